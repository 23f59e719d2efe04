// The boxes of a group a second time, each side as one byte: a step of a frame around them. Sixty-four boxes are six
// cache lines and as few comparisons, and what does not pass there needs no look at the boxes themselves.
//
// The step of x, trunc(clamp((x - centre) * scale)), never falls as x grows, wherever x is: a difference, a product
// with a positive number and both roundings keep order. So boxes that overlap also do in steps, in the frame of any
// group, far outside of it too, where all steps are one; what passes in steps is then compared exactly.
#pragma once

#include <cfloat>

#include "broad_phase/box.h"
#include "math/wide/bytes.h"
#include "math/wide/quads.h"

namespace lendulet {

using Quad = Wide<float, 4>;

inline constexpr int group_lanes = 64;  // boxes, the bits of a word
inline constexpr int bound_count = 6;   // lower x, y, z, upper x, y, z

// Lanes without a box have lower = 127 and upper = -128, which no step reaches: nothing overlaps them.
struct alignas(64) CoarseBoxes {
    int8_t bounds[bound_count][group_lanes];
    float centre[4], scale[4];  // the fourth takes what stands behind a box's sides, and gives no step
};

inline constexpr float first_step = -128.0f, last_step = 126.0f;

// The bounds of a box or a set of boxes.
struct Bounds6 {
    float at[bound_count];
};

// Steps as fine as they can be inside the bounds. Finite and positive scales, so that nothing becomes NaN.
LENDULET_FORCE_INLINE void set_frame(CoarseBoxes& coarse, const Bounds6& bounds) {
    const Quad lower{bounds.at[0], bounds.at[1], bounds.at[2], 0}, upper{bounds.at[3], bounds.at[4], bounds.at[5], 0};
    const Quad steps = splat<Quad>(250.0f), least = splat<Quad>(1e-30f), most = splat<Quad>(FLT_MAX);
    const Quad half = splat<Quad>(0.5f), zero = splat<Quad>(0.0f);
    Quad scale = steps / minimum(maximum(upper - lower, least), most), centre = half * lower + half * upper;
    centre = select(absolute(centre) <= most, centre, zero);  // of no boxes it is not a number
    centre[3] = 1.0f;  // an index read as a float may be denormal, and multiplying that is slow
    scale[3] = 0.0f;
    store_wide(coarse.centre, centre);
    store_wide(coarse.scale, scale);
}

LENDULET_FORCE_INLINE Wide<float, 4> steps_of(Wide<float, 4> sides, Wide<float, 4> centre, Wide<float, 4> scale) {
    return minimum(maximum((sides - centre) * scale, splat<Quad>(first_step)), splat<Quad>(last_step));
}

#if defined(__AVX512VL__)
// Both sides of a box side by side, for to_bytes, which sees to what lies below the first step.
LENDULET_FORCE_INLINE Wide<float, 8> eight_steps(const CoarseBoxes& frame, const BroadBox& box) {
    using Eight = Wide<float, 8>;
    const Eight steps = (load_wide<Eight>(box.lower) - load_quad_twice(frame.centre)) * load_quad_twice(frame.scale);
    return minimum(steps, splat<Eight>(last_step));
}
#endif

// The steps of a box: lower x, y, z, nothing, upper x, y, z, nothing, and those again.
LENDULET_FORCE_INLINE Bytes16 steps_of(const CoarseBoxes& frame, Wide<float, 4> lower, Wide<float, 4> upper) {
    const Quad centre = load_wide<Quad>(frame.centre), scale = load_wide<Quad>(frame.scale);
    const Quad low = steps_of(lower, centre, scale), high = steps_of(upper, centre, scale);
    return to_bytes(low, high, low, high);
}
LENDULET_FORCE_INLINE Bytes16 steps_of(const CoarseBoxes& frame, const BroadBox& box) {
#if defined(__AVX512VL__)
    return to_bytes(eight_steps(frame, box));
#else
    return steps_of(frame, load_wide<Quad>(box.lower), load_wide<Quad>(box.upper));
#endif
}

// The steps of a box as a word: lower x in its lowest byte, then as above.
LENDULET_FORCE_INLINE void store_steps(CoarseBoxes& coarse, uint32_t lane, uint64_t steps) {
    for (int k = 0; k < bound_count; ++k)
        coarse.bounds[k][lane] = static_cast<int8_t>(steps >> 8 * (k < 3 ? k : k + 1));
}

LENDULET_FORCE_INLINE void set_steps(CoarseBoxes& coarse, uint32_t lane, const BroadBox& box) {
    using Words = Wide<uint64_t, 2>;
    store_steps(coarse, lane, ((Words)steps_of(coarse, box))[0]);
}

// The steps of the box around two others, and of the second.
struct StepsOfTwo {
    uint64_t around, second;
};
LENDULET_FORCE_INLINE StepsOfTwo steps_of_two(const CoarseBoxes& frame, const BroadBox& a, const BroadBox& b) {
    using Words = Wide<uint64_t, 2>;
#if defined(__AVX512VL__)
    const Wide<float, 8> of_a = eight_steps(frame, a), of_b = eight_steps(frame, b);
    const Wide<float, 8> around =
        __builtin_shufflevector(minimum(of_a, of_b), maximum(of_a, of_b), 0, 1, 2, 3, 12, 13, 14, 15);
    return {((Words)to_bytes(around))[0], ((Words)to_bytes(of_b))[0]};
#else
    const Quad centre = load_wide<Quad>(frame.centre), scale = load_wide<Quad>(frame.scale);
    const Quad a_low = steps_of(load_wide<Quad>(a.lower), centre, scale),
               a_high = steps_of(load_wide<Quad>(a.upper), centre, scale),
               b_low = steps_of(load_wide<Quad>(b.lower), centre, scale),
               b_high = steps_of(load_wide<Quad>(b.upper), centre, scale);
    const Words words = (Words)to_bytes(minimum(a_low, b_low), maximum(a_high, b_high), b_low, b_high);
    return {words[0], words[1]};
#endif
}

inline void clear_steps(CoarseBoxes& coarse, uint32_t lane) {
    for (int d = 0; d < 3; ++d) {
        coarse.bounds[d][lane] = 127;
        coarse.bounds[3 + d][lane] = -128;
    }
}

}  // namespace lendulet
