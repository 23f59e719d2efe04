// The views of bodies: StaticBodyRef and RigidBodyRef.
#include "lendulet/body.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {

BodyId StaticBodyRef::id() const { return world_->bodies.id(slot_); }
BodyType StaticBodyRef::type() const { return world_->bodies.info[slot_].type; }
Position StaticBodyRef::position() const { return world_->bodies.user_pose(slot_).position; }
Quat StaticBodyRef::orientation() const { return world_->bodies.user_pose(slot_).orientation; }
Mat3 StaticBodyRef::rotation_matrix() const { return lendulet::rotation_matrix(orientation()); }
std::string_view StaticBodyRef::name() const { return world_->bodies.name[slot_]; }
uint64_t StaticBodyRef::user_data() const { return world_->bodies.info[slot_].user_data; }
int StaticBodyRef::collider_count() const { return world_->bodies.info[slot_].collider_count; }

namespace {

// Slot of the body's collider `index`, or of its first where there are not so many.
uint32_t collider_slot(const WorldData& world, uint32_t body, int index) {
    uint32_t slot = world.bodies.info[body].first_collider;
    for (int i = 0; i < index; ++i) {
        uint32_t next = world.colliders.info[slot].next;
        if (next == no_slot) break;
        slot = next;
    }
    return slot;
}

Status checked(bool good, const char* call, const char* what) {
    if (good) return {};
    return Error{ErrorCode::non_finite, std::string(call) + ": " + what + " must be finite"};
}

}  // namespace

const Shape& StaticBodyRef::shape(int collider) const {
    return world_->colliders.shape[collider_slot(*world_, slot_, collider)];
}
bool StaticBodyRef::is_trigger(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot_, collider)].is_trigger;
}
const CollisionFilter& StaticBodyRef::filter(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot_, collider)].filter;
}
const Material& StaticBodyRef::material(int collider) const {
    return world_->colliders.material[collider_slot(*world_, slot_, collider)];
}
Events StaticBodyRef::events(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot_, collider)].events;
}
Transform StaticBodyRef::collider_pose(int collider) const {
    return world_->colliders.given[collider_slot(*world_, slot_, collider)];
}
ColliderId StaticBodyRef::collider(int index) const {
    return world_->colliders.id(collider_slot(*world_, slot_, index));
}

Aabb StaticBodyRef::aabb() const {
    const BodyStore& bodies = world_->bodies;
    const ColliderStore& colliders = world_->colliders;
    const Pose& pose = bodies.pose[slot_];
    Aabb box{{3e38f, 3e38f, 3e38f}, {-3e38f, -3e38f, -3e38f}};
    for (uint32_t c = bodies.info[slot_].first_collider; c != no_slot; c = colliders.info[c].next) {
        Transform local = colliders.local[c];
        CentredBox b = bounds(colliders.geometry[c], pose.orientation * local.rotation);
        Position centre = pose * local.translation + b.centre;
        box.lower = at(minimum(from_origin(box.lower), from_origin(centre - b.half)));
        box.upper = at(maximum(from_origin(box.upper), from_origin(centre + b.half)));
    }
    return box;
}

float RigidBodyRef::mass() const {
    return type() == BodyType::dynamic ? world_->bodies.mass[slot_].mass : std::numeric_limits<float>::infinity();
}
float RigidBodyRef::inverse_mass() const { return world_->bodies.mass[slot_].inverse_mass; }
Position RigidBodyRef::centre_of_mass() const { return world_->bodies.pose[slot_].position; }
SymMat3 RigidBodyRef::inverse_inertia() const { return world_->bodies.inverse_inertia_world(slot_); }
Vec3 RigidBodyRef::momentum() const { return type() == BodyType::dynamic ? world_->bodies.momenta[slot_].p : Vec3{}; }
Vec3 RigidBodyRef::angular_momentum() const {
    return type() == BodyType::dynamic ? world_->bodies.momenta[slot_].L : Vec3{};
}
Vec3 RigidBodyRef::velocity() const { return world_->bodies.velocity(slot_); }
Vec3 RigidBodyRef::angular_velocity() const { return world_->bodies.angular_velocity(slot_); }
float RigidBodyRef::kinetic_energy() const {
    return 0.5f * (dot(momentum(), velocity()) + dot(angular_momentum(), angular_velocity()));
}
float RigidBodyRef::potential_energy() const {
    if (type() != BodyType::dynamic) return 0.0f;
    const BodyInfo& info = world_->bodies.info[slot_];
    return -mass() * info.gravity_factor * dot(world_->config.gravity, from_origin(centre_of_mass()));
}
Vec3 RigidBodyRef::velocity_at(Position point) const {
    return velocity() + cross(angular_velocity(), point - centre_of_mass());
}
float RigidBodyRef::impulse_effectiveness(Position point, Vec3 direction) const {
    Vec3 r = point - centre_of_mass();
    return dot(direction, inverse_mass() * direction + cross(inverse_inertia() * cross(r, direction), r));
}

Status RigidBodyRef::set_pose(Position position, Quat orientation) {
    Result<Quat> q = unit_quaternion(orientation, "set_pose");
    if (!q) return q.error();
    Status place = valid_position(position, "set_pose");
    if (!place) return place;
    wake();
    wake_touching(*world_, slot_);  // what it leaves behind
    world_->bodies.set_user_pose(slot_, {position, q.value()});
    world_->bodies.change[slot_] = {};
    world_->bodies.info[slot_].placed_at = static_cast<uint32_t>(world_->steps);
    for (uint32_t c = world_->bodies.info[slot_].first_collider; c != no_slot; c = world_->colliders.info[c].next)
        world_->query_scene.changed(c);
    return {};
}
Status RigidBodyRef::set_velocity(Vec3 v) {
    Vec3 p = type() == BodyType::kinematic ? v : world_->bodies.mass[slot_].mass * v;
    Status s = checked(is_finite(v) && is_finite(p), "set_velocity", "velocity and momentum");
    if (!s) return s;
    BodyMomenta& m = world_->bodies.momenta[slot_];
    m.p = p;
    m.p_low = {};
    wake();
    return {};
}
Status RigidBodyRef::set_angular_velocity(Vec3 w) {
    Vec3 L = type() == BodyType::kinematic ? w : world_->bodies.inertia_times(slot_, w);
    Status s = checked(is_finite(w) && is_finite(L), "set_angular_velocity", "angular velocity and momentum");
    if (!s) return s;
    world_->bodies.momenta[slot_].L = L;
    wake();
    return {};
}
Status RigidBodyRef::set_momentum(Vec3 p) {
    Status s = checked(is_finite(p), "set_momentum", "momentum");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.momenta[slot_].p = p;
    world_->bodies.momenta[slot_].p_low = {};
    wake();
    return {};
}
Status RigidBodyRef::set_angular_momentum(Vec3 L) {
    Status s = checked(is_finite(L), "set_angular_momentum", "angular momentum");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.momenta[slot_].L = L;
    wake();
    return {};
}
Status RigidBodyRef::apply_impulse(Vec3 impulse, Position point) {
    BodyMomenta& m = world_->bodies.momenta[slot_];
    // p' = p + J, L' = L + (x_J - x) x J, thesis 3.3.1
    Vec3 p = m.p + impulse, L = m.L + cross(point - centre_of_mass(), impulse);
    Status s = checked(is_finite(p) && is_finite(L), "apply_impulse", "impulse, point and what they lead to");
    if (!s || type() != BodyType::dynamic) return s;
    m.p = p;
    m.L = L;
    wake();
    return {};
}
Status RigidBodyRef::apply_impulse(Vec3 impulse) { return apply_impulse(impulse, centre_of_mass()); }
Status RigidBodyRef::apply_angular_impulse(Vec3 angular_impulse) {
    Vec3 L = world_->bodies.momenta[slot_].L + angular_impulse;
    Status s = checked(is_finite(L), "apply_angular_impulse", "angular impulse and momentum");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.momenta[slot_].L = L;
    wake();
    return {};
}
Status RigidBodyRef::apply_force(Vec3 force, Position point) {
    BodyForces& sum = world_->bodies.forces[slot_];
    Vec3 total = sum.force + force, torque = sum.torque + cross(point - centre_of_mass(), force);
    Status s = checked(is_finite(total) && is_finite(torque), "apply_force", "force, point and the sum of forces");
    if (!s || type() != BodyType::dynamic) return s;
    sum = {total, torque};
    world_->bodies.info[slot_].has_forces = true;
    wake();
    return {};
}
Status RigidBodyRef::apply_force(Vec3 force) { return apply_force(force, centre_of_mass()); }
Status RigidBodyRef::apply_torque(Vec3 torque) {
    Vec3 total = world_->bodies.forces[slot_].torque + torque;
    Status s = checked(is_finite(total), "apply_torque", "torque and the sum of torques");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.forces[slot_].torque = total;
    world_->bodies.info[slot_].has_forces = true;
    wake();
    return {};
}
Status RigidBodyRef::move_to(Position position, Quat orientation, float dt) {
    Result<Quat> q = unit_quaternion(orientation, "move_to");
    if (!q) return q.error();
    Status place = valid_position(position, "move_to");
    if (!place) return place;
    if (!(dt > 0.0f) || !is_finite(dt))
        return Error{ErrorCode::bad_time_step, "move_to: dt must be positive and finite"};
    // The principal frame is what turns and moves: velocities that carry it to its place under the wanted body frame.
    Pose now = world_->bodies.pose[slot_], target = Pose{position, q.value()} * world_->bodies.principal[slot_];
    Quat turn = target.orientation * conjugate(now.orientation);
    if (turn.w < 0.0f) turn = {-turn.x, -turn.y, -turn.z, -turn.w};
    Vec3 axis{turn.x, turn.y, turn.z};
    float s = length(axis);
    float angle = 2.0f * arc_tangent2(s, turn.w);
    Vec3 w = s > 1e-9f ? (angle / (s * dt)) * axis : (2.0f / dt) * axis;
    Status v = set_velocity((1.0f / dt) * (target.position - now.position));
    return v ? set_angular_velocity(w) : v;
}

bool RigidBodyRef::asleep() const { return world_->bodies.info[slot_].asleep; }
void RigidBodyRef::wake() { wake_body(*world_, slot_); }

}  // namespace lendulet
