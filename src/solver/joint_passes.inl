// The passes of joint rows over a substep. Part of kernels.inl.
//
// Joints keep two sets of impulses. Those of the biased pass act before the drift, along the axes at its start, and are
// chosen so that the gap vanishes at its end; those of the relax pass act after it, along the axes at its end, and make
// the velocities agree with the joint. Each set is the warm start of its own pass in the next substep. This is the
// splitting of RATTLE (Andersen 1983; Hairer, Lubich, Wanner, "Geometric Numerical Integration", VII.1): a force that
// turns with the bodies must act in equal parts along its axes before and after, else energy grows or is lost in
// proportion to h. Joint impulses are applied anew in every substep, at arms of that substep, instead of repeating
// velocity changes as contacts do: bodies that swing about each other would lose angular momentum.

enum class JointPass { warm_start, solve, warm_relax, relax };

// What a pass changed in the rows of one joint.
template <int W, JointClass C>
struct JointChange {
    using F = Wide<float, W>;
    F locked[JointShape<C>::locked];
    F bounded[JointShape<C>::bounded > 0 ? JointShape<C>::bounded : 1];
};

// Total of row impulses as vectors: linear at the shared point, angular.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void to_vectors(const JointRow<W, C>& c, const JointChange<W, C>& x,
                                      Vec3T<Wide<float, W>>& linear, Vec3T<Wide<float, W>>& angular) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    angular = zero_vector<F>();
    if constexpr (S::slider)
        linear = x.locked[0] * c.direction[0] + x.locked[1] * c.direction[1] + x.bounded[0] * c.direction[2];
    else linear = {x.locked[0], x.locked[1], x.locked[2]};
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) angular = angular + x.locked[S::linear + j] * c.direction[j];
    if constexpr (S::bounded > 0 && !S::slider)
        for (int j = 0; j < S::bounded; ++j) angular = angular + x.bounded[j] * c.direction[S::limited_ball ? j : 2];
}

// How fast the relative motion changes by itself along the turning axes, times half a substep: joints must be ahead of
// it by that much for their gap to close at the end of the drift.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> sliding_curvature(const JointPair<F>& p, Vec3T<F> ra, Vec3T<F> rb, Vec3T<F> sliding) {
    Vec3T<F> b = cross(p.gyro_b, rb) + cross(p.spin_b(), cross(p.spin_b(), rb));
    Vec3T<F> a = cross(p.gyro_a, ra) + cross(p.spin_a(), cross(p.spin_a(), ra) + (sliding + sliding));
    return b - a;
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> turning_curvature(const JointPair<F>& p) {
    return (p.gyro_b - p.gyro_a) + cross(p.spin_b(), p.spin_a());
}

// Velocities that the locked rows still have to lose, as impulses with all of them solved together.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void solve_locked(JointRow<W, C>& c, const JointPair<Wide<float, W>>& p,
                                        const SubstepConstants& k, Vec3T<Wide<float, W>> sliding,
                                        Vec3T<Wide<float, W>> turning,
                                        Wide<float, W> (&change)[JointShape<C>::locked]) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const F zero = splat<F>(0.0f);
    const F most = splat<F>(joint_push_speed), rate = c.bias * splat<F>(k.inverse_h), half_h = splat<F>(0.5f * k.h);
    auto limited = [&](F speed) { return maximum(minimum(speed, most), zero - most); };
    auto push = [&](F gap) { return limited(rate * gap); };
    // What turns fast enough to reach this limit is not resolved by the substep; without it, errors would feed
    // themselves.
    auto ahead = [&](Vec3T<F> curvature) {
        return Vec3T<F>{limited(half_h * curvature.x), limited(half_h * curvature.y), limited(half_h * curvature.z)};
    };
    if constexpr (biased) {
        sliding = sliding + ahead(sliding_curvature(p, c.ra, c.rb, S::slider ? sliding : zero_vector<F>()));
        turning = turning + ahead(turning_curvature(p));
    }
    for (int i = 0; i < S::linear; ++i) {
        change[i] = zero - along_row<W, C>(c, i, sliding);
        if constexpr (biased) change[i] = change[i] - push(along_row<W, C>(c, i, c.gap));
    }
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) {
            change[S::linear + j] = zero - dot(c.direction[j], turning);
            if constexpr (biased) change[S::linear + j] = change[S::linear + j] - push(c.error[j]);
        }
    c.mass.solve(change);
    for (int i = 0; i < S::locked; ++i) {
        change[i] = c.relaxation * change[i];
        if constexpr (biased) change[i] = change[i] - c.leak * c.impulse[0][i];
        c.impulse[biased ? 0 : 1][i] = c.impulse[biased ? 0 : 1][i] + change[i];
    }
}

// The limit of one bounded row with velocity v: within the substep its coordinate may just reach a bound, or a share of
// what it is beyond is undone. Both bounds in one: the impulse without which the velocity lies between the two bounds'.
// In the relax pass that impulse is the one of both passes together.
template <bool biased, class Row, class Joint, class F>
LENDULET_FORCE_INLINE F solve_limit(Row& row, const Joint& c, const SubstepConstants& k, F v) {
    const F zero = splat<F>(0.0f), inverse_h = splat<F>(k.inverse_h), most = splat<F>(joint_push_speed);
    F below = row.lower - row.coordinate, above = row.upper - row.coordinate;  // <= 0 and >= 0 within
    F rate = zero, other = zero;
    if constexpr (biased) rate = c.bias * inverse_h;
    else other = row.limit[0];
    F slowest = select(below > zero, minimum(rate * below, most), below * inverse_h);
    F fastest = select(above < zero, maximum(rate * above, zero - most), above * inverse_h);
    F& own = row.limit[biased ? 0 : 1];
    F held = other + own, without = v - row.rate * held;
    F total = inverse_or_zero(row.rate) * (maximum(minimum(without, fastest), slowest) - without);
    F kept = select(held * total > zero, held, zero);  // a bound that is left lets go at once
    total = kept + c.relaxation * (total - kept);
    if constexpr (biased) {
        F leaky = total - c.leak * kept;
        total = select(total > zero, maximum(leaky, zero), minimum(leaky, zero));
    }
    own = total - other;
    return total - held;
}

// Spring and motor of the driven row. The spring is the implicit midpoint rule, which neither gains nor loses energy:
// its impulse over a substep is -h (stiffness (x + h v / 2) + damping v) with v the velocity of the drift.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE Wide<float, W> solve_drive(JointRow<W, C>& c, const SubstepConstants& k, Wide<float, W> v) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    auto& row = c.row[0];
    F inverse_rate = inverse_or_zero(row.rate);
    F share = one - splat<F>(0.5f) * c.split, change = zero;
    if constexpr (biased) {
        F h = splat<F>(k.h) * share, most = h * c.spring_force;
        F soft = h * (c.damping + splat<F>(0.5f * k.h) * c.stiffness);
        F without = v - row.rate * c.spring;
        F pull = soft * without + h * c.stiffness * (row.coordinate - c.target);
        F next = maximum(minimum((zero - pull) / (soft * row.rate + one), most), zero - most);
        change = c.relaxation * (next - c.spring);
        c.spring = c.spring + change;
    }
    F most = splat<F>(k.h) * c.motor_force, before = zero;
    if constexpr (biased) most = share * most;
    else before = c.motor[0];
    F& motor = c.motor[biased ? 0 : 1];
    F wanted = motor + inverse_rate * (c.motor_velocity - (v + row.rate * change));
    F next = maximum(minimum(wanted, most - before), zero - (most + before));
    F turn = c.relaxation * (next - motor);
    motor = motor + turn;
    return change + turn;
}

// Bounded rows one after the other, each with the locked rows held still.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void solve_bounded(JointRow<W, C>& c, const JointPair<Wide<float, W>>& p,
                                         const SubstepConstants& k, JointChange<W, C>& x) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> sliding = p.sliding(c.ra, c.rb), turning = p.turning();
    F passed = splat<F>(0.0f);
    for (int j = 0; j < S::bounded; ++j) {
        Vec3T<F> u = c.direction[S::limited_ball ? j : 2];
        F v = S::slider ? dot(u, sliding) : dot(u, turning);
        if (j == 1) v = v + c.coupling * passed;
        F change = splat<F>(0.0f);
        if constexpr (S::driven) change = solve_drive<W, C, biased>(c, k, v);
        change = change + solve_limit<biased>(c.row[j], c, k, v + c.row[j].rate * change);
        for (int i = 0; i < S::locked; ++i) {
            F back = c.row[j].response[i] * change;
            x.locked[i] = x.locked[i] - back;
            c.impulse[biased ? 0 : 1][i] = c.impulse[biased ? 0 : 1][i] - back;
        }
        x.bounded[j] = change;
        passed = change;
    }
}

// The stored impulses of one set.
template <int W, JointClass C, int set>
LENDULET_FORCE_INLINE JointChange<W, C> stored_impulses(JointRow<W, C>& c, const SubstepConstants& k) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    JointChange<W, C> x;
    for (int i = 0; i < S::locked; ++i) x.locked[i] = c.impulse[set][i];
    if constexpr (S::bounded > 0)
        for (int j = 0; j < S::bounded; ++j) {
            if constexpr (set == 1) c.row[j].limit[1] = splat<F>(0.0f);  // whether a limit is met is found anew
            x.bounded[j] = c.row[j].limit[set];
        }
    if constexpr (S::driven) {
        if constexpr (set == 1) {
            F most = splat<F>(k.h) * c.motor_force;
            c.motor[1] = maximum(minimum(c.motor[1], most - c.motor[0]), splat<F>(0.0f) - (most + c.motor[0]));
        }
        x.bounded[0] = x.bounded[0] + c.motor[set] + (set == 0 ? c.spring : c.split * c.spring);
    }
    return x;
}

template <int W, JointClass C, JointPass pass>
LENDULET_FORCE_INLINE void joint_pass(JointRow<W, C>& c, const JointGroup& g, SolverBodies& bodies,
                                      const SubstepConstants& k) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    constexpr bool biased = pass == JointPass::solve;
    JointPair<F> pair = load_pair<W, C>(c, bodies, biased);
    if (pass == JointPass::warm_relax || (pass == JointPass::warm_start && k.moved))
        update_joint<W, C>(c, bodies, pair.IA, pair.IB, pair.A.inverse_mass + pair.B.inverse_mass);
    JointChange<W, C> x;
    Vec3T<F> linear, angular;
    if constexpr (pass == JointPass::solve || pass == JointPass::relax) {
        solve_locked<W, C, biased>(c, pair, k, pair.sliding(c.ra, c.rb), pair.turning(), x.locked);
        if constexpr (S::bounded > 0) {
            // The locked rows' part first, so that bounded rows see the velocities that it leaves.
            for (F& b : x.bounded) b = splat<F>(0.0f);
            to_vectors<W, C>(c, x, linear, angular);
            pair.push(c.ra, c.rb, linear, angular);
            for (F& l : x.locked) l = splat<F>(0.0f);
            solve_bounded<W, C, biased>(c, pair, k, x);
        }
    } else {
        x = stored_impulses < W, C, pass == JointPass::warm_relax ? 1 : 0 > (c, k);
    }
    to_vectors<W, C>(c, x, linear, angular);
    pair.push(c.ra, c.rb, linear, angular);
    if (g.moved_a) store_velocity<W>(bodies.state.data(), c.a, pair.A);
    if (g.moved_b) store_velocity<W>(bodies.state.data(), c.b, pair.B);
}

template <int W, JointClass C, JointPass pass>
void run_joints(const JointGroup& g, SolverBodies& bodies, const SubstepConstants& k, int begin, int end) {
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int i = begin; i < end; ++i) joint_pass<W, C, pass>(rows[i], g, bodies, k);
}
template <int W, JointClass C>
void prepare_joints(const JointGroup& g, const JointRecord* records, const SolverBodies& bodies, int begin, int end) {
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int i = begin; i < end; ++i) prepare_joint<W, C>(rows[i], g, records, bodies, i * W);
}

template <int W, JointClass C>
void store_joints(const JointGroup& g, JointRecord* records, int begin, int end) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int b = begin; b < end; ++b) {
        JointRow<W, C>& c = rows[b];
        JointChange<W, C> all;
        for (int i = 0; i < S::locked; ++i) all.locked[i] = c.impulse[0][i] + c.impulse[1][i];
        if constexpr (S::bounded > 0)
            for (int j = 0; j < S::bounded; ++j) all.bounded[j] = c.row[j].limit[0] + c.row[j].limit[1];
        if constexpr (S::driven)
            all.bounded[0] = all.bounded[0] + c.motor[0] + c.motor[1] + (splat<F>(1.0f) + c.split) * c.spring;
        Vec3T<F> linear, angular;
        to_vectors<W, C>(c, all, linear, angular);
        int live = g.count - b * W < W ? g.count - b * W : W;
        for (int l = 0; l < live; ++l) {
            JointRecord& r = records[g.order[b * W + l]];
            float* places[2][2] = {{r.linear_0, r.angular_0}, {r.linear_1, r.angular_1}};
            for (int set = 0; set < 2; ++set)
                for (int i = 0; i < S::locked; ++i)
                    (i < S::linear ? places[set][0][i] : places[set][1][i - S::linear]) = lane(c.impulse[set][i], l);
            if constexpr (S::bounded > 0) r.limit_0 = lane(c.row[0].limit[0], l);
            if constexpr (S::bounded > 1) r.limit_1 = lane(c.row[1].limit[0], l);
            if constexpr (S::driven)
                r.motor_0 = lane(c.motor[0], l), r.motor_1 = lane(c.motor[1], l), r.spring = lane(c.spring, l);
            for (int i = 0; i < 3; ++i) {
                r.impulse[i] = lane(component_of(linear, i), l);
                r.angular_impulse[i] = lane(component_of(angular, i), l);
            }
        }
    }
}
