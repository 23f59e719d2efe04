#include "broad_phase/sweep/interval_order.h"

#include <utility>

#include "broad_phase/block.h"

namespace lendulet {

namespace {

// A hundred keys are dealt to one or two hundred drawers, by where they lie between the smallest and the largest
// coordinate; that leaves little to repair. Does nothing where the coordinates are too far apart.
constexpr size_t radix_pays_from = 400;
void deal_into_drawers(Array<uint64_t>& keys, Array<uint64_t>& swap) {
    constexpr int most_drawers = 256;
    size_t n = keys.size();
    const int drawers = n <= most_drawers / 2 ? most_drawers / 2 : most_drawers;
    uint64_t least = keys[0], most = keys[0];
    for (uint64_t key : keys) {
        least = key < least ? key : least;
        most = key > most ? key : most;
    }
    float from = float_of(static_cast<uint32_t>(least >> 32)), to = float_of(static_cast<uint32_t>(most >> 32));
    float scale = static_cast<float>(drawers - 1) / (to - from);
    if (!(scale > 0 && scale < infinity)) return;
    // Rounds monotonically, and never above the last drawer: (to - from) * scale is drawers - 1 within rounding.
    auto drawer = [&](uint64_t key) {
        int d = static_cast<int>((float_of(static_cast<uint32_t>(key >> 32)) - from) * scale);
        return d < drawers ? d : drawers - 1;
    };
    uint16_t place[most_drawers] = {};
    for (uint64_t key : keys) ++place[drawer(key)];
    uint16_t begin = 0;
    for (int d = 0; d < drawers; ++d) begin = static_cast<uint16_t>(begin + std::exchange(place[d], begin));
    swap.resize_unset(n);
    for (uint64_t key : keys) swap[place[drawer(key)]++] = key;
    keys.swap(swap);
}

}  // namespace

// Each is compared with each, four at a time, and goes where the number of smaller ones says: those of the same
// coordinate count if their place is smaller. No branch depends on the keys.
void IntervalOrder::sort_handful() {
    const size_t n = keys_.size();
    if (n < 2) return;
    n <= 8 ? sort_fours<2>() : n <= 12 ? sort_fours<3>() : sort_fours<handful / 4>();
}

template <size_t vectors>
void IntervalOrder::sort_fours() {
    using Int4 = Wide<int32_t, 4>;
    const size_t n = keys_.size();
    alignas(16) int32_t at[4 * vectors], smaller[4 * vectors];  // signed integers of the order of the coordinates
    for (size_t i = 0; i < n; ++i) at[i] = static_cast<int32_t>((keys_[i] >> 32) ^ 0x80000000u);
    for (size_t i = n; i < 4 * vectors; ++i) at[i] = 0;
    // From where it is read for key j: -1 in the lanes behind it. There equal ones count: what is above other - 1.
    static constexpr int32_t behind[2 * handful] = {0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,
                                                    -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    auto load = [](const int32_t* p) {
        Int4 x;
        std::memcpy(&x, p, sizeof x);
        return x;
    };
    Int4 mine[vectors], count[vectors] = {};
    for (size_t v = 0; v < vectors; ++v) mine[v] = load(at + 4 * v);
    for (size_t j = 0; j < n; ++j) {
        const Int4 other = Int4{} + at[j];
        for (size_t v = 0; v < vectors; ++v) count[v] -= mine[v] > other + load(behind + handful - 1 - j + 4 * v);
    }
    for (size_t v = 0; v < vectors; ++v) std::memcpy(smaller + 4 * v, &count[v], sizeof count[v]);
    swap_.resize_unset(n);
    for (size_t i = 0; i < n; ++i) swap_[static_cast<size_t>(smaller[i])] = keys_[i];
    keys_.swap(swap_);
}

void IntervalOrder::repair_or_sort() {
    size_t n = keys_.size(), descents = 0;
    for (size_t i = 1; i < n; ++i) descents += keys_[i] < keys_[i - 1];
    if (descents == 0) return;
    // Insertion takes time for every box passed. A sequence of which one key in eight is smaller than the one before is
    // not worth it; nor is one in which a few keys pass thousands, which is only seen while at it.
    if (descents > n / 8) {
        if (n >= radix_pays_from) return sort_keys(keys_, swap_);
        deal_into_drawers(keys_, swap_);
    }
    size_t passed = 0;
    for (size_t i = 1; i < n; ++i) {
        uint64_t key = keys_[i];
        size_t at = i;
        for (; at > 0 && keys_[at - 1] > key; --at) keys_[at] = keys_[at - 1];
        keys_[at] = key;
        passed += i - at;
        if (passed > 8 * n) return sort_keys(keys_, swap_);
    }
}

bool IntervalOrder::sorted() const {
    for (size_t i = 1; i < keys_.size(); ++i) {
        if (keys_[i] <= keys_[i - 1]) return false;
    }
    return true;
}

}  // namespace lendulet
