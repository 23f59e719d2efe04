// Changes of a set between frames; see wide_tree_set.h.
#include <algorithm>
#include <cfloat>

#include "broad_phase/block.h"
#include "broad_phase/wide_tree/wide_tree_set.h"

namespace lendulet {

namespace {

constexpr float all_space = FLT_MAX;

// A box may leave the bounds its group was built with by this share of their longest edge before it counts as one that
// jumps. Groups can then at most double their edges.
constexpr float leeway = 0.5f;

// Its edges are finite numbers.
bool measurable(const BroadBox& box) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) yes &= box.upper[d] - box.lower[d] <= FLT_MAX;
    return yes;
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

void read_lane(const BoxGroup& group, uint32_t i, BroadBox& box) {
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = group.bounds[d][i];
        box.upper[d] = group.bounds[3 + d][i];
    }
    box.index = group.index[i];
}

void write_lane(BoxGroup& group, uint32_t i, const BroadBox& box) {
    for (int d = 0; d < 3; ++d) {
        group.bounds[d][i] = box.lower[d];
        group.bounds[3 + d][i] = box.upper[d];
    }
    group.index[i] = box.index;
}

}  // namespace

void WideTreeSet::begin_changes() {
    touched_.clear();
    marks_ = 0;
    if (mapped_) return;
    mapped_ = true;
    lane_of_.resize_unset(static_cast<size_t>(count_));
    for (size_t i = 0; i < place_.size(); ++i) lane_of_[place_[i]] = static_cast<uint32_t>(i);
    for (size_t i = 0; i < unbounded_place_.size(); ++i)
        lane_of_[unbounded_place_[i]] = beside | static_cast<uint32_t>(i);
    built_groups_ = groups_.count();
    loose_used_ = group_lanes;
    wear_ = 0;
    size_t groups = groups_.size();
    home_.resize_unset(groups);
    first_row_.resize_unset(groups);
    changed_.assign(groups, 0);
    is_touched_.assign(groups, 0);
    for (size_t i = 0; i < groups; ++i) home_[i] = home_of(bounds_at(0, static_cast<uint32_t>(i)));
}

BroadBox WideTreeSet::box_at(uint32_t place) const {
    uint32_t lane = lane_of_[place];
    if (lane & beside) return unbounded_[lane & ~beside];
    const BoxGroup& group = groups_[lane / group_lanes];
    BroadBox box{};
    read_lane(group, lane % group_lanes, box);
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
    touched_.reserve(touched_.size() + 1);
    touched_.data()[touched_.size()] = group;
    touched_.resize_unset(touched_.size() + !is_touched_[group]);
    is_touched_[group] = 1;
}

bool WideTreeSet::mark(uint32_t place) {
    uint32_t lane = lane_of_[place];
    if (lane & beside) return false;
    changed_[lane / group_lanes] |= uint64_t{1} << lane % group_lanes;
    ++marks_;
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

// First the lanes of the marks, so that what the rows need can be asked for some rows ahead: it is scattered over the
// memory of both frames.
void WideTreeSet::gather(const BroadBox* boxes, Array<uint32_t>& jumped) {
    constexpr size_t ahead = 12;
    sort_touched();
    rows_.resize_unset(static_cast<size_t>(marks_));
    row_lane_.resize_unset(static_cast<size_t>(marks_) + ahead);
    size_t marks = 0;
    for (uint32_t g : touched_) {
        for (uint64_t left = changed_[g]; left; left &= left - 1) {
            row_lane_[marks++] = g * group_lanes + static_cast<uint32_t>(__builtin_ctzll(left));
        }
    }
    for (size_t i = 0; i < ahead && marks > 0; ++i) row_lane_[marks + i] = row_lane_[marks - 1];
    uint32_t n = 0, last = no_box;
    for (size_t i = 0; i < marks; ++i) {
        const uint32_t lane = row_lane_[i], g = lane / group_lanes, soon = row_lane_[i + ahead];
        __builtin_prefetch(&boxes[place_[soon]]);
        for (int k = 0; k < bound_count; ++k) {
            __builtin_prefetch(&groups_[soon / group_lanes].bounds[k][soon % group_lanes], 1);
        }
        if (g != last) first_row_[g] = n;
        last = g;
        WideTreeChange& row = rows_[n];
        row.after = boxes[place_[lane]];
        read_lane(groups_[g], lane % group_lanes, row.before);
        row_lane_[n] = lane;
        if (contains(home_[g], row.after) && row.after.index == row.before.index) {
            ++n;
            continue;
        }
        changed_[g] &= ~(uint64_t{1} << lane % group_lanes);
        jumped.push_back(place_[lane]);
    }
    rows_.resize_unset(n);
    row_lane_.resize_unset(n);
}

void WideTreeSet::clear_lane(uint32_t lane) {
    BoxGroup& group = groups_[lane / group_lanes];
    for (int k = 0; k < bound_count; ++k) group.bounds[k][lane % group_lanes] = k < 3 ? infinity : -infinity;
    place_[lane] = no_box;
}

void WideTreeSet::remove(uint32_t place) {
    shuffled_ = true;
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
    return {changed_.data(), first_row_.data(), rows_.data(), row_lane_.data()};
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

void WideTreeSet::extend_bounds(int level, uint32_t child, const BroadBox& box) {
    BoundsBlock& block = blocks_[static_cast<uint32_t>(first_block_[level]) + child / block_lanes];
    for (int d = 0; d < 3; ++d) {
        float &lower = block.bounds[d][child % block_lanes], &upper = block.bounds[3 + d][child % block_lanes];
        lower = minimum(box.lower[d], lower);
        upper = maximum(box.upper[d], upper);
    }
}

void WideTreeSet::widen() {
    sort_touched();
    for (size_t i = 0; i < rows_.size(); ++i) {
        const WideTreeChange& row = rows_[i];
        BroadBox around = row.after;
        for (int d = 0; d < 3; ++d) {
            around.lower[d] = minimum(row.before.lower[d], row.after.lower[d]);
            around.upper[d] = maximum(row.before.upper[d], row.after.upper[d]);
        }
        write_lane(groups_[row_lane_[i] / group_lanes], row_lane_[i] % group_lanes, around);
        extend_bounds(0, row_lane_[i] / group_lanes, row.after);
    }
    raise_touched();
}

void WideTreeSet::settle(int count) {
    for (size_t i = 0; i < rows_.size(); ++i) {
        write_lane(groups_[row_lane_[i] / group_lanes], row_lane_[i] % group_lanes, rows_[i].after);
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
    first_row_.push_back(0);
    loose_used_ = 0;
    if (before % block_lanes) return;
    plan_levels(before / block_lanes);
    raise_bounds();
}

void WideTreeSet::insert(uint32_t place, const BroadBox& box) {
    shuffled_ = true;
    if (!measurable(box)) {
        lane_of_[place] = beside | static_cast<uint32_t>(unbounded_.count());
        unbounded_.push_back(box);
        unbounded_place_.push_back(place);
        return;
    }
    if (loose_used_ == group_lanes) add_group();
    uint32_t g = static_cast<uint32_t>(groups_.count()) - 1, i = static_cast<uint32_t>(loose_used_++);
    write_lane(groups_[g], i, box);
    place_[g * group_lanes + i] = place;
    lane_of_[place] = g * group_lanes + i;
    for (int level = 0; level < levels_; ++level, g /= block_lanes) extend_bounds(level, g, box);
}

// Building costs about as much as visiting one group for every four boxes. Each query since the last build has visited
// the loose boxes for nothing; once that adds up to a build, it is time for one, and the sum is at most twice what the
// best moment would have cost. Groups that have grown by a quarter call for one at once.
bool WideTreeSet::worn(int queries) {
    wear_ += static_cast<int64_t>(loose_lanes()) * queries;
    return wear_ * 4 > static_cast<int64_t>(count_) * group_lanes || size_sum_ > most_growth * built_size_;
}

}  // namespace lendulet
