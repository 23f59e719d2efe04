// The loops of AllPairs and of small trees, compiled once per instruction set. Every one writes the same pairs in the
// same order.
#pragma once

#include "broad_phase/block.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

// A set of boxes in blocks as the loop sees it.
struct ScannedBoxes {
    const BoxBlock* blocks;
    const uint32_t* index;        // of the boxes of the first block
    int count;                    // lanes; those without a box among them only if no box is infinite
    int index_step = block_size;  // from the indices of one block to those of the next
};

struct AllPairsKernels {
    // Boxes as they are given into blocks, and their indices; lanes behind the last box are emptied. There is room for
    // the indices of whole blocks.
    void (*fill)(const BroadBox* boxes, int count, BoxBlock* blocks, uint32_t* index);
    // Pairs of the boxes [begin, end) of `moving` with those before each and with all of `fixed`. Whole blocks: `begin`
    // is a multiple of their size, `end` too or the count.
    void (*scan)(const ScannedBoxes& moving, const ScannedBoxes& fixed, int begin, int end, PairStream& out);
};

// Those of this machine's widest instructions.
const AllPairsKernels& all_pairs_kernels();

}  // namespace lendulet
