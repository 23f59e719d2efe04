// Which of the fifteen separating axes of two boxes can be the best: all of them at once, in four lanes of single
// precision, up to what rounding may change. Doubles, of which a register holds two, then decide among the few that are
// left. In an unnamed namespace, as the formulas of the axes are, which other sources compile for wider lanes.
#pragma once

#include "collision/batch/frame.h"
#include "collision/box_difference.h"
#include "math/wide/gather.h"

namespace lendulet {
namespace {

using Four = Wide<float, 4>;  // the last lane is not used
// Each number's place is taken by the next one, and by the last one.
LENDULET_FORCE_INLINE Four of_next(Four a) { return __builtin_shufflevector(a, a, 1, 2, 0, 3); }
LENDULET_FORCE_INLINE Four of_last(Four a) { return __builtin_shufflevector(a, a, 2, 0, 1, 3); }
LENDULET_FORCE_INLINE float largest(Four a) { return maximum(maximum(a[0], a[1]), a[2]); }
LENDULET_FORCE_INLINE Four to_four(Lanes a) {
    return __builtin_convertvector(__builtin_shufflevector(a.xy, a.z, 0, 1, 2, 3), Four);
}
LENDULET_FORCE_INLINE uint32_t places(Four a, float least) { return mask_bits(a >= repeat<Four>(least)) & 7u; }

#include "collision/batch/box_axes.inl"

// Cosine above which two edges count as parallel, as least_sine_squared has it.
constexpr float parallel_edges = 1.0f - 5.1e-6f;
// Of S: what two separations in single precision may be off. Each is made of products of a half extent or a coordinate
// with numbers of at most the sine between the edges, of which |r_1| |x_2| + |r_2| |x_1| <= sqrt(2) sine |x|; with the
// quotient that is 12 roundings of 2^-24 at most, 7.2e-7 of S.
constexpr float doubt_of_two = 1.6e-6f;

// Bit k is set where axis k, numbered as in BestAxis, may be the one along which the boxes are farthest apart, or
// overlap least. 0: edges or faces are parallel, or something is not a number.
LENDULET_FORCE_INLINE uint32_t best_candidates(const BoxDifference& boxes) {
    const Four c[3] = {to_four(boxes.edge[3]), to_four(boxes.edge[4]), to_four(boxes.edge[5])};
    const Four rows[3] = {to_four(boxes.row[0]), to_four(boxes.row[1]), to_four(boxes.row[2])};
    const Four columns[3] = {absolute(c[0]), absolute(c[1]), absolute(c[2])};
    const Four ar[3] = {absolute(rows[0]), absolute(rows[1]), absolute(rows[2])};
    const Four along_a = to_four(boxes.t), half_b = to_four(boxes.half_b);
    const float *halves_a = boxes.half, *halves_b = boxes.half + 3, along[3] = {along_a[0], along_a[1], along_a[2]};
    const Four along_b = along[0] * rows[0] + along[1] * rows[1] + along[2] * rows[2];
    const Four b_next = of_next(half_b), b_last = of_last(half_b);
    auto of_edge = [&](int i, int i1, int i2) {
        const EdgePair<Four, float> e{along[i1], along[i2], halves_a[i1], halves_a[i2], rows[i1],       rows[i2],
                                      ar[i1],    ar[i2],    b_next,       b_last,       of_next(ar[i]), of_last(ar[i])};
        return e.separation_times_sine() / square_root(e.sine_squared());
    };
    const Four s[5] = {face_separation(along_a, to_four(boxes.half_a), halves_b, columns),
                       face_separation(along_b, half_b, halves_a, ar), of_edge(0, 1, 2), of_edge(1, 2, 0),
                       of_edge(2, 0, 1)};
    if (!(largest(maximum(columns[0], maximum(columns[1], columns[2]))) < parallel_edges)) return 0;
    const float most = largest(maximum(maximum(maximum(s[0], s[1]), maximum(s[2], s[3])), s[4]));
    const float least = most - doubt_of_two * static_cast<float>(boxes.size);
    return places(s[0], least) | places(s[1], least) << 3 | places(s[2], least) << 6 | places(s[3], least) << 9 |
           places(s[4], least) << 12;
}

}  // namespace
}  // namespace lendulet
