// Rows that resist rolling and spinning, for the contacts that have such friction or whose surfaces run over their
// bodies. Part of kernels.inl.
//
// A contact presses over a patch that is ahead of its middle while a body rolls: its reaction N then has the moment b N
// against the turning about the patch's tangents, with b the rolling coefficient, a length. About the normal, the
// patch's own friction has at most the moment s N. Both are rows on the relative spin alone, with a round limit for the
// first, and take what they can of it within their limits: the torque is the same for both bodies, so L is conserved.
//
// The contacts of a group whose rows have this come with a second row each, so that all others keep their kernels. It
// is solved before the contact's own in the biased pass, when the normal impulses are those of the last relax pass:
// their mean is the load, which that of a biased pass is not quite. Friction comes after it, so that slip is zero at
// the end.
//
// A surface that runs, a conveyor belt's, is nothing but a slip that is there from the start: the contact's own row
// begins with it and needs to know no more.

template <int W, int P>
void prepare_rolling(const ContactGroup& g, const BodyArrays& bodies, int begin, int end) {
    using F = Wide<float, W>;
    auto* contacts = reinterpret_cast<ContactRow<W, P>*>(g.rows);
    auto* rows = reinterpret_cast<RollingRow<W>*>(g.rolling);
    for (int i = begin; i < end; ++i) {
        ContactRow<W, P>& c = contacts[i];
        RollingRow<W>& r = rows[i];
        int32_t a[W], b[W];
        Vec3T<F> held = zero_vector<F>();
        r.running = zero_vector<F>();
        r.rolling = r.spinning = splat<F>(0.0f);
        for (int l = 0; l < W; ++l) {
            a[l] = c.a[l] / 8, b[l] = c.b[l] / 8;
            if (i * W + l >= g.count) continue;
            const ContactExtra& extra = g.extras[g.order[i * W + l]];
            set_lane(r.rolling, l, extra.rolling);
            set_lane(r.spinning, l, extra.spinning);
            set_lane(held.x, l, extra.impulse[0]);
            set_lane(held.y, l, extra.impulse[1]);
            set_lane(held.z, l, extra.impulse[2]);
            set_lane(r.running.x, l, extra.running[0]);
            set_lane(r.running.y, l, extra.running[1]);
            set_lane(r.running.z, l, extra.running[2]);
        }
        c.start_slip = c.start_slip + r.running;
        r.start_spin = load_start<W>(bodies.start, b).w - load_start<W>(bodies.start, a).w;
        SymMat3T<F> K =
            load_inverse_inertia_at<W>(bodies.inertia, c.a) + load_inverse_inertia_at<W>(bodies.inertia, c.b);
        Vec3T<F> t2 = cross(c.n, c.t1), k1 = K * c.t1;
        F k11 = dot(c.t1, k1), k12 = dot(t2, k1), k22 = dot(t2, K * t2);
        F d = inverse_or_zero(k11 * k22 - k12 * k12);
        r.mass[0] = d * k22, r.mass[1] = -(d * k12), r.mass[2] = d * k11;
        r.mass_n = inverse_or_zero(dot(c.n, K * c.n));
        r.tangent[0] = dot(held, c.t1);
        r.tangent[1] = dot(held, t2);
        r.normal = dot(held, c.n);
    }
}

template <int W, int P>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> solve_rolling(const ContactRow<W, P>& c, RollingRow<W>& r,
                                                          Vec3T<Wide<float, W>> t2, Vec3T<Wide<float, W>> spin,
                                                          const SymMat3T<Wide<float, W>>& K) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F pressed = c.p[0].impulse;
    for (int j = 1; j < P; ++j) pressed = pressed + c.p[j].impulse;
    F x = dot(spin, c.t1), y = dot(spin, t2), most = r.rolling * pressed;
    F f1 = r.tangent[0] - (r.mass[0] * x + r.mass[1] * y), f2 = r.tangent[1] - (r.mass[1] * x + r.mass[2] * y);
    F size2 = f1 * f1 + f2 * f2;
    auto rolls = size2 > most * most;
    F keeps = select(rolls, zero, one), held1 = keeps * f1, held2 = keeps * f2;
    auto drags = select(rolls, most, zero) > zero;
    if (mask_bits(drags)) {
        cut_to_limit(f1, f2, r.mass, square_root(size2), most);
        held1 = select(drags, f1, held1);
        held2 = select(drags, f2, held2);
    }
    f1 = held1, f2 = held2;
    Vec3T<F> turn = (f1 - r.tangent[0]) * c.t1 + (f2 - r.tangent[1]) * t2;
    r.tangent[0] = f1, r.tangent[1] = f2;
    F z = dot(c.n, spin + K * turn);
    most = r.spinning * pressed;
    F fn = maximum(minimum(r.normal - r.mass_n * z, most), zero - most);
    turn = turn + (fn - r.normal) * c.n;
    r.normal = fn;
    return turn;
}

// `warm`: applies the impulses as they are.
template <int W, int P, bool warm>
void run_rolling(const ContactGroup& g, const BodyArrays& bodies, int begin, int end) {
    using F = Wide<float, W>;
    auto* contacts = reinterpret_cast<const ContactRow<W, P>*>(g.rows);
    auto* rows = reinterpret_cast<RollingRow<W>*>(g.rolling);
    BodyState* states = bodies.state;
    for (int i = begin; i < end; ++i) {
        const ContactRow<W, P>& c = contacts[i];
        RollingRow<W>& r = rows[i];
        WideVelocity<F> A = load_velocity_at<W>(states, c.a), B = load_velocity_at<W>(states, c.b);
        SymMat3T<F> IA = load_inverse_inertia_at<W>(bodies.inertia, c.a),
                    IB = load_inverse_inertia_at<W>(bodies.inertia, c.b);
        Vec3T<F> t2 = cross(c.n, c.t1), turn;
        if constexpr (warm) turn = r.tangent[0] * c.t1 + r.tangent[1] * t2 + r.normal * c.n;
        else turn = solve_rolling<W, P>(c, r, t2, r.start_spin + (B.w - A.w), IA + IB);
        B.w = B.w + IB * turn;
        A.w = A.w - IA * turn;
        store_velocity_at<W>(states, c.b, B);
        if (!g.fixed_a) store_velocity_at<W>(states, c.a, A);
    }
}

template <int W, int P>
void store_rolling(const ContactGroup& g, int begin, int end) {
    using F = Wide<float, W>;
    auto* contacts = reinterpret_cast<const ContactRow<W, P>*>(g.rows);
    auto* rows = reinterpret_cast<const RollingRow<W>*>(g.rolling);
    for (int i = begin; i < end; ++i) {
        const ContactRow<W, P>& c = contacts[i];
        const RollingRow<W>& r = rows[i];
        Vec3T<F> turn = r.tangent[0] * c.t1 + r.tangent[1] * cross(c.n, c.t1) + r.normal * c.n;
        for (int l = 0; l < W && i * W + l < g.count; ++l) {
            float* out = g.extras[g.order[i * W + l]].impulse;
            out[0] = lane(turn.x, l), out[1] = lane(turn.y, l), out[2] = lane(turn.z, l);
        }
    }
}
