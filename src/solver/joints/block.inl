// The algebra of joints: how the relative motion at a shared world point answers to impulses there, and the direct
// solve of a few rows. Part of kernels.inl.

// L D L^T of a symmetric positive definite matrix, with D inverted. Rows that cannot move (empty lanes) get no impulse.
template <class F, int N>
struct Factor {
    F lower[N > 1 ? N*(N - 1) / 2 : 1];  // row by row: 10 20 21 30 31 32 ...
    F inverse[N];

    LENDULET_FORCE_INLINE F& at(int i, int j) { return lower[i * (i - 1) / 2 + j]; }
    LENDULET_FORCE_INLINE F at(int i, int j) const { return lower[i * (i - 1) / 2 + j]; }

    // Pivots below a millionth of the row's own size are noise of the cancellation and are held there.
    LENDULET_FORCE_INLINE void set(const F (&k)[N][N]) {
        F d[N];
        for (int i = 0; i < N; ++i) {
            F v[N];
            d[i] = k[i][i];
            for (int j = 0; j < i; ++j) {
                v[j] = k[i][j];
                for (int m = 0; m < j; ++m) v[j] = v[j] - at(j, m) * v[m];  // v = L_ij d_j
                at(i, j) = v[j] * inverse[j];
                d[i] = d[i] - at(i, j) * v[j];
            }
            inverse[i] = inverse_or_zero(maximum(d[i], splat<F>(1e-6f) * k[i][i]));
        }
    }
    LENDULET_FORCE_INLINE void solve(F (&x)[N]) const {
        for (int i = 1; i < N; ++i)
            for (int j = 0; j < i; ++j) x[i] = x[i] - at(i, j) * x[j];
        for (int i = N - 1; i >= 0; --i) {
            x[i] = x[i] * inverse[i];
            for (int j = i + 1; j < N; ++j) x[i] = x[i] - at(j, i) * x[j];
        }
    }
};

// Velocity of B relative to A at the shared point (linear) and in turning (angular), per impulse P at that point and
// angular impulse T: linear = K P + C T, angular = C^T P + I T. With r the arm of either body, row i of its part of C
// is I^-1 (r x e_i), and its part of K is that crossed into r.
template <class F>
struct PointResponse {
    SymMat3T<F> linear;   // K
    Vec3T<F> x, y, z;     // rows of C
    SymMat3T<F> angular;  // I

    LENDULET_FORCE_INLINE Vec3T<F> coupled(Vec3T<F> t) const { return {dot(x, t), dot(y, t), dot(z, t)}; }  // C t
    LENDULET_FORCE_INLINE Vec3T<F> turned(Vec3T<F> p) const { return p.x * x + p.y * y + p.z * z; }         // C^T p
};

template <class F>
LENDULET_FORCE_INLINE void add_body(PointResponse<F>& p, Vec3T<F> r, const SymMat3T<F>& I) {
    Vec3T<F> ix{I.xx, I.xy, I.xz}, iy{I.xy, I.yy, I.yz}, iz{I.xz, I.yz, I.zz};
    Vec3T<F> x = r.z * iy - r.y * iz, y = r.x * iz - r.z * ix, z = r.y * ix - r.x * iy;  // I (r x e_i)
    p.linear.xx = p.linear.xx + (r.z * x.y - r.y * x.z);
    p.linear.yy = p.linear.yy + (r.x * y.z - r.z * y.x);
    p.linear.zz = p.linear.zz + (r.y * z.x - r.x * z.y);
    p.linear.xy = p.linear.xy + (r.z * y.y - r.y * y.z);
    p.linear.xz = p.linear.xz + (r.z * z.y - r.y * z.z);
    p.linear.yz = p.linear.yz + (r.x * z.z - r.z * z.x);
    p.x = p.x + x;
    p.y = p.y + y;
    p.z = p.z + z;
}

template <class F>
LENDULET_FORCE_INLINE PointResponse<F> point_response(Vec3T<F> ra, Vec3T<F> rb, const SymMat3T<F>& IA,
                                                      const SymMat3T<F>& IB, F inverse_masses) {
    const F zero = splat<F>(0.0f);
    PointResponse<F> p{{inverse_masses, inverse_masses, inverse_masses, zero, zero, zero},
                       zero_vector<F>(),
                       zero_vector<F>(),
                       zero_vector<F>(),
                       IA + IB};
    add_body(p, ra, IA);
    add_body(p, rb, IB);
    return p;
}

// The two bodies of W joints: changes of velocity since the start of the step, the velocities then (of B relative to
// A), and what the joints' arms need.
template <class F>
struct JointPair {
    WideVelocity<F> A, B;
    Vec3T<F> start_v, start_wa, start_wb;
    SymMat3T<F> IA, IB;
    Vec3T<F> gyro_a, gyro_b;  // angular acceleration by the bodies' own spin
    Vec3T<F> dpa, dpb;        // displacement and rotation since the start of the step
    QuatT<F> dqa, dqb;

    LENDULET_FORCE_INLINE Vec3T<F> sliding(Vec3T<F> ra, Vec3T<F> rb) const {
        return (start_v + (B.v - A.v)) + (cross(spin_b(), rb) - cross(spin_a(), ra));
    }
    LENDULET_FORCE_INLINE Vec3T<F> turning() const { return (start_wb - start_wa) + (B.w - A.w); }
    LENDULET_FORCE_INLINE Vec3T<F> spin_a() const { return start_wa + A.w; }
    LENDULET_FORCE_INLINE Vec3T<F> spin_b() const { return start_wb + B.w; }
    LENDULET_FORCE_INLINE void push(Vec3T<F> ra, Vec3T<F> rb, Vec3T<F> P, Vec3T<F> T) {
        A.v = A.v - A.inverse_mass * P;
        A.w = A.w - IA * (cross(ra, P) + T);
        B.v = B.v + B.inverse_mass * P;
        B.w = B.w + IB * (cross(rb, P) + T);
    }
};

// Of one body: all but the velocities at the start of the step. The kick left its gyroscopic acceleration in the unused
// places of its state and inertia.
template <int W>
LENDULET_FORCE_INLINE void load_joint_body(const SolverBodies& bodies, const int32_t* place,
                                           WideVelocity<Wide<float, W>>& x, Vec3T<Wide<float, W>>& dp,
                                           QuatT<Wide<float, W>>& dq, SymMat3T<Wide<float, W>>& I,
                                           Vec3T<Wide<float, W>>& gyro) {
    Wide<float, W> p[8], m[8];
    x = load_velocity_at<W>(bodies.state.data(), place);
    gather8<W>(floats_of(bodies.state.data()), place, sizeof(BodyState) / 32, 8, p);
    gather8<W>(floats_of(bodies.inertia.data()), place, sizeof(BodyInertia) / 32, 0, m);
    dp = {p[0], p[1], p[2]};
    dq = {p[4], p[5], p[6], p[7]};
    I = {m[0], m[1], m[2], m[3], m[4], m[5]};
    gyro = {m[6], m[7], p[3]};
}
