// Changes of a set between frames; see wide_tree_set.h.
#include <algorithm>
#include <cfloat>

#include "broad_phase/block.h"
#include "broad_phase/wide_tree/wide_tree_set.h"
#include "math/wide/quads.h"

namespace lendulet {

namespace {

using Quad = Wide<float, 4>;

constexpr float all_space = FLT_MAX;

// A box may leave the bounds its group was built with by this share of their longest edge before it counts as one that
// jumps. Groups can then at most double their edges.
constexpr float leeway = 0.5f;

constexpr uint8_t may_shrink = 3;  // in is_touched_: its bounds may have to be found anew

// Its edges are finite numbers.
bool measurable(const BroadBox& box) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) yes &= box.upper[d] - box.lower[d] <= FLT_MAX;
    return yes;
}

BroadBox home_of(const Bounds6& b) {
    float margin = leeway * maximum(maximum(b.at[3] - b.at[0], b.at[4] - b.at[1]), b.at[5] - b.at[2]);
    BroadBox home{};
    for (int d = 0; d < 3; ++d) {
        home.lower[d] = b.at[d] - margin;
        home.upper[d] = b.at[3 + d] + margin;
    }
    return home;
}

Quad lower_of(const BroadBox& box) { return load_wide<Quad>(box.lower); }
Quad upper_of(const BroadBox& box) { return load_wide<Quad>(box.upper); }

bool contains(const BroadBox& home, const BroadBox& box) {
    return three_at_most(lower_of(home), lower_of(box), upper_of(box), upper_of(home));
}

BroadBox around(const BroadBox& a, const BroadBox& b) {
    BroadBox both;
    store_wide(both.lower, minimum(lower_of(a), lower_of(b)));
    store_wide(both.upper, maximum(upper_of(a), upper_of(b)));
    return both;
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
    return groups_[lane / group_lanes].boxes[lane % group_lanes];
}

uint32_t WideTreeSet::index_at(uint32_t place) const {
    uint32_t lane = lane_of_[place];
    return lane & beside ? unbounded_[lane & ~beside].index
                         : groups_[lane / group_lanes].boxes[lane % group_lanes].index;
}

void WideTreeSet::swap_places(uint32_t a, uint32_t b) {
    std::swap(lane_of_[a], lane_of_[b]);
    for (uint32_t place : {a, b}) {
        uint32_t lane = lane_of_[place];
        (lane & beside ? unbounded_place_[lane & ~beside] : place_[lane]) = place;
    }
}

void WideTreeSet::touch(uint32_t group) {
    if (!is_touched_[group]) touched_.push_back(group);
    is_touched_[group] |= 1;
}

void WideTreeSet::mark(const uint32_t* places, int count, Array<uint32_t>& unbounded) {
    touched_.reserve(touched_.size() + static_cast<size_t>(count));
    uint32_t* next = touched_.data() + touched_.size();
    for (int i = 0; i < count; ++i) {
        const uint32_t lane = lane_of_[places[i]], group = lane / group_lanes;
        if (lane & beside) {
            unbounded.push_back(places[i]);
            continue;
        }
        changed_[group] |= uint64_t{1} << lane % group_lanes;
        ++marks_;
        *next = group;  // whether it is new there is not to be foreseen
        next += !is_touched_[group];
        is_touched_[group] = 1;
    }
    touched_.resize_unset(static_cast<size_t>(next - touched_.data()));
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
    uint32_t* next = row_lane_.data();
    for (uint32_t g : touched_) {
        first_row_[g] = static_cast<uint32_t>(next - row_lane_.data());
        uint64_t left = changed_[g];
        do {
            *next++ = g * group_lanes + static_cast<uint32_t>(__builtin_ctzll(left));
        } while (left &= left - 1);
    }
    uint32_t* lanes = row_lane_.data();
    const auto marks = static_cast<size_t>(next - lanes);
    for (size_t i = 0; i < ahead && marks > 0; ++i) lanes[marks + i] = lanes[marks - 1];
    const uint32_t* place = place_.data();
    const BroadBox* home = home_.data();
    BoxGroup* groups = groups_.data();
    WideTreeChange* row = rows_.data();
    for (size_t i = 0; i < marks; ++i) {
        const uint32_t lane = lanes[i], g = lane / group_lanes, soon = lanes[i + ahead];
        __builtin_prefetch(&boxes[place[soon]]);
        __builtin_prefetch(&groups[soon / group_lanes].boxes[soon % group_lanes], 1);
        row->after = boxes[place[lane]];
        row->before = groups[g].boxes[lane % group_lanes];
        if (contains(home[g], row->after) && row->after.index == row->before.index) {
            lanes[row++ - rows_.data()] = lane;
            continue;
        }
        changed_[g] &= ~(uint64_t{1} << lane % group_lanes);
        jumped.push_back(place[lane]);
    }
    const auto n = static_cast<uint32_t>(row - rows_.data());
    rows_.resize_unset(n);
    row_lane_.resize_unset(n);
    if (n == marks) return;
    for (uint32_t i = n; i-- > 0;) first_row_[row_lane_[i] / group_lanes] = i;
}

void WideTreeSet::clear_lane(uint32_t lane) {
    clear_box(groups_[lane / group_lanes].boxes[lane % group_lanes]);
    clear_steps(coarse_[lane / group_lanes], lane % group_lanes);
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
    is_touched_[lane / group_lanes] = may_shrink;
}

WideTreeChanges WideTreeSet::changes() const {
    return {changed_.data(), first_row_.data(), rows_.data(), row_lane_.data()};
}

// The bounds of the levels above some groups, in order, from those below.
void WideTreeSet::raise(const Array<uint32_t>& groups) {
    parents_.clear();
    parents_.append(groups.data(), groups.size());
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
    const uint32_t *lanes = row_lane_.data(), *end = lanes + rows_.size();
    const WideTreeChange* row = rows_.data();
    while (lanes < end) {
        const uint32_t g = *lanes / group_lanes;
        BoxGroup& group = groups_[g];
        CoarseBoxes& coarse = coarse_[g];
        const Bounds6 bounds = bounds_at(0, g);
        const Quad lower{bounds.at[0], bounds.at[1], bounds.at[2], 0},
            upper{bounds.at[3], bounds.at[4], bounds.at[5], 0};
        Quad lowest = lower, highest = upper;
        auto inwards = lower > upper;  // sides that a box leaves which has made them what they are
        for (; lanes < end && *lanes / group_lanes == g; ++lanes, ++row) {
            const Quad low = lower_of(row->after), high = upper_of(row->after);
            set_steps(coarse, *lanes % group_lanes, around(row->before, row->after));
            group.boxes[*lanes % group_lanes] = row->after;
            inwards |= (lower_of(row->before) <= lower) & (low > lower);
            inwards |= (upper_of(row->before) >= upper) & (high < upper);
            lowest = minimum(low, lowest);
            highest = maximum(high, highest);
        }
        if (mask_bits(inwards) & 7) is_touched_[g] = may_shrink;
        set_bounds(0, g, {{lowest[0], lowest[1], lowest[2], highest[0], highest[1], highest[2]}});
    }
    raise(touched_);
}

void WideTreeSet::settle(int count) {
    CoarseBoxes* coarse = coarse_.data();
    const uint32_t* lane = row_lane_.data();
    for (const WideTreeChange& row : rows_) {
        set_steps(coarse[*lane / group_lanes], *lane % group_lanes, row.after);
        ++lane;
    }
    shrunk_.clear();
    for (uint32_t g : touched_) {
        Bounds6 bounds;
        if (is_touched_[g] == may_shrink) {
            kernels_.group_bounds(groups_[g], bounds);
            set_bounds(0, g, bounds);
            shrunk_.push_back(g);
        } else {
            bounds = bounds_at(0, g);
        }
        if (g < static_cast<uint32_t>(built_groups_)) {
            float size = size_of(bounds);
            size_sum_ += size - size_[g];
            size_[g] = size;
        }
        changed_[g] = 0;
        is_touched_[g] = 0;
    }
    raise(shrunk_);
    lane_of_.resize(static_cast<size_t>(count), no_box);
    count_ = count;
}

// A loose group at the end, empty.
void WideTreeSet::add_group() {
    int before = groups_.count();
    groups_.resize_unset(groups_.size() + 1);
    coarse_.resize_unset(groups_.size());
    Bounds6 all{};
    if (levels_ > 0) kernels_.block_bounds(blocks_[first_block_[levels_ - 1]], all);
    set_frame(coarse_.back(), all);
    place_.resize(static_cast<size_t>(before) * group_lanes, no_box);  // the last group may have been cut short
    place_.resize(groups_.size() * group_lanes, no_box);
    uint32_t first = static_cast<uint32_t>(before) * group_lanes;
    for (uint32_t i = 0; i < group_lanes; ++i) clear_lane(first + i);
    home_.push_back({{-all_space, -all_space, -all_space}, 0, {all_space, all_space, all_space}, 0});
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
    groups_[g].boxes[i] = box;
    set_steps(coarse_[g], i, box);
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
