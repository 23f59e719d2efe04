#include "broad_phase/sort.h"

#include <algorithm>
#include <utility>

namespace lendulet {

namespace {

// By digits of so many bits, the lowest first.
template <int digit>
void sort_by_digits(Array<uint64_t>& keys, Array<uint64_t>& swap, int first_bit) {
    constexpr int radix = 1 << digit;
    uint64_t differing = 0;
    for (uint64_t key : keys) differing |= key ^ keys[0];
    swap.resize_unset(keys.size());
    for (int shift = first_bit; shift < 64; shift += digit) {
        if ((differing >> shift & (radix - 1)) == 0) continue;  // all the same here
        uint32_t place[radix] = {};
        for (uint64_t key : keys) ++place[key >> shift & (radix - 1)];
        uint32_t begin = 0;
        for (uint32_t& p : place) begin += std::exchange(p, begin);
        for (uint64_t key : keys) swap[place[key >> shift & (radix - 1)]++] = key;
        keys.swap(swap);
    }
}

}  // namespace

void sort_keys(Array<uint64_t>& keys, Array<uint64_t>& swap, int first_bit) {
    // Measured: below, clearing and summing the histograms costs more.
    constexpr size_t small_digits_pay_from = 64, large_digits_pay_from = 1500;
    if (keys.size() < small_digits_pay_from) {
        std::sort(keys.begin(), keys.end());  // order: total, keys that are equal cannot be told apart
        return;
    }
    keys.size() < large_digits_pay_from ? sort_by_digits<8>(keys, swap, first_bit)
                                        : sort_by_digits<11>(keys, swap, first_bit);
}

void append_missing(const Array<uint64_t>& from, const Array<uint64_t>& in, Array<BoxPair>& out) {
    size_t next = 0;
    for (uint64_t key : from) {
        while (next < in.size() && in[next] < key) ++next;
        if (next < in.size() && in[next] == key) continue;
        out.push_back({static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)});
    }
}

}  // namespace lendulet
