// A manifold as batches of pairs write it, in quads. Points that are not there have separation `absent_separation`.
#pragma once

#include <cstdint>

namespace lendulet {

inline constexpr float absent_separation = 1e9f;

struct alignas(64) BatchManifold {
    float normal[3];  // unit, from A to B, world axes
    float follow;     // see Manifold
    struct {
        float position[3], separation;  // half way between the surfaces, from the centre of mass of A's body
    } points[4];
    uint32_t id[4];
    int32_t count;             // 0: the features that face each other do not overlap, or they are beyond the margin
    float radius_a, radius_b;  // see Manifold
    float passes;              // 1: moving on as they do, the two do not touch within the step
};
static_assert(sizeof(BatchManifold) == 128);

}  // namespace lendulet
