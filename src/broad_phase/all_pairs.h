// The broad phase that tests every box against every other: the reference for all others, and the fastest for a handful
// of boxes. Time grows with the square of the count.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

class AllPairs {
public:
    explicit AllPairs(const Memory* memory) : fixed_(memory), moving_(memory), chunks_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const;
    uint32_t ray(const float origin[3], const float translation[3], float max_t, float& t) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;

private:
    // The boxes of one set in the caller's order, eight a block.
    struct Set {
        Array<BoxBlock> blocks;
        Array<uint32_t> index;
        explicit Set(const Memory* memory) : blocks(memory), index(memory) {}
        void assign(const BroadBox* boxes, int count);
        void pairs_from(const WideBox& box, uint32_t box_index, int first, PairList& out) const;
        // The lanes of block `b` that hold boxes.
        uint32_t lanes(int b) const {
            int left = index.count() - b * block_size;
            return left >= block_size ? 0xffu : (1u << left) - 1;
        }
    };
    Set fixed_, moving_;
    PairChunks chunks_;
};

}  // namespace lendulet
