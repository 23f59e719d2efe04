// Joints' way into the solver's records and back.
#include "world/joints/records.h"

#include <cstring>

#include "base/hash.h"

namespace lendulet {
namespace {

// --- to the solver

JointClass class_of(const JointInfo& j) {
    if (j.axes >= 0) return JointClass::six_degrees;
    const bool rubs = j.friction > 0.0f,
               driven = j.drive().max_force > 0.0f || j.spring.stiffness > 0.0f || j.spring.damping > 0.0f;
    switch (j.type) {
        case JointType::ball:
            // A cone without width is a hinge whose angle is the twist.
            if (j.swing_limit == 0.0f)
                return rubs                   ? JointClass::driven_hinge
                       : j.twist_limit.free() ? JointClass::hinge
                                              : JointClass::limited_hinge;
            if (rubs) return JointClass::rubbing_ball;
            return j.swing_limit <= pi || !j.twist_limit.free() ? JointClass::limited_ball : JointClass::ball;
        case JointType::hinge:
            return driven ? JointClass::driven_hinge : j.limit.free() ? JointClass::hinge : JointClass::limited_hinge;
        case JointType::slider:
            return driven ? JointClass::driven_slider : JointClass::slider;
        case JointType::fixed:
        case JointType::distance:
        case JointType::six_degrees:
            break;
    }
    return JointClass::fixed;
}

void put(float* p, Vec3 v) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }
void put(float* p, Quat q) { p[0] = q.x, p[1] = q.y, p[2] = q.z, p[3] = q.w; }

// One side: those of bodies that are not packed are given in the world.
void put_side(const WorldData& world, uint32_t body, const Transform& frame, float* arm, float* rotation,
              int32_t& index) {
    index = world.bodies.info[body].solver_index;
    if (index == static_body) {
        Pose pose = world.bodies.pose[body] * frame;
        put(arm, from_origin(pose.position));
        put(rotation, pose.orientation);
    } else {
        put(arm, frame.translation);
        put(rotation, frame.rotation);
    }
}
void put_sides(const WorldData& world, const JointInfo& j, JointRecord& r) {
    put_side(world, j.body_a, j.frame_a, r.arm_a, r.frame_a, r.body_a);
    put_side(world, j.body_b, j.frame_b, r.arm_b, r.frame_b, r.body_b);
}

void put_bounds(JointRecord& r, const JointInfo& j) {
    bool ball = j.type == JointType::ball;
    const Limit& limit = ball ? j.twist_limit : j.limit;
    r.lower = limit.free() ? -unlimited : maximum(limit.lower, -unlimited);
    r.upper = limit.free() ? unlimited : minimum(limit.upper, unlimited);
    r.swing_limit = j.swing_limit > pi ? unlimited : j.swing_limit;
    const Motor drive = j.drive();
    r.motor_velocity = drive.target_velocity;
    r.motor_force = minimum(drive.max_force, unlimited);
    if (ball) return;
    r.stiffness = j.spring.stiffness;
    r.damping = j.spring.damping;
    // -k (x - t) - c (x' - u) is the force of a spring to t + c u / k.
    bool pulled = j.spring.stiffness > 0.0f;
    r.target = j.spring.target + (pulled ? j.spring.damping / j.spring.stiffness * j.spring.target_velocity : 0.0f);
    r.spring_force = minimum(j.spring.max_force, unlimited);
}

void put_impulses(JointRecord& r, const JointImpulses& i, float scale) {
    for (int k = 0; k < 3; ++k) {
        r.linear[k] = scale * i.linear[k];
        r.angular[k] = scale * i.angular[k];
    }
    r.limit_0 = scale * i.limit[0];
    r.limit_1 = scale * i.limit[1];
    r.motor = scale * i.motor;
    r.spring = scale * i.spring;
    r.flags = i.flags;
}

const JointAxesInfo& axes_of(const WorldData& world, const JointInfo& j) {
    return world.joints.axes[static_cast<size_t>(j.axes)];
}

// The part of a body whose place among the packed ones is known.
int part_of(const WorldData& world, int32_t solver_body) {
    int c = 0;
    while (solver_body >= world.parts[c].bodies.end) ++c;
    return c;
}
// One over the multiple of the setting's substeps that a joint takes, by its record.
float substep_share(const WorldData& world, int record) {
    int c = 0;
    while (record >= world.parts[c].first_joint + world.parts[c].joint_count) ++c;
    return 1.0f / substep_multiple(c);
}

bool awake(const WorldData& world, uint32_t body) {
    const BodyInfo& info = world.bodies.info[body];
    return info.type == BodyType::dynamic && !info.asleep;
}

}  // namespace

void drop_joint_records(WorldData& world) {
    for (uint32_t slot : world.active_joints) {
        world.joints.impulses[slot] = joint_impulses(world, slot);
        if (int32_t axes = world.joints.info[slot].axes; axes >= 0)
            world.joints.axes[static_cast<size_t>(axes)] = joint_axes_impulses(world, slot);
    }
    forget_joint_records(world);
}

JointImpulses joint_impulses(const WorldData& world, uint32_t slot) {
    if (world.joints.record[slot] < 0) return world.joints.impulses[slot];
    const JointRecord& r = world.joint_records[static_cast<size_t>(world.joints.record[slot])];
    JointImpulses i;
    for (int k = 0; k < 3; ++k) {
        i.linear[k] = r.linear[k];
        i.angular[k] = r.angular[k];
    }
    i.limit[0] = r.limit_0;
    i.limit[1] = r.limit_1;
    i.motor = r.motor;
    i.spring = r.spring;
    i.flags = r.flags;
    const float share = substep_share(world, world.joints.record[slot]);
    const float mean = share / static_cast<float>(world.config.solver_steps);
    i.impulse = mean * Vec3{r.impulse[0], r.impulse[1], r.impulse[2]};
    i.angular_impulse = mean * Vec3{r.angular_impulse[0], r.angular_impulse[1], r.angular_impulse[2]};
    i.h = world.joints_h * share;
    return i;
}

JointAxesInfo joint_axes_impulses(const WorldData& world, uint32_t slot) {
    JointAxesInfo info = axes_of(world, world.joints.info[slot]);
    if (world.joints.record[slot] < 0) return info;
    const JointRecord& record = world.joint_records[static_cast<size_t>(world.joints.record[slot])];
    const JointAxesRecord& r = world.joint_axes[static_cast<size_t>(record.axes)];
    for (int i = 0; i < joint_coordinates; ++i) {
        info.limit[i] = r.axis[i].limit;
        info.motor[i] = r.axis[i].motor;
        info.spring[i] = r.axis[i].spring;
    }
    return info;
}

void forget_joint_records(WorldData& world) {
    for (uint32_t slot : world.active_joints) world.joints.record[slot] = -1;
    world.active_joints.clear();
    world.joint_records.clear();
    world.joint_axes.clear();
    world.joints_changed = true;
}

uint64_t hash_joints(const WorldData& world, uint64_t start) {
    uint64_t h = hash_combine(start, world.joints.slots.order().size());
    for (uint32_t slot : world.joints.slots.order()) {
        const JointImpulses i = joint_impulses(world, slot);
        h = hash_floats(h, i.linear, 3);
        h = hash_floats(h, i.angular, 3);
        h = hash_floats(h, i.limit, 2);
        h = hash_floats(h, &i.motor, 1);
        h = hash_floats(h, &i.spring, 1);
        const JointInfo& j = world.joints.info[slot];
        if (j.axes < 0) continue;
        const JointAxesInfo axes = joint_axes_impulses(world, slot);
        h = hash_floats(h, axes.limit, joint_coordinates);
        h = hash_floats(h, axes.motor, joint_coordinates);
        h = hash_floats(h, axes.spring, joint_coordinates);
    }
    return h;
}

// --- stage

namespace {

// What static and kinematic bodies' sides say may have changed.
void renew_sides(WorldData& world) {
    for (uint32_t i : world.fixed_joints)
        put_sides(world, world.joints.info[world.active_joints[i]], world.joint_records[i]);
}

// Awake joints by class of substeps, stably.
void list_joints(WorldData& world) {
    JointStore& joints = world.joints;
    auto class_of_joint = [&](const JointInfo& j) {
        uint32_t moved = awake(world, j.body_a) ? j.body_a : j.body_b;
        return awake(world, moved) ? part_of(world, world.bodies.info[moved].solver_index) : -1;
    };
    int counts[solver_parts] = {};
    for (uint32_t slot : world.movers.joints)
        if (int c = class_of_joint(joints.info[slot]); c >= 0) ++counts[c];
    int first = 0;
    for (int c = 0; c < solver_parts; ++c) {
        world.parts[c].first_joint = first;
        world.parts[c].joint_count = counts[c];
        first += counts[c];
        counts[c] = 0;
    }
    world.active_joints.resize_unset(static_cast<size_t>(first));
    world.joint_records.resize_unset(static_cast<size_t>(first));
    for (uint32_t slot : world.movers.joints) {
        int c = class_of_joint(joints.info[slot]);
        if (c < 0) continue;
        joints.record[slot] = world.parts[c].first_joint + counts[c]++;
        world.active_joints[static_cast<size_t>(joints.record[slot])] = slot;
    }
    int axes = 0;
    for (size_t i = 0; i < world.active_joints.size(); ++i)
        if (joints.info[world.active_joints[i]].axes >= 0) world.joint_records[i].axes = axes++;
    world.joint_axes.resize_unset(static_cast<size_t>(axes));
}

bool same_bodies(const WorldData& world) {
    for (int c = 0; c < solver_parts; ++c)
        if (world.joint_bodies_ends[c] != world.parts[c].bodies.end) return false;
    return world.joint_bodies.size() == world.awake.size() &&
           std::memcmp(world.joint_bodies.data(), world.awake.data(), world.awake.size() * sizeof(uint32_t)) == 0;
}

}  // namespace

JointReuse pack_joints(WorldData& world, float h) {
    JointStore& joints = world.joints;
    if (joints.count() == 0 && world.active_joints.empty()) {
        for (SolverPart& part : world.parts) part.first_joint = part.joint_count = 0;
        return {};
    }
    JointReuse reuse{!world.joints_changed && same_bodies(world), world.joints_h > 0.0f ? h / world.joints_h : 0.0f};
    if (reuse.same) {
        renew_sides(world);
        return reuse;
    }
    drop_joint_records(world);
    list_joints(world);
    world.tasks.for_each(world.active_joints.count(), 256, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            uint32_t slot = world.active_joints[static_cast<size_t>(i)];
            const JointInfo& j = joints.info[slot];
            JointRecord r{};
            put_sides(world, j, r);
            r.type = class_of(j);
            put_bounds(r, j);
            const JointImpulses& last = joints.impulses[slot];
            const float scale = last.h > 0.0f ? world.joints_h * substep_share(world, i) / last.h : 0.0f;
            put_impulses(r, last, scale);
            if (j.axes >= 0) {
                r.axes = world.joint_records[static_cast<size_t>(i)].axes;
                world.joint_axes[static_cast<size_t>(r.axes)] = axes_record(axes_of(world, j), scale);
            }
            world.joint_records[static_cast<size_t>(i)] = r;
        }
    });
    world.fixed_joints.clear();
    for (uint32_t i = 0; i < world.joint_records.size(); ++i)
        if (world.joint_records[i].body_a == static_body || world.joint_records[i].body_b == static_body)
            world.fixed_joints.push_back(i);
    world.joint_bodies.clear();
    world.joint_bodies.append(world.awake.data(), world.awake.size());
    for (int c = 0; c < solver_parts; ++c) world.joint_bodies_ends[c] = world.parts[c].bodies.end;
    world.joints_changed = false;
    return reuse;
}

}  // namespace lendulet
