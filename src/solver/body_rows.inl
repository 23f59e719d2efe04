// Bodies over a substep: kick by forces, drift by velocities. Part of kernels.inl.
//
// State is momentum. Constraints change velocities; what they changed is added to L through the inertia of this
// substep, so L is never recomputed from w and without torque stays constant to the last bit (Delta L = I Delta w is
// the sum of r x J exactly as the rows applied it). Orientation follows L by the implicit midpoint rule at constant L
// (Simo, Wong 1991; Hairer, Lubich, Wanner, "Geometric Numerical Integration", ch. VII), which keeps the energy of
// tumbling bodies.
//
// Warm start: what constraints added to a body's velocity and angular momentum in the last substep is J^T lambda of
// their final impulses, so adding it again warm-starts every row of the body at once. Rows then bring the angular part
// over to their present arms: see ContactRow::overdue and joints/passes.inl.
//
// Drift: a body that accelerates evenly moves by the mean of its velocities at both ends of the substep, which makes
// free flight, sliding and swinging second-order accurate; a body that is being stopped moves by its final velocity,
// which is what its contacts asked for. Evenly means that the velocity changes now as it did in the substep before.
//
// Bodies with joints (see joints/passes.inl): the drift goes by the velocity that the joints' biased pass chose. Where
// nothing but joints constrains a group of bodies, the kick is split: half of the applied forces acts before the first
// drift, half after the last one, all of them in between. Elsewhere all of the kick comes first, as contacts want it.

// Lanes [first, first + W) of the components of a BodyBlock.
template <int W>
struct BlockLanes {
    using F = Wide<float, W>;
    BodyBlock& block;
    int at;
    LENDULET_FORCE_INLINE BlockLanes(SolverBodies& bodies, int first)
        : block(bodies.blocks[static_cast<size_t>(first / block_bodies)]), at(first % block_bodies) {}
    LENDULET_FORCE_INLINE F get(const BodyBlock::Lanes& x) const { return load_wide<F>(x + at); }
    LENDULET_FORCE_INLINE Vec3T<F> get(const BodyBlock::Lanes (&x)[3]) const {
        return {load_wide<F>(x[0] + at), load_wide<F>(x[1] + at), load_wide<F>(x[2] + at)};
    }
    LENDULET_FORCE_INLINE QuatT<F> get(const BodyBlock::Lanes (&x)[4]) const {
        return {load_wide<F>(x[0] + at), load_wide<F>(x[1] + at), load_wide<F>(x[2] + at), load_wide<F>(x[3] + at)};
    }
    LENDULET_FORCE_INLINE void put(BodyBlock::Lanes& x, F v) const { store_wide(x + at, v); }
    LENDULET_FORCE_INLINE void put(BodyBlock::Lanes (&x)[3], Vec3T<F> v) const {
        store_wide(x[0] + at, v.x);
        store_wide(x[1] + at, v.y);
        store_wide(x[2] + at, v.z);
    }
};

// Indices of W consecutive bodies.
template <int W>
struct Consecutive {
    int32_t index[W];
    LENDULET_FORCE_INLINE explicit Consecutive(int first) {
        for (int l = 0; l < W; ++l) index[l] = first + l;
    }
};

// Before the first substep.
template <int W>
void begin_bodies(SolverBodies& bodies, int begin, int end) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(BodyMotion) / sizeof(float);
    for (int i = begin; i < end; i += W) {
        Consecutive<W> c(i);
        BlockLanes<W> x(bodies, i);
        F m[32];
        for (int k = 0; k < 32; k += 8) gather8<W>(floats_of(bodies.motion.data()), c.index, stride, k, m + k);
        BodyBlock& b = x.block;
        for (int k = 0; k < 4; ++k) x.put(b.q0[k], m[k]);
        for (int k = 0; k < 3; ++k) {
            x.put(b.inertia[k], m[4 + k]);
            x.put(b.inverse_inertia[k], m[8 + k]);
            x.put(b.L[k], m[12 + k]);
            x.put(b.acceleration[k], m[16 + k]);
            x.put(b.torque[k], m[20 + k]);
            x.put(b.change_v[k], m[24 + k]);
            x.put(b.change_L[k], m[28 + k]);
        }
        x.put(b.linear_loss, m[7]);
        x.put(b.angular_loss, m[11]);
        x.put(b.anisotropy, m[15]);
        x.put(b.free, m[19]);
        x.put(b.joints, m[23]);
        WideVelocity<F> start = load_start<W>(bodies.start.data(), c.index);
        x.put(b.start_v, start.v);
        x.put(b.start_w, start.w);
    }
}

// Theta w or Theta^-1 L: R diag(principal) R^T applied to a world vector.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> apply_principal(QuatT<F> q, Vec3T<F> principal, Vec3T<F> v) {
    return rotate(q, multiply(principal, rotate_inverse(q, v)));
}

// exp of half the rotation vector `turn`, as a quaternion, less 1; |turn| <= 1. Taylor series to single precision.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_less_one(Vec3T<F> turn) {
    F x = splat<F>(0.25f) * dot(turn, turn);  // (angle / 2)^2
    F s =
        splat<F>(0.5f) + x * (splat<F>(-1.0f / 12.0f) + x * (splat<F>(1.0f / 240.0f) + x * splat<F>(-1.0f / 10080.0f)));
    F c = x * (splat<F>(-0.5f) +
               x * (splat<F>(1.0f / 24.0f) + x * (splat<F>(-1.0f / 720.0f) + x * splat<F>(1.0f / 40320.0f))));
    return {s * turn.x, s * turn.y, s * turn.z, c};
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_quaternion(Vec3T<F> turn) {
    QuatT<F> q = turn_less_one(turn);
    q.w = splat<F>(1.0f) + q.w;
    return q;
}
// q + d with what rounding added to q kept in `low` (Kahan 1965), in the lanes of `active`.
template <class F, class Mask>
LENDULET_FORCE_INLINE void add_compensated(F& q, F& low, F d, Mask active) {
    F y = d - low, t = q + y;
    low = select(active, (t - q) - y, low);
    q = select(active, t, q);
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> normalized(QuatT<F> q) {
    F s = splat<F>(1.0f) / square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

// The turn, or what is left of it at a radian, where the series ends: what spins faster than its parts can follow turns
// by too little, and not by numbers without bounds.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> at_most_a_radian(Vec3T<F> turn) {
    const F size2 = dot(turn, turn), one = splat<F>(1.0f);
    return select(size2 > one, one / square_root(size2), one) * turn;
}

inline constexpr int max_turn_parts = 128;
inline constexpr float most_wish = 0.25f;  // of a part
inline constexpr float quick = 0.2f;       // from here on 6 iterations

// Turns dq q0 over h at constant L. The fixed point of the midpoint rule contracts by h |w| anisotropy / 2 an
// iteration, a quarter of the wish below, so fast and slender bodies are turned in parts and with more iterations, and
// slow ones need fewer than four: as many as leave an error below 1e-7 rad. How many parts must not change with |w| as
// a body tumbles: the rule keeps energy because it is the same backwards, and with parts that came and went a box at
// 100 rad/s about its middle axis gained 3 % of it in a minute. Kinematic lanes (no inertia) turn with their given w.
// What a lane does never depends on its neighbours; only work that no lane of a block asks for is left out.
// A turn of many parts is rounded once: at 1000 rad/s about the middle axis the parts' rounding took 0.02 % of the
// energy a minute.
template <int W>
LENDULET_FORCE_INLINE QuatT<Wide<float, W>> turn_at_constant_L(QuatT<Wide<float, W>> dq, QuatT<Wide<float, W>> q0,
                                                               Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> inverse,
                                                               Vec3T<Wide<float, W>> w, Wide<float, W> anisotropy,
                                                               float h) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f), four = splat<F>(4.0f);
    auto given = (inverse.x + inverse.y + inverse.z) <= zero;
    F wish = splat<F>(2.0f * h) * square_root(dot(w, w)) * anisotropy;
    F iterations = select(wish > splat<F>(0.01f), select(wish > splat<F>(0.05f), four, splat<F>(2.0f)), one);
    iterations = select(anisotropy <= one, zero, iterations);  // about a fixed axis L gives the velocity at once
    F parts = one;
    const bool some_quick = mask_bits(wish > splat<F>(quick)) != 0;
    if (some_quick) {
        // |L| and the least moment do not change while it tumbles, |w| does.
        F most = maximum(maximum(inverse.x, inverse.y), inverse.z);
        F steady = select(given, wish, splat<F>(2.0f * h) * square_root(dot(L, L)) * most);
        iterations = select(steady > splat<F>(quick), select(anisotropy > one, splat<F>(6.0f), zero), iterations);
        for (int i = 1; i < max_turn_parts; i *= 2)
            parts = select(steady > splat<F>(most_wish) * parts, parts + parts, parts);
    }
    F step = splat<F>(h) / parts;
    QuatT<F> q = dq, low{zero, zero, zero, zero};
    for (float part = 0.0f; mask_bits(splat<F>(part) < parts); part += 1.0f) {
        auto active = splat<F>(part) < parts;
        F half = splat<F>(0.5f) * step;
        Vec3T<F> rate = select(given, w, apply_principal(multiply(q, q0), inverse, L));
        for (float i = 0.0f; mask_bits(splat<F>(i) < iterations); i += 1.0f) {
            Vec3T<F> turn = half * rate;
            if (some_quick) turn = at_most_a_radian(turn);
            QuatT<F> mid = multiply(turn_quaternion(turn), q);
            Vec3T<F> next = apply_principal(multiply(mid, q0), inverse, L);
            rate = select(given, w, select(splat<F>(i) < iterations, next, rate));
        }
        Vec3T<F> turn = step * rate;
        if (some_quick) turn = at_most_a_radian(turn);
        QuatT<F> d = multiply(turn_less_one(turn), q);
        if (!some_quick) {  // one part, which is not rounded again: the same bits
            q = {q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
            break;
        }
        add_compensated(q.x, low.x, d.x, active);
        add_compensated(q.y, low.y, d.y, active);
        add_compensated(q.z, low.z, d.z, active);
        add_compensated(q.w, low.w, d.w, active);
    }
    return normalized(q);
}

template <class F>
struct JointMode {
    F jointed, split;  // 1 or 0
};
template <class F>
LENDULET_FORCE_INLINE JointMode<F> joint_mode(F joints) {
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f);
    return {select(joints > splat<F>(0.5f), one, zero), select(joints > splat<F>(1.5f), one, zero)};
}

// Leaves dw/dt = I^-1 (L x w), the change of w at constant L, where joints find it with the state that they load
// anyway. Bodies that turn about a fixed axis have none, and the last drift has left zeros there.
template <int W>
LENDULET_FORCE_INLINE void store_gyro(SolverBodies& bodies, const int32_t* index, const SymMat3T<Wide<float, W>>& I,
                                      Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> w) {
    Vec3T<Wide<float, W>> gyro = I * cross(L, w), dp;
    QuatT<Wide<float, W>> dq;
    load_displacement<W>(bodies.state.data(), index, dp, dq);
    Wide<float, W> p[4] = {dp.x, dp.y, dp.z, gyro.z}, i1[4] = {I.xz, I.yz, gyro.x, gyro.y};
    scatter4<W>(floats_of(bodies.state.data()), index, 16, 8, p);
    scatter4<W>(floats_of(bodies.inertia.data()), index, 8, 4, i1);
}

template <int W>
void kick_bodies(SolverBodies& bodies, const SubstepConstants& k, int begin, int end) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f);
    for (int i = begin; i < end; i += W) {
        Consecutive<W> c(i);
        BlockLanes<W> y(bodies, i);
        BodyBlock& b = y.block;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), c.index);
        auto movable = x.inverse_mass > zero;
        JointMode<F> mode{};
        if (k.joints) mode = joint_mode(y.get(b.joints));
        Vec3T<F> L = y.get(b.L), dv = zero_vector<F>(), dL = dv;
        if (!k.first) {
            Vec3T<F> dp;
            QuatT<F> dq;
            load_displacement<W>(bodies.state.data(), c.index, dp, dq);
            Vec3T<F> rv = x.v - y.get(b.v_ref), rw = x.w - y.get(b.w_ref);
            Vec3T<F> more_L = apply_principal(multiply(dq, y.get(b.q0)), y.get(b.inertia), rw);
            dv = y.get(b.dv) + rv;
            dL = y.get(b.dL) + more_L;
            L = L + more_L;
            y.put(b.change_v, x.v - y.get(b.v_start));
            y.put(b.change_L, L - y.get(b.L_start));
        }
        y.put(b.v_start, x.v);
        y.put(b.L_start, L);
        F h = splat<F>(k.h);
        if (k.joints && k.first) h = select(mode.split > zero, splat<F>(0.5f) * h, h);
        Vec3T<F> start_w = y.get(b.start_w);
        L = L - y.get(b.angular_loss) * L + h * y.get(b.torque);
        SymMat3T<F> I = load_inverse_inertia<W>(bodies.inertia.data(), c.index);
        Vec3T<F> push = h * y.get(b.acceleration) - y.get(b.linear_loss) * (y.get(b.start_v) + x.v);
        x.v = x.v + select(movable, push, zero_vector<F>());
        x.w = select(movable, I * L - start_w, x.w);
        if (k.joints) {
            F scale = select(mode.split > zero, splat<F>(k.repeat_scale), splat<F>(1.0f));
            dv = scale * dv;
            dL = scale * dL;
        }
        Vec3T<F> dw = I * dL;
        if (k.joints) {
            auto tumbles = y.get(b.anisotropy) > splat<F>(1.0f);
            store_gyro<W>(bodies, c.index, I, select(tumbles, L + dL, zero_vector<F>()), start_w + (x.w + dw));
        }
        y.put(b.L, L);
        y.put(b.v_ref, x.v);
        y.put(b.w_ref, x.w);
        x.v = x.v + dv;
        x.w = x.w + dw;
        store_velocity<W>(bodies.state.data(), c.index, x);
    }
}

// The change per substep that an evenly accelerating body shows; none for a body that is being stopped or pushed, nor
// for one that is pushed by another moving body: places must follow momenta where impulses between bodies act, or their
// angular momentum about each other changes. `pushed`: what constraints changed in this substep.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> even_change(Vec3T<F> now, Vec3T<F> before, F free, Vec3T<F> pushed) {
    Vec3T<F> d = now - before;
    auto even = dot(d, d) <= splat<F>(0.25f) * dot(before, before);
    const F zero = splat<F>(0.0f);
    F untouched = select(dot(pushed, pushed) > zero, zero, splat<F>(1.0f));
    free = select(free < zero, select(untouched > zero, untouched, free), free);
    return select(free > zero, now, select(free < zero, zero_vector<F>(), select(even, before, zero_vector<F>())));
}

// Speeds within a step, m/s and rad/s: twice those to which bodies are cut after it. Where contacts cannot follow a
// body any more, it stays finite.
inline constexpr float most_speed = 2e4f, most_spin = 6e3f;

// How much of a speed stays; 1 but for those beyond `most`.
template <class F>
LENDULET_FORCE_INLINE F kept_share(Vec3T<F> speed, float most) {
    const F size2 = dot(speed, speed);
    return select(size2 > splat<F>(most * most), splat<F>(most) / square_root(size2), splat<F>(1.0f));
}

template <int W>
void drift_bodies(SolverBodies& bodies, const SubstepConstants& k, int begin, int end) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f);
    BodyState* state = bodies.state.data();
    for (int i = begin; i < end; i += W) {
        Consecutive<W> c(i);
        BlockLanes<W> y(bodies, i);
        BodyBlock& b = y.block;
        WideVelocity<F> x = load_velocity<W>(state, c.index);
        Vec3T<F> dp;
        QuatT<F> dq, q0 = y.get(b.q0);
        load_displacement<W>(state, c.index, dp, dq);
        Vec3T<F> inverse = y.get(b.inverse_inertia), start_w = y.get(b.start_w);
        F anisotropy = y.get(b.anisotropy), free = y.get(b.free);
        Vec3T<F> dv = x.v - y.get(b.v_ref), dw = x.w - y.get(b.w_ref);
        Vec3T<F> more_L = apply_principal(multiply(dq, q0), y.get(b.inertia), dw);
        Vec3T<F> L = y.get(b.L) + more_L;
        const Vec3T<F> start_v = y.get(b.start_v);
        const F speed_share = kept_share(start_v + x.v, most_speed), spin_share = kept_share(start_w + x.w, most_spin);
        if (mask_bits(speed_share * spin_share < splat<F>(1.0f))) {  // and nothing of it is repeated
            auto calm = x.inverse_mass * (splat<F>(1.0f) - speed_share * spin_share) <= zero;
            x.v = select(calm, x.v, speed_share * (start_v + x.v) - start_v);
            x.w = select(calm, x.w, spin_share * (start_w + x.w) - start_w);
            L = select(calm, L, spin_share * L);
            dv = select(calm, dv, zero_vector<F>());
            more_L = select(calm, more_L, zero_vector<F>());
        }

        Vec3T<F> change_v = even_change(x.v - y.get(b.v_start), y.get(b.change_v), free, dv);
        Vec3T<F> change_L = even_change(L - y.get(b.L_start), y.get(b.change_L), free, dv);
        JointMode<F> mode{};
        if (k.joints) {
            mode = joint_mode(y.get(b.joints));
            change_v = select(mode.jointed > zero, zero_vector<F>(), change_v);
            change_L = select(mode.jointed > zero, zero_vector<F>(), change_L);
        }
        y.put(b.dv, dv);
        y.put(b.dL, more_L);
        Vec3T<F> moved = splat<F>(k.h) * (start_v + (x.v - half * change_v));
        dp = dp + moved;
        dq = turn_at_constant_L<W>(dq, q0, L - half * change_L, inverse, start_w + x.w, anisotropy, k.h);

        SymMat3T<F> I = rotate_diagonal(rotation_matrix<F>(multiply(dq, q0), splat<F>(1.0f)), inverse);
        const bool second_half = k.joints && k.last;
        if (second_half) {
            F h = splat<F>(0.5f * k.h) * mode.split;
            x.v = x.v + h * y.get(b.acceleration);
            L = L + h * y.get(b.torque);
        }
        x.w = select(x.inverse_mass > zero, I * L - start_w, x.w);
        y.put(b.L, L);
        y.put(b.v_ref, x.v);
        y.put(b.w_ref, x.w);
        if (second_half) {
            F scale = splat<F>(k.end_scale) * mode.split;
            x.v = x.v + scale * dv;
            x.w = x.w + I * (scale * more_L);
        }
        F velocity[8] = {x.v.x, x.v.y, x.v.z, x.inverse_mass, x.w.x, x.w.y, x.w.z, moved.x};
        F place[8] = {dp.x, dp.y, dp.z, zero, dq.x, dq.y, dq.z, dq.w};
        F inertia[8] = {I.xx, I.yy, I.zz, I.xy, I.xz, I.yz, moved.y, moved.z};
        scatter8<W>(floats_of(state), c.index, 16, 0, velocity);
        scatter8<W>(floats_of(state), c.index, 16, 8, place);
        scatter8<W>(floats_of(bodies.inertia.data()), c.index, 8, 0, inertia);
    }
}

// After the last relax: leaves L and the changes in BodyMotion.
template <int W>
void settle_bodies(SolverBodies& bodies, int begin, int end) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(BodyMotion) / sizeof(float);
    const F zero = splat<F>(0.0f);
    for (int i = begin; i < end; i += W) {
        Consecutive<W> c(i);
        BlockLanes<W> y(bodies, i);
        BodyBlock& b = y.block;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), c.index);
        Vec3T<F> dp;
        QuatT<F> dq;
        load_displacement<W>(bodies.state.data(), c.index, dp, dq);
        Vec3T<F> rw = x.w - y.get(b.w_ref);
        Vec3T<F> L = y.get(b.L) + apply_principal(multiply(dq, y.get(b.q0)), y.get(b.inertia), rw);
        Vec3T<F> change_v = x.v - y.get(b.v_start), change_L = L - y.get(b.L_start);
        F momentum[4] = {L.x, L.y, L.z, y.get(b.anisotropy)};
        F changes[8] = {change_v.x, change_v.y, change_v.z, zero, change_L.x, change_L.y, change_L.z, zero};
        scatter4<W>(floats_of(bodies.motion.data()), c.index, stride, 12, momentum);
        scatter8<W>(floats_of(bodies.motion.data()), c.index, stride, 24, changes);
    }
}
