// Which of the mesh triangles near a convex shape are worth looking at, W at a time: tests of separation along the
// triangle's normal, its three sides and the shape's own axes. What it rejects touches nothing, or touches the
// neighbour instead, so that what it lets through decides nothing but the time.
#pragma once

#include <cstdint>

#include "geometry/triangle_surface.h"

namespace lendulet {

struct HullFace;
struct MeshQuery;

// Triangles side by side, what they are tested against, and what is left of them; filled and read by MeshFilter.
struct MeshFilterBatch {
    static constexpr int capacity = 64, room = capacity + 16;  // whole blocks of the widest lanes
    int count;
    float corner[3][3][room], front[3][room];  // mesh frame; by corner and component, by component of the unit normal
    float lean[room];  // most that the direction of the shortest distance leans across a side, as sine

    const Geometry* shape;
    const Vec3* hull;           // its corners, where it is a hull of few,
    const HullFace* hull_face;  // and its faces
    int hull_count, hull_faces;
    Mat3 to_shape;                // rows: the axes of contacts in those of the mesh
    Vec3 position, lower, upper;  // of the shape, and bounds relative to that, margin included, mesh axes
    Vec3 centre;                  // of the shape, relative to its position, mesh axes
    Vec3 box_centre, box_half;    // of the core, the shape's axes
    Vec3 box_lower, box_upper;    // of the core and the limit, the shape's axes
    float limit, slack;           // cores farther than that do not matter, give or take the slack, which is in it

    // Out: how far shape and triangle must come nearer to each other, or the limit rise, before the triangle can pass
    // the tests along axes that do not turn with the shape; of those that pass 0 or less.
    float away[room];

    // Out: those that may touch, or whose plane the shape is beyond, one after the other in their order, in the axes of
    // contacts and relative to the shape's position.
    int live;
    uint32_t number[room];                 // of the triangle among those tested
    float p[3][3][room], normal[3][room];  // by corner and component; towards the shape's centre
    float flags[room];                     // as whole numbers, see below
    float face[room];                      // the number of the face that looks at it: of a box or a hull of few
    float lowest[3][room];                 // where the core's lowest point along the normal is,
    bool has_lowest;                       // of shapes of which that is found on the way
    enum Flag {
        apart = 1,         // the core is farther than the limit from it, though it crosses its plane
        behind = 2,        // the shape's centre is behind it
        beside = 4,        // all of the core is outside one of its sides
        first_beyond = 3,  // number of the first of three flags: edges as of beyond_edges()
    };

    // Out, but for balls: those that the core is farther from than the limit and outside a side of, though it crosses
    // their planes. They give nothing, and neither do the edges and corners that they share with others.
    int far;
    uint32_t far_number[room];
    float far_behind[room];  // 1: the shape's centre is behind it

    bool is(Flag flag, int i) const { return (static_cast<int>(flags[i]) & flag) != 0; }
};

// Overlapping by h, the lowest point along a normal may be within a side by h tan(a / 2), with a the angle up to which
// edges are gentle.
inline constexpr float half_gentle_tangent = 0.125f;

using FilterTriangles = void (*)(MeshFilterBatch&);
// Four at a time.
void filter_triangles(MeshFilterBatch& batch);

class MeshFilter {
public:
    static constexpr int capacity = MeshFilterBatch::capacity;

    // `limit`: cores farther than that from a triangle do not matter.
    MeshFilter(const MeshQuery& q, float limit);

    // Up to `capacity` triangles.
    void test(const uint32_t* triangles, int count);

    // The shape's points are within that of its position, those which a hull is taken for included.
    float reach() const { return reach_; }
    // What number i of those tested is away from passing, less what rounding may take.
    float away(int i) const { return batch_.away[i] - batch_.slack; }

    // What is left, by number; and where its parts are.
    int live() const { return batch_.live; }
    uint32_t number(int i) const { return batch_.number[i]; }
    bool is_apart(int i) const { return batch_.is(MeshFilterBatch::apart, i); }
    bool is_behind(int i) const { return batch_.is(MeshFilterBatch::behind, i); }
    bool is_beside(int i) const { return batch_.is(MeshFilterBatch::beside, i); }
    uint8_t edges_beyond(int i) const {  // where lowest points are known
        return static_cast<uint8_t>(static_cast<int>(batch_.flags[i]) >> MeshFilterBatch::first_beyond);
    }
    Vec3 corner(int i, int k) const { return at(batch_.p[k], i); }
    Vec3 normal(int i) const { return at(batch_.normal, i); }
    Vec3 lowest(int i) const { return at(batch_.lowest, i); }
    void set_lowest(int i, Vec3 p) { batch_.lowest[0][i] = p.x, batch_.lowest[1][i] = p.y, batch_.lowest[2][i] = p.z; }
    bool has_lowest() const { return batch_.has_lowest; }
    int32_t face(int i) const { return static_cast<int32_t>(batch_.face[i]); }
    // The triangles that are far, by number.
    int far() const { return batch_.far; }
    uint32_t far_number(int i) const { return batch_.far_number[i]; }
    bool is_far_behind(int i) const { return batch_.far_behind[i] > 0.0f; }
    const MeshFilterBatch& batch() const { return batch_; }

private:
    static Vec3 at(const float (&rows)[3][MeshFilterBatch::room], int i) {
        return {rows[0][i], rows[1][i], rows[2][i]};
    }
    void load(const uint32_t* triangles, int count);

    const TriangleSurface& surface_;
    FilterTriangles filter_;
    float reach_;
    MeshFilterBatch batch_;
};

}  // namespace lendulet
