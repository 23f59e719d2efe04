// Sums that keep what rounding takes from them.
#pragma once

#include "lendulet/math.h"

namespace lendulet {

// x += d with the rounding error kept in `low` (Kahan 1965): a body that glides far from the origin would lose a share
// of every step, always the same one, and one that falls for minutes some of its momentum.
template <class F>
LENDULET_FORCE_INLINE void add_kept(Vec3T<F>& x, Vec3T<F>& low, Vec3T<F> d) {
    const Vec3T<F> y = d - low, t = x + y;
    low = (t - x) - y;
    x = t;
}

}  // namespace lendulet
