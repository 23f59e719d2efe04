// Which pairs begin and which end when some boxes change: the part of BroadPhase::update that most structures share.
//
// Pairs that begin or end have a changed box. So where few boxes changed, their pairs are looked up before and after,
// and the two lists compared; the time goes with the number of changed boxes. Where many did, all pairs are found
// before and after; then the list after is kept, for it is the list before of the next time.
//
// A structure for this has moving_count(), moving_box(place) (as it was last set), visit_overlapping(), set_moving(),
// find_pairs(), and optionally change_moving(changes, tasks), which is told what changed, and
// find_pairs_of(tasks, boxes, count, out), the pairs of some boxes with both sets; it may give pairs twice and those
// of a box with itself.
#pragma once

#include <algorithm>

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/sort.h"

namespace lendulet {

// What BroadPhase::update is given.
struct BoxChanges {
    const BroadBox* boxes;
    int count;
    const uint32_t* changed;
    int changed_count;

    // The i-th place that differs, if all from `from` to `to` are new or gone: first those listed.
    uint32_t place(int i, int listed, int from) const {
        return i < listed ? changed[i] : static_cast<uint32_t>(from + i - listed);
    }
    // How many places below `end` are listed.
    int listed_below(int end) const {
        return static_cast<int>(std::lower_bound(changed, changed + changed_count, static_cast<uint32_t>(end)) -
                                changed);
    }
};

class PairChanges {
public:
    explicit PairChanges(const Memory* memory)
        : before_(memory), after_(memory), swap_(memory), pairs_(memory), touched_(memory), chunks_(memory) {}

    // Brings the structure to its new state and appends the pairs that begin and that end, each sorted. Looks up single
    // boxes while fewer than one in `share` of them changed.
    template <class Structure>
    void update(Structure& structure, TaskPool& tasks, const BoxChanges& changes, int share, Array<BoxPair>& begun,
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
            pairs_of_touched(structure, tasks, before_);
        } else if (!known_) {
            all_pairs(structure, tasks, before_);
        }
        if constexpr (requires { structure.change_moving(changes, tasks); }) structure.change_moving(changes, tasks);
        else structure.set_moving(changes.boxes, changes.count, &tasks);
        if (few) {
            touched_.clear();
            for (int i = 0; i < listed + fresh; ++i)
                touched_.push_back(changes.boxes[changes.place(i, listed, common)]);
            pairs_of_touched(structure, tasks, after_);
        } else {
            all_pairs(structure, tasks, after_);
        }
        append_differences(after_, before_, begun, ended);
        known_ = !few;
        if (known_) before_.swap(after_);
    }

    // The structure has been set otherwise: what was kept of its pairs is of no use.
    void forget() { known_ = false; }

    size_t bytes() const {
        return before_.bytes() + after_.bytes() + swap_.bytes() + pairs_.bytes() + touched_.bytes() + chunks_.bytes();
    }

private:
    // The pairs of the boxes in touched_, sorted, each once.
    template <class Structure>
    void pairs_of_touched(Structure& structure, TaskPool& tasks, Array<uint64_t>& keys) {
        constexpr int grain = 64;
        pairs_.clear();
        if constexpr (requires { structure.find_pairs_of(tasks, touched_.data(), 0, pairs_); }) {
            structure.find_pairs_of(tasks, touched_.data(), touched_.count(), pairs_);
            return sorted_keys(keys);
        }
        chunks_.search(tasks, touched_.count(), grain, pairs_, [&](int begin, int end, PairList& list) {
            for (int i = begin; i < end; ++i) {
                const BroadBox& box = touched_[i];
                structure.visit_overlapping(box.lower, box.upper,
                                            [&](uint32_t other) { PairWriter(list, 1).write(box.index, other); });
            }
        });
        sorted_keys(keys);
    }
    template <class Structure>
    void all_pairs(Structure& structure, TaskPool& tasks, Array<uint64_t>& keys) {
        pairs_.clear();
        structure.find_pairs(tasks, pairs_);
        sorted_keys(keys);
    }
    void sorted_keys(Array<uint64_t>& keys);  // of pairs_, without those of a box and itself

    Array<uint64_t> before_, after_, swap_;  // a << 32 | b
    Array<BoxPair> pairs_;
    Array<BroadBox> touched_;
    PairChunks chunks_;
    bool known_ = false;  // `before_` holds the pairs of the structure's present state
};

}  // namespace lendulet
