// The broad phase that tests every box against every other: the reference for all others, and the fastest for a handful
// of boxes. Time grows with the square of the count.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"

namespace lendulet {

class AllPairs {
public:
    explicit AllPairs(const Memory* memory) : fixed_(memory), moving_(memory), chunks_(memory), changes_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    int moving_count() const { return moving_.index.count(); }
    BroadBox moving_box(int place) const { return moving_.box(place); }

private:
    // The boxes of one set in the caller's order, eight a block.
    struct Set {
        Array<BoxBlock> blocks;
        Array<uint32_t> index;
        explicit Set(const Memory* memory) : blocks(memory), index(memory) {}
        void assign(const BroadBox* boxes, int count);
        BroadBox box(int place) const;
        void pairs_from(const WideBox& box, uint32_t box_index, int first, PairList& out) const;
        // The lanes of block `b` that hold boxes.
        uint32_t lanes(int b) const {
            int left = index.count() - b * block_size;
            return left >= block_size ? 0xffu : (1u << left) - 1;
        }
    };
    template <class Query>
    void offer_all(Query& query) const;

    Set fixed_, moving_;
    PairChunks chunks_;
    PairChanges changes_;
};

template <class Visit>
void AllPairs::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    const WideBox box = spread(lower, upper);
    for (const Set* set : {&moving_, &fixed_}) {
        for (int b = 0; b < set->blocks.count(); ++b) {
            uint32_t hits = overlaps(set->blocks[b], box) & set->lanes(b);
            while (hits) visit(set->index[b * block_size + take_bit(hits)]);
        }
    }
}

}  // namespace lendulet
