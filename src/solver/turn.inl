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
template <class F>
LENDULET_FORCE_INLINE QuatT<F> normalized(QuatT<F> q) {
    F s = splat<F>(1.0f) / square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

// The turn, or what is left of it at a radian, where the series ends: what spins faster than its parts can follow turns
// by too little, and not by numbers without bounds.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> at_most_a_radian(Vec3T<F> turn) {
    const F size2 = dot(turn, turn), one = splat<F>(1.0f);
    return select(size2 > one, one / square_root(size2), one) * turn;
}

// The same of a turn of any angle up to 10^5 rad, as a whole: sine and cosine of an eighth of it, without whole turns,
// by their series, doubled twice.
template <class F>
LENDULET_FORCE_INLINE QuatT<F> long_turn_quaternion(Vec3T<F> turn) {
    const F one = splat<F>(1.0f), two = splat<F>(2.0f), to_whole = splat<F>(12582912.0f);  // 1.5 * 2^23
    F angle = square_root(dot(turn, turn)), half = splat<F>(0.5f) * angle;
    F turns = (half * splat<F>(0.15915494f) + to_whole) - to_whole;
    F r = (half - turns * splat<F>(6.28125f)) - turns * splat<F>(1.9353072e-3f);  // 2 pi in two parts
    F x = splat<F>(0.25f) * r, y = x * x;
    F s = x * (one +
               y * (splat<F>(-1.0f / 6.0f) +
                    y * (splat<F>(1.0f / 120.0f) + y * (splat<F>(-1.0f / 5040.0f) + y * splat<F>(1.0f / 362880.0f)))));
    F c = one + y * (splat<F>(-0.5f) + y * (splat<F>(1.0f / 24.0f) +
                                            y * (splat<F>(-1.0f / 720.0f) +
                                                 y * (splat<F>(1.0f / 40320.0f) + y * splat<F>(-1.0f / 3628800.0f)))));
    for (int i = 0; i < 2; ++i) {
        F doubled = two * s * c;
        c = one - two * s * s;
        s = doubled;
    }
    F along = select(angle > splat<F>(1e-20f), s / angle, splat<F>(0.5f));
    return {along * turn.x, along * turn.y, along * turn.z, c};
}

// Bodies two of whose principal moments are equal turn by a closed form (Euler 1758): about L at an even rate while the
// axis between goes with them, and about that axis at another.
template <class F>
struct SymmetricTop {
    Vec3T<F> axis;    // principal frame
    F along, across;  // inverse moments
};
template <class F>
LENDULET_FORCE_INLINE auto find_symmetry(Vec3T<F> inverse, SymmetricTop<F>& top) {
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f);
    auto about_x = inverse.y == inverse.z, about_y = inverse.x == inverse.z, about_z = inverse.x == inverse.y;
    F y = select(about_y, one, zero), z = select(about_y, zero, one);
    top.axis = {select(about_x, one, zero), select(about_x, zero, y), select(about_x, zero, z)};
    top.along = select(about_x, inverse.x, select(about_y, inverse.y, inverse.z));
    top.across = select(about_x, inverse.y, inverse.x);
    return about_x | about_y | about_z;
}
template <class F>
LENDULET_FORCE_INLINE QuatT<F> turn_top(QuatT<F> dq, QuatT<F> q0, Vec3T<F> L, const SymmetricTop<F>& top, F h) {
    Vec3T<F> axis = rotate(multiply(dq, q0), top.axis);
    F spin = (top.along - top.across) * dot(L, axis);
    return multiply(long_turn_quaternion((h * top.across) * L), multiply(long_turn_quaternion((h * spin) * axis), dq));
}

inline constexpr int max_turn_parts = 128;
inline constexpr float most_wish = 0.25f;  // of a part
inline constexpr float quick = 0.2f;       // from here on 6 iterations

// Turns dq q0 over h at constant L. The fixed point of the midpoint rule contracts by h |w| anisotropy / 2 an
// iteration, a quarter of the wish below, so fast and slender bodies are turned in parts and with more iterations, and
// slow ones need fewer than four: as many as leave an error below 1e-7 rad. How many parts must not change with |w| as
// a body tumbles: the rule keeps energy because it is the same backwards, and with parts that came and went a box at
// 100 rad/s about its middle axis gained 3 % of it in a minute. Kinematic lanes (no inertia) turn with their given w.
// The middle's inertia is given the mean of L as the body sees it at both ends (as it sees L from the middle, with its
// part across the axis times the cosine of half the turn): then the axis n satisfies (n x L) I^-1 mean = 0, which is
// what the energies at both ends differ by, so that every turn keeps it, however far it goes.
// What a lane does never depends on its neighbours; only work that no lane of a block asks for is left out.
// A turn of many parts is rounded once: at 1000 rad/s about the middle axis the parts' rounding took 0.02 % of the
// energy a minute.
template <int W>
LENDULET_FORCE_INLINE QuatT<Wide<float, W>> turn_at_constant_L(QuatT<Wide<float, W>> dq, QuatT<Wide<float, W>> q0,
                                                               Vec3T<Wide<float, W>> L, Vec3T<Wide<float, W>> inverse,
                                                               Vec3T<Wide<float, W>> w, Wide<float, W> anisotropy,
                                                               float h) {
    using F = Wide<float, W>;
    const F one = splat<F>(1.0f), zero = splat<F>(0.0f), four = splat<F>(4.0f);
    auto given = (inverse.x + inverse.y + inverse.z) <= zero;
    F wish = splat<F>(2.0f * h) * square_root(dot(w, w)) * anisotropy;
    F iterations = select(wish > splat<F>(0.01f), select(wish > splat<F>(0.05f), four, splat<F>(2.0f)), one);
    iterations = select(anisotropy <= one, zero, iterations);  // about a fixed axis L gives the velocity at once
    F parts = one;
    const bool some_quick = mask_bits(wish > splat<F>(quick)) != 0;
    QuatT<F> whole = dq;
    F by_closed_form = zero;
    if (some_quick) {
        // |L| and the least moment do not change while it tumbles, |w| does.
        F most = maximum(maximum(inverse.x, inverse.y), inverse.z);
        F steady = select(given, wish, splat<F>(2.0f * h) * square_root(dot(L, L)) * most);
        iterations = select(steady > splat<F>(quick), select(anisotropy > one, splat<F>(6.0f), zero), iterations);
        SymmetricTop<F> top;
        auto symmetric = find_symmetry(inverse, top);
        by_closed_form = select(symmetric & (steady > splat<F>(quick)), select(given, zero, one), zero);
        if (mask_bits(by_closed_form > zero)) whole = turn_top(dq, q0, L, top, splat<F>(h));
        iterations = select(by_closed_form > zero, zero, iterations);
        steady = select(by_closed_form > zero, zero, steady);
        for (int i = 1; i < max_turn_parts; i *= 2)
            parts = select(steady > splat<F>(most_wish) * parts, parts + parts, parts);
    }
    F step = splat<F>(h) / parts;
    QuatT<F> q = dq, low{zero, zero, zero, zero};
    for (float part = 0.0f; mask_bits(splat<F>(part) < parts); part += 1.0f) {
        auto active = splat<F>(part) < parts;
        F half = splat<F>(0.5f) * step;
        Vec3T<F> rate = select(given, w, apply_principal(multiply(q, q0), inverse, L));
        for (float i = 0.0f; mask_bits(splat<F>(i) < iterations); i += 1.0f) {
            Vec3T<F> by = half * rate;
            if (some_quick) by = at_most_a_radian(by);
            QuatT<F> turn = turn_quaternion(by), mid = multiply(turn, q);
            Vec3T<F> axis{turn.x, turn.y, turn.z};
            Vec3T<F> mean = L + splat<F>(2.0f) * cross(axis, cross(axis, L));
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
    if (some_quick) q = select(by_closed_form > zero, whole, q);
    return normalized(q);
}
