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

// Pairs to collide. Whole blocks of lanes are read and written, so the arrays need room beyond `count` for the widest;
// see BoxLists.
struct BoxBatch {
    const ShapeFrame* frames;
    int count;
    int32_t *a, *b;  // indices of frames
    float* margin;   // surfaces farther apart than this give no points, m
    // In: 1 + the axis of the last contact, 0: none. Out: that of this one, where it was found by an axis.
    float* feature;
    float* clearance;  // out: the distance is at least this, m (the largest separation along an axis)
    BoxManifold* out;  // valid where clearance <= margin
    int32_t* list[2];  // scratch: pairs whose faces and whose edges meet
};

template <int Pairs, int Lanes>
struct BoxLists {
    static constexpr int room = Pairs + Lanes;
    int32_t a[room], b[room], list[2][room];
    float margin[room], feature[room], clearance[room];
    BoxManifold out[room];
    BoxBatch batch(const ShapeFrame* frames, int count) {
        return {frames, count, a, b, margin, feature, clearance, out, {list[0], list[1]}};
    }
};

}  // namespace lendulet
