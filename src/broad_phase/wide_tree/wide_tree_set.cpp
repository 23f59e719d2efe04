#include "broad_phase/wide_tree/wide_tree_set.h"

#include "broad_phase/block.h"

namespace lendulet {

namespace {

constexpr int groups_per_task = 32;
constexpr Bounds6 no_bounds{{infinity, infinity, infinity, -infinity, -infinity, -infinity}};

bool holds(const Bounds6& outer, const Bounds6& inner) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) yes &= outer.at[d] <= inner.at[d] && outer.at[3 + d] >= inner.at[3 + d];
    return yes;
}

// The steps of a lane are those of its box, or of none.
bool steps_hold(const CoarseBoxes& coarse, size_t lane, const BroadBox& box, bool used) {
    const Bytes16 steps = steps_of(coarse, box);
    bool yes = true;
    for (int d = 0; d < 3; ++d) {
        yes &= coarse.bounds[d][lane] == (used ? steps[d] : 127);
        yes &= coarse.bounds[3 + d][lane] == (used ? steps[4 + d] : -128);
    }
    return yes;
}

int blocks_for(int children) { return (children + block_lanes - 1) / block_lanes; }

}  // namespace

WideTreeSet::WideTreeSet(const Memory* memory, const WideTreeKernels& kernels) : kernels_(kernels), order_(memory) {
    auto give = [&](auto&... arrays) { (arrays.set_memory(memory), ...); };
    give(groups_, coarse_, blocks_, place_, unbounded_, unbounded_place_, lane_of_, home_, size_, changed_, loosened_);
    give(marked_lane_, touched_, parents_, shrunk_, first_row_, rows_, row_lane_, row_steps_, moves_);
}

WideTreeView WideTreeSet::view() const {
    WideTreeView view;
    view.groups = groups_.data();
    view.coarse = coarse_.data();
    view.blocks = blocks_.data();
    view.group_count = groups_.count();
    view.lanes = place_.count();
    view.levels = levels_;
    for (int level = 0; level < levels_; ++level) view.first_block[level] = first_block_[level];
    return view;
}

void WideTreeSet::build(const BroadBox* boxes, int count, TaskPool* tasks) {
    count_ = count;
    mapped_ = false;
    order_.sort(boxes, count, tasks, place_, unbounded_place_);
    unbounded_.clear();
    for (uint32_t place : unbounded_place_) unbounded_.push_back(boxes[place]);
    int lanes = place_.count();
    groups_.resize_unset(static_cast<size_t>((lanes + group_lanes - 1) / group_lanes));
    coarse_.resize_unset(groups_.size());
    plan_levels(0);
    fill_groups(boxes, tasks);
    built_size_ = size_sum_;
    shuffled_ = false;
}

bool WideTreeSet::refill(const BroadBox* boxes, int count, TaskPool* tasks) {
    if (count != count_ || shuffled_) return false;
    for (size_t i = 0; i < unbounded_.size(); ++i) unbounded_[i] = boxes[unbounded_place_[i]];
    mapped_ = false;
    fill_groups(boxes, tasks);
    return size_sum_ <= most_growth * built_size_;
}

// Each box into the lane that its place has, and all bounds.
void WideTreeSet::fill_groups(const BroadBox* boxes, TaskPool* tasks) {
    const int lanes = place_.count();
    size_.resize_unset(groups_.size());
    auto fill = [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            int first = i * group_lanes, n = lanes - first;
            Bounds6 bounds;
            kernels_.fill(groups_[i], coarse_[i], boxes, place_.data() + first, n < group_lanes ? n : group_lanes,
                          bounds);
            set_bounds(0, static_cast<uint32_t>(i), bounds);
            size_[i] = size_of(bounds);
        }
    };
    if (tasks) tasks->for_each(groups_.count(), groups_per_task, fill);
    else fill(0, groups_.count(), 0);
    size_sum_ = 0;
    for (float size : size_) size_sum_ += size;
    raise_bounds();
}

// As many levels as needed. The last block of each is cleared, for its lanes without a child, but at level 0 only if it
// is block `first_cleared` or after.
void WideTreeSet::plan_levels(int first_cleared) {
    int total = 0;
    levels_ = 0;
    for (int children = groups_.count(); children > 0 && (levels_ == 0 || children > 1); ++levels_) {
        children = blocks_for(children);
        first_block_[levels_] = total;
        blocks_at_[levels_] = children;
        total += children;
    }
    blocks_.resize_unset(static_cast<size_t>(total));
    for (int level = 0; level < levels_; ++level) {
        int last = blocks_at_[level] - 1;
        if (level == 0 && last < first_cleared) continue;
        for (int k = 0; k < bound_count; ++k) {
            for (float& bound : blocks_[first_block_[level] + last].bounds[k]) bound = no_bounds.at[k];
        }
    }
}

void WideTreeSet::set_bounds(int level, uint32_t child, const Bounds6& bounds) {
    BoundsBlock& block = blocks_[static_cast<uint32_t>(first_block_[level]) + child / block_lanes];
    for (int k = 0; k < bound_count; ++k) block.bounds[k][child % block_lanes] = bounds.at[k];
}

Bounds6 WideTreeSet::bounds_at(int level, uint32_t child) const {
    const BoundsBlock& block = blocks_[static_cast<uint32_t>(first_block_[level]) + child / block_lanes];
    Bounds6 bounds;
    for (int k = 0; k < bound_count; ++k) bounds.at[k] = block.bounds[k][child % block_lanes];
    return bounds;
}

// The bounds of all levels from level 0.
void WideTreeSet::raise_bounds() {
    for (int level = 1; level < levels_; ++level) {
        for (int i = 0; i < blocks_at_[level - 1]; ++i) {
            Bounds6 bounds;
            kernels_.block_bounds(blocks_[first_block_[level - 1] + i], bounds);
            set_bounds(level, static_cast<uint32_t>(i), bounds);
        }
    }
}

void WideTreeSet::boxes(Array<BroadPhaseBox>& out) const {
    auto append = [&](const Bounds6& b, int depth, bool leaf, uint32_t index) {
        out.push_back({{b.at[0], b.at[1], b.at[2]}, {b.at[3], b.at[4], b.at[5]}, depth, leaf, index});
    };
    for (const BroadBox& b : unbounded_) {
        append({{b.lower[0], b.lower[1], b.lower[2], b.upper[0], b.upper[1], b.upper[2]}}, 0, true, b.index);
    }
    if (levels_ == 0) return;
    Bounds6 root;
    kernels_.block_bounds(blocks_[first_block_[levels_ - 1]], root);
    append(root, 0, false, no_box);
    for (int level = levels_ - 1; level >= 0; --level) {
        int children = level ? blocks_at_[level - 1] : groups_.count();
        for (int i = 0; i < children; ++i) {
            append(bounds_at(level, static_cast<uint32_t>(i)), levels_ - level, false, no_box);
        }
    }
    for (size_t lane = 0; lane < place_.size(); ++lane) {
        if (place_[lane] == no_box) continue;
        const BroadBox& b = groups_[lane / group_lanes].boxes[lane % group_lanes];
        append({{b.lower[0], b.lower[1], b.lower[2], b.upper[0], b.upper[1], b.upper[2]}}, levels_ + 1, true, b.index);
    }
}

const char* WideTreeSet::check() const {
    int held = unbounded_.count();
    for (int g = 0; g < groups_.count(); ++g) {
        Bounds6 outer = bounds_at(0, static_cast<uint32_t>(g)), inner;
        kernels_.group_bounds(groups_[g], inner);
        if (!holds(outer, inner)) return "a group does not hold its boxes";
        for (size_t i = 0; i < group_lanes; ++i) {
            size_t lane = static_cast<size_t>(g) * group_lanes + i;
            bool used = lane < place_.size() && place_[lane] != no_box;
            const BroadBox& box = groups_[g].boxes[i];
            if (used != (box.lower[0] <= box.upper[0]))
                return "a lane without a box is not empty, or the other way round";
            if (!steps_hold(coarse_[g], i, box, used)) return "the steps of a lane are not those of its box";
            if (used && mapped_ && lane_of_[place_[lane]] != lane) return "a place and its lane do not know each other";
            held += used;
        }
    }
    if (held != count_) return "boxes are missing, or there are too many";
    for (int level = 1; level < levels_; ++level) {
        for (int i = 0; i < blocks_at_[level - 1]; ++i) {
            Bounds6 inner;
            kernels_.block_bounds(blocks_[first_block_[level - 1] + i], inner);
            if (!holds(bounds_at(level, static_cast<uint32_t>(i)), inner)) return "a node does not hold its children";
        }
    }
    for (size_t i = 0; i < unbounded_.size(); ++i) {
        bool known = !mapped_ || lane_of_[unbounded_place_[i]] == (beside | static_cast<uint32_t>(i));
        if (!known) return "a box beside the tree is not where its place says";
    }
    for (uint64_t changed : changed_) {
        if (mapped_ && changed) return "a group still has marks";
    }
    return "";
}

size_t WideTreeSet::bytes() const {
    size_t sum = order_.bytes();
    auto add = [&](const auto&... arrays) { ((sum += arrays.bytes()), ...); };
    add(groups_, coarse_, blocks_, place_, unbounded_, unbounded_place_, lane_of_, home_, size_, changed_, loosened_);
    add(marked_lane_, touched_, parents_, shrunk_, first_row_, rows_, row_lane_, row_steps_, moves_);
    return sum;
}

}  // namespace lendulet
