// The passes of joint rows over a substep. Part of kernels.inl.
//
// Joints take part in the delta warm start of contacts: what constraints changed in the last substep is in the bodies'
// velocities again when a pass begins. Linear impulses are the same ones on turned arms, but the angular impulses that
// go with them have changed; each row knows which it holds (turn_a, turn_b, angular) and, when its turn comes, replaces
// them by those of its present arms and axes. So all impulses act at shared points of the present, linear and angular
// momentum are conserved together, and no pass over the rows is spent on warm starting.
//
// Until its rows are solved again a joint has turned its bodies by that: by h w P r / I, for a force P along an arm
// that turns with w. For a body of which the moment I is small beside m r^2 this is no small part of w but (h w)^2 m
// r^2 / I times it. What is taken from velocities for more than the rows themselves, which undo it, is therefore taken
// from those before: the motion's curvature. And what soft rows give up is a share of the impulse as it acts now
// (turn_held()), not of what it was along the old arms: else a tenth of that turning would stay.
//
// Where nothing but joints constrains a group of bodies ("split"), the biased pass is the only one of a substep. It
// chooses impulses along the axes now so that the gap vanishes at the end of the drift, as SHAKE does (Ryckaert,
// Ciccotti, Berendsen 1977; Hairer, Lubich, Wanner, "Geometric Numerical Integration", VII.1): with forces applied in
// halves before and after the drift, the relax pass of one substep and the biased pass of the next would act at the
// same place one after the other, and their sum is what a single pass finds. Only at the end of a step velocities are
// made to agree with the joints, by half an impulse, and the next step begins with the other half. Forces that turn
// with the bodies thus act in equal parts along their axes before and after each drift (RATTLE), else energy would grow
// or be lost in proportion to h.
//
// Elsewhere ("touching") impulses and forces act before the drift and a relax pass after it, together with the
// contacts', makes velocities agree with the joints.

// What a pass changed in the rows of one joint.
template <int W, JointClass C>
struct JointChange {
    using F = Wide<float, W>;
    F locked[JointShape<C>::locked];
    F bounded[JointShape<C>::bounded > 0 ? JointShape<C>::bounded : 1];
    [[no_unique_address]] std::conditional_t<JointShape<C>::rubs, Vec3T<F>, NoPart<0>> rub;
};

// Total of row impulses as vectors: linear at the shared point, angular.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void to_vectors(const JointGeometry<W, C>& o, const JointChange<W, C>& x,
                                      Vec3T<Wide<float, W>>& linear, Vec3T<Wide<float, W>>& angular) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    angular = zero_vector<F>();
    if constexpr (S::six) {
        six_vectors<W>(o, x.locked, x.bounded, linear, angular);
        return;
    }
    if constexpr (S::slider)
        linear = x.locked[0] * o.direction[0] + x.locked[1] * o.direction[1] + x.bounded[0] * o.direction[2];
    else linear = {x.locked[0], x.locked[1], x.locked[2]};
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) angular = angular + x.locked[S::linear + j] * o.direction[j];
    if constexpr (S::bounded > 0 && !S::slider)
        for (int j = 0; j < S::bounded; ++j) angular = angular + x.bounded[j] * o.direction[S::limited_ball ? j : 2];
    if constexpr (S::rubs) angular = angular + x.rub;
}

// The impulses that the row holds.
template <int W, JointClass C>
LENDULET_FORCE_INLINE JointChange<W, C> held_impulses(const JointRow<W, C>& c) {
    using S = JointShape<C>;
    JointChange<W, C> x;
    for (int i = 0; i < S::locked; ++i) x.locked[i] = c.impulse[i];
    if constexpr (S::bounded > 0)
        for (int j = 0; j < S::bounded; ++j) x.bounded[j] = c.row[j].limit;
    if constexpr (S::driven) x.bounded[0] = x.bounded[0] + c.motor + c.spring_sum;
    if constexpr (S::rubs) x.rub = c.rub;
    if constexpr (S::six)
        for (int j = 0; j < S::bounded; ++j) x.bounded[j] = x.bounded[j] + (c.row[j].motor + c.row[j].spring_sum);
    return x;
}

// How fast the relative motion changes by itself along the turning axes: joints must be ahead of it by half a substep
// for their gap to close at the end of the drift, and for a coordinate to change there by h times the rate asked for.
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

// By how much the mean of a rate over the drift is ahead of what it is before it. What turns fast enough to reach the
// limit is not resolved by the substep; without it, errors would feed themselves.
template <class F>
LENDULET_FORCE_INLINE F rate_ahead(F curvature, const JointConstants& k) {
    const F most = splat<F>(joint_push_speed);
    return maximum(minimum(splat<F>(0.5f * k.h) * curvature, most), splat<F>(0.0f) - most);
}

// Share of errors undone in a pass. Soft rows undo half of it where they give up the leak of half an impulse, at the
// start of a split step: else a load at rest would not be at rest.
template <int W, JointClass C>
LENDULET_FORCE_INLINE Wide<float, W> bias_of(const JointRow<W, C>& c, const JointConstants& k, bool split) {
    using F = Wide<float, W>;
    if (!split || k.share == 1.0f) return c.bias;
    return select(c.leak > splat<F>(0.0f), splat<F>(k.share) * c.bias, c.bias);
}

// Velocities that the locked rows still have to lose.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void locked_speeds(const JointRow<W, C>& c, const JointGeometry<W, C>& o,
                                         const JointPair<Wide<float, W>>& p, const JointPair<Wide<float, W>>& before,
                                         const JointConstants& k, bool split,
                                         Wide<float, W> (&change)[JointShape<C>::locked]) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const F zero = splat<F>(0.0f), rate = bias_of<W, C>(c, k, split) * splat<F>(k.inverse_h);
    const F most = splat<F>(joint_push_speed);
    auto push = [&](F gap) { return maximum(minimum(rate * gap, most), zero - most); };
    auto ahead = [&](Vec3T<F> curvature) {
        return Vec3T<F>{rate_ahead(curvature.x, k), rate_ahead(curvature.y, k), rate_ahead(curvature.z, k)};
    };
    Vec3T<F> sliding = p.sliding(o.ra, o.rb), turning = p.turning();
    if constexpr (biased) {
        Vec3T<F> along = zero_vector<F>();
        if constexpr (S::along) along = before.sliding(o.ra, o.rb);
        sliding = sliding + ahead(sliding_curvature(before, o.ra, o.rb, along));
        if constexpr (S::angular > 0) turning = turning + ahead(turning_curvature(before));
    }
    for (int i = 0; i < S::linear; ++i) {
        change[i] = zero - along_row<W, C>(o, i, sliding);
        if constexpr (biased) {
            F gap = along_row<W, C>(o, i, o.gap);
            if constexpr (S::six) gap = gap - c.held_at[i];
            change[i] = change[i] - push(gap);
        }
    }
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) {
            change[S::linear + j] = zero - dot(o.direction[S::turning + j], turning);
            if constexpr (biased) change[S::linear + j] = change[S::linear + j] - push(o.error[j]);
        }
}

// The impulses that take them away, all rows of a joint together.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void solve_locked(JointRow<W, C>& c, const JointGeometry<W, C>& o,
                                        const Factor<Wide<float, W>, JointShape<C>::locked>& mass,
                                        const JointPair<Wide<float, W>>& p, const JointPair<Wide<float, W>>& before,
                                        const Wide<float, W> (&turned)[JointShape<C>::locked], const JointConstants& k,
                                        bool split, Wide<float, W> (&change)[JointShape<C>::locked]) {
    locked_speeds<W, C, biased>(c, o, p, before, k, split, change);
    mass.solve(change);
    for (int i = 0; i < JointShape<C>::locked; ++i) {
        change[i] = c.relaxation * change[i];
        if constexpr (biased) change[i] = change[i] - c.leak * (c.impulse[i] + turned[i]);
        c.impulse[i] = c.impulse[i] + change[i];
    }
}

// Between which velocities a bounded row may leave its coordinate: within the substep it may just reach a bound, or a
// share of what it is beyond is undone.
template <class F>
struct SpeedRange {
    F slowest, fastest;
};
template <bool biased, class Row, class F>
LENDULET_FORCE_INLINE SpeedRange<F> speed_range(const Row& row, F coordinate, F bias, const JointConstants& k) {
    const F zero = splat<F>(0.0f), inverse_h = splat<F>(k.inverse_h), most = splat<F>(joint_push_speed);
    F below = row.lower - coordinate, above = row.upper - coordinate;  // <= 0 and >= 0 within
    F rate = biased ? bias * inverse_h : zero;
    return {select(below > zero, minimum(rate * below, most), below * inverse_h),
            select(above < zero, maximum(rate * above, zero - most), above * inverse_h)};
}

// A turn about one axis of several that is far beyond its bounds came there where it was not known, and is brought back
// with 1 rad/s at 480 substeps a second: at the speed of other gaps that would be a motor.
template <class Row, class F>
LENDULET_FORCE_INLINE F near_bounds(const Row& row, F turn) {
    const F far = splat<F>(0.5f), near = splat<F>(0.01f);
    return select(turn > row.upper + far, row.upper + near, select(turn < row.lower - far, row.lower - near, turn));
}

// The limit of one bounded row with velocity v. Both bounds in one: the impulse without which the velocity lies in its
// range.
template <bool biased, class Row, class F>
LENDULET_FORCE_INLINE F solve_limit(Row& row, SpeedRange<F> range, F rate, F leak, F relaxation, F v) {
    const F zero = splat<F>(0.0f);
    F held = row.limit, without = v - rate * held;
    F total = inverse_or_zero(rate) * (maximum(minimum(without, range.fastest), range.slowest) - without);
    F kept = select(held * total > zero, held, zero);  // a bound that is left lets go at once
    total = kept + relaxation * (total - kept);
    if constexpr (biased) {
        F leaky = total - leak * kept;
        total = select(total > zero, maximum(leaky, zero), minimum(leaky, zero));
    }
    row.limit = total;
    return total - held;
}

// Spring and motor of the driven row. The spring is the implicit midpoint rule, which neither gains nor loses energy:
// its impulse over a substep is -h (stiffness (x + h v / 2) + damping v) with v the velocity of the drift, half of it
// before that drift and half after where the kick is split.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE Wide<float, W> solve_drive(JointRow<W, C>& c, const JointConstants& k, bool split,
                                                 Wide<float, W> rate, Wide<float, W> coordinate, Wide<float, W> v) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F inverse_rate = inverse_or_zero(rate), change = zero;
    if (biased || split) {
        F known = split && !k.first ? c.spring : zero, sum = known;  // what the last drift's spring still has to give
        if constexpr (biased) {
            F h = splat<F>(split ? 0.5f * k.h : k.h), most = h * c.spring_force;
            F soft = h * (c.damping + splat<F>(0.5f * k.h) * c.stiffness);
            F without = v + rate * (known - c.spring_sum);
            F pull = soft * without + h * c.stiffness * (coordinate - c.target);
            F next = maximum(minimum((zero - pull) / (soft * rate + one), most), zero - most);
            sum = c.spring_sum + c.relaxation * ((known + next) - c.spring_sum);
            c.spring = sum - known;
        }
        change = sum - c.spring_sum;
        c.spring_sum = sum;
    }
    F most = splat<F>(split ? k.share * k.h : k.h) * c.motor_force;
    F wanted = c.motor + inverse_rate * (c.motor_velocity - (v + rate * change));
    F next = maximum(minimum(wanted, most), zero - most);
    F turn = c.relaxation * (next - c.motor);
    c.motor = c.motor + turn;
    return change + turn;
}

// Bounded rows one after the other, each with the locked rows held still, after these were solved. Where no lane of the
// block meets a bound and none is driven, there is nothing to do; lanes without work stay as they are, so that what a
// joint does never depends on its neighbours.
template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void solve_bounded(JointRow<W, C>& c, const JointGeometry<W, C>& o,
                                         const PointResponse<Wide<float, W>>& response,
                                         const Factor<Wide<float, W>, JointShape<C>::locked>& mass,
                                         JointPair<Wide<float, W>>& p, const JointConstants& k, bool split,
                                         JointChange<W, C>& x) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const F zero = splat<F>(0.0f);
    SpeedRange<F> range[S::bounded];
    F v[S::bounded];
    Vec3T<F> sliding = p.sliding(o.ra, o.rb), turning = p.turning();
    auto busy = zero < zero;
    for (int j = 0; j < S::bounded; ++j) {
        Vec3T<F> u = o.direction[S::limited_ball ? j : 2];
        v[j] = S::slider ? dot(u, sliding) : dot(u, turning);
        // A motor, spring or damper is about how far the coordinate gets, not about how fast it sets out.
        if constexpr (S::driven && biased)
            v[j] = v[j] +
                   rate_ahead(dot(u, S::slider ? sliding_curvature(p, o.ra, o.rb, sliding) : turning_curvature(p)), k);
        const F coordinate = S::limited_ball && j == 1 ? near_bounds(c.row[j], o.coordinate[j]) : o.coordinate[j];
        range[j] = speed_range<biased>(c.row[j], coordinate, bias_of<W, C>(c, k, split), k);
        busy = busy | (v[j] < range[j].slowest) | (v[j] > range[j].fastest) | (c.row[j].limit != zero);
        x.bounded[j] = zero;
    }
    if (!S::driven && mask_bits(busy) == 0) return;
    BoundedResponse<W, C> r[S::bounded];
    factor_bounded<W, C>(o, response, mass, r);
    JointChange<W, C> more;
    if constexpr (S::rubs) more.rub = zero_vector<F>();
    F impulse[S::locked];
    for (int i = 0; i < S::locked; ++i) more.locked[i] = zero, impulse[i] = c.impulse[i];
    for (int j = 0; j < S::bounded; ++j) {
        F speed = v[j], change = zero;
        if constexpr (S::bounded > 1)
            if (j == 1) speed = speed + r[1].passed * more.bounded[0];
        if constexpr (S::driven) change = solve_drive<W, C, biased>(c, k, split, r[j].rate, o.coordinate[j], speed);
        change = change +
                 solve_limit<biased>(c.row[j], range[j], r[j].rate, c.leak, c.relaxation, speed + r[j].rate * change);
        for (int i = 0; i < S::locked; ++i) {
            F back = r[j].back[i] * change;
            more.locked[i] = more.locked[i] - back;
            impulse[i] = impulse[i] - back;
        }
        more.bounded[j] = change;
    }
    Vec3T<F> linear, angular;
    to_vectors<W, C>(o, more, linear, angular);
    JointPair<F> pushed = p;
    pushed.push(o.ra, o.rb, linear, angular);
    auto take = [&](F& old, F now) { old = S::driven ? now : select(busy, now, old); };
    auto take_vector = [&](Vec3T<F>& old, Vec3T<F> now) { take(old.x, now.x), take(old.y, now.y), take(old.z, now.z); };
    take_vector(p.A.v, pushed.A.v), take_vector(p.A.w, pushed.A.w);
    take_vector(p.B.v, pushed.B.v), take_vector(p.B.w, pushed.B.w);
    for (int i = 0; i < S::locked; ++i) {
        take(c.impulse[i], impulse[i]);
        take(x.locked[i], x.locked[i] + more.locked[i]);
    }
    for (int j = 0; j < S::bounded; ++j) take(x.bounded[j], more.bounded[j]);
}

#include "solver/joints/rubbing.inl"
#include "solver/joints/six_passes.inl"

// Multiplies what the row holds, as the bodies' repeated changes were.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void scale_impulses(JointRow<W, C>& c, Wide<float, W> s) {
    using S = JointShape<C>;
    for (Wide<float, W>& x : c.impulse) x = s * x;
    c.turn_a = s * c.turn_a;
    c.turn_b = s * c.turn_b;
    if constexpr (S::directions > 0) c.angular = s * c.angular;
    if constexpr (S::along) c.linear = s * c.linear;
    if constexpr (S::bounded > 0)
        for (auto& row : c.row) row.limit = s * row.limit;
    if constexpr (S::six)
        for (auto& row : c.row) row.motor = s * row.motor, row.spring_sum = s * row.spring_sum;
    if constexpr (S::driven) c.motor = s * c.motor, c.spring_sum = s * c.spring_sum;
    if constexpr (S::rubs) c.rub = s * c.rub;
}

// What a pass did to the impulses, told to the row.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void hold(JointRow<W, C>& c, const JointGeometry<W, C>& o, Vec3T<Wide<float, W>> linear,
                                Vec3T<Wide<float, W>> angular) {
    using S = JointShape<C>;
    c.turn_a = c.turn_a + (cross(o.ra, linear) + angular);
    c.turn_b = c.turn_b + (cross(o.rb, linear) + angular);
    if constexpr (S::directions > 0) c.angular = c.angular + angular;
    if constexpr (S::along) c.linear = c.linear + linear;
}

// Replaces the impulses that the bodies' velocities hold by those on the present arms and axes.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void rebase(JointRow<W, C>& c, const JointGeometry<W, C>& o, JointPair<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> linear, angular;
    to_vectors<W, C>(o, held_impulses<W, C>(c), linear, angular);
    if constexpr (S::along) {
        Vec3T<F> more = linear - c.linear;
        p.A.v = p.A.v - p.A.inverse_mass * more;
        p.B.v = p.B.v + p.B.inverse_mass * more;
        c.linear = linear;
    }
    Vec3T<F> turn_a = cross(o.ra, linear), turn_b = cross(o.rb, linear);
    if constexpr (S::directions > 0) {
        turn_a = turn_a + angular;
        turn_b = turn_b + angular;
        c.angular = angular;
    }
    p.A.w = p.A.w - p.IA * (turn_a - c.turn_a);
    p.B.w = p.B.w + p.IB * (turn_b - c.turn_b);
    c.turn_a = turn_a;
    c.turn_b = turn_b;
}

// By how much the impulses of the locked rows turned with their arms: what makes these rows move as before rebase().
template <int W, JointClass C>
LENDULET_FORCE_INLINE void turn_held(const JointRow<W, C>& c, const JointGeometry<W, C>& o,
                                     const Factor<Wide<float, W>, JointShape<C>::locked>& mass,
                                     const JointPair<Wide<float, W>>& before, const JointPair<Wide<float, W>>& after,
                                     Wide<float, W> (&turned)[JointShape<C>::locked]) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const Vec3T<F> wa = before.A.w - after.A.w, wb = before.B.w - after.B.w;
    Vec3T<F> sliding = cross(wb, o.rb) - cross(wa, o.ra), turning = wb - wa;
    if constexpr (S::along) sliding = sliding + ((before.B.v - after.B.v) - (before.A.v - after.A.v));
    for (int i = 0; i < S::linear; ++i) turned[i] = along_row<W, C>(o, i, sliding);
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) turned[S::linear + j] = dot(o.direction[S::turning + j], turning);
    mass.solve(turned);
    for (int i = 0; i < S::locked; ++i) turned[i] = c.relaxation * turned[i];
}

// What a joint holds: along the line or at the point, and about each body's centre of mass.
template <class F>
struct HeldByJoint {
    Vec3T<F> linear, turn_a, turn_b;
};

// Takes from the bodies what soft rows hold beyond most_held_speed and most_held_spin; returns what share stays.
template <int W>
[[gnu::noinline]] Wide<float, W> let_go_of_excess(JointPair<Wide<float, W>>& p, const HeldByJoint<Wide<float, W>>& held,
                                                  Wide<float, W> speed2, Wide<float, W> leak) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    constexpr float per_spin = 1.0f / most_held_spin;
    const Vec3T<F> spin_a = p.IA * held.turn_a, spin_b = p.IB * held.turn_b;
    const F spin2 = splat<F>(per_spin * per_spin) * maximum(dot(spin_a, spin_a), dot(spin_b, spin_b));
    const F over2 = select(leak > zero, maximum(speed2, spin2), zero);
    auto are_over = over2 > one;
    const F share = select(are_over, one / square_root(over2), one), less = one - share;
    p.A.v = select(are_over, p.A.v + (less * p.A.inverse_mass) * held.linear, p.A.v);
    p.B.v = select(are_over, p.B.v - (less * p.B.inverse_mass) * held.linear, p.B.v);
    p.A.w = select(are_over, p.A.w + less * spin_a, p.A.w);
    p.B.w = select(are_over, p.B.w - less * spin_b, p.B.w);
    return share;
}

// All rows of a joint let go of the same share. Few ever come so far: a bound of the spins, by the traces of the
// inverse inertias, tells.
template <int W, JointClass C>
LENDULET_FORCE_INLINE Wide<float, W> limit_held(JointRow<W, C>& c, JointPair<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    constexpr float per_speed = 1.0f / most_held_speed, per_spin = 1.0f / most_held_spin;
    HeldByJoint<F> held{{}, c.turn_a, c.turn_b};
    if constexpr (JointShape<C>::along) held.linear = c.linear;
    else held.linear = {c.impulse[0], c.impulse[1], c.impulse[2]};
    const F speed = splat<F>(per_speed) * (p.A.inverse_mass + p.B.inverse_mass);
    const F speed2 = (speed * speed) * dot(held.linear, held.linear);
    const F most_a = splat<F>(per_spin) * (p.IA.xx + p.IA.yy + p.IA.zz),
            most_b = splat<F>(per_spin) * (p.IB.xx + p.IB.yy + p.IB.zz);
    const F most2 = maximum((most_a * most_a) * dot(c.turn_a, c.turn_a), (most_b * most_b) * dot(c.turn_b, c.turn_b));
    if (mask_bits(maximum(speed2, most2) > splat<F>(1.0f)) == 0) return splat<F>(1.0f);
    const F share = let_go_of_excess<W>(p, held, speed2, c.leak);
    scale_impulses<W, C>(c, share);
    return share;
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE JointPair<Wide<float, W>> load_pair(const JointRow<W, C>& c, const SolverBodies& bodies) {
    JointPair<Wide<float, W>> p;
    load_joint_body<W>(bodies, c.a, p.A, p.dpa, p.dqa, p.IA, p.gyro_a);
    load_joint_body<W>(bodies, c.b, p.B, p.dpb, p.dqb, p.IB, p.gyro_b);
    p.start_v = c.start_v;
    p.start_wa = c.start_wa;
    p.start_wb = c.start_wb;
    return p;
}

// Forces are reported as means over the step: its last impulse alone would be ahead of the motion or behind it.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void add_to_sums(JointRow<W, C>& c) {
    if constexpr (JointShape<C>::along) c.linear_sum = c.linear_sum + c.linear;
    else c.linear_sum = c.linear_sum + Vec3T<Wide<float, W>>{c.impulse[0], c.impulse[1], c.impulse[2]};
    if constexpr (JointShape<C>::directions > 0) c.angular_sum = c.angular_sum + c.angular;
}

template <int W, JointClass C, bool biased>
LENDULET_FORCE_INLINE void joint_pass(JointRow<W, C>& c, const JointGroup& g, SolverBodies& bodies,
                                      const JointConstants& k) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    JointPair<F> pair = load_pair<W, C>(c, bodies);
    JointGeometry<W, C> o = find_geometry<W, C>(c, pair);
    PointResponse<F> response = point_response(o.ra, o.rb, pair.IA, pair.IB, pair.A.inverse_mass + pair.B.inverse_mass);
    Factor<F, S::locked> mass = factor_locked<W, C>(c, o, response);
    if (g.split && k.scale != 1.0f) scale_impulses<W, C>(c, splat<F>(k.scale));
    const JointPair<F> before = pair;
    if (biased || g.split) rebase<W, C>(c, o, pair);
    F turned[S::locked];
    if constexpr (biased) {
        turn_held<W, C>(c, o, mass, before, pair, turned);
        const F share = limit_held<W, C>(c, pair);
        for (F& t : turned) t = share * t;
    }
    JointChange<W, C> x;
    if constexpr (S::bounded > 0)
        for (F& b : x.bounded) b = splat<F>(0.0f);
    if constexpr (S::rubs) x.rub = zero_vector<F>();
    solve_locked<W, C, biased>(c, o, mass, pair, before, turned, k, g.split, x.locked);
    Vec3T<F> linear, angular;
    to_vectors<W, C>(o, x, linear, angular);
    pair.push(o.ra, o.rb, linear, angular);
    if constexpr (S::bounded > 0) {
        if constexpr (S::rubs) solve_rubbing<W, C, biased>(c, o, response, mass, pair, k, g.split, x);
        if constexpr (S::six) solve_axes<W, biased>(c, o, response, mass, pair, k, g.split, x);
        else solve_bounded<W, C, biased>(c, o, response, mass, pair, k, g.split, x);
        to_vectors<W, C>(o, x, linear, angular);
    }
    hold<W, C>(c, o, linear, angular);
    if (!biased || g.split) add_to_sums<W, C>(c);  // what the row holds now has acted
    if (g.moved_a) store_velocity_at<W>(bodies.state.data(), c.a, pair.A);
    if (g.moved_b) store_velocity_at<W>(bodies.state.data(), c.b, pair.B);
}

template <int W, JointClass C, bool biased>
void run_joints(const JointGroup& g, SolverBodies& bodies, const JointConstants& k, int begin, int end) {
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int i = begin; i < end; ++i) joint_pass<W, C, biased>(rows[i], g, bodies, k);
}

template <int W, JointClass C>
void warm_start_joints(const JointGroup& g, SolverBodies& bodies, const JointConstants&, int begin, int end) {
    using F = Wide<float, W>;
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int i = begin; i < end; ++i) {
        JointRow<W, C>& c = rows[i];
        WideVelocity<F> A = load_velocity_at<W>(bodies.state.data(), c.a),
                        B = load_velocity_at<W>(bodies.state.data(), c.b);
        Vec3T<F> linear;
        if constexpr (JointShape<C>::along) linear = c.linear;
        else linear = {c.impulse[0], c.impulse[1], c.impulse[2]};
        A.v = A.v - A.inverse_mass * linear;
        B.v = B.v + B.inverse_mass * linear;
        A.w = A.w - load_inverse_inertia_at<W>(bodies.inertia.data(), c.a) * c.turn_a;
        B.w = B.w + load_inverse_inertia_at<W>(bodies.inertia.data(), c.b) * c.turn_b;
        if (g.moved_a) store_velocity_at<W>(bodies.state.data(), c.a, A);
        if (g.moved_b) store_velocity_at<W>(bodies.state.data(), c.b, B);
    }
}
