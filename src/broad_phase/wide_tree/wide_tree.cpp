#include "broad_phase/wide_tree/wide_tree.h"

#include <algorithm>

#include "broad_phase/sort.h"

namespace lendulet {

WideTree::WideTree(const Memory* memory, int width)
    : kernels_(wide_tree_kernels(width)),
      fixed_(memory, kernels_),
      moving_(memory, kernels_),
      chunks_(memory),
      special_(memory),
      removed_(memory),
      changes_(memory),
      found_(memory),
      lost_(memory),
      begun_(memory),
      ended_(memory),
      swap_(memory) {}

void WideTree::set_fixed(const BroadBox* boxes, int count, TaskPool* tasks) { fixed_.build(boxes, count, tasks); }

void WideTree::set_moving(const BroadBox* boxes, int count, TaskPool* tasks) {
    moving_.build(boxes, count, tasks);
    ++builds_;
}

void WideTree::move_all(const BroadBox* boxes, int count, TaskPool* tasks) {
    if (!moving_.refill(boxes, count, tasks)) set_moving(boxes, count, tasks);
}

void WideTree::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 4;  // groups
    const WideTreeView moving = moving_.view(), fixed = fixed_.view();
    chunks_.search(tasks, moving.group_count, grain, out, [&](int begin, int end, PairList& list) {
        PairRoom room(list);
        kernels_.find_pairs(moving, fixed, begin, end, room);
    });
    pairs_of_unbounded(out);
}

// Unbounded boxes are few: each is tested against the others and taken through the trees.
void WideTree::pairs_of_unbounded(Array<BoxPair>& out) const {
    const Array<BroadBox>& moving = moving_.unbounded();
    for (int i = 0; i < moving.count(); ++i) {
        const BroadBox& box = moving[i];
        auto meet = [&](uint32_t other) {
            out.push_back(box.index < other ? BoxPair{box.index, other} : BoxPair{other, box.index});
        };
        for (int j = i + 1; j < moving.count(); ++j) {
            if (overlap(moving[j], box.lower, box.upper)) meet(moving[j].index);
        }
        for (const BroadBox& other : fixed_.unbounded()) {
            if (overlap(other, box.lower, box.upper)) meet(other.index);
        }
        visit_bounded(moving_, box.lower, box.upper, meet);
        visit_bounded(fixed_, box.lower, box.upper, meet);
    }
    for (const BroadBox& box : fixed_.unbounded()) {
        auto meet = [&](uint32_t other) {
            out.push_back(box.index < other ? BoxPair{box.index, other} : BoxPair{other, box.index});
        };
        visit_bounded(moving_, box.lower, box.upper, meet);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Queries

void WideTree::find_hits(const BoxQuery* queries, int begin, int end, PairList& out) const {
    for (const WideTreeSet* set : {&moving_, &fixed_}) {
        for (const BroadBox& box : set->unbounded()) {
            for (int i = begin; i < end; ++i) {
                if (!overlap(box, queries[i].lower, queries[i].upper)) continue;
                PairWriter(out, 1).write_as_it_is(static_cast<uint32_t>(i), box.index);
            }
        }
        if (set->count() == set->unbounded().count()) continue;
        PairRoom room(out);
        kernels_.find_hits(set->view(), queries, begin, end, room);
    }
}

void WideTree::cast(BoxCast& cast) const {
    for (const WideTreeSet* set : {&moving_, &fixed_}) {
        for (const BroadBox& box : set->unbounded()) cast.offer(measure(cast, box.lower, box.upper), box.index);
        kernels_.cast(set->view(), cast);
    }
}

void WideTree::nearest(NearestBox& nearest) const {
    for (const WideTreeSet* set : {&moving_, &fixed_}) {
        for (const BroadBox& box : set->unbounded()) nearest.offer(measure(nearest, box.lower, box.upper), box.index);
        kernels_.nearest(set->view(), nearest);
    }
}

// The bounded boxes of a set. All are finite: an infinite side reaches no farther than the largest float, and no empty
// lane.
void WideTree::visit_groups_of(const WideTreeSet& set, const float lower[3], const float upper[3], Visitor visit,
                               void* context) const {
    if (set.count() == set.unbounded().count()) return;
    struct Batch : IndexStream {
        uint32_t hits[4 * group_lanes];
        Visitor visit;
        void* context;
        void drain() {
            for (const uint32_t* hit = hits; hit < next; ++hit) visit(context, *hit);
            next = hits;
        }
    };
    Batch batch;
    batch.next = batch.hits;
    batch.end = batch.hits + 4 * group_lanes;
    batch.full = [](IndexStream& stream) { static_cast<Batch&>(stream).drain(); };
    batch.visit = visit;
    batch.context = context;
    Bounds6 bounds;
    for (int d = 0; d < 3; ++d) {
        bounds.at[d] = maximum(lower[d], -FLT_MAX);
        bounds.at[3 + d] = minimum(upper[d], FLT_MAX);
    }
    kernels_.find_overlapping(set.view(), bounds, batch);
    batch.drain();
}

void WideTree::boxes(Array<BroadPhaseBox>& out) const {
    moving_.boxes(out);
    fixed_.boxes(out);
}

size_t WideTree::bytes() const {
    return moving_.bytes() + fixed_.bytes() + chunks_.bytes() + special_.bytes() + removed_.bytes() + changes_.bytes() +
           found_.bytes() + lost_.bytes() + begun_.bytes() + ended_.bytes() + swap_.bytes();
}

const char* WideTree::check() const {
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

}  // namespace lendulet
