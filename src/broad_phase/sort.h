// The sort of all sweeps and pair lists: keys of 64 bits, by radix where there are many.
#pragma once

#include <cstdint>
#include <cstring>

#include "base/memory.h"
#include "broad_phase/box.h"

namespace lendulet {

// Unsigned integers in the order of floats; -0 counts as +0.
inline uint32_t ordered_bits(float x) {
    x += 0.0f;
    uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

inline float float_of(uint32_t ordered) {
    uint32_t bits = ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered;
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

// Sorts keys by their bits from `first_bit` on; the order of keys equal there is left as it is if all of them stand in
// rising order before, else unspecified only for keys that are equal altogether. The sorted keys are left in `keys`,
// whose memory may have changed hands with that of `swap`.
void sort_keys(Array<uint64_t>& keys, Array<uint64_t>& swap, int first_bit = 0);

// Appends the pairs whose keys a << 32 | b stand in one of two sorted lists and not in the other. One that stands in a
// list several times counts as often, less the times it stands in the other.
void append_differences(const Array<uint64_t>& a, const Array<uint64_t>& b, Array<BoxPair>& only_in_a,
                        Array<BoxPair>& only_in_b);

}  // namespace lendulet
