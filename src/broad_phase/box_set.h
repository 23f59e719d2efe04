// A set of boxes in the caller's order, eight to a block, and the queries that scan it: for structures that order boxes
// but do not nest them.
#pragma once

#include "base/memory.h"
#include "broad_phase/all_pairs_scan.h"
#include "broad_phase/query.h"

namespace lendulet {

struct BoxSet {
    Array<BoxBlock> blocks;
    Array<uint32_t> index;

    const AllPairsKernels* kernels;

    explicit BoxSet(const Memory* memory) : blocks(memory), index(memory), kernels(&all_pairs_kernels()) {}
    void assign(const BroadBox* boxes, int count);
    int count() const { return index.count(); }
    BroadBox box(int place) const { return box_in(blocks[place / block_size], place % block_size, index[place]); }
    float lower(int axis, int place) const { return blocks[place / block_size].lower[axis][place % block_size]; }
    float upper(int axis, int place) const { return blocks[place / block_size].upper[axis][place % block_size]; }
    // The lanes of block `b` that hold boxes.
    uint32_t lanes(int b) const {
        int left = index.count() - b * block_size;
        return left >= block_size ? 0xffu : (1u << left) - 1;
    }
    // visit(index) for every box that overlaps.
    template <class Visit>
    void visit_overlapping(const WideBox& box, Visit&& visit) const {
        for (int b = 0; b < blocks.count(); ++b) {
            uint32_t hits = overlaps(blocks[b], box) & lanes(b);
            while (hits) visit(index[b * block_size + take_bit(hits)]);
        }
    }
    // Offers all boxes to a BoxCast or NearestBox.
    template <class Query>
    void offer_to(Query& query) const {
        for (int b = 0; b < blocks.count(); ++b) {
            offer_block(query, blocks[b], lanes(b), index.data() + b * block_size);
        }
    }
    void append_boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const { return blocks.bytes() + index.bytes(); }
    const char* check() const;  // as BroadPhase::check
};

}  // namespace lendulet
