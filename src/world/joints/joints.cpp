// Joints through the public interface: adding, setting and removing.
#include <algorithm>

#include "world/joints/checks.h"
#include "world/joints/records.h"
#include "world/validate.h"

namespace lendulet {
namespace {

constexpr size_t max_name = 255;

void drive_was_set(WorldData& world, const JointInfo& j) {
    world.joints_changed = true;
    wake_body(world, j.body_a);
    wake_body(world, j.body_b);
}

// The joint, where it is of a type that has one motor and one spring.
Result<JointInfo*> driven_joint(WorldData& world, JointId id, const char* call) {
    if (!world.joints.alive(id)) return no_such(world.joints.slots, id.generation, call, "joint");
    JointInfo& j = world.joints.info[id.index];
    if (j.type != JointType::hinge && j.type != JointType::slider && j.type != JointType::distance)
        return refused_joint(ErrorCode::bad_joint, call,
                             "only hinges, sliders and distance joints have one motor and spring");
    return &j;
}
// Where such a joint's rows are data, the one that is driven; else null.
JointAxis* driven_axis(WorldData& world, const JointInfo& j) {
    return j.axes < 0 ? nullptr : &world.joints.axes[static_cast<size_t>(j.axes)].row[driven_row(j.type)];
}

// A coordinate that a six-degree joint uses.
Result<JointAxis*> axis_of(WorldData& world, JointId id, Coordinate coordinate, const char* call) {
    if (!world.joints.alive(id)) return no_such(world.joints.slots, id.generation, call, "joint");
    const JointInfo& j = world.joints.info[id.index];
    const int row = static_cast<int>(coordinate);
    if (j.type != JointType::six_degrees || row < 0 || row >= joint_coordinates)
        return refused_joint(ErrorCode::bad_joint, call,
                             "only six-degree joints have motors, springs and friction by coordinate");
    JointAxesInfo& axes = world.joints.axes[static_cast<size_t>(j.axes)];
    if ((coordinate == Coordinate::distance && axes.distance_axes == 0) ||
        (coordinate == Coordinate::swing && axes.swing_axes == 0))
        return refused_joint(ErrorCode::bad_joint, call, "the joint does not use that coordinate");
    return &axes.row[row];
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
    drop_joint_records(world);
    joints_changed(world, j);
    keep_removed_joint(world, slot);
    world.joints.remove(slot);
}

// Whether a joint of the last step broke in it; what it bore then.
bool has_broken(const WorldData& world, uint32_t slot, Vec3& force, Vec3& torque) {
    const JointInfo& j = world.joints.info[slot];
    if (!j.breaks()) return false;
    const JointImpulses i = joint_impulses(world, slot);
    if (!(i.h > 0.0f)) return false;
    force = (1.0f / i.h) * i.impulse;
    torque = (1.0f / i.h) * i.angular_impulse;
    return length(force) > j.break_force || length(torque) > j.break_torque;
}

}  // namespace

Result<JointId> World::add_joint(const JointDef& def) {
    constexpr const char* call = "add_joint";
    WorldData& world = data();
    if (Status s = check_bodies(world, def.body_a, def.body_b, call); !s) return s.error();
    Result<Transform> a = check_frame(def.frame_a, "frame A", call), b = check_frame(def.frame_b, "frame B", call);
    if (!a) return a.error();
    if (!b) return b.error();
    if (Status s = check_rows(def, call); !s) return s.error();
    if (!(def.break_force > 0.0f) || !(def.break_torque > 0.0f))
        return refused_joint(ErrorCode::bad_joint, call, "the force and torque at which it breaks must be positive");

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
    j.friction = def.friction;
    j.swing_limit = def.swing_limit;
    j.twist_limit = def.twist_limit;
    j.break_force = def.break_force;
    j.break_torque = def.break_torque;
    j.user_data = def.user_data;
    const bool has_rows = rows_are_data(j);
    const JointAxesInfo rows = has_rows ? rows_of(def) : JointAxesInfo{};
    wake_body(world, j.body_a);
    wake_body(world, j.body_b);
    joints_changed(world, j);
    return world.joints.id(world.joints.add(j, has_rows ? &rows : nullptr, def.name.substr(0, max_name)));
}

Status World::remove_joint(JointId id) {
    if (!data().joints.alive(id)) return no_such(data().joints.slots, id.generation, "remove_joint", "joint");
    remove_joint_at(data(), id.index);
    return {};
}

Status World::set_motor(JointId id, Motor motor) {
    constexpr const char* call = "set_motor";
    Result<JointInfo*> driven = driven_joint(data(), id, call);
    if (!driven) return driven.error();
    if (Status s = check_motor(motor, call); !s) return s;
    JointInfo& j = *driven.value();
    j.motor = motor;
    if (JointAxis* axis = driven_axis(data(), j)) axis->motor = motor;
    drive_was_set(data(), j);
    return {};
}

Status World::set_motor(JointId id, Coordinate coordinate, Motor motor) {
    constexpr const char* call = "set_motor";
    Result<JointAxis*> axis = axis_of(data(), id, coordinate, call);
    if (!axis) return axis.error();
    if (Status s = check_motor(motor, call); !s) return s;
    axis.value()->motor = motor;
    drive_was_set(data(), data().joints.info[id.index]);
    return {};
}

Status World::set_spring(JointId id, Spring spring) {
    constexpr const char* call = "set_spring";
    Result<JointInfo*> driven = driven_joint(data(), id, call);
    if (!driven) return driven.error();
    if (Status s = check_spring(spring, driven.value()->type == JointType::hinge, call); !s) return s;
    JointInfo& j = *driven.value();
    j.spring = spring;
    if (JointAxis* axis = driven_axis(data(), j)) axis->spring = spring;
    drive_was_set(data(), j);
    return {};
}

Status World::set_spring(JointId id, Coordinate coordinate, Spring spring) {
    constexpr const char* call = "set_spring";
    Result<JointAxis*> axis = axis_of(data(), id, coordinate, call);
    if (!axis) return axis.error();
    const bool turns = coordinate >= Coordinate::about_x && coordinate != Coordinate::distance;
    if (Status s = check_spring(spring, turns, call); !s) return s;
    axis.value()->spring = spring;
    drive_was_set(data(), data().joints.info[id.index]);
    return {};
}

Status World::set_friction(JointId id, float friction) {
    constexpr const char* call = "set_friction";
    WorldData& world = data();
    if (!world.joints.alive(id)) return no_such(world.joints.slots, id.generation, call, "joint");
    JointInfo& j = world.joints.info[id.index];
    if (j.type == JointType::fixed || j.type == JointType::six_degrees)
        return refused_joint(ErrorCode::bad_joint, call,
                             "only hinges, sliders, distance and ball joints have one friction");
    if (Status s = check_joint_friction(friction, call); !s) return s;
    if (j.type == JointType::ball) {
        // Balls are of another class with friction than without, and with no impulse of it left.
        drop_joint_records(world);
        if (!(friction > 0.0f)) {
            JointImpulses& held = world.joints.impulses[id.index];
            if (j.swing_limit > 0.0f) held.angular[0] = held.angular[1] = held.angular[2] = 0.0f;
            held.motor = 0.0f;
        }
    }
    j.friction = friction;
    if (JointAxis* axis = driven_axis(world, j)) axis->friction = friction;
    drive_was_set(world, j);
    return {};
}

Status World::set_friction(JointId id, Coordinate coordinate, float friction) {
    constexpr const char* call = "set_friction";
    Result<JointAxis*> axis = axis_of(data(), id, coordinate, call);
    if (!axis) return axis.error();
    if (Status s = check_joint_friction(friction, call); !s) return s;
    axis.value()->friction = friction;
    drive_was_set(data(), data().joints.info[id.index]);
    return {};
}

namespace {

// The limit of a joint, with `coordinate` or, null, the only one it has, in its definition.
Result<Limit*> limit_in(JointDef& def, const Coordinate* coordinate, const char* call) {
    const bool only = def.type == JointType::hinge || def.type == JointType::slider || def.type == JointType::distance;
    if (!coordinate) {
        if (only) return &def.limit;
        return refused_joint(ErrorCode::bad_joint, call, "only hinges, sliders and distance joints have one limit");
    }
    const int row = static_cast<int>(*coordinate);
    if (def.type == JointType::ball && *coordinate == Coordinate::about_x) return &def.twist_limit;
    if (def.type == JointType::six_degrees && row >= 0 && row < joint_coordinates) {
        JointAxis* const axes[joint_coordinates] = {&def.axes.linear[0],  &def.axes.linear[1],  &def.axes.linear[2],
                                                    &def.axes.angular[0], &def.axes.angular[1], &def.axes.angular[2],
                                                    &def.axes.distance,   &def.axes.swing};
        return &axes[row]->limit;
    }
    return refused_joint(ErrorCode::bad_joint, call, "the joint has no limit of that coordinate");
}

// Which coordinates bounds lock, as bits.
uint32_t locks_of(const JointDef& def) {
    uint32_t bits = def.type == JointType::ball && def.swing_limit == 0.0f ? 1u << 31 : 0u;
    if (def.type != JointType::six_degrees) return bits;
    for (int i = 0; i < 3; ++i)
        bits |= uint32_t{def.axes.linear[i].limit.locked()} << i | uint32_t{def.axes.angular[i].limit.locked()}
                                                                       << (3 + i);
    return bits | uint32_t{def.axes.distance.limit.locked()} << 6 | uint32_t{def.axes.swing.limit.locked()} << 7;
}

// Takes the limits of a definition that was checked. What the old ones held is forgotten, and all that the joint held
// where it locks others now: locks share their impulses.
void take_limits(WorldData& world, uint32_t slot, const JointDef& def, bool relocked) {
    drop_joint_records(world);
    JointInfo& j = world.joints.info[slot];
    if (relocked) world.joints.impulses[slot] = {};
    j.limit = def.limit;
    j.swing_limit = def.swing_limit;
    j.twist_limit = def.twist_limit;
    for (float& x : world.joints.impulses[slot].limit) x = 0.0f;
    world.joint_groups_changed = true;
    drive_was_set(world, j);
    if (j.axes < 0) return;
    JointAxesInfo& axes = world.joints.axes[static_cast<size_t>(j.axes)];
    if (j.type == JointType::six_degrees) {
        const JointAxesInfo rows = rows_of(def);
        for (int i = 0; i < joint_coordinates; ++i) axes.row[i].limit = rows.row[i].limit;
    } else {
        axes.row[driven_row(j.type)].limit = def.limit;
    }
    for (float& x : axes.limit) x = 0.0f;
}

Status set_limit_of(World& world, WorldData& data, JointId id, const Coordinate* coordinate, Limit limit) {
    constexpr const char* call = "set_limit";
    if (!data.joints.alive(id)) return no_such(data.joints.slots, id.generation, call, "joint");
    JointDef def = world.joint_def(id);
    const uint32_t locks = locks_of(def);
    if (def.type == JointType::ball && coordinate && *coordinate == Coordinate::swing) {
        def.swing_limit = limit.free() ? 4.0f : limit.upper;
    } else {
        Result<Limit*> at = limit_in(def, coordinate, call);
        if (!at) return at.error();
        *at.value() = limit;
    }
    if (Status s = check_rows(def, call); !s) return s;
    take_limits(data, id.index, def, locks_of(def) != locks);
    return {};
}

}  // namespace

Status World::set_limit(JointId id, Limit limit) { return set_limit_of(*this, data(), id, nullptr, limit); }
Status World::set_limit(JointId id, Coordinate coordinate, Limit limit) {
    return set_limit_of(*this, data(), id, &coordinate, limit);
}

Result<JointDef> World::joint_at(JointType type, BodyId a, BodyId b, Position anchor, Vec3 axis) const {
    constexpr const char* call = "joint_at";
    const WorldData& world = data();
    if (Status s = check_bodies(world, a, b, call); !s) return s.error();
    if (Status s = valid_position(anchor, call); !s) return s.error();
    if (!is_finite(axis)) return refused_joint(ErrorCode::non_finite, call, "the axis must be finite");
    if (!(max_component(absolute(axis)) > 1e-30f))
        return refused_joint(ErrorCode::bad_joint, call, "the axis has no length");
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

bool World::alive(JointId id) const { return data().joints.alive(id); }
int World::joint_count() const { return data().joints.count(); }
JointId World::joint_id(int index) const {
    if (index < 0 || index >= joint_count()) return {};
    return data().joints.id(data().joints.slots.in_order(index));
}

JointDef World::joint_def(JointId id) const {
    if (!alive(id)) detail::fail(no_such(data().joints.slots, id.generation, "joint_def", "joint"));
    const WorldData& world = data();
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
    def.friction = j.friction;
    def.swing_limit = j.swing_limit;
    def.twist_limit = j.twist_limit;
    if (j.type == JointType::six_degrees) def.axes = coordinates_of(world.joints.axes[static_cast<size_t>(j.axes)]);
    def.collide_connected = j.collide_connected;
    def.break_force = j.break_force;
    def.break_torque = j.break_torque;
    def.user_data = j.user_data;
    def.name = world.joints.name[id.index];
    return def;
}

void break_joints(WorldData& world) {
    if (world.joints.breakable() == 0) return;
    Array<JointBreak>& breaks = world.events.breaks;
    const size_t first = breaks.size();
    for (uint32_t slot : world.active_joints) {
        const JointInfo& j = world.joints.info[slot];
        JointBreak b{world.joints.id(slot), world.bodies.id(j.body_a), world.bodies.id(j.body_b), j.user_data, {}, {}};
        if (has_broken(world, slot, b.force, b.torque)) breaks.push_back(b);
    }
    std::sort(breaks.begin() + first, breaks.end(),  // order: total
              [](const JointBreak& x, const JointBreak& y) { return x.joint.index < y.joint.index; });
    for (size_t i = first; i < breaks.size(); ++i) remove_joint_at(world, breaks[i].joint.index);
}

void remove_joints_of(WorldData& world, uint32_t body) {
    for (uint32_t slot = world.joints.first_of(body); slot != no_joint_link; slot = world.joints.first_of(body))
        remove_joint_at(world, slot);
}

}  // namespace lendulet
