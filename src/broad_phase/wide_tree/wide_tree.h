// The broad phase named "default": boxes in groups of 64 that lie close together, sixteen groups or blocks to a block
// of bounds above them, no pointers. Everything is tested as many at a time as the machine's vectors hold, and where a
// loop may meet a hit or not it notes bits instead of branching. wide_tree_order.h says how boxes get their order,
// wide_tree_set.h how they keep it from frame to frame, wide_tree_pairs.inl and wide_tree_changes.inl how pairs are
// found, wide_tree_batch.inl how many boxes are searched together.
//
// Beside the boxes of a group stand their sides as bytes (coarse_boxes.h): 384 of them, which searches look at first.
// Groups, not single boxes, are what is tested against the tree: a box of the acceptance set (half extents .25 to .5,
// centres in a cube of side 1.5 n^(1/3)) takes one test of bytes against its own group and some against those next to
// it. A test is six comparisons of 64 bytes with AVX-512, twelve of 32 or 24 of 16 without; it lets a tenth more boxes
// pass than overlap, and what passes is compared exactly, box by box.
//
// How far from what the machine can do (10 000 boxes, one core of an Emerald Rapids at 2.85 GHz, sixteen lanes,
// measured): building and searching takes 36 ns a box, 103 cycles. Comparisons of bytes are one a cycle, so its own
// group costs a box six cycles; the rest of the search is the boxes that reach into neighbours, the ends of loops and
// the writing of pairs. A build reads the 32 bytes of a box twice and writes them once, and the 16 of its centre are
// read seven times.
//
// A frame in which 5 % of the boxes move. A changed box is near 1.5 groups besides its own of 16 and near two of those
// of a hundred thousand boxes, and is tested against each once, as the box around what it was and is: 15 to 18
// comparisons of 64 bytes over as many lines, then one or two boxes of 32 bytes in both states, beside its own 64 of
// before and after and the tests of one to four blocks above, six comparisons each. The comparisons alone would be 20
// to 40 cycles; a changed box takes 190 at 1000 boxes, 250 at 10 000, 330 at 100 000 and 460 at a million, where groups
// and changed boxes come from the outer caches. At 10 000 a quarter of it is the way down the tree, three tenths are
// the tests of groups, an eighth comparing what passed, a fifth the gathering of the changed boxes with their bounds
// and steps before and after the search, a tenth the sorting of what begins and ends. Few branches that depend on a box
// are left: loops over what passed and the ends of loops, of which about one a box is guessed wrong. Samples lie evenly
// over all instructions; nothing stands out that it would wait for.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"
#include "broad_phase/wide_tree/wide_tree_set.h"

namespace lendulet {

class WideTree {
public:
    // `width`: lanes of the vectors, 4, 8 or 16, which never show in a result; 0 for the widest of this machine.
    explicit WideTree(const Memory* memory, int width = 0);

    // As in BroadPhase.
    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void move_all(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    // visit(index) for every box of both sets that overlaps, each once.
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    // The hits of the queries [begin, end) as (query, index), in an order of queries that depends on where the range is
    // cut; those of one query always come in one order.
    void find_hits(const BoxQuery* queries, int begin, int end, PairList& out) const;
    // Offer every box of both sets that could better the best hit.
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;

    // Builds of the moving set so far, for tests and statistics.
    int builds() const { return builds_; }

private:
    void pairs_of_unbounded(Array<BoxPair>& out) const;
    void adopt_removed(const BroadBox* boxes, int count, const uint32_t* changed, int changed_count);
    void find_changes(TaskPool& tasks);
    void take_out(uint32_t place);
    void put_in(uint32_t place, const BroadBox& box);
    void replace(TaskPool& tasks, const BroadBox* boxes, int count);
    void sort_changes(Array<BoxPair>& begun, Array<BoxPair>& ended);
    void note(uint32_t a, uint32_t b, bool begins);
    using Visitor = void (*)(void* context, uint32_t index);
    void visit_groups_of(const WideTreeSet& set, const float lower[3], const float upper[3], Visitor visit,
                         void* context) const;
    template <class Visit>
    void visit_bounded(const WideTreeSet& set, const float lower[3], const float upper[3], Visit& visit) const {
        auto call = [](void* context, uint32_t index) { (*static_cast<Visit*>(context))(index); };
        visit_groups_of(set, lower, upper, call, const_cast<void*>(static_cast<const void*>(&visit)));
    }

    const WideTreeKernels& kernels_;
    WideTreeSet fixed_, moving_;
    PairChunks chunks_;
    int builds_ = 0;

    // While updating: places to take out and put in again; changes as the kernels write them; sorted keys of those that
    // begin and end.
    Array<uint32_t> special_;
    Array<uint64_t> removed_;  // index << 32 | place
    Array<BoxPair> changes_, found_, lost_;
    Array<uint64_t> begun_, ended_, swap_;
};

template <class Visit>
void WideTree::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    for (const WideTreeSet* set : {&moving_, &fixed_}) {
        for (const BroadBox& box : set->unbounded()) {
            if (overlap(box, lower, upper)) visit(box.index);
        }
        visit_bounded(*set, lower, upper, visit);
    }
}

}  // namespace lendulet
