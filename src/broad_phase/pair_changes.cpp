#include "broad_phase/pair_changes.h"

namespace lendulet {

void PairChanges::sorted_keys(Array<uint64_t>& keys) {
    keys.resize_unset(pairs_.size());
    size_t n = 0;
    for (const BoxPair& pair : pairs_) {
        if (pair.a != pair.b) keys[n++] = uint64_t{pair.a} << 32 | pair.b;
    }
    keys.resize_unset(n);
    sort_keys(keys, swap_);
    keys.resize_unset(static_cast<size_t>(std::unique(keys.begin(), keys.end()) - keys.begin()));
}

}  // namespace lendulet
