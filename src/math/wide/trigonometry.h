// Angles for kernels: the wide counterpart of arc_tangent2, in single precision from IEEE-exact operations.
#pragma once

#include "math/wide/wide.h"

namespace lendulet {

// Arc tangent of t in [0, 1]. Above tan(pi/8) the addition theorem takes pi/4 off, which leaves |u| <= tan(pi/8), where
// eight terms of the series suffice for 2e-8.
template <class F>
LENDULET_FORCE_INLINE F arc_tangent_unit(F t) {
    const F one = splat<F>(1.0f);
    auto steep = t > splat<F>(0.41421356f);
    F u = select(steep, (t - one) / (t + one), t);
    F s = u * u;
    F p = splat<F>(-1.0f / 15.0f);
    p = splat<F>(1.0f / 13.0f) + s * p;
    p = splat<F>(-1.0f / 11.0f) + s * p;
    p = splat<F>(1.0f / 9.0f) + s * p;
    p = splat<F>(-1.0f / 7.0f) + s * p;
    p = splat<F>(1.0f / 5.0f) + s * p;
    p = splat<F>(-1.0f / 3.0f) + s * p;
    return select(steep, splat<F>(0.25f * pi), splat<F>(0.0f)) + (u + u * (s * p));
}

// Angle of the point (x, y) from the x axis, in [-pi, pi], error below 4e-7 rad; 0 at the origin. Arguments whose
// larger is below 1e-30 in size count as the origin. Name F at the call: for F = float the function of math.h would be
// chosen.
template <class F>
LENDULET_FORCE_INLINE F arc_tangent2(F y, F x) {
    const F zero = splat<F>(0.0f);
    F ax = absolute(x), ay = absolute(y);
    F large = maximum(ax, ay), small = minimum(ax, ay);
    F angle = arc_tangent_unit(small / maximum(large, splat<F>(1e-30f)));
    angle = select(ay > ax, splat<F>(0.5f * pi) - angle, angle);
    angle = select(x < zero, splat<F>(pi) - angle, angle);
    return select(y < zero, zero - angle, angle);
}

}  // namespace lendulet
