// What a query carries while it visits boxes: the best hit so far and the test that betters it. Ties go to the smallest
// index, so the answer depends neither on the order of visits nor on the structure.
#pragma once

#include <cfloat>
#include <cmath>

#include "broad_phase/block.h"

namespace lendulet {

// A box (a point for a ray) that moves by t * translation, t in [0, max_t].
struct BoxCast {
    float lower[3], upper[3], translation[3];
    float best_t;
    uint32_t best_index = no_box;

    // A hit is at most FLT_MAX away, so that infinity can stand for a miss.
    BoxCast(const float low[3], const float high[3], const float along[3], float max_t)
        : lower{low[0], low[1], low[2]},
          upper{high[0], high[1], high[2]},
          translation{along[0], along[1], along[2]},
          best_t(max_t < FLT_MAX ? max_t : FLT_MAX) {}

    LENDULET_FORCE_INLINE void offer(float t, uint32_t index) {
        if (t < best_t || (t == best_t && index < best_index)) {
            best_t = t;
            best_index = index;
        }
    }
};

// When the cast enters a box (0 where it starts inside), infinity where it misses or only reaches it beyond the best
// hit. The slab test of Kay and Kajiya 1986 on the sum of both boxes. Subtraction and division round monotonically,
// hence the interval of a node contains those of its boxes to the last bit and a descent finds exactly what a scan
// finds.
template <class F>
LENDULET_FORCE_INLINE F cast_entry(const BoxCast& cast, const F lower[3], const F upper[3]) {
    F enter = splat<F>(0.0f), leave = splat<F>(cast.best_t);
    auto hit = leave >= enter;
    for (int d = 0; d < 3; ++d) {
        F low = splat<F>(cast.lower[d]), high = splat<F>(cast.upper[d]), along = splat<F>(cast.translation[d]);
        if (cast.translation[d] == 0.0f) {
            hit = hit & (lower[d] <= high) & (upper[d] >= low);
            continue;
        }
        bool forwards = cast.translation[d] > 0.0f;
        enter = maximum((forwards ? lower[d] - high : upper[d] - low) / along, enter);
        leave = minimum((forwards ? upper[d] - low : lower[d] - high) / along, leave);
    }
    return select(hit & (enter <= leave), enter, splat<F>(infinity));
}

// A point, and how far the nearest box so far is from it, squared. What is farther than the root of FLT_MAX (1.8e19 m)
// is not found, so that infinity can stand for nothing there.
struct NearestBox {
    float point[3];
    float best_squared;
    uint32_t best_index = no_box;

    // No box is at a negative distance.
    NearestBox(const float p[3], float max_distance) : point{p[0], p[1], p[2]} {
        float squared = max_distance * max_distance;
        best_squared = max_distance < 0 ? -1.0f : squared < FLT_MAX ? squared : FLT_MAX;
    }

    LENDULET_FORCE_INLINE void offer(float squared, uint32_t index) {
        if (squared < best_squared || (squared == best_squared && index < best_index)) {
            best_squared = squared;
            best_index = index;
        }
    }
    float distance() const { return std::sqrt(best_squared); }
};

// Squared distance of a box from the point, 0 inside. Rounds monotonically too: a node is never farther than its boxes.
template <class F>
LENDULET_FORCE_INLINE F squared_distance(const NearestBox& nearest, const F lower[3], const F upper[3]) {
    F sum = splat<F>(0.0f);
    for (int d = 0; d < 3; ++d) {
        F at = splat<F>(nearest.point[d]);
        F gap = maximum(maximum(lower[d] - at, at - upper[d]), splat<F>(0.0f));
        sum = sum + gap * gap;
    }
    return sum;
}

LENDULET_FORCE_INLINE float measure(const BoxCast& cast, const float lower[3], const float upper[3]) {
    return cast_entry<float>(cast, lower, upper);
}
LENDULET_FORCE_INLINE float measure(const NearestBox& nearest, const float lower[3], const float upper[3]) {
    return squared_distance<float>(nearest, lower, upper);
}
inline Float4 measure_wide(const BoxCast& cast, const Float4 lower[3], const Float4 upper[3]) {
    return cast_entry<Float4>(cast, lower, upper);
}
inline Float4 measure_wide(const NearestBox& nearest, const Float4 lower[3], const Float4 upper[3]) {
    return squared_distance<Float4>(nearest, lower, upper);
}
LENDULET_FORCE_INLINE float limit(const BoxCast& cast) { return cast.best_t; }
LENDULET_FORCE_INLINE float limit(const NearestBox& nearest) { return nearest.best_squared; }

// The measure of a query (when it enters, how far it is) for the eight boxes of a block; smaller is better, and a box
// whose measure is above limit(query) is no hit.
template <class Query>
LENDULET_FORCE_INLINE void measure_block(const Query& query, const BoxBlock& block, float out[block_size]) {
    for (int half = 0; half < block_size; half += 4) {
        Float4 lower[3], upper[3];
        for (int d = 0; d < 3; ++d) {
            lower[d] = load_wide<Float4>(block.lower[d] + half);
            upper[d] = load_wide<Float4>(block.upper[d] + half);
        }
        store_wide(out + half, measure_wide(query, lower, upper));
    }
}

// Offers the boxes in the given lanes to the query; index[i] belongs to lane i.
template <class Query>
void offer_block(Query& query, const BoxBlock& block, uint32_t lanes, const uint32_t* index) {
    float at[block_size];
    measure_block(query, block, at);
    while (lanes) {
        int lane = take_bit(lanes);
        query.offer(at[lane], index[lane]);
    }
}

}  // namespace lendulet
