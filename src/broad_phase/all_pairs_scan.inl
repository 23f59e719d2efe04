// The one source of the loop of AllPairs; see all_pairs_scan.h. Included by a unit for each instruction set, which
// defines LENDULET_KERNEL_SPACE.
#include "broad_phase/all_pairs_scan.h"
#include "math/wide/mask.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

// A box with each coordinate in all lanes.
template <class F>
struct Spread {
    F lower[3], upper[3];
};

template <class F>
LENDULET_FORCE_INLINE uint32_t overlapping(const BoxBlock& block, int first, const Spread<F>& box) {
    LaneMask<F> hit = at_most(load_wide<F>(block.lower[0] + first), box.upper[0]);
    hit = at_most<F>(hit, box.lower[0], load_wide<F>(block.upper[0] + first));
    for (int d = 1; d < 3; ++d) {
        hit = at_most<F>(hit, load_wide<F>(block.lower[d] + first), box.upper[d]);
        hit = at_most<F>(hit, box.lower[d], load_wide<F>(block.upper[d] + first));
    }
    return lane_bits<F>(hit);
}

// Pairs of a box with the first `lanes` of a set.
template <class F>
LENDULET_FORCE_INLINE void pairs_with(const ScannedBoxes& set, int lanes, const Spread<F>& box, uint32_t own,
                                      PairStream& out) {
    const BoxBlock* block = set.blocks;
    const uint32_t* index = set.index;
    for (; lanes > 0; lanes -= block_size, ++block, index += set.index_step) {
        uint32_t hits = overlapping<F>(*block, 0, box);
        if (lanes_of<F> < block_size && lanes > lanes_of<F>)
            hits |= overlapping<F>(*block, lanes_of<F>, box) << lanes_of<F>;
        hits &= ~(~0u << (lanes < block_size ? lanes : block_size));
        if (hits == 0) continue;
        if (out.end - out.next < block_size) out.full(out);
        BoxPair* next = out.next;
        do {
            const uint32_t other = index[take_bit(hits)];
            *next++ = own < other ? BoxPair{own, other} : BoxPair{other, own};
        } while (hits);
        out.next = next;
    }
}

// Those before a box and not those after it: the first boxes of a block need none of the blocks behind.
template <class F>
void scan_all_pairs(const ScannedBoxes& moving, const ScannedBoxes& fixed, int begin, int end, PairStream& out) {
    for (int i = begin; i < end; ++i) {
        const int b = static_cast<int>(static_cast<unsigned>(i) / block_size), lane = i - b * block_size;
        const BoxBlock& block = moving.blocks[b];
        Spread<F> box;
        for (int d = 0; d < 3; ++d) {
            box.lower[d] = repeat<F>(block.lower[d][lane]);
            box.upper[d] = repeat<F>(block.upper[d][lane]);
        }
        const uint32_t own = moving.index[b * moving.index_step + lane];
        pairs_with(moving, i, box, own, out);
        pairs_with(fixed, fixed.count, box, own, out);
    }
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
