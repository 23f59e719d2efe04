#include "broad_phase/rtree/box_tree.h"

#include "broad_phase/block_fill.h"
#include "broad_phase/rtree/leaf.h"

namespace lendulet {

namespace {

// The tree is built anew after this many refits, or once its leaves have grown by this factor. A build costs about a
// third of a search for pairs.
constexpr int most_refits = 64;
constexpr float most_growth = 1.15f;
// Work is cut into tasks of about this many boxes.
constexpr int boxes_per_task = 2048;

}  // namespace

BoxTree::BoxTree(const Memory* memory)
    : nodes_(memory),
      index_(memory),
      slot_(memory),
      lane_(memory),
      leaf_size_(memory),
      group_growth_(memory),
      unbounded_(memory),
      unbounded_slot_(memory),
      centres_(memory) {}

// ---------------------------------------------------------------------------------------------------------------------
// Building

void BoxTree::build(const BroadBox* boxes, int count, TaskPool* tasks) {
    count_ = count;
    refits_ = 0;
    ++builds_;
    lanes_known_ = false;
    if (count <= smallest_cut && build_uncut(boxes, count, tasks)) return;
    collect(boxes, count);
    if (count_bounded() == 0) return;
    plan_levels();
    if (tasks && tasks->workers() > 1 && count_bounded() > 2 * boxes_per_task) arrange_in_parallel(*tasks);
    else arrange(0, 0, 0, count_bounded());
    fill(boxes, true, tasks);
}

// Full leaves in the order of the boxes. False where some are unbounded: then they are to be collected first.
bool BoxTree::build_uncut(const BroadBox* boxes, int count, TaskPool* tasks) {
    unbounded_.clear();
    unbounded_slot_.clear();
    if (count == 0) return true;
    plan_levels();
    for (size_t i = 0; i < slot_.size(); ++i)
        slot_[i] = i < static_cast<size_t>(count) ? static_cast<uint32_t>(i) : no_box;
    return fill(boxes, true, tasks);
}

// The centres of the bounded boxes, and the list of the others.
void BoxTree::collect(const BroadBox* boxes, int count) {
    unbounded_.clear();
    unbounded_slot_.clear();
    centres_.resize_unset(static_cast<size_t>(count));
    size_t n = 0;
    using Int4 = Wide<int32_t, 4>;
    const Int4 sides{-1, -1, -1, 0};  // without the word behind: most integers are denormal floats, which are slow
    for (int i = 0; i < count; ++i) {
        if (!bounded(boxes[i])) {
            unbounded_.push_back(boxes[i]);
            unbounded_slot_.push_back(static_cast<uint32_t>(i));
            continue;
        }
        Float4 lower = (Float4)((Int4)load_wide<Float4>(boxes[i].lower) & sides);
        Float4 upper = (Float4)((Int4)load_wide<Float4>(boxes[i].upper) & sides);
        // Halved before adding: the sum of two large floats may overflow.
        const Float4 half = splat<Float4>(0.5f);
        Int4 at = ordered(half * lower + half * upper);
        at[3] = i;
        std::memcpy(static_cast<void*>(&centres_[n++]), &at, sizeof at);
    }
    centres_.resize_unset(n);
}

// As many levels as needed; below the root the children of a node are as full as they can be, as Lee and Lee have it:
// the root has count / 8^(height - 1) of them, rounded up.
void BoxTree::plan_levels() {
    int count = count_bounded();
    int64_t capacity = block_size;  // of a child of the root
    for (levels_ = 2; capacity * block_size < count; ++levels_) capacity *= block_size;
    int size = count, nodes = 1, first = 0;  // size: of the largest node of the level
    for (int level = 0; level < levels_; ++level) {
        nodes_at_[level] = nodes;
        first_node_[level] = first;
        first += nodes;
        if (level == levels_ - 1) break;
        int fan_out = static_cast<int>((size + capacity - 1) / capacity);
        fan_out_[level] = fan_out;
        nodes *= fan_out;
        size = (size + fan_out - 1) / fan_out;
        capacity /= block_size;
    }
    size_t leaves = static_cast<size_t>(nodes_at_[levels_ - 1]);
    nodes_.resize_unset(static_cast<size_t>(first));
    index_.resize_unset(leaves * block_size);
    slot_.resize_unset(leaves * block_size);
    leaf_size_.resize_unset(leaves);
    group_growth_.resize_unset(static_cast<size_t>(nodes_at_[levels_ - 2]));
}

// Divides the boxes [begin, begin + count) of a node among its children, and so on down to the leaves.
void BoxTree::arrange(int level, int node, int begin, int count) {
    if (level == levels_ - 1) {
        for (int i = 0; i < block_size; ++i) {
            slot_[static_cast<size_t>(node) * block_size + i] = i < count ? centres_[begin + i].slot : no_box;
        }
        return;
    }
    int fan_out = fan_out_[level];
    const bool cut = count_bounded() > smallest_cut;
    if (cut) omt_divide(centres_.data() + begin, count, fan_out);
    auto begin_of = [&](int k) {
        return cut ? part_begin(count, fan_out, k) : k * block_size < count ? k * block_size : count;
    };
    for (int k = 0; k < fan_out; ++k) {
        int from = begin_of(k), to = begin_of(k + 1);
        arrange(level + 1, node * fan_out + k, begin + from, to - from);
    }
}

BoxTree::Range BoxTree::range_of(int level, int node) const {
    Range range{0, count_bounded()};
    for (int l = 0; l < level; ++l) {
        int below = 1;  // nodes of `level` per child of level l
        for (int m = l + 1; m < level; ++m) below *= fan_out_[m];
        int k = node / below % fan_out_[l];
        int from = part_begin(range.count, fan_out_[l], k), to = part_begin(range.count, fan_out_[l], k + 1);
        range = {range.begin + from, to - from};
    }
    return range;
}

// Level by level until there are enough nodes, then whole subtrees.
void BoxTree::arrange_in_parallel(TaskPool& tasks) {
    int level = 0;
    for (; level < levels_ - 2 && nodes_at_[level] < 16; ++level) {
        tasks.for_each(nodes_at_[level], 1, [&](int first, int last, int) {
            for (int node = first; node < last; ++node) {
                Range range = range_of(level, node);
                omt_divide(centres_.data() + range.begin, range.count, fan_out_[level]);
            }
        });
    }
    tasks.for_each(nodes_at_[level], 1, [&](int first, int last, int) {
        for (int node = first; node < last; ++node) {
            Range range = range_of(level, node);
            arrange(level, node, range.begin, range.count);
        }
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Bounds

void BoxTree::set(const BroadBox* boxes, int count, TaskPool* tasks) {
    bool keep = count == count_ && refits_ < most_refits && builds_ > 0;
    if (keep && refit(boxes, tasks) && growth_ < most_growth) ++refits_;
    else build(boxes, count, tasks);
}

bool BoxTree::refit(const BroadBox* boxes, TaskPool* tasks) {
    for (int i = 0; i < unbounded_.count(); ++i) {
        unbounded_[i] = boxes[unbounded_slot_[i]];
        if (bounded(unbounded_[i])) return false;
    }
    return count_bounded() == 0 || fill(boxes, false, tasks);
}

bool BoxTree::fill(const BroadBox* boxes, bool building, TaskPool* tasks) {
    auto fill_groups = [&](int first, int last, int) {
        for (int i = first; i < last; ++i) group_growth_[i] = fill_group(boxes, i, building);
    };
    constexpr int grain = boxes_per_task / (block_size * block_size);
    if (tasks) tasks->for_each(group_count(), grain, fill_groups);
    else fill_groups(0, group_count(), 0);
    fill_above_groups();
    float sum = 0;  // in the order of the groups: the same for any number of workers
    for (float growth : group_growth_) sum += growth;
    growth_ = sum / static_cast<float>(nodes_at_[levels_ - 1]);
    return growth_ < infinity;
}

// Sum of the growth of the leaves, infinite where a box has become so. The growth of a leaf is capped: a few boxes that
// jumped across the world cost no more than their leaves meeting all others.
float BoxTree::fill_group(const BroadBox* boxes, int group, bool building) {
    constexpr float growth_cap = 1000;
    int fan_out = fan_out_[group_level()];
    BoxBlock& block = nodes_[first_node_[group_level()] + group];
    float sum = 0;
    for (int k = 0; k < fan_out; ++k) {
        int leaf = group * fan_out + k;
        size_t place = static_cast<size_t>(leaf) * block_size;
        const LeafBounds bounds =
            fill_leaf(nodes_[first_node_[levels_ - 1] + leaf], &index_[place], boxes, &slot_[place]);
        for (int d = 0; d < 3; ++d) {
            block.lower[d][k] = bounds.lower[d];
            block.upper[d][k] = bounds.upper[d];
        }
        float size = bounds.size();
        if (building) leaf_size_[leaf] = size;
        if (!bounds.finite()) sum = infinity;
        else if (size > leaf_size_[leaf]) sum += minimum(size / leaf_size_[leaf], growth_cap);
        else sum += 1;
    }
    for (int k = fan_out; k < block_size; ++k) clear_lane(block, k);
    return sum;
}

void BoxTree::fill_above_groups() {
    for (int level = group_level(); level > 0; --level) {
        int fan_out = fan_out_[level - 1];
        for (int i = 0; i < nodes_at_[level]; ++i) {
            float lower[3], upper[3];
            block_bounds(nodes_[first_node_[level] + i], lower, upper);
            set_lane(nodes_[first_node_[level - 1] + i / fan_out], i % fan_out, lower, upper);
        }
        for (int i = 0; i < nodes_at_[level - 1]; ++i) {
            for (int k = fan_out; k < block_size; ++k) clear_lane(nodes_[first_node_[level - 1] + i], k);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Queries

WideBox BoxTree::bounds_of(Ref group) const {
    if (group.level > 0) {
        int fan_out = fan_out_[group.level - 1];
        return spread_lane(block({group.level - 1, group.node / fan_out}), group.node % fan_out);
    }
    float lower[3], upper[3];
    block_bounds(block(group), lower, upper);
    return spread(lower, upper);
}

uint32_t BoxTree::boxes_in_leaf(int leaf) const {
    uint32_t lanes = 0;
    for (int i = 0; i < block_size; ++i) {
        lanes |= (slot_[static_cast<size_t>(leaf) * block_size + i] != no_box ? 1u : 0u) << i;
    }
    return lanes;
}

void BoxTree::prepare_look_up() {
    if (lanes_known_) return;
    lanes_known_ = true;
    lane_.assign(static_cast<size_t>(count_), no_box);
    if (empty()) return;
    for (int i = 0; i < slot_.count(); ++i) {
        if (slot_[i] != no_box) lane_[slot_[i]] = static_cast<uint32_t>(i);
    }
}

BroadBox BoxTree::box(int place) const {
    LENDULET_ASSERT(lanes_known_);
    int lane = static_cast<int>(lane_[place]);
    if (lane_[place] != no_box)
        return box_in(nodes_[first_node_[levels_ - 1] + lane / block_size], lane % block_size, index_[lane]);
    for (int i = 0; unbounded_.count() > i; ++i) {
        if (unbounded_slot_[i] == static_cast<uint32_t>(place)) return unbounded_[i];
    }
    return empty_box;
}

ScannedBoxes BoxTree::leaves() const {
    if (empty()) return {nullptr, nullptr, 0};
    return {&nodes_[first_node_[levels_ - 1]], index_.data(), count_bounded()};
}

const char* BoxTree::check() const {
    for (int level = 0; level + 1 < levels_ && !empty(); ++level) {
        for (int i = 0; i < nodes_at_[level]; ++i) {
            for (int k = 0; k < fan_out_[level]; ++k) {
                float lower[3], upper[3];
                block_bounds(block(child({level, i}, k)), lower, upper);
                for (int d = 0; d < 3; ++d) {
                    if (block({level, i}).lower[d][k] != lower[d] || block({level, i}).upper[d][k] != upper[d]) {
                        return "a node's bounds are not those of its children";
                    }
                }
            }
        }
    }
    int held = 0;
    if (empty()) return "";
    for (uint32_t slot : slot_) held += slot != no_box;
    return held == count_bounded() ? "" : "the leaves do not hold all boxes";
}

size_t BoxTree::bytes() const {
    return nodes_.bytes() + index_.bytes() + slot_.bytes() + lane_.bytes() + leaf_size_.bytes() +
           group_growth_.bytes() + unbounded_.bytes() + unbounded_slot_.bytes() + lane_.bytes() + centres_.bytes();
}

}  // namespace lendulet
