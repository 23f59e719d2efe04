// The C interface: bodies that come and go, picking, pulling.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

// A damped spring between the point that is held and where it is wanted, as accelerations of the point; the force is
// that times the mass that the point feels along it. Stable for steps up to 1 / (2 pi hertz): 0.04 s.
constexpr float grip_hertz = 4.0f;
constexpr float grip_damping = 0.8f;         // ratio
constexpr float grip_acceleration = 600.0f;  // m/s^2, at most
constexpr float grip_calm = 3.0f;            // 1/s: how fast turning dies away

lendulet_result add(World& world, const RigidBodyDef& def, lendulet_body* out) {
    Result<BodyId> id = world.add_rigid_body(def);
    if (!id) return refuse(id.error());
    if (out) *out = number_of(id.value());
    return 0;
}

bool is_dynamic(const World& world, BodyId id) {
    return world.alive(id) && world.get_static(id).type() == BodyType::dynamic;
}

Position held_point(const World& world, const lendulet_grip& grip) {
    StaticBodyRef body = world.get_static(grip.body);
    return Pose{body.position(), body.orientation()} * grip.on_body;
}

}  // namespace

namespace lendulet::c {

void pull(lendulet_world& handle) {
    World& world = handle.scene.world;
    if (!is_dynamic(world, handle.grip.body)) {
        handle.grip = {};
        return;
    }
    RigidBodyRef body = world.get(handle.grip.body);
    const Position point = held_point(world, handle.grip);
    const float omega = 2.0f * pi * grip_hertz;
    Vec3 a = omega * omega * (handle.grip.target - point) - 2.0f * grip_damping * omega * body.velocity_at(point);
    const float size = length(a);
    if (!(size > 1e-6f)) return;
    const Vec3 direction = (1.0f / size) * a;
    const float mass = 1.0f / body.impulse_effectiveness(point, direction);
    // A state so wild that these are not finite is refused by the calls and left to the step.
    (void)body.apply_force(mass * minimum(size, grip_acceleration) * direction, point).ok();
    (void)body.apply_torque(-grip_calm * body.angular_momentum()).ok();
}

}  // namespace lendulet::c

extern "C" {

lendulet_result lendulet_add_box(lendulet_world* world, const float half_extents[3], const float at[3],
                                 const float velocity[3], float density, lendulet_body* out) {
    if (!world || !half_extents || !at || !velocity) return refuse_null("add_box");
    return add(world->scene.world,
               {.shape = Box{vector(half_extents)},
                .position = position(at),
                .velocity = vector(velocity),
                .density = density},
               out);
}

lendulet_result lendulet_add_sphere(lendulet_world* world, float radius, const float at[3], const float velocity[3],
                                    float density, lendulet_body* out) {
    if (!world || !at || !velocity) return refuse_null("add_sphere");
    return add(world->scene.world,
               {.shape = Sphere{radius}, .position = position(at), .velocity = vector(velocity), .density = density},
               out);
}

lendulet_result lendulet_add_fixed_box(lendulet_world* world, const float half_extents[3], const float at[3],
                                       lendulet_body* out) {
    if (!world || !half_extents || !at) return refuse_null("add_fixed_box");
    Result<BodyId> id =
        world->scene.world.add_static_body({.shape = Box{vector(half_extents)}, .position = position(at)});
    if (!id) return refuse(id.error());
    if (out) *out = number_of(id.value());
    return 0;
}

lendulet_result lendulet_remove_body(lendulet_world* world, lendulet_body body) {
    if (!world) return refuse_null("remove_body");
    return result_of(world->scene.world.remove_body(id_of(body)));
}

lendulet_result lendulet_grab(lendulet_world* world, lendulet_body body, const float point[3]) {
    if (!world || !point) return refuse_null("grab");
    const World& w = world->scene.world;
    const Position taken = position(point);
    if (!is_dynamic(w, id_of(body))) return refuse_body("grab");
    const Vec3 v = from_origin(taken);
    if (!(length_squared(v) < 1e14f)) return refuse({ErrorCode::out_of_world, "grab: that point is out of the world"});
    StaticBodyRef ref = w.get_static(id_of(body));
    world->grip = {id_of(body), rotate_inverse(ref.orientation(), taken - ref.position()), taken};
    world->scene.world.get(id_of(body)).wake();
    return 0;
}

lendulet_result lendulet_drag(lendulet_world* world, const float target[3]) {
    if (!world || !target) return refuse_null("drag");
    if (!world->grip.body) return refuse({ErrorCode::stale_id, "drag: nothing is grabbed"});
    const Position to = position(target);
    if (!(length_squared(from_origin(to)) < 1e14f))
        return refuse({ErrorCode::out_of_world, "drag: that point is out of the world"});
    world->grip.target = to;
    return 0;
}

void lendulet_release(lendulet_world* world) {
    if (world) world->grip = {};
}

lendulet_result lendulet_read_grab(const lendulet_world* world, float out[3]) {
    if (!world || !out) return refuse_null("read_grab");
    if (!is_dynamic(world->scene.world, world->grip.body)) return 0;
    put(out, held_point(world->scene.world, world->grip));
    return 1;
}

}  // extern "C"
