#include "broad_phase/rtree/rtree_omt.h"

namespace lendulet {

namespace {

// The tree is built anew after this many refits, or once its leaves have grown by this factor. A build costs about a
// third of a search for pairs.
constexpr int most_refits = 64;
constexpr float most_growth = 1.15f;

// One group of up to 64 boxes of a tree against groups.
class GroupPairs {
public:
    GroupPairs(const BoxTree& tree, int group) : tree_(tree), group_(group), block_(tree.group(group)) {}

    // All pairs inside the group.
    void with_itself(PairList& out) const {
        int leaves = tree_.leaves_per_group(), first = group_ * leaves;
        for (int i = 0; i < leaves; ++i) {
            inside_leaf(first + i, out);
            uint32_t hits = overlaps(block_, spread_lane(block_, i)) & (~0u << (i + 1));
            while (hits) {
                int j = take_bit(hits);
                between_leaves(tree_.leaf(first + i), tree_.leaf_indices(first + i), tree_.leaf(first + j),
                               tree_.leaf_indices(first + j), spread_lane(block_, j), out);
            }
        }
    }

    // All pairs with another group, of this or another tree.
    void with(const BoxTree& other, int other_group, PairList& out) const {
        const BoxBlock& theirs = other.group(other_group);
        int first = group_ * tree_.leaves_per_group(), other_first = other_group * other.leaves_per_group();
        for (int i = 0; i < tree_.leaves_per_group(); ++i) {
            uint32_t hits = overlaps(theirs, spread_lane(block_, i));
            while (hits) {
                int j = take_bit(hits);
                between_leaves(tree_.leaf(first + i), tree_.leaf_indices(first + i), other.leaf(other_first + j),
                               other.leaf_indices(other_first + j), spread_lane(theirs, j), out);
            }
        }
    }

private:
    void inside_leaf(int leaf, PairList& out) const {
        const BoxBlock& boxes = tree_.leaf(leaf);
        const uint32_t* index = tree_.leaf_indices(leaf);
        PairWriter writer(out, block_size * (block_size - 1) / 2);
        for (int i = 0; i < block_size - 1; ++i) {
            uint32_t hits = overlaps(boxes, spread_lane(boxes, i)) & (~0u << (i + 1));
            while (hits) writer.write(index[i], index[take_bit(hits)]);
        }
    }

    // Only boxes of the first leaf that reach into the bounds of the second are tested against its boxes.
    static void between_leaves(const BoxBlock& a, const uint32_t* index_a, const BoxBlock& b, const uint32_t* index_b,
                               const WideBox& bounds_of_b, PairList& out) {
        uint32_t near = overlaps(a, bounds_of_b);
        if (near == 0) return;
        PairWriter writer(out, block_size * block_size);
        while (near) {
            int i = take_bit(near);
            uint32_t hits = overlaps(b, spread_lane(a, i));
            while (hits) writer.write(index_a[i], index_b[take_bit(hits)]);
        }
    }

    const BoxTree& tree_;
    int group_;
    const BoxBlock& block_;
};

}  // namespace

RtreeOmt::RtreeOmt(const Memory* memory)
    : fixed_(memory), moving_(memory), moving_boxes_(memory), chunks_(memory), changes_(memory) {}

void RtreeOmt::set_fixed(const BroadBox* boxes, int count, TaskPool* tasks) {
    fixed_.build(boxes, count, tasks);
    changes_.forget();
}

// The tree knows boxes by their place in the array. If the array holds other boxes than the last time, refitting is
// still right; the growth then tells that it is slow.
void RtreeOmt::set_moving(const BroadBox* boxes, int count, TaskPool* tasks) {
    moving_boxes_.clear();
    moving_boxes_.append(boxes, static_cast<size_t>(count));
    changes_.forget();
    bool keep = count == moving_.count() && refits_ < most_refits;
    if (keep && moving_.refit(boxes, tasks) && moving_.growth() < most_growth) {
        ++refits_;
        return;
    }
    moving_.build(boxes, count, tasks);
    refits_ = 0;
    ++builds_;
}

void RtreeOmt::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 4;  // groups
    chunks_.search(tasks, moving_.group_count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int i = begin; i < end; ++i) {
            GroupPairs group(moving_, i);
            WideBox bounds = moving_.group_bounds(i);
            group.with_itself(list);
            moving_.visit_groups(bounds, i + 1, [&](int other) { group.with(moving_, other, list); });
            fixed_.visit_groups(bounds, 0, [&](int other) { group.with(fixed_, other, list); });
        }
    });
    pairs_of_unbounded(out);
}

// Unbounded boxes are few: each is tested against the others and taken through the trees.
void RtreeOmt::pairs_of_unbounded(Array<BoxPair>& out) const {
    auto append = [&](uint32_t a, uint32_t b) { out.push_back(a < b ? BoxPair{a, b} : BoxPair{b, a}); };
    const Array<BroadBox>& moving = moving_.unbounded();
    for (int i = 0; i < moving.count(); ++i) {
        const BroadBox& box = moving[i];
        auto with_box = [&](uint32_t other) { append(box.index, other); };
        for (int j = i + 1; j < moving.count(); ++j) {
            if (overlap(moving[j], box.lower, box.upper)) append(box.index, moving[j].index);
        }
        for (const BroadBox& other : fixed_.unbounded()) {
            if (overlap(other, box.lower, box.upper)) append(box.index, other.index);
        }
        moving_.visit_overlapping(box.lower, box.upper, with_box);
        fixed_.visit_overlapping(box.lower, box.upper, with_box);
    }
    for (const BroadBox& box : fixed_.unbounded()) {
        moving_.visit_overlapping(box.lower, box.upper, [&](uint32_t other) { append(box.index, other); });
    }
}

void RtreeOmt::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                      Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 8;
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

void RtreeOmt::cast(BoxCast& cast) const {
    moving_.offer_to(cast);
    fixed_.offer_to(cast);
}

void RtreeOmt::nearest(NearestBox& nearest) const {
    moving_.offer_to(nearest);
    fixed_.offer_to(nearest);
}

void RtreeOmt::boxes(Array<BroadPhaseBox>& out) const {
    moving_.boxes(out);
    fixed_.boxes(out);
}

size_t RtreeOmt::bytes() const {
    return moving_.bytes() + fixed_.bytes() + moving_boxes_.bytes() + chunks_.bytes() + changes_.bytes();
}

const char* RtreeOmt::check() const {
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

}  // namespace lendulet
