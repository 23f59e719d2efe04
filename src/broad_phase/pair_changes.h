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

// A structure as PairChanges sees it.
class ChangingStructure {
public:
    virtual int moving_count() const = 0;
    virtual BroadBox moving_box(int place) const = 0;
    virtual void change(const BoxChanges& changes) = 0;
    // Append all pairs, and those of some boxes.
    virtual void find_pairs(Array<BoxPair>& out) = 0;
    virtual void find_pairs_of(const Array<BroadBox>& boxes, PairChunks& chunks, Array<BoxPair>& out) = 0;

protected:
    ~ChangingStructure() = default;
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
        Adapted<Structure> adapted(structure, tasks);
        update(adapted, changes, share, begun, ended);
    }

    // The structure has been set otherwise: what was kept of its pairs is of no use.
    void forget() { known_ = false; }

    size_t bytes() const {
        return before_.bytes() + after_.bytes() + swap_.bytes() + pairs_.bytes() + touched_.bytes() + chunks_.bytes();
    }

private:
    template <class Structure>
    class Adapted;
    void update(ChangingStructure& structure, const BoxChanges& changes, int share, Array<BoxPair>& begun,
                Array<BoxPair>& ended);
    void pairs_of_touched(ChangingStructure& structure, Array<uint64_t>& keys);
    void all_pairs(ChangingStructure& structure, Array<uint64_t>& keys);
    void sorted_keys(Array<uint64_t>& keys);  // of pairs_, without those of a box and itself

    Array<uint64_t> before_, after_, swap_;  // a << 32 | b
    Array<BoxPair> pairs_;
    Array<BroadBox> touched_;
    PairChunks chunks_;
    bool known_ = false;  // `before_` holds the pairs of the structure's present state
};

template <class Structure>
class PairChanges::Adapted final : public ChangingStructure {
public:
    Adapted(Structure& structure, TaskPool& tasks) : structure_(structure), tasks_(tasks) {}
    int moving_count() const override { return structure_.moving_count(); }
    BroadBox moving_box(int place) const override { return structure_.moving_box(place); }
    void change(const BoxChanges& changes) override {
        if constexpr (requires { structure_.change_moving(changes, tasks_); })
            structure_.change_moving(changes, tasks_);
        else structure_.set_moving(changes.boxes, changes.count, &tasks_);
    }
    void find_pairs(Array<BoxPair>& out) override { structure_.find_pairs(tasks_, out); }
    void find_pairs_of(const Array<BroadBox>& boxes, PairChunks& chunks, Array<BoxPair>& out) override {
        if constexpr (requires { structure_.find_pairs_of(tasks_, boxes.data(), 0, out); }) {
            structure_.find_pairs_of(tasks_, boxes.data(), boxes.count(), out);
        } else {
            constexpr int grain = 64;
            chunks.search(tasks_, boxes.count(), grain, out, [&](int begin, int end, PairList& list) {
                for (int i = begin; i < end; ++i) {
                    const BroadBox& box = boxes[i];
                    structure_.visit_overlapping(box.lower, box.upper, Meetings(list, box.index, true));
                }
            });
        }
    }

private:
    Structure& structure_;
    TaskPool& tasks_;
};

}  // namespace lendulet
