// What batches of pairs read of a collider, in quads so that lanes are filled by transposes. The first cache line tells
// how it moves, the second what it is.
#pragma once

#include <cstdint>

#include "lendulet/math.h"

namespace lendulet {

struct alignas(64) ShapeFrame {
    float rotation[4];  // shape to world
    float centre[3];    // the body's centre of mass, world
    float near;         // surfaces this close are given points, m
    float velocity[3];  // of the centre of mass
    float turning;      // most that turning moves a point of the shape within the step, m
    float arm[3];       // the shape's position from the centre of mass, world axes
    float reach;        // farthest that a point of the shape is from the centre of mass, m
    float half[3];      // half extents of boxes; of a capsule's core the second
    float rounding;     // radius around the core
    float radius;       // of a sphere about the shape's position that holds it
    float low[3];       // what rounding added to `centre`, see BodyMomenta::x_low
    uint32_t unused[8];
};
static_assert(sizeof(ShapeFrame) == 128);

inline constexpr int frame_stride = sizeof(ShapeFrame) / sizeof(float);
inline constexpr int frame_rotation = 0, frame_centre = 4, frame_velocity = 8, frame_arm = 12, frame_half = 16;
inline constexpr int frame_low = 20;  // in the quad that begins with `radius`

// Pairs are processed in chunks of this many; index lists have room for whole blocks of the widest lanes.
inline constexpr int batch_capacity = 256;

// From the centre of mass of A's body to that of B's. 100 m from the origin positions are rounded to 7.6e-6 m; what
// that took is kept, and with it gaps are as exact as at the origin.
template <class V>
LENDULET_FORCE_INLINE V between_centres(V a, V a_low, V b, V b_low) {
    return (b - a) - (b_low - a_low);
}

}  // namespace lendulet
