// Eight boxes side by side and the two tests every broad phase is made of: does a box overlap them, does a ray enter
// them. The number is fixed, so that the order of pairs does not depend on the width of the machine's vectors.
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
        box.lower[d] = splat<Float4>(lower[d]);
        box.upper[d] = splat<Float4>(upper[d]);
    }
    return box;
}

LENDULET_FORCE_INLINE WideBox spread_lane(const BoxBlock& block, int lane) {
    WideBox box;
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = splat<Float4>(block.lower[d][lane]);
        box.upper[d] = splat<Float4>(block.upper[d][lane]);
    }
    return box;
}

// Bit i is set where box i of the block overlaps `box`; intervals are closed, so touching counts.
LENDULET_FORCE_INLINE uint32_t overlaps(const BoxBlock& block, const WideBox& box) {
    uint32_t bits = 0;
    for (int half = 0; half < block_size; half += 4) {
        auto hit = load_wide<Float4>(block.lower[0] + half) <= box.upper[0];
        hit &= load_wide<Float4>(block.upper[0] + half) >= box.lower[0];
        for (int d = 1; d < 3; ++d) {
            hit &= load_wide<Float4>(block.lower[d] + half) <= box.upper[d];
            hit &= load_wide<Float4>(block.upper[d] + half) >= box.lower[d];
        }
        bits |= mask_bits(hit) << half;
    }
    return bits;
}

inline bool overlap(const BroadBox& a, const float lower[3], const float upper[3]) {
    return a.lower[0] <= upper[0] && a.upper[0] >= lower[0] && a.lower[1] <= upper[1] && a.upper[1] >= lower[1] &&
           a.lower[2] <= upper[2] && a.upper[2] >= lower[2];
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

// Index of the lowest set bit, which is cleared.
LENDULET_FORCE_INLINE int take_bit(uint32_t& bits) {
    int bit = __builtin_ctz(bits);
    bits &= bits - 1;
    return bit;
}

// The segment origin + t * translation, t in [0, max_t], with the best hit so far.
struct RayCast {
    float origin[3], translation[3];
    float best_t;
    uint32_t best_index = no_box;

    // A hit is at most FLT_MAX away, so that infinity can stand for a miss.
    RayCast(const float from[3], const float along[3], float max_t)
        : origin{from[0], from[1], from[2]},
          translation{along[0], along[1], along[2]},
          best_t(max_t < FLT_MAX ? max_t : FLT_MAX) {}

    void offer(float t, uint32_t index) {
        if (t < best_t || (t == best_t && index < best_index)) {
            best_t = t;
            best_index = index;
        }
    }
};

// Where the ray enters a box (0 where it starts inside), infinity where it misses or only reaches it beyond the best
// hit. The slab test of Kay and Kajiya 1986. Subtraction and division round monotonically, hence the interval of a node
// contains those of its boxes to the last bit and a descent finds exactly what a scan finds.
template <class F>
LENDULET_FORCE_INLINE F ray_entry(const RayCast& ray, const F lower[3], const F upper[3]) {
    F enter = splat<F>(0.0f), leave = splat<F>(ray.best_t);
    auto hit = leave >= enter;
    for (int d = 0; d < 3; ++d) {
        F origin = splat<F>(ray.origin[d]), along = splat<F>(ray.translation[d]);
        if (ray.translation[d] == 0.0f) {
            hit = hit & (lower[d] <= origin) & (upper[d] >= origin);
            continue;
        }
        bool forwards = ray.translation[d] > 0.0f;
        enter = maximum(((forwards ? lower[d] : upper[d]) - origin) / along, enter);
        leave = minimum(((forwards ? upper[d] : lower[d]) - origin) / along, leave);
    }
    return select(hit & (enter <= leave), enter, splat<F>(infinity));
}

// The same for the eight boxes of a block.
inline void ray_entries(const RayCast& ray, const BoxBlock& block, float out[block_size]) {
    for (int half = 0; half < block_size; half += 4) {
        Float4 lower[3], upper[3];
        for (int d = 0; d < 3; ++d) {
            lower[d] = load_wide<Float4>(block.lower[d] + half);
            upper[d] = load_wide<Float4>(block.upper[d] + half);
        }
        store_wide(out + half, ray_entry<Float4>(ray, lower, upper));
    }
}

// Offers the boxes in the given lanes to the ray; index[i] belongs to lane i.
inline void cast_into(RayCast& ray, const BoxBlock& block, uint32_t lanes, const uint32_t* index) {
    float entry[block_size];
    ray_entries(ray, block, entry);
    while (lanes) {
        int lane = take_bit(lanes);
        ray.offer(entry[lane], index[lane]);
    }
}

}  // namespace lendulet
