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
// drift, half after the last one, all of them in between. Elsewhere all of the kick comes first, as contacts want it;
// see first_kick() for what changes.

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

// Theta w for bodies turned by dq since the start of the step. Where all moments are equal that asks for no
// orientation.
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> apply_moments(QuatT<Wide<float, W>> dq, const BlockLanes<W>& body,
                                                          Vec3T<Wide<float, W>> w) {
    using F = Wide<float, W>;
    const BodyBlock& b = body.block;
    const Vec3T<F> moments = body.get(b.inertia);
    const Vec3T<F> of_round = moments.x * w;
    auto round = body.get(b.anisotropy) <= splat<F>(1.0f);
    if (mask_bits(round) == (1u << W) - 1) return of_round;
    return select(round, of_round, apply_principal(multiply(dq, body.get(b.q0)), moments, w));
}

// L and what constraints changed it by, with what rounding added (Kahan 1965): many small changes of one direction
// would be rounded alike, each component by its own share, and a ball that spins out on a plane would roll away.
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> add_to_L(const BlockLanes<W>& body, Vec3T<Wide<float, W>> more) {
    const Vec3T<Wide<float, W>> L = body.get(body.block.L), d = more - body.get(body.block.L_low), sum = L + d;
    body.put(body.block.L_low, (sum - L) - d);
    return sum;
}

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
            x.put(b.L_low[k], splat<F>(0.0f));
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

template <class F>
struct JointMode {
    F jointed, split;  // 1 or 0
};
// How much of the kick comes first in a step. Half of it where it is split; elsewhere all, so velocities are those of
// the middle of the last substep, half a kick behind. What changes from one to the other begins with what the kick
// lacks or is ahead by, or a group that touches on its way down and lets go on its way up gains half a kick's work each
// time: a cradle of five balls 0.03 % a second.
template <class F>
LENDULET_FORCE_INLINE F first_kick(F joints) {
    constexpr float middle = 0.5f * (joints_touching + joints_split + joints_change);
    auto half = absolute(joints - splat<F>(middle)) < splat<F>(0.5f);
    return select(half, splat<F>(0.5f), splat<F>(1.0f));
}
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
            Vec3T<F> more_L = apply_moments<W>(dq, y, rw);
            dv = y.get(b.dv) + rv;
            dL = y.get(b.dL) + more_L;
            L = add_to_L<W>(y, more_L);
            y.put(b.change_v, x.v - y.get(b.v_start));
            y.put(b.change_L, L - y.get(b.L_start));
        }
        y.put(b.v_start, x.v);
        y.put(b.L_start, L);
        F h = splat<F>(k.h);
        if (k.joints && k.first) h = first_kick(y.get(b.joints)) * h;
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

// The size of the largest component. Squares of what little moves a body that stands are too small for fast arithmetic.
template <class F>
LENDULET_FORCE_INLINE F largest(Vec3T<F> v) {
    const Vec3T<F> a = absolute(v);
    return maximum(maximum(a.x, a.y), a.z);
}

// The change per substep that an evenly accelerating body shows; none for a body that is being stopped or pushed, nor
// for one that is pushed by another moving body: places must follow momenta where impulses between bodies act, or their
// angular momentum about each other changes. `pushed`: what constraints changed in this substep.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> even_change(Vec3T<F> now, Vec3T<F> before, F free, Vec3T<F> pushed) {
    auto even = largest(now - before) <= splat<F>(0.5f) * largest(before);
    const F zero = splat<F>(0.0f);
    F untouched = select(largest(pushed) > zero, zero, splat<F>(1.0f));
    free = select(free < zero, select(untouched > zero, untouched, free), free);
    return select(free > zero, now, select(free < zero, zero_vector<F>(), select(even, before, zero_vector<F>())));
}

// Speeds within a step, m/s and rad/s: twice those to which bodies are cut after it. Where contacts cannot follow a
// body any more, it stays finite.
inline constexpr float most_speed = 2e4f, most_spin = 6e3f;

// Whether any lane may be beyond `most`.
template <class F>
LENDULET_FORCE_INLINE bool may_exceed(Vec3T<F> speed, float most) {
    return mask_bits(largest(speed) > splat<F>(0.57f * most)) != 0;  // less than 1 / sqrt(3)
}

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
        const Vec3T<F> inverse = y.get(b.inverse_inertia), start_w = y.get(b.start_w), start_v = y.get(b.start_v);
        F anisotropy = y.get(b.anisotropy), free = y.get(b.free);
        Vec3T<F> dv = x.v - y.get(b.v_ref), dw = x.w - y.get(b.w_ref);
        Vec3T<F> more_L = apply_moments<W>(dq, y, dw);
        Vec3T<F> L = add_to_L<W>(y, more_L);
        if (may_exceed(start_v + x.v, most_speed) ||
            may_exceed(start_w + x.w, most_spin)) {  // and nothing of it is repeated
            const F speed_share = kept_share(start_v + x.v, most_speed),
                    spin_share = kept_share(start_w + x.w, most_spin);
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
        auto round = anisotropy <= splat<F>(1.0f);
        const bool all_round = mask_bits(round) == (1u << W) - 1;
        SymMat3T<F> I = load_inverse_inertia<W>(bodies.inertia.data(), c.index);
        dq = turn_at_constant_L<W>(dq, q0, L - half * change_L, inverse, start_w + x.w, anisotropy, I, k.h);
        if (!all_round) {
            const SymMat3T<F> turned = rotate_diagonal(rotation_matrix<F>(multiply(dq, q0), splat<F>(1.0f)), inverse);
            I = {select(round, I.xx, turned.xx), select(round, I.yy, turned.yy), select(round, I.zz, turned.zz),
                 select(round, I.xy, turned.xy), select(round, I.xz, turned.xz), select(round, I.yz, turned.yz)};
        }
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
        Vec3T<F> L = y.get(b.L) + apply_moments<W>(dq, y, rw);
        Vec3T<F> change_v = x.v - y.get(b.v_start), change_L = L - y.get(b.L_start);
        F momentum[4] = {L.x, L.y, L.z, y.get(b.anisotropy)};
        F changes[8] = {change_v.x, change_v.y, change_v.z, zero, change_L.x, change_L.y, change_L.z, zero};
        scatter4<W>(floats_of(bodies.motion.data()), c.index, stride, 12, momentum);
        scatter8<W>(floats_of(bodies.motion.data()), c.index, stride, 24, changes);
    }
}
