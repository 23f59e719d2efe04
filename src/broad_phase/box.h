// The plain values every broad phase works on.
#pragma once

#include <cstdint>

namespace lendulet {

// A box as stored: two quads of floats, so that a kernel loads it with two instructions. `index` is the caller's, not
// shared by two boxes. lower <= upper in each coordinate, both possibly infinite; never NaN.
struct alignas(32) BroadBox {
    float lower[3];
    uint32_t index;
    float upper[3];
    uint32_t unused;
};

// Two boxes that overlap (closed: touching counts), by the caller's indices, a < b.
struct BoxPair {
    uint32_t a, b;
};

// A box of the structure itself.
struct BroadPhaseBox {
    float lower[3], upper[3];
    int depth;  // 0: root
    bool leaf;
    uint32_t index;  // of a leaf: the caller's
};

inline constexpr uint32_t no_box = ~0u;

// One query of each kind, for batches; see the functions of BroadPhase for one.
struct BoxQuery {
    float lower[3], upper[3];
};
struct RayQuery {
    float origin[3], translation[3], max_t;
};
struct CastQuery {
    float lower[3], upper[3], translation[3], max_t;
};
struct NearestQuery {
    float point[3], max_distance;
};

// The answer to a ray, cast or nearest query: `at` is t or the distance, unset if the index is no_box.
struct BroadPhaseHit {
    uint32_t index;
    float at;
};

}  // namespace lendulet
