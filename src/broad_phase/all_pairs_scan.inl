// The one source of the loops of AllPairs; see all_pairs_scan.h. Included by a unit for each instruction set, which
// defines LENDULET_KERNEL_SPACE.
#include "broad_phase/all_pairs_scan.h"
#include "broad_phase/block_fill.h"
#include "math/wide/gather.h"
#include "math/wide/mask.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

// A block is written as wide as it is read: what is written in parts has to reach the cache before it can be read
// whole.
template <class F>
void fill_blocks(const BroadBox* boxes, int count, BoxBlock* blocks, uint32_t* index) {
    constexpr int width = lanes_of<F>;
    for (int left = count; left > 0; left -= block_size, boxes += block_size, index += block_size, ++blocks) {
        for (int first = 0; first < block_size; first += width) {
            const BroadBox* box[width];
            for (int i = 0; i < width; ++i) box[i] = first + i < left ? boxes + first + i : &empty_box;
            F low[4], high[4];
            transpose_quads<width>([&](int i) { return load_wide<Float4>(box[i]->lower); }, low);
            transpose_quads<width>([&](int i) { return load_wide<Float4>(box[i]->upper); }, high);
            for (int d = 0; d < 3; ++d) {
                store_wide(blocks->lower[d] + first, low[d]);
                store_wide(blocks->upper[d] + first, high[d]);
            }
            std::memcpy(index + first, &low[3], sizeof low[3]);  // the word behind `lower` is the index
        }
    }
}

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
LENDULET_FORCE_INLINE void pairs_with(ScannedBoxes set, int lanes, const Spread<F>& box, uint32_t own,
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

// Eight numbers of a block as one or two vectors.
template <class F>
struct Eight {
    static constexpr int parts = block_size / lanes_of<F>;
    F part[parts];
};
template <class F>
LENDULET_FORCE_INLINE Eight<F> load_eight(const float* p) {
    Eight<F> all;
    for (int i = 0; i < all.parts; ++i) all.part[i] = load_wide<F>(p + i * lanes_of<F>);
    return all;
}
// Lane i gets what lane i + K had, round the end.
template <int K, class F>
LENDULET_FORCE_INLINE Eight<F> turned(const Eight<F>& e) {
    const F a = e.part[0], b = e.part[Eight<F>::parts - 1];
    if constexpr (Eight<F>::parts == 1) {
        return {__builtin_shufflevector(a, a, K, K + 1, K + 2, K + 3, K + 4, (K + 5) % 8, (K + 6) % 8, (K + 7) % 8)};
    } else {
        return {__builtin_shufflevector(a, b, K, K + 1, K + 2, K + 3),
                __builtin_shufflevector(b, a, K, K + 1, K + 2, K + 3)};
    }
}

// Bit i: box i of the block overlaps box i + K, round the end.
template <int K, class F>
LENDULET_FORCE_INLINE uint32_t overlapping_turned(const Eight<F> lower[3], const Eight<F> upper[3]) {
    Eight<F> low[3], high[3];
    for (int d = 0; d < 3; ++d) {
        low[d] = turned<K>(lower[d]);
        high[d] = turned<K>(upper[d]);
    }
    uint32_t bits = 0;
    for (int p = 0; p < Eight<F>::parts; ++p) {
        LaneMask<F> hit = at_most(lower[0].part[p], high[0].part[p]);
        hit = at_most<F>(hit, low[0].part[p], upper[0].part[p]);
        for (int d = 1; d < 3; ++d) {
            hit = at_most<F>(hit, lower[d].part[p], high[d].part[p]);
            hit = at_most<F>(hit, low[d].part[p], upper[d].part[p]);
        }
        bits |= lane_bits<F>(hit) << p * lanes_of<F>;
    }
    return bits;
}

// Bit i + 8 k - 8: box i of the block overlaps box i + k, round the end, of k to 4; those of 4 once.
template <class F>
LENDULET_FORCE_INLINE uint32_t overlapping_within(const BoxBlock& block) {
    Eight<F> lower[3], upper[3];
    for (int d = 0; d < 3; ++d) {
        lower[d] = load_eight<F>(block.lower[d]);
        upper[d] = load_eight<F>(block.upper[d]);
    }
    return overlapping_turned<1>(lower, upper) | overlapping_turned<2>(lower, upper) << 8 |
           overlapping_turned<3>(lower, upper) << 16 | (overlapping_turned<4>(lower, upper) & 0xf) << 24;
}

// The bits of overlapping_within whose boxes are both among the first `lanes`.
struct BitsWithin {
    uint32_t of[block_size + 1];
    constexpr BitsWithin() : of{} {
        for (int lanes = 0; lanes <= block_size; ++lanes) {
            for (int bit = 0; bit < 28; ++bit) {
                const int i = bit % block_size, j = (i + 1 + bit / block_size) % block_size;
                if (i < lanes && j < lanes) of[lanes] |= 1u << bit;
            }
        }
    }
};
inline constexpr BitsWithin bits_within;

// Pairs of the first `lanes` boxes of a block among themselves: all of them against all turned by one, two, three and
// four lanes, which is four tests in place of seven.
template <class F>
LENDULET_FORCE_INLINE void pairs_within(const BoxBlock& block, const uint32_t* index, int lanes, PairStream& out) {
    uint32_t hits = overlapping_within<F>(block) & bits_within.of[lanes];
    if (hits == 0) return;
    constexpr int most = block_size * (block_size - 1) / 2;
    if (out.end - out.next < most) out.full(out);
    BoxPair* next = out.next;
    do {
        const int bit = take_bit(hits), i = bit % block_size, j = (i + 1 + bit / block_size) % block_size;
        const uint32_t a = index[i], b = index[j];
        *next++ = a < b ? BoxPair{a, b} : BoxPair{b, a};
    } while (hits);
    out.next = next;
}

// Block by block: its boxes with each other, then with all of the blocks before it and of the other set.
template <class F>
void scan_all_pairs(const ScannedBoxes& moving_boxes, const ScannedBoxes& fixed_boxes, int begin, int end,
                    PairStream& out) {
    const ScannedBoxes moving = moving_boxes, fixed = fixed_boxes;  // not to be read anew after each pair
    constexpr int few = 4;  // boxes of a block: then those before each are tested one by one
    for (int first = begin; first < end; first += block_size) {
        const int b = static_cast<int>(static_cast<unsigned>(first) / block_size);
        const int lanes = end - first < block_size ? end - first : block_size;
        const BoxBlock& block = moving.blocks[b];
        const uint32_t* index = moving.index + b * moving.index_step;
        const bool whole = lanes > few;
        if (whole) pairs_within<F>(block, index, lanes, out);
        for (int i = whole && first + fixed.count == 0 ? lanes : 0; i < lanes; ++i) {
            const int before = whole ? first : first + i;
            Spread<F> box;
            for (int d = 0; d < 3; ++d) {
                box.lower[d] = repeat<F>(block.lower[d][i]);
                box.upper[d] = repeat<F>(block.upper[d][i]);
            }
            pairs_with(moving, before, box, index[i], out);
            pairs_with(fixed, fixed.count, box, index[i], out);
        }
    }
}

template <class F>
constexpr AllPairsKernels make_all_pairs_kernels() {
    return {fill_blocks<F>, scan_all_pairs<F>};
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
