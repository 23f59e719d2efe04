// How far a vector is turned, without the cancellation of computing the turned vector first.
#pragma once

#include "lendulet/math.h"

namespace lendulet {

// Principal moments that differ by no more, relative to the largest, count as equal: rounding of mass properties.
inline constexpr float equal_moments = 1e-6f;

// R(dq)^T n - n.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> turned_back(QuatT<F> dq, Vec3T<F> n) {
    Vec3T<F> u{-dq.x, -dq.y, -dq.z};
    Vec3T<F> c = cross(u, cross(u, n) + dq.w * n);
    return c + c;
}

}  // namespace lendulet
