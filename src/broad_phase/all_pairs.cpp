#include "broad_phase/all_pairs.h"

namespace lendulet {

void AllPairs::Set::assign(const BroadBox* boxes, int count) {
    int block_count = (count + block_size - 1) / block_size;
    blocks.resize_unset(static_cast<size_t>(block_count));
    index.resize_unset(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
        set_lane(blocks[i / block_size], i % block_size, boxes[i].lower, boxes[i].upper);
        index[i] = boxes[i].index;
    }
    for (int i = count; i < block_count * block_size; ++i) clear_lane(blocks[i / block_size], i % block_size);
}

BroadBox AllPairs::Set::box(int place) const {
    const BoxBlock& block = blocks[place / block_size];
    int lane = place % block_size;
    return {{block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]},
            index[place],
            {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]},
            0};
}

void AllPairs::set_fixed(const BroadBox* boxes, int count, TaskPool*) {
    fixed_.assign(boxes, count);
    changes_.forget();
}
void AllPairs::set_moving(const BroadBox* boxes, int count, TaskPool*) {
    moving_.assign(boxes, count);
    changes_.forget();
}

// Appends the pairs of a box with those from place `first` on.
void AllPairs::Set::pairs_from(const WideBox& box, uint32_t box_index, int first, PairList& out) const {
    uint32_t skipped = (1u << first % block_size) - 1;
    for (int b = first / block_size; b < blocks.count(); ++b, skipped = 0) {
        uint32_t hits = overlaps(blocks[b], box) & lanes(b) & ~skipped;
        if (hits == 0) continue;
        PairWriter writer(out, block_size);
        while (hits) writer.write(box_index, index[b * block_size + take_bit(hits)]);
    }
}

void AllPairs::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 64;
    chunks_.search(tasks, moving_.index.count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int i = begin; i < end; ++i) {
            WideBox box = spread_lane(moving_.blocks[i / block_size], i % block_size);
            moving_.pairs_from(box, moving_.index[i], i + 1, list);
            fixed_.pairs_from(box, moving_.index[i], 0, list);
        }
    });
}

void AllPairs::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                      Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 4;  // all pairs of a box cost twice what its part in the search for all pairs does, two times
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

template <class Query>
void AllPairs::offer_all(Query& query) const {
    for (const Set* set : {&moving_, &fixed_}) {
        for (int b = 0; b < set->blocks.count(); ++b) {
            offer_block(query, set->blocks[b], set->lanes(b), set->index.data() + b * block_size);
        }
    }
}

void AllPairs::cast(BoxCast& cast) const { offer_all(cast); }
void AllPairs::nearest(NearestBox& nearest) const { offer_all(nearest); }

void AllPairs::boxes(Array<BroadPhaseBox>& out) const {
    for (const Set* set : {&moving_, &fixed_}) {
        for (int i = 0; i < set->index.count(); ++i) {
            const BroadBox b = set->box(i);
            out.push_back(
                {{b.lower[0], b.lower[1], b.lower[2]}, {b.upper[0], b.upper[1], b.upper[2]}, 0, true, b.index});
        }
    }
}

size_t AllPairs::bytes() const {
    size_t sum = chunks_.bytes() + changes_.bytes();
    for (const Set* set : {&moving_, &fixed_}) sum += set->blocks.bytes() + set->index.bytes();
    return sum;
}

const char* AllPairs::check() const {
    for (const Set* set : {&moving_, &fixed_}) {
        if (set->blocks.count() != (set->index.count() + block_size - 1) / block_size) return "blocks do not fit boxes";
    }
    return "";
}

}  // namespace lendulet
