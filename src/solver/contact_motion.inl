// How contact rows follow their bodies within a step. Part of kernels.inl, after contact_rows.inl.

// Arms of the centre where B has moved by so much against A: the point rides on one of the bodies, or on both.
template <class F>
struct Arms {
    Vec3T<F> ra, rb;
};
template <int W, int P>
LENDULET_FORCE_INLINE Arms<Wide<float, W>> arms_after(const ContactRow<W, P>& c, Vec3T<Wide<float, W>> moved) {
    return {c.ra + c.follow * moved, c.rb - (splat<Wide<float, W>>(1.0f) - c.follow) * moved};
}

// Arms of the centre now, and the relative velocity there that was left from the start of the step.
template <class F>
struct MovedArms {
    Vec3T<F> ra, rb, start_slip;
    F turned;  // square of the sine of half the angle by which one of the bodies has turned, at least
    F swung;   // above 0 where an arm has grown by far_swing
};

// Square of how far an arm may grow, see MovedArms::swung. Deep within each other balls have arms of no length.
template <class F>
LENDULET_FORCE_INLINE F far_arm2(Vec3T<F> arm, F radius) {
    return splat<F>(far_swing) * maximum(dot(arm, arm), radius * radius);
}

// Separations, levers and arms from the two bodies' displacements since the start of the step.
template <int W, int P>
LENDULET_FORCE_INLINE MovedArms<Wide<float, W>> update_displacement(ContactRow<W, P>& c, const BodyState* states,
                                                                    Vec3T<Wide<float, W>> t2) {
    using F = Wide<float, W>;
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement_at<W>(states, c.a, dpa, dqa);
    load_displacement_at<W>(states, c.b, dpb, dqb);
    Vec3T<F> moved = dpb - dpa, ea = turned_back(dqa, c.n), eb = turned_back(dqb, c.n);
    c.shift = dot(c.n, moved) + dot(eb, c.rb + c.radius_b * c.n) - dot(ea, c.ra - c.radius_a * c.n);
    if constexpr (P > 1) {
        Vec3T<F> e = eb - ea;
        c.turn.shift[0] = dot(e, c.t1);
        c.turn.shift[1] = dot(e, t2);
    }
    const Arms<F> arms = arms_after(c, moved);
    const F way = dot(moved, moved), left = splat<F>(1.0f) - c.follow;
    MovedArms<F> now{
        arms.ra, arms.rb, c.start_slip - cross(c.start_turn, moved),
        maximum(dqa.x * dqa.x + dqa.y * dqa.y + dqa.z * dqa.z, dqb.x * dqb.x + dqb.y * dqb.y + dqb.z * dqb.z),
        maximum((c.follow * c.follow) * way - far_arm2(c.ra, c.radius_a),
                (left * left) * way - far_arm2(c.rb, c.radius_b))};
    c.lever_a = cross(now.ra, c.n);
    c.lever_b = cross(now.rb, c.n);
    c.start_approach = dot(c.n, now.start_slip);
    return now;
}

// All that the row holds, on B: what acts at the centre, and beside it the couple of normals off the centre and of the
// twist.
template <int W, int P>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> held_impulse(const ContactRow<W, P>& c, Vec3T<Wide<float, W>> t2) {
    Wide<float, W> pressed = c.p[0].impulse;
    for (int j = 1; j < P; ++j) pressed = pressed + c.p[j].impulse;
    return pressed * c.n + (c.friction.tangent[0] * c.t1 + c.friction.tangent[1] * t2);
}
template <int W, int P>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> held_couple(const ContactRow<W, P>& c, Vec3T<Wide<float, W>> t2) {
    using F = Wide<float, W>;
    if constexpr (P == 1) return zero_vector<F>();
    else {
        F m1 = splat<F>(0.0f), m2 = m1;
        for (int j = 0; j < P; ++j) m1 = m1 + c.p[j].impulse * c.p[j].u, m2 = m2 + c.p[j].impulse * c.p[j].v;
        return (m2 * c.t1 - m1 * t2) + c.friction.twist * c.n;
    }
}

// Puts a row where its manifold is now that both bodies have turned: the normal turns with the body that owns the face,
// the points with the one that owns the corners. All is taken from the start of the step; where there is a load the
// centre lies in its plane, see RowPlace. Returns the centre's arms, no other motion.
template <int W, int P>
LENDULET_FORCE_INLINE Arms<Wide<float, W>> place_turned(ContactRow<W, P>& c, const RowPlace<W, P>& start,
                                                        const BodyState* states) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement_at<W>(states, c.a, dpa, dqa);
    load_displacement_at<W>(states, c.b, dpb, dqb);
    auto on_b = c.follow > splat<F>(0.5f);  // the corners
    const QuatT<F> face{select(on_b, dqa.x, dqb.x), select(on_b, dqa.y, dqb.y), select(on_b, dqa.z, dqb.z),
                        select(on_b, dqa.w, dqb.w)};
    const QuatT<F> corner{select(on_b, dqb.x, dqa.x), select(on_b, dqb.y, dqa.y), select(on_b, dqb.z, dqa.z),
                          select(on_b, dqb.w, dqa.w)};
    c.n = rotate(face, start.n);
    c.t1 = rotate(face, start.t1);
    const Vec3T<F> between = (start.ra - start.rb) + (dpb - dpa);
    Vec3T<F> arm = rotate(corner, select(on_b, start.rb, start.ra));
    Vec3T<F> ra = select(on_b, arm + between, arm), rb = ra - between;
    const F shift = select(on_b, dot(c.n, ra) - dot(start.n, start.ra), dot(start.n, start.rb) - dot(c.n, rb));
    c.shift = zero;
    if constexpr (P == 1) {
        c.p[0].separation = start.separation[0] + shift;
    } else {
        c.turn.shift[0] = c.turn.shift[1] = zero;
        const Vec3T<F> t2 = cross(c.n, c.t1), d1 = rotate(corner, start.t1),
                       d2 = rotate(corner, cross(start.n, start.t1));
        const F side = select(on_b, one, zero - one), slope1 = side * dot(c.n, d1), slope2 = side * dot(c.n, d2);
        const F u1 = dot(c.t1, d1), u2 = dot(c.t1, d2), v1 = dot(t2, d1), v2 = dot(t2, d2);
        F least = splat<F>(far_separation);
        for (int j = 0; j < P; ++j) {
            const F u = start.u[j], v = start.v[j];
            c.p[j].u = u1 * u + u2 * v;
            c.p[j].v = v1 * u + v2 * v;
            auto there = start.separation[j] < splat<F>(0.1f * far_separation);
            c.p[j].separation = start.separation[j] + select(there, shift + (slope1 * u + slope2 * v), zero);
            least = minimum(least, c.p[j].separation);
        }
        const Vec3T<F> down = (side * (least - (start.least + shift))) * c.n;
        ra = ra + down;
        rb = rb + down;
    }
    return {ra, rb};
}

// The same for two balls, whose normal is the line between their centres.
template <int W>
LENDULET_FORCE_INLINE Arms<Wide<float, W>> place_balls(ContactRow<W, 1>& c, const RowPlace<W, 1>& start,
                                                       const BodyState* states) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), s = start.separation[0], radii = c.radius_a + c.radius_b;
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement_at<W>(states, c.a, dpa, dqa);
    load_displacement_at<W>(states, c.b, dpb, dqb);
    const Vec3T<F> between = (start.ra - start.rb) + (dpb - dpa);
    const Vec3T<F> centre_a = rotate(dqa, start.ra - (c.radius_a + c.follow * s) * start.n);
    const Vec3T<F> centre_b = rotate(dqb, start.rb + (c.radius_b + (one - c.follow) * s) * start.n);
    const Vec3T<F> way = (between + centre_b) - centre_a;
    const F distance = square_root(dot(way, way));
    auto known = distance > splat<F>(0.01f) * radii;
    c.n = select(known, (one / maximum(distance, splat<F>(1e-30f))) * way, c.n);
    const Vec3T<F> t =
        cross(c.n, select(absolute(c.n.x) > splat<F>(0.5f), Vec3T<F>{splat<F>(0.0f), one, splat<F>(0.0f)},
                          Vec3T<F>{one, splat<F>(0.0f), splat<F>(0.0f)}));
    c.t1 = (one / square_root(dot(t, t))) * t;
    c.shift = splat<F>(0.0f);
    c.p[0].separation = distance - radii;
    const Vec3T<F> ra = centre_a + (c.radius_a + c.follow * c.p[0].separation) * c.n;
    return {ra, ra - between};
}

// Puts lanes of balls among those of others. What they hold stays the same impulse, told by the new normal; it does not
// pull.
template <int W>
LENDULET_FORCE_INLINE Arms<Wide<float, W>> select_balls(Wide<float, W> balls, ContactRow<W, 1>& renewed,
                                                        const Arms<Wide<float, W>>& arms, const ContactRow<W, 1>& c,
                                                        const RowPlace<W, 1>& start, Vec3T<Wide<float, W>> held,
                                                        const BodyState* states) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f);
    auto are = balls > zero;
    ContactRow<W, 1> b = c;
    const Arms<F> of_balls = place_balls<W>(b, start, states);
    const Vec3T<F> t2 = cross(b.n, b.t1);
    renewed.n = select(are, b.n, renewed.n);
    renewed.t1 = select(are, b.t1, renewed.t1);
    renewed.shift = select(are, b.shift, renewed.shift);
    renewed.p[0].separation = select(are, b.p[0].separation, renewed.p[0].separation);
    renewed.p[0].impulse = select(are, maximum(dot(held, b.n), zero), renewed.p[0].impulse);
    renewed.friction.tangent[0] = select(are, dot(held, b.t1), renewed.friction.tangent[0]);
    renewed.friction.tangent[1] = select(are, dot(held, t2), renewed.friction.tangent[1]);
    return {select(are, of_balls.ra, arms.ra), select(are, of_balls.rb, arms.rb)};
}

// A row does not begin to turn where a body turns by more than this in a substep, in squares of the sine of half the
// angle: 1/8 rad, one radian in an ordinary step. Which corner meets what is then another question in every substep,
// and loads that turn so fast would drive the bodies.
constexpr float fastest_turn = 0.0625f * 0.0625f;

// 1 in the lanes that carry something, or will within two substeps if they go on as they have so far.
template <int W, int P>
LENDULET_FORCE_INLINE Wide<float, W> near_lanes(const ContactRow<W, P>& c, const SubstepConstants& k) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), ahead = splat<F>(1.0f + 2.0f / k.substeps_so_far);
    F near = zero;
    for (int j = 0; j < P; ++j) {
        F moved = c.shift;
        if constexpr (P > 1) moved = moved + (c.p[j].u * c.turn.shift[0] + c.p[j].v * c.turn.shift[1]);
        near = select(c.p[j].impulse > zero, one, near);
        near = select(c.p[j].separation + ahead * moved <= zero, one, near);
    }
    return near;
}

// 1 in the lanes that turn with their bodies: corners above a face, where `near`; and those that have turned before.
template <int W, int P>
LENDULET_FORCE_INLINE Wide<float, W> turning_lanes(const ContactRow<W, P>& c, Wide<float, W> near,
                                                   Wide<float, W> turned, const SubstepConstants& k) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    const F fastest = splat<F>(fastest_turn * k.substeps_so_far * k.substeps_so_far);
    near = select((turned > c.turn_limit) & (turned < fastest), near, zero);
    near = select(c.turn_limit < zero, one, near);
    near = select(c.turn_limit < splat<F>(0.5f * following_balls), zero, near);
    return select(c.turn_limit < splat<F>(far_turn), near, zero);
}

// 1 in the lanes of two balls that have gone by some of their size, where `near`; and those that have followed before.
template <int W, int P>
LENDULET_FORCE_INLINE Wide<float, W> following_lanes(const ContactRow<W, P>& c, Wide<float, W> near,
                                                     Wide<float, W> swung) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    near = select((c.turn_limit > splat<F>(far_turn)) & (c.turn_limit <= splat<F>(never)), near, zero);
    near = select(swung > zero, near, zero);
    return select(c.turn_limit < splat<F>(0.5f * following_balls), one, near);
}

// Where lanes turn, the row takes over what it is in its new place; in the others that place is the row's.
template <int W, int P>
LENDULET_FORCE_INLINE void take_over(ContactRow<W, P>& c, ContactRow<W, P>& renewed, Wide<float, W> turns,
                                     Wide<float, W> balls) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    auto turned = turns > zero;
    c.n = select(turned, renewed.n, c.n);
    c.t1 = select(turned, renewed.t1, c.t1);
    c.turn_limit = select(turned, select(balls > zero, splat<F>(following_balls), zero - one), c.turn_limit);
    if constexpr (P == 1) {
        c.p[0].impulse = select(turned, renewed.p[0].impulse, c.p[0].impulse);
        for (int i = 0; i < 2; ++i)
            c.friction.tangent[i] = select(turned, renewed.friction.tangent[i], c.friction.tangent[i]);
    }
    c.shift = select(turned, renewed.shift, c.shift);
    for (int j = 0; j < P; ++j) {
        c.p[j].separation = select(turned, renewed.p[j].separation, c.p[j].separation);
        if constexpr (P > 1) {
            c.p[j].u = select(turned, renewed.p[j].u, c.p[j].u);
            c.p[j].v = select(turned, renewed.p[j].v, c.p[j].v);
        }
    }
    if constexpr (P > 1)
        for (F& x : c.turn.shift) x = select(turned, zero, x);
    renewed.n = c.n, renewed.t1 = c.t1;
    if constexpr (P > 1)
        for (int j = 0; j < P; ++j) renewed.p[j].u = c.p[j].u, renewed.p[j].v = c.p[j].v;
}

// Rows whose bodies have turned far since the start of the step; few ever come here, so bodies and manifolds are
// fetched anew.
//
// Manifolds turn with their bodies, and what they hold with them: the bodies get the difference at once, between them,
// so that momenta stay. What is missing since the centre's arms have followed the drift is overdue all the same.
//
// All rows get new masses. A slender body that has turned answers many times as much to an impulse, and rows that take
// it for what it was at the start of the step would answer ever more to what they did themselves: from twice on they
// gain energy without end.
template <int W, int P>
[[gnu::noinline]] MovedArms<Wide<float, W>> turn_row(ContactRow<W, P>& c, MovedArms<Wide<float, W>> now,
                                                     const BodyArrays& bodies, const SubstepConstants& k,
                                                     const ContactGroup& g, int first) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    const F near = near_lanes<W, P>(c, k), corners = turning_lanes<W, P>(c, near, now.turned, k);
    F balls = zero;
    if constexpr (P == 1) balls = following_lanes<W, P>(c, near, now.swung);
    const F turns = maximum(corners, balls);
    const F renews =
        select(maximum(now.turned - maximum(c.turn_limit, splat<F>(far_turn)), now.swung) > zero, one, turns);
    auto turned = turns > zero, far = renews > zero;
    if (!mask_bits(far)) return now;
    RecordQuads<W> record{floats_of(g.records), {}};
    for (int l = 0; l < W; ++l)
        record.index[l] = static_cast<int32_t>(g.order[first + l < g.count ? first + l : first]);
    WideVelocity<F> A{}, B = load_velocity_at<W>(bodies.state, c.b);
    SymMat3T<F> IA{}, IB = load_inverse_inertia_at<W>(bodies.inertia, c.b);
    if (!g.fixed_a) {
        A = load_velocity_at<W>(bodies.state, c.a);
        IA = load_inverse_inertia_at<W>(bodies.inertia, c.a);
    }
    ContactRow<W, P> renewed = c;
    if (mask_bits(turned)) {
        const RowPlace<W, P> start(ManifoldQuads<W, P>{record});
        const Vec3T<F> t2 = cross(c.n, c.t1), held = held_impulse<W, P>(c, t2);
        Arms<F> arms{now.ra, now.rb};
        if (mask_bits(corners > zero)) arms = place_turned<W, P>(renewed, start, bodies.state);
        if constexpr (P == 1) {
            if (mask_bits(balls > zero)) arms = select_balls<W>(balls, renewed, arms, c, start, held, bodies.state);
        }
        const Vec3T<F> gone = select(turned, arms.ra - now.ra, zero_vector<F>());
        const Vec3T<F> new_t2 = cross(renewed.n, renewed.t1);
        const Vec3T<F> linear = select(turned, held_impulse<W, P>(renewed, new_t2) - held, zero_vector<F>());
        const Vec3T<F> couple =
            select(turned, held_couple<W, P>(renewed, new_t2) - held_couple<W, P>(c, t2), zero_vector<F>()) +
            cross(gone, held);
        now.ra = now.ra + gone;
        now.rb = now.rb + gone;
        B.v = B.v + B.inverse_mass * linear;
        B.w = B.w + IB * (cross(now.rb, linear) + couple);
        store_velocity_at<W>(bodies.state, c.b, B);
        if (!g.fixed_a) {
            A.v = A.v - A.inverse_mass * linear;
            A.w = A.w - IA * (cross(now.ra, linear) + couple);
            store_velocity_at<W>(bodies.state, c.a, A);
        }
        const WideVelocity<F> A0 = load_start_at<W>(bodies.start, c.a), B0 = load_start_at<W>(bodies.start, c.b);
        Vec3T<F> slip = (B0.v - A0.v) + (cross(B0.w, now.rb) - cross(A0.w, now.ra));
        if (g.rolling) {
            const Vec3T<F> running = reinterpret_cast<const RollingRow<W>*>(g.rolling)[first / W].running;
            slip = slip + (running - dot(running, renewed.n) * renewed.n);
        }
        now.start_slip = select(turned, slip, now.start_slip);
        take_over<W, P>(c, renewed, turns, balls);
        c.ra = c.ra + gone;
        c.rb = c.rb + gone;
        c.lever_a = cross(now.ra, c.n);
        c.lever_b = cross(now.rb, c.n);
        c.start_approach = dot(c.n, now.start_slip);
    }
    prepare_normals<W, P>(renewed, now.ra, now.rb, IA, IB, A.inverse_mass + B.inverse_mass);
    prepare_friction<W, P>(renewed, now.ra, now.rb, IA, IB, A.inverse_mass + B.inverse_mass);
    for (int j = 0; j < P; ++j) c.p[j].mass = select(far, renewed.p[j].mass, c.p[j].mass);
    if constexpr (P > 1)
        for (int i = 0; i < P * (P - 1) / 2; ++i)
            c.turn.coupling[i] = select(far, renewed.turn.coupling[i], c.turn.coupling[i]);
    constexpr int masses = sizeof(c.friction.mass) / sizeof(c.friction.mass[0]);
    for (int i = 0; i < masses; ++i) c.friction.mass[i] = select(far, renewed.friction.mass[i], c.friction.mass[i]);
    return now;
}

// Brings a row to where its bodies are, and A and B with it.
template <int W, int P>
LENDULET_FORCE_INLINE MovedArms<Wide<float, W>> follow_bodies(ContactRow<W, P>& c, const BodyArrays& bodies,
                                                              const SubstepConstants& k, const ContactGroup& g,
                                                              int first, Vec3T<Wide<float, W>>& t2,
                                                              WideVelocity<Wide<float, W>>& A,
                                                              WideVelocity<Wide<float, W>>& B) {
    MovedArms<Wide<float, W>> now = update_displacement<W, P>(c, bodies.state, t2);
    if (mask_bits(maximum(now.turned - c.turn_limit, now.swung) > splat<Wide<float, W>>(0.0f))) {
        now = turn_row<W, P>(c, now, bodies, k, g, first);
        t2 = cross(c.n, c.t1);
        B = load_velocity_at<W>(bodies.state, c.b);
        if (!g.fixed_a) A = load_velocity_at<W>(bodies.state, c.a);
    }
    return now;
}
