// A convex polytope of triangles inside a Minkowski difference, which takes new points one by one (thesis 4.2: the
// faces below the new point go, the edges that bounded them are joined to it). Topology never depends on distances
// being exact: the faces removed by a point are always connected, and a removal that would tear the surface is refused.
#pragma once

#include <cstdint>

#include "collision/gjk_difference.h"
#include "math/wide/wide.h"

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
    DifferencePoint farthest(Vec3d d) const;  // of the polytope's corners

    int face_end() const { return face_end_; }  // faces are 0 ... face_end() - 1, removed ones infinitely far
    bool alive(int f) const { return key_[f] < far; }
    Vec3d direction(int f) const { return faces_[f].n; }  // the normal at any length
    Vec3d normal(int f) const { return (1.0 / square_root(faces_[f].nn)) * faces_[f].n; }
    // From the origin to the plane of face f with normal n, positive where the origin lies inside.
    double distance(int f, Vec3d n) const { return dot(n, y_[faces_[f].vertex[0]]); }
    double height_above(int f, Vec3d y) const { return dot(normal(f), y - y_[faces_[f].vertex[0]]); }
    Simplex triangle(int f) const;
    const uint8_t* corners(int f) const { return faces_[f].vertex; }  // three vertices by number

private:
    static constexpr double far = 1e300;
    struct Face {
        Vec3d n;  // outward, of any length; zero for a face without area
        double nn;
        uint8_t vertex[3];     // counter-clockwise seen from outside
        uint8_t neighbour[3];  // across the edge from vertex[i] to vertex[i + 1]
    };
    struct Edge {
        uint8_t from, to;
        uint8_t outer, outer_edge;  // the face that stays, and which of its edges this is
    };

    void set_corners(int f, int i, int j, int k);
    void set_planes(const int* faces, Vec3T<Wide<double, 2>> i, Vec3T<Wide<double, 2>> j, Vec3T<Wide<double, 2>> k);
    int add_vertex(const DifferencePoint& p);
    bool lies_above(Vec3d y, const Face& face) const;
    void collect_visible(int f, int entered, Vec3d y);
    bool outline_is_simple();

    int vertex_count_, face_end_, free_count_, visible_count_, edge_count_;
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
        Face faces_[max_faces + 1];  // the last is for a plane that belongs to no face
    };
    double key_[max_faces + 1];  // the distance times its absolute value, which orders faces without a square root
    uint8_t free_[max_faces], visible_[max_faces];
    bool is_visible_[max_faces];
    Edge outline_[max_faces + 1];
    uint8_t last_seen_[max_vertices];  // the expansion in whose outline a vertex was last
};

}  // namespace lendulet
