// Changes of a set between frames; see wide_tree_set.h.
#include <algorithm>
#include <cfloat>

#include "base/prefetch.h"
#include "broad_phase/block.h"
#include "broad_phase/wide_tree/wide_tree_set.h"
#include "math/unbranched.h"
#include "math/wide/quads.h"

namespace lendulet {

namespace {

constexpr float all_space = FLT_MAX;
constexpr int ahead = 16;       // rows of a batch whose boxes are asked for
constexpr int most_near = 512;  // groups beyond so many are likely not to be near
// So often a group may lose what made its bounds before they are found anew: for that all its boxes have to be read.
constexpr uint8_t most_loosened = 3;

// A box may leave the bounds its group was built with by this share of their longest edge before it counts as one that
// jumps. Groups can then at most double their edges.
constexpr float leeway = 0.5f;

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

}  // namespace

void WideTreeSet::begin_changes() {
    touched_.clear();
    shrunk_.clear();
    marks_ = begun_marks_ = 0;
    first_touched_ = end_touched_ = 0;
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
    loosened_.assign(groups, 0);
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

void WideTreeSet::mark(const uint32_t* places, int count, Array<uint32_t>& unbounded) {
    touched_.reserve(touched_.size() + static_cast<size_t>(count));
    uint32_t* next = touched_.data() + touched_.size();
    for (int i = 0; i < count; ++i) {
        const uint32_t lane = lane_of_[places[i]], group = lane / group_lanes;
        if (lane & beside) {
            unbounded.push_back(places[i]);
            continue;
        }
        *next = group;  // whether it is new there is not to be foreseen
        next += one_if(changed_[group] == 0);
        changed_[group] |= uint64_t{1} << lane % group_lanes;
        ++marks_;
    }
    touched_.resize_unset(static_cast<size_t>(next - touched_.data()));
    list_marks();
}

// The lanes of the marks in order. Few groups are sorted; for many it is faster to look at all.
void WideTreeSet::list_marks() {
    if (touched_.size() * 16 < groups_.size()) {
        std::sort(touched_.begin(), touched_.end());  // order: total
    } else {
        touched_.resize_unset(groups_.size() + 1);
        size_t n = 0;
        for (size_t g = 0; g < groups_.size(); ++g) {
            touched_[n] = static_cast<uint32_t>(g);
            n += one_if(changed_[g] != 0);
        }
        touched_.resize_unset(n);
    }
    constexpr int usual = 6;  // marks of a group; a loop over them would end where the machine does not expect it
    marked_lane_.resize_unset(static_cast<size_t>(marks_) + ahead + usual);
    uint32_t* next = marked_lane_.data();
    for (uint32_t g : touched_) {
        uint64_t left = changed_[g];
        auto list = [&] {
            *next = g * group_lanes + static_cast<uint32_t>(__builtin_ctzll(left | uint64_t{1} << 63));
            next += one_if(left != 0);
            left &= left - 1;
        };
        for (int i = 0; i < usual; ++i) list();
        while (left) list();
        changed_[g] = 0;
    }
    for (int i = 0; i < ahead && marks_ > 0; ++i) next[i] = next[-1];
}

// Of whole groups, so that no group waits with one changed box while another is searched; `most` is at least as many as
// a group has, and no batch has more, for a second search of the few behind would cost almost a whole one. What the
// rows need lies scattered over the memory of both frames, and is asked for some rows ahead.
bool WideTreeSet::next_batch(const BroadBox* boxes, int most, Array<uint32_t>& jumped) {
    if (begun_marks_ == marks_) return false;
    const uint32_t* marked = marked_lane_.data();
    const int begin = begun_marks_;
    int end = marks_ - begin > most ? begin + most : marks_;
    while (end < marks_ && marked[end] / group_lanes == marked[end - 1] / group_lanes) --end;
    begun_marks_ = end;
    first_touched_ = end_touched_;
    while (end_touched_ < touched_.size() && touched_[end_touched_] <= marked[end - 1] / group_lanes) ++end_touched_;
    rows_.resize_unset(static_cast<size_t>(end - begin));
    row_lane_.resize_unset(static_cast<size_t>(end - begin));
    const uint32_t* place = place_.data();
    const BroadBox* home = home_.data();
    BoxGroup* groups = groups_.data();
    const CoarseBoxes* coarse = coarse_.data();
    const bool far = groups_.count() > most_near;
    WideTreeChange* row = rows_.data();
    uint32_t* row_lane = row_lane_.data();
    for (int i = begin; i < end; ++i) {
        const uint32_t lane = marked[i], g = lane / group_lanes, soon = marked[i + ahead];
        __builtin_prefetch(&boxes[place[soon]]);
        __builtin_prefetch(&groups[soon / group_lanes].boxes[soon % group_lanes], 1);
        if (far) prefetch<sizeof(CoarseBoxes) / 64>(&coarse[soon / group_lanes]);
        row->after = boxes[place[lane]];
        row->before = groups[g].boxes[lane % group_lanes];
        if (contains(home[g], row->after) && row->after.index == row->before.index) {
            *row_lane++ = lane;
            ++row;
            continue;
        }
        jumped.push_back(place[lane]);
    }
    rows_.resize_unset(static_cast<size_t>(row - rows_.data()));
    row_lane_.resize_unset(rows_.size());
    widen();
    return true;
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
    shrunk_.push_back(lane / group_lanes);
}

WideTreeChanges WideTreeSet::changes() const {
    return {changed_.data(), first_row_.data(), rows_.data(), row_lane_.data(), row_steps_.data()};
}

// The bounds of the levels above some groups, in order, from those below.
void WideTreeSet::raise(const uint32_t* groups, size_t count) {
    parents_.clear();
    parents_.append(groups, count);
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

// The boxes of after into their lanes, with the steps of both states, and what is above made to hold both. How many
// rows a group has is not to be foreseen, so what its rows come to together is written after each of them.
void WideTreeSet::widen() {
    row_steps_.resize_unset(rows_.size());
    kernels_.take_over(groups_.data(), coarse_.data(), rows_.data(), row_lane_.data(), rows_.count(),
                       row_steps_.data());
    moves_.resize_unset(rows_.size());
    GroupMove* next = moves_.data();  // after that of `now`
    GroupMove now{};
    now.group = no_box;
    for (uint32_t i = 0; i < rows_.size(); ++i) {
        const WideTreeChange& row = rows_[i];
        const uint32_t g = row_lane_[i] / group_lanes;
        const size_t first = one_if(g != now.group);
        next += first;
        const Quad old = (Quad)(Wide<uint32_t, 4>{} - static_cast<uint32_t>(first));  // not numbers: give the others
        auto kept = [&](Quad q) { return (Quad)((Wide<uint32_t, 4>)q | (Wide<uint32_t, 4>)old); };
        now.lower_before = minimum(kept(now.lower_before), lower_of(row.before));
        now.lower_after = minimum(kept(now.lower_after), lower_of(row.after));
        now.upper_before = maximum(kept(now.upper_before), upper_of(row.before));
        now.upper_after = maximum(kept(now.upper_after), upper_of(row.after));
        now.lanes = (now.lanes & (uint64_t{first} - 1)) | uint64_t{1} << row_lane_[i] % group_lanes;
        now.first_row += (i - now.first_row) & (0u - static_cast<uint32_t>(first));
        now.group = g;
        next[-1] = now;
    }
    shrunk_.reserve(shrunk_.size() + end_touched_ - first_touched_);
    uint32_t* shrunk = shrunk_.data() + shrunk_.size();
    for (const GroupMove* m = moves_.data(); m < next; ++m) {
        const Bounds6 bounds = bounds_at(0, m->group);
        const Quad lower{bounds.at[0], bounds.at[1], bounds.at[2], 0},
            upper{bounds.at[3], bounds.at[4], bounds.at[5], 0};
        // Sides that boxes leave which had made them what they are.
        const auto inwards = ((m->lower_before <= lower) & (m->lower_after > lower)) |
                             ((m->upper_before >= upper) & (m->upper_after < upper));
        const uint8_t loosened = loosened_[m->group] + ((mask_bits(inwards) & 7) != 0);
        loosened_[m->group] = loosened;
        *shrunk = m->group;
        shrunk += one_if(loosened >= most_loosened);
        changed_[m->group] = m->lanes;
        first_row_[m->group] = m->first_row;
        const Quad lowest = minimum(m->lower_after, lower), highest = maximum(m->upper_after, upper);
        set_bounds(0, m->group, {{lowest[0], lowest[1], lowest[2], highest[0], highest[1], highest[2]}});
    }
    shrunk_.resize_unset(static_cast<size_t>(shrunk - shrunk_.data()));
    raise(touched_.data() + first_touched_, end_touched_ - first_touched_);
}

void WideTreeSet::settle() {
    CoarseBoxes* coarse = coarse_.data();
    const StepsOfTwo* steps = row_steps_.data();
    for (uint32_t lane : row_lane_) store_steps(coarse[lane / group_lanes], lane % group_lanes, steps++->second);
    for (size_t i = first_touched_; i < end_touched_; ++i) changed_[touched_[i]] = 0;
}

void WideTreeSet::end_changes(int count) {
    lane_of_.resize(static_cast<size_t>(count), no_box);
    count_ = count;
    std::sort(shrunk_.begin(), shrunk_.end());  // order: total; those of boxes taken out come last, and twice
    uint32_t last = no_box;
    for (uint32_t g : shrunk_) {
        if (g == last) continue;
        last = g;
        loosened_[g] = 0;
        Bounds6 bounds;
        kernels_.group_bounds(groups_[g], bounds);
        set_bounds(0, g, bounds);
    }
    for (const Array<uint32_t>* groups : {&touched_, &shrunk_}) {
        for (uint32_t g : *groups) {
            if (g >= static_cast<uint32_t>(built_groups_)) break;
            const float size = size_of(bounds_at(0, g));
            size_sum_ += size - size_[g];
            size_[g] = size;
        }
    }
    raise(shrunk_.data(), shrunk_.size());
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
    loosened_.push_back(0);
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
