// What the tree of the default broad phase is made of, and its inner loops as a table of functions: one source
// (wide_tree_kernels.inl) compiled once per instruction set. All tables give the same output in the same order: sets of
// boxes are tested against each other in a fixed order, and how many at once cannot show.
#pragma once

#include <cstdint>

#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"
#include "broad_phase/wide_tree/coarse_boxes.h"

namespace lendulet {

inline constexpr int block_lanes = 16;  // groups or blocks, the lanes of the widest vector

// A leaf: 64 boxes that lie close together. Lanes without a box have lower = +infinity and upper = -infinity: nothing
// finite overlaps them, and they leave all bounds alone. Searches look at their CoarseBoxes first.
struct alignas(64) BoxGroup {
    BroadBox boxes[group_lanes];
};
inline void clear_box(BroadBox& box) {
    box = {{infinity, infinity, infinity}, no_box, {-infinity, -infinity, -infinity}, 0};
}

// The bounds of 16 groups, or of 16 blocks of the level below; unused lanes as in a group.
struct alignas(64) BoundsBlock {
    float bounds[bound_count][block_lanes];
};

// A tree as the kernels see it. Level 0 holds the bounds of the groups, each level above the bounds of the blocks
// below, sixteen a block, by their numbers: there are no pointers. The last level is one block.
struct WideTreeView {
    static constexpr int max_levels = 8;
    const BoxGroup* groups = nullptr;
    const CoarseBoxes* coarse = nullptr;  // of each group
    const BoundsBlock* blocks = nullptr;
    int group_count = 0;
    int lanes = 0;  // used of all groups together: the last may be partly empty
    int levels = 0;
    int first_block[max_levels] = {};
};

struct alignas(64) WideTreeChange {
    BroadBox before, after;  // of the same index
};

// Boxes of the moving set that change between two frames, one batch, sorted by their lanes. While they are searched,
// the steps of their lanes are those of the box around before and after, and all bounds above hold both.
struct WideTreeChanges {
    const uint64_t* changed = nullptr;     // of each group, the lanes that change
    const uint32_t* first = nullptr;       // of each group with such lanes, where its rows begin
    const WideTreeChange* rows = nullptr;  // in the order of lanes
    const uint32_t* lanes = nullptr;       // of each row, counted through all groups
    const StepsOfTwo* steps = nullptr;     // of each row, before and after, in the frame of its group
};

// Where a query writes the indices of hits: from `next` on there is room for a group's, or `full` has to be called.
struct IndexStream {
    uint32_t *next, *end;
    void (*full)(IndexStream&);
};

struct WideTreeKernels {
    int width;
    // Copies boxes[place[i]], i < count, into a group and gives their bounds.
    void (*fill)(BoxGroup& group, CoarseBoxes& coarse, const BroadBox* boxes, const uint32_t* place, int count,
                 Bounds6& bounds);
    // The bounds of the boxes of a group, and of a block.
    void (*group_bounds)(const BoxGroup& group, Bounds6& bounds);
    void (*block_bounds)(const BoundsBlock& block, Bounds6& bounds);
    // Pairs of the groups [begin, end) of `moving`: within each, with the groups after it, with those of `fixed`.
    void (*find_pairs)(const WideTreeView& moving, const WideTreeView& fixed, int begin, int end, PairStream& out);
    // Changed boxes get their lanes' boxes of after and the steps around both states; gives those and those of after.
    void (*take_over)(BoxGroup* groups, CoarseBoxes* coarse, const WideTreeChange* rows, const uint32_t* lanes,
                      int count, StepsOfTwo* steps);
    // Pairs that begin (written a < b) and end (written a > b) with the rows [begin, end) of the changes, in an order
    // that depends on where the ranges are cut.
    void (*find_changes)(const WideTreeView& moving, const WideTreeView& fixed, const WideTreeChanges& changes,
                         int begin, int end, PairStream& out);
    // Queries; see BroadPhase. The box of the first is finite.
    void (*find_overlapping)(const WideTreeView& tree, const Bounds6& box, IndexStream& out);
    // The hits of the queries [begin, end) as (query, index), in any order; those of one query in the order of groups.
    void (*find_hits)(const WideTreeView& tree, const BoxQuery* queries, int begin, int end, PairStream& out);
    void (*cast)(const WideTreeView& tree, BoxCast& cast);
    void (*nearest)(const WideTreeView& tree, NearestBox& nearest);
};

// The table of 4, 8 or 16 lanes; of fewer where this machine has no instructions for so many. 0: the widest.
const WideTreeKernels& wide_tree_kernels(int width);

}  // namespace lendulet
