// An R-tree of boxes, eight children to a node, bulk-loaded by OMT and refitted when its boxes move.
//
// All nodes of a level have the same number of children and their parts differ by at most one box, so the tree needs no
// pointers: child k of node i of level l is node i * fan_out[l] + k of the next level. The last level are the leaves,
// of up to eight boxes; the nodes of the level above ("groups", up to 64 boxes) are what pair searches are cut into.
//
// Boxes with an infinite side (planes) are kept in a list beside the tree, so that everything in the tree is finite.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/query.h"
#include "broad_phase/rtree/omt.h"

namespace lendulet {

class BoxTree {
public:
    explicit BoxTree(const Memory* memory);

    // Bulk-loads. `tasks` may be null; it never changes the result.
    void build(const BroadBox* boxes, int count, TaskPool* tasks);

    // Takes over new bounds of as many boxes as were built, box by place in the array, and keeps the shape of the tree.
    // False where a box has become finite or infinite: then the tree must be built anew.
    bool refit(const BroadBox* boxes, TaskPool* tasks);

    // How much the leaves have grown since they were built: mean ratio of their edge lengths, at least 1.
    float growth() const { return growth_; }
    int count() const { return count_; }

    // visit(group) for every group from `first_group` on whose bounds overlap the (finite) box, in order.
    template <class Visit>
    void visit_groups(const WideBox& box, int first_group, Visit&& visit) const;
    int group_count() const { return count_bounded() ? nodes_at_[group_level()] : 0; }
    int leaves_per_group() const { return fan_out_[group_level()]; }
    const BoxBlock& group(int i) const { return nodes_[first_node_[group_level()] + i]; }
    const BoxBlock& leaf(int i) const { return nodes_[first_node_[levels_ - 1] + i]; }
    const uint32_t* leaf_indices(int i) const { return index_.data() + i * block_size; }
    WideBox group_bounds(int i) const;
    const Array<BroadBox>& unbounded() const { return unbounded_; }

    // visit(index) for every box in the tree that overlaps; not for the unbounded ones. The box given may be infinite.
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    // Offers the query (BoxCast or NearestBox) every box that could better its best hit, the unbounded ones included.
    template <class Query>
    void offer_to(Query& query) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;  // as BroadPhase::check

private:
    static constexpr int max_levels = 12;  // 8^11 > 2^31 boxes
    static constexpr int stack_size = max_levels * block_size;
    struct Place {
        int level, node;
    };

    int count_bounded() const { return count_ - unbounded_.count(); }
    int group_level() const { return levels_ - 2; }
    const BoxBlock& node(Place p) const { return nodes_[first_node_[p.level] + p.node]; }
    Place child(Place p, int k) const { return {p.level + 1, p.node * fan_out_[p.level] + k}; }
    uint32_t boxes_in_leaf(int leaf) const;  // a bit for each lane that holds one
    void collect(const BroadBox* boxes, int count);
    void plan_levels();
    void arrange(int level, int node, int begin, int count);
    void arrange_in_parallel(TaskPool& tasks);
    struct Range {
        int begin, count;
    };
    Range range_of(int level, int node) const;
    bool fill(const BroadBox* boxes, bool building, TaskPool* tasks);
    float fill_group(const BroadBox* boxes, int group, bool building);
    void fill_above_groups();

    int count_ = 0, levels_ = 2;
    int fan_out_[max_levels] = {}, nodes_at_[max_levels] = {}, first_node_[max_levels] = {};
    float growth_ = 1;
    Array<BoxBlock> nodes_;      // level by level, root first
    Array<uint32_t> index_;      // of the boxes of the leaves, the caller's; no_box where a lane is empty
    Array<uint32_t> slot_;       // of the same, their place in the caller's array
    Array<float> leaf_size_;     // sum of the edge lengths of a leaf when it was built
    Array<float> group_growth_;  // sum of the growth of its leaves
    Array<BroadBox> unbounded_;  // copies
    Array<uint32_t> unbounded_slot_;
    Array<BoxCentre> centres_;  // while building
};

template <class Visit>
void BoxTree::visit_groups(const WideBox& box, int first_group, Visit&& visit) const {
    if (first_group >= group_count()) return;
    // The node of each level that holds the first group; nodes before it are skipped.
    int first_at[max_levels];
    first_at[group_level()] = first_group;
    for (int level = group_level(); level > 0; --level) first_at[level - 1] = first_at[level] / fan_out_[level - 1];
    Place stack[stack_size];
    stack[0] = {0, 0};
    for (int top = 1; top > 0;) {
        Place place = stack[--top];
        if (place.level == group_level()) {
            visit(place.node);
            continue;
        }
        uint32_t hits = overlaps(node(place), box);
        while (hits) {  // the last child first, so that the first comes off the stack first
            int k = 31 - __builtin_clz(hits);
            hits ^= 1u << k;
            Place next = child(place, k);
            if (next.node < first_at[next.level]) break;
            stack[top++] = next;
        }
    }
}

template <class Visit>
void BoxTree::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    if (group_count() == 0) return;
    // All boxes here are finite: an infinite side reaches no farther than the largest float, and no empty lane.
    float low[3], high[3];
    for (int d = 0; d < 3; ++d) {
        low[d] = lower[d] < -FLT_MAX ? -FLT_MAX : lower[d];
        high[d] = upper[d] > FLT_MAX ? FLT_MAX : upper[d];
    }
    const WideBox box = spread(low, high);
    Place stack[stack_size];
    stack[0] = {0, 0};
    for (int top = 1; top > 0;) {
        Place place = stack[--top];
        uint32_t hits = overlaps(node(place), box);
        if (place.level == levels_ - 1) {
            while (hits) visit(leaf_indices(place.node)[take_bit(hits)]);
        } else {
            while (hits) stack[top++] = child(place, take_bit(hits));
        }
    }
}

}  // namespace lendulet
