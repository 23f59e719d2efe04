// A tree of boxes for queries: rays, swept boxes, overlaps and nearest boxes, with a visitor that may shorten the
// search. Eight boxes to a node, split by the surface area heuristic, refitted where bounds have changed; boxes come
// and go one by one as well.
//
// Unlike the broad phase it holds boxes as they are now and not through a whole step, so that an exact test behind it
// sees the present; and it is built for few long searches instead of many short ones.
#pragma once

#include <cfloat>
#include <type_traits>

#include "base/memory.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/query_tree_cast.h"

namespace lendulet {

class QueryTree {
public:
    explicit QueryTree(const Memory* memory)
        : nodes_(memory), parents_(memory), places_(memory), unbounded_(memory), items_(memory) {}

    // Builds the tree of boxes[0, count), whose indices are distinct. O(n log n).
    void build(const BroadBox* boxes, int count);
    // Takes over new bounds of all its boxes, `boxes` being by index. False where a box has become infinite or finite;
    // then it must be built anew.
    bool refit(const BroadBox* boxes);
    // One box: comes, goes, or has new bounds. Cost: a way through the tree.
    void insert(const BroadBox& box);
    void remove(uint32_t index);
    void move(const BroadBox& box);
    bool holds(uint32_t index) const { return index < places_.size() && places_[index] != no_box; }
    // Whether changes have made it so much larger, or so many boxes have come, that it should be built anew.
    bool is_worn();
    int count() const { return count_; }

    // All walks call visit(index) for every box that may be met, and some just beside: bounds are tested with a margin
    // for rounding. `visit` of cast and nearest returns how far the search still goes.

    // Boxes that `swept` meets for t in [0, limit], roughly by t.
    template <class Visit>
    void cast(const SweptBox& swept, float limit, Visit&& visit) const;
    // The same for each of many, through this tree and what `casts` has already: by turns, once all have been added.
    void add_to(ManyCasts& casts) const;
    // Boxes that overlap [lower, upper].
    template <class Visit>
    void overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    // Boxes no farther than `limit` from [lower, upper], roughly by distance.
    template <class Visit>
    void nearest(const float lower[3], const float upper[3], float limit, Visit&& visit) const;

    size_t bytes() const;

private:
    using Node = QueryNode;
    static constexpr int heuristic_depth = query_tree::heuristic_depth, max_depth = query_tree::max_depth;
    static constexpr float margin = query_tree::margin;
    static constexpr uint32_t beside = no_box - 1u, no_parent = ~0u;

    struct Item {
        float lower[3], upper[3];
        uint32_t index;
    };
    struct Part {
        int first, count;
        float lower[3], upper[3];
        float area() const;
    };
    struct Entry {
        int32_t child;
        float key;
    };
    struct Stack {
        Entry entries[max_depth * block_size];
        int top = 0;
        void push(Entry e, int bottom) {  // nearest last, so that it comes off first
            int at = top++;
            for (; at > bottom && entries[at - 1].key < e.key; --at) entries[at] = entries[at - 1];
            entries[at] = e;
        }
    };

    void measure(Part& part) const;
    void fill(int32_t node, const Part& part, int depth);
    Part split(Part& part, bool by_heuristic);
    int split_place(const Part& part);
    static void set(Node& node, int lane, const float lower[3], const float upper[3], int32_t child);
    void put(uint32_t node, int lane, uint32_t index) {
        places_[index] = node * block_size + static_cast<uint32_t>(lane);
    }
    uint32_t add_node(uint32_t parent);
    void place_leaf(const BroadBox& box);
    // The bounds of all that a node holds; the lane of a child that has it, true where that was not so.
    static void measure(const Node& node, float lower[3], float upper[3]);
    bool fit_lane(Node& node, int lane) const;
    void fit_parents(uint32_t node);
    float total_size() const;

    // keys_of(block, limit, keys) writes what orders and prunes the lanes.
    template <class Keys, class Visit>
    void walk(float limit, Keys&& keys_of, Visit&& visit) const;

    const QueryTreeCast cast_ = query_tree_cast();
    int count_ = 0, built_count_ = 0;
    int changes_ = 0;  // since its size was last looked at
    bool worn_ = false;
    float built_size_ = 0.0f;
    Array<Node> nodes_;          // parents before children
    Array<uint32_t> parents_;    // of each node: its parent's number times block_size, plus its lane there
    Array<uint32_t> places_;     // by index: node and lane likewise, `beside`, or no_box
    Array<uint32_t> unbounded_;  // indices of boxes beside the nodes, infinite ones above all
    Array<Item> items_;          // while building
};

template <class Keys, class Visit>
void QueryTree::walk(float limit, Keys&& keys_of, Visit&& visit) const {
    for (uint32_t index : unbounded_) limit = visit(index);
    if (nodes_.empty()) return;
    Stack stack;
    stack.push({0, 0.0f}, 0);
    while (stack.top > 0) {
        Entry e = stack.entries[--stack.top];
        if (e.key > limit) continue;
        if (e.child < 0) {
            limit = visit(static_cast<uint32_t>(~e.child));
            continue;
        }
        const Node& node = nodes_[static_cast<size_t>(e.child)];
        float keys[block_size];
        uint32_t hits = keys_of(node.box, limit, keys);
        int bottom = stack.top;
        while (hits) {
            int k = take_bit(hits);
            stack.push({node.child[k], keys[k]}, bottom);
        }
    }
}

template <class Visit>
void QueryTree::cast(const SweptBox& swept, float limit, Visit&& visit) const {
    for (uint32_t index : unbounded_) limit = visit(index);
    if (nodes_.empty()) return;
    using Called = std::remove_reference_t<Visit>;
    auto called = [](void* context, uint32_t index) -> float { return (*static_cast<Called*>(context))(index); };
    cast_(nodes_.data(), swept, limit, {called, &visit});
}

template <class Visit>
void QueryTree::overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    float low[3], high[3];
    for (int d = 0; d < 3; ++d) {
        low[d] = maximum(lower[d] - margin * absolute(lower[d]), -FLT_MAX);
        high[d] = minimum(upper[d] + margin * absolute(upper[d]), FLT_MAX);
    }
    const WideBox wide = spread(low, high);
    auto keys_of = [&](const BoxBlock& box, float, float keys[block_size]) {
        for (int k = 0; k < block_size; ++k) keys[k] = 0.0f;
        return overlaps(box, wide);
    };
    walk(0.0f, keys_of, [&](uint32_t index) {
        visit(index);
        return 0.0f;
    });
}

template <class Visit>
void QueryTree::nearest(const float lower[3], const float upper[3], float limit, Visit&& visit) const {
    const WideBox wide = spread(lower, upper);
    auto keys_of = [&](const BoxBlock& box, float now, float keys[block_size]) {
        uint32_t hits = 0;
        for (int lanes = 0; lanes < block_size; lanes += 4) {
            Float4 sum = splat<Float4>(0.0f), zero = sum;
            for (int d = 0; d < 3; ++d) {
                Float4 low = load_wide<Float4>(box.lower[d] + lanes), high = load_wide<Float4>(box.upper[d] + lanes);
                Float4 gap = maximum(maximum(low - wide.upper[d], wide.lower[d] - high), zero);
                sum = sum + gap * gap;
            }
            Float4 distance = square_root(sum) * splat<Float4>(1.0f - margin);
            hits |= mask_bits(distance <= splat<Float4>(now)) << lanes;
            store_wide(keys + lanes, distance);
        }
        return hits;
    };
    walk(limit, keys_of, visit);
}

}  // namespace lendulet
