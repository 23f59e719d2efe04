// How a body turns at constant angular momentum. Part of kernels.inl and of impacts.cpp.

// Theta w or Theta^-1 L: R diag(principal) R^T applied to a world vector.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> apply_principal(QuatT<F> q, Vec3T<F> principal, Vec3T<F> v) {
    return rotate(q, multiply(principal, rotate_inverse(q, v)));
}

// exp of half the rotation vector `turn`, as a quaternion, less 1; |turn| <= 1. Taylor series to single precision.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_less_one(Vec3T<F> turn) {
    F x = splat<F>(0.25f) * dot(turn, turn);  // (angle / 2)^2
    F s =
        splat<F>(0.5f) + x * (splat<F>(-1.0f / 12.0f) + x * (splat<F>(1.0f / 240.0f) + x * splat<F>(-1.0f / 10080.0f)));
    F c = x * (splat<F>(-0.5f) +
               x * (splat<F>(1.0f / 24.0f) + x * (splat<F>(-1.0f / 720.0f) + x * splat<F>(1.0f / 40320.0f))));
    return {s * turn.x, s * turn.y, s * turn.z, c};
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_quaternion(Vec3T<F> turn) {
    QuatT<F> q = turn_less_one(turn);
    q.w = splat<F>(1.0f) + q.w;
    return q;
}
// q + d with what rounding added to q kept in `low` (Kahan 1965), in the lanes of `active`.
template <class F, class Mask>
LENDULET_FORCE_INLINE void add_compensated(F& q, F& low, F d, Mask active) {
    F y = d - low, t = q + y;
    low = select(active, (t - q) - y, low);
    q = select(active, t, q);
}
// Without the components that are too small to tell: squares of what is left are numbers that processors multiply as
// fast as others. A body that stands turns by 1e-11 rad about two axes, and by their product about the third.
inline constexpr float still_spin = 1e-12f, still_turn = 1e-15f;  // rad/s, rad
template <class F>
LENDULET_FORCE_INLINE F unless_still(F x, float still) {
    return select(absolute(x) < splat<F>(still), splat<F>(0.0f), x);
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> unless_still(Vec3T<F> a, float still) {
    return {unless_still(a.x, still), unless_still(a.y, still), unless_still(a.z, still)};
}

// Of a quaternion that rounding alone took from unit length: a step of Newton's rule for 1 / |q|.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> normalized(QuatT<F> q) {
    q = {unless_still(q.x, still_turn), unless_still(q.y, still_turn), unless_still(q.z, still_turn), q.w};
    F s = splat<F>(1.5f) - splat<F>(0.5f) * ((q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w));
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

inline constexpr int most_halvings = 7;  // of a turn, until the series holds: 128 radians in a substep

// The turn, or what is left of it at a radian, where the series ends: what spins faster than its parts can follow turns
// by too little, and not by numbers without bounds.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> at_most_a_radian(Vec3T<F> turn) {
    const F size2 = dot(turn, turn), one = splat<F>(1.0f);
    return select(size2 > one, one / square_root(size2), one) * turn;
}

// exp of half the rotation vector `turn` of any length, less 1: that of a part, squared.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> long_turn_less_one(Vec3T<F> turn) {
    const F one = splat<F>(1.0f), size2 = dot(turn, turn);
    F parts = one;
    for (int i = 0; i < most_halvings; ++i) parts = select(size2 > parts * parts, parts + parts, parts);
    QuatT<F> q = turn_quaternion(at_most_a_radian((one / parts) * turn));
    for (F done = one; mask_bits(done < parts); done = done + done) {
        auto more = done < parts;
        const QuatT<F> twice = multiply(q, q);
        q = {select(more, twice.x, q.x), select(more, twice.y, q.y), select(more, twice.z, q.z),
             select(more, twice.w, q.w)};
    }
    const QuatT<F> whole = turn_less_one(turn);
    auto cut = parts > one;
    return {select(cut, q.x, whole.x), select(cut, q.y, whole.y), select(cut, q.z, whole.z),
            select(cut, q.w - one, whole.w)};
}

// The axis about which a body has two equal principal moments, or nearly: the inverses of these and of the third one.
template <class F>
struct Symmetry {
    F found;        // 1, or 0 where all three differ
    Vec3T<F> axis;  // of the principal frame
    F across, along;
    LENDULET_FORCE_INLINE explicit Symmetry(Vec3T<F> inverse) {
        const F zero = splat<F>(0.0f), one = splat<F>(1.0f), half = splat<F>(0.5f);
        const F near = splat<F>(equal_moments) * maximum(maximum(inverse.x, inverse.y), inverse.z);
        auto about_x = absolute(inverse.y - inverse.z) <= near;
        auto about_y = absolute(inverse.x - inverse.z) <= near;
        auto about_z = absolute(inverse.x - inverse.y) <= near;
        const F x = select(about_x, one, zero), y = select(about_y, one - x, zero);
        axis = {x, y, one - x - y};
        found = maximum(x + y, select(about_z, one, zero));
        along = select(x > zero, inverse.x, select(y > zero, inverse.y, inverse.z));
        across = half * select(x > zero, inverse.y + inverse.z,
                               select(y > zero, inverse.x + inverse.z, inverse.x + inverse.y));
    }
};

// The turn of a body with such an axis, exact for any time: it turns about its axis, which goes round L. The angle
// between the two stays, and with it the energy, whatever rounding does to either turn. (Landau, Lifshitz, "Mechanics",
// section 33)
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_symmetric(QuatT<F> q, QuatT<F> q0, Vec3T<F> L, const Symmetry<F>& body, float h,
                                              bool some_long) {
    const F time = splat<F>(h);
    const Vec3T<F> axis = rotate(q0, body.axis);  // at the start of the step
    const F spin = (time * (body.along - body.across)) * dot(L, rotate(q, axis));
    const Vec3T<F> about_axis = unless_still(spin * axis, still_turn),
                   about_L = unless_still((time * body.across) * L, still_turn);
    const QuatT<F> a = some_long ? long_turn_less_one(about_axis) : turn_less_one(about_axis);
    const QuatT<F> b = some_long ? long_turn_less_one(about_L) : turn_less_one(about_L);
    QuatT<F> d = multiply(q, a);
    q = {q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
    d = multiply(b, q);
    return {q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
}

inline constexpr int max_turn_parts = 128;
inline constexpr float most_wish = 0.25f;  // of a part
// Wishes, see below: from the second and third on once and three times, from the last on in parts and 6 times. Below
// the first one a body turns by less than 1e-4 rad in a substep, and w stays.
inline constexpr float slow = 1e-4f, calm = 0.01f, lively = 0.05f, quick = 0.2f;

// Turns dq q0 over h at constant L; I is the inverse inertia there. The fixed point of the midpoint rule contracts by
// h |w| anisotropy / 2 an iteration, a quarter of the wish below. The iteration begins with what w would be in the
// middle if it went on to change as it does, dw/dt = I (L x w), as good as one that begins with w and goes once. Fast
// and slender bodies are turned in parts and with more iterations, and slow ones need fewer than three: as many as
// leave an error below 1e-7 rad. How many parts must not change with |w| as a body tumbles: the rule keeps energy
// because it is the same backwards, and with parts that came and went a box at 100 rad/s about its middle axis gained 3
// % of it in a minute. Kinematic lanes (no inertia) turn with their given w. The middle's inertia is given the mean of
// L as the body sees it at both ends (as it sees L from the middle, with its part across the axis times the cosine of
// half the turn): then the axis n satisfies (n x L) I^-1 mean = 0, which is what the energies at both ends differ by,
// so that every turn keeps it, however far it goes. What a lane does never depends on its neighbours; only work that no
// lane of a block asks for is left out. A turn of many parts is rounded once: at 1000 rad/s about the middle axis the
// parts' rounding took 0.02 % of the energy a minute.
template <int W>
LENDULET_FORCE_INLINE QuatT<Wide<float, W>> turn_at_constant_L(QuatT<Wide<float, W>> dq, QuatT<Wide<float, W>> q0,
                                                               Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> inverse,
                                                               Vec3T<Wide<float, W>> w, Wide<float, W> anisotropy,
                                                               const SymMat3T<Wide<float, W>>& I, float h) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f), two = splat<F>(2.0f);
    auto given = (inverse.x + inverse.y + inverse.z) <= zero;
    Vec3T<F> rate = unless_still(select(given, w, I * L), still_spin);
    F wish2 = splat<F>(4.0f * h * h) * dot(rate, rate) * (anisotropy * anisotropy);  // squared
    F iterations =
        select(wish2 > splat<F>(calm * calm), select(wish2 > splat<F>(lively * lively), splat<F>(3.0f), one), zero);
    iterations = select(anisotropy <= one, zero, iterations);  // about a fixed axis L gives the velocity at once
    F symmetric = zero;
    QuatT<F> turned{};
    if (mask_bits(anisotropy > one)) {
        const Symmetry<F> body(inverse);
        symmetric = select(anisotropy > one, select(given, zero, body.found), zero);
        iterations = select(symmetric > zero, zero, iterations);
        if (mask_bits(symmetric > zero)) {
            const F size2 = dot(L, L) * (body.along * body.along + body.across * body.across);
            turned = turn_symmetric(dq, q0, L, body, h, mask_bits(splat<F>(h * h) * size2 > one) != 0);
        }
    }
    if (mask_bits(symmetric > zero) == (1u << W) - 1) return normalized(turned);
    wish2 = select(symmetric > zero, zero, wish2);
    F parts = one;
    const bool some_quick = mask_bits(wish2 > splat<F>(quick * quick)) != 0;
    if (some_quick) {
        // |L| and the least moment do not change while it tumbles, |w| does.
        F most = maximum(maximum(inverse.x, inverse.y), inverse.z);
        F steady =
            splat<F>(2.0f * h) * select(given, square_root(dot(w, w)) * anisotropy, square_root(dot(L, L)) * most);
        steady = select(symmetric > zero, zero, steady);
        const QuatT<F> d = multiply(long_turn_less_one(splat<F>(h) * rate), dq);
        auto evenly = select(anisotropy > one, zero, select(given, zero, one)) > zero;  // about its axis, however far
        turned = select(evenly, QuatT<F>{dq.x + d.x, dq.y + d.y, dq.z + d.z, dq.w + d.w}, turned);
        symmetric = select(evenly, one, symmetric);
        steady = select(evenly, zero, steady);
        iterations = select(steady > splat<F>(quick), select(anisotropy > one, splat<F>(6.0f), zero), iterations);
        for (int i = 1; i < max_turn_parts; i *= 2)
            parts = select(steady > splat<F>(most_wish) * parts, parts + parts, parts);
    }
    F step = splat<F>(h) / parts;
    auto tumbles = select(anisotropy > one, wish2, zero) > splat<F>(slow * slow);
    if (mask_bits(tumbles)) rate = select(tumbles, rate + (splat<F>(0.5f) * step) * (I * cross(L, rate)), rate);
    QuatT<F> q = dq, low{zero, zero, zero, zero};
    for (float part = 0.0f; mask_bits(splat<F>(part) < parts); part += 1.0f) {
        auto active = splat<F>(part) < parts;
        F half = splat<F>(0.5f) * step;
        if (part > 0.0f) rate = select(given, w, apply_principal(multiply(q, q0), inverse, L));
        for (float i = 0.0f; mask_bits(splat<F>(i) < iterations); i += 1.0f) {
            Vec3T<F> by = half * rate;
            if (some_quick) by = at_most_a_radian(by);
            QuatT<F> turn = turn_quaternion(by), mid = multiply(turn, q);
            Vec3T<F> axis{turn.x, turn.y, turn.z};
            Vec3T<F> mean = L + two * cross(axis, cross(axis, L));
            Vec3T<F> next = apply_principal(multiply(mid, q0), inverse, mean);
            rate = select(given, w, select(splat<F>(i) < iterations, next, rate));
        }
        Vec3T<F> by = step * rate;
        if (some_quick) by = at_most_a_radian(by);
        QuatT<F> d = multiply(turn_less_one(by), q);
        if (!some_quick) {  // one part, which is not rounded again: the same bits
            q = {q.x + d.x, q.y + d.y, q.z + d.z, q.w + d.w};
            break;
        }
        add_compensated(q.x, low.x, d.x, active);
        add_compensated(q.y, low.y, d.y, active);
        add_compensated(q.z, low.z, d.z, active);
        add_compensated(q.w, low.w, d.w, active);
    }
    return normalized(select(symmetric > zero, turned, q));
}
