// Joint rows: W joints of one class side by side, and how they follow the bodies. Part of kernels.inl.
//
// Both bodies get every impulse at one shared world point between the two anchors, or between B's anchor and the axis
// for sliders. Linear and angular momentum are therefore conserved together. Arms, axes and effective masses
// are taken anew in every pass, from the displacement since the start of the step; none of them is stored. A ball
// joint's row is 132 bytes a joint.

template <JointClass C>
struct JointShape {
    static constexpr bool slider = C == JointClass::slider || C == JointClass::driven_slider;
    static constexpr bool hinge =
        C == JointClass::hinge || C == JointClass::limited_hinge || C == JointClass::driven_hinge;
    static constexpr bool rubs = C == JointClass::rubbing_ball;  // see rubbing.inl
    static constexpr bool limited_ball = C == JointClass::limited_ball || rubs;
    static constexpr bool six = C == JointClass::six_degrees;  // which rows act is data, see six_degrees.inl
    static constexpr bool along = slider || six;               // linear rows along the joint frame's axes on A
    static constexpr int linear = slider ? 2 : 3;              // locked rows
    static constexpr int angular = hinge ? 2 : slider || six || C == JointClass::fixed ? 3 : 0;
    static constexpr int locked = linear + angular;
    static constexpr int bounded = six                                           ? joint_axes
                                   : limited_ball                                ? 2
                                   : slider || (hinge && C != JointClass::hinge) ? 1
                                                                                 : 0;
    // Its one bounded row has motor and spring besides the limit.
    static constexpr bool driven = C == JointClass::driven_hinge || C == JointClass::driven_slider;
    // Directions: the joint frame's y, z and x on A, or a ball joint's axes of swing and twist; a six-degree joint's
    // are those of its bounded rows, which its locked rows share.
    static constexpr int directions = six ? joint_axes : linear + angular == 3 ? bounded : 3;
    static constexpr int turning = six ? 3 : 0;  // the direction of the first angular row
};

template <int>
struct NoPart {};

// Rows about the joint frame's axes.
template <int W>
struct JointAxes {
    using F = Wide<float, W>;
    QuatT<F> frame_a, frame_b;  // joint frame on each body at the start of the step, world
    Vec3T<F> angular;           // angular impulse on B that is in the bodies' velocities
    Vec3T<F> angular_sum;       // and all of it since the start of the step
};
template <int W>
struct JointTravel {
    Vec3T<Wide<float, W>> linear;  // the same for the linear impulse, where rows are not along world axes
};
// Rows with bounds, each solved with the locked rows held.
template <int W, int N>
struct JointBounds {
    using F = Wide<float, W>;
    struct Row {
        F lower, upper;
        F limit;  // impulse
    } row[N];
};
template <int W>
struct JointDrive {
    using F = Wide<float, W>;
    F motor_velocity, motor_force, motor;
    F stiffness, damping, target, spring_force;
    F spring;      // impulse over the half substep of the last drift, over a whole one where the kick is not split
    F spring_sum;  // and of all that is in the bodies' velocities
};

// Friction about all axes.
template <int W>
struct JointRub {
    Wide<float, W> most_torque;
    Vec3T<Wide<float, W>> rub;  // angular impulse on B, world axes
};

// Rows of a six-degree joint. Flags are 1 or 0.
template <int W>
struct JointSix {
    using F = Wide<float, W>;
    F locked[6];
    F held_at[3], cosine[3], sine[3];  // where: travel, and half the angle
    F distance_axes[3], swing_axes[3];
    struct Row {
        F used;
        F lower, upper, limit_stiffness, limit_damping;
        F motor_velocity, motor_force;
        F stiffness, damping, target, target_velocity, spring_force;
        F limit, motor, spring, spring_sum;  // impulses, as in JointDrive; `spring` with that of a soft bound
    } row[joint_axes];
    uint32_t used;  // bits of the rows that any lane uses
};

template <int W, JointClass C>
struct alignas(64) JointRow
    : std::conditional_t<(JointShape<C>::directions > 0), JointAxes<W>, NoPart<0>>,
      std::conditional_t<JointShape<C>::along, JointTravel<W>, NoPart<1>>,
      std::conditional_t<
          JointShape<C>::six, JointSix<W>,
          std::conditional_t<(JointShape<C>::bounded > 0), JointBounds<W, JointShape<C>::bounded>, NoPart<2>>>,
      std::conditional_t<JointShape<C>::driven, JointDrive<W>, NoPart<3>>,
      std::conditional_t<JointShape<C>::rubs, JointRub<W>, NoPart<4>> {
    using F = Wide<float, W>;
    int32_t a[W], b[W];                    // eight times the body's index, as in contact rows
    Vec3T<F> ra0, rb0, gap0;               // arms of the two anchors and the way from A's to B's, ...
    Vec3T<F> start_v, start_wa, start_wb;  // ... velocity of B relative to A and spins, at the start of the step
    Vec3T<F> turn_a, turn_b;               // angular impulses about their centres that both bodies' velocities hold
    Vec3T<F> linear_sum;                   // impulse on B since the start of the step
    F impulse[JointShape<C>::locked];
    F bias, leak;  // shares of the gap undone and of the impulse given up in a biased pass
    F relaxation;  // share of its solution that the joint takes in a pass
    F share_a;     // share of a gap between the anchors by which the shared point is off A's
};
static_assert(sizeof(JointRow<16, JointClass::ball>) == 16 * 144);

// Joint frames on the bodies as the records give them.
template <int W, JointClass C>
struct alignas(64) JointFrames {
    using F = Wide<float, W>;
    Vec3T<F> arm_a, arm_b;
    QuatT<F> frame_a, frame_b;
};

// A row's axes, errors and coordinates now.
template <int W, JointClass C>
struct JointGeometry {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> ra, rb, gap;  // the arms are those of the shared point
    Vec3T<F> direction[S::directions > 0 ? S::directions : 1];
    F error[S::angular > 0 ? S::angular : 1];  // of the locked angular rows, rad
    F coordinate[S::bounded > 0 ? S::bounded : 1];
};

template <class F>
LENDULET_FORCE_INLINE F component_of(Vec3T<F> v, int i) {
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}
// R(dq) r - r, without the cancellation of computing the rotated arm first.
template <class F>
LENDULET_FORCE_INLINE Vec3T<F> turned_by(QuatT<F> dq, Vec3T<F> r) {
    return turned_back(conjugate(dq), r);
}

#include "solver/joints/six_degrees.inl"

// Axes and errors from the joint frames on both bodies. With q the rotation from frame A to frame B: its vector part is
// half the error of a fixed joint; B's x axis crossed into A's is that of a hinge; the turn of B about A's x axis, or
// the twist of a ball joint by swing-twist decomposition, is 2 atan(x / w), its rate the relative turning along
// (a + b) / (1 + a.b) with the two x axes a, b; the swing is the angle between these, its axis a x b.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void find_axes(JointGeometry<W, C>& o, const JointRow<W, C>& c, QuatT<Wide<float, W>> dqa,
                                     QuatT<Wide<float, W>> dqb) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const F zero = splat<F>(0.0f), one = splat<F>(1.0f), two = splat<F>(2.0f);
    QuatT<F> qa = multiply(dqa, c.frame_a), qb = multiply(dqb, c.frame_b), q = multiply(conjugate(qa), qb);
    auto far_side = q.w < zero;
    q = select(far_side, QuatT<F>{-q.x, -q.y, -q.z, -q.w}, q);
    Mat3T<F> axes = rotation_matrix<F>(qa, one);
    if constexpr (S::limited_ball) {
        Vec3T<F> xb = rotation_matrix<F>(qb, one).x, swing = cross(axes.x, xb);
        F size = length(swing);
        o.direction[0] = select(size > splat<F>(1e-6f), (one / maximum(size, splat<F>(1e-6f))) * swing, axes.y);
        const F known = one + dot(axes.x, xb), least = splat<F>(2.0f * least_turn_known);
        o.direction[1] = select(known > least, (one / maximum(known, least)) * (axes.x + xb), zero_vector<F>());
        o.coordinate[0] = two * arc_tangent2<F>(square_root(q.y * q.y + q.z * q.z), square_root(q.x * q.x + q.w * q.w));
    } else {
        o.direction[0] = axes.y;
        o.direction[1] = axes.z;
        o.direction[2] = axes.x;
    }
    if constexpr (S::angular == 2) {
        o.error[0] = two * (q.w * q.y - q.x * q.z);
        o.error[1] = two * (q.w * q.z + q.x * q.y);
    } else if constexpr (S::angular == 3) {
        o.error[0] = two * q.y;
        o.error[1] = two * q.z;
        o.error[2] = two * q.x;
    }
    if constexpr (S::bounded > 0 && !S::slider) {
        // Whole turns are counted from the middle of the bounds, so that a range may reach beyond half a turn.
        constexpr int i = S::bounded - 1;
        F angle = two * arc_tangent2<F>(q.x, q.w);
        auto bounded = c.row[i].upper - c.row[i].lower < splat<F>(unlimited);
        F middle = select(bounded, splat<F>(0.5f) * (c.row[i].lower + c.row[i].upper), zero);
        F x = angle - middle, whole = splat<F>(2.0f * pi);
        o.coordinate[i] = select(x > splat<F>(pi), angle - whole, select(x < splat<F>(-pi), angle + whole, angle));
    }
}

// Linear row i: along world axes, or along the directions of a slider or six-degree joint.
template <int W, JointClass C>
LENDULET_FORCE_INLINE Wide<float, W> along_row(const JointGeometry<W, C>& o, int i, Vec3T<Wide<float, W>> v) {
    if constexpr (JointShape<C>::along) return dot(o.direction[i], v);
    else return component_of(v, i);
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE JointGeometry<W, C> find_geometry(const JointRow<W, C>& c, const JointPair<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    JointGeometry<W, C> o;
    Vec3T<F> ta = turned_by(p.dqa, c.ra0), tb = turned_by(p.dqb, c.rb0);
    o.gap = c.gap0 + ((p.dpb - p.dpa) + (tb - ta));
    o.ra = c.ra0 + ta;
    o.rb = c.rb0 + tb;
    if constexpr (S::six) find_six_axes<W>(o, c, p.dqa, p.dqb);
    else if constexpr (S::directions > 0) find_axes<W, C>(o, c, p.dqa, p.dqb);
    Vec3T<F> error = o.gap;
    if constexpr (S::six) {
        error = locked_gap<W>(o, c);
        o.ra = o.ra + (o.gap - error);
    }
    if constexpr (S::slider) {
        o.coordinate[0] = dot(o.direction[2], o.gap);
        error = o.gap - o.coordinate[0] * o.direction[2];
        o.ra = o.ra + (o.gap - error);
    }
    // The shared point is nearer to the lighter body's anchor, and at it where the other one cannot be moved: an arm
    // that a gap has turned away from a spinning body's axis would change its spin. But shares are no longer than the
    // arms: torn joints must not get endless levers.
    F arms = dot(o.ra, o.ra) + dot(o.rb, o.rb), size = dot(error, error), most = splat<F>(1.0f);
    auto torn = size > arms;
    if (mask_bits(torn) != 0) [[unlikely]]
        most = select(torn, square_root(arms / maximum(size, splat<F>(1e-30f))), most);
    o.ra = o.ra + (most * c.share_a) * error;
    o.rb = o.rb - (most * (splat<F>(1.0f) - c.share_a)) * error;
    return o;
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE Factor<Wide<float, W>, JointShape<C>::locked> factor_locked(
    [[maybe_unused]] const JointRow<W, C>& c, const JointGeometry<W, C>& o, const PointResponse<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    F k[S::locked][S::locked];
    for (int i = 0; i < S::linear; ++i) {
        Vec3T<F> column;
        if constexpr (S::along) column = p.linear * o.direction[i];
        else
            column = i == 0   ? Vec3T<F>{p.linear.xx, p.linear.xy, p.linear.xz}
                     : i == 1 ? Vec3T<F>{p.linear.xy, p.linear.yy, p.linear.yz}
                              : Vec3T<F>{p.linear.xz, p.linear.yz, p.linear.zz};
        for (int j = i; j < S::linear; ++j) k[j][i] = along_row<W, C>(o, j, column);
    }
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) {
            Vec3T<F> d = o.direction[S::turning + j], slide = p.coupled(d), turn = p.angular * d;
            for (int i = 0; i < S::linear; ++i) k[S::linear + j][i] = along_row<W, C>(o, i, slide);
            for (int i = 0; i <= j; ++i) k[S::linear + j][S::linear + i] = dot(o.direction[S::turning + i], turn);
        }
    if constexpr (S::six)  // rows that are not locked get no impulse
        for (int j = 0; j < S::locked; ++j)
            for (int i = 0; i <= j; ++i) k[j][i] = (c.locked[i] * c.locked[j]) * k[j][i];
    Factor<F, S::locked> mass;
    mass.set(k);
    return mass;
}

// How a bounded row answers with the locked rows held.
template <int W, JointClass C>
struct BoundedResponse {
    using F = Wide<float, W>;
    F back[JointShape<C>::locked];  // impulses of the locked rows that hold them still, per unit of this row's
    F rate;                         // velocity per unit impulse
    F passed;                       // and per unit impulse of row 0
};
template <int W, JointClass C>
LENDULET_FORCE_INLINE void factor_bounded(const JointGeometry<W, C>& o, const PointResponse<Wide<float, W>>& p,
                                          const Factor<Wide<float, W>, JointShape<C>::locked>& mass,
                                          BoundedResponse<W, C> (&response)[JointShape<C>::bounded]) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> slide[S::bounded], turn[S::bounded];
    for (int j = 0; j < S::bounded; ++j) {
        Vec3T<F> u = o.direction[S::limited_ball ? j : 2];
        slide[j] = S::slider ? p.linear * u : p.coupled(u);
        turn[j] = S::slider ? p.turned(u) : p.angular * u;
        BoundedResponse<W, C>& r = response[j];
        F b[S::locked];
        for (int i = 0; i < S::linear; ++i) b[i] = along_row<W, C>(o, i, slide[j]);
        if constexpr (S::angular > 0)
            for (int i = 0; i < S::angular; ++i) b[S::linear + i] = dot(o.direction[i], turn[j]);
        for (int i = 0; i < S::locked; ++i) r.back[i] = b[i];
        mass.solve(r.back);
        F own = S::slider ? dot(u, slide[j]) : dot(u, turn[j]), rest = own;
        for (int i = 0; i < S::locked; ++i) rest = rest - b[i] * r.back[i];
        r.rate = maximum(rest, splat<F>(1e-6f) * own);
        r.passed = splat<F>(0.0f);
        if (j == 1) {
            r.passed = dot(u, turn[0]);
            for (int i = 0; i < S::locked; ++i) r.passed = r.passed - b[i] * response[0].back[i];
        }
    }
}
