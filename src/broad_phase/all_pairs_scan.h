// The loop of AllPairs, compiled once per instruction set. Every width writes the same pairs in the same order.
#pragma once

#include "broad_phase/block.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

// A BoxSet as the loop sees it.
struct ScannedBoxes {
    const BoxBlock* blocks;
    const uint32_t* index;
    int count;
};

// Pairs of the boxes [begin, end) of `moving` with those after each and with all of `fixed`.
using AllPairsScan = void (*)(const ScannedBoxes& moving, const ScannedBoxes& fixed, int begin, int end,
                              PairStream& out);

// Of the widest vectors of this machine that a block fills.
AllPairsScan all_pairs_scan();

}  // namespace lendulet
