// A convex polytope of triangles inside a Minkowski difference, which takes new points one by one (thesis 4.2: the
// faces below the new point go, the edges that bounded them are joined to it). Topology never depends on distances
// being exact: the outline of the faces removed by a point is always one loop, and a removal that would tear the
// surface is refused.
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

    int face_end() const { return face_end_; }  // faces are 0 ... face_end() - 1, removed ones infinitely far
    bool alive(int f) const { return distance_[f] < far; }
    Vec3d normal(int f) const { return {normal_x_[f], normal_y_[f], normal_z_[f]}; }  // unit, outward
    // From the origin to the plane of face f, positive where the origin lies inside.
    double distance(int f) const { return distance_[f]; }
    Simplex triangle(int f) const;

private:
    static constexpr double far = 1e300;
    static constexpr int spare = max_faces;  // a place for a plane that belongs to no face
    // Half edge 4 f + e of face f leads from its corner e to the next one, counter-clockwise seen from outside. A half
    // edge of the outline in one word, which is written and read at once: where it begins and ends, and its twin on the
    // face that stays.
    class Edge {
    public:
        Edge() {}
        Edge(uint32_t from, uint32_t to, uint32_t twin) : bits_(from | to << 8 | twin << 16) {}
        uint32_t from() const { return bits_ & 255; }
        uint32_t to() const { return bits_ >> 8 & 255; }
        uint32_t twin() const { return bits_ >> 16; }

    private:
        uint32_t bits_;
    };

    int add_vertex(const DifferencePoint& p);
    template <class F>
    void set_planes(const int* faces, Vec3T<F> from, Vec3T<F> to, Vec3d apex);
    void find_visible(int f, Vec3d y);
    void list_visible();
    bool find_outline();
    bool keep_connected(int f);
    void join_outline(const DifferencePoint& p);

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
    // Planes component by component, for loops over two faces at a time. A face without area has no normal, offset 0,
    // and lies infinitely far. `height_` is how far the point that is being taken lies above each plane.
    double normal_x_[max_faces + 1], normal_y_[max_faces + 1], normal_z_[max_faces + 1];
    double offset_[max_faces + 1], distance_[max_faces + 1], height_[max_faces + 1];
    uint8_t corner_[4 * max_faces];
    uint16_t twin_[4 * max_faces];
    uint8_t free_[max_faces], visible_[max_faces + 1];
    Edge outline_[max_faces + 1];
    uint8_t edge_from_[max_vertices];  // which edge of the outline begins at a vertex
};

}  // namespace lendulet
