// What joints report: coordinates, errors and forces.
#include "world/joints/geometry.h"
#include "world/validate.h"

namespace lendulet {
namespace {

constexpr Vec3 unit[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};

Vec3 of_axes(uint8_t bits, Vec3 v) {
    return {(bits & 1) != 0 ? v.x : 0.0f, (bits & 2) != 0 ? v.y : 0.0f, (bits & 4) != 0 ? v.z : 0.0f};
}

float lock_error(float x, float w, float at) {
    const SinCos half = sin_cos(0.5f * at);
    return 2.0f * (x * half.cos - w * half.sin);
}

// Of the locked rows of a six-degree joint; of angles as the solver measures them, which no angle makes singular.
void find_errors(const JointAxesInfo& axes, const JointPose& pose, JointState& s) {
    const Quat q = relative_rotation(pose);
    Vec3 off{}, turned{};
    for (int i = 0; i < 3; ++i) {
        const JointAxis &travel = axes.row[i], &angle = axes.row[3 + i];
        if (travel.limit.locked() && travel.limit_stiffness == 0.0f)
            off += (s.coordinates[i] - travel.limit.lower) * unit[i];
        if (angle.limit.locked() && angle.limit_stiffness == 0.0f)
            turned += lock_error(component({q.x, q.y, q.z}, i), q.w, angle.limit.lower) * unit[i];
    }
    s.linear_error = rotate(pose.a.orientation, off);
    s.angular_error = length(turned);
}

void report_rows(const WorldData& world, const JointInfo& j, const JointPose& pose, JointState& s) {
    const JointAxesInfo& axes = world.joints.axes[static_cast<size_t>(j.axes)];
    const JointCoordinates at = joint_coordinates_of(world, j, axes);
    if (j.type == JointType::distance) {
        constexpr int row = static_cast<int>(Coordinate::distance);
        s.position = at.value[row];
        s.velocity = at.rate[row];
        s.linear_error = {};
    } else if (j.type == JointType::six_degrees) {
        for (int i = 0; i < joint_coordinates; ++i) s.coordinates[i] = at.value[i], s.rates[i] = at.rate[i];
        find_errors(axes, pose, s);
    }
}

}  // namespace

Vec3 velocity_at(const WorldData& world, uint32_t body, Position point) {
    if (world.bodies.info[body].type == BodyType::fixed) return {};
    return world.bodies.velocity(body) +
           cross(world.bodies.angular_velocity(body), point - world.bodies.pose[body].position);
}

JointCoordinates joint_coordinates_of(const WorldData& world, const JointInfo& j, const JointAxesInfo& axes) {
    JointCoordinates c;
    const JointPose pose = joint_pose(world, j);
    const Quat q = relative_rotation(pose);
    const Vec3 v{q.x, q.y, q.z};
    auto in_a = [&](Vec3 world_vector) { return rotate_inverse(pose.a.orientation, world_vector); };
    Vec3 travel = in_a(pose.b.position - pose.a.position);
    Vec3 moving = in_a(velocity_at(world, j.body_b, pose.b.position) - velocity_at(world, j.body_a, pose.b.position));
    Vec3 turning = in_a(world.bodies.angular_velocity(j.body_b) - world.bodies.angular_velocity(j.body_a));
    for (int i = 0; i < 3; ++i) {
        float x = component(v, i), size = maximum(q.w * q.w + x * x, 1e-12f);
        Vec3 axis = (1.0f / size) * (q.w * (q.w * unit[i] + cross(v, unit[i])) + x * v);
        c.value[i] = component(travel, i);
        c.rate[i] = component(moving, i);
        c.value[3 + i] = 2.0f * arc_tangent2(x, q.w);
        c.rate[3 + i] = dot(axis, turning);
    }
    if (axes.distance_axes != 0) {
        constexpr int row = static_cast<int>(Coordinate::distance);
        Vec3 way = of_axes(axes.distance_axes, travel);
        c.value[row] = length(way);
        c.rate[row] = c.value[row] > 0.0f ? dot(way, moving) / c.value[row] : 0.0f;
    }
    if (axes.swing_axes != 0) {
        constexpr int row = static_cast<int>(Coordinate::swing);
        Vec3 e = of_axes(static_cast<uint8_t>(7 & ~axes.swing_axes), {1.0f, 1.0f, 1.0f});
        float along = dot(v, e);
        Vec3 axis = along * cross(e, v) + q.w * (v - along * e);
        float size = length(axis);
        c.value[row] = 2.0f * arc_tangent2(square_root(maximum(dot(v, v) - along * along, 0.0f)),
                                           square_root(along * along + q.w * q.w));
        c.rate[row] = size > 0.0f ? dot(axis, turning) / size : 0.0f;
    }
    return c;
}

JointState World::joint(JointId id) const {
    if (!alive(id)) detail::fail(no_such(data().joints.slots, id.generation, "joint", "joint"));
    const WorldData& world = data();
    const JointInfo& j = world.joints.info[id.index];
    const JointImpulses report = joint_impulses(world, id.index);
    JointPose pose = joint_pose(world, j);
    Quat q = relative_rotation(pose);
    Vec3 axis = rotate(pose.a.orientation, Vec3{1.0f, 0.0f, 0.0f});
    Vec3 gap = pose.b.position - pose.a.position;
    Vec3 turning = world.bodies.angular_velocity(j.body_b) - world.bodies.angular_velocity(j.body_a);

    JointState s{};
    s.type = j.type;
    s.body_a = world.bodies.id(j.body_a);
    s.body_b = world.bodies.id(j.body_b);
    s.linear_error = gap;
    float across = square_root(q.y * q.y + q.z * q.z), along = square_root(q.x * q.x + q.w * q.w);
    if (j.type == JointType::hinge) {
        s.position = 2.0f * arc_tangent2(q.x, q.w);
        s.velocity = dot(axis, turning);
        s.angular_error = 2.0f * arc_tangent2(across, along);
    } else if (j.type == JointType::slider) {
        s.position = dot(axis, gap);
        Vec3 sliding = velocity_at(world, j.body_b, pose.b.position) - velocity_at(world, j.body_a, pose.b.position);
        s.velocity = dot(axis, sliding);
        s.linear_error = gap - s.position * axis;
    }
    if (j.axes >= 0) report_rows(world, j, pose, s);
    if (j.type == JointType::slider || j.type == JointType::fixed)
        s.angular_error = 2.0f * arc_tangent2(length(Vec3{q.x, q.y, q.z}), q.w);
    if (report.h > 0.0f) {
        s.force = (1.0f / report.h) * report.impulse;
        s.torque = (1.0f / report.h) * report.angular_impulse;
    }
    return s;
}

}  // namespace lendulet
