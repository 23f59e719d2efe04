// The views of bodies: StaticBodyRef and RigidBodyRef.
#include "lendulet/body.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {

uint32_t StaticBodyRef::slot() const {
    if (!world_->bodies.alive(id_)) detail::fail(no_such(world_->bodies.slots, id_.generation, "a view", "body"));
    return id_.index;
}
BodyId StaticBodyRef::id() const { return id_; }
BodyType StaticBodyRef::type() const { return world_->bodies.info[slot()].type; }
Position StaticBodyRef::position() const { return world_->bodies.user_pose(slot()).position; }
Quat StaticBodyRef::orientation() const { return world_->bodies.user_pose(slot()).orientation; }
Mat3 StaticBodyRef::rotation_matrix() const { return lendulet::rotation_matrix(orientation()); }
std::string_view StaticBodyRef::name() const { return world_->bodies.name[slot()]; }
uint64_t StaticBodyRef::user_data() const { return world_->bodies.info[slot()].user_data; }
int StaticBodyRef::collider_count() const { return world_->bodies.info[slot()].collider_count; }

namespace {

// Slot of the body's collider `index`; no_slot where there are not so many.
uint32_t find_collider(const WorldData& world, uint32_t body, int index) {
    const BodyInfo& info = world.bodies.info[body];
    if (index < 0 || index >= info.collider_count) return no_slot;
    uint32_t slot = info.first_collider;
    for (int i = 0; i < index; ++i) slot = world.colliders.info[slot].next;
    return slot;
}
uint32_t collider_slot(const WorldData& world, uint32_t body, int index, const char* call) {
    const uint32_t slot = find_collider(world, body, index);
    if (slot == no_slot)
        detail::fail({ErrorCode::bad_collider, std::string(call) + ": the body has no collider " +
                                                   std::to_string(index) + ", it has " +
                                                   std::to_string(world.bodies.info[body].collider_count)});
    return slot;
}

Status checked(bool good, const char* call, const char* what) {
    if (good) return {};
    return Error{ErrorCode::non_finite, std::string(call) + ": " + what + " must be finite"};
}

}  // namespace

const Shape& StaticBodyRef::shape(int collider) const {
    return world_->colliders.shape[collider_slot(*world_, slot(), collider, "shape")];
}
bool StaticBodyRef::is_trigger(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot(), collider, "is_trigger")].is_trigger;
}
const CollisionFilter& StaticBodyRef::filter(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot(), collider, "filter")].filter;
}
const Material& StaticBodyRef::material(int collider) const {
    return world_->colliders.material[collider_slot(*world_, slot(), collider, "material")];
}
Events StaticBodyRef::events(int collider) const {
    return world_->colliders.info[collider_slot(*world_, slot(), collider, "events")].events;
}
Transform StaticBodyRef::collider_pose(int collider) const {
    return world_->colliders.given[collider_slot(*world_, slot(), collider, "collider_pose")];
}
ColliderId StaticBodyRef::collider(int index) const {
    const uint32_t found = find_collider(*world_, slot(), index);
    return found == no_slot ? ColliderId{} : world_->colliders.id(found);
}

Aabb StaticBodyRef::aabb() const {
    const BodyStore& bodies = world_->bodies;
    const ColliderStore& colliders = world_->colliders;
    const Pose& pose = bodies.pose[slot()];
    Aabb box{{3e38f, 3e38f, 3e38f}, {-3e38f, -3e38f, -3e38f}};
    for (uint32_t c = bodies.info[slot()].first_collider; c != no_slot; c = colliders.info[c].next) {
        Transform local = colliders.local[c];
        CentredBox b = bounds(colliders.geometry[c], pose.orientation * local.rotation);
        Position centre = pose * local.translation + b.centre;
        box.lower = at(minimum(from_origin(box.lower), from_origin(centre - b.half)));
        box.upper = at(maximum(from_origin(box.upper), from_origin(centre + b.half)));
    }
    return box;
}

float RigidBodyRef::mass() const {
    return type() == BodyType::dynamic ? world_->bodies.mass[slot()].mass : std::numeric_limits<float>::infinity();
}
float RigidBodyRef::inverse_mass() const { return world_->bodies.mass[slot()].inverse_mass; }
Position RigidBodyRef::centre_of_mass() const { return world_->bodies.pose[slot()].position; }
SymMat3 RigidBodyRef::inverse_inertia() const { return world_->bodies.inverse_inertia_world(slot()); }
Vec3 RigidBodyRef::momentum() const { return type() == BodyType::dynamic ? world_->bodies.momenta[slot()].p : Vec3{}; }
Vec3 RigidBodyRef::angular_momentum() const {
    return type() == BodyType::dynamic ? world_->bodies.momenta[slot()].L : Vec3{};
}
Vec3 RigidBodyRef::velocity() const { return world_->bodies.velocity(slot()); }
Vec3 RigidBodyRef::angular_velocity() const { return world_->bodies.angular_velocity(slot()); }
float RigidBodyRef::kinetic_energy() const {
    return 0.5f * (dot(momentum(), velocity()) + dot(angular_momentum(), angular_velocity()));
}
float RigidBodyRef::potential_energy() const {
    if (type() != BodyType::dynamic) return 0.0f;
    const BodyInfo& info = world_->bodies.info[slot()];
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
    const uint32_t body = slot();
    wake();
    wake_touching(*world_, body);  // what it leaves behind
    world_->bodies.set_user_pose(body, {position, q.value()});
    world_->bodies.change[body] = {};
    world_->bodies.info[body].placed_at = static_cast<uint32_t>(world_->steps);
    for (uint32_t c = world_->bodies.info[body].first_collider; c != no_slot; c = world_->colliders.info[c].next)
        world_->query_scene.changed(c);
    return {};
}
Status RigidBodyRef::set_velocity(Vec3 v) {
    Vec3 p = type() == BodyType::kinematic ? v : world_->bodies.mass[slot()].mass * v;
    Status s = checked(is_finite(v) && is_finite(p), "set_velocity", "velocity and momentum");
    if (!s) return s;
    BodyMomenta& m = world_->bodies.momenta[slot()];
    m.p = p;
    m.p_low = {};
    wake();
    return {};
}
Status RigidBodyRef::set_angular_velocity(Vec3 w) {
    Vec3 L = type() == BodyType::kinematic ? w : world_->bodies.inertia_times(slot(), w);
    Status s = checked(is_finite(w) && is_finite(L), "set_angular_velocity", "angular velocity and momentum");
    if (!s) return s;
    world_->bodies.momenta[slot()].L = L;
    wake();
    return {};
}
Status RigidBodyRef::set_momentum(Vec3 p) {
    Status s = checked(is_finite(p), "set_momentum", "momentum");
    if (!s || type() != BodyType::dynamic) return s;
    BodyMomenta& m = world_->bodies.momenta[slot()];
    m.p = p;
    m.p_low = {};
    wake();
    return {};
}
Status RigidBodyRef::set_angular_momentum(Vec3 L) {
    Status s = checked(is_finite(L), "set_angular_momentum", "angular momentum");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.momenta[slot()].L = L;
    wake();
    return {};
}
Status RigidBodyRef::apply_impulse(Vec3 impulse, Position point) {
    BodyMomenta& m = world_->bodies.momenta[slot()];
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
    Vec3 L = world_->bodies.momenta[slot()].L + angular_impulse;
    Status s = checked(is_finite(L), "apply_angular_impulse", "angular impulse and momentum");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.momenta[slot()].L = L;
    wake();
    return {};
}
Status RigidBodyRef::apply_force(Vec3 force, Position point) {
    BodyForces& sum = world_->bodies.forces[slot()];
    Vec3 total = sum.force + force, torque = sum.torque + cross(point - centre_of_mass(), force);
    Status s = checked(is_finite(total) && is_finite(torque), "apply_force", "force, point and the sum of forces");
    if (!s || type() != BodyType::dynamic) return s;
    sum = {total, torque};
    world_->bodies.info[slot()].has_forces = true;
    wake();
    return {};
}
Status RigidBodyRef::apply_force(Vec3 force) { return apply_force(force, centre_of_mass()); }
Status RigidBodyRef::apply_torque(Vec3 torque) {
    Vec3 total = world_->bodies.forces[slot()].torque + torque;
    Status s = checked(is_finite(total), "apply_torque", "torque and the sum of torques");
    if (!s || type() != BodyType::dynamic) return s;
    world_->bodies.forces[slot()].torque = total;
    world_->bodies.info[slot()].has_forces = true;
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
    Pose now = world_->bodies.pose[slot()], target = Pose{position, q.value()} * world_->bodies.principal[slot()];
    Quat turn = target.orientation * conjugate(now.orientation);
    if (turn.w < 0.0f) turn = {-turn.x, -turn.y, -turn.z, -turn.w};
    Vec3 axis{turn.x, turn.y, turn.z};
    float s = length(axis);
    float angle = 2.0f * arc_tangent2(s, turn.w);
    Vec3 w = s > 1e-9f ? (angle / (s * dt)) * axis : (2.0f / dt) * axis;
    Status v = set_velocity((1.0f / dt) * (target.position - now.position));
    return v ? set_angular_velocity(w) : v;
}

bool RigidBodyRef::asleep() const { return world_->bodies.info[slot()].asleep; }
void RigidBodyRef::wake() { wake_body(*world_, slot()); }

}  // namespace lendulet
