// Joints: checks, adding and removing, what they report, and their way into the solver's records and back.
#include <string>

#include "base/hash.h"
#include "solver/joints/joint.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr size_t max_name = 255;
constexpr float turn = 2.0f * pi;

Error refused(ErrorCode code, const char* call, std::string what) {
    return {code, std::string(call) + ": " + std::move(what)};
}
Error bad_joint(const char* call, std::string what) { return refused(ErrorCode::bad_joint, call, std::move(what)); }

// --- checks

Status check_bodies(const WorldData& world, BodyId a, BodyId b, const char* call) {
    if (!world.bodies.alive(a)) return no_such(world.bodies.slots, a.generation, call, "body A");
    if (!world.bodies.alive(b)) return no_such(world.bodies.slots, b.generation, call, "body B");
    if (a == b) return bad_joint(call, "body A and body B are the same");
    auto moved = [&](BodyId id) { return world.bodies.info[id.index].type == BodyType::dynamic; };
    if (!moved(a) && !moved(b))
        return refused(ErrorCode::no_dynamic_body, call, "neither body is dynamic, so the joint could move nothing");
    return {};
}

Result<Transform> check_frame(const Transform& frame, const char* name, const char* call) {
    if (!is_finite(frame.translation))
        return refused(ErrorCode::non_finite, call, std::string(name) + " must be finite");
    Result<Quat> q = unit_quaternion(frame.rotation, call);
    if (!q) return q.error();
    return Transform{frame.translation, q.value()};
}

// Bounds that are finite, or infinite on their own side; `most` is the widest angle between them, 0 for lengths.
Status check_limit(const Limit& limit, const char* name, float most, const char* call) {
    if (limit.lower != limit.lower || limit.upper != limit.upper)
        return refused(ErrorCode::non_finite, call, std::string(name) + " must be numbers");
    if (limit.free()) {
        if (limit.lower == 1.0f && limit.upper == -1.0f) return {};
        return bad_joint(call, std::string(name) + ": lower bound " + text(limit.lower) + " is above upper bound " +
                                   text(limit.upper));
    }
    if (most > 0.0f &&
        (limit.upper - limit.lower > most || absolute(limit.lower) > turn || absolute(limit.upper) > turn))
        return bad_joint(call, std::string(name) + ": bounds must lie within one turn of 0 and of each other");
    return {};
}

Status check_motor(const Motor& motor, const char* call) {
    if (!is_finite(motor.target_velocity) || motor.max_force != motor.max_force)
        return refused(ErrorCode::non_finite, call, "the motor's velocity and force must be numbers");
    if (motor.max_force < 0.0f)
        return bad_joint(call, "the motor's force is " + text(motor.max_force) + ", must not be negative");
    return {};
}

Status check_spring(const Spring& spring, const char* call) {
    if (!is_finite(spring.stiffness) || !is_finite(spring.damping) || !is_finite(spring.target) ||
        spring.max_force != spring.max_force)
        return refused(ErrorCode::non_finite, call, "the spring's values must be numbers");
    if (spring.stiffness < 0.0f || spring.damping < 0.0f || spring.max_force < 0.0f)
        return bad_joint(call, "the spring's stiffness, damping and force must not be negative");
    return {};
}

Status check_rows(const JointDef& def, const char* call) {
    float widest = def.type == JointType::hinge ? turn : 0.0f;
    if (def.type == JointType::hinge || def.type == JointType::slider) {
        if (Status s = check_limit(def.limit, "limit", widest, call); !s) return s;
        if (Status s = check_motor(def.motor, call); !s) return s;
        if (Status s = check_spring(def.spring, call); !s) return s;
    }
    if (def.type == JointType::ball) {
        if (!(def.swing_limit >= 0.0f))
            return bad_joint(call, "swing limit is " + text(def.swing_limit) + ", must not be negative");
        if (Status s = check_limit(def.twist_limit, "twist limit", turn, call); !s) return s;
    }
    return {};
}

// --- geometry

struct JointPose {
    Pose a, b;  // the joint frame on each body, in the world
};
JointPose joint_pose(const WorldData& world, const JointInfo& j) {
    return {world.bodies.pose[j.body_a] * j.frame_a, world.bodies.pose[j.body_b] * j.frame_b};
}

// Rotation from frame A to frame B as the shorter turn.
Quat relative_rotation(const JointPose& p) {
    Quat q = conjugate(p.a.orientation) * p.b.orientation;
    return q.w < 0.0f ? Quat{-q.x, -q.y, -q.z, -q.w} : q;
}

Vec3 velocity_at(const WorldData& world, uint32_t body, Position point) {
    if (world.bodies.info[body].type == BodyType::fixed) return {};
    return world.bodies.velocity(body) +
           cross(world.bodies.angular_velocity(body), point - world.bodies.pose[body].position);
}

// --- to the solver

JointClass class_of(const JointInfo& j) {
    bool driven = j.motor.max_force > 0.0f || j.spring.stiffness > 0.0f || j.spring.damping > 0.0f;
    switch (j.type) {
        case JointType::ball:
            // A cone without width is a hinge whose angle is the twist.
            if (j.swing_limit == 0.0f) return j.twist_limit.free() ? JointClass::hinge : JointClass::limited_hinge;
            return j.swing_limit <= pi || !j.twist_limit.free() ? JointClass::limited_ball : JointClass::ball;
        case JointType::hinge:
            return driven ? JointClass::driven_hinge : j.limit.free() ? JointClass::hinge : JointClass::limited_hinge;
        case JointType::slider:
            return driven ? JointClass::driven_slider : JointClass::slider;
        case JointType::fixed:
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
    if (ball) return;
    r.motor_velocity = j.motor.target_velocity;
    r.motor_force = minimum(j.motor.max_force, unlimited);
    r.stiffness = j.spring.stiffness;
    r.damping = j.spring.damping;
    r.target = j.spring.target;
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
    return 1.0f / static_cast<float>(1 << c);
}

bool awake(const WorldData& world, uint32_t body) {
    const BodyInfo& info = world.bodies.info[body];
    return info.type == BodyType::dynamic && !info.asleep;
}

// Takes impulses from the records, which are to be made anew.
void drop_records(WorldData& world) {
    for (uint32_t slot : world.active_joints) world.joints.impulses[slot] = joint_impulses(world, slot);
    forget_joint_records(world);
}

// Joints may keep the colliders of their bodies apart.
void joints_changed(WorldData& world, const JointInfo& j) {
    world.movers.joints_changed = world.joints_changed = world.joint_groups_changed = true;
    if (!j.collide_connected) world.rejoined.push_back({j.body_a, j.body_b});
}

void remove_joint_at(WorldData& world, uint32_t slot) {
    const JointInfo& j = world.joints.info[slot];
    wake_body(world, j.body_a);
    wake_body(world, j.body_b);
    drop_records(world);
    joints_changed(world, j);
    world.joints.remove(slot);
}

}  // namespace

// --- the public calls

Result<JointId> World::add_joint(const JointDef& def) {
    constexpr const char* call = "add_joint";
    WorldData& world = *data_;
    if (Status s = check_bodies(world, def.body_a, def.body_b, call); !s) return s.error();
    Result<Transform> a = check_frame(def.frame_a, "frame A", call), b = check_frame(def.frame_b, "frame B", call);
    if (!a) return a.error();
    if (!b) return b.error();
    if (Status s = check_rows(def, call); !s) return s.error();

    JointInfo j;
    j.type = def.type;
    j.collide_connected = def.collide_connected;
    j.body_a = def.body_a.index;
    j.body_b = def.body_b.index;
    j.frame_a = inverse(world.bodies.principal[j.body_a]) * a.value();
    j.frame_b = inverse(world.bodies.principal[j.body_b]) * b.value();
    j.limit = def.limit;
    j.motor = def.motor;
    j.spring = def.spring;
    j.swing_limit = def.swing_limit;
    j.twist_limit = def.twist_limit;
    j.user_data = def.user_data;
    wake_body(world, j.body_a);
    wake_body(world, j.body_b);
    joints_changed(world, j);
    return world.joints.id(world.joints.add(j, def.name.substr(0, max_name)));
}

Status World::remove_joint(JointId id) {
    if (!data_->joints.alive(id)) return no_such(data_->joints.slots, id.generation, "remove_joint", "joint");
    remove_joint_at(*data_, id.index);
    return {};
}

Status World::set_motor(JointId id, Motor motor) {
    constexpr const char* call = "set_motor";
    WorldData& world = *data_;
    if (!world.joints.alive(id)) return no_such(world.joints.slots, id.generation, call, "joint");
    JointInfo& j = world.joints.info[id.index];
    if (j.type != JointType::hinge && j.type != JointType::slider)
        return bad_joint(call, "only hinges and sliders have a motor");
    if (Status s = check_motor(motor, call); !s) return s;
    j.motor = motor;
    world.joints_changed = true;
    wake_body(world, j.body_a);
    wake_body(world, j.body_b);
    return {};
}

Result<JointDef> World::joint_at(JointType type, BodyId a, BodyId b, Position anchor, Vec3 axis) const {
    constexpr const char* call = "joint_at";
    const WorldData& world = *data_;
    if (Status s = check_bodies(world, a, b, call); !s) return s.error();
    if (Status s = valid_position(anchor, call); !s) return s.error();
    if (!is_finite(axis)) return refused(ErrorCode::non_finite, call, "the axis must be finite");
    if (!(max_component(absolute(axis)) > 1e-30f)) return bad_joint(call, "the axis has no length");
    Quat frame = rotation_between({1.0f, 0.0f, 0.0f}, normalize(axis));
    auto on = [&](BodyId id) {
        Pose pose = world.bodies.user_pose(id.index);
        return Transform{to_local(pose, anchor), conjugate(pose.orientation) * frame};
    };
    JointDef def;
    def.type = type;
    def.body_a = a;
    def.body_b = b;
    def.frame_a = on(a);
    def.frame_b = on(b);
    return def;
}

bool World::alive(JointId id) const { return data_->joints.alive(id); }
int World::joint_count() const { return data_->joints.count(); }
JointId World::joint_id(int index) const {
    if (index < 0 || index >= joint_count()) return {};
    return data_->joints.id(data_->joints.slots.in_order(index));
}

JointDef World::joint_def(JointId id) const {
    if (!alive(id)) detail::fail(no_such(data_->joints.slots, id.generation, "joint_def", "joint"));
    const WorldData& world = *data_;
    const JointInfo& j = world.joints.info[id.index];
    JointDef def;
    def.type = j.type;
    def.body_a = world.bodies.id(j.body_a);
    def.body_b = world.bodies.id(j.body_b);
    def.frame_a = world.bodies.principal[j.body_a] * j.frame_a;
    def.frame_b = world.bodies.principal[j.body_b] * j.frame_b;
    def.limit = j.limit;
    def.motor = j.motor;
    def.spring = j.spring;
    def.swing_limit = j.swing_limit;
    def.twist_limit = j.twist_limit;
    def.collide_connected = j.collide_connected;
    def.user_data = j.user_data;
    def.name = world.joints.name[id.index];
    return def;
}

JointState World::joint(JointId id) const {
    if (!alive(id)) detail::fail(no_such(data_->joints.slots, id.generation, "joint", "joint"));
    const WorldData& world = *data_;
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
    if (j.type == JointType::slider || j.type == JointType::fixed)
        s.angular_error = 2.0f * arc_tangent2(length(Vec3{q.x, q.y, q.z}), q.w);
    if (report.h > 0.0f) {
        s.force = (1.0f / report.h) * report.impulse;
        s.torque = (1.0f / report.h) * report.angular_impulse;
    }
    return s;
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
    i.impulse = {r.impulse[0], r.impulse[1], r.impulse[2]};
    i.angular_impulse = {r.angular_impulse[0], r.angular_impulse[1], r.angular_impulse[2]};
    i.h = world.joints_h * substep_share(world, world.joints.record[slot]);
    return i;
}

void forget_joint_records(WorldData& world) {
    for (uint32_t slot : world.active_joints) world.joints.record[slot] = -1;
    world.active_joints.clear();
    world.joint_records.clear();
    world.joints_changed = true;
}

void remove_joints_of(WorldData& world, uint32_t body) {
    for (uint32_t slot = world.joints.first_of(body); slot != no_joint_link; slot = world.joints.first_of(body))
        remove_joint_at(world, slot);
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
    int counts[substep_classes] = {};
    for (uint32_t slot : world.movers.joints)
        if (int c = class_of_joint(joints.info[slot]); c >= 0) ++counts[c];
    int first = 0;
    for (int c = 0; c < substep_classes; ++c) {
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
}

bool same_bodies(const WorldData& world) {
    for (int c = 0; c < substep_classes; ++c)
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
    drop_records(world);
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
            put_impulses(r, last, last.h > 0.0f ? world.joints_h * substep_share(world, i) / last.h : 0.0f);
            world.joint_records[static_cast<size_t>(i)] = r;
        }
    });
    world.fixed_joints.clear();
    for (uint32_t i = 0; i < world.joint_records.size(); ++i)
        if (world.joint_records[i].body_a == static_body || world.joint_records[i].body_b == static_body)
            world.fixed_joints.push_back(i);
    world.joint_bodies.clear();
    world.joint_bodies.append(world.awake.data(), world.awake.size());
    for (int c = 0; c < substep_classes; ++c) world.joint_bodies_ends[c] = world.parts[c].bodies.end;
    world.joints_changed = false;
    return reuse;
}

}  // namespace lendulet
