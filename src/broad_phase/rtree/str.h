// The tiles of Sort-Tile-Recursive bulk loading (Leutenegger, Lopez and Edgington 1997): with P nodes to make, the
// entries are cut along x into P^(1/3) slabs, each slab along y, each of these bars along z into runs of one node.
#pragma once

#include "broad_phase/rtree/omt.h"

namespace lendulet {

// Reorders so that entries 8k to 8k + 7 belong to node k. Cuts are exact selections at multiples of eight, which gives
// the same nodes as sorting, without the order inside a node that nobody needs.
void str_tile(BoxCentre* centres, int count);

}  // namespace lendulet
