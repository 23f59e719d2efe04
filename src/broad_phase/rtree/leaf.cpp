#include "broad_phase/rtree/leaf.h"

#include "broad_phase/block_fill.h"

namespace lendulet {

LeafBounds fill_leaf(BoxBlock& leaf, uint32_t index[block_size], const BroadBox* boxes,
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
