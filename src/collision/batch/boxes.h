// Pairs of sharp boxes, many at a time: the wide kernels of boxes.inl behind one call per instruction set.
#pragma once

#include <cstdint>

#include "collision/batch/frame.h"

namespace lendulet {

// A manifold of two boxes in quads. Points that are not there have separation `absent_separation`.
inline constexpr float absent_separation = 1e9f;
struct alignas(64) BoxManifold {
    float normal[3];  // unit, from A to B, world axes
    float follow;     // see Manifold
    struct {
        float position[3], separation;  // half way between the surfaces, from the centre of mass of A's body
    } points[4];
    uint32_t id[4];
    int32_t count;  // 0: the features that face each other do not overlap, or they are beyond the margin
    uint32_t unused[3];
};
static_assert(sizeof(BoxManifold) == 128);

// Lists of one chunk. Whole blocks of lanes are read and written: room beyond `count` for the widest.
struct BoxBatch {
    static constexpr int room = batch_capacity + 16;
    const ShapeFrame* frames;
    int count = 0;
    int32_t a[room], b[room];  // indices of frames
    float margin[room];
    // In: 1 + the axis of the last contact, 0: none. Out: that of this one, where it was found by an axis.
    float feature[room];
    float clearance[room];   // out: the distance is at least this, m (the largest separation along an axis)
    BoxManifold out[room];   // valid where clearance <= margin
    int32_t list[2][room];   // scratch: pairs whose faces and whose edges meet
};

}  // namespace lendulet
