#include "broad_phase/pair_changes.h"

#include "broad_phase/sort.h"

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

// Appends what stands in one sorted list and not in the other.
void PairChanges::append_missing(const Array<uint64_t>& from, const Array<uint64_t>& in, Array<BoxPair>& out) {
    size_t place = 0;
    for (uint64_t key : from) {
        while (place < in.size() && in[place] < key) ++place;
        if (place < in.size() && in[place] == key) continue;
        out.push_back({static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)});
    }
}

}  // namespace lendulet
