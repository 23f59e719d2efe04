// Contact rows: the constraint of one manifold, W of them side by side. Part of kernels.inl.
//
// All points of a manifold lie in one plane with normal n, so r_j x n = r x n - u_j t2 + v_j t1 with r the arm of their
// centre and (u, v) coordinates along t1, t2. The normal rows therefore live in three relative coordinates: the normal
// velocity at the centre and the relative spin about -t2 and t1. A sweep over the points needs the bodies once, at the
// start and at the end; in between the points see each other through the entries n_i M^-1 n_j.
//
// Arms follow the substep's motion: both bodies get the impulse at the same world point x_a + r_a = x_b + r_b, so
// linear and angular momentum are conserved together. Separations follow the bodies' displacement and rotation, but the
// point of a swept surface (ball, capsule, side of a cylinder) does not turn with its body, only its core point does.

//
// Rows work on changes of velocity since the start of the step. What the velocities then contribute is a constant of
// the row but for the arms' motion, so it is kept in the row and not gathered in every pass.

// Members that only rows of several points have.
template <class F, int P>
struct PatchTurn {
    Vec3T<F> start_spin;         // relative angular velocity at the start of the step
    F shift[2];                  // the separations' change per u, per v
    F coupling[P == 4 ? 6 : 1];  // n_i M^-1 n_j: 10 20 21 30 31 32
};
template <class F>
struct PatchTurn<F, 1> {};
template <class F, int P>
struct PatchPoint {
    F u, v;        // place along t1, t2 from the centre
    F separation;  // at the start of the step
    F impulse;     // accumulated normal impulse lambda
    F mass;        // 1 / (n M^-1 n)
};
template <class F>
struct PatchPoint<F, 1> {
    F separation, impulse, mass;
};
template <class F, int P>
struct PatchFriction {
    F mass[6];            // inverse of the block of t1, t2 and twist: 11 12 13 22 23 33
    F tangent[2], twist;  // impulses
};
template <class F>
struct PatchFriction<F, 1> {
    F mass[3];  // 11 12 22
    F tangent[2];
};

// Squares of the sine of half an angle, see MovedArms::turned: from 0.07 rad on a row of corners and a face turns with
// its bodies, all others get new masses from 0.2 rad on.
inline constexpr float near_turn = 1.2e-3f, far_turn = 0.01f;
// As far_turn, for rows of two balls; and what tells that such a row follows them. From `never` on turning changes
// nothing: sines are at most 1.
inline constexpr float turn_of_balls = 0.0101f, following_balls = -2.0f, never = 2.0f;
// Square of the growth of an arm, in parts of its length, from which on a row gets new masses, and one of balls a new
// normal.
inline constexpr float far_swing = 0.04f;

template <int W, int P>
struct alignas(64) ContactRow {
    using F = Wide<float, W>;
    int32_t a[W], b[W];  // eight times the body's index: the place of its inertia in floats, half that of its state
    // Read by both passes; where a line says so, written by relax for the solve of the next substep.
    Vec3T<F> n, t1;             // normal, first tangent; the second is n x t1
    Vec3T<F> lever_a, lever_b;  // arm x n; by relax
    F start_approach;  // relative normal velocity of the centre at the start of the step, with these arms; by relax
    F shift;           // the separations' change since the start of the step, at the centre; by relax
    F push_speed;      // fastest that overlap is undone
    F bounce_speed;    // times SubstepConstants::bounce_speed: the approach, negative, from which on impacts handle it
    F follow;          // share of the arms' motion that A's arm makes
    Vec3T<F> overdue;  // angular impulse that the held impulses lack since the bodies moved, unless they rest; by relax
    PatchPoint<F, P> p[P];
    [[no_unique_address]] PatchTurn<F, P> turn;
    // Read by relax alone.
    Vec3T<F> ra, rb;  // arms of the centre at the start of the step
    F radius_a, radius_b;
    F turn_limit;  // how far a body may turn before turn_row() is called, see MovedArms; negative when the row turns
    Vec3T<F> start_slip;  // relative velocity of the centre at the start of the step
    Vec3T<F> start_turn;  // angular velocity then of the bodies whose arms move, weighted by how much they do
    F static_friction, dynamic_friction;
    PatchFriction<F, P> friction;
};

// The second row of contacts that have a ContactExtra, see rolling.inl.
template <int W>
struct alignas(64) RollingRow {
    using F = Wide<float, W>;
    Vec3T<F> start_spin;  // relative angular velocity at the start of the step
    F mass[3];            // inverse of the block of t1 and t2: 11 12 22
    F mass_n;
    F rolling, spinning;   // m
    F tangent[2], normal;  // impulses on B, N m s
    Vec3T<F> running;      // see ContactExtra, m/s
};

// Changes of velocity since the start of the step, or the velocities then.
template <class F>
struct WideVelocity {
    Vec3T<F> v, w;
    F inverse_mass, drift_x;
};

template <int W>
LENDULET_FORCE_INLINE WideVelocity<Wide<float, W>> load_velocity(const BodyState* s, const int32_t* i) {
    Wide<float, W> p[4], q[4];
    gather4<W>(floats_of(s), i, 16, 0, p);
    gather4<W>(floats_of(s), i, 16, 4, q);
    return {{p[0], p[1], p[2]}, {q[0], q[1], q[2]}, p[3], q[3]};
}
template <int W>
LENDULET_FORCE_INLINE void store_velocity(BodyState* s, const int32_t* i, const WideVelocity<Wide<float, W>>& x) {
    Wide<float, W> p[4] = {x.v.x, x.v.y, x.v.z, x.inverse_mass}, q[4] = {x.w.x, x.w.y, x.w.z, x.drift_x};
    scatter4<W>(floats_of(s), i, 16, 0, p);
    scatter4<W>(floats_of(s), i, 16, 4, q);
}
template <int W>
LENDULET_FORCE_INLINE WideVelocity<Wide<float, W>> load_start(const BodyStart* s, const int32_t* i) {
    Wide<float, W> p[4], q[4];
    gather4<W>(floats_of(s), i, 8, 0, p);
    gather4<W>(floats_of(s), i, 8, 4, q);
    return {{p[0], p[1], p[2]}, {q[0], q[1], q[2]}, p[3], q[3]};
}
template <int W>
LENDULET_FORCE_INLINE SymMat3T<Wide<float, W>> load_inverse_inertia(const BodyInertia* s, const int32_t* i) {
    Wide<float, W> p[4], q[4];
    gather4<W>(floats_of(s), i, 8, 0, p);
    gather4<W>(floats_of(s), i, 8, 4, q);
    return {p[0], p[1], p[2], p[3], q[0], q[1]};
}
template <int W>
LENDULET_FORCE_INLINE void load_displacement(const BodyState* s, const int32_t* i, Vec3T<Wide<float, W>>& dp,
                                             QuatT<Wide<float, W>>& dq) {
    Wide<float, W> p[4], q[4];
    gather4<W>(floats_of(s), i, 16, 8, p);
    gather4<W>(floats_of(s), i, 16, 12, q);
    dp = {p[0], p[1], p[2]};
    dq = {q[0], q[1], q[2], q[3]};
}
// The same for the places that contact rows keep.
template <int W>
LENDULET_FORCE_INLINE WideVelocity<Wide<float, W>> load_velocity_at(const BodyState* s, const int32_t* place) {
    Wide<float, W> p[8];
    gather8<W>(floats_of(s), place, 2, 0, p);
    return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}, p[3], p[7]};
}
template <int W>
LENDULET_FORCE_INLINE WideVelocity<Wide<float, W>> load_start_at(const BodyStart* s, const int32_t* place) {
    Wide<float, W> p[8];
    gather8<W>(floats_of(s), place, 1, 0, p);
    return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}, p[3], p[7]};
}
template <int W>
LENDULET_FORCE_INLINE void store_velocity_at(BodyState* s, const int32_t* place,
                                             const WideVelocity<Wide<float, W>>& x) {
    Wide<float, W> p[8] = {x.v.x, x.v.y, x.v.z, x.inverse_mass, x.w.x, x.w.y, x.w.z, x.drift_x};
    scatter8<W>(floats_of(s), place, 2, 0, p);
}
template <int W>
LENDULET_FORCE_INLINE SymMat3T<Wide<float, W>> load_inverse_inertia_at(const BodyInertia* s, const int32_t* place) {
    Wide<float, W> p[8];
    gather8<W>(floats_of(s), place, 1, 0, p);
    return {p[0], p[1], p[2], p[3], p[4], p[5]};
}
// With how far the last drift moved the body, see BodyState::drift_x.
template <int W>
LENDULET_FORCE_INLINE SymMat3T<Wide<float, W>> load_inverse_inertia_at(const BodyInertia* s, const int32_t* place,
                                                                       const WideVelocity<Wide<float, W>>& x,
                                                                       Vec3T<Wide<float, W>>& drift) {
    Wide<float, W> p[8];
    gather8<W>(floats_of(s), place, 1, 0, p);
    drift = {x.drift_x, p[6], p[7]};
    return {p[0], p[1], p[2], p[3], p[4], p[5]};
}
template <int W>
LENDULET_FORCE_INLINE void load_displacement_at(const BodyState* s, const int32_t* place, Vec3T<Wide<float, W>>& dp,
                                                QuatT<Wide<float, W>>& dq) {
    Wide<float, W> p[8];
    gather8<W>(floats_of(s), place, 2, 8, p);
    dp = {p[0], p[1], p[2]};
    dq = {p[4], p[5], p[6], p[7]};
}
template <class F>
LENDULET_FORCE_INLINE F inverse_or_zero(F k) {
    return select(k > splat<F>(0.0f), splat<F>(1.0f) / k, splat<F>(0.0f));
}

// --- from records to rows

// Of points with arms `ra` and `rb` of their centre.
template <int W, int P>
LENDULET_FORCE_INLINE void prepare_normals(ContactRow<W, P>& c, Vec3T<Wide<float, W>> ra, Vec3T<Wide<float, W>> rb,
                                           const SymMat3T<Wide<float, W>>& IA, const SymMat3T<Wide<float, W>>& IB,
                                           Wide<float, W> inverse_masses) {
    using F = Wide<float, W>;
    Vec3T<F> t2 = cross(c.n, c.t1), minus_t2 = -t2;
    Vec3T<F> aA = cross(ra, c.n), aB = cross(rb, c.n);
    Vec3T<F> IaA = IA * aA, IbB = IB * aB, arms = IaA + IbB;
    SymMat3T<F> I = IA + IB;
    Vec3T<F> I1 = I * minus_t2, I2 = I * c.t1;
    // K in the coordinates (centre, -t2, t1): n_i M^-1 n_j = (1 u_i v_i) K (1 u_j v_j)^T
    F k00 = inverse_masses + dot(aA, IaA) + dot(aB, IbB), k01 = dot(arms, minus_t2), k02 = dot(arms, c.t1);
    F k11 = dot(minus_t2, I1), k12 = dot(c.t1, I1), k22 = dot(c.t1, I2);
    for (int j = 0; j < P; ++j) {
        if constexpr (P == 1) {
            c.p[j].mass = inverse_or_zero(k00);
        } else {
            F u = c.p[j].u, v = c.p[j].v;
            F h0 = k00 + u * k01 + v * k02, h1 = k01 + u * k11 + v * k12, h2 = k02 + u * k12 + v * k22;
            c.p[j].mass = inverse_or_zero(h0 + u * h1 + v * h2);
            for (int i = 0; i < j; ++i) c.turn.coupling[j * (j - 1) / 2 + i] = h0 + c.p[i].u * h1 + c.p[i].v * h2;
        }
    }
}

template <int W, int P>
LENDULET_FORCE_INLINE void prepare_friction(ContactRow<W, P>& c, Vec3T<Wide<float, W>> ra, Vec3T<Wide<float, W>> rb,
                                            const SymMat3T<Wide<float, W>>& IA, const SymMat3T<Wide<float, W>>& IB,
                                            Wide<float, W> inverse_masses) {
    using F = Wide<float, W>;
    Vec3T<F> t2 = cross(c.n, c.t1);
    Vec3T<F> a1 = cross(ra, c.t1), b1 = cross(rb, c.t1), a2 = cross(ra, t2), b2 = cross(rb, t2);
    Vec3T<F> Ia1 = IA * a1, Ib1 = IB * b1;
    F k11 = inverse_masses + dot(a1, Ia1) + dot(b1, Ib1), k12 = dot(a2, Ia1) + dot(b2, Ib1);
    F k22 = inverse_masses + dot(a2, IA * a2) + dot(b2, IB * b2);
    F* m = c.friction.mass;
    if constexpr (P == 1) {  // one point: nothing resists the twist
        F d = inverse_or_zero(k11 * k22 - k12 * k12);
        m[0] = d * k22, m[1] = -(d * k12), m[2] = d * k11;
    } else {
        Vec3T<F> In = IA * c.n, In2 = IB * c.n;
        F k13 = dot(a1, In) + dot(b1, In2), k23 = dot(a2, In) + dot(b2, In2), k33 = dot(c.n, In) + dot(c.n, In2);
        F c11 = k22 * k33 - k23 * k23, c12 = k13 * k23 - k12 * k33, c13 = k12 * k23 - k13 * k22;
        F d = inverse_or_zero(k11 * c11 + k12 * c12 + k13 * c13);
        m[0] = d * c11, m[1] = d * c12, m[2] = d * c13;
        m[3] = d * (k11 * k33 - k13 * k13), m[4] = d * (k12 * k13 - k11 * k23), m[5] = d * (k11 * k22 - k12 * k12);
    }
}

// One record a lane, as vectors of quads.
template <int W>
struct RecordQuads {
    using F = Wide<float, W>;
    static constexpr int stride = sizeof(ContactRecord) / sizeof(float);
    const float* base;
    int32_t index[W];
    LENDULET_FORCE_INLINE void load8(int offset, F out[8]) const { gather8<W>(base, index, stride, offset, out); }
    LENDULET_FORCE_INLINE void load4(int offset, F out[4]) const { gather4<W>(base, index, stride, offset, out); }
};

// What the velocities at the start of the step contribute to the row's.
template <int W, int P>
LENDULET_FORCE_INLINE void prepare_start(ContactRow<W, P>& c, const BodyArrays& bodies, const int32_t* a,
                                         const int32_t* b) {
    using F = Wide<float, W>;
    WideVelocity<F> A0 = load_start<W>(bodies.start, a), B0 = load_start<W>(bodies.start, b);
    c.start_slip = (B0.v - A0.v) + (cross(B0.w, c.rb) - cross(A0.w, c.ra));
    c.start_turn = c.follow * A0.w + (splat<F>(1.0f) - c.follow) * B0.w;
    c.start_approach = dot(c.n, c.start_slip);
    if constexpr (P > 1) c.turn.start_spin = B0.w - A0.w;
}

// Manifolds of one block of rows as quads: 0 1, 2 3, 4 .. 7, 8 9 of their records.
template <int W, int P>
struct ManifoldQuads {
    Wide<float, W> head[8], friction[8], point[P > 1 ? P : 2][4], tail[8];
    LENDULET_FORCE_INLINE explicit ManifoldQuads(const RecordQuads<W>& record) {
        record.load8(0, head);
        record.load8(8, friction);
        if constexpr (P == 1) record.load4(16, point[0]);
        else
            for (int j = 0; j < P; j += 2) record.load8(16 + 4 * j, point[j]);
        record.load8(32, tail);
    }
};

// How manifolds lie at the start of the step.
template <int W, int P>
struct RowPlace {
    using F = Wide<float, W>;
    Vec3T<F> n, t1, ra, rb;
    F u[P], v[P], separation[P], least;  // of the separations
    LENDULET_FORCE_INLINE explicit RowPlace(const ManifoldQuads<W, P>& m) : n{m.head[0], m.head[1], m.head[2]} {
        const F zero = splat<F>(0.0f), one = splat<F>(1.0f), half = splat<F>(0.5f), follow = m.tail[2];
        auto steep = absolute(n.x) > half;
        Vec3T<F> t = select(steep, Vec3T<F>{n.y, -n.x, zero}, Vec3T<F>{zero, n.z, -n.y});
        t1 = (one / square_root(dot(t, t))) * t;
        // The centre of the points, on the surface of the body that they ride on; but as far from the other surface as
        // the nearest of them. There the load will be, so friction must act in that plane: where a body stands on an
        // edge the middle of its face is well above it.
        Vec3T<F> sum = zero_vector<F>();
        F weight = zero, gap = zero;
        least = splat<F>(far_separation);
        for (int j = 0; j < P; ++j) {
            const F s = m.point[j][3];
            auto there = s < splat<F>(0.1f * far_separation);
            weight = weight + select(there, one, zero);
            gap = gap + select(there, s, zero);
            sum = sum + select(there, Vec3T<F>{m.point[j][0], m.point[j][1], m.point[j][2]}, zero_vector<F>());
            separation[j] = s;
            least = minimum(least, s);
        }
        F mean = one / maximum(weight, one);
        // Silenced manifolds (seams.cpp) have no points: their centre may be anywhere near the body.
        F rise = select(weight > zero, (follow - half) * (least + (least - mean * gap)), zero);
        ra = mean * sum + rise * n;
        rb = ra - Vec3T<F>{m.tail[4], m.tail[5], m.tail[6]};
        Vec3T<F> t2 = cross(n, t1);
        for (int j = 0; j < P; ++j) {
            Vec3T<F> d = Vec3T<F>{m.point[j][0], m.point[j][1], m.point[j][2]} - ra;
            u[j] = dot(d, t1);
            v[j] = dot(d, t2);
        }
    }
};

// Whether a body may turn about its centre and a contact's masses stay: it cannot be moved, or it is a ball about it,
// `radius` that of the surface at the end of `arm`.
template <class F>
LENDULET_FORCE_INLINE F turns_freely(const SymMat3T<F>& I, Vec3T<F> arm, Vec3T<F> n, F radius) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    const Vec3T<F> aside = arm - dot(arm, n) * n;
    F is = select(dot(aside, aside) <= splat<F>(0.01f) * (radius * radius), one, zero);
    is = select(maximum(absolute(I.xx - I.yy), absolute(I.xx - I.zz)) > zero, zero, is);
    is = select(maximum(maximum(absolute(I.xy), absolute(I.xz)), absolute(I.yz)) > zero, zero, is);
    return select(I.xx > zero, is, one);
}

// The share of what the contacts held in the last step with which they begin this one, see most_held_speed.
template <int W, int P>
LENDULET_FORCE_INLINE Wide<float, W> share_kept(const ContactRow<W, P>& c) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), most = splat<F>(most_held_speed);
    F excess = zero;
    for (int j = 0; j < P; ++j) excess = maximum(c.p[j].impulse - most * c.p[j].mass, excess);
    if (mask_bits(excess > zero) == 0) return one;
    F over = one;
    for (int j = 0; j < P; ++j) {
        const F held = most * c.p[j].mass;
        over = maximum(over, select(c.p[j].impulse > held, c.p[j].impulse / held, one));
    }
    return one / over;
}

template <int W, int P>
LENDULET_FORCE_INLINE void prepare_row(ContactRow<W, P>& c, const ContactGroup& group, const ContactRecord* records,
                                       const BodyArrays& bodies, int first) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f);
    int live = group.count - first < W ? group.count - first : W;
    RecordQuads<W> record{floats_of(records), {}};
    F sharp = zero;  // 1 where corners of one body meet a face of the other
    F balls = zero;  // and where two balls meet
    c.bounce_speed = splat<F>(-1e30f);
    int32_t body_a[W], body_b[W];
    for (int l = 0; l < W; ++l) {
        int32_t i = static_cast<int32_t>(group.order[first + (l < live ? l : 0)]);
        record.index[l] = i;
        body_a[l] = l < live ? records[i].body_a : group.filler;
        body_b[l] = l < live ? records[i].body_b : group.filler;
        if (group.shares) body_a[l] = stand_in(first + l, 0), body_b[l] = stand_in(first + l, 1);
        const uint32_t flags = records[i].flags;
        if (!group.rolling && (flags & contact_sharp)) set_lane(sharp, l, 1.0f);
        if (flags & contact_balls) set_lane(balls, l, 1.0f);
        // In a crowd blows that are not followed are met by rows.
        const bool followed = records[i].restitution > 0.0f && (flags & contact_crowded) == 0;
        if (followed || (flags & contact_swift)) set_lane(c.bounce_speed, l, -slowest_bounce(records[i]));
        c.a[l] = 8 * body_a[l];
        c.b[l] = 8 * body_b[l];
    }
    const ManifoldQuads<W, P> m(record);
    const RowPlace<W, P> place(m);
    const F unit = splat<F>(group.impulse_unit);
    c.n = place.n, c.t1 = place.t1, c.ra = place.ra, c.rb = place.rb;
    c.static_friction = m.head[3];
    c.dynamic_friction = m.friction[7];
    c.radius_a = m.tail[0], c.radius_b = m.tail[1], c.follow = m.tail[2];
    c.push_speed = m.tail[7];
    sharp = select(absolute(c.follow - splat<F>(0.5f)) > splat<F>(0.25f), sharp, zero);
    sharp = select(maximum(c.radius_a, c.radius_b) > zero, zero, sharp);
    c.turn_limit = select(sharp > zero, splat<F>(near_turn), splat<F>(far_turn));
    if constexpr (P == 1) c.turn_limit = select(balls > zero, splat<F>(turn_of_balls), c.turn_limit);
    c.lever_a = cross(c.ra, c.n);
    c.lever_b = cross(c.rb, c.n);
    for (int j = 0; j < P; ++j) {
        if constexpr (P > 1) c.p[j].u = place.u[j], c.p[j].v = place.v[j];
        c.p[j].separation = place.separation[j];
        c.p[j].impulse = unit * m.head[4 + j];
    }
    c.shift = zero;
    c.overdue = zero_vector<F>();
    if constexpr (P > 1) c.turn.shift[0] = c.turn.shift[1] = zero;
    prepare_start<W, P>(c, bodies, body_a, body_b);
    WideVelocity<F> A = load_velocity_at<W>(bodies.state, c.a), B = load_velocity_at<W>(bodies.state, c.b);
    SymMat3T<F> IA = load_inverse_inertia_at<W>(bodies.inertia, c.a);
    SymMat3T<F> IB = load_inverse_inertia_at<W>(bodies.inertia, c.b);
    F inverse_masses = A.inverse_mass + B.inverse_mass;
    if constexpr (P == 1) {
        const F free = minimum(turns_freely(IA, c.ra, c.n, c.radius_a), turns_freely(IB, c.rb, c.n, c.radius_b));
        c.turn_limit = select(free > zero, splat<F>(never) + select(balls > zero, zero, splat<F>(1.0f)), c.turn_limit);
    }
    prepare_normals<W, P>(c, c.ra, c.rb, IA, IB, inverse_masses);
    prepare_friction<W, P>(c, c.ra, c.rb, IA, IB, inverse_masses);
    const F kept = share_kept<W, P>(c);
    for (int j = 0; j < P; ++j) c.p[j].impulse = kept * c.p[j].impulse;
    const Vec3T<F> f = (kept * unit) * Vec3T<F>{m.friction[0], m.friction[1], m.friction[2]};
    c.friction.tangent[0] = dot(f, c.t1);
    c.friction.tangent[1] = dot(f, cross(c.n, c.t1));
    if constexpr (P > 1) c.friction.twist = (kept * unit) * m.friction[3];
    for (int l = live; l < W; ++l) {  // empty lanes never push
        for (int j = 0; j < P; ++j) set_lane(c.p[j].impulse, l, 0.0f), set_lane(c.p[j].mass, l, 0.0f);
        set_lane(c.friction.tangent[0], l, 0.0f), set_lane(c.friction.tangent[1], l, 0.0f);
        if constexpr (P > 1) set_lane(c.friction.twist, l, 0.0f);
        for (F& m : c.friction.mass) set_lane(m, l, 0.0f);
    }
}

template <int W, int P>
void prepare_rows(const ContactGroup& g, const ContactRecord* records, const BodyArrays& bodies, int begin, int end) {
    auto* rows = reinterpret_cast<ContactRow<W, P>*>(g.rows);
    for (int i = begin; i < end; ++i) prepare_row<W, P>(rows[i], g, records, bodies, i * W);
}

// --- and back

template <int W, int P>
void store_rows(const ContactGroup& g, ContactRecord* records, int begin, int end) {
    using F = Wide<float, W>;
    constexpr int stride = sizeof(ContactRecord) / sizeof(float);
    const F zero = splat<F>(0.0f), unit = splat<F>(1.0f / g.impulse_unit);
    auto* rows = reinterpret_cast<const ContactRow<W, P>*>(g.rows);
    for (int i = begin; i < end; ++i) {
        const ContactRow<W, P>& c = rows[i];
        Vec3T<F> f = unit * (c.friction.tangent[0] * c.t1 + c.friction.tangent[1] * cross(c.n, c.t1));
        // Of rows that were passed over zeros have another sign.
        F impulses[8] = {zero, zero, zero, zero, f.x + zero, f.y + zero, f.z + zero, zero};
        float separation[P][W];
        for (int j = 0; j < P; ++j) {
            impulses[j] = unit * c.p[j].impulse;
            F s = c.shift;
            if constexpr (P > 1) s = s + (c.p[j].u * c.turn.shift[0] + c.p[j].v * c.turn.shift[1]);
            s = select(c.p[j].separation < splat<F>(0.1f * far_separation), c.p[j].separation + s, c.p[j].separation);
            store_wide(separation[j], s);
        }
        if constexpr (P > 1) impulses[7] = unit * c.friction.twist + zero;
        int live = g.count - i * W < W ? g.count - i * W : W;
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = static_cast<int32_t>(g.order[i * W + (l < live ? l : 0)]);
        if (live == W) {
            scatter8<W>(floats_of(records), index, stride, 4, impulses);
        } else {
            float lanes[8][W];
            for (int k = 0; k < 8; ++k) store_wide(lanes[k], impulses[k]);
            for (int l = 0; l < live; ++l)
                for (int k = 0; k < 8; ++k) floats_of(records)[index[l] * stride + 4 + k] = lanes[k][l];
        }
        for (int l = 0; l < live; ++l)
            for (int j = 0; j < P; ++j) records[index[l]].points[j].separation = separation[j][l];
    }
}
