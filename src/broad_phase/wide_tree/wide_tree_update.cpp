// The wide tree between frames. What changes goes three ways:
// - boxes that moved a little keep their lanes; batch after batch, in the order of the groups, they are searched with
//   their boxes of before and after, among those that have changed already and those that have not yet;
// - single boxes that jumped, came or went are then taken out of this state and put into the new one, each by a query;
// - if most did, all pairs of this state and of a newly built tree are compared.
// What each step begins and ends adds up to what the frame does: it is counted pair by pair when the lists are sorted.
#include <algorithm>

#include "broad_phase/sort.h"
#include "broad_phase/wide_tree/wide_tree.h"
#include "math/unbranched.h"

namespace lendulet {

namespace {

constexpr int boxes_per_batch = 64;  // as many as are searched together: 4 kB, and 20 groups that they change

uint64_t key_of(const BoxPair& pair) { return uint64_t{pair.a} << 32 | pair.b; }

}  // namespace

void WideTree::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                      Array<BoxPair>& begun, Array<BoxPair>& ended) {
    moving_.begin_changes();
    const int before = moving_.count(), common = std::min(before, count);
    if (count < before) adopt_removed(boxes, count, changed, changed_count);
    special_.clear();
    const uint32_t* known = std::lower_bound(changed, changed + changed_count, static_cast<uint32_t>(common));
    moving_.mark(changed, static_cast<int>(known - changed), special_);
    changes_.clear();
    // One after the other, batches stay in the nearest caches from their collection to their end; many workers need
    // all at once.
    const int batch = tasks.workers() == 1 ? boxes_per_batch : changed_count;
    while (moving_.next_batch(boxes, batch, special_)) {
        find_changes(tasks);
        moving_.settle();
    }
    const int singles = special_.count() + (before - common) + (count - common);
    // Two queries of a single box (about 160 ns each) cost as much as eight boxes in two searches and a build.
    if (int64_t{singles} * 8 > count + int64_t{256}) {
        replace(tasks, boxes, count);
    } else {
        for (uint32_t place : special_) take_out(place);
        for (int place = common; place < before; ++place) take_out(static_cast<uint32_t>(place));
        moving_.end_changes(count);
        for (uint32_t place : special_) put_in(place, boxes[place]);
        for (int place = common; place < count; ++place) put_in(static_cast<uint32_t>(place), boxes[place]);
        if (moving_.worn(moving_.changed_groups() + 2 * singles)) set_moving(boxes, count, &tasks);
    }
    sort_changes(begun, ended);
}

// Where a caller fills the hole of a removed box with his last one, that box keeps its lane.
void WideTree::adopt_removed(const BroadBox* boxes, int count, const uint32_t* changed, int changed_count) {
    removed_.clear();
    for (int place = count; place < moving_.count(); ++place) {
        uint32_t p = static_cast<uint32_t>(place);
        removed_.push_back(uint64_t{moving_.index_at(p)} << 32 | p);
    }
    sort_keys(removed_, swap_);
    for (int i = 0; i < changed_count && changed[i] < static_cast<uint32_t>(count); ++i) {
        uint32_t index = boxes[changed[i]].index;
        if (index == moving_.index_at(changed[i])) continue;
        const uint64_t* found = std::lower_bound(removed_.begin(), removed_.end(), uint64_t{index} << 32);
        if (found == removed_.end() || *found >> 32 != index) continue;
        moving_.swap_places(changed[i], static_cast<uint32_t>(*found));
    }
}

void WideTree::find_changes(TaskPool& tasks) {
    constexpr int grain = 32;  // boxes
    const WideTreeView moving = moving_.view(), fixed = fixed_.view();
    const WideTreeChanges changes = moving_.changes();
    chunks_.search(tasks, moving_.changed_count(), grain, changes_, [&](int begin, int end, PairList& list) {
        PairRoom room(list);
        kernels_.find_changes(moving, fixed, changes, begin, end, room);
    });
    for (const WideTreeSet* set : {&moving_, &fixed_}) {
        for (const BroadBox& box : set->unbounded()) {
            for (int i = 0; i < moving_.changed_count(); ++i) {
                const auto& [before, after] = changes.rows[i];
                bool was = overlap(box, before.lower, before.upper), is = overlap(box, after.lower, after.upper);
                if (was != is) note(box.index, after.index, is);
            }
        }
    }
}

// Begun pairs are noted with a < b, ended ones with a > b, as the kernels do.
void WideTree::note(uint32_t a, uint32_t b, bool begins) {
    changes_.push_back((a < b) == begins ? BoxPair{a, b} : BoxPair{b, a});
}

void WideTree::take_out(uint32_t place) {
    const BroadBox box = moving_.box_at(place);
    moving_.remove(place);
    visit_overlapping(box.lower, box.upper, [&](uint32_t other) { note(box.index, other, false); });
}

void WideTree::put_in(uint32_t place, const BroadBox& box) {
    visit_overlapping(box.lower, box.upper, [&](uint32_t other) { note(box.index, other, true); });
    moving_.insert(place, box);
}

// From the state that changes_ leads to.
void WideTree::replace(TaskPool& tasks, const BroadBox* boxes, int count) {
    auto all_pairs = [&](Array<uint64_t>& keys) {
        found_.clear();
        find_pairs(tasks, found_);
        keys.clear();
        for (const BoxPair& pair : found_) keys.push_back(key_of(pair));
        sort_keys(keys, swap_);
    };
    all_pairs(ended_);
    set_moving(boxes, count, &tasks);
    all_pairs(begun_);
    found_.clear();
    lost_.clear();
    append_differences(begun_, ended_, found_, lost_);
    for (const BoxPair& pair : found_) note(pair.a, pair.b, true);
    for (const BoxPair& pair : lost_) note(pair.a, pair.b, false);
}

// What changes in several steps may begin and end, or the other way round, and more than once: that cancels.
void WideTree::sort_changes(Array<BoxPair>& begun, Array<BoxPair>& ended) {
    begun_.resize_unset(changes_.size());
    ended_.resize_unset(changes_.size());
    size_t begins = 0, ends = 0;
    for (const BoxPair& pair : changes_) {  // which of both it is cannot be foreseen: written to both lists
        const bool is = pair.a < pair.b;
        begun_.data()[begins] = key_of(pair);
        ended_.data()[ends] = key_of({pair.b, pair.a});
        begins += one_if(is);
        ends += one_if(!is);
    }
    begun_.resize_unset(begins);
    ended_.resize_unset(ends);
    sort_keys(begun_, swap_);
    sort_keys(ended_, swap_);
    append_differences(begun_, ended_, begun, ended);
}

}  // namespace lendulet
