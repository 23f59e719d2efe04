// What the solver found, into the bodies. Part of kernels.inl.

// Half of what |q|^2 lacks of 1.
template <int W>
LENDULET_FORCE_INLINE Wide<float, W> half_lack(QuatT<Wide<float, W>> q) {
    using F = Wide<float, W>;
    if constexpr (W == 1) {
        const double x = q.x, y = q.y, z = q.z, w = q.w;
        return static_cast<float>(0.5 * (1.0 - (x * x + y * y + z * z + w * w)));
    } else {
        using D = Wide<double, W>;
        const auto exact = [](F f) { return __builtin_convertvector(f, D); };
        const D x = exact(q.x), y = exact(q.y), z = exact(q.z), w = exact(q.w);
        return __builtin_convertvector(0.5 * (1.0 - (x * x + y * y + z * z + w * w)), F);
    }
}

// q <- dq q, where dq began with what rounding q took before, and leaves that anew in `low`. An orientation is rounded
// to 6e-8 rad, in every step again and not evenly: in ten minutes of steps of 1/240 s a top fell by 0.015 degrees.
template <int W>
LENDULET_FORCE_INLINE void add_turn(QuatT<Wide<float, W>>& q, Vec3T<Wide<float, W>>& low, QuatT<Wide<float, W>> dq) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f);
    // dq (1 + half of what |q| lacks of 1) - 1, without cancellation.
    const F grow = select(dq.w > zero, -(dq.x * dq.x + dq.y * dq.y + dq.z * dq.z) / (one + dq.w), dq.w - one);
    const F lack = half_lack<W>(q);
    const QuatT<F> d =
        multiply(QuatT<F>{dq.x + lack * dq.x, dq.y + lack * dq.y, dq.z + lack * dq.z, grow + lack * dq.w}, q);
    const QuatT<F> t{q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
    const QuatT<F> lost{d.x - (t.x - q.x), d.y - (t.y - q.y), d.z - (t.z - q.z), d.w - (t.w - q.w)};
    const QuatT<F> turn = multiply(lost, conjugate(t));
    low = {turn.x, turn.y, turn.z};
    q = t;
}

template <class F>
LENDULET_FORCE_INLINE F sum_of(Vec3T<F> v) {
    return v.x + v.y + v.z;
}

// 1 where all numbers are finite and no speed is too large. Nearly all bodies are slow, and neither square overflows
// unless they are not. Zero times what is not finite is NaN.
template <class F>
LENDULET_FORCE_INLINE F is_sound(const UnpackBatch& batch, Vec3T<F> x, QuatT<F> q, Vec3T<F> p, Vec3T<F> L,
                                 F inverse_mass, Vec3T<F> inverse_inertia) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), turning = largest(inverse_inertia);
    const F speed = inverse_mass * inverse_mass * dot(p, p), spin = turning * turning * dot(L, L);
    const F finite = (zero * sum_of(x) + zero * sum_of(p)) + zero * sum_of(L);
    const F size = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    const auto within = [&](F a, F most) { return select(a <= most, one, zero); };
    return (within(speed, splat<F>(batch.most_speed * batch.most_speed)) *
            within(spin, splat<F>(batch.most_spin * batch.most_spin))) *
           (select(size < splat<F>(2.0f), one, zero) * within(finite, zero));
}

template <int W>
void unpack_lanes(UnpackBatch& batch) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    const SolverBodies& from = *batch.packed;
    for (int i = 0; i < batch.count; i += W) {
        const auto lanes = [&](const float* p) { return load_wide<F>(p + i); };
        const int32_t *slot = batch.body + i, *place = batch.place + i;
        int32_t before[W];
        for (int l = 0; l < W; ++l) before[l] = place[l] - reserved_bodies;
        F pose[7], m[15], mass[8], solved[4], moved[8], motion[8], changed[8];
        gather7<W>(floats_of(batch.bodies.pose), slot, pose);
        scatter7<W>(floats_of(batch.before), before, pose);
        gather_momenta<W>(batch.bodies.momenta, slot, m);
        gather8<W>(floats_of(batch.bodies.mass), slot, mass_floats, 0, mass);
        gather4<W>(floats_of(from.state.data()), place, sizeof(BodyState) / sizeof(float), 0, solved);
        gather8<W>(floats_of(from.state.data()), place, sizeof(BodyState) / sizeof(float), 8, moved);
        gather8<W>(floats_of(from.motion.data()), place, sizeof(BodyMotion) / sizeof(float), 12, motion);
        gather8<W>(floats_of(from.motion.data()), place, sizeof(BodyMotion) / sizeof(float), 24, changed);
        const auto dynamic = lanes(batch.dynamic) > zero;
        Vec3T<F> x = vector_of(pose), p = vector_of(m), p_low = vector_of(m + 3), L = vector_of(m + 6),
                 x_low = vector_of(m + 9), turn_low;
        QuatT<F> q = quaternion_of(pose + 3);
        add_kept(x, x_low, vector_of(moved));
        add_turn<W>(q, turn_low, quaternion_of(moved + 4));
        // What only gravity acts on gets exactly m g dt, not what is left of it after adding to a large velocity.
        const auto free = motion[7] > zero;
        const Vec3T<F> alone = load_vector<F>(batch.gain, i) - lanes(batch.loss) * p;
        Vec3T<F> new_p = p, new_low = p_low;
        add_kept(new_p, new_low, select(free, alone, mass[0] * vector_of(solved)));
        p = select(dynamic, new_p, p), p_low = select(dynamic, new_low, p_low);
        L = select(dynamic, vector_of(motion), L);

        const F after[7] = {x.x, x.y, x.z, q.x, q.y, q.z, q.w};
        scatter7<W>(floats_of(batch.bodies.pose), slot, after);
        const F kept[15] = {p.x, p.y,     p.z,     p_low.x, p_low.y,    p_low.z,    L.x,       L.y,
                            L.z, x_low.x, x_low.y, x_low.z, turn_low.x, turn_low.y, turn_low.z};
        scatter8<W>(floats_of(batch.bodies.momenta), slot, momenta_floats, 0, kept);
        scatter8<W>(floats_of(batch.bodies.momenta), slot, momenta_floats, 7, kept + 7);
        const F substeps = select(dynamic, lanes(batch.substeps), zero);
        const Vec3T<F> v = substeps * vector_of(changed), l = substeps * vector_of(changed + 4);
        const F change[6] = {v.x, v.y, v.z, l.x, l.y, l.z};
        scatter4<W>(floats_of(batch.bodies.change), slot, change_floats, 0, change);
        scatter4<W>(floats_of(batch.bodies.change), slot, change_floats, 2, change + 2);

        const F sound = is_sound(batch, x, q, p, L, mass[1], vector_of(mass + 5));
        store_wide(batch.doubtful + i, one - sound);
    }
}
