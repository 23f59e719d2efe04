// A convex polytope of triangles inside a Minkowski difference, which takes new points one by one (thesis 4.2: the
// faces below the new point go, the edges that bounded them are joined to it). Topology never depends on distances
// being exact: the faces removed by a point are always connected, and a removal that would tear the surface is refused.
#pragma once

#include <cstdint>

#include "collision/gjk_difference.h"

namespace lendulet {

class Polytope {
public:
    static constexpr int max_vertices = 72;
    static constexpr int max_faces = 2 * max_vertices;

    Polytope() {}  // leaves the arrays unset: clearing them would cost more than a typical query

    // The four points must span a volume. Faces nearer to coplanar with a new point than `tolerance` (m) are merged.
    void start(const Simplex& tetrahedron, double tolerance);
    int nearest_face() const;
    // Takes p, which lies beyond face f. False where rounding has left no clean outline to join it to.
    bool expand(int f, const DifferencePoint& p);
    bool holds(Vec3d y) const;
    void retire(int f) { distance_[f] = far; }  // never again the nearest

    Vec3d normal(int f) const { return faces_[f].n; }
    int face_end() const { return face_end_; }  // faces are 0 ... face_end() - 1, removed ones infinitely far
    double distance(int f) const { return distance_[f]; }  // from the origin to the plane, positive inside
    Simplex triangle(int f) const;

private:
    static constexpr double far = 1e300;
    struct Face {
        Vec3d n;               // unit, outward; zero for a face without area
        uint8_t vertex[3];     // counter-clockwise seen from outside
        uint8_t neighbour[3];  // across the edge from vertex[i] to vertex[i + 1]
    };
    struct Edge {
        uint8_t from, to, outer;  // outer: the face that stays
    };

    void set_face(int f, int i, int j, int k);
    int add_vertex(const DifferencePoint& p);
    int collect_visible(int f, Vec3d y);
    int collect_outline(int visible_count);
    bool is_one_loop(int edge_count);

    int vertex_count_, face_end_, free_count_;
    double tolerance_;
    // Unions without a constructed member: see the constructor.
    union {
        Vec3d y_[max_vertices];
    };
    union {
        Vec3 a_[max_vertices];
    };
    union {
        Vec3 b_[max_vertices];
    };
    union {
        Face faces_[max_faces];
    };
    double distance_[max_faces];
    uint8_t free_[max_faces], visible_[max_faces];
    bool is_visible_[max_faces];
    Edge outline_[max_faces];
    uint8_t edge_from_[max_vertices];  // outline edge that starts at a vertex
};

}  // namespace lendulet
