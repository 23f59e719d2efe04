// A leaf of the R-trees, filled from the caller's boxes.
#pragma once

#include "broad_phase/block.h"

namespace lendulet {

struct LeafBounds {
    Float4 lower, upper;  // x, y, z and a lane of no meaning

    void include(Float4 low, Float4 high) {
        lower = minimum(low, lower);
        upper = maximum(high, upper);
    }
    // Sum of the edge lengths.
    float size() const { return (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]); }
    // A box with an infinite side shows in the bounds of its leaf, whichever side it is.
    bool finite() const {
        bool yes = true;
        for (int d = 0; d < 3; ++d) yes &= lower[d] >= -FLT_MAX && upper[d] <= FLT_MAX;
        return yes;
    }
};

// Reads the boxes of a leaf from the caller's array, transposes them into the leaf and returns their bounds.
LeafBounds fill_leaf(BoxBlock& leaf, uint32_t index[block_size], const BroadBox* boxes,
                     const uint32_t slot[block_size]);

}  // namespace lendulet
