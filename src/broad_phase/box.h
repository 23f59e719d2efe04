// The plain values every broad phase works on.
#pragma once

#include <cstdint>

namespace lendulet {

// A box as stored: two quads of floats, so that a kernel loads it with two instructions. `index` is the caller's.
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

}  // namespace lendulet
