// Changes of a set between frames; see wide_tree_set.h.
#include <algorithm>
#include <cfloat>

#include "broad_phase/block.h"
#include "broad_phase/wide_tree/wide_tree_set.h"

namespace lendulet {

namespace {

constexpr float all_space = FLT_MAX;

// A box may leave the bounds its group was built with by this share of their longest edge before it counts as one that
// jumps. Groups can then at most double their edges; measured, a quarter more or less shows in no scene.
constexpr float leeway = 0.5f;

bool bounded(const BroadBox& box) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) yes &= box.upper[d] - box.lower[d] <= FLT_MAX;
    return yes;
}

float size_of(const Bounds6& b) {
    float size = (b.at[3] - b.at[0]) + (b.at[4] - b.at[1]) + (b.at[5] - b.at[2]);
    return size > 0 ? size : 0;  // of no boxes: 0
}

Bounds6 home_of(const Bounds6& b) {
    float margin = leeway * maximum(maximum(b.at[3] - b.at[0], b.at[4] - b.at[1]), b.at[5] - b.at[2]);
    Bounds6 home;
    for (int d = 0; d < 3; ++d) {
        home.at[d] = b.at[d] - margin;
        home.at[3 + d] = b.at[3 + d] + margin;
    }
    return home;
}

bool contains(const Bounds6& home, const BroadBox& box) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) yes &= (box.lower[d] >= home.at[d]) & (box.upper[d] <= home.at[3 + d]);
    return yes;
}

}  // namespace

void WideTreeSet::begin_changes() {
    touched_.clear();
    if (mapped_) return;
    mapped_ = true;
    lane_of_.resize_unset(static_cast<size_t>(count_));
    for (size_t i = 0; i < place_.size(); ++i) lane_of_[place_[i]] = static_cast<uint32_t>(i);
    for (size_t i = 0; i < unbounded_place_.size(); ++i) lane_of_[unbounded_place_[i]] = beside | static_cast<uint32_t>(i);
    built_groups_ = groups_.count();
    loose_used_ = group_lanes;
    wear_ = 0;
    size_t groups = groups_.size();
    home_.resize_unset(groups);
    size_.resize_unset(groups);
    first_change_.resize_unset(groups);
    changed_.assign(groups, 0);
    is_touched_.assign(groups, 0);
    size_sum_ = 0;
    for (size_t i = 0; i < groups; ++i) {
        Bounds6 bounds = bounds_at(0, static_cast<uint32_t>(i));
        home_[i] = home_of(bounds);
        size_[i] = size_of(bounds);
        size_sum_ += size_[i];
    }
    built_size_ = size_sum_;
}

BroadBox WideTreeSet::box_at(uint32_t place) const {
    uint32_t lane = lane_of_[place];
    if (lane & beside) return unbounded_[lane & ~beside];
    const BoxGroup& group = groups_[lane / group_lanes];
    BroadBox box{};
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = group.bounds[d][lane % group_lanes];
        box.upper[d] = group.bounds[3 + d][lane % group_lanes];
    }
    box.index = group.index[lane % group_lanes];
    return box;
}

uint32_t WideTreeSet::index_at(uint32_t place) const {
    uint32_t lane = lane_of_[place];
    return lane & beside ? unbounded_[lane & ~beside].index : groups_[lane / group_lanes].index[lane % group_lanes];
}

void WideTreeSet::swap_places(uint32_t a, uint32_t b) {
    std::swap(lane_of_[a], lane_of_[b]);
    for (uint32_t place : {a, b}) {
        uint32_t lane = lane_of_[place];
        (lane & beside ? unbounded_place_[lane & ~beside] : place_[lane]) = place;
    }
}

void WideTreeSet::touch(uint32_t group) {
    if (is_touched_[group]) return;
    is_touched_[group] = 1;
    touched_.push_back(group);
}

bool WideTreeSet::mark(uint32_t place) {
    uint32_t lane = lane_of_[place];
    if (lane & beside) return false;
    changed_[lane / group_lanes] |= uint64_t{1} << lane % group_lanes;
    touch(lane / group_lanes);
    return true;
}

// Few are sorted; for many it is faster to look at all groups.
void WideTreeSet::sort_touched() {
    if (touched_.size() * 16 < groups_.size()) {
        std::sort(touched_.begin(), touched_.end());  // order: total
        return;
    }
    size_t n = 0;
    for (size_t i = 0; i < groups_.size(); ++i) {
        if (is_touched_[i]) touched_[n++] = static_cast<uint32_t>(i);
    }
}

void WideTreeSet::gather(const BroadBox* boxes, Array<uint32_t>& jumped) {
    sort_touched();
    changed_lane_.clear();
    size_t most = WideTreeChanges::padding;
    for (uint32_t group : touched_) most += static_cast<size_t>(__builtin_popcountll(changed_[group]));
    changed_lane_.resize_unset(most);
    changed_index_.resize_unset(most);
    for (int k = 0; k < bound_count; ++k) {
        before_[k].resize_unset(most);
        after_[k].resize_unset(most);
    }
    size_t n = 0;
    for (uint32_t g : touched_) {
        const BoxGroup& group = groups_[g];
        const Bounds6 home = home_[g];
        first_change_[g] = static_cast<uint32_t>(n);
        for (uint64_t left = changed_[g]; left; left &= left - 1) {
            int i = __builtin_ctzll(left);
            uint32_t lane = g * group_lanes + static_cast<uint32_t>(i);
            const BroadBox& box = boxes[place_[lane]];
            if (!contains(home, box) || box.index != group.index[i]) {
                changed_[g] &= ~(uint64_t{1} << i);
                jumped.push_back(place_[lane]);
                continue;
            }
            for (int d = 0; d < 3; ++d) {
                before_[d][n] = group.bounds[d][i];
                before_[3 + d][n] = group.bounds[3 + d][i];
                after_[d][n] = box.lower[d];
                after_[3 + d][n] = box.upper[d];
            }
            changed_index_[n] = box.index;
            changed_lane_[n++] = lane;
        }
    }
    changed_index_.resize_unset(n + WideTreeChanges::padding);
    changed_lane_.resize_unset(n);
}

void WideTreeSet::clear_lane(uint32_t lane) {
    BoxGroup& group = groups_[lane / group_lanes];
    for (int k = 0; k < bound_count; ++k) group.bounds[k][lane % group_lanes] = k < 3 ? infinity : -infinity;
    place_[lane] = no_box;
}

void WideTreeSet::remove(uint32_t place) {
    uint32_t lane = lane_of_[place];
    lane_of_[place] = no_box;
    if (lane & beside) {
        uint32_t i = lane & ~beside;
        unbounded_[i] = unbounded_.back();
        unbounded_place_[i] = unbounded_place_.back();
        lane_of_[unbounded_place_[i]] = lane;
        lane_of_[place] = no_box;
        unbounded_.pop_back();
        unbounded_place_.pop_back();
        return;
    }
    clear_lane(lane);
    touch(lane / group_lanes);
}

WideTreeChanges WideTreeSet::changes() const {
    WideTreeChanges changes;
    changes.changed = changed_.data();
    changes.first = first_change_.data();
    changes.index = changed_index_.data();
    for (int k = 0; k < bound_count; ++k) {
        changes.before[k] = before_[k].data();
        changes.after[k] = after_[k].data();
    }
    return changes;
}

// The bounds of the levels above the touched groups from those below.
void WideTreeSet::raise_touched() {
    parents_.clear();
    parents_.append(touched_.data(), touched_.size());
    for (int level = 1; level < levels_; ++level) {
        size_t n = 0;
        for (uint32_t child : parents_) {
            uint32_t parent = child / block_lanes;
            if (n && parents_[n - 1] == parent) continue;
            Bounds6 bounds;
            kernels_.block_bounds(blocks_[static_cast<uint32_t>(first_block_[level - 1]) + parent], bounds);
            set_bounds(level, parent, bounds);
            parents_[n++] = parent;
        }
        parents_.resize_unset(n);
    }
}

void WideTreeSet::widen() {
    sort_touched();
    for (uint32_t g : touched_) {
        Bounds6 bounds = bounds_at(0, g);
        uint32_t first = first_change_[g];
        for (uint32_t i = first; i < first + static_cast<uint32_t>(__builtin_popcountll(changed_[g])); ++i) {
            for (int d = 0; d < 3; ++d) {
                bounds.at[d] = minimum(after_[d][i], bounds.at[d]);
                bounds.at[3 + d] = maximum(after_[3 + d][i], bounds.at[3 + d]);
            }
        }
        set_bounds(0, g, bounds);
    }
    raise_touched();
}

void WideTreeSet::settle(int count) {
    for (size_t i = 0; i < changed_lane_.size(); ++i) {
        uint32_t lane = changed_lane_[i];
        BoxGroup& group = groups_[lane / group_lanes];
        for (int k = 0; k < bound_count; ++k) group.bounds[k][lane % group_lanes] = after_[k][i];
    }
    for (uint32_t g : touched_) {
        Bounds6 bounds;
        kernels_.group_bounds(groups_[g], bounds);
        set_bounds(0, g, bounds);
        if (g < static_cast<uint32_t>(built_groups_)) {
            float size = size_of(bounds);
            size_sum_ += size - size_[g];
            size_[g] = size;
        }
        changed_[g] = 0;
        is_touched_[g] = 0;
    }
    raise_touched();
    lane_of_.resize(static_cast<size_t>(count), no_box);
    count_ = count;
}

// A loose group at the end, empty.
void WideTreeSet::add_group() {
    int before = groups_.count();
    groups_.push_back(BoxGroup{});
    place_.resize(static_cast<size_t>(before) * group_lanes, no_box);  // the last group may have been cut short
    place_.resize(groups_.size() * group_lanes, no_box);
    uint32_t first = static_cast<uint32_t>(before) * group_lanes;
    for (uint32_t i = 0; i < group_lanes; ++i) clear_lane(first + i);
    home_.push_back({{-all_space, -all_space, -all_space, all_space, all_space, all_space}});
    size_.push_back(0);
    changed_.push_back(0);
    is_touched_.push_back(0);
    first_change_.push_back(0);
    loose_used_ = 0;
    if (before % block_lanes) return;
    plan_levels(before / block_lanes);
    raise_bounds();
}

void WideTreeSet::insert(uint32_t place, const BroadBox& box) {
    if (!bounded(box)) {
        lane_of_[place] = beside | static_cast<uint32_t>(unbounded_.count());
        unbounded_.push_back(box);
        unbounded_place_.push_back(place);
        return;
    }
    if (loose_used_ == group_lanes) add_group();
    uint32_t g = static_cast<uint32_t>(groups_.count()) - 1, i = static_cast<uint32_t>(loose_used_++);
    BoxGroup& group = groups_[g];
    group.index[i] = box.index;
    place_[g * group_lanes + i] = place;
    lane_of_[place] = g * group_lanes + i;
    uint32_t child = g;
    for (int d = 0; d < 3; ++d) {
        group.bounds[d][i] = box.lower[d];
        group.bounds[3 + d][i] = box.upper[d];
    }
    for (int level = 0; level < levels_; ++level, child /= block_lanes) {
        Bounds6 bounds = bounds_at(level, child);
        for (int d = 0; d < 3; ++d) {
            bounds.at[d] = minimum(box.lower[d], bounds.at[d]);
            bounds.at[3 + d] = maximum(box.upper[d], bounds.at[3 + d]);
        }
        set_bounds(level, child, bounds);
    }
}

// Building costs about as much as visiting one group for every four boxes. Each query since the last build has visited
// the loose boxes for nothing; once that adds up to a build, it is time for one, and the sum is at most twice what the
// best moment would have cost. Groups that have grown by a quarter call for one at once.
bool WideTreeSet::worn(int queries) {
    wear_ += static_cast<int64_t>(loose_lanes()) * queries;
    return wear_ * 4 > static_cast<int64_t>(count_) * group_lanes || size_sum_ > 1.25 * built_size_;
}

}  // namespace lendulet
