// The loop of AllPairs and of small trees, compiled once per instruction set. Every width writes the same pairs in the
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

// Pairs of the boxes [begin, end) of `moving` with those before each and with all of `fixed`. Whole blocks: `begin` is
// a multiple of their size, `end` too or the count.
using AllPairsScan = void (*)(const ScannedBoxes& moving, const ScannedBoxes& fixed, int begin, int end,
                              PairStream& out);

// Of the widest vectors of this machine that a block fills.
AllPairsScan all_pairs_scan();

}  // namespace lendulet
