// Bodies over a substep: kick by forces, drift by velocities. Part of kernels.inl.
//
// State is momentum. Constraints change velocities; what they changed is added to L through the inertia of this
// substep, so L is never recomputed from w and without torque stays constant to the last bit (Delta L = I Delta w is
// the sum of r x J exactly as the rows applied it). Orientation follows L by the implicit midpoint rule at constant L
// (Simo, Wong 1991; Hairer, Lubich, Wanner, "Geometric Numerical Integration", ch. VII), which keeps the energy of
// tumbling bodies.
//
// Warm start: what constraints added to a body's velocity in the last substep is M^-1 J^T lambda of their final
// impulses, so adding it again warm-starts every row of the body at once.
//
// Drift: a body that accelerates evenly moves by the mean of its velocities at both ends of the substep, which makes
// free flight, sliding and swinging second-order accurate; a body that is being stopped moves by its final velocity,
// which is what its contacts asked for. Evenly means that the velocity changes now as it did in the substep before.
//
// Bodies with joints: joint impulses are no part of the warm start, see joint_passes.inl; the drift goes by the
// velocity that the joints' biased pass chose. Where nothing but joints constrains a group of bodies, the kick is
// split: half of the applied forces acts before the drift and half after it (kick-drift-kick), and what joints add
// follows in the relax pass. Elsewhere all of the kick comes first, as contacts want it.

template <int W>
struct MotionBlock {
    using F = Wide<float, W>;
    static constexpr int stride = sizeof(BodyMotion) / sizeof(float);
    LENDULET_FORCE_INLINE static Vec3T<F> load(const BodyMotion* m, int first, int quad, F& w) {
        F q[4];
        load4<W>(floats_of(m), first, stride, 4 * quad, q);
        w = q[3];
        return {q[0], q[1], q[2]};
    }
    LENDULET_FORCE_INLINE static void store(BodyMotion* m, int first, int quad, Vec3T<F> v, F w) {
        F q[4] = {v.x, v.y, v.z, w};
        store4<W>(floats_of(m), first, stride, 4 * quad, q);
    }
};
enum MotionQuad {
    quad_q0,
    quad_inertia,
    quad_inverse,
    quad_L,
    quad_acceleration,
    quad_torque,
    quad_v_ref,
    quad_w_ref,
    quad_dv,
    quad_dw,
    quad_v_start,
    quad_L_start,
    quad_change_v,
    quad_change_L
};

// Theta w or Theta^-1 L: R diag(principal) R^T applied to a world vector.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> apply_principal(QuatT<F> q, Vec3T<F> principal, Vec3T<F> v) {
    return rotate(q, multiply(principal, rotate_inverse(q, v)));
}

// exp of half the rotation vector `turn`, as a quaternion; |turn| <= 1. Taylor series to single precision.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_quaternion(Vec3T<F> turn) {
    F x = splat<F>(0.25f) * dot(turn, turn);  // (angle / 2)^2
    F s =
        splat<F>(0.5f) + x * (splat<F>(-1.0f / 12.0f) + x * (splat<F>(1.0f / 240.0f) + x * splat<F>(-1.0f / 10080.0f)));
    F c = splat<F>(1.0f) + x * (splat<F>(-0.5f) + x * (splat<F>(1.0f / 24.0f) +
                                                       x * (splat<F>(-1.0f / 720.0f) + x * splat<F>(1.0f / 40320.0f))));
    return {s * turn.x, s * turn.y, s * turn.z, c};
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> normalized(QuatT<F> q) {
    F s = splat<F>(1.0f) / square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

inline constexpr int max_turn_parts = 32;

// Turns dq q0 over h at constant L. The fixed point of the midpoint rule contracts for h |w| anisotropy < 1, so fast
// and slender bodies are turned in parts; kinematic lanes (no inertia) turn with their given w.
template <int W>
LENDULET_FORCE_INLINE QuatT<Wide<float, W>> turn_at_constant_L(QuatT<Wide<float, W>> dq, QuatT<Wide<float, W>> q0,
                                                               Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> inverse,
                                                               Vec3T<Wide<float, W>> w, Wide<float, W> anisotropy,
                                                               float h) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f);
    auto given = (inverse.x + inverse.y + inverse.z) <= zero;
    auto fixed_axis = anisotropy <= one;
    F wish = splat<F>(2.0f * h) * square_root(dot(w, w)) * anisotropy;
    F parts = one;  // smallest power of two above the wish: steps of a lane never depend on its neighbours
    for (int i = 1; i < max_turn_parts; i *= 2) parts = select(wish > parts, parts + parts, parts);
    F step = splat<F>(h) / parts;
    float most = 1.0f;
    for (int l = 0; l < W; ++l) most = lane(parts, l) > most ? lane(parts, l) : most;
    QuatT<F> q = dq;
    for (float part = 0.0f; part < most; part += 1.0f) {
        auto active = splat<F>(part) < parts;
        F half = splat<F>(0.5f) * step;
        Vec3T<F> rate = select(given, w, apply_principal(multiply(q, q0), inverse, L));
        for (int i = 0; i < 4; ++i) {
            QuatT<F> mid = multiply(turn_quaternion(half * rate), q);
            Vec3T<F> next = apply_principal(multiply(mid, q0), inverse, L);
            rate = select(given, w, select(fixed_axis, rate, next));
        }
        q = select(active, normalized(multiply(turn_quaternion(step * rate), q)), q);
    }
    return q;
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
// anyway.
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
void kick_bodies(SolverBodies& bodies, const SubstepConstants& k, bool first_substep, int begin, int end) {
    using F = Wide<float, W>;
    using M = MotionBlock<W>;
    BodyMotion* motion = bodies.motion.data();
    for (int i = begin; i < end; i += W) {
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = i + l;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), index),
                        start = load_start<W>(bodies.start.data(), index);
        auto movable = x.inverse_mass > splat<F>(0.0f);
        F unused, linear_loss, angular_loss, anisotropy;
        Vec3T<F> inertia = M::load(motion, i, quad_inertia, linear_loss);
        M::load(motion, i, quad_inverse, angular_loss);
        Vec3T<F> L = M::load(motion, i, quad_L, anisotropy);
        Vec3T<F> dv = zero_vector<F>(), dw = dv, change_v, change_L;
        if (first_substep) {
            change_v = M::load(motion, i, quad_change_v, unused);
            change_L = M::load(motion, i, quad_change_L, unused);
        } else {
            Vec3T<F> dp;
            QuatT<F> dq;
            load_displacement<W>(bodies.state.data(), index, dp, dq);
            F q[4];
            load4<W>(floats_of(motion), i, M::stride, 4 * quad_q0, q);
            QuatT<F> orientation = multiply(dq, QuatT<F>{q[0], q[1], q[2], q[3]});
            Vec3T<F> rv = x.v - M::load(motion, i, quad_v_ref, unused),
                     rw = x.w - M::load(motion, i, quad_w_ref, unused);
            dv = M::load(motion, i, quad_dv, unused) + rv;
            dw = M::load(motion, i, quad_dw, unused) + rw;
            L = L + apply_principal(orientation, inertia, rw);
            change_v = x.v - M::load(motion, i, quad_v_start, unused);
            change_L = L - M::load(motion, i, quad_L_start, unused);
        }
        M::store(motion, i, quad_v_start, x.v, splat<F>(0.0f));
        M::store(motion, i, quad_L_start, L, splat<F>(0.0f));
        M::store(motion, i, quad_change_v, change_v, splat<F>(0.0f));
        M::store(motion, i, quad_change_L, change_L, splat<F>(0.0f));
        F free, joints, h = splat<F>(k.h);
        Vec3T<F> acceleration = M::load(motion, i, quad_acceleration, free),
                 torque = M::load(motion, i, quad_torque, joints);
        if (k.joints) {
            auto split = joint_mode(joints).split > splat<F>(0.0f);
            h = select(split, splat<F>(0.5f) * h, h);
            dv = select(split, zero_vector<F>(), dv);
            dw = select(split, zero_vector<F>(), dw);
            M::store(motion, i, quad_dv, dv, splat<F>(0.0f));
            M::store(motion, i, quad_dw, dw, splat<F>(0.0f));
        }
        L = L - angular_loss * L + h * torque;
        SymMat3T<F> I = load_inverse_inertia<W>(bodies.inertia.data(), index);
        x.v = x.v + select(movable, h * acceleration - linear_loss * (start.v + x.v), zero_vector<F>());
        x.w = select(movable, I * L - start.w, x.w);
        if (k.joints) store_gyro<W>(bodies, index, I, L, start.w + x.w);
        M::store(motion, i, quad_L, L, anisotropy);
        M::store(motion, i, quad_v_ref, x.v, splat<F>(0.0f));
        M::store(motion, i, quad_w_ref, x.w, splat<F>(0.0f));
        x.v = x.v + dv;
        x.w = x.w + dw;
        store_velocity<W>(bodies.state.data(), index, x);
    }
}

// The change per substep that an evenly accelerating body shows; none for a body that is being stopped or pushed.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> even_change(Vec3T<F> now, Vec3T<F> before, F free) {
    Vec3T<F> d = now - before;
    auto even = dot(d, d) <= splat<F>(0.25f) * dot(before, before);
    return select(free > splat<F>(0.0f), now, select(even, before, zero_vector<F>()));
}

template <int W>
void drift_bodies(SolverBodies& bodies, const SubstepConstants& k, int begin, int end) {
    using F = Wide<float, W>;
    using M = MotionBlock<W>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f);
    BodyMotion* motion = bodies.motion.data();
    BodyState* state = bodies.state.data();
    for (int i = begin; i < end; i += W) {
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = i + l;
        WideVelocity<F> x = load_velocity<W>(state, index), start = load_start<W>(bodies.start.data(), index);
        Vec3T<F> dp;
        QuatT<F> dq;
        load_displacement<W>(state, index, dp, dq);
        F unused, anisotropy, free, q[4];
        load4<W>(floats_of(motion), i, M::stride, 4 * quad_q0, q);
        QuatT<F> q0{q[0], q[1], q[2], q[3]};
        Vec3T<F> inertia = M::load(motion, i, quad_inertia, unused), inverse = M::load(motion, i, quad_inverse, unused);
        Vec3T<F> L = M::load(motion, i, quad_L, anisotropy);
        M::load(motion, i, quad_acceleration, free);
        Vec3T<F> dv = x.v - M::load(motion, i, quad_v_ref, unused), dw = x.w - M::load(motion, i, quad_w_ref, unused);
        L = L + apply_principal(multiply(dq, q0), inertia, dw);
        M::store(motion, i, quad_dv, dv, zero);
        M::store(motion, i, quad_dw, dw, zero);

        Vec3T<F> change_v = even_change(x.v - M::load(motion, i, quad_v_start, unused),
                                        M::load(motion, i, quad_change_v, unused), free);
        Vec3T<F> change_L =
            even_change(L - M::load(motion, i, quad_L_start, unused), M::load(motion, i, quad_change_L, unused), free);
        JointMode<F> mode{};
        if (k.joints) {
            F joints;
            M::load(motion, i, quad_torque, joints);
            mode = joint_mode(joints);
            change_v = select(mode.jointed > zero, zero_vector<F>(), change_v);
            change_L = select(mode.jointed > zero, zero_vector<F>(), change_L);
        }
        dp = dp + splat<F>(k.h) * (start.v + (x.v - half * change_v));
        dq = turn_at_constant_L<W>(dq, q0, L - half * change_L, inverse, start.w + x.w, anisotropy, k.h);

        SymMat3T<F> I = rotate_diagonal(rotation_matrix<F>(multiply(dq, q0), splat<F>(1.0f)), inverse);
        if (k.joints) {
            F second = splat<F>(0.5f * k.h) * mode.split;
            x.v = x.v + second * M::load(motion, i, quad_acceleration, unused);
            L = L + second * M::load(motion, i, quad_torque, unused);
        }
        x.w = select(x.inverse_mass > zero, I * L - start.w, x.w);
        store_velocity<W>(state, index, x);
        F p[4] = {dp.x, dp.y, dp.z, zero}, r[4] = {dq.x, dq.y, dq.z, dq.w};
        scatter4<W>(floats_of(state), index, 16, 8, p);
        scatter4<W>(floats_of(state), index, 16, 12, r);
        F i0[4] = {I.xx, I.yy, I.zz, I.xy}, i1[4] = {I.xz, I.yz, zero, zero};
        scatter4<W>(floats_of(bodies.inertia.data()), index, 8, 0, i0);
        scatter4<W>(floats_of(bodies.inertia.data()), index, 8, 4, i1);
        M::store(motion, i, quad_L, L, anisotropy);
        M::store(motion, i, quad_v_ref, x.v, zero);
        M::store(motion, i, quad_w_ref, x.w, zero);
    }
}

// After the last relax: brings L and the changes up to date.
template <int W>
void settle_bodies(SolverBodies& bodies, int begin, int end) {
    using F = Wide<float, W>;
    using M = MotionBlock<W>;
    BodyMotion* motion = bodies.motion.data();
    for (int i = begin; i < end; i += W) {
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = i + l;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), index);
        Vec3T<F> dp;
        QuatT<F> dq;
        load_displacement<W>(bodies.state.data(), index, dp, dq);
        F unused, anisotropy, q[4];
        load4<W>(floats_of(motion), i, M::stride, 4 * quad_q0, q);
        Vec3T<F> inertia = M::load(motion, i, quad_inertia, unused), L = M::load(motion, i, quad_L, anisotropy);
        Vec3T<F> rw = x.w - M::load(motion, i, quad_w_ref, unused);
        L = L + apply_principal(multiply(dq, QuatT<F>{q[0], q[1], q[2], q[3]}), inertia, rw);
        M::store(motion, i, quad_L, L, anisotropy);
        M::store(motion, i, quad_change_v, x.v - M::load(motion, i, quad_v_start, unused), splat<F>(0.0f));
        M::store(motion, i, quad_change_L, L - M::load(motion, i, quad_L_start, unused), splat<F>(0.0f));
    }
}

// See Booking.
template <int W>
void book_joints(SolverBodies& bodies, Booking what, int begin, int end) {
    using F = Wide<float, W>;
    using M = MotionBlock<W>;
    const F zero = splat<F>(0.0f);
    BodyMotion* motion = bodies.motion.data();
    for (int i = begin; i < end; i += W) {
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = i + l;
        F joints, unused, anisotropy, q[4];
        M::load(motion, i, quad_torque, joints);
        auto jointed = joint_mode(joints).jointed > zero;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), index);
        Vec3T<F> v = M::load(motion, i, quad_v_ref, unused), w = M::load(motion, i, quad_w_ref, unused);
        Vec3T<F> added_v = select(jointed, x.v - v, zero_vector<F>()),
                 added_w = select(jointed, x.w - w, zero_vector<F>());
        if (what == Booking::contacts_warm) {
            M::store(motion, i, quad_dv, added_v, zero);
            M::store(motion, i, quad_dw, added_w, zero);
            continue;
        }
        if (what == Booking::joints_solved) {
            added_v = select(jointed, added_v - M::load(motion, i, quad_dv, unused), zero_vector<F>());
            added_w = select(jointed, added_w - M::load(motion, i, quad_dw, unused), zero_vector<F>());
        }
        Vec3T<F> dp, inertia = M::load(motion, i, quad_inertia, unused), L = M::load(motion, i, quad_L, anisotropy);
        QuatT<F> dq;
        load_displacement<W>(bodies.state.data(), index, dp, dq);
        load4<W>(floats_of(motion), i, M::stride, 4 * quad_q0, q);
        L = L + apply_principal(multiply(dq, QuatT<F>{q[0], q[1], q[2], q[3]}), inertia, added_w);
        M::store(motion, i, quad_L, L, anisotropy);
        M::store(motion, i, quad_v_ref, v + added_v, zero);
        M::store(motion, i, quad_w_ref, w + added_w, zero);
    }
}
