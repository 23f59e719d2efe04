// The cuts of Overlap Minimizing Top-down bulk loading (Lee and Lee 2003; thesis 5.3): a set of boxes is divided by
// the centres of the boxes into as many parts of nearly equal count as its node has children.
#pragma once

#include <cstdint>
#include <cstring>

#include "math/wide/wide.h"

namespace lendulet {

// A box as the cuts see it: the coordinates of its centre as integers of the same order, since integers are compared
// without branches together with the slot that breaks ties; so every division has exactly one result.
struct alignas(16) BoxCentre {
    int32_t at[3];
    uint32_t slot;
};

// Integers in the order of floats, and back; -0 counts as +0.
inline int32_t ordered(float x) {
    x += 0.0f;
    int32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits ^ (bits >> 31 & 0x7fffffff);
}
inline Wide<int32_t, 4> ordered(Wide<float, 4> x) {
    x += 0.0f;
    Wide<int32_t, 4> bits = (Wide<int32_t, 4>)x;
    return bits ^ (bits >> 31 & 0x7fffffff);
}
inline float from_ordered(int32_t bits) {
    bits ^= bits >> 31 & 0x7fffffff;
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

// Where part k of `count` things begins when they are cut into `parts` of nearly equal size, the smaller ones first.
constexpr int part_begin(int count, int parts, int k) {
    int size = count / parts, smaller = parts - count % parts;
    return k * size + (k > smaller ? k - smaller : 0);
}

// Reorders the boxes so that those of child k of `fan_out` (1 to 8) stand in [part_begin(k), part_begin(k + 1)).
void omt_divide(BoxCentre* boxes, int count, int fan_out);

// Reorders so that the first `wanted` boxes are the smallest by (at[axis], slot). Linear time on average,
// count * log(count) at worst. Exposed for tests.
void select_smallest(BoxCentre* boxes, int count, int wanted, int axis);

}  // namespace lendulet
