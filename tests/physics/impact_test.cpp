// Cases A13 and A14: a ball meets a wall obliquely, without gravity. Friction sees the whole normal impulse,
// restitution included (Brach, Mechanical Impact Dynamics, 1991).
#include <gtest/gtest.h>

#include "physics/cases.h"

namespace lendulet::cases {
namespace {

struct Outcome {
    Vec3d velocity, spin;  // in the case's frame
};

// A ball of radius 0.5 at (3, -5, 0) m/s against y = 0. `gap` moves the moment of impact within its step.
Outcome bounce(const Frame& frame, Ground ground, float friction, float gap) {
    World world = world_in(frame, {});
    add_ground(world, frame, ground, friction, 0.8f);
    BodyId ball = world
                      .add_rigid_body({.shape = Sphere{0.5f},
                                       .position = frame.point({-0.6f, 0.5f + gap, 0.0f}),
                                       .velocity = frame.direction({3.0f, -5.0f, 0.0f}),
                                       .friction = friction,
                                       .restitution = 0.8f})
                      .value();
    advance(world, 30);
    const RigidBodyRef body = world.get(ball);
    return {frame.local_direction(body.velocity()), frame.local_direction(body.angular_velocity())};
}

void compare(const std::string& name, float friction, double tangential, double tangential_tolerance) {
    constexpr double approach = 5.0, restitution = 0.8, speed = 3.0, radius = 0.5;
    const double spin = (speed - tangential) / (0.4 * radius);
    Worst normal_error(name + " normal speed error", 0.1, "%"),
        sideways(name + " sideways speed", 0.1, "% of tangential speed");
    Worst tangential_error(name + " tangential speed error", tangential_tolerance, "%"),
        spin_error(name + " spin error", 0.2, "%");
    Worst spin_sideways(name + " spin about other axes", 0.2, "% of spin");
    int phase = 0;
    for (const Frame& frame : random_frames())
        for (Ground ground : grounds) {
            Outcome end = bounce(frame, ground, friction, 1.0f + 0.017f * static_cast<float>(phase++));
            normal_error.add(100.0 * (end.velocity.y / (restitution * approach) - 1.0));
            tangential_error.add(100.0 * (end.velocity.x / tangential - 1.0));
            sideways.add(100.0 * end.velocity.z / tangential);
            spin_error.add(100.0 * (-end.spin.z / spin - 1.0));
            spin_sideways.add(100.0 * length(Vec3d{end.spin.x, end.spin.y, 0.0}) / spin);
        }
    for (const Worst* worst : {&normal_error, &tangential_error, &sideways, &spin_error, &spin_sideways})
        worst->finish();
}

// The tangential impulse is mu times the normal one: dv_t = mu (1 + e) v_n.
TEST(Impact, A13ObliqueSliding) { compare("A13", 0.05f, 3.0 - 0.05 * 1.8 * 5.0, 0.1); }

// It rolls off: v_t = v / (1 + 2/5).
TEST(Impact, A14ObliqueGripping) { compare("A14", 1.0f, 3.0 * 5.0 / 7.0, 0.1); }

}  // namespace
}  // namespace lendulet::cases
