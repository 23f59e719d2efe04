#include "broad_phase/rtree/two_trees.h"

namespace lendulet {

namespace {

// The eight boxes of a leaf and the caller's index of each.
struct Leaf {
    const BoxBlock& boxes;
    const uint32_t* index;
};

template <class Tree>
Leaf leaf_of(const Tree& tree, typename Tree::Ref group, int k) {
    typename Tree::Ref leaf = tree.child(group, k);
    return {tree.block(leaf), tree.indices(leaf)};
}

void inside_leaf(Leaf leaf, PairList& out) {
    PairWriter writer(out, block_size * (block_size - 1) / 2);
    for (int i = 0; i < block_size - 1; ++i) {
        uint32_t hits = overlaps(leaf.boxes, spread_lane(leaf.boxes, i)) & (~0u << (i + 1));
        while (hits) writer.write(leaf.index[i], leaf.index[take_bit(hits)]);
    }
}

// Only boxes of the first leaf that reach into the bounds of the second are tested against its boxes.
void between_leaves(Leaf a, Leaf b, const WideBox& bounds_of_b, PairList& out) {
    uint32_t near = overlaps(a.boxes, bounds_of_b);
    if (near == 0) return;
    PairWriter writer(out, block_size * block_size);
    while (near) {
        int i = take_bit(near);
        uint32_t hits = overlaps(b.boxes, spread_lane(a.boxes, i));
        while (hits) writer.write(a.index[i], b.index[take_bit(hits)]);
    }
}

// All pairs inside a group of up to eight leaves.
template <class Tree>
void inside_group(const Tree& tree, typename Tree::Ref group, PairList& out) {
    const BoxBlock& bounds = tree.block(group);
    for (uint32_t lanes = tree.lanes(group); lanes;) {
        int i = take_bit(lanes);
        Leaf leaf = leaf_of(tree, group, i);
        inside_leaf(leaf, out);
        uint32_t hits = overlaps(bounds, spread_lane(bounds, i)) & (~0u << (i + 1));
        while (hits) {
            int j = take_bit(hits);
            between_leaves(leaf, leaf_of(tree, group, j), spread_lane(bounds, j), out);
        }
    }
}

// All pairs of a group with another, of this or another tree.
template <class Tree>
void between_groups(const Tree& tree, typename Tree::Ref group, const WideBox& bounds, const Tree& other,
                    typename Tree::Ref other_group, PairList& out) {
    const BoxBlock &mine = tree.block(group), &theirs = other.block(other_group);
    uint32_t near = overlaps(theirs, bounds);
    if (near == 0) return;
    for (uint32_t lanes = tree.lanes(group); lanes;) {
        int i = take_bit(lanes);
        uint32_t hits = overlaps(theirs, spread_lane(mine, i)) & near;
        while (hits) {
            int j = take_bit(hits);
            between_leaves(leaf_of(tree, group, i), leaf_of(other, other_group, j), spread_lane(theirs, j), out);
        }
    }
}

void pairs_of_leaves(const ScannedBoxes& moving, const ScannedBoxes& fixed, Array<BoxPair>& out) {
    PairList list(out, true);
    PairRoom room(list);
    all_pairs_kernels().scan(moving, fixed, 0, moving.count, room);
}

}  // namespace

template <class Tree>
void TwoTrees<Tree>::set_fixed(const BroadBox* boxes, int count, TaskPool* tasks) {
    fixed_.build(boxes, count, tasks);
    changes_.forget();
}

template <class Tree>
void TwoTrees<Tree>::set_moving(const BroadBox* boxes, int count, TaskPool* tasks) {
    moving_.set(boxes, count, tasks);
    changes_.forget();
}

template <class Tree>
void TwoTrees<Tree>::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    if (moving_.is_few() && fixed_.is_few()) {
        pairs_of_leaves(moving_.leaves(), fixed_.leaves(), out);
    } else {
        find_pairs_by_groups(tasks, out);
    }
    if (moving_.unbounded().count() + fixed_.unbounded().count() > 0) pairs_of_unbounded(out);
}

template <class Tree>
void TwoTrees<Tree>::find_pairs_by_groups(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 4;  // groups
    moving_.list_groups();
    chunks_.search(tasks, moving_.group_count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int i = begin; i < end; ++i) {
            auto group = moving_.group(i);
            const WideBox bounds = moving_.bounds_of(group);
            inside_group(moving_, group, list);
            moving_.visit_later_groups(
                group, bounds, [&](auto other) { between_groups(moving_, group, bounds, moving_, other, list); });
            fixed_.visit_groups(bounds,
                                [&](auto other) { between_groups(moving_, group, bounds, fixed_, other, list); });
        }
    });
}

// Unbounded boxes are few: each is tested against the others and taken through the trees.
template <class Tree>
void TwoTrees<Tree>::pairs_of_unbounded(Array<BoxPair>& out) const {
    PairList list(out, true);
    const Array<BroadBox>& moving = moving_.unbounded();
    for (int i = 0; i < moving.count(); ++i) {
        const BroadBox& box = moving[i];
        const Meetings meet(list, box.index, true);
        for (int j = i + 1; j < moving.count(); ++j) {
            if (overlap(moving[j], box.lower, box.upper)) meet(moving[j].index);
        }
        visit_finite_overlapping(moving_, box.lower, box.upper, meet);
        lendulet::visit_overlapping(fixed_, box.lower, box.upper, meet);
    }
    for (const BroadBox& box : fixed_.unbounded()) {
        visit_finite_overlapping(moving_, box.lower, box.upper, Meetings(list, box.index, true));
    }
}

template <class Tree>
void TwoTrees<Tree>::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed,
                            int changed_count, Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 8;  // two look-ups of a box alone cost several times its part in the search for all pairs
    moving_.prepare_look_up();
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

template <class Tree>
void TwoTrees<Tree>::cast(BoxCast& cast) const {
    offer_boxes(moving_, cast);
    offer_boxes(fixed_, cast);
}

template <class Tree>
void TwoTrees<Tree>::nearest(NearestBox& nearest) const {
    offer_boxes(moving_, nearest);
    offer_boxes(fixed_, nearest);
}

template <class Tree>
void TwoTrees<Tree>::boxes(Array<BroadPhaseBox>& out) const {
    append_boxes(moving_, out);
    append_boxes(fixed_, out);
}

template <class Tree>
const char* TwoTrees<Tree>::check() const {
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

template class TwoTrees<BoxTree>;
template class TwoTrees<RTree>;

}  // namespace lendulet
