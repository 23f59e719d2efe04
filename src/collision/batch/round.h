// Pairs of balls and capsules with each other, and of boxes with balls, many at a time: the wide kernels of round.inl
// behind one call per instruction set. They do what pair_ball.cpp does for one pair.
#pragma once

#include <cstdint>

#include "collision/batch/frame.h"
#include "collision/batch/manifold.h"

namespace lendulet {

// Pairs to collide. Whole blocks of lanes are read and written, so the arrays have room beyond `count` for the widest.
struct RoundBatch {
    static constexpr int room = batch_capacity + 16;
    const ShapeFrame* frames;
    float dt, fall;  // fall: what gravity moves a body by within the step, m
    int count = 0;
    int32_t a[room], b[room];  // indices of frames; of a box and a ball, the box is A
    float exchanged[room];     // 1 where the manifold is wanted as from B to A, else 0
};

}  // namespace lendulet
