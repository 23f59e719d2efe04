// Over which triangles a shape's lowest points lie, and so which edges of gently bent triangles it can touch.
//
// Let n lean from the normal of a triangle T towards that of its neighbour across an edge. The core's lowest point
// along n then moves back over T, or stays (the support of a convex shape is monotone). Where the shape touches the
// edge, in a direction between the two normals, the lowest point along it is over the edge; so the lowest point along
// T's own normal is beyond the edge, and that along the neighbour's is beyond it seen from there. Likewise no corner of
// a triangle is touched whose sides there the triangle's lowest point is within. A shape that is beside T, and rests on
// the neighbour, needs no closest points on T.
#pragma once

#include <cstdint>

#include "collision/mesh/over_triangle.h"
#include "collision/mesh/query.h"

namespace lendulet {

// Bit i: the core's lowest point along the triangle's normal is beyond edge i, or not surely within.
uint8_t beyond_edges(const MeshQuery& q, const Triangle& t, const TriangleSides& sides, Vec3 lowest);

// The triangles that one query has looked at.
class Footing {
public:
    // Before anything is asked. Nothing of what is farther than the limit is touched: its lowest point is beyond no
    // edge. Above the capacity nothing is kept, and more closest points are sought than necessary.
    void note(uint32_t triangle, bool from_behind, uint8_t beyond) {
        if (count_ < capacity) noted_[count_++] = {triangle, beyond, from_behind};
    }
    // Of a triangle that the lowest point is not over.
    struct Beside {
        uint32_t index;
        uint8_t beyond;  // as of beyond_edges()
        bool from_behind;
    };
    // False only where the shape cannot touch an edge or corner of the triangle, all of whose edges are gentle or
    // cannot touch.
    bool may_touch_rim(const MeshQuery& q, const Beside& t);

private:
    static constexpr int capacity = 192;
    static constexpr uint32_t lists = 64;
    struct Linked {
        uint32_t name;  // of a triangle or a corner
        uint16_t next;  // one more than the number of the next whose name has the same last digits; 0: none
        uint8_t beyond;
        bool from_behind;
    };
    struct Linking {
        uint16_t first[lists];
        Linked at[3 * capacity];
        int count = 0;

        void add(uint32_t name, uint8_t beyond, bool from_behind);
        const Linked* find(uint32_t name, bool from_behind) const;
    };

    void link(const MeshQuery& q);
    // Of any triangle, noted or not.
    Beside look_up(const MeshQuery& q, uint32_t index, bool from_behind) const;

    int count_ = 0;
    bool linked_ = false;
    Beside noted_[capacity];
    Linking triangles_, settled_;  // settled: corners of a triangle whose lowest point is within both sides there
};

}  // namespace lendulet
