#include "broad_phase/sort.h"

#include <algorithm>
#include <utility>

#include "math/unbranched.h"

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

// A handful: each key's place is the number of those below it. Without a branch that depends on a key.
void sort_by_rank(Array<uint64_t>& keys) {
    constexpr size_t most = 32;
    const size_t n = keys.size();
    uint64_t old[most];
    uint32_t rank[most];
    for (size_t i = 0; i < n; ++i) {
        const uint64_t key = old[i] = keys[i];
        uint32_t below = 0;
        for (size_t j = 0; j < i; ++j) {
            const bool less = old[j] <= key;
            below += less;
            rank[j] += !less;
        }
        rank[i] = below;
    }
    for (size_t i = 0; i < n; ++i) keys[rank[i]] = old[i];
}

// Keys that are spread evenly, by their highest bits that differ into a few times as many buckets as keys and each to
// its place from there. False where too many share a bucket; nothing has changed then.
bool sort_by_buckets(Array<uint64_t>& keys, Array<uint64_t>& swap) {
    constexpr int most_bits = 12, most_together = 24;
    uint64_t low = keys[0], high = keys[0];
    for (uint64_t key : keys) {
        low = key < low ? key : low;
        high = key > high ? key : high;
    }
    const int bits = std::min(most_bits, 65 - __builtin_clzll(keys.size()));
    const int span = high > low ? 64 - __builtin_clzll(high - low) : 1;
    const int shift = span > bits ? span - bits : 0;
    uint32_t place[1 << most_bits];
    const size_t buckets = static_cast<size_t>((high - low) >> shift) + 1;
    std::memset(place, 0, buckets * sizeof place[0]);
    for (uint64_t key : keys) ++place[(key - low) >> shift];
    uint32_t begin = 0, most = 0;
    for (size_t b = 0; b < buckets; ++b) {
        most = std::max(most, place[b]);
        begin += std::exchange(place[b], begin);
    }
    if (most > most_together) return false;
    swap.resize_unset(keys.size());
    for (uint64_t key : keys) swap[place[(key - low) >> shift]++] = key;
    keys.swap(swap);
    uint64_t* sorted = keys.data();
    for (size_t i = 1; i < keys.size(); ++i) {
        const uint64_t key = sorted[i];
        size_t at = i;
        for (; at > 0 && sorted[at - 1] > key; --at) sorted[at] = sorted[at - 1];
        sorted[at] = key;
    }
    return true;
}

}  // namespace

void sort_keys(Array<uint64_t>& keys, Array<uint64_t>& swap, int first_bit) {
    // Measured: below, clearing and summing the histograms costs more.
    constexpr size_t ranks_pay_to = 32, buckets_pay_to = 8192;
    constexpr size_t small_digits_pay_from = 64, large_digits_pay_from = 1500;
    if (keys.size() <= ranks_pay_to) return sort_by_rank(keys);
    if (keys.size() <= buckets_pay_to && sort_by_buckets(keys, swap)) return;
    if (keys.size() < small_digits_pay_from) {
        std::sort(keys.begin(), keys.end());  // order: total, keys that are equal cannot be told apart
        return;
    }
    keys.size() < large_digits_pay_from ? sort_by_digits<8>(keys, swap, first_bit)
                                        : sort_by_digits<11>(keys, swap, first_bit);
}

// Which of two keys comes first cannot be foreseen: both are written, and what was to be written stays.
void append_differences(const Array<uint64_t>& a, const Array<uint64_t>& b, Array<BoxPair>& only_in_a,
                        Array<BoxPair>& only_in_b) {
    auto pair_of = [](uint64_t key) { return BoxPair{static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)}; };
    auto room = [](Array<BoxPair>& out, size_t more) {
        out.reserve(out.size() + more);
        return out.data() + out.size();
    };
    BoxPair *next_a = room(only_in_a, a.size()), *next_b = room(only_in_b, b.size());
    size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        const uint64_t of_a = a[i], of_b = b[j];
        *next_a = pair_of(of_a);
        *next_b = pair_of(of_b);
        next_a += one_if(of_a < of_b);
        next_b += one_if(of_b < of_a);
        i += one_if(of_a <= of_b);
        j += one_if(of_b <= of_a);
    }
    for (; i < a.size(); ++i) *next_a++ = pair_of(a[i]);
    for (; j < b.size(); ++j) *next_b++ = pair_of(b[j]);
    only_in_a.resize_unset(static_cast<size_t>(next_a - only_in_a.data()));
    only_in_b.resize_unset(static_cast<size_t>(next_b - only_in_b.data()));
}

}  // namespace lendulet
