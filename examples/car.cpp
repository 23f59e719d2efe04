// A car: a body on four wheels. It drives up to speed, turns, brakes and stands.
//
// A wheel hangs on two joints with a carrier between them, a small body:
//   car - carrier   six degrees: travel along y is the suspension, spring and damper within bounds; turning about y is
//                   locked, or held at the steering angle by a stiff spring; all else is locked
//   carrier - wheel a hinge along the axle, with the motor, and with friction for the bearing and the brake
// One joint would not do: turning about several axes at once, a wheel has no steering angle of its own.
#include <cstdio>

#include "lendulet/lendulet.h"

using namespace lendulet;

constexpr float mass = 1200.0f, radius = 0.33f, gravity = 9.81f, bearing = 2.0f;
constexpr Spring steering{.stiffness = 30000.0f, .damping = 600.0f};

struct Car {
    BodyId body;
    JointId suspensions[4], axles[4];  // two in front, two behind
};

JointDef suspension(const World& world, BodyId car, BodyId carrier, Position hub, bool steers) {
    JointDef def = world.joint_at(JointType::six_degrees, car, carrier, hub).value();
    for (JointAxis& a : def.axes.linear) a.limit = {0.0f, 0.0f};
    for (JointAxis& a : def.axes.angular) a.limit = {0.0f, 0.0f};
    // A quarter of the car at 1.5 Hz, with two fifths of the critical damping. The target is so far below that the
    // spring carries its load at 0.
    const float load = 0.25f * mass, w = 2.0f * pi * 1.5f, k = load * w * w;
    def.axes.linear[1].limit = {-0.15f, 0.15f};
    def.axes.linear[1].spring = {.stiffness = k, .damping = 0.8f * load * w, .target = -load * gravity / k};
    if (steers) def.axes.angular[1] = {.limit = {-0.6f, 0.6f}, .spring = steering};
    return def;
}

Car make_car(World& world, Position at) {
    Car car;
    // Low centre of mass, as of engine and floor.
    car.body = world
                   .add_rigid_body({.shape = Box{{0.7f, 0.3f, 2.0f}},
                                    .position = at + Vec3{0.0f, 0.75f, 0.0f},
                                    .filter = {.group = 1},
                                    .mass = mass,
                                    .centre_of_mass = Vec3{0.0f, -0.25f, 0.0f}})
                   .value();
    // A cylinder's axis is y, a wheel's is x. Parts of the car have one group: they do not meet.
    const ColliderDef tyre{.shape = Cylinder{0.07f, radius - 0.03f, 0.03f},
                           .local = {{}, rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi)},
                           .material = {.static_friction = 1.0f, .dynamic_friction = 0.9f},
                           .filter = {.group = 1}};
    for (int i = 0; i < 4; ++i) {
        const bool front = i < 2;
        const Position hub = at + Vec3{i % 2 == 0 ? 0.8f : -0.8f, radius, front ? 1.3f : -1.3f};
        const BodyId carrier =
            world
                .add_rigid_body(
                    {.shape = Box{{0.05f, 0.1f, 0.1f}}, .position = hub, .filter = {.group = 1}, .mass = 15.0f})
                .value();
        const BodyId wheel = world.add_rigid_body({.position = hub, .colliders = {&tyre, 1}, .mass = 20.0f}).value();
        car.suspensions[i] = world.add_joint(suspension(world, car.body, carrier, hub, front)).value();
        JointDef axle = world.joint_at(JointType::hinge, carrier, wheel, hub, {1.0f, 0.0f, 0.0f}).value();
        axle.friction = bearing;
        car.axles[i] = world.add_joint(axle).value();
    }
    return car;
}

// `speed` to drive at, m/s, with `torque` at each rear wheel, N m; `steer`: angle of the front wheels, rad, to the left
// where > 0; `brake`: torque at each wheel, N m.
struct Pedals {
    float speed = 0.0f, torque = 0.0f, steer = 0.0f, brake = 0.0f;
};
void control(World& world, const Car& car, const Pedals& p) {
    Spring turned = steering;
    turned.target = p.steer;
    for (int i = 0; i < 4; ++i) {
        world.set_friction(car.axles[i], bearing + p.brake).value();
        if (i < 2) world.set_spring(car.suspensions[i], Coordinate::about_y, turned).value();
        else world.set_motor(car.axles[i], {p.speed / radius, p.torque}).value();
    }
}

int main() {
    World world = WorldBuilder{}.down_gravity(gravity).build().value();
    world.add_static_body({.shape = Plane{}}).value();
    const Car car = make_car(world, {});
    struct Part {
        const char* what;
        float seconds;
        Pedals pedals;
    };
    const Part parts[] = {{"stands", 2.0f, {}},
                          {"drives", 6.0f, {.speed = 15.0f, .torque = 600.0f}},
                          {"turns", 3.0f, {.speed = 15.0f, .torque = 600.0f, .steer = 0.08f}},
                          {"brakes", 4.0f, {.brake = 800.0f}}};
    for (const Part& part : parts) {
        control(world, car, part.pedals);
        for (float t = 0.0f; t < part.seconds; t += 1.0f / 60) world.update(1.0f / 60).value();
        const RigidBodyRef body = world.get(car.body);
        std::printf("%-6s %.0f s: %6.2f m aside, %6.2f m ahead, %5.2f m/s, turning %5.2f rad/s, left spring %+.3f m\n",
                    part.what, part.seconds, body.position().x, body.position().z, length(body.velocity()),
                    body.angular_velocity().y, world.joint(car.suspensions[0]).coordinates[1]);
    }
}
