// The broad phase of two R-trees, one for the boxes that move and one for those that do not (thesis 5.2, 5.3). The tree
// of the moving boxes keeps its shape while that stays good: then a step only recomputes bounds.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"
#include "broad_phase/rtree/box_tree.h"

namespace lendulet {

class RtreeOmt {
public:
    explicit RtreeOmt(const Memory* memory);

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    int moving_count() const { return moving_boxes_.count(); }
    BroadBox moving_box(int place) const { return moving_boxes_[place]; }

    // Bulk loads of the moving set so far, for tests and statistics.
    int builds() const { return builds_; }

private:
    void pairs_of_unbounded(Array<BoxPair>& out) const;

    BoxTree fixed_, moving_;
    Array<BroadBox> moving_boxes_;
    int refits_ = 0, builds_ = 0;
    PairChunks chunks_;
    PairChanges changes_;
};

template <class Visit>
void RtreeOmt::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    for (const BoxTree* tree : {&moving_, &fixed_}) {
        for (const BroadBox& box : tree->unbounded()) {
            if (overlap(box, lower, upper)) visit(box.index);
        }
        tree->visit_overlapping(lower, upper, visit);
    }
}

}  // namespace lendulet
