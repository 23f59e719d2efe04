#include "broad_phase/sweep/interval_order.h"

namespace lendulet {

void IntervalOrder::repair_or_sort() {
    constexpr size_t few = 24;  // insertion beats any other sort
    size_t n = keys_.size();
    if (n > few) {
        // Insertion takes time for every box passed. A sequence of which one key in eight is smaller than the one
        // before is not worth it; nor is one in which a few keys pass thousands, which is only seen while at it.
        size_t descents = 0;
        for (size_t i = 1; i < n; ++i) descents += keys_[i] < keys_[i - 1];
        if (descents == 0) return;
        if (descents > n / 8) return sort_keys(keys_, swap_);
    }
    size_t passed = 0;
    for (size_t i = 1; i < n; ++i) {
        uint64_t key = keys_[i];
        size_t at = i;
        for (; at > 0 && keys_[at - 1] > key; --at) keys_[at] = keys_[at - 1];
        keys_[at] = key;
        passed += i - at;
        if (passed > 8 * n && n > few) return sort_keys(keys_, swap_);
    }
}

bool IntervalOrder::sorted() const {
    for (size_t i = 1; i < keys_.size(); ++i) {
        if (keys_[i] <= keys_[i - 1]) return false;
    }
    return true;
}

}  // namespace lendulet
