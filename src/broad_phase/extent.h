// Bounds that grow box by box.
#pragma once

#include "broad_phase/block.h"
#include "lendulet/math.h"

namespace lendulet {

inline void clear_extent(float lower[3], float upper[3]) {
    for (int d = 0; d < 3; ++d) lower[d] = infinity, upper[d] = -infinity;
}

inline void include_extent(float lower[3], float upper[3], const float low[3], const float high[3]) {
    for (int d = 0; d < 3; ++d) lower[d] = minimum(lower[d], low[d]), upper[d] = maximum(upper[d], high[d]);
}

inline float half_area(const float lower[3], const float upper[3]) {
    float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
    return x * y + y * z + z * x;
}

}  // namespace lendulet
