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

template <int W, int P>
struct alignas(64) ContactRow {
    using F = Wide<float, W>;
    int32_t a[W], b[W];
    Vec3T<F> n, t1;   // normal, first tangent; the second is n x t1
    Vec3T<F> ra, rb;  // arms of the centre at the start of the step
    F follow, radius_a, radius_b;
    struct Point {
        F u, v;        // place along t1, t2 from the centre
        F separation;  // at the start of the step
        F impulse;     // accumulated normal impulse lambda
        F mass;        // 1 / (n M^-1 n)
    } p[P];
    F coupling[P == 4 ? 6 : 1];  // n_i M^-1 n_j: 10 20 21 30 31 32
    Vec3T<F> moved;              // displacement of B relative to A since the start of the step
    F shift[3];                  // the separations' change: at the centre, per u, per v
    F static_friction, dynamic_friction;
    F friction_mass[6];   // inverse of the block of t1, t2 and twist: 11 12 13 22 23 33
    F tangent[2], twist;  // friction impulses
    F push_speed;         // fastest that overlap is undone
    F bounce_speed;       // approach speed from which the impact stage alone handles the point; huge where e = 0
};

struct BodyArrays {
    BodyState* state;
    const BodyInertia* inertia;
    const BodyStart* start;
};

// Changes of velocity since the start of the step, or the velocities then.
template <class F>
struct WideVelocity {
    Vec3T<F> v, w;
    F inverse_mass, unused;
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
    Wide<float, W> p[4] = {x.v.x, x.v.y, x.v.z, x.inverse_mass}, q[4] = {x.w.x, x.w.y, x.w.z, x.unused};
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
// R(dq)^T n - n, without the cancellation of computing the rotated vector first.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> turned_back(QuatT<F> dq, Vec3T<F> n) {
    Vec3T<F> u{-dq.x, -dq.y, -dq.z};
    Vec3T<F> c = cross(u, cross(u, n) + dq.w * n);
    return c + c;
}
template <class F>
LENDULET_FORCE_INLINE F inverse_or_zero(F k) {
    return select(k > splat<F>(0.0f), splat<F>(1.0f) / k, splat<F>(0.0f));
}

// --- from records to rows

template <int W, int P>
LENDULET_FORCE_INLINE void prepare_normals(ContactRow<W, P>& c, const SymMat3T<Wide<float, W>>& IA,
                                           const SymMat3T<Wide<float, W>>& IB, Wide<float, W> inverse_masses) {
    using F = Wide<float, W>;
    Vec3T<F> t2 = cross(c.n, c.t1), minus_t2 = -t2;
    Vec3T<F> aA = cross(c.ra, c.n), aB = cross(c.rb, c.n);
    Vec3T<F> IaA = IA * aA, IbB = IB * aB, arms = IaA + IbB;
    SymMat3T<F> I = IA + IB;
    Vec3T<F> I1 = I * minus_t2, I2 = I * c.t1;
    // K in the coordinates (centre, -t2, t1): n_i M^-1 n_j = (1 u_i v_i) K (1 u_j v_j)^T
    F k00 = inverse_masses + dot(aA, IaA) + dot(aB, IbB), k01 = dot(arms, minus_t2), k02 = dot(arms, c.t1);
    F k11 = dot(minus_t2, I1), k12 = dot(c.t1, I1), k22 = dot(c.t1, I2);
    for (int j = 0; j < P; ++j) {
        F u = c.p[j].u, v = c.p[j].v;
        F h0 = k00 + u * k01 + v * k02, h1 = k01 + u * k11 + v * k12, h2 = k02 + u * k12 + v * k22;
        c.p[j].mass = inverse_or_zero(h0 + u * h1 + v * h2);
        for (int i = 0; i < j; ++i) c.coupling[j * (j - 1) / 2 + i] = h0 + c.p[i].u * h1 + c.p[i].v * h2;
    }
}

template <int W, int P>
LENDULET_FORCE_INLINE void prepare_friction(ContactRow<W, P>& c, const SymMat3T<Wide<float, W>>& IA,
                                            const SymMat3T<Wide<float, W>>& IB, Wide<float, W> inverse_masses) {
    using F = Wide<float, W>;
    Vec3T<F> t2 = cross(c.n, c.t1);
    Vec3T<F> a1 = cross(c.ra, c.t1), b1 = cross(c.rb, c.t1), a2 = cross(c.ra, t2), b2 = cross(c.rb, t2);
    Vec3T<F> Ia1 = IA * a1, Ib1 = IB * b1;
    F k11 = inverse_masses + dot(a1, Ia1) + dot(b1, Ib1), k12 = dot(a2, Ia1) + dot(b2, Ib1);
    F k22 = inverse_masses + dot(a2, IA * a2) + dot(b2, IB * b2);
    F* m = c.friction_mass;
    if constexpr (P == 1) {  // one point: nothing resists the twist
        F d = inverse_or_zero(k11 * k22 - k12 * k12);
        m[0] = d * k22, m[1] = -(d * k12), m[3] = d * k11;
        m[2] = m[4] = m[5] = splat<F>(0.0f);
    } else {
        Vec3T<F> In = IA * c.n, In2 = IB * c.n;
        F k13 = dot(a1, In) + dot(b1, In2), k23 = dot(a2, In) + dot(b2, In2), k33 = dot(c.n, In) + dot(c.n, In2);
        F c11 = k22 * k33 - k23 * k23, c12 = k13 * k23 - k12 * k33, c13 = k12 * k23 - k13 * k22;
        F d = inverse_or_zero(k11 * c11 + k12 * c12 + k13 * c13);
        m[0] = d * c11, m[1] = d * c12, m[2] = d * c13;
        m[3] = d * (k11 * k33 - k13 * k13), m[4] = d * (k12 * k13 - k11 * k23), m[5] = d * (k11 * k22 - k12 * k12);
    }
}

template <int W, int P>
LENDULET_FORCE_INLINE void prepare_row(ContactRow<W, P>& c, const ContactGroup& group, const ContactRecord* records,
                                       const SolverBodies& bodies, int first) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), half = splat<F>(0.5f);
    int live = group.count - first < W ? group.count - first : W;
    int32_t index[W];
    for (int l = 0; l < W; ++l) {
        index[l] = static_cast<int32_t>(group.order[first + (l < live ? l : 0)]);
        c.a[l] = l < live ? records[index[l]].body_a : group.filler;
        c.b[l] = l < live ? records[index[l]].body_b : group.filler;
    }
    const float* base = floats_of(records);
    constexpr int stride = sizeof(ContactRecord) / sizeof(float);
    F normal[4], impulse[4], friction[4], ints[4], surface[4], offset[4], point[P][4];
    gather4<W>(base, index, stride, 0, normal);
    gather4<W>(base, index, stride, 4, impulse);
    gather4<W>(base, index, stride, 8, friction);
    gather4<W>(base, index, stride, 12, ints);
    for (int j = 0; j < P; ++j) gather4<W>(base, index, stride, 16 + 4 * j, point[j]);
    gather4<W>(base, index, stride, 32, surface);
    gather4<W>(base, index, stride, 36, offset);

    c.n = {normal[0], normal[1], normal[2]};
    auto steep = absolute(c.n.x) > half;
    Vec3T<F> t = select(steep, Vec3T<F>{c.n.y, -c.n.x, zero}, Vec3T<F>{zero, c.n.z, -c.n.y});
    c.t1 = (one / square_root(dot(t, t))) * t;
    c.static_friction = normal[3];
    c.dynamic_friction = ints[3];
    c.radius_a = surface[0], c.radius_b = surface[1], c.follow = surface[2];
    c.bounce_speed = select(surface[3] > zero, splat<F>(-1.0f), splat<F>(-1e30f));
    c.push_speed = offset[3];

    // The centre of the points, on the surface of the body that they ride on.
    Vec3T<F> sum = zero_vector<F>();
    F weight = zero, gap = zero;
    for (int j = 0; j < P; ++j) {
        auto there = point[j][3] < splat<F>(0.1f * far_separation);
        weight = weight + select(there, one, zero);
        gap = gap + select(there, point[j][3], zero);
        sum = sum + select(there, Vec3T<F>{point[j][0], point[j][1], point[j][2]}, zero_vector<F>());
    }
    F mean = one / maximum(weight, one);
    c.ra = mean * sum + ((c.follow - half) * (mean * gap)) * c.n;
    c.rb = c.ra - Vec3T<F>{offset[0], offset[1], offset[2]};

    Vec3T<F> t2 = cross(c.n, c.t1);
    for (int j = 0; j < P; ++j) {
        Vec3T<F> d = Vec3T<F>{point[j][0], point[j][1], point[j][2]} - c.ra;
        c.p[j].u = P == 1 ? zero : dot(d, c.t1);
        c.p[j].v = P == 1 ? zero : dot(d, t2);
        c.p[j].separation = point[j][3];
        c.p[j].impulse = impulse[j];
    }
    WideVelocity<F> A = load_velocity<W>(bodies.state.data(), c.a), B = load_velocity<W>(bodies.state.data(), c.b);
    SymMat3T<F> IA = load_inverse_inertia<W>(bodies.inertia.data(), c.a);
    SymMat3T<F> IB = load_inverse_inertia<W>(bodies.inertia.data(), c.b);
    F inverse_masses = A.inverse_mass + B.inverse_mass;
    prepare_normals<W, P>(c, IA, IB, inverse_masses);
    prepare_friction<W, P>(c, IA, IB, inverse_masses);
    Vec3T<F> f{friction[0], friction[1], friction[2]};
    c.tangent[0] = dot(f, c.t1);
    c.tangent[1] = dot(f, t2);
    c.twist = friction[3];
    c.moved = zero_vector<F>();
    for (F& s : c.shift) s = zero;
    for (int l = live; l < W; ++l) {  // empty lanes never push
        for (int j = 0; j < P; ++j) set_lane(c.p[j].impulse, l, 0.0f), set_lane(c.p[j].mass, l, 0.0f);
        set_lane(c.tangent[0], l, 0.0f), set_lane(c.tangent[1], l, 0.0f), set_lane(c.twist, l, 0.0f);
        for (F& m : c.friction_mass) set_lane(m, l, 0.0f);
    }
}

template <int W, int P>
void prepare_rows(const ContactGroup& g, const ContactRecord* records, const SolverBodies& bodies, int begin, int end) {
    auto* rows = reinterpret_cast<ContactRow<W, P>*>(g.rows);
    for (int i = begin; i < end; ++i) prepare_row<W, P>(rows[i], g, records, bodies, i * W);
}

// --- the passes

enum class Pass { warm_start, solve, relax };

// Friction of the whole patch as one block (t1, t2, twist), limited by the round Coulomb cone on the total normal
// impulse: it sticks while the impulse that stops the sliding is within the static cone, and slides with the dynamic
// coefficient otherwise (thesis 3.3.4 with THESIS-NOTES). Returns the impulse on B and the angular impulse about n.
template <int W, int P>
LENDULET_FORCE_INLINE void solve_friction(ContactRow<W, P>& c, Vec3T<Wide<float, W>> t2, Vec3T<Wide<float, W>> slip,
                                          Wide<float, W> spin, Vec3T<Wide<float, W>>& linear,
                                          Vec3T<Wide<float, W>>& angular) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F total = c.p[0].impulse, lever = zero;
    if constexpr (P > 1) {
        lever = zero;
        total = zero;
        for (int j = 0; j < P; ++j) {
            total = total + c.p[j].impulse;
            lever = lever + c.p[j].impulse * square_root(c.p[j].u * c.p[j].u + c.p[j].v * c.p[j].v);
        }
    }
    const F* m = c.friction_mass;
    F x = dot(slip, c.t1), y = dot(slip, t2);
    F f1 = c.tangent[0] - (m[0] * x + m[1] * y + m[2] * spin);
    F f2 = c.tangent[1] - (m[1] * x + m[3] * y + m[4] * spin);
    F sticking = c.static_friction * total, sliding = c.dynamic_friction * total;
    F size2 = f1 * f1 + f2 * f2;
    F scale = select(size2 > sticking * sticking, sliding / maximum(square_root(size2), splat<F>(1e-30f)), one);
    f1 = scale * f1;
    f2 = scale * f2;
    linear = (f1 - c.tangent[0]) * c.t1 + (f2 - c.tangent[1]) * t2;
    c.tangent[0] = f1;
    c.tangent[1] = f2;
    angular = zero_vector<F>();
    if constexpr (P > 1) {
        F ft = c.twist - (m[2] * x + m[4] * y + m[5] * spin);
        F hold = c.static_friction * lever, slide = c.dynamic_friction * lever;
        ft = select(absolute(ft) > hold, select(ft > zero, slide, zero - slide), ft);
        angular = (ft - c.twist) * c.n;
        c.twist = ft;
    }
}

// Separations since the start of the step, from the two bodies' displacements.
template <int W, int P>
LENDULET_FORCE_INLINE void update_displacement(ContactRow<W, P>& c, const BodyState* states) {
    using F = Wide<float, W>;
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement<W>(states, c.a, dpa, dqa);
    load_displacement<W>(states, c.b, dpb, dqb);
    c.moved = dpb - dpa;
    Vec3T<F> ea = turned_back(dqa, c.n), eb = turned_back(dqb, c.n);
    c.shift[0] = dot(c.n, c.moved) + dot(eb, c.rb + c.radius_b * c.n) - dot(ea, c.ra - c.radius_a * c.n);
    if constexpr (P > 1) {
        Vec3T<F> e = eb - ea;
        c.shift[1] = dot(e, c.t1);
        c.shift[2] = dot(e, cross(c.n, c.t1));
    }
}

// `fixed_a` (A is not moved by constraints) and k.moved are the same for all rows of a loop: branches cost nothing
// here, copies of the kernel would only take longer to build.
template <int W, int P, Pass pass>
LENDULET_FORCE_INLINE void contact_pass(ContactRow<W, P>& c, const BodyArrays& bodies, const SubstepConstants& k,
                                        bool fixed_a) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    BodyState* states = bodies.state;
    WideVelocity<F> A = load_velocity<W>(states, c.a), B = load_velocity<W>(states, c.b);
    SymMat3T<F> IA{}, IB = load_inverse_inertia<W>(bodies.inertia, c.b);
    if (!fixed_a) IA = load_inverse_inertia<W>(bodies.inertia, c.a);
    WideVelocity<F> A0 = load_start<W>(bodies.start, c.a), B0 = load_start<W>(bodies.start, c.b);
    if (pass == Pass::relax || (pass == Pass::solve && k.moved)) update_displacement<W, P>(c, states);

    Vec3T<F> t2 = cross(c.n, c.t1);
    Vec3T<F> ra = c.ra + c.follow * c.moved, rb = c.rb - (one - c.follow) * c.moved;
    Vec3T<F> aA = cross(ra, c.n), aB = cross(rb, c.n);
    F change[P];
    if constexpr (pass == Pass::warm_start) {
        for (int j = 0; j < P; ++j) change[j] = c.p[j].impulse;
    } else {
        constexpr bool biased = pass != Pass::relax;
        F inverse_h = splat<F>(k.inverse_h), keep = splat<F>(biased ? 1.0f - k.leak : 1.0f);
        F rate = splat<F>(biased ? k.bias_rate : 0.0f), push = zero - c.push_speed;
        F bounce = splat<F>(k.bounce_speed) * c.bounce_speed;
        Vec3T<F> wa = A0.w + A.w, wb = B0.w + B.w, spin = wb - wa;
        F g0 = dot(c.n, (B0.v - A0.v) + (B.v - A.v)) + (dot(aB, wb) - dot(aA, wa));
        F g1 = zero - dot(spin, t2), g2 = dot(spin, c.t1);
        for (int j = 0; j < P; ++j) {
            auto& p = c.p[j];
            F s = p.separation + c.shift[0];
            F vn = g0;
            if constexpr (P > 1) {
                s = s + p.u * c.shift[1] + p.v * c.shift[2];
                vn = vn + (p.u * g1 + p.v * g2);
            }
            auto apart = s > zero;
            F bias = select(apart, s * inverse_h, maximum(rate * s, push));
            F kept = select(apart, one, keep) * p.impulse;
            for (int i = 0; i < j; ++i) vn = vn + c.coupling[j * (j - 1) / 2 + i] * change[i];
            F next = maximum(kept - p.mass * (vn + bias), zero);
            next = select(vn < bounce, zero, next);  // left to the impact stage, which knows the time of impact
            change[j] = next - p.impulse;
            p.impulse = next;
        }
    }
    F total = change[0];
    Vec3T<F> turn = zero_vector<F>();
    if constexpr (P > 1) {
        F moment1 = change[0] * c.p[0].u, moment2 = change[0] * c.p[0].v;
        for (int j = 1; j < P; ++j) {
            total = total + change[j];
            moment1 = moment1 + change[j] * c.p[j].u;
            moment2 = moment2 + change[j] * c.p[j].v;
        }
        turn = moment2 * c.t1 - moment1 * t2;
    }
    Vec3T<F> push = total * c.n;
    B.v = B.v + B.inverse_mass * push;
    B.w = B.w + IB * (total * aB + turn);
    A.v = A.v - A.inverse_mass * push;
    A.w = A.w - IA * (total * aA + turn);
    if constexpr (pass == Pass::relax || pass == Pass::warm_start) {
        Vec3T<F> linear, angular;
        if constexpr (pass == Pass::relax) {
            Vec3T<F> wa = A0.w + A.w, wb = B0.w + B.w;
            Vec3T<F> slip = ((B0.v - A0.v) + (B.v - A.v)) + (cross(wb, rb) - cross(wa, ra));
            solve_friction<W, P>(c, t2, slip, dot(c.n, wb - wa), linear, angular);
        } else {
            linear = c.tangent[0] * c.t1 + c.tangent[1] * t2;
            angular = c.twist * c.n;
        }
        B.v = B.v + B.inverse_mass * linear;
        B.w = B.w + IB * (cross(rb, linear) + angular);
        A.v = A.v - A.inverse_mass * linear;
        A.w = A.w - IA * (cross(ra, linear) + angular);
    }
    store_velocity<W>(states, c.b, B);
    if (!fixed_a) store_velocity<W>(states, c.a, A);
}

template <int W, int P, Pass pass>
void run_pass(const ContactGroup& g, SolverBodies& bodies, const SubstepConstants& k, int begin, int end) {
    auto* rows = reinterpret_cast<ContactRow<W, P>*>(g.rows);
    const BodyArrays arrays{bodies.state.data(), bodies.inertia.data(), bodies.start.data()};
    for (int i = begin; i < end; ++i) contact_pass<W, P, pass>(rows[i], arrays, k, g.fixed_a);
}

// --- and back

template <int W, int P>
void store_rows(const ContactGroup& g, ContactRecord* records, int begin, int end) {
    using F = Wide<float, W>;
    auto* rows = reinterpret_cast<const ContactRow<W, P>*>(g.rows);
    for (int i = begin; i < end; ++i) {
        const ContactRow<W, P>& c = rows[i];
        Vec3T<F> t2 = cross(c.n, c.t1), f = c.tangent[0] * c.t1 + c.tangent[1] * t2;
        int live = g.count - i * W < W ? g.count - i * W : W;
        for (int l = 0; l < live; ++l) {
            ContactRecord& r = records[g.order[i * W + l]];
            for (int j = 0; j < P; ++j) {
                r.normal_impulse[j] = lane(c.p[j].impulse, l);
                float s = lane(c.p[j].separation, l);
                if (s < 0.1f * far_separation)
                    s += lane(c.shift[0], l) + lane(c.p[j].u, l) * lane(c.shift[1], l) +
                         lane(c.p[j].v, l) * lane(c.shift[2], l);
                r.points[j].separation = s;
            }
            r.friction_impulse[0] = lane(f.x, l);
            r.friction_impulse[1] = lane(f.y, l);
            r.friction_impulse[2] = lane(f.z, l);
            r.twist_impulse = lane(c.twist, l);
        }
    }
}
