// The incident face clipped by the reference face, W pairs side by side. Part of boxes.inl.

// Points this part of the size outside the reference face still count as inside it, so that round-off does not make
// the corners of boxes of equal size come and go.
constexpr float overhang = 2e-4f;
// Tolerances of the choice of points, in parts of the size of the set; see thin_points.
constexpr float equal_depth = 5e-4f, negligible_reach = 1e-3f, score_tie = 1e-4f;
// A point this much above the deepest, in parts of the size, is worth half. What spans far but will not be touched
// within the step must not crowd out what is: a plank on a rim of five corners would turn over the one that is left
// out, touch it, and find another left out in the next step. (Round faces of many corners, which thin_points serves, do
// worse by it.)
constexpr float half_worth = 2.5e-4f;

// The lanes of one of three values by the number 0, 1, 2 in `which`; of `next` and `last` by that number plus 1 and 2.
template <class F>
struct Chooser {
    decltype(F{} == F{}) is_0, is_1;
    LENDULET_FORCE_INLINE explicit Chooser(F which) : is_0(which == splat<F>(0.0f)), is_1(which == splat<F>(1.0f)) {}
    template <class T>
    LENDULET_FORCE_INLINE T at(const T* v) const {
        return select(is_0, v[0], select(is_1, v[1], v[2]));
    }
    template <class T>
    LENDULET_FORCE_INLINE T next(const T* v) const {
        return select(is_0, v[1], select(is_1, v[2], v[0]));
    }
    template <class T>
    LENDULET_FORCE_INLINE T last(const T* v) const {
        return select(is_0, v[2], select(is_1, v[0], v[1]));
    }
};

// The reference face and the incident face in its coordinates: u and v along the reference box's next two axes, w along
// the normal, from the reference box's centre.
template <class F>
struct WideFaces {
    F axis, incident_axis, sign, incident_sign;
    F half_u, half_v, half_w;
    Vec3T<F> centre, edge_1, edge_2;  // of the incident face: centre and half edges along its next two axes
    Vec3T<F> u, v, w;                 // world
};

template <class F>
LENDULET_FORCE_INLINE WideFaces<F> faces_of(const WideBox<F>& reference, const WideBox<F>& incident, Vec3T<F> d,
                                            F axis) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), minus_one = splat<F>(-1.0f);
    WideFaces<F> f;
    Chooser<F> k(axis);
    f.axis = axis;
    Vec3T<F> n = k.at(reference.axis);
    f.u = k.next(reference.axis), f.v = k.last(reference.axis);
    f.half_w = k.at(reference.half), f.half_u = k.next(reference.half), f.half_v = k.last(reference.half);
    F w = dot(n, d);
    f.sign = select(w < zero, minus_one, one);
    f.w = f.sign * n;
    F turn[3];
    Vec3T<F> local[3];
    for (int i = 0; i < 3; ++i) {
        turn[i] = dot(n, incident.axis[i]);
        local[i] = {dot(f.u, incident.axis[i]), dot(f.v, incident.axis[i]), f.sign * turn[i]};
    }
    F n0 = absolute(turn[0]), n1 = absolute(turn[1]), n2 = absolute(turn[2]);
    f.incident_axis = select((n0 >= n1) & (n0 >= n2), zero, select(n1 >= n2, one, splat<F>(2.0f)));
    Chooser<F> j(f.incident_axis);
    f.incident_sign = select(f.sign * j.at(turn) > zero, minus_one, one);
    f.centre = Vec3T<F>{dot(f.u, d), dot(f.v, d), f.sign * w} + (f.incident_sign * j.at(incident.half)) * j.at(local);
    f.edge_1 = j.next(incident.half) * j.next(local);
    f.edge_2 = j.last(incident.half) * j.last(local);
    return f;
}

// Names of a box's features: corners 0..7 by the signs of their coordinates, edges 8..19, faces 20..25. Small whole
// numbers in floats, so that lanes need no second type.
template <class F>
LENDULET_FORCE_INLINE F sign_bit(F s) {
    return select(s > splat<F>(0.0f), splat<F>(1.0f), splat<F>(0.0f));
}
template <class F>
struct BoxNames {
    F next, last;                        // the axes after `axis`
    F weight, next_weight, last_weight;  // 2^axis and so on
    F axis, sign;
    LENDULET_FORCE_INLINE BoxNames(F of_axis, F of_sign) : axis(of_axis), sign(sign_bit(of_sign)) {
        Chooser<F> k(of_axis);
        const F numbers[3] = {splat<F>(0.0f), splat<F>(1.0f), splat<F>(2.0f)};
        const F weights[3] = {splat<F>(1.0f), splat<F>(2.0f), splat<F>(4.0f)};
        next = k.next(numbers), last = k.last(numbers);
        weight = k.at(weights), next_weight = k.next(weights), last_weight = k.last(weights);
    }
    LENDULET_FORCE_INLINE F face() const { return splat<F>(20.0f) + (axis + axis) + sign; }
    // Of the face: the corner with these signs (0 or 1) along the next two axes.
    LENDULET_FORCE_INLINE F corner(float along_next, float along_last) const {
        return sign * weight + splat<F>(along_next) * next_weight + splat<F>(along_last) * last_weight;
    }
    LENDULET_FORCE_INLINE static F edge(F along, F bit_next, F bit_last) {
        return splat<F>(8.0f) + splat<F>(4.0f) * along + bit_next + (bit_last + bit_last);
    }
    // Of the face: the edge along its next axis on one side of its last, and the other way round.
    LENDULET_FORCE_INLINE F edge_along_next(F side) const { return edge(next, side, sign); }
    LENDULET_FORCE_INLINE F edge_along_last(F side) const { return edge(last, sign, side); }
};
// Both features that meet in a point, the reference box's in the upper half.
template <class F>
LENDULET_FORCE_INLINE F name_of_point(F reference, F incident) {
    return splat<F>(65536.0f) * reference + incident;
}

// Candidates: 2 e where incident edge e enters the reference face and 2 e + 1 where it leaves it, 8..11 the corners of
// the reference face that lie within the incident one. Those that are not there are not numbers: no comparison with
// them holds, so that they are neither extremes nor chosen.
template <class F>
struct Candidates {
    F u[12], v[12], separation[12], name[12];

    template <class M>
    LENDULET_FORCE_INLINE void put(int q, M there, F at_u, F at_v, F at_separation, F named) {
        const F absent = splat<F>(__builtin_nanf(""));
        u[q] = select(there, at_u, absent);
        v[q] = select(there, at_v, absent);
        separation[q] = select(there, at_separation, absent);
        name[q] = named;
    }
};

constexpr float corner_1[4] = {1.0f, -1.0f, -1.0f, 1.0f}, corner_2[4] = {1.0f, 1.0f, -1.0f, -1.0f};
constexpr float bit_of(float sign) { return sign > 0.0f ? 1.0f : 0.0f; }

template <class F>
LENDULET_FORCE_INLINE F safe_inverse(F d) {
    F tiny = splat<F>(1e-12f);
    return splat<F>(1.0f) / select(absolute(d) > tiny, d, tiny);
}

// Liang-Barsky: parameters at which each incident edge passes the four sides. Edge e runs from corner e to corner e +
// 1; the corners go round with signs ++, -+, --, +-, so edges 0 and 2 run along edge_1 and the others along edge_2.
template <class F>
LENDULET_FORCE_INLINE void clip_edges(const WideFaces<F>& f, F slack_u, F slack_v, F margin,
                                      const BoxNames<F>& reference, const BoxNames<F>& incident, Candidates<F>& c) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), hu = f.half_u + slack_u, hv = f.half_v + slack_v;
    const Vec3T<F> half_edge[2] = {f.edge_1, f.edge_2};
    F inverse_u[2], inverse_v[2];
    for (int g = 0; g < 2; ++g) {
        inverse_u[g] = safe_inverse(splat<F>(-2.0f) * half_edge[g].x);
        inverse_v[g] = safe_inverse(splat<F>(-2.0f) * half_edge[g].y);
    }
    F face = reference.face();
    for (int e = 0; e < 4; ++e) {
        const int g = e & 1;
        const F direction = splat<F>(e < 2 ? 1.0f : -1.0f);
        Vec3T<F> corner = f.centre + (splat<F>(corner_1[e]) * f.edge_1 + splat<F>(corner_2[e]) * f.edge_2);
        Vec3T<F> along = (splat<F>(-2.0f) * direction) * half_edge[g];
        F iu = direction * inverse_u[g], iv = direction * inverse_v[g];
        F ua = (zero - hu - corner.x) * iu, ub = (hu - corner.x) * iu;
        F va = (zero - hv - corner.y) * iv, vb = (hv - corner.y) * iv;
        F enter_u = minimum(ua, ub), enter_v = minimum(va, vb), leave_u = maximum(ua, ub), leave_v = maximum(va, vb);
        F t0 = maximum(maximum(enter_u, enter_v), zero), t1 = minimum(minimum(leave_u, leave_v), one);
        F incident_edge = g == 0 ? incident.edge_along_next(splat<F>(bit_of(corner_2[e])))
                                 : incident.edge_along_last(splat<F>(bit_of(corner_1[e])));
        // It enters through the side that it runs away from. Its direction says which side that is, also where the
        // crossing itself is lost in round-off.
        F run_u = sign_bit(direction * half_edge[g].x), run_v = sign_bit(direction * half_edge[g].y);
        F enters = select(enter_u > enter_v, reference.edge_along_last(run_u), reference.edge_along_next(run_v));
        F leaves =
            select(leave_u < leave_v, reference.edge_along_last(one - run_u), reference.edge_along_next(one - run_v));
        auto at_corner = (enter_u <= zero) & (enter_v <= zero);
        F corner_name = incident.corner(bit_of(corner_1[e]), bit_of(corner_2[e]));
        auto put = [&](int q, F t, auto valid, F name) {
            F separation = (corner.z + t * along.z) - f.half_w;
            c.put(q, valid & (separation <= margin), corner.x + t * along.x, corner.y + t * along.y, separation, name);
        };
        put(2 * e, t0, t0 <= t1,
            select(at_corner, name_of_point(face, corner_name), name_of_point(enters, incident_edge)));
        put(2 * e + 1, t1, (t0 < t1) & (t1 < one), name_of_point(leaves, incident_edge));
    }
}

template <class F>
LENDULET_FORCE_INLINE void project_corners(const WideFaces<F>& f, F slack, F margin, const BoxNames<F>& reference,
                                           const BoxNames<F>& incident, Candidates<F>& c) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f);
    F determinant = f.edge_1.x * f.edge_2.y - f.edge_1.y * f.edge_2.x;
    auto solvable = absolute(determinant) > splat<F>(1e-30f);
    F inverse = select(solvable, one / select(solvable, determinant, one), zero);
    // Corners on the rim are left to the edges, which are clipped by a slightly larger rectangle.
    F in_1 = one - slack / length(f.edge_1), in_2 = one - slack / length(f.edge_2);
    F face = incident.face();
    for (int e = 0; e < 4; ++e) {
        const int q = 8 + e;
        F u = splat<F>(corner_1[e]) * f.half_u, v = splat<F>(corner_2[e]) * f.half_v;
        F du = u - f.centre.x, dv = v - f.centre.y;
        F p1 = inverse * (du * f.edge_2.y - dv * f.edge_2.x), p2 = inverse * (f.edge_1.x * dv - f.edge_1.y * du);
        F separation = (f.centre.z + p1 * f.edge_1.z + p2 * f.edge_2.z) - f.half_w;
        auto inside = (absolute(p1) < in_1) & (absolute(p2) < in_2) & (separation <= margin);
        c.put(q, inside, u, v, separation,
              name_of_point(reference.corner(bit_of(corner_1[e]), bit_of(corner_2[e])), face));
    }
}

template <class F>
struct ChosenPoint {
    F u, v, separation, name;
};

// The extremes of twelve values by four short chains, which do not wait for each other; what is not a number is passed
// over.
template <class F>
LENDULET_FORCE_INLINE F least_of(const F* x, F beyond) {
    F least[4];
    for (int k = 0; k < 4; ++k) least[k] = minimum(x[8 + k], minimum(x[4 + k], minimum(x[k], beyond)));
    return minimum(minimum(least[0], least[1]), minimum(least[2], least[3]));
}
template <class F>
LENDULET_FORCE_INLINE F most_of(const F* x, F beneath) {
    F most[4];
    for (int k = 0; k < 4; ++k) most[k] = maximum(x[8 + k], maximum(x[4 + k], maximum(x[k], beneath)));
    return maximum(maximum(most[0], most[1]), maximum(most[2], most[3]));
}

// Of `count` candidates from `first` on the one with the largest place, of equal ones the first. By halves: the depth
// of comparisons that wait for each other is that of a tree.
template <class F>
struct PlacedPoint {
    F place;
    ChosenPoint<F> point;
};
template <int first, int count, class F>
LENDULET_FORCE_INLINE PlacedPoint<F> farthest_of(const Candidates<F>& c, const F* places) {
    if constexpr (count == 1) {
        return {places[first], {c.u[first], c.v[first], c.separation[first], c.name[first]}};
    } else {
        const PlacedPoint<F> a = farthest_of<first, count / 2>(c, places);
        const PlacedPoint<F> b = farthest_of<first + count / 2, count - count / 2>(c, places);
        auto later = b.place > a.place;
        return {select(later, b.place, a.place),
                {select(later, b.point.u, a.point.u), select(later, b.point.v, a.point.v),
                 select(later, b.point.separation, a.point.separation), select(later, b.point.name, a.point.name)}};
    }
}

// Of all twelve; a single lane goes through them one by one.
template <class F>
LENDULET_FORCE_INLINE ChosenPoint<F> farthest_of(const Candidates<F>& c, const F* places) {
    if constexpr (lanes_of<F> == 1) {
        int best = 0;
        for (int q = 1; q < 12; ++q)
            if (places[q] > places[best]) best = q;
        return {c.u[best], c.v[best], c.separation[best], c.name[best]};
    } else {
        return farthest_of<0, 12>(c, places).point;
    }
}

// The candidate with the best score, and of those as good the one that is farthest by `place`; see pick() in clip.cpp.
// Returns the score.
template <class F, class Score, class Place>
LENDULET_FORCE_INLINE F pick(const Candidates<F>& c, ChosenPoint<F>& chosen, Score&& score, Place&& place) {
    const F none = splat<F>(lowest_score);
    F scores[12], places[12];
    for (int q = 0; q < 12; ++q) scores[q] = score(q);
    F best = most_of(scores, none), limit = best - splat<F>(score_tie) * absolute(best);
    for (int q = 0; q < 12; ++q) places[q] = select(scores[q] >= limit, place(q), none);
    chosen = farthest_of(c, places);
    return best;
}

// At most four of the candidates, as thin_points chooses but for what they are worth; returns how many.
template <class F>
LENDULET_FORCE_INLINE F choose_points(const Candidates<F>& c, F way, ChosenPoint<F>* p) {
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), huge = splat<F>(3e38f);
    F u0 = least_of(c.u, huge), u1 = most_of(c.u, zero - huge), v0 = least_of(c.v, huge);
    F v1 = most_of(c.v, zero - huge), deepest = least_of(c.separation, huge), along[12], places[12];
    for (int q = 0; q < 12; ++q) along[q] = c.u[q] + splat<F>(0.618034f) * c.v[q];
    auto forward = [&](int q) { return along[q]; };
    auto backward = [&](int q) { return zero - along[q]; };
    auto any = u0 <= u1;
    F size = select(any, maximum(u1 - u0, v1 - v0), zero);
    F part = maximum(splat<F>(half_worth) * size, maximum(way, splat<F>(1e-30f))), worth[12];
    for (int q = 0; q < 12; ++q) worth[q] = part / (part + maximum(c.separation[q] - deepest, zero));
    F limit = deepest + splat<F>(equal_depth) * size, reach = splat<F>(negligible_reach) * size;
    auto twice_area = [&](const ChosenPoint<F>& a, const ChosenPoint<F>& b, int q) {
        return (b.u - a.u) * (c.v[q] - a.v) - (b.v - a.v) * (c.u[q] - a.u);
    };
    for (int q = 0; q < 12; ++q) places[q] = select(c.separation[q] <= limit, along[q], splat<F>(lowest_score));
    p[0] = farthest_of(c, places);
    auto distance = [&](int q) {
        F du = c.u[q] - p[0].u, dv = c.v[q] - p[0].v;
        return worth[q] * (du * du + dv * dv);
    };
    F far = pick(c, p[1], distance, backward);
    F least = reach * square_root(maximum(far, zero));
    auto area = [&](int q) { return worth[q] * absolute(twice_area(p[0], p[1], q)); };
    F third = pick(c, p[2], area, forward);
    F turn = (p[1].u - p[0].u) * (p[2].v - p[0].v) - (p[1].v - p[0].v) * (p[2].u - p[0].u);
    F side = select(turn > zero, splat<F>(-1.0f), one);
    auto outside = [&](int q) {
        F ab = twice_area(p[0], p[1], q), bc = twice_area(p[1], p[2], q), ca = twice_area(p[2], p[0], q);
        return worth[q] * maximum(maximum(side * ab, side * bc), side * ca);
    };
    F fourth = pick(c, p[3], outside, backward);
    F count = select(any, one, zero);
    F second_there = select(far > reach * reach, count, zero);
    F third_there = select(third > least, second_there, zero);
    F fourth_there = select(fourth > least, third_there, zero);
    return count + second_there + third_there + fourth_there;
}
