// Pairs of sharp boxes, many at a time: the wide kernels of boxes.inl behind one call per instruction set.
#pragma once

#include <cstdint>

#include "collision/batch/frame.h"
#include "collision/batch/manifold.h"

namespace lendulet {

// Pairs to collide. Whole blocks of lanes are read and written, so the arrays need room beyond `count` for the widest;
// see BoxLists.
struct BoxBatch {
    const ShapeFrame* frames;
    int count;
    int32_t *a, *b;  // indices of frames
    float* margin;   // surfaces farther apart than this give no points, m
    float* way;      // how far the boxes may come within the step, m; 0: points only where they are nearest now
    // In: 1 + the axis of the last contact, 0: none. Out: that of this one, where it was found by an axis.
    float* feature;
    float* clearance;    // out: the distance is at least this, m (the largest separation along an axis)
    BatchManifold* out;  // valid where clearance <= margin
    int32_t* list[2];    // scratch: pairs whose faces and whose edges meet
};

template <int Pairs, int Lanes>
struct BoxLists {
    static constexpr int room = Pairs + Lanes;
    int32_t a[room], b[room], list[2][room];
    float margin[room], way[room], feature[room], clearance[room];
    BatchManifold out[room];
    BoxBatch batch(const ShapeFrame* frames, int count) {
        return {frames, count, a, b, margin, way, feature, clearance, out, {list[0], list[1]}};
    }
};

}  // namespace lendulet
