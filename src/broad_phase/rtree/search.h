// The searches of the R-tree family, for every kind of tree: boxes that overlap, the first box met by a cast, the
// nearest box, and the boxes of the nodes for pictures.
//
// A tree for this has a small type Ref that names a node, and
//   empty(), root(), is_leaf(ref), block(ref) (a BoxBlock: bounds of the children, or the boxes of a leaf),
//   child(ref, k), lanes(ref) (a bit for each child or box there is), indices(ref) (of a leaf's boxes),
//   unbounded() (boxes with an infinite side, kept beside the tree), most_pending (enough for a stack of nodes).
#pragma once

#include "base/memory.h"
#include "broad_phase/query.h"

namespace lendulet {

// visit(index) for every box in the tree that overlaps; not for the unbounded ones. The box given may be infinite.
template <class Tree, class Visit>
void visit_finite_overlapping(const Tree& tree, const float lower[3], const float upper[3], Visit&& visit) {
    if (tree.empty()) return;
    // All boxes here are finite: an infinite side reaches no farther than the largest float, and no empty lane.
    float low[3], high[3];
    for (int d = 0; d < 3; ++d) {
        low[d] = lower[d] < -FLT_MAX ? -FLT_MAX : lower[d];
        high[d] = upper[d] > FLT_MAX ? FLT_MAX : upper[d];
    }
    const WideBox box = spread(low, high);
    typename Tree::Ref stack[Tree::most_pending];
    stack[0] = tree.root();
    for (int top = 1; top > 0;) {
        typename Tree::Ref ref = stack[--top];
        uint32_t hits = overlaps(tree.block(ref), box);
        if (tree.is_leaf(ref)) {
            const uint32_t* index = tree.indices(ref);
            while (hits) visit(index[take_bit(hits)]);
        } else {
            while (hits) stack[top++] = tree.child(ref, take_bit(hits));
        }
    }
}

// The same with the unbounded ones.
template <class Tree, class Visit>
void visit_overlapping(const Tree& tree, const float lower[3], const float upper[3], Visit&& visit) {
    for (const BroadBox& box : tree.unbounded()) {
        if (overlap(box, lower, upper)) visit(box.index);
    }
    visit_finite_overlapping(tree, lower, upper, visit);
}

// Offers the query (BoxCast or NearestBox) every box that could better its best hit, nearer nodes first.
template <class Tree, class Query>
void offer_boxes(const Tree& tree, Query& query) {
    for (const BroadBox& box : tree.unbounded()) query.offer(measure(query, box.lower, box.upper), box.index);
    if (tree.empty()) return;
    struct Entry {
        typename Tree::Ref ref;
        float at;
    };
    Entry stack[Tree::most_pending];
    stack[0] = {tree.root(), 0};
    for (int top = 1; top > 0;) {
        auto [ref, at] = stack[--top];
        if (at > limit(query)) continue;  // at an equal one there may be a smaller index
        if (tree.is_leaf(ref)) {
            offer_block(query, tree.block(ref), tree.lanes(ref), tree.indices(ref));
            continue;
        }
        float measures[block_size];
        measure_block(query, tree.block(ref), measures);
        const int bottom = top;
        for (uint32_t lanes = tree.lanes(ref); lanes;) {
            int k = take_bit(lanes);
            if (measures[k] > limit(query)) continue;
            int i = top++;  // sorted so that the best comes off first
            for (; i > bottom && stack[i - 1].at < measures[k]; --i) stack[i] = stack[i - 1];
            stack[i] = {tree.child(ref, k), measures[k]};
        }
    }
}

// Bounds of the boxes of a block; empty lanes do not count.
inline void block_bounds(const BoxBlock& block, float lower[3], float upper[3]) {
    for (int d = 0; d < 3; ++d) {
        Float4 low = minimum(load_wide<Float4>(block.lower[d]), load_wide<Float4>(block.lower[d] + 4));
        Float4 high = maximum(load_wide<Float4>(block.upper[d]), load_wide<Float4>(block.upper[d] + 4));
        low = minimum(low, __builtin_shufflevector(low, low, 2, 3, 0, 1));
        high = maximum(high, __builtin_shufflevector(high, high, 2, 3, 0, 1));
        lower[d] = minimum(low[0], low[1]);
        upper[d] = maximum(high[0], high[1]);
    }
}

template <class Tree>
void append_boxes_below(const Tree& tree, typename Tree::Ref ref, int depth, Array<BroadPhaseBox>& out) {
    const BoxBlock& b = tree.block(ref);
    bool leaf = tree.is_leaf(ref);
    for (uint32_t lanes = tree.lanes(ref); lanes;) {
        int k = take_bit(lanes);
        out.push_back({{b.lower[0][k], b.lower[1][k], b.lower[2][k]},
                       {b.upper[0][k], b.upper[1][k], b.upper[2][k]},
                       depth,
                       leaf,
                       leaf ? tree.indices(ref)[k] : no_box});
        if (!leaf) append_boxes_below(tree, tree.child(ref, k), depth + 1, out);
    }
}

// The bounds of the root at depth 0, then every node before those below it. Unbounded boxes are leaves of depth 0.
template <class Tree>
void append_boxes(const Tree& tree, Array<BroadPhaseBox>& out) {
    for (const BroadBox& b : tree.unbounded()) {
        out.push_back({{b.lower[0], b.lower[1], b.lower[2]}, {b.upper[0], b.upper[1], b.upper[2]}, 0, true, b.index});
    }
    if (tree.empty()) return;
    BroadPhaseBox root{{}, {}, 0, false, no_box};
    block_bounds(tree.block(tree.root()), root.lower, root.upper);
    out.push_back(root);
    append_boxes_below(tree, tree.root(), 1, out);
}

}  // namespace lendulet
