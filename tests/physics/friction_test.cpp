// Cases A17, A18 and A20: Coulomb's law for a flat box, on a slope and on the level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/cases.h"
#include "scale.h"

namespace lendulet::cases {
namespace {

// A slope of 45 degrees is level ground with gravity tilted.
const float sin45 = std::sqrt(0.5f);
const Vec3 tilted{9.81f * sin45, -9.81f * sin45, 0.0f};

BodyId add_slab(World& world, const Frame& frame, float friction, Vec3 velocity = {}, Quat turn = {}) {
    Pose pose = frame.pose({0.0f, 0.1f, 0.0f}, turn);
    return world
        .add_rigid_body({.shape = Box{{0.5f, 0.1f, 0.5f}},
                         .position = pose.position,
                         .orientation = pose.orientation,
                         .velocity = frame.direction(velocity),
                         .friction = friction})
        .value();
}

struct Slide {
    double distance, speed;  // down the slope, at the end
    double early_distance;   // after half of the time
};

Slide slide_on_slope(const Frame& frame, Ground ground, float friction, int steps) {
    World world = world_in(frame, tilted);
    add_ground(world, frame, ground, friction);
    BodyId slab = add_slab(world, frame, friction);
    double x0 = frame.local(world.get(slab).position()).x;
    advance(world, steps / 2);
    double early = frame.local(world.get(slab).position()).x - x0;
    advance(world, steps - steps / 2);
    const RigidBodyRef body = world.get(slab);
    return {frame.local(body.position()).x - x0, frame.local_direction(body.velocity()).x, early};
}

// It slips just where mu < tan 45 deg, and then by g (sin - mu cos) t^2 / 2.
TEST(Friction, A17StickSlipThreshold) {
    constexpr int steps = 300;
    const int stride = 100 / scaled(20, 5);
    const double t = steps * static_cast<double>(dt);
    Worst wrong("A17 wrong outcomes beyond 0.002 of mu = 1", 0, "");
    Worst creep("A17 creep at mu = 1.2", 1e-6, "m/s");
    double largest_slip = 0.0, smallest_stick = 9.0, displacement_error = 0.0;
    for (const Frame& frame : random_frames())
        for (Ground ground : grounds) {
            for (int i = -100; i <= 100; i += stride) {
                float friction = 1.0f + 0.001f * static_cast<float>(i);
                Slide slide = slide_on_slope(frame, ground, friction, steps);
                double expected = 0.5 * standard_gravity * std::sqrt(0.5) * (1.0 - friction) * t * t;
                bool slips = slide.distance > 0.5 * expected && slide.distance > 1e-3;
                if (slips) largest_slip = std::max<double>(largest_slip, friction);
                else smallest_stick = std::min<double>(smallest_stick, friction);
                if (std::abs(i) > 2) wrong.add(slips == (i < 0) ? 0.0 : 1.0);
                if (i < -2)
                    displacement_error = std::fmax(displacement_error, std::fabs(slide.distance / expected - 1.0));
            }
            Slide held = slide_on_slope(frame, ground, 1.2f, steps);
            creep.add((held.distance - held.early_distance) / (0.5 * t));
        }
    wrong.finish();
    creep.finish();
    report("A17 largest mu that slips", largest_slip, "");
    report("A17 smallest mu that sticks", smallest_stick, "");
    report("A17 displacement error where it slips", 100.0 * displacement_error, "%");
}

TEST(Friction, A18SlidingAcceleration) {
    constexpr int steps = 180;
    constexpr float friction = 0.5f;
    const double t = steps * static_cast<double>(dt), expected = standard_gravity * std::sqrt(0.5) * (1.0 - friction);
    Worst acceleration("A18 acceleration error", 0.05, "%");
    for (const Frame& frame : random_frames())
        for (Ground ground : grounds)
            acceleration.add(100.0 * (slide_on_slope(frame, ground, friction, steps).speed / t / expected - 1.0));
    acceleration.finish();
}

struct Stop {
    double distance, direction_deg, yaw_deg;
};

// A slab thrown at 5 m/s in the direction `heading` slides to a stop.
Stop slide_to_stop(const Frame& frame, Ground ground, float heading, float box_turn) {
    constexpr float friction = 0.5f;
    World world = world_in(frame);
    add_ground(world, frame, ground, friction);
    Quat turn = rotation_about({0.0f, 1.0f, 0.0f}, box_turn);
    SinCos s = sin_cos(heading);
    BodyId slab = add_slab(world, frame, friction, {5.0f * s.cos, 0.0f, 5.0f * s.sin}, turn);
    Vec3d x0 = frame.local(world.get(slab).position()), v0 = frame.local_direction(world.get(slab).velocity());
    Vec3d edge = frame.local_direction(world.get(slab).rotation_matrix().x);
    advance(world, 90);
    Vec3d moved = frame.local(world.get(slab).position()) - x0;
    moved.y = 0.0;
    Vec3d turned = frame.local_direction(world.get(slab).rotation_matrix().x);
    return {length(moved), degrees(angle_between(moved, v0)), degrees(angle_between(edge, turned))};
}

// d = v^2 / (2 mu g).
TEST(Friction, A18StoppingDistance) {
    const double expected = 25.0 / (2.0 * 0.5 * standard_gravity);
    Worst distance("A18 stopping distance error", 0.1, "%");
    for (const Frame& frame : random_frames())
        for (Ground ground : grounds)
            distance.add(100.0 * (slide_to_stop(frame, ground, 0.0f, 0.0f).distance / expected - 1.0));
    distance.finish();
}

// All directions are alike: the friction cone is round.
TEST(Friction, A20Isotropy) {
    Worst spread("A20 spread of stopping distances", 0.1, "%"), direction("A20 direction error", 0.05, "deg");
    Worst yaw("A20 yaw", 0.1, "deg");
    const int stride = 90 / scaled(18, 3);
    for (const Frame& frame : random_frames())
        for (Ground ground : grounds)
            for (bool turned : {false, true}) {
                double shortest = 1e9, longest = 0.0;
                for (int angle = 0; angle <= 90; angle += stride) {
                    float heading = static_cast<float>(angle) * pi / 180.0f;
                    Stop stop = slide_to_stop(frame, ground, heading, turned ? heading : 0.0f);
                    shortest = std::fmin(shortest, stop.distance);
                    longest = std::fmax(longest, stop.distance);
                    direction.add(stop.direction_deg);
                    yaw.add(stop.yaw_deg);
                }
                spread.add(100.0 * (longest / shortest - 1.0));
            }
    spread.finish();
    direction.finish();
    yaw.finish();
}

}  // namespace
}  // namespace lendulet::cases
