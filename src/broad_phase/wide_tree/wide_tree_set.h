// One set of boxes of the wide tree: its groups, the bounds above them and the boxes with infinite sides beside them.
//
// Between frames a box keeps its lane while it stays near where its group was built; one that jumps farther, or is new,
// goes into a loose group at the end, whatever its place in space. Loose groups meet more queries than others, and
// groups grow as their boxes drift apart: worn() tells when what that costs has paid for building the set anew.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/wide_tree/wide_tree_kernels.h"
#include "broad_phase/wide_tree/wide_tree_order.h"

namespace lendulet {

// The sum of its edge lengths, by which the wear of groups is told; 0 of no boxes.
inline float size_of(const Bounds6& b) {
    float size = (b.at[3] - b.at[0]) + (b.at[4] - b.at[1]) + (b.at[5] - b.at[2]);
    return size > 0 ? size : 0;
}

class WideTreeSet {
public:
    WideTreeSet(const Memory* memory, const WideTreeKernels& kernels);

    // Replaces all boxes. `tasks` may be null; it never changes the result.
    void build(const BroadBox* boxes, int count, TaskPool* tasks);
    // Replaces all boxes by as many that are mostly near where those of the same place were, and leaves each in its
    // lane. False, with nothing of use left, where the set has to be built instead: groups would be too large, or some
    // have lost or won boxes.
    bool refill(const BroadBox* boxes, int count, TaskPool* tasks);
    WideTreeView view() const;
    const Array<BroadBox>& unbounded() const { return unbounded_; }
    int count() const { return count_; }
    size_t bytes() const;
    void boxes(Array<BroadPhaseBox>& out) const;
    // Empty, or a sentence about the first thing that is wrong inside.
    const char* check() const;

    // Changes, in this order. "Place": in the caller's array, of the boxes of the last frame.
    // 1. Before all others.
    void begin_changes();
    BroadBox box_at(uint32_t place) const;
    uint32_t index_at(uint32_t place) const;
    // The lane of one place becomes the other's and the other way round.
    void swap_places(uint32_t a, uint32_t b);
    // 2. Marks boxes that change, once. Appends those that are unbounded to `unbounded` instead: they are to be removed
    // and inserted.
    void mark(const uint32_t* places, int count, Array<uint32_t>& unbounded);
    // 3. Collects the next of the marked boxes, at most `most` >= group_lanes, before and after, `boxes` being the new
    // array; they get their new state, and all bounds hold both, so that their changes can be searched. False where
    // none are left. Appends the places of those that jump or become another box to `jumped`: they are no longer
    // marked, but to be removed and inserted.
    bool next_batch(const BroadBox* boxes, int most, Array<uint32_t>& jumped);
    WideTreeChanges changes() const;
    int changed_count() const { return rows_.count(); }
    // 4. After the search of each batch: the old state goes.
    void settle();
    int changed_groups() const { return touched_.count(); }
    // 5. Takes a box out.
    void remove(uint32_t place);
    // 6. The set then has `count` boxes; those removed or new are to be inserted.
    void end_changes(int count);
    // 7. Puts a box in.
    void insert(uint32_t place, const BroadBox& box);
    // True where a build now saves more than it costs, as far as can be told from the work of the changes since the
    // last.
    bool worn(int queries);
    static constexpr double most_growth = 1.25;  // of the sizes of all groups together
    int loose_lanes() const { return (groups_.count() - built_groups_ - 1) * group_lanes + loose_used_; }

private:
    static constexpr uint32_t beside = 1u << 31;  // in lane_of_: the rest counts in the list of unbounded boxes

    // What the rows of one group come to together.
    struct alignas(16) GroupMove {
        Wide<float, 4> lower_before, upper_before, lower_after, upper_after;  // the box around all; the fourth is none
        uint64_t lanes;
        uint32_t group, first_row;
    };

    void fill_groups(const BroadBox* boxes, TaskPool* tasks);
    void plan_levels(int first_cleared);
    void set_bounds(int level, uint32_t child, const Bounds6& bounds);
    Bounds6 bounds_at(int level, uint32_t child) const;
    void raise_bounds();
    void raise(const uint32_t* groups, size_t count);
    void list_marks();
    void widen();
    void extend_bounds(int level, uint32_t child, const BroadBox& box);
    void add_group();
    void clear_lane(uint32_t lane);

    const WideTreeKernels& kernels_;
    int levels_ = 0, count_ = 0;
    int first_block_[WideTreeView::max_levels] = {}, blocks_at_[WideTreeView::max_levels] = {};
    Array<BoxGroup> groups_;
    Array<CoarseBoxes> coarse_;  // of each group
    Array<BoundsBlock> blocks_;  // level 0 first
    Array<uint32_t> place_;      // of the box in each lane, its place in the caller's array; no_box: none
    Array<BroadBox> unbounded_;
    Array<uint32_t> unbounded_place_;
    WideTreeOrder order_;

    Array<float> size_;                     // of each group, see size_of
    double size_sum_ = 0, built_size_ = 0;  // now, and when the set was built
    bool shuffled_ = false;                 // boxes have come or gone since

    // What changes need; made by the first after a build.
    bool mapped_ = false;
    Array<uint32_t> lane_of_;       // of each place
    Array<BroadBox> home_;          // of each group, what its boxes stay in
    int built_groups_ = 0;          // the others are loose
    int loose_used_ = group_lanes;  // lanes of the last loose group
    int64_t wear_ = 0;
    Array<uint8_t> loosened_;  // of each group, how often it may have become smaller than its bounds

    // The changes of one frame.
    int marks_ = 0, begun_marks_ = 0;   // all, and those of batches so far
    Array<uint32_t> marked_lane_;       // in order
    Array<uint32_t> touched_;           // groups with marks, in order
    Array<uint32_t> shrunk_, parents_;  // groups that may have become smaller
    // Of the present batch.
    size_t first_touched_ = 0, end_touched_ = 0;
    Array<uint64_t> changed_;    // of each group, the lanes that change: all zero between batches
    Array<uint32_t> first_row_;  // of each group with such lanes
    Array<WideTreeChange> rows_;
    Array<uint32_t> row_lane_;
    Array<StepsOfTwo> row_steps_;
    Array<GroupMove> moves_;
};

}  // namespace lendulet
