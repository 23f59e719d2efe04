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

void AllPairs::set_fixed(const BroadBox* boxes, int count, TaskPool*) { fixed_.assign(boxes, count); }
void AllPairs::set_moving(const BroadBox* boxes, int count, TaskPool*) { moving_.assign(boxes, count); }

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

void AllPairs::query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const {
    WideBox box = spread(lower, upper);
    for (const Set* set : {&moving_, &fixed_}) {
        for (int b = 0; b < set->blocks.count(); ++b) {
            uint32_t hits = overlaps(set->blocks[b], box) & set->lanes(b);
            while (hits) out.push_back(set->index[b * block_size + take_bit(hits)]);
        }
    }
}

uint32_t AllPairs::ray(const float origin[3], const float translation[3], float max_t, float& t) const {
    RayCast cast(origin, translation, max_t);
    for (const Set* set : {&moving_, &fixed_}) {
        for (int b = 0; b < set->blocks.count(); ++b) {
            cast_into(cast, set->blocks[b], set->lanes(b), set->index.data() + b * block_size);
        }
    }
    if (cast.best_index != no_box) t = cast.best_t;
    return cast.best_index;
}

void AllPairs::boxes(Array<BroadPhaseBox>& out) const {
    for (const Set* set : {&moving_, &fixed_}) {
        for (int i = 0; i < set->index.count(); ++i) {
            const BoxBlock& block = set->blocks[i / block_size];
            int lane = i % block_size;
            out.push_back({{block.lower[0][lane], block.lower[1][lane], block.lower[2][lane]},
                           {block.upper[0][lane], block.upper[1][lane], block.upper[2][lane]},
                           0,
                           true,
                           set->index[i]});
        }
    }
}

size_t AllPairs::bytes() const {
    size_t sum = chunks_.bytes();
    for (const Set* set : {&moving_, &fixed_}) sum += set->blocks.bytes() + set->index.bytes();
    return sum;
}

}  // namespace lendulet
