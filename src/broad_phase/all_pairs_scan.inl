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

// Pairs of a box with those of a set from place `first` on.
template <class F>
LENDULET_FORCE_INLINE void pairs_from(const ScannedBoxes& set, const Spread<F>& box, uint32_t box_index, int first,
                                      PairStream& out) {
    constexpr int width = lanes_of<F>;
    uint32_t skipped = (1u << first % width) - 1;
    for (int i = first / width * width; i < set.count; i += width, skipped = 0) {
        uint32_t hits = overlapping<F>(set.blocks[i / block_size], i % block_size, box) & ~skipped;
        if (hits == 0) continue;
        if (set.count - i < width) hits &= (1u << (set.count - i)) - 1;  // infinite boxes overlap empty lanes
        if (out.end - out.next < width) out.full(out);
        BoxPair* next = out.next;
        while (hits) {
            const uint32_t other = set.index[i + take_bit(hits)];
            *next++ = box_index < other ? BoxPair{box_index, other} : BoxPair{other, box_index};
        }
        out.next = next;
    }
}

template <class F>
void scan_all_pairs(const ScannedBoxes& moving, const ScannedBoxes& fixed, int begin, int end, PairStream& out) {
    for (int i = begin; i < end; ++i) {
        const BoxBlock& block = moving.blocks[i / block_size];
        Spread<F> box;
        for (int d = 0; d < 3; ++d) {
            box.lower[d] = splat<F>(block.lower[d][i % block_size]);
            box.upper[d] = splat<F>(block.upper[d][i % block_size]);
        }
        pairs_from(moving, box, moving.index[i], i + 1, out);
        pairs_from(fixed, box, moving.index[i], 0, out);
    }
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
