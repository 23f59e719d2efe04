// A leaf of the R-trees, filled from the caller's boxes.
#pragma once

#include "broad_phase/block_fill.h"

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
inline LeafBounds fill_leaf(BoxBlock& leaf, uint32_t index[block_size], const BroadBox* boxes,
                            const uint32_t slot[block_size]) {
    LeafBounds bounds{splat<Float4>(infinity), splat<Float4>(-infinity)};
    for (int half = 0; half < block_size; half += 4) {
        Float4 low[4], high[4];
        for (int i = 0; i < 4; ++i) {
            const BroadBox* box = slot[half + i] == no_box ? &empty_box : boxes + slot[half + i];
            low[i] = load_wide<Float4>(box->lower);
            high[i] = load_wide<Float4>(box->upper);
            bounds.include(low[i], high[i]);
        }
        store_quad(leaf, half, index + half, low, high);
    }
    return bounds;
}

}  // namespace lendulet
