// What passes do with contact rows: normals and friction. Part of kernels.inl, after contact_motion.inl.

enum class Pass { warm_start, solve, relax };

// Less than the sum of the points' impulses times their distances from the centre.
template <int W, int P>
LENDULET_FORCE_INLINE Wide<float, W> least_lever(const ContactRow<W, P>& c) {
    using F = Wide<float, W>;
    F sum = splat<F>(0.0f);
    for (int j = 0; j < P; ++j) sum = sum + c.p[j].impulse * maximum(absolute(c.p[j].u), absolute(c.p[j].v));
    return splat<F>(0.999f) * sum;
}

// x with M x = f by factors L D L^T; `m`: 11 12 13 22 23 33 of M. Zero where M has no inverse.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> solve_symmetric(const F m[6], Vec3T<F> f) {
    const F d1 = inverse_or_zero(m[0]), l21 = d1 * m[1], l31 = d1 * m[2], e23 = m[4] - l21 * m[2];
    const F d2 = inverse_or_zero(m[3] - l21 * m[1]), l32 = d2 * e23;
    const F z2 = f.y - l21 * f.x, z3 = f.z - l31 * f.x - l32 * z2;
    const F x3 = inverse_or_zero(m[5] - l31 * m[2] - l32 * e23) * z3;
    const F x2 = d2 * z2 - l32 * x3;
    return {d1 * f.x - l21 * x2 - l31 * x3, x2, x3};
}

// What a patch drags that slides, spins or does both: Coulomb's law at every point, each with its share of the load
// against its own way, so that the patch holds less by force where it spins and less by torque where it slides.
// `stop`: the impulse (t1, t2, twist) that stops all motion; `spare`: what of it would be beyond the limits of slip and
// of spin, each as if it were alone. With q the motion that is left, turned round, and p_j = J_j q the way of a point
// of it,
//
//     M q + mu sum of lambda_j J_j^T p_j / |p_j| = stop.
//
// One step of iterated weights, with |p_j| of the motion that `spare` would stop, makes that linear and implicit: what
// would overshoot comes to rest, and slow slip of what spins fast meets a force in proportion to it. No point gives
// more than mu lambda_j.
template <int W, int P>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> drag_of_points(const ContactRow<W, P>& c, Vec3T<Wide<float, W>> stop,
                                                           Vec3T<Wide<float, W>> spare) {
    using F = Wide<float, W>;
    const F mu = c.dynamic_friction, zero = splat<F>(0.0f), one = splat<F>(1.0f), least = splat<F>(1e-20f);
    const Vec3T<F> left = solve_symmetric(c.friction.mass, spare);
    F slowness[P], most = zero;
    for (int j = 0; j < P; ++j) {
        const F x = left.x - left.z * c.p[j].v, y = left.y + left.z * c.p[j].u;
        slowness[j] = x * x + y * y;
        most = maximum(most, select(c.p[j].impulse > zero, slowness[j], zero));
    }
    // A point about which the patch turns would be a weight without end. Points that carry nothing have no say.
    most = maximum(splat<F>(1e-6f) * most, least);
    F m[6];
    for (int i = 0; i < 6; ++i) m[i] = c.friction.mass[i];
    for (int j = 0; j < P; ++j) {
        slowness[j] = one / square_root(maximum(slowness[j], most));
        const F u = c.p[j].u, v = c.p[j].v, weight = mu * c.p[j].impulse * slowness[j];
        m[0] = m[0] + weight;
        m[2] = m[2] - weight * v;
        m[3] = m[3] + weight;
        m[4] = m[4] + weight * u;
        m[5] = m[5] + weight * (u * u + v * v);
    }
    const Vec3T<F> q = solve_symmetric(m, stop);
    Vec3T<F> sum = zero_vector<F>();
    for (int j = 0; j < P; ++j) {
        const F x = q.x - q.z * c.p[j].v, y = q.y + q.z * c.p[j].u;
        const F share = mu * c.p[j].impulse * minimum(slowness[j], one / square_root(maximum(x * x + y * y, least)));
        sum = sum + Vec3T<F>{share * x, share * y, share * (c.p[j].u * y - c.p[j].v * x)};
    }
    return sum;
}

// Friction of the whole patch as one block (t1, t2, twist): it sticks while the impulses that stop the slip and the
// spin are within their static limits, that of the slip a round cone on the total normal impulse, and otherwise moves
// with the dynamic coefficient (thesis 3.3.4 with THESIS-NOTES). Returns the impulse on B and the angular impulse about
// n.
template <int W, int P>
LENDULET_FORCE_INLINE void solve_friction(ContactRow<W, P>& c, Vec3T<Wide<float, W>> t2, Vec3T<Wide<float, W>> slip,
                                          Vec3T<Wide<float, W>> spin, Vec3T<Wide<float, W>>& linear,
                                          Vec3T<Wide<float, W>>& angular) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F total = c.p[0].impulse, twist = zero;
    F x = dot(slip, c.t1), y = dot(slip, t2), f1, f2, ft = zero;
    const F* m = c.friction.mass;
    if constexpr (P > 1) {
        for (int j = 1; j < P; ++j) total = total + c.p[j].impulse;
        twist = dot(c.n, spin);
        f1 = c.friction.tangent[0] - (m[0] * x + m[1] * y + m[2] * twist);
        f2 = c.friction.tangent[1] - (m[1] * x + m[3] * y + m[4] * twist);
        ft = c.friction.twist - (m[2] * x + m[4] * y + m[5] * twist);
    } else {
        f1 = c.friction.tangent[0] - (m[0] * x + m[1] * y);
        f2 = c.friction.tangent[1] - (m[1] * x + m[2] * y);
    }
    // Roots are dear, and most rows do without: they stick, or carry nothing.
    F sticking = c.static_friction * total, sliding = c.dynamic_friction * total;
    F size2 = f1 * f1 + f2 * f2;
    auto slides = size2 > sticking * sticking;
    F held1, held2, held = zero;
    if constexpr (P > 1) {
        const F size = absolute(ft);
        F hold = least_lever<W, P>(c) * c.static_friction;
        // Without load nothing sticks, also where the square of what slides is too small a number.
        F moves = select(slides, total, select(size > hold, total, zero));
        F kept = total;
        Vec3T<F> drag = zero_vector<F>();
        if (mask_bits(moves > zero)) {
            F lever = zero;
            for (int j = 0; j < P; ++j)
                lever = lever + c.p[j].impulse * square_root(c.p[j].u * c.p[j].u + c.p[j].v * c.p[j].v);
            hold = c.static_friction * lever;
            kept = select(slides, zero, select(size > hold, zero, total));
            const F tangential[3] = {m[0], m[1], m[3]};
            F cut1 = f1, cut2 = f2;
            cut_to_limit(cut1, cut2, tangential, square_root(size2), sliding);
            const F d = inverse_or_zero(m[0] * m[3] - m[1] * m[1]);
            const F left1 = select(slides, f1 - cut1, zero), left2 = select(slides, f2 - cut2, zero);
            // The twist that stops with the slip that is left, instead of without any.
            const F along1 = d * (m[3] * m[2] - m[1] * m[4]), along2 = d * (m[0] * m[4] - m[1] * m[2]);
            const F spare = ft - (along1 * left1 + along2 * left2), most = c.dynamic_friction * lever;
            drag =
                drag_of_points<W, P>(c, {f1, f2, ft}, {left1, left2, ft - maximum(minimum(spare, most), zero - most)});
        }
        const auto keeps = kept > zero, drags = moves > zero;
        held1 = select(keeps, f1, select(drags, drag.x, zero));
        held2 = select(keeps, f2, select(drags, drag.y, zero));
        held = select(keeps, ft, select(drags, drag.z, zero));
    } else {
        auto keeps = select(slides, zero, select(total > zero, one, zero)) > zero;
        auto drags = select(slides, sliding, zero) > zero;
        held1 = select(keeps, f1, zero), held2 = select(keeps, f2, zero);
        if (mask_bits(drags)) {
            F cut1 = f1, cut2 = f2;
            cut_to_limit(cut1, cut2, m, square_root(size2), sliding);
            held1 = select(drags, cut1, held1);
            held2 = select(drags, cut2, held2);
        }
    }
    linear = (held1 - c.friction.tangent[0]) * c.t1 + (held2 - c.friction.tangent[1]) * t2;
    c.friction.tangent[0] = held1;
    c.friction.tangent[1] = held2;
    angular = zero_vector<F>();
    if constexpr (P > 1) {
        angular = (held - c.friction.twist) * c.n;
        c.friction.twist = held;
    }
}

// One sweep over the points; returns what it added to the impulses: `biased` with the terms that undo overlap.
template <int W, int P, bool biased>
LENDULET_FORCE_INLINE void sweep_normals(ContactRow<W, P>& c, const WideVelocity<Wide<float, W>>& A,
                                         const WideVelocity<Wide<float, W>>& B, Vec3T<Wide<float, W>> t2,
                                         const SubstepConstants& k, Wide<float, W> change[P]) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F inverse_h = splat<F>(k.inverse_h), keep = splat<F>(biased ? 1.0f - k.leak : 1.0f);
    F rate = splat<F>(biased ? k.bias_rate : 0.0f), push = zero - c.push_speed;
    F bounce = splat<F>(k.bounce_speed) * c.bounce_speed;
    F g0 = (c.start_approach + dot(c.n, B.v - A.v)) + (dot(c.lever_b, B.w) - dot(c.lever_a, A.w));
    F g1 = zero, g2 = zero;
    if constexpr (P > 1) {
        Vec3T<F> spin = c.turn.start_spin + (B.w - A.w);
        g1 = zero - dot(spin, t2), g2 = dot(spin, c.t1);
    }
    for (int j = 0; j < P; ++j) {
        auto& p = c.p[j];
        F s = p.separation + c.shift, vn = g0;
        if constexpr (P > 1) {
            s = s + (p.u * c.turn.shift[0] + p.v * c.turn.shift[1]);
            vn = vn + (p.u * g1 + p.v * g2);
            for (int i = 0; i < j; ++i) vn = vn + c.turn.coupling[j * (j - 1) / 2 + i] * change[i];
        }
        auto apart = s > zero;
        F kept = p.impulse, bias;
        if constexpr (biased) {
            bias = select(apart, s * inverse_h, maximum(rate * s, push));
            kept = select(apart, one, keep) * kept;
        } else {
            bias = select(apart, s * inverse_h, zero);
        }
        F next = maximum((kept - p.mass * bias) - p.mass * vn, zero);
        // What carries nothing yet is left to the impact stage, which knows the time of impact.
        next = select((vn < bounce) & (p.impulse <= zero), zero, next);
        change[j] = next - p.impulse;
        p.impulse = next;
    }
}

// Adds impulses of the points along n to the bodies, and what is overdue.
template <int W, int P, bool overdue>
LENDULET_FORCE_INLINE void apply_normals(const ContactRow<W, P>& c, WideVelocity<Wide<float, W>>& A,
                                         WideVelocity<Wide<float, W>>& B, const SymMat3T<Wide<float, W>>& IA,
                                         const SymMat3T<Wide<float, W>>& IB, Vec3T<Wide<float, W>> t2,
                                         const Wide<float, W> change[P]) {
    using F = Wide<float, W>;
    F total = change[0];
    Vec3T<F> turn_a, turn_b;
    if constexpr (P > 1) {
        F moment1 = change[0] * c.p[0].u, moment2 = change[0] * c.p[0].v;
        for (int j = 1; j < P; ++j) {
            total = total + change[j];
            moment1 = moment1 + change[j] * c.p[j].u;
            moment2 = moment2 + change[j] * c.p[j].v;
        }
        Vec3T<F> turn = moment2 * c.t1 - moment1 * t2;
        turn_a = total * c.lever_a + turn;
        turn_b = total * c.lever_b + turn;
    } else {
        turn_a = total * c.lever_a;
        turn_b = total * c.lever_b;
    }
    if constexpr (overdue) {
        Vec3T<F> share = c.follow * c.overdue;
        turn_a = turn_a - share;
        turn_b = turn_b + (c.overdue - share);
    }
    Vec3T<F> push = total * c.n;
    B.v = B.v + B.inverse_mass * push;
    B.w = B.w + IB * turn_b;
    A.v = A.v - A.inverse_mass * push;
    A.w = A.w - IA * turn_a;
}

// What a contact holds is repeated from one substep to the next, also the blow by which a body was stopped. Where most
// of it is given back at once, the friction that came with it is too, before the bodies move: else they would turn and
// slide by it for a substep. Few rows come here, so the bodies are fetched anew. `share`: what is left of it, less 1.
template <int W, int P>
[[gnu::noinline]] void let_go_of_friction(ContactRow<W, P>& c, const BodyArrays& bodies, bool fixed_a,
                                          Wide<float, W> share) {
    using F = Wide<float, W>;
    WideVelocity<F> A = load_velocity_at<W>(bodies.state, c.a), B = load_velocity_at<W>(bodies.state, c.b);
    const SymMat3T<F> IA = load_inverse_inertia_at<W>(bodies.inertia, c.a),
                      IB = load_inverse_inertia_at<W>(bodies.inertia, c.b);
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement_at<W>(bodies.state, c.a, dpa, dqa);
    load_displacement_at<W>(bodies.state, c.b, dpb, dqb);
    const Vec3T<F> moved = dpb - dpa;
    const Arms<F> arms = arms_after(c, moved);
    // One that has gone on by more than its arm is long past what it struck: relax passes take from it as they may.
    share = select(dot(moved, moved) <= dot(c.rb, c.rb), share, splat<F>(0.0f));
    F f1 = share * c.friction.tangent[0], f2 = share * c.friction.tangent[1];
    c.friction.tangent[0] = c.friction.tangent[0] + f1;
    c.friction.tangent[1] = c.friction.tangent[1] + f2;
    Vec3T<F> linear = f1 * c.t1 + f2 * cross(c.n, c.t1), angular = zero_vector<F>();
    if constexpr (P > 1) {
        F twist = share * c.friction.twist;
        c.friction.twist = c.friction.twist + twist;
        angular = twist * c.n;
    }
    B.v = B.v + B.inverse_mass * linear;
    B.w = B.w + IB * (cross(arms.rb, linear) + angular);
    store_velocity_at<W>(bodies.state, c.b, B);
    if (fixed_a) return;
    A.v = A.v - A.inverse_mass * linear;
    A.w = A.w - IA * (cross(arms.ra, linear) + angular);
    store_velocity_at<W>(bodies.state, c.a, A);
}

// Whether all lanes are 0, which is what no number is not.
template <int W>
LENDULET_FORCE_INLINE bool all_zero(Wide<float, W> sum_of_sizes) {
    return mask_bits(sum_of_sizes <= splat<Wide<float, W>>(0.0f)) == (1u << W) - 1;
}

// Whether no lane has an impulse.
template <int W, int P>
LENDULET_FORCE_INLINE bool holds_nothing(const ContactRow<W, P>& c) {
    Wide<float, W> held = absolute(c.friction.tangent[0]) + absolute(c.friction.tangent[1]);
    if constexpr (P > 1) held = held + absolute(c.friction.twist);
    for (int j = 0; j < P; ++j) held = held + c.p[j].impulse;
    return all_zero<W>(held);
}

// Whether a sweep left all impulses as they were.
template <int W, int P>
LENDULET_FORCE_INLINE bool changes_nothing(const Wide<float, W> change[P], Vec3T<Wide<float, W>> overdue) {
    Wide<float, W> sum = (absolute(overdue.x) + absolute(overdue.y)) + absolute(overdue.z);
    for (int j = 0; j < P; ++j) sum = sum + absolute(change[j]);
    return all_zero<W>(sum);
}

// g.fixed_a and k.moved are the same for all rows of a loop: branches cost nothing here, copies of the kernel would
// only take longer to build. `first`: number of the first manifold in the group. Rows that give and hold nothing stop
// half way: what is left of a pass adds zeros then.
template <int W, int P, Pass pass>
LENDULET_FORCE_INLINE void contact_pass(ContactRow<W, P>& c, const BodyArrays& bodies, const SubstepConstants& k,
                                        const ContactGroup& g, int first) {
    using F = Wide<float, W>;
    BodyState* states = bodies.state;
    const bool fixed_a = g.fixed_a;
    const bool empty = pass != Pass::solve && holds_nothing<W, P>(c);
    if (pass == Pass::warm_start && empty) return;
    WideVelocity<F> A{}, B = load_velocity_at<W>(states, c.b);
    if (!fixed_a) A = load_velocity_at<W>(states, c.a);
    Vec3T<F> t2 = cross(c.n, c.t1), linear, angular;
    F change[P];
    MovedArms<F> now;
    if constexpr (pass == Pass::solve) {
        if (k.moved) follow_bodies<W, P>(c, bodies, k, g, first, t2, A, B);
        sweep_normals<W, P, true>(c, A, B, t2, k, change);
        if (changes_nothing<W, P>(change, c.overdue)) return;
    }
    Vec3T<F> drift_a = zero_vector<F>(), drift_b;
    SymMat3T<F> IA{}, IB = load_inverse_inertia_at<W>(bodies.inertia, c.b, B, drift_b);
    if (!fixed_a) IA = load_inverse_inertia_at<W>(bodies.inertia, c.a, A, drift_a);
    if constexpr (pass == Pass::warm_start) {
        now = {c.ra, c.rb, c.start_slip, splat<F>(0.0f), splat<F>(0.0f)};
        if (k.moved) now = update_displacement<W, P>(c, states, t2);
        for (int j = 0; j < P; ++j) change[j] = c.p[j].impulse;
        apply_normals<W, P, false>(c, A, B, IA, IB, t2, change);
        linear = c.friction.tangent[0] * c.t1 + c.friction.tangent[1] * t2;
        angular = zero_vector<F>();
        if constexpr (P > 1) angular = c.friction.twist * c.n;
        B.w = B.w + IB * (cross(now.rb, linear) + angular);
        A.w = A.w - IA * (cross(now.ra, linear) + angular);
    } else if constexpr (pass == Pass::solve) {
        apply_normals<W, P, true>(c, A, B, IA, IB, t2, change);
    } else {
        if (!fixed_a) {
            Vec3T<F> drift = drift_b - drift_a, moment = cross(held_impulse<W, P>(c, t2), drift);
            auto moving = dot(drift, drift) > splat<F>(k.still_drift * k.still_drift);
            c.overdue = select(moving, moment, zero_vector<F>());
        }
        now = follow_bodies<W, P>(c, bodies, k, g, first, t2, A, B);
        sweep_normals<W, P, false>(c, A, B, t2, k, change);
        if (empty && changes_nothing<W, P>(change, c.overdue)) return;
        apply_normals<W, P, false>(c, A, B, IA, IB, t2, change);
        Vec3T<F> slip = (now.start_slip + (B.v - A.v)) + (cross(B.w, now.rb) - cross(A.w, now.ra)), spin{};
        if constexpr (P > 1) spin = c.turn.start_spin + (B.w - A.w);
        solve_friction<W, P>(c, t2, slip, spin, linear, angular);
        B.w = B.w + IB * (cross(now.rb, linear) + angular);
        A.w = A.w - IA * (cross(now.ra, linear) + angular);
    }
    if constexpr (pass != Pass::solve) {
        B.v = B.v + B.inverse_mass * linear;
        A.v = A.v - A.inverse_mass * linear;
    }
    store_velocity_at<W>(states, c.b, B);
    if (!fixed_a) store_velocity_at<W>(states, c.a, A);
    if constexpr (pass == Pass::solve) {
        F left = c.p[0].impulse, gone = change[0];
        for (int j = 1; j < P; ++j) left = left + c.p[j].impulse, gone = gone + change[j];
        auto lets_go = left + gone < splat<F>(0.0f);
        if (mask_bits(lets_go))
            let_go_of_friction<W, P>(c, bodies, fixed_a, select(lets_go, gone / (left - gone), splat<F>(0.0f)));
    }
}

template <int W, int P, Pass pass>
void run_pass(const ContactGroup& g, const BodyArrays& bodies, const SubstepConstants& k, int begin, int end) {
    auto* rows = reinterpret_cast<ContactRow<W, P>*>(g.rows);
    for (int i = begin; i < end; ++i) contact_pass<W, P, pass>(rows[i], bodies, k, g, i * W);
}
