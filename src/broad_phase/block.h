// Eight boxes side by side and the test every broad phase is made of: does a box overlap them. The number is fixed, so
// that the order of pairs does not depend on the width of the machine's vectors.
#pragma once

#include <cfloat>
#include <cstdint>

#include "broad_phase/box.h"
#include "math/wide/wide.h"

namespace lendulet {

inline constexpr int block_size = 8;
inline constexpr float infinity = __builtin_inff();

// Lanes without a box have lower = +infinity and upper = -infinity: no box with finite bounds overlaps them.
struct alignas(64) BoxBlock {
    float lower[3][block_size], upper[3][block_size];
};

using Float4 = Wide<float, 4>;

// A box with each coordinate in all lanes: spread once, then tested against many blocks.
struct WideBox {
    Float4 lower[3], upper[3];
};

LENDULET_FORCE_INLINE WideBox spread(const float lower[3], const float upper[3]) {
    WideBox box;
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = repeat<Float4>(lower[d]);
        box.upper[d] = repeat<Float4>(upper[d]);
    }
    return box;
}

LENDULET_FORCE_INLINE WideBox spread_lane(const BoxBlock& block, int lane) {
    WideBox box;
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = repeat<Float4>(block.lower[d][lane]);
        box.upper[d] = repeat<Float4>(block.upper[d][lane]);
    }
    return box;
}

// Bit i is set where box `half` + i of the block overlaps `box`, i = 0 .. 3; intervals are closed, so touching counts.
LENDULET_FORCE_INLINE uint32_t overlaps_half(const BoxBlock& block, int half, const WideBox& box) {
    auto hit = load_wide<Float4>(block.lower[0] + half) <= box.upper[0];
    hit &= load_wide<Float4>(block.upper[0] + half) >= box.lower[0];
    for (int d = 1; d < 3; ++d) {
        hit &= load_wide<Float4>(block.lower[d] + half) <= box.upper[d];
        hit &= load_wide<Float4>(block.upper[d] + half) >= box.lower[d];
    }
    return mask_bits(hit);
}

// The same for all eight.
LENDULET_FORCE_INLINE uint32_t overlaps(const BoxBlock& block, const WideBox& box) {
    return overlaps_half(block, 0, box) | overlaps_half(block, 4, box) << 4;
}

inline bool overlap(const BroadBox& a, const float lower[3], const float upper[3]) {
    return a.lower[0] <= upper[0] && a.upper[0] >= lower[0] && a.lower[1] <= upper[1] && a.upper[1] >= lower[1] &&
           a.lower[2] <= upper[2] && a.upper[2] >= lower[2];
}

// No side is infinite.
inline bool bounded(const BroadBox& box) {
    const Float4 most = splat<Float4>(FLT_MAX);
    auto finite = (absolute(load_wide<Float4>(box.lower)) <= most) & (absolute(load_wide<Float4>(box.upper)) <= most);
    return (mask_bits(finite) & 7) == 7;  // the fourth words are no sides
}

inline BroadBox box_in(const BoxBlock& block, int lane, uint32_t index) {
    return {{block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]},
            index,
            {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]},
            0};
}

inline void set_lane(BoxBlock& block, int lane, const float lower[3], const float upper[3]) {
    for (int d = 0; d < 3; ++d) {
        block.lower[d][lane] = lower[d];
        block.upper[d][lane] = upper[d];
    }
}

inline void clear_lane(BoxBlock& block, int lane) {
    for (int d = 0; d < 3; ++d) {
        block.lower[d][lane] = infinity;
        block.upper[d][lane] = -infinity;
    }
}

inline bool is_empty(const BoxBlock& block, int lane) { return block.lower[0][lane] > block.upper[0][lane]; }

// The four lanes from `first` on.
inline void clear_half(BoxBlock& block, int first) {
    for (int d = 0; d < 3; ++d) {
        store_wide(block.lower[d] + first, splat<Float4>(infinity));
        store_wide(block.upper[d] + first, splat<Float4>(-infinity));
    }
}
inline void clear_lanes(BoxBlock& block) {
    for (int i = 0; i < block_size; i += 4) clear_half(block, i);
}

// Index of the lowest set bit, which is cleared.
LENDULET_FORCE_INLINE int take_bit(uint32_t& bits) {
    int bit = __builtin_ctz(bits);
    bits &= bits - 1;
    return bit;
}

}  // namespace lendulet
