#include "solver/impact_joints.h"

namespace lendulet {
namespace {

// An impact goes through so many joints at most; what is behind them answers as if it were free. Its cost goes with the
// square of their number: with 16 the longest step of a hundred ragdolls that bounce took three times as long.
constexpr int most_joints = 8;
constexpr int most_rows = 7 * most_joints;  // three each way, and a distance
// Joints give way by this share of what they would without each other, so that those that say the same twice, as in
// closed loops, have a solution.
constexpr double give = 1e-5;

Vec3 vector_of(const float* p) { return {p[0], p[1], p[2]}; }
Quat quat_of(const float* p) { return {p[0], p[1], p[2], p[3]}; }

}  // namespace

void ImpactJoints::make_ready(size_t bodies, size_t joints) {
    first_.make_ready(bodies + 1), of_body_.make_ready(2 * joints);
}

// Joints of every body, the last of the list first.
void ImpactJoints::list_joints(int count) {
    listed_ = true;
    first_.assign(static_cast<size_t>(count) + 1, 0);
    auto each = [&](auto&& run) {
        for (int i = 0; i < joints_.count; ++i) {
            const JointRecord& r = joints_.records[i];
            run(r.body_a, static_cast<uint32_t>(i));
            run(r.body_b, static_cast<uint32_t>(i));
        }
    };
    each([&](int32_t body, uint32_t) { ++first_[static_cast<size_t>(body)]; });
    uint32_t sum = 0;
    for (uint32_t& n : first_) n = sum += n;
    of_body_.resize_unset(sum);
    each([&](int32_t body, uint32_t joint) { of_body_[--first_[static_cast<size_t>(body)]] = joint; });
}

int ImpactJoints::find(const SolverBodies& bodies, int32_t body) {
    for (int i = 0; i < bodies_.count(); ++i)
        if (bodies_[static_cast<size_t>(i)].body == body) return i;
    ReachedBody b{};
    b.body = body;
    b.inverse_mass = bodies.state[static_cast<size_t>(body)].inverse_mass;
    bodies_.push_back(b);
    return bodies_.count() - 1;
}

ImpactJoints::JointEnd ImpactJoints::end_of(const SolverBodies& bodies, int body, const float* arm,
                                            const float* frame) const {
    const ReachedBody& b = bodies_[static_cast<size_t>(body)];
    if (b.body == static_body) return {vector_of(arm), {}, quat_of(frame), 0.0f};
    const BodyPlace& p = bodies.place[static_cast<size_t>(b.body)];
    const Quat q = b.dq * quat_of(bodies.motion[static_cast<size_t>(b.body)].q0);
    return {(vector_of(p.x) - vector_of(p.x_low)) + b.dp, rotate(q, vector_of(arm)), q * quat_of(frame),
            b.inverse_mass};
}

// Its locked rows, see joints/rows.inl and six_degrees.inl.
void ImpactJoints::add_joint(const SolverBodies& bodies, const JointRecord& r) {
    Row row{find(bodies, r.body_a), find(bodies, r.body_b), {}, {}, {}};
    const JointEnd A = end_of(bodies, row.a, r.arm_a, r.frame_a), B = end_of(bodies, row.b, r.arm_b, r.frame_b);
    const JointAxesRecord* six = r.type == JointClass::six_degrees ? joints_.axes + r.axes : nullptr;
    const bool slider = r.type == JointClass::slider || r.type == JointClass::driven_slider, along = slider || six;
    const bool ball =
        r.type == JointClass::ball || r.type == JointClass::limited_ball || r.type == JointClass::rubbing_ball;
    const Mat3 axes = rotation_matrix(A.frame);
    const Vec3 axis[3] = {axes.x, axes.y, axes.z};
    // Both bodies get the impulse at one point.
    const Vec3 gap = (B.x + B.arm) - (A.x + A.arm);
    const float share = along ? 1.0f : B.inverse_mass / (A.inverse_mass + B.inverse_mass);
    const Vec3 arm_a = A.arm + share * gap, arm_b = B.arm - (1.0f - share) * gap;
    auto add_linear = [&](Vec3 u) {
        row.along = u, row.turn_a = cross(arm_a, u), row.turn_b = cross(arm_b, u);
        rows_.push_back(row);
    };
    for (int i = slider ? 1 : 0; i < 3; ++i)
        if (!six || (six->locked >> i & 1) != 0) add_linear(axis[i]);
    if (six && (six->used >> distance_row & 1) != 0) {
        const JointAxisRecord& d = six->axis[distance_row];
        Vec3 way;
        for (int i = 0; i < 3; ++i)
            if ((six->distance_axes >> i & 1) != 0) way += dot(gap, axis[i]) * axis[i];
        if (!(d.upper > d.lower) && !(d.limit_stiffness > 0.0f)) add_linear(normalize(way, Vec3{}));
    }
    row.along = {};
    const Quat q = conjugate(A.frame) * B.frame;
    const Vec3 v{q.x, q.y, q.z}, unit[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const bool hinge = !ball && !along && r.type != JointClass::fixed;
    for (int i = hinge ? 1 : 0; i < 3 && !ball; ++i) {
        row.turn_a = row.turn_b = axis[i];
        if (six) {
            if ((six->locked >> (3 + i) & 1) == 0) continue;
            const SinCos half = sin_cos(0.5f * six->held_at[3 + i]);
            const Vec3 u = half.cos * (q.w * unit[i] + cross(v, unit[i])) + half.sin * v;
            row.turn_a = row.turn_b = rotate(A.frame, u);
        }
        rows_.push_back(row);
    }
}

Array<ReachedBody>& ImpactJoints::reach(const SolverBodies& bodies, int32_t a, int32_t b) {
    if (!listed_) list_joints(bodies.count);
    bodies_.clear(), near_.clear();
    find(bodies, a), find(bodies, b);
    for (int i = 0; i < bodies_.count() && near_.count() < most_joints; ++i) {
        const ReachedBody from = bodies_[static_cast<size_t>(i)];
        if (!(from.inverse_mass > 0.0f)) continue;
        const uint32_t *joint = of_body_.data() + first_[static_cast<size_t>(from.body)],
                       *last = of_body_.data() + first_[static_cast<size_t>(from.body) + 1];
        for (; joint < last && near_.count() < most_joints; ++joint) {
            bool known = false;
            for (uint32_t other : near_) known |= other == *joint;
            if (known) continue;
            near_.push_back(*joint);
            find(bodies, joints_.records[*joint].body_a), find(bodies, joints_.records[*joint].body_b);
        }
    }
    return bodies_;
}

void ImpactJoints::lock(const SolverBodies& bodies) {
    rows_.clear();
    // The farthest first: eliminated in this order rows of a tree couple none that did not meet before.
    for (int i = near_.count(); i-- > 0;) add_joint(bodies, joints_.records[near_[static_cast<size_t>(i)]]);
    factor();
}

void ImpactJoints::clear() {
    for (ReachedBody& b : bodies_) b.impulse = b.angular_impulse = {};
}
void ImpactJoints::push(const Row& row, float impulse) {
    ReachedBody &a = bodies_[static_cast<size_t>(row.a)], &b = bodies_[static_cast<size_t>(row.b)];
    a.impulse -= impulse * row.along, a.angular_impulse -= impulse * row.turn_a;
    b.impulse += impulse * row.along, b.angular_impulse += impulse * row.turn_b;
}
void ImpactJoints::push_contact(Vec3 arm_a, Vec3 arm_b, Vec3 impulse) {
    push({0, 1, impulse, cross(arm_a, impulse), cross(arm_b, impulse)}, 1.0f);
}
float ImpactJoints::speed(const Row& row) const {
    const ReachedBody &a = bodies_[static_cast<size_t>(row.a)], &b = bodies_[static_cast<size_t>(row.b)];
    return dot(row.along, b.inverse_mass * b.impulse - a.inverse_mass * a.impulse) +
           dot(row.turn_b, b.inverse_inertia * b.angular_impulse) -
           dot(row.turn_a, a.inverse_inertia * a.angular_impulse);
}

void ImpactJoints::factor() {
    const int n = rows_.count();
    matrix_.assign(static_cast<size_t>(n * n), 0.0);
    for (int j = 0; j < n; ++j) {
        const Row& own = rows_[static_cast<size_t>(j)];
        clear();
        push(own, 1.0f);
        for (int i = j; i < n; ++i) {
            const Row& row = rows_[static_cast<size_t>(i)];
            if (row.a != own.a && row.a != own.b && row.b != own.a && row.b != own.b) continue;
            at(i, j) = static_cast<double>(speed(row)) * (i == j ? 1.0 + give : 1.0);
        }
    }
    int below[most_rows];
    for (int p = 0; p < n; ++p) {
        int count = 0;
        const double inverse = at(p, p) > 0.0 ? 1.0 / at(p, p) : 0.0;
        for (int i = p + 1; i < n; ++i)
            if (at(i, p) != 0.0) below[count++] = i;
        for (int x = 0; x < count; ++x) {
            const double share = at(below[x], p) * inverse;
            for (int y = 0; y <= x; ++y) at(below[x], below[y]) -= share * at(below[y], p);
        }
        for (int x = 0; x < count; ++x) at(below[x], p) *= inverse;
        at(p, p) = inverse;
    }
}

void ImpactJoints::answer_of(Vec3 arm_a, Vec3 arm_b, Vec3 impulse, double* y) {
    clear();
    push_contact(arm_a, arm_b, impulse);
    for (int i = 0; i < rows_.count(); ++i) y[i] = static_cast<double>(speed(rows_[static_cast<size_t>(i)]));
    for (int j = 0; j < rows_.count(); ++j) {
        if (y[j] == 0.0) continue;  // the impact does not get there: only rows of joints near it start
        for (int i = j + 1; i < rows_.count(); ++i) y[i] -= at(i, j) * y[j];
    }
}

float ImpactJoints::held_back(Vec3 arm_a, Vec3 arm_b, Vec3 u, Vec3 w) {
    double x[most_rows], y[most_rows], sum = 0.0;
    answer_of(arm_a, arm_b, u, x);
    answer_of(arm_a, arm_b, w, y);
    for (int i = 0; i < rows_.count(); ++i) sum += x[i] * y[i] * at(i, i);
    return static_cast<float>(sum);
}

const Array<ReachedBody>& ImpactJoints::hand_on(Vec3 arm_a, Vec3 arm_b, Vec3 impulse) {
    double y[most_rows];
    answer_of(arm_a, arm_b, impulse, y);
    for (int i = rows_.count(); i-- > 0;) {
        y[i] *= at(i, i);
        for (int j = i + 1; j < rows_.count(); ++j) y[i] -= at(j, i) * y[j];
        push(rows_[static_cast<size_t>(i)], static_cast<float>(-y[i]));
    }
    return bodies_;
}

}  // namespace lendulet
