// Cuts the impulse of a two-axis row to a round limit so that what is left of its velocity points against it. Part of
// kernels.inl.
//
// A row along two axes has the effective mass M (symmetric, positive) and wants the impulse f, which takes all of its
// velocity away. Where |f| exceeds what the row may give, R, Coulomb's law asks for an impulse f' with |f'| = R along
// the line of the velocity that is left, v' = -s f' with some s >= 0. Since M v' = f - f', that is
//
//     (1 + s M) f' = f,   |f'| = R.
//
// Scaling f itself gives the same only where M is isotropic: else what slides would be pushed along M v', off its way
// by as much as 30 degrees for a long body that slides askew, and several points of one body would push against each
// other. 1 / |f'| is nearly linear in s, so two steps of Newton's method from s = 0 give the direction to 0.04 degrees
// where the greatest and the least mass are as 4 to 1, and the last scaling gives the length.
// Source: More, Sorensen, "Computing a Trust Region Step", SIAM J. Sci. Stat. Comput. 4 (1983), section 3.

// f' for (x, y) of length `size` > 0 in lanes that are over the limit 0 < most < size; `m`: 11 12 22 of M.
template <class F>
LENDULET_FORCE_INLINE void cut_to_limit(F& x, F& y, const F m[3], F size, F most) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), least = splat<F>(1e-30f);
    // In units of f and of the trace of M. Below a hundred-thousandth of f the direction no longer changes.
    const F unit = one / maximum(size, least), share = one / maximum(m[0] + m[2], least);
    const F a = share * m[0], b = share * m[1], d = share * m[2], fx = unit * x, fy = unit * y;
    const F length = maximum(unit * most, splat<F>(1e-5f));
    const F determinant = maximum(a * d - b * b, zero);
    F s = zero, gx = fx, gy = fy, norm = one;
    for (int i = 0; i < 2; ++i) {
        F px = a * gx + b * gy, py = b * gx + d * gy;
        // (1 + s M)^-1, here and below: the adjugate is 1 + s (trace - M).
        F scale = one / (one + s * (one + s * determinant));
        F qx = scale * (px + s * (d * px - b * py)), qy = scale * (py + s * (a * py - b * px));
        F slope = maximum(gx * qx + gy * qy, least);
        s = maximum(s + (norm * norm) * ((norm - length) / (length * slope)), zero);
        scale = one / (one + s * (one + s * determinant));
        gx = scale * (fx + s * (d * fx - b * fy));
        gy = scale * (fy + s * (a * fy - b * fx));
        norm = square_root(gx * gx + gy * gy);
    }
    const F last = most / maximum(norm, least);
    x = last * gx;
    y = last * gy;
}
