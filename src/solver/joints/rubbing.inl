// Friction of ball joints, about all axes at once. Part of kernels.inl.
//
// With the anchors held together the relative turning answers an angular impulse by K = I - C^T K_l^-1 C
// (PointResponse; K_l: the linear rows'). The impulse f that ends the turning u solves K f = K f_held - u = g. Where
// |f| exceeds the greatest one, R, Coulomb's law asks for f' with |f'| = R against the turning that is left, u' = -s f'
// with s >= 0:
//
//     (K + s) f' = g,   |f'| = R.
//
// Newton's method for 1 / |f'|, from s = 0: s += (|f'| - R) / R |f'|^2 / (f' . (K + s)^-1 f'). Limbs turn about their
// axis ten times as easily as across it, so f cut to length would not point against their turning.
// Source: as in round_limit.inl.

// x with (K + s) x = g.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> solve_shifted(const SymMat3T<F>& K, F s, Vec3T<F> g) {
    const F k[3][3] = {{K.xx + s, K.xy, K.xz}, {K.xy, K.yy + s, K.yz}, {K.xz, K.yz, K.zz + s}};
    Factor<F, 3> factor;
    factor.set(k);
    F x[3] = {g.x, g.y, g.z};
    factor.solve(x);
    return {x[0], x[1], x[2]};
}

// f' for an f of length `size` > most. In units of f and of the trace of K.
template <class F>
[[gnu::noinline]] Vec3T<F> cut_torque(SymMat3T<F> K, Vec3T<F> g, F size, F most) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), least = splat<F>(1e-30f);
    const F share = one / maximum(K.xx + K.yy + K.zz, least), unit = one / maximum(size, least);
    K = {share * K.xx, share * K.yy, share * K.zz, share * K.xy, share * K.xz, share * K.yz};
    g = unit * (share * g);
    const F R = maximum(unit * most, splat<F>(1e-5f));
    F s = zero;
    Vec3T<F> f = solve_shifted(K, s, g);
    for (int i = 0; i < 3; ++i) {
        const F length2 = dot(f, f), slope = maximum(dot(f, solve_shifted(K, s, f)), least);
        s = maximum(s + (length2 / slope) * ((square_root(length2) - R) / R), zero);
        f = solve_shifted(K, s, g);
    }
    return (most / maximum(length(f), least)) * f;
}

template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void solve_rubbing(JointRow<W, C>& c, const JointGeometry<W, C>& o,
                                         const PointResponse<Wide<float, W>>& response,
                                         const Factor<Wide<float, W>, 3>& mass, JointPair<Wide<float, W>>& p,
                                         const JointConstants& k, bool split, JointChange<W, C>& x) {
    using F = Wide<float, W>;
    const Vec3T<F>&cx = response.x, &cy = response.y, &cz = response.z;
    const F linear[3][3] = {{cx.x, cy.x, cz.x}, {cx.y, cy.y, cz.y}, {cx.z, cy.z, cz.z}};  // column i: C e_i
    F back[3][3], less[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) back[i][j] = linear[i][j];
        mass.solve(back[i]);
        for (int j = 0; j <= i; ++j)
            less[i][j] = linear[j][0] * back[i][0] + linear[j][1] * back[i][1] + linear[j][2] * back[i][2];
    }
    SymMat3T<F> K = response.angular;
    K.xx = K.xx - less[0][0], K.yy = K.yy - less[1][1], K.zz = K.zz - less[2][2];
    K.xy = K.xy - less[1][0], K.xz = K.xz - less[2][0], K.yz = K.yz - less[2][1];
    Vec3T<F> turning = p.turning();
    if constexpr (biased) {
        const Vec3T<F> curvature = turning_curvature(p);
        turning =
            turning + Vec3T<F>{rate_ahead(curvature.x, k), rate_ahead(curvature.y, k), rate_ahead(curvature.z, k)};
    }
    const F most = splat<F>(split ? k.share * k.h : k.h) * c.most_torque;
    const Vec3T<F> g = K * c.rub - turning;
    Vec3T<F> f = solve_shifted(K, splat<F>(0.0f), g);
    const F size = length(f);
    auto slides = size > most;
    if (mask_bits(slides) != 0) f = select(slides, cut_torque(K, g, size, most), f);
    const Vec3T<F> turn = c.relaxation * (f - c.rub);
    c.rub = c.rub + turn;
    x.rub = x.rub + turn;
    F held[3];
    for (int j = 0; j < 3; ++j) {
        held[j] = splat<F>(0.0f) - (turn.x * back[0][j] + turn.y * back[1][j] + turn.z * back[2][j]);
        c.impulse[j] = c.impulse[j] + held[j];
        x.locked[j] = x.locked[j] + held[j];
    }
    p.push(o.ra, o.rb, {held[0], held[1], held[2]}, turn);
}
