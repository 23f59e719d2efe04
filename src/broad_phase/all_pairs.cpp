#include "broad_phase/all_pairs.h"

#include <algorithm>

#include "broad_phase/all_pairs_scan.h"

namespace lendulet {

namespace {

ScannedBoxes scanned(const BoxSet& set) { return {set.blocks.data(), set.index.data(), set.count()}; }

}  // namespace

void AllPairs::set_fixed(const BroadBox* boxes, int count, TaskPool*) {
    fixed_.assign(boxes, count);
    changes_.forget();
}
void AllPairs::set_moving(const BroadBox* boxes, int count, TaskPool*) {
    moving_.assign(boxes, count);
    changes_.forget();
}

void AllPairs::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 8;  // blocks
    const ScannedBoxes moving = scanned(moving_), fixed = scanned(fixed_);
    auto scan = [&](int begin, int end, PairList& list) {
        PairRoom room(list);
        moving_.kernels->scan(moving, fixed, begin * block_size, std::min(end * block_size, moving.count), room);
    };
    const int blocks = moving_.blocks.count();
    if (blocks > grain) return chunks_.search(tasks, blocks, grain, out, scan);
    PairList list(out, true);  // as a search of so few would, in half the instructions
    scan(0, blocks, list);
}

void AllPairs::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                      Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 4;  // all pairs of a box cost twice what its part in the search for all pairs does, two times
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

void AllPairs::cast(BoxCast& cast) const {
    moving_.offer_to(cast);
    fixed_.offer_to(cast);
}

void AllPairs::nearest(NearestBox& nearest) const {
    moving_.offer_to(nearest);
    fixed_.offer_to(nearest);
}

void AllPairs::boxes(Array<BroadPhaseBox>& out) const {
    moving_.append_boxes(out);
    fixed_.append_boxes(out);
}

size_t AllPairs::bytes() const { return moving_.bytes() + fixed_.bytes() + chunks_.bytes() + changes_.bytes(); }

const char* AllPairs::check() const {
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

}  // namespace lendulet
