// Tests of four floats at a time in units for wide registers. By intrinsics: with AVX-512 GCC takes a comparison of
// vectors through a mask register and back.
#pragma once

#include "math/wide/wide.h"

namespace lendulet {

// Whether a <= b and c <= d in the first three lanes of each.
LENDULET_FORCE_INLINE bool three_at_most(Wide<float, 4> a, Wide<float, 4> b, Wide<float, 4> c, Wide<float, 4> d) {
#if defined(__SSE2__)
    return (~_mm_movemask_ps(_mm_and_ps(_mm_cmple_ps((__m128)a, (__m128)b), _mm_cmple_ps((__m128)c, (__m128)d))) & 7) ==
           0;
#else
    return (~mask_bits((a <= b) & (c <= d)) & 7) == 0;
#endif
}

#if defined(__AVX__)
// Four floats twice.
LENDULET_FORCE_INLINE Wide<float, 8> load_quad_twice(const float* p) {
    return (Wide<float, 8>)_mm256_broadcast_ps(reinterpret_cast<const __m128*>(p));
}
#endif

}  // namespace lendulet
