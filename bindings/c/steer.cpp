// The C interface: how bodies that move are placed, pushed and driven.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

// Calls act(view) on a body that moves, where it is one and no pointer is null.
template <class Act>
lendulet_result act_on(lendulet_world* world, lendulet_body body, bool given, const char* call, Act&& act) {
    if (!world || !given) return refuse_null(call);
    World& w = world->scene.world;
    const BodyId id = id_of(body);
    if (!w.alive(id) || w.get_static(id).type() == BodyType::fixed) return refuse_body(call);
    return result_of(act(w.get(id)));
}

}  // namespace

extern "C" {

lendulet_result lendulet_set_pose(lendulet_world* world, lendulet_body body, const float at[3],
                                  const float orientation[4]) {
    if (!world || !at || !orientation) return refuse_null("set_pose");
    return result_of(world->scene.world.set_pose(id_of(body), position(at), rotation(orientation)));
}

lendulet_result lendulet_set_velocity(lendulet_world* world, lendulet_body body, const float velocity[3]) {
    return act_on(world, body, velocity, "set_velocity",
                  [&](RigidBodyRef b) { return b.set_velocity(vector(velocity)); });
}

lendulet_result lendulet_set_angular_velocity(lendulet_world* world, lendulet_body body, const float velocity[3]) {
    return act_on(world, body, velocity, "set_angular_velocity",
                  [&](RigidBodyRef b) { return b.set_angular_velocity(vector(velocity)); });
}

lendulet_result lendulet_apply_impulse(lendulet_world* world, lendulet_body body, const float impulse[3],
                                       const float point[3]) {
    return act_on(world, body, impulse && point, "apply_impulse",
                  [&](RigidBodyRef b) { return b.apply_impulse(vector(impulse), position(point)); });
}

lendulet_result lendulet_apply_force(lendulet_world* world, lendulet_body body, const float force[3],
                                     const float point[3]) {
    return act_on(world, body, force && point, "apply_force",
                  [&](RigidBodyRef b) { return b.apply_force(vector(force), position(point)); });
}

lendulet_result lendulet_apply_torque(lendulet_world* world, lendulet_body body, const float torque[3]) {
    return act_on(world, body, torque, "apply_torque", [&](RigidBodyRef b) { return b.apply_torque(vector(torque)); });
}

lendulet_result lendulet_move_to(lendulet_world* world, lendulet_body body, const float at[3],
                                 const float orientation[4]) {
    return act_on(world, body, at && orientation, "move_to",
                  [&](RigidBodyRef b) { return b.move_to(position(at), rotation(orientation), world->scene.dt); });
}

lendulet_result lendulet_set_damping(lendulet_world* world, lendulet_body body, float linear, float angular) {
    return act_on(world, body, true, "set_damping", [&](RigidBodyRef b) { return b.set_damping(linear, angular); });
}

lendulet_result lendulet_set_mass(lendulet_world* world, lendulet_body body, float mass) {
    return act_on(world, body, true, "set_mass", [&](RigidBodyRef b) { return b.set_mass(mass); });
}

lendulet_result lendulet_set_gravity_factor(lendulet_world* world, lendulet_body body, float factor) {
    return act_on(world, body, true, "set_gravity_factor",
                  [&](RigidBodyRef b) { return b.set_gravity_factor(factor); });
}

}  // extern "C"
