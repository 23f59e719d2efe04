#include "broad_phase/pair_changes.h"

#include <algorithm>

#include "broad_phase/sort.h"

namespace lendulet {

void PairChanges::update(ChangingStructure& structure, const BoxChanges& changes, int share, Array<BoxPair>& begun,
                         Array<BoxPair>& ended) {
    int old_count = structure.moving_count(), common = std::min(old_count, changes.count);
    int listed = changes.listed_below(common);
    int gone = old_count - common, fresh = changes.count - common;
    bool few = (static_cast<int64_t>(listed) + gone + fresh) * share < changes.count;
    touched_.reserve(static_cast<size_t>(changes.count / share) + 1);  // so that later updates need not grow it
    if (few) {
        touched_.clear();
        for (int i = 0; i < listed + gone; ++i) {
            touched_.push_back(structure.moving_box(static_cast<int>(changes.place(i, listed, common))));
        }
        pairs_of_touched(structure, before_);
    } else if (!known_) {
        all_pairs(structure, before_);
    }
    structure.change(changes);
    if (few) {
        touched_.clear();
        for (int i = 0; i < listed + fresh; ++i) touched_.push_back(changes.boxes[changes.place(i, listed, common)]);
        pairs_of_touched(structure, after_);
    } else {
        all_pairs(structure, after_);
    }
    append_differences(after_, before_, begun, ended);
    known_ = !few;
    if (known_) before_.swap(after_);
}

// The pairs of the boxes in touched_, sorted, each once.
void PairChanges::pairs_of_touched(ChangingStructure& structure, Array<uint64_t>& keys) {
    pairs_.clear();
    structure.find_pairs_of(touched_, chunks_, pairs_);
    sorted_keys(keys);
}

void PairChanges::all_pairs(ChangingStructure& structure, Array<uint64_t>& keys) {
    pairs_.clear();
    structure.find_pairs(pairs_);
    sorted_keys(keys);
}

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
