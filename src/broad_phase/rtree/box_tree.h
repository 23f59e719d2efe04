// An R-tree of boxes, eight children to a node, bulk-loaded by OMT and refitted when its boxes move.
//
// All nodes of a level have the same number of children and their parts differ by at most one box, so the tree needs no
// pointers: child k of node i of level l is node i * fan_out[l] + k of the next level. The last level are the leaves,
// of up to eight boxes; the nodes of the level above ("groups", up to 64 boxes) are what pair searches are cut into.
// That is why this is not an RTree with a bulk loader of its own: a shape known beforehand is filled and refitted by
// parallel loops over whole levels, without links to follow or to keep. Its price is that single boxes cannot come and
// go: then it is built anew.
//
// Boxes with an infinite side (planes) are kept in a list beside the tree, so that everything in the tree is finite.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/all_pairs_scan.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/rtree/omt.h"
#include "broad_phase/rtree/search.h"

namespace lendulet {

class BoxTree {
public:
    explicit BoxTree(const Memory* memory);

    // Bulk-loads. `tasks` may be null; it never changes the result.
    void build(const BroadBox* boxes, int count, TaskPool* tasks);

    // Takes over new bounds of as many boxes as were built, box by place in the array, and keeps the shape of the tree.
    // False where a box has become finite or infinite: then the tree must be built anew.
    bool refit(const BroadBox* boxes, TaskPool* tasks);

    // Refits where the tree stays good by that, else bulk-loads. The tree knows boxes by their place in the array. If
    // the array holds other boxes than the last time, refitting is still right; the growth then tells that it is slow.
    void set(const BroadBox* boxes, int count, TaskPool* tasks);
    void change(const BoxChanges& changes, TaskPool& tasks) { set(changes.boxes, changes.count, &tasks); }

    int count() const { return count_; }
    // The box at a place of the array last given, once prepare_look_up() has been called since.
    BroadBox box(int place) const;
    void prepare_look_up();
    // How much the leaves have grown since they were built: mean ratio of their edge lengths, at least 1.
    float growth() const { return growth_; }
    // Bulk loads so far.
    int builds() const { return builds_; }

    // The tree as search.h sees it.
    struct Ref {
        int level, node;
    };
    static constexpr int max_levels = 12;  // 8^11 > 2^31 boxes
    static constexpr int most_pending = max_levels * block_size;
    bool empty() const { return count_bounded() == 0; }
    Ref root() const { return {0, 0}; }
    bool is_leaf(Ref ref) const { return ref.level == levels_ - 1; }
    const BoxBlock& block(Ref ref) const { return nodes_[first_node_[ref.level] + ref.node]; }
    Ref child(Ref ref, int k) const { return {ref.level + 1, ref.node * fan_out_[ref.level] + k}; }
    uint32_t lanes(Ref ref) const { return is_leaf(ref) ? boxes_in_leaf(ref.node) : (1u << fan_out_[ref.level]) - 1; }
    const uint32_t* indices(Ref ref) const { return index_.data() + ref.node * block_size; }
    const Array<BroadBox>& unbounded() const { return unbounded_; }

    // The groups, in the order of the tree.
    void list_groups() {}
    int group_count() const { return empty() ? 0 : nodes_at_[group_level()]; }
    Ref group(int i) const { return {group_level(), i}; }
    WideBox bounds_of(Ref group) const;
    // visit(group) for every group (after the one given) whose bounds overlap the finite box.
    template <class Visit>
    void visit_groups(const WideBox& box, Visit&& visit) const {
        visit_groups_from(0, box, visit);
    }
    template <class Visit>
    void visit_later_groups(Ref group, const WideBox& box, Visit&& visit) const {
        visit_groups_from(group.node + 1, box, visit);
    }

    // As in RTree.
    ScannedBoxes leaves() const;
    bool is_few() const { return count_bounded() <= smallest_cut; }

    size_t bytes() const;
    const char* check() const;  // as BroadPhase::check

private:
    // Up to this a set is not cut at all: the leaves of one group are compared faster than they could be improved.
    static constexpr int smallest_cut = block_size * block_size;

    template <class Visit>
    void visit_groups_from(int first_group, const WideBox& box, Visit&& visit) const;
    int count_bounded() const { return count_ - unbounded_.count(); }
    int group_level() const { return levels_ - 2; }
    uint32_t boxes_in_leaf(int leaf) const;  // a bit for each lane that holds one
    void collect(const BroadBox* boxes, int count);
    void plan_levels();
    bool build_uncut(const BroadBox* boxes, int count, TaskPool* tasks);
    void arrange(int level, int node, int begin, int count);
    void arrange_in_parallel(TaskPool& tasks);
    struct Range {
        int begin, count;
    };
    Range range_of(int level, int node) const;
    bool fill(const BroadBox* boxes, bool building, TaskPool* tasks);
    float fill_group(const BroadBox* boxes, int group, bool building);
    void fill_above_groups();

    int count_ = 0, levels_ = 2, refits_ = 0, builds_ = 0;
    bool lanes_known_ = false;
    int fan_out_[max_levels] = {}, nodes_at_[max_levels] = {}, first_node_[max_levels] = {};
    float growth_ = 1;
    Array<BoxBlock> nodes_;      // level by level, root first
    Array<uint32_t> index_;      // of the boxes of the leaves, the caller's; no_box where a lane is empty
    Array<uint32_t> slot_;       // of the same, their place in the caller's array
    Array<uint32_t> lane_;       // the inverse: lane of a place, counted over all leaves; or no_box
    Array<float> leaf_size_;     // sum of the edge lengths of a leaf when it was built
    Array<float> group_growth_;  // sum of the growth of its leaves
    Array<BroadBox> unbounded_;  // copies
    Array<uint32_t> unbounded_slot_;
    Array<BoxCentre> centres_;  // while building
};

template <class Visit>
void BoxTree::visit_groups_from(int first_group, const WideBox& box, Visit&& visit) const {
    if (first_group >= group_count()) return;
    // The node of each level that holds the first group; nodes before it are skipped.
    int first_at[max_levels];
    first_at[group_level()] = first_group;
    for (int level = group_level(); level > 0; --level) first_at[level - 1] = first_at[level] / fan_out_[level - 1];
    Ref stack[most_pending];
    stack[0] = {0, 0};
    for (int top = 1; top > 0;) {
        Ref ref = stack[--top];
        if (ref.level == group_level()) {
            visit(ref);
            continue;
        }
        uint32_t hits = overlaps(block(ref), box);
        while (hits) {  // the last child first, so that the first comes off the stack first
            int k = 31 - __builtin_clz(hits);
            hits ^= 1u << k;
            Ref next = child(ref, k);
            if (next.node < first_at[next.level]) break;
            stack[top++] = next;
        }
    }
}

}  // namespace lendulet
