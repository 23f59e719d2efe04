// Bodies over a substep: kick by forces, drift by velocities. Part of kernels.inl.
//
// State is momentum. Constraints change velocities; what they changed is added to L through the inertia of this substep,
// so L is never recomputed from w and without torque stays constant to the last bit (Delta L = I Delta w is the sum of
// r x J exactly as the rows applied it). Orientation follows L by the implicit midpoint rule at constant L (Simo, Wong
// 1991; Hairer, Lubich, Wanner, "Geometric Numerical Integration", ch. VII), which keeps the energy of tumbling bodies.
//
// Warm start: what constraints added to a body's velocity in the last substep is M^-1 J^T lambda of their final impulses,
// so adding it again warm-starts every row of the body at once.
//
// Drift: a body that accelerates evenly moves by the mean of its velocities at both ends of the substep, which makes free
// flight, sliding and swinging second-order accurate; a body that is being stopped moves by its final velocity, which is
// what its contacts asked for. Evenly means that the velocity changes now as it did in the substep before.

template <int W>
struct MotionBlock {
    using F = Wide<float, W>;
    static constexpr int stride = sizeof(BodyMotion) / sizeof(float);
    LENDULET_FORCE_INLINE static Vec3T<F> load(const BodyMotion* m, int first, int quad, F& w) {
        F q[4];
        load4<W>(m->q0, first, stride, 4 * quad, q);
        w = q[3];
        return {q[0], q[1], q[2]};
    }
    LENDULET_FORCE_INLINE static void store(BodyMotion* m, int first, int quad, Vec3T<F> v, F w) {
        F q[4] = {v.x, v.y, v.z, w};
        store4<W>(m->q0, first, stride, 4 * quad, q);
    }
};
enum MotionQuad { quad_q0, quad_inertia, quad_inverse, quad_L, quad_acceleration, quad_torque, quad_v_ref, quad_w_ref,
                  quad_dv, quad_dw, quad_v_start, quad_L_start, quad_change_v, quad_change_L };

// Theta w or Theta^-1 L: R diag(principal) R^T applied to a world vector.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> apply_principal(QuatT<F> q, Vec3T<F> principal, Vec3T<F> v) {
    return rotate(q, multiply(principal, rotate_inverse(q, v)));
}

// exp of half the rotation vector `turn`, as a quaternion; |turn| <= 1. Taylor series to single precision.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_quaternion(Vec3T<F> turn) {
    F x = splat<F>(0.25f) * dot(turn, turn);  // (angle / 2)^2
    F s = splat<F>(0.5f) + x * (splat<F>(-1.0f / 12.0f) + x * (splat<F>(1.0f / 240.0f) + x * splat<F>(-1.0f / 10080.0f)));
    F c = splat<F>(1.0f) +
          x * (splat<F>(-0.5f) + x * (splat<F>(1.0f / 24.0f) + x * (splat<F>(-1.0f / 720.0f) + x * splat<F>(1.0f / 40320.0f))));
    return {s * turn.x, s * turn.y, s * turn.z, c};
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> normalized(QuatT<F> q) {
    F s = splat<F>(1.0f) / square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

inline constexpr int max_turn_parts = 32;

// Turns dq q0 over h at constant L. The fixed point of the midpoint rule contracts for h |w| anisotropy < 1, so fast and
// slender bodies are turned in parts; kinematic lanes (no inertia) turn with their given w.
template <int W>
LENDULET_FORCE_INLINE QuatT<Wide<float, W>> turn_at_constant_L(QuatT<Wide<float, W>> dq, QuatT<Wide<float, W>> q0,
                                                              Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> inverse,
                                                              Vec3T<Wide<float, W>> w, Wide<float, W> anisotropy, float h) {
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

template <int W>
void kick_bodies(SolverBodies& bodies, const SubstepConstants& k, bool first_substep, int begin, int end) {
    using F = Wide<float, W>;
    using M = MotionBlock<W>;
    BodyMotion* motion = bodies.motion.data();
    for (int i = begin; i < end; i += W) {
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = i + l;
        WideVelocity<F> x = load_velocity<W>(bodies.state.data(), index);
        auto movable = x.inverse_mass > splat<F>(0.0f);
        F unused, linear_decay, angular_decay, anisotropy;
        Vec3T<F> inertia = M::load(motion, i, quad_inertia, linear_decay);
        M::load(motion, i, quad_inverse, angular_decay);
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
            load4<W>(motion->q0, i, M::stride, 4 * quad_q0, q);
            QuatT<F> orientation = multiply(dq, QuatT<F>{q[0], q[1], q[2], q[3]});
            Vec3T<F> rv = x.v - M::load(motion, i, quad_v_ref, unused), rw = x.w - M::load(motion, i, quad_w_ref, unused);
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
        F free;
        Vec3T<F> acceleration = M::load(motion, i, quad_acceleration, free), torque = M::load(motion, i, quad_torque, unused);
        L = angular_decay * L + splat<F>(k.h) * torque;
        SymMat3T<F> I = load_inverse_inertia<W>(bodies.inertia.data(), index);
        x.v = select(movable, linear_decay * x.v + splat<F>(k.h) * acceleration, x.v);
        x.w = select(movable, I * L, x.w);
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
        WideVelocity<F> x = load_velocity<W>(state, index);
        Vec3T<F> dp;
        QuatT<F> dq;
        load_displacement<W>(state, index, dp, dq);
        F unused, anisotropy, free, q[4];
        load4<W>(motion->q0, i, M::stride, 4 * quad_q0, q);
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
        Vec3T<F> change_L = even_change(L - M::load(motion, i, quad_L_start, unused),
                                        M::load(motion, i, quad_change_L, unused), free);
        dp = dp + splat<F>(k.h) * (x.v - half * change_v);
        dq = turn_at_constant_L<W>(dq, q0, L - half * change_L, inverse, x.w, anisotropy, k.h);

        SymMat3T<F> I = rotate_diagonal(rotation_matrix<F>(multiply(dq, q0), splat<F>(1.0f)), inverse);
        x.w = select(x.inverse_mass > zero, I * L, x.w);
        store_velocity<W>(state, index, x);
        F p[4] = {dp.x, dp.y, dp.z, zero}, r[4] = {dq.x, dq.y, dq.z, dq.w};
        scatter4<W>(state->v, index, 16, 8, p);
        scatter4<W>(state->v, index, 16, 12, r);
        F i0[4] = {I.xx, I.yy, I.zz, I.xy}, i1[4] = {I.xz, I.yz, zero, zero};
        scatter4<W>(bodies.inertia.data()->inverse, index, 8, 0, i0);
        scatter4<W>(bodies.inertia.data()->inverse, index, 8, 4, i1);
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
        load4<W>(motion->q0, i, M::stride, 4 * quad_q0, q);
        Vec3T<F> inertia = M::load(motion, i, quad_inertia, unused), L = M::load(motion, i, quad_L, anisotropy);
        Vec3T<F> rw = x.w - M::load(motion, i, quad_w_ref, unused);
        L = L + apply_principal(multiply(dq, QuatT<F>{q[0], q[1], q[2], q[3]}), inertia, rw);
        M::store(motion, i, quad_L, L, anisotropy);
        M::store(motion, i, quad_change_v, x.v - M::load(motion, i, quad_v_start, unused), splat<F>(0.0f));
        M::store(motion, i, quad_change_L, L - M::load(motion, i, quad_L_start, unused), splat<F>(0.0f));
    }
}
