// Boxes as they are given into the lanes of blocks.
#pragma once

#include <cstring>

#include "broad_phase/block.h"
#include "math/wide/gather.h"

namespace lendulet {

inline constexpr BroadBox empty_box{{infinity, infinity, infinity}, no_box, {-infinity, -infinity, -infinity}, 0};

// Four boxes, each as two quads, to lanes: low and high become x, y, z and the word behind.
LENDULET_FORCE_INLINE void turn_quad(Float4 low[4], Float4 high[4]) {
    detail::transpose4(low[0], low[1], low[2], low[3]);
    detail::transpose4(high[0], high[1], high[2], high[3]);
}

// Four boxes, each as two quads, into the lanes from `first` on; their indices to index[0 .. 3].
LENDULET_FORCE_INLINE void store_quad(BoxBlock& block, int first, uint32_t index[4], Float4 low[4], Float4 high[4]) {
    turn_quad(low, high);
    for (int d = 0; d < 3; ++d) {
        store_wide(block.lower[d] + first, low[d]);
        store_wide(block.upper[d] + first, high[d]);
    }
    std::memcpy(index, &low[3], sizeof low[3]);  // the word behind `lower` is the index
}

}  // namespace lendulet
