// Coordinates and directions of six-degree joints. Part of kernels.inl.
//
// Travel is where B's origin is along the axes of the joint frame on A, e_x, e_y, e_z. With q = (v, w) the rotation
// from frame A to frame B and u the velocity with which B turns relative to A, both in that frame, v' = (w u + u x v) /
// 2 and w' = -(u . v) / 2. From these follow
//   the turn about axis i,  2 atan(v_i / w):  its rate is d . u with d = (w^2 e_i + w v x e_i + v_i v) / (w^2 + v_i^2);
//   a lock of that turn at the angle p:  e = 2 (v_i cos(p/2) - w sin(p/2)) = 0,  e' = d . u with
//                                        d = cos(p/2) (w e_i + v x e_i) + sin(p/2) v.
// The second one is linear in q, so it has no singular place, no curvature of its own where it holds, and with the sign
// of q both e and d change: it is not to be made positive, or impulses kept along d would turn round at half a turn.
// The angle about several axes is that between the remaining axis on A and on B, or with all three the whole turn; its
// axis is that of the shortest turn.

template <int W>
using SixRow = JointRow<W, JointClass::six_degrees>;
template <int W>
using SixGeometry = JointGeometry<W, JointClass::six_degrees>;

template <class F>
LENDULET_FORCE_INLINE void set_component(Vec3T<F>& v, int i, F x) {
    (i == 0 ? v.x : i == 1 ? v.y : v.z) = x;
}
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> unit_vector(int i) {
    Vec3T<F> e = zero_vector<F>();
    set_component(e, i, splat<F>(1.0f));
    return e;
}
// What of v lies along axes with flags.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> along_flags(const F (&flag)[3], Vec3T<F> v) {
    return {flag[0] * v.x, flag[1] * v.y, flag[2] * v.z};
}
// v divided by its length, and nothing where that is too short to tell a direction.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> direction_of(Vec3T<F> v, F size) {
    F scale = select(size > splat<F>(1e-6f), splat<F>(1.0f) / maximum(size, splat<F>(1e-6f)), splat<F>(0.0f));
    return scale * v;
}

// Square of the cosine of half the angle between an axis on A and on B, below which the turn about it is not known: 154
// degrees.
inline constexpr float least_turn_known = 0.05f;

// Turn about axis i as the locked or the bounded row has it.
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> turning_axis(SixGeometry<W>& o, const SixRow<W>& c, int i,
                                                         QuatT<Wide<float, W>> q) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), two = splat<F>(2.0f);
    Vec3T<F> v{q.x, q.y, q.z}, e = unit_vector<F>(i), across = cross(v, e);
    F x = component_of(v, i);
    o.error[i] = two * (x * c.cosine[i] - q.w * c.sine[i]);
    Vec3T<F> locked = c.cosine[i] * (q.w * e + across) + c.sine[i] * v;
    auto holds = c.locked[3 + i] > zero;
    if ((c.used >> (3 + i) & 1) == 0) return select(holds, locked, zero_vector<F>());
    auto& row = c.row[3 + i];
    // Where the axis has swung round to the other side there is no telling how far it is turned about: the turn jumps,
    // and bounds that followed it would drive the bodies.
    const F known = q.w * q.w + x * x;
    Vec3T<F> bounded = (one / maximum(known, splat<F>(least_turn_known))) * (q.w * (q.w * e + across) + x * v);
    auto told = (row.used > zero) & (known > splat<F>(least_turn_known));
    auto turned = q.w < zero;
    F angle = two * arc_tangent2<F>(select(turned, zero - x, x), select(turned, zero - q.w, q.w));
    // Whole turns are counted from the middle of the bounds, so that a range may reach beyond half a turn.
    auto ranged = row.upper - row.lower < splat<F>(unlimited);
    F middle = select(ranged, splat<F>(0.5f) * (row.lower + row.upper), zero), whole = splat<F>(2.0f * pi);
    F from = angle - middle;
    o.coordinate[3 + i] =
        select(from > splat<F>(pi), angle - whole, select(from < splat<F>(-pi), angle + whole, angle));
    return select(holds, locked, select(told, bounded, zero_vector<F>()));
}

template <int W>
LENDULET_FORCE_INLINE void find_six_axes(SixGeometry<W>& o, const SixRow<W>& c, QuatT<Wide<float, W>> dqa,
                                         QuatT<Wide<float, W>> dqb) {
    using F = Wide<float, W>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), two = splat<F>(2.0f);
    QuatT<F> qa = multiply(dqa, c.frame_a), qb = multiply(dqb, c.frame_b), q = multiply(conjugate(qa), qb);
    Mat3T<F> axes = rotation_matrix<F>(qa, one);
    auto to_world = [&](Vec3T<F> v) { return v.x * axes.x + v.y * axes.y + v.z * axes.z; };
    Vec3T<F> travel{dot(axes.x, o.gap), dot(axes.y, o.gap), dot(axes.z, o.gap)};
    o.direction[0] = axes.x;
    o.direction[1] = axes.y;
    o.direction[2] = axes.z;
    for (int i = 0; i < 3; ++i) {
        o.coordinate[i] = component_of(travel, i);
        o.coordinate[3 + i] = zero;
        o.direction[3 + i] = to_world(turning_axis<W>(o, c, i, q));
    }
    o.direction[distance_row] = o.direction[swing_row] = zero_vector<F>();
    o.coordinate[distance_row] = o.coordinate[swing_row] = zero;
    if ((c.used >> distance_row & 1) != 0) {
        Vec3T<F> way = along_flags(c.distance_axes, travel);
        F size = length(way);
        o.coordinate[distance_row] = size;
        o.direction[distance_row] =
            select(c.row[distance_row].used > zero, to_world(direction_of(way, size)), zero_vector<F>());
    }
    if ((c.used >> swing_row & 1) != 0) {
        // With e the axis that stays about itself, or none: e x R e, or 2 w v.
        F rest[3] = {one - c.swing_axes[0], one - c.swing_axes[1], one - c.swing_axes[2]};
        Vec3T<F> v{q.x, q.y, q.z}, e{rest[0], rest[1], rest[2]};
        F along = dot(v, e);
        Vec3T<F> turn = two * (along * cross(e, v) + q.w * (v - along * e));
        o.coordinate[swing_row] = two * arc_tangent2<F>(square_root(maximum(dot(v, v) - along * along, zero)),
                                                        square_root(along * along + q.w * q.w));
        o.direction[swing_row] =
            select(c.row[swing_row].used > zero, to_world(direction_of(turn, length(turn))), zero_vector<F>());
    }
}

// How far the locked linear axes are off.
template <int W>
LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> locked_gap(const SixGeometry<W>& o, const SixRow<W>& c) {
    Vec3T<Wide<float, W>> sum = zero_vector<Wide<float, W>>();
    for (int i = 0; i < 3; ++i) sum = sum + (c.locked[i] * (o.coordinate[i] - c.held_at[i])) * o.direction[i];
    return sum;
}

// An axis is locked or bounded, so both impulses act along its one direction.
template <int W>
LENDULET_FORCE_INLINE void six_vectors(const SixGeometry<W>& o, const Wide<float, W> (&locked)[6],
                                       const Wide<float, W> (&bounded)[joint_axes], Vec3T<Wide<float, W>>& linear,
                                       Vec3T<Wide<float, W>>& angular) {
    linear = bounded[distance_row] * o.direction[distance_row];
    angular = bounded[swing_row] * o.direction[swing_row];
    for (int i = 0; i < 3; ++i) {
        linear = linear + (locked[i] + bounded[i]) * o.direction[i];
        angular = angular + (locked[3 + i] + bounded[3 + i]) * o.direction[3 + i];
    }
}
