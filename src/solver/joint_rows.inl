// Joint rows: W joints of one class side by side, and how they follow the bodies. Part of kernels.inl.
//
// Both bodies get every impulse at one shared world point: half way between the two anchors, or between B's anchor and
// the axis for sliders. Linear and angular momentum are therefore conserved together. Arms, axes and effective masses
// are taken anew in every substep, from the displacement since the start of the step.

template <JointClass C>
struct JointShape {
    static constexpr bool slider = C == JointClass::slider, limited_ball = C == JointClass::limited_ball;
    static constexpr int linear = slider ? 2 : 3;  // locked rows
    static constexpr int angular = C == JointClass::hinge || C == JointClass::driven_hinge ? 2
                                   : slider || C == JointClass::fixed                      ? 3
                                                                                           : 0;
    static constexpr int locked = linear + angular;
    static constexpr int bounded = limited_ball ? 2 : slider || C == JointClass::driven_hinge ? 1 : 0;
    static constexpr bool driven = bounded == 1;  // its one bounded row has motor and spring besides the limit
    // Directions that are kept: the joint frame's y, z and x on A, or a ball joint's axes of swing and twist.
    static constexpr int directions = linear + angular == 3 ? bounded : 3;
};

template <int>
struct NoPart {};

// Rows about the joint frame's axes.
template <int W, JointClass C>
struct JointAxes {
    using F = Wide<float, W>;
    QuatT<F> frame_a, frame_b;                      // joint frame on each body at the start of the step, world
    Vec3T<F> direction[JointShape<C>::directions];  // now, world
    F error[3];                                     // of the locked angular rows, rad
};

// Rows with bounds, each solved with the locked rows held.
template <int W, JointClass C>
struct JointBounds {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    struct Row {
        F coordinate, lower, upper;
        F response[S::locked];  // impulses of the locked rows that hold them still per unit of this row's
        F rate;                 // this row's velocity per unit impulse, locked rows held
        F limit[2];             // impulses of the biased and the relax pass
    } row[S::bounded];
    F coupling;  // velocity of row 1 per unit impulse of row 0, locked rows held
};
template <int W>
struct JointDrive {
    using F = Wide<float, W>;
    F motor_velocity, motor_force, motor[2];
    F stiffness, damping, target, spring_force, spring;
};

template <int W, JointClass C>
struct alignas(64) JointRow : std::conditional_t<(JointShape<C>::directions > 0), JointAxes<W, C>, NoPart<0>>,
                              std::conditional_t<(JointShape<C>::bounded > 0), JointBounds<W, C>, NoPart<1>>,
                              std::conditional_t<JointShape<C>::driven, JointDrive<W>, NoPart<2>> {
    using F = Wide<float, W>;
    static constexpr int locked = JointShape<C>::locked;
    int32_t a[W], b[W];
    Vec3T<F> ra0, rb0, gap0;  // arms of the two anchors and the way from A's to B's, at the start of the step
    Vec3T<F> ra, rb, gap;     // now; the arms are those of the shared point
    Factor<F, locked> mass;
    F impulse[2][locked];  // of the biased pass and of the relax pass
    F bias, leak;          // shares of the gap undone and of the impulse given up in a biased pass
    F relaxation;          // share of its solution that the joint takes in a pass
    F split;               // 1: half of the applied forces' share acts in each pass; 0: all of it in the biased pass
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

// --- how rows follow the bodies

// Axes and errors from the joint frames on both bodies. With q the rotation from frame A to frame B: its vector part is
// half the error of a fixed joint; B's x axis crossed into A's is that of a hinge; the turn of B about A's x axis, or
// the twist of a ball joint by swing-twist decomposition, is 2 atan(x / w), its rate the relative turning along
// (a + b) / (1 + a.b) with the two x axes a, b; the swing is the angle between these, its axis a x b.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void update_axes(JointRow<W, C>& c, QuatT<Wide<float, W>> dqa, QuatT<Wide<float, W>> dqb) {
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
        c.direction[0] = select(size > splat<F>(1e-6f), (one / maximum(size, splat<F>(1e-6f))) * swing, axes.y);
        c.direction[1] = (one / maximum(one + dot(axes.x, xb), splat<F>(0.02f))) * (axes.x + xb);
        c.row[0].coordinate =
            two * arc_tangent2<F>(square_root(q.y * q.y + q.z * q.z), square_root(q.x * q.x + q.w * q.w));
        c.row[1].coordinate = two * arc_tangent2<F>(q.x, q.w);
    } else {
        c.direction[0] = axes.y;
        c.direction[1] = axes.z;
        c.direction[2] = axes.x;
    }
    if constexpr (S::angular == 2) {
        c.error[0] = two * (q.w * q.y - q.x * q.z);
        c.error[1] = two * (q.w * q.z + q.x * q.y);
    } else if constexpr (S::angular == 3) {
        c.error[0] = two * q.y;
        c.error[1] = two * q.z;
        c.error[2] = two * q.x;
    }
    if constexpr (C == JointClass::driven_hinge) c.row[0].coordinate = two * arc_tangent2<F>(q.x, q.w);
    if constexpr (S::bounded > 0 && !S::slider) {
        // Whole turns are counted from the middle of the bounds, so that a range may reach beyond half a turn.
        auto& row = c.row[S::bounded - 1];
        auto bounded = row.upper - row.lower < splat<F>(unlimited);
        F middle = select(bounded, splat<F>(0.5f) * (row.lower + row.upper), zero);
        F x = row.coordinate - middle, whole = splat<F>(2.0f * pi);
        row.coordinate = select(x > splat<F>(pi), row.coordinate - whole,
                                select(x < splat<F>(-pi), row.coordinate + whole, row.coordinate));
    }
}

// Linear row i: along world axes, or along the directions of a slider.
template <int W, JointClass C>
LENDULET_FORCE_INLINE Wide<float, W> along_row(const JointRow<W, C>& c, int i, Vec3T<Wide<float, W>> v) {
    if constexpr (JointShape<C>::slider) return dot(c.direction[i], v);
    else return component_of(v, i);
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE void factor_locked(JointRow<W, C>& c, const PointResponse<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    F k[S::locked][S::locked];
    for (int i = 0; i < S::linear; ++i) {
        Vec3T<F> column;
        if constexpr (S::slider) column = p.linear * c.direction[i];
        else
            column = i == 0   ? Vec3T<F>{p.linear.xx, p.linear.xy, p.linear.xz}
                     : i == 1 ? Vec3T<F>{p.linear.xy, p.linear.yy, p.linear.yz}
                              : Vec3T<F>{p.linear.xz, p.linear.yz, p.linear.zz};
        for (int j = i; j < S::linear; ++j) k[j][i] = along_row<W, C>(c, j, column);
    }
    if constexpr (S::angular > 0)
        for (int j = 0; j < S::angular; ++j) {
            Vec3T<F> slide = p.coupled(c.direction[j]), turn = p.angular * c.direction[j];
            for (int i = 0; i < S::linear; ++i) k[S::linear + j][i] = along_row<W, C>(c, i, slide);
            for (int i = 0; i <= j; ++i) k[S::linear + j][S::linear + i] = dot(c.direction[i], turn);
        }
    c.mass.set(k);
}

// Response of the locked rows to each bounded row, and what is left of its own.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void factor_bounded(JointRow<W, C>& c, const PointResponse<Wide<float, W>>& p) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> slide[S::bounded], turn[S::bounded];
    for (int j = 0; j < S::bounded; ++j) {
        Vec3T<F> u = c.direction[S::limited_ball ? j : 2];
        slide[j] = S::slider ? p.linear * u : p.coupled(u);
        turn[j] = S::slider ? p.turned(u) : p.angular * u;
        auto& row = c.row[j];
        F b[S::locked];
        for (int i = 0; i < S::linear; ++i) b[i] = along_row<W, C>(c, i, slide[j]);
        if constexpr (S::angular > 0)
            for (int i = 0; i < S::angular; ++i) b[S::linear + i] = dot(c.direction[i], turn[j]);
        for (int i = 0; i < S::locked; ++i) row.response[i] = b[i];
        c.mass.solve(row.response);
        F own = S::slider ? dot(u, slide[j]) : dot(u, turn[j]), rest = own;
        for (int i = 0; i < S::locked; ++i) rest = rest - b[i] * row.response[i];
        row.rate = maximum(rest, splat<F>(1e-6f) * own);
        if (j == 1) {
            c.coupling = dot(u, turn[0]);
            for (int i = 0; i < S::locked; ++i) c.coupling = c.coupling - b[i] * c.row[0].response[i];
        }
    }
}

// Brings a row up to date with its bodies. Not inlined: it is called from several passes, and long.
template <int W, JointClass C>
[[gnu::noinline]] void update_joint(JointRow<W, C>& c, const SolverBodies& bodies, const SymMat3T<Wide<float, W>>& IA,
                                    const SymMat3T<Wide<float, W>>& IB, const Wide<float, W>& inverse_masses) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    Vec3T<F> dpa, dpb;
    QuatT<F> dqa, dqb;
    load_displacement<W>(bodies.state.data(), c.a, dpa, dqa);
    load_displacement<W>(bodies.state.data(), c.b, dpb, dqb);
    Vec3T<F> ta = turned_by(dqa, c.ra0), tb = turned_by(dqb, c.rb0);
    c.gap = c.gap0 + ((dpb - dpa) + (tb - ta));
    c.ra = c.ra0 + ta;
    c.rb = c.rb0 + tb;
    if constexpr (S::directions > 0) update_axes<W, C>(c, dqa, dqb);
    Vec3T<F> error = c.gap;
    if constexpr (S::slider) {
        c.row[0].coordinate = dot(c.direction[2], c.gap);
        error = c.gap - c.row[0].coordinate * c.direction[2];
        c.ra = c.ra + (c.gap - error);
    }
    // Half the error to each, but no more than the arms are long: torn joints must not get endless levers.
    F arms = dot(c.ra, c.ra) + dot(c.rb, c.rb), size = dot(error, error);
    F share = select(size > arms, square_root(arms / maximum(size, splat<F>(1e-30f))), splat<F>(1.0f));
    error = (splat<F>(0.5f) * share) * error;
    c.ra = c.ra + error;
    c.rb = c.rb - error;
    auto response = point_response(c.ra, c.rb, IA, IB, inverse_masses);
    factor_locked<W, C>(c, response);
    if constexpr (S::bounded > 0) factor_bounded<W, C>(c, response);
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE JointPair<Wide<float, W>> load_pair(const JointRow<W, C>& c, const SolverBodies& bodies,
                                                          bool with_gyro) {
    JointPair<Wide<float, W>> pair;
    pair.A = load_velocity<W>(bodies.state.data(), c.a);
    pair.B = load_velocity<W>(bodies.state.data(), c.b);
    pair.start_a = load_start<W>(bodies.start.data(), c.a);
    pair.start_b = load_start<W>(bodies.start.data(), c.b);
    pair.IA = load_inertia_and_gyro<W>(bodies, c.a, with_gyro, pair.gyro_a);
    pair.IB = load_inertia_and_gyro<W>(bodies, c.b, with_gyro, pair.gyro_b);
    return pair;
}

// --- from records to rows and back

template <int W>
struct JointQuads {
    static constexpr int stride = sizeof(JointRecord) / sizeof(float);
    Wide<float, W> q[4];
    LENDULET_FORCE_INLINE JointQuads(const JointRecord* records, const int32_t* index, int quad) {
        gather4<W>(floats_of(records), index, stride, 4 * quad, q);
    }
    LENDULET_FORCE_INLINE Vec3T<Wide<float, W>> vector() const { return {q[0], q[1], q[2]}; }
    LENDULET_FORCE_INLINE QuatT<Wide<float, W>> quat() const { return {q[0], q[1], q[2], q[3]}; }
};
enum JointQuad {
    joint_arm_a,
    joint_arm_b,
    joint_frame_a,
    joint_frame_b,
    joint_offset,
    joint_bodies,
    joint_limits,
    joint_spring,
    joint_linear_0,
    joint_angular_0,
    joint_linear_1,
    joint_angular_1,
    joint_spring_impulse
};

// Impulses of the last step, for how the two passes share them now.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void load_impulses(JointRow<W, C>& c, const JointRecord* records, const int32_t* index,
                                         Wide<float, W> was_split) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    const F zero = splat<F>(0.0f), half = splat<F>(0.5f);
    auto share = [&](F& first, F& second) {
        F both = first + second;
        F a = select(c.split > was_split, half * both, select(c.split < was_split, both, first));
        second = select(c.split > was_split, half * both, select(c.split < was_split, zero, second));
        first = a;
    };
    JointQuads<W> l0(records, index, joint_linear_0), a0(records, index, joint_angular_0);
    JointQuads<W> l1(records, index, joint_linear_1), a1(records, index, joint_angular_1);
    for (int i = 0; i < S::locked; ++i) {
        c.impulse[0][i] = i < S::linear ? l0.q[i] : a0.q[i - S::linear];
        c.impulse[1][i] = i < S::linear ? l1.q[i] : a1.q[i - S::linear];
        share(c.impulse[0][i], c.impulse[1][i]);
    }
    if constexpr (S::bounded > 0)
        for (int j = 0; j < S::bounded; ++j) c.row[j].limit[0] = j == 0 ? l0.q[3] : a0.q[3], c.row[j].limit[1] = zero;
    if constexpr (S::driven) {
        c.motor[0] = l1.q[3];
        c.motor[1] = a1.q[3];
        share(c.motor[0], c.motor[1]);
        c.spring = JointQuads<W>(records, index, joint_spring_impulse).q[0];
        c.spring =
            select(c.split > was_split, half * c.spring, select(c.split < was_split, c.spring + c.spring, c.spring));
    }
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE void prepare_joint(JointRow<W, C>& c, const JointGroup& group, const JointRecord* records,
                                         const SolverBodies& bodies, int first) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    int live = group.count - first < W ? group.count - first : W;
    int32_t index[W];
    F was_split = splat<F>(0.0f);
    for (int l = 0; l < W; ++l) {
        index[l] = static_cast<int32_t>(group.order[first + (l < live ? l : 0)]);
        const JointRecord& r = records[index[l]];
        c.a[l] = l < live ? r.body_a : group.filler;
        c.b[l] = l < live ? r.body_b : group.filler;
        bool alone = (r.flags & joint_alone) != 0;
        set_lane(c.bias, l, alone ? 1.0f : joint_bias);
        set_lane(c.leak, l, alone ? 0.0f : joint_leak);
        set_lane(c.split, l, (r.flags & joint_split) != 0 ? 1.0f : 0.0f);
        set_lane(was_split, l, (r.old_flags & joint_split) != 0 ? 1.0f : 0.0f);
    }
    JointQuads<W> arm_a(records, index, joint_arm_a), arm_b(records, index, joint_arm_b),
        offset(records, index, joint_offset);
    F qa[4], qb[4];
    constexpr int motion_stride = sizeof(BodyMotion) / sizeof(float);
    gather4<W>(floats_of(bodies.motion.data()), c.a, motion_stride, 0, qa);
    gather4<W>(floats_of(bodies.motion.data()), c.b, motion_stride, 0, qb);
    QuatT<F> q0a{qa[0], qa[1], qa[2], qa[3]}, q0b{qb[0], qb[1], qb[2], qb[3]};
    c.ra0 = rotate(q0a, arm_a.vector());
    c.rb0 = rotate(q0b, arm_b.vector());
    c.gap0 = offset.vector() + (c.rb0 - c.ra0);
    load_impulses<W, C>(c, records, index, was_split);
    if constexpr (S::directions > 0) {
        c.frame_a = multiply(q0a, JointQuads<W>(records, index, joint_frame_a).quat());
        c.frame_b = multiply(q0b, JointQuads<W>(records, index, joint_frame_b).quat());
    }
    JointQuads<W> limits(records, index, joint_limits);
    c.relaxation = limits.q[2];
    if constexpr (S::bounded > 0) {
        c.row[S::bounded - 1].lower = limits.q[0];
        c.row[S::bounded - 1].upper = limits.q[1];
        if constexpr (S::limited_ball) c.row[0].lower = splat<F>(-unlimited), c.row[0].upper = arm_a.q[3];
    }
    if constexpr (S::driven) {
        JointQuads<W> spring(records, index, joint_spring);
        c.motor_velocity = arm_b.q[3];
        c.motor_force = offset.q[3];
        c.stiffness = spring.q[0], c.damping = spring.q[1], c.target = spring.q[2], c.spring_force = spring.q[3];
    }
    for (int l = live; l < W; ++l) {  // empty lanes carry nothing
        for (int set = 0; set < 2; ++set)
            for (F& x : c.impulse[set]) set_lane(x, l, 0.0f);
        if constexpr (S::bounded > 0)
            for (auto& row : c.row) set_lane(row.limit[0], l, 0.0f);
        if constexpr (S::driven)
            set_lane(c.motor[0], l, 0.0f), set_lane(c.motor[1], l, 0.0f), set_lane(c.spring, l, 0.0f);
    }
    JointPair<F> pair = load_pair<W, C>(c, bodies, false);
    update_joint<W, C>(c, bodies, pair.IA, pair.IB, pair.A.inverse_mass + pair.B.inverse_mass);
}
