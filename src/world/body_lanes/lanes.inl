// W bodies by slot: their state as the kernels use it. Part of kernels.inl.

// Where the floats of the stores' records are.
inline constexpr int pose_floats = 7, momenta_floats = 15, mass_floats = 9, change_floats = 6;
static_assert(sizeof(Pose) == pose_floats * sizeof(float) && sizeof(BodyMomenta) == momenta_floats * sizeof(float));
static_assert(sizeof(BodyMass) == mass_floats * sizeof(float) && sizeof(BodyChange) == change_floats * sizeof(float));

template <class F>
LENDULET_FORCE_INLINE Vec3T<F> vector_of(const F* f) {
    return {f[0], f[1], f[2]};
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> quaternion_of(const F* f) {
    return {f[0], f[1], f[2], f[3]};
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> load_vector(const float (*p)[body_batch], int i) {
    return {load_wide<F>(p[0] + i), load_wide<F>(p[1] + i), load_wide<F>(p[2] + i)};
}
template <class F>
LENDULET_FORCE_INLINE void store_vector(float (*p)[body_batch], int i, Vec3T<F> v) {
    store_wide(p[0] + i, v.x);
    store_wide(p[1] + i, v.y);
    store_wide(p[2] + i, v.z);
}
template <class F>
LENDULET_FORCE_INLINE F largest(Vec3T<F> v) {
    return maximum(v.x, maximum(v.y, v.z));
}
// Records of seven floats: a vector and a quaternion. No load reaches beyond a record.
template <int W>
LENDULET_FORCE_INLINE void gather7(const float* base, const int32_t* index, Wide<float, W> out[7]) {
    Wide<float, W> end[4];
    gather4<W>(base, index, 7, 0, out);
    gather4<W>(base, index, 7, 3, end);
    for (int k = 1; k < 4; ++k) out[3 + k] = end[k];
}
template <int W>
LENDULET_FORCE_INLINE void scatter7(float* base, const int32_t* index, const Wide<float, W> in[7]) {
    scatter4<W>(base, index, 7, 0, in);
    scatter4<W>(base, index, 7, 3, in + 3);
}
template <int W>
LENDULET_FORCE_INLINE void gather_momenta(const BodyMomenta* momenta, const int32_t* body, Wide<float, W> out[15]) {
    Wide<float, W> end[8];
    gather8<W>(floats_of(momenta), body, momenta_floats, 0, out);
    gather8<W>(floats_of(momenta), body, momenta_floats, 7, end);
    for (int k = 1; k < 8; ++k) out[7 + k] = end[k];
}

// A block of bodies as it is now.
template <int W>
struct BodyLanes {
    using F = Wide<float, W>;
    Vec3T<F> x, p, L, x_low, turn_low;
    QuatT<F> q;
    F inverse_mass, anisotropy;
    Vec3T<F> inertia, inverse_inertia;

    LENDULET_FORCE_INLINE BodyLanes(const BodyColumns& bodies, const int32_t* body) {
        F pose[7], m[15], mass[8];
        gather7<W>(floats_of(bodies.pose), body, pose);
        gather_momenta<W>(bodies.momenta, body, m);
        gather8<W>(floats_of(bodies.mass), body, mass_floats, 1, mass);
        x = vector_of(pose), q = quaternion_of(pose + 3);
        p = vector_of(m), L = vector_of(m + 6), x_low = vector_of(m + 9), turn_low = vector_of(m + 12);
        inverse_mass = mass[0], inertia = vector_of(mass + 1), inverse_inertia = vector_of(mass + 4);
        anisotropy = mass[7];
    }
    // As BodyStore's functions of these names; `kinematic`: momenta hold velocities.
    template <class Mask>
    LENDULET_FORCE_INLINE Vec3T<F> velocity(Mask kinematic) const {
        return select(kinematic, p, inverse_mass * p);
    }
    template <class Mask>
    LENDULET_FORCE_INLINE Vec3T<F> angular_velocity(Mask kinematic) const {
        const auto round = anisotropy <= splat<F>(1.0f);
        Vec3T<F> w = inverse_inertia.x * L;
        if (mask_bits(round) != (1u << W) - 1)
            w = select(round, w, rotate(q, multiply(inverse_inertia, rotate_inverse(q, L))));
        return select(kinematic, L, w);
    }
    LENDULET_FORCE_INLINE SymMat3T<F> inverse_inertia_world() const {
        const auto round = anisotropy <= splat<F>(1.0f);
        const F zero = splat<F>(0.0f), same = inverse_inertia.x;
        if (mask_bits(round) == (1u << W) - 1) return {same, same, same, zero, zero, zero};
        const SymMat3T<F> I = rotate_diagonal(rotation_matrix<F>(q, splat<F>(1.0f)), inverse_inertia);
        return {select(round, same, I.xx), select(round, same, I.yy), select(round, same, I.zz),
                select(round, zero, I.xy), select(round, zero, I.xz), select(round, zero, I.yz)};
    }
};
