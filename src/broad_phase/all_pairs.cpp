#include "broad_phase/all_pairs.h"

namespace lendulet {

namespace {

// Appends the pairs of a box with those of a set from place `first` on, by half blocks: with ten boxes a third of the
// lanes of whole blocks would be empty or done.
void pairs_from(const BoxSet& set, const WideBox& box, uint32_t box_index, int first, PairList& out) {
    const int count = set.count();
    uint32_t skipped = (1u << first % 4) - 1;
    for (int i = first & ~3; i < count; i += 4, skipped = 0) {
        uint32_t hits = overlaps_half(set.blocks.data()[i / block_size], i % block_size, box) & ~skipped;
        if (hits == 0) continue;
        if (count - i < 4) hits &= (1u << (count - i)) - 1;
        PairWriter writer(out, 4);
        while (hits) writer.write(box_index, set.index[i + take_bit(hits)]);
    }
}

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
    constexpr int grain = 64;
    chunks_.search(tasks, moving_.count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int i = begin; i < end; ++i) {
            WideBox box = spread_lane(moving_.blocks[i / block_size], i % block_size);
            pairs_from(moving_, box, moving_.index[i], i + 1, list);
            pairs_from(fixed_, box, moving_.index[i], 0, list);
        }
    });
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
