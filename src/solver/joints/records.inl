// From joint records to rows and back, and what rows take over from the bodies at the start of a step. Part of
// kernels.inl.

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
    joint_bounds,
    joint_bodies,
    joint_spring,
    joint_linear,
    joint_angular,
    joint_drive,
    joint_impulse,
    joint_angular_impulse
};

#include "solver/joints/six_records.inl"

// Impulses of the last step. Those of a split joint stand for half a substep.
template <int W, JointClass C>
LENDULET_FORCE_INLINE void load_impulses(JointRow<W, C>& c, [[maybe_unused]] const JointGroup& g,
                                         const JointRecord* records, const int32_t* index, const int32_t (&live)[W]) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    F scale = splat<F>(0.0f);  // empty lanes carry nothing
    for (int l = 0; l < W; ++l) {
        const JointRecord& r = records[index[l]];
        bool split = (r.flags & joint_split) != 0, was_split = (r.old_flags & joint_split) != 0;
        if (live[l]) set_lane(scale, l, split == was_split ? 1.0f : split ? 0.5f : 2.0f);
    }
    JointQuads<W> linear(records, index, joint_linear), angular(records, index, joint_angular);
    for (int i = 0; i < S::locked; ++i) c.impulse[i] = scale * (i < S::linear ? linear.q[i] : angular.q[i - S::linear]);
    if constexpr (S::six) load_six_impulses<W>(c, g, records, index, scale);
    else if constexpr (S::bounded > 0)
        for (int j = 0; j < S::bounded; ++j) c.row[j].limit = scale * (j == 0 ? linear.q[3] : angular.q[3]);
    if constexpr (S::driven) {
        JointQuads<W> drive(records, index, joint_drive);
        c.motor = scale * drive.q[0];
        c.spring = scale * drive.q[1];
    }
    if constexpr (S::rubs) c.rub = scale * angular.vector();
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE void load_joint(JointRow<W, C>& c, JointFrames<W, C>& frames, const JointGroup& g,
                                      const JointRecord* records, bool with_impulses, int first) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    int32_t index[W], live[W];
    for (int l = 0; l < W; ++l) {
        live[l] = first + l < g.count;
        index[l] = static_cast<int32_t>(g.order[live[l] ? first + l : first]);
        const JointRecord& r = records[index[l]];
        c.a[l] = 8 * (live[l] ? r.body_a : g.filler);
        c.b[l] = 8 * (live[l] ? r.body_b : g.filler);
        bool alone = (r.flags & joint_alone) != 0;
        set_lane(c.bias, l, alone ? 1.0f : joint_bias);
        set_lane(c.leak, l, alone ? 0.0f : joint_leak);
    }
    JointQuads<W> arm_a(records, index, joint_arm_a), arm_b(records, index, joint_arm_b),
        bounds(records, index, joint_bounds);
    frames.arm_a = arm_a.vector();
    frames.arm_b = arm_b.vector();
    c.relaxation = bounds.q[1];
    if constexpr (S::directions > 0) {
        frames.frame_a = JointQuads<W>(records, index, joint_frame_a).quat();
        frames.frame_b = JointQuads<W>(records, index, joint_frame_b).quat();
    }
    if constexpr (S::six) load_six_rows<W>(c, g, records, index, live);
    else if constexpr (S::bounded > 0) {
        c.row[S::bounded - 1].lower = bounds.q[2];
        c.row[S::bounded - 1].upper = bounds.q[3];
        if constexpr (S::limited_ball) c.row[0].lower = splat<F>(-unlimited), c.row[0].upper = arm_a.q[3];
    }
    if constexpr (S::driven) {
        JointQuads<W> spring(records, index, joint_spring);
        c.motor_velocity = arm_b.q[3];
        c.motor_force = bounds.q[0];
        c.stiffness = spring.q[0], c.damping = spring.q[1], c.target = spring.q[2], c.spring_force = spring.q[3];
    }
    if constexpr (S::rubs) c.most_torque = bounds.q[0];
    if (with_impulses) load_impulses<W, C>(c, g, records, index, live);
}

template <int W, JointClass C>
void load_joints(const JointGroup& g, const JointRecord* records, bool with_impulses, int begin, int end) {
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    auto* frames = reinterpret_cast<JointFrames<W, C>*>(g.frames);
    for (int i = begin; i < end; ++i) load_joint<W, C>(rows[i], frames[i], g, records, with_impulses, i * W);
}

// One side at the start of the step: place of the centre, what rounding took from it, and the arm in world axes. The
// anchor on a body that is not packed counts as its centre.
template <class F>
struct JointSide {
    Vec3T<F> x, x_low, arm, v, w;
    QuatT<F> q;
};
template <int W>
LENDULET_FORCE_INLINE JointSide<Wide<float, W>> load_side(const SolverBodies& bodies, const int32_t* place,
                                                          Vec3T<Wide<float, W>> arm, bool moved) {
    using F = Wide<float, W>;
    F q[4], x[8], start[8];
    gather4<W>(floats_of(bodies.motion.data()), place, sizeof(BodyMotion) / 32, 0, q);
    gather8<W>(floats_of(bodies.place.data()), place, sizeof(BodyPlace) / 32, 0, x);
    gather8<W>(floats_of(bodies.start.data()), place, sizeof(BodyStart) / 32, 0, start);
    JointSide<F> s;
    s.x = {x[0], x[1], x[2]};
    s.x_low = {x[4], x[5], x[6]};
    s.v = {start[0], start[1], start[2]};
    s.w = {start[4], start[5], start[6]};
    s.q = {q[0], q[1], q[2], q[3]};
    s.arm = rotate(s.q, arm);
    if (moved) return s;
    for (int l = 0; l < W; ++l) {
        if (place[l] != 8 * static_body) continue;
        set_lane(s.x.x, l, lane(arm.x, l)), set_lane(s.x.y, l, lane(arm.y, l)), set_lane(s.x.z, l, lane(arm.z, l));
        set_lane(s.arm.x, l, 0.0f), set_lane(s.arm.y, l, 0.0f), set_lane(s.arm.z, l, 0.0f);
    }
    return s;
}

template <int W, JointClass C>
LENDULET_FORCE_INLINE void prepare_joint(JointRow<W, C>& c, const JointFrames<W, C>& frames, const JointGroup& g,
                                         const SolverBodies& bodies, float scale) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    JointSide<F> A = load_side<W>(bodies, c.a, frames.arm_a, g.moved_a),
                 B = load_side<W>(bodies, c.b, frames.arm_b, g.moved_b);
    c.ra0 = A.arm;
    c.rb0 = B.arm;
    c.gap0 = ((B.x - A.x) - (B.x_low - A.x_low)) + (B.arm - A.arm);
    c.start_v = B.v - A.v;
    c.start_wa = A.w;
    c.start_wb = B.w;
    if constexpr (S::directions > 0) {
        c.frame_a = multiply(A.q, frames.frame_a);
        c.frame_b = multiply(B.q, frames.frame_b);
    }
    if constexpr (S::driven) c.spring = splat<F>(scale) * c.spring, c.spring_sum = c.spring;
    if constexpr (S::six)
        for (auto& row : c.row) row.spring = splat<F>(scale) * row.spring, row.spring_sum = row.spring;
    c.turn_a = c.turn_b = zero_vector<F>();
    c.linear_sum = zero_vector<F>();
    if constexpr (S::directions > 0) c.angular = c.angular_sum = zero_vector<F>();
    if constexpr (S::along) c.linear = zero_vector<F>();
    if (scale != 1.0f) {
        for (F& x : c.impulse) x = splat<F>(scale) * x;
        if constexpr (S::bounded > 0)
            for (auto& row : c.row) row.limit = splat<F>(scale) * row.limit;
        if constexpr (S::driven) c.motor = splat<F>(scale) * c.motor;
        if constexpr (S::rubs) c.rub = splat<F>(scale) * c.rub;
        if constexpr (S::six)
            for (auto& row : c.row) row.motor = splat<F>(scale) * row.motor;
    }
    F a[4], b[4];
    gather4<W>(floats_of(bodies.state.data()), c.a, sizeof(BodyState) / 32, 0, a);
    gather4<W>(floats_of(bodies.state.data()), c.b, sizeof(BodyState) / 32, 0, b);
    c.share_a = b[3] * inverse_or_zero(a[3] + b[3]);
    // The impulses on the axes of now.
    JointPair<F> still{};
    still.dqa.w = still.dqb.w = splat<F>(1.0f);
    JointGeometry<W, C> o = find_geometry<W, C>(c, still);
    Vec3T<F> linear, angular;
    to_vectors<W, C>(o, held_impulses<W, C>(c), linear, angular);
    c.turn_a = cross(o.ra, linear) + angular;
    c.turn_b = cross(o.rb, linear) + angular;
    if constexpr (S::directions > 0) c.angular = angular;
    if constexpr (S::along) c.linear = linear;
}

template <int W, JointClass C>
void prepare_joints(const JointGroup& g, const SolverBodies& bodies, float scale, int begin, int end) {
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    auto* frames = reinterpret_cast<JointFrames<W, C>*>(g.frames);
    for (int i = begin; i < end; ++i) prepare_joint<W, C>(rows[i], frames[i], g, bodies, scale);
}

// What store_joints() writes, for the full lanes of a block that has empty ones.
template <int W, JointClass C>
void store_lanes(const Wide<float, W> (&quads)[5][4], const uint32_t* order, int count, JointRecord* records) {
    using S = JointShape<C>;
    constexpr int places[5] = {joint_linear, joint_angular, joint_drive, joint_impulse, joint_angular_impulse};
    constexpr bool used[5] = {true, S::angular > 0 || S::bounded > 1, S::driven, true, (S::directions > 0)};
    for (int q = 0; q < 5; ++q) {
        if (!used[q]) continue;
        float lanes[4][W];
        for (int i = 0; i < 4; ++i) store_wide(lanes[i], quads[q][i]);
        for (int l = 0; l < count; ++l) {
            float* to = floats_of(records + order[l]) + 4 * places[q];
            for (int i = 0; i < 4; ++i) to[i] = lanes[i][l];
        }
    }
}

template <int W, JointClass C>
void store_joints(const JointGroup& g, JointRecord* records, int begin, int end) {
    using F = Wide<float, W>;
    using S = JointShape<C>;
    constexpr int stride = sizeof(JointRecord) / sizeof(float);
    const F zero = splat<F>(0.0f);
    auto* rows = reinterpret_cast<JointRow<W, C>*>(g.rows);
    for (int b = begin; b < end; ++b) {
        const JointRow<W, C>& c = rows[b];
        F quads[5][4]{};
        for (int i = 0; i < S::locked; ++i) (i < S::linear ? quads[0][i] : quads[1][i - S::linear]) = c.impulse[i];
        if constexpr (S::six) {
            store_six<W>(c, g, records, b * W);
        } else {
            if constexpr (S::bounded > 0) quads[0][3] = c.row[0].limit;
            if constexpr (S::bounded > 1) quads[1][3] = c.row[1].limit;
        }
        if constexpr (S::rubs) quads[1][0] = c.rub.x, quads[1][1] = c.rub.y, quads[1][2] = c.rub.z;
        if constexpr (S::driven) quads[2][0] = c.motor, quads[2][1] = c.spring;
        Vec3T<F> linear = c.linear_sum, angular = zero_vector<F>();
        if constexpr (S::directions > 0) angular = c.angular_sum;
        quads[3][0] = linear.x, quads[3][1] = linear.y, quads[3][2] = linear.z, quads[3][3] = zero;
        quads[4][0] = angular.x, quads[4][1] = angular.y, quads[4][2] = angular.z, quads[4][3] = zero;
        int last = g.count - b * W;
        if (last < W) {
            store_lanes<W, C>(quads, g.order + b * W, last, records);
            continue;
        }
        int32_t index[W];
        for (int l = 0; l < W; ++l) index[l] = static_cast<int32_t>(g.order[b * W + l]);
        float* base = floats_of(records);
        scatter4<W>(base, index, stride, 4 * joint_linear, quads[0]);
        if (S::angular > 0 || S::bounded > 1) scatter4<W>(base, index, stride, 4 * joint_angular, quads[1]);
        if (S::driven) scatter4<W>(base, index, stride, 4 * joint_drive, quads[2]);
        scatter4<W>(base, index, stride, 4 * joint_impulse, quads[3]);
        if (S::directions > 0) scatter4<W>(base, index, stride, 4 * joint_angular_impulse, quads[4]);
    }
}
