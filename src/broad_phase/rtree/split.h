// The two ways to split a node that got a ninth entry, and the two ways to choose a child for a new one.
#pragma once

#include <cstdint>

#include "broad_phase/block.h"

namespace lendulet {

// A child of a node or a box of a leaf, while it is between nodes.
struct RtreeEntry {
    float lower[3], upper[3];
    uint32_t child;  // the node, or the place of the box in the caller's array
    uint32_t index;  // of a box: the caller's
};

inline constexpr int split_count = block_size + 1;
// A node keeps at least this many entries: 40 % of eight, as both papers advise.
inline constexpr int least_entries = 3;

// Divides the entries: the group of entry i is bit i of the result, 0 or 1; both have at least `least_entries`.
// Guttman 1984, QuadraticSplit: the pair that would waste most volume starts the groups; then always the entry goes
// next for which it matters most, to the group whose volume it makes grow less.
uint32_t split_quadratic(const RtreeEntry entries[split_count]);
// Beckmann et al. 1990: of all ways to cut the entries sorted by lower or upper side, the axis whose cuts have the
// least sum of margins, and on it the cut with the least overlap, then the least volume.
uint32_t split_star(const RtreeEntry entries[split_count]);

// The child whose volume grows least for the box (Guttman, ChooseLeaf); ties: the smaller volume, the smaller growth of
// the edges (volumes are 0 where all is flat), the first.
int choose_least_growth(const BoxBlock& block, int count, const float lower[3], const float upper[3]);
// The child whose overlap with its siblings grows least (R*, above the leaves); ties as above.
int choose_least_overlap(const BoxBlock& block, int count, const float lower[3], const float upper[3]);

}  // namespace lendulet
