// Contacts of a convex shape with many triangles, gathered into few manifolds: what neighbouring triangles of one plane
// give becomes one manifold of at most four points, where their material is one. Bounded, on the stack; the result
// depends on the order in which triangles come, which is that of the mesh's hierarchy.
#pragma once

#include <cstdint>

#include "collision/clip.h"
#include "collision/manifold.h"
#include "collision/narrow_phase.h"

namespace lendulet {

// A point of a manifold without initial values: there are many, of which few are used.
struct MeshPoint {
    float x, y, z, separation;
    uint32_t id;
    Vec3 position() const { return {x, y, z}; }
};

// What one triangle gives: points with one normal, relative to the position of the convex shape.
struct TriangleContact {
    Vec3 normal;  // from the triangle to the shape
    Vec3 front;   // of a face: the same in the axes of the mesh, of which it does not turn with the shape
    bool face;    // the normal is that of the triangle
    float radius, follow;
    uint32_t original;  // the triangle
    uint8_t material;
    int count = 0;
    // Of a ball, whose contacts are one: how much nearer it is in the middle of the step.
    bool single = false;
    float nears = 0.0f;
    MeshPoint points[max_clipped_points];
};

class MeshManifolds {
public:
    // Points closer together than `resolution` are one.
    explicit MeshManifolds(float resolution) : near_squared_(resolution * resolution) {}

    void add(const TriangleContact& contact);
    // Writes at most `capacity` manifolds, the deepest where there are more, turned from the axes of the mesh and of
    // the contacts to others and relative to a point from which the shape is at `position`.
    struct Placing {
        Quat from_mesh, from_contact;
        Vec3 position;
    };
    int write(const Placing& placing, Manifold* out, int capacity);

private:
    static constexpr int max_groups = 24, max_points = 64;
    struct Group {  // without initial values
        union {
            Vec3 normal;
        };
        union {
            Vec3 front;
        };
        bool face;
        uint8_t material;
        float radius, follow, deepest;
        uint32_t lowest_original, deepest_original;
        int count;
        MeshPoint points[max_points];

        Group() {}
    };

    Group* group_for(const TriangleContact& contact);
    void add_point(Group& group, const MeshPoint& point);
    static void reduce(Group& group);

    float near_squared_;
    int count_ = 0;
    Group groups_[max_groups];
};

}  // namespace lendulet
