// Friction points against the slip, whatever the shape and however many points of a body slide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;
constexpr float g = 9.81f;

// A long box that slides askew answers to forces along and across it differently, but it has no reason to leave its
// way: 12 degrees off it went, where friction was cut along the impulse that would have stopped it.
TEST(Friction, ABoxSlidesStraightHoweverItLies) {
    for (Vec3 half : {Vec3{1.0f, 0.5f, 0.2f}, {0.2f, 0.2f, 2.0f}, {0.3f, 0.3f, 0.3f}})
        for (float yaw : {0.0f, 0.4f, 0.8f}) {
            World world = WorldBuilder{}.down_gravity(g).friction(0.3f).sleep(false).build().value();
            world.add_static_body({.shape = Plane{}}).value();
            BodyId id = world
                            .add_rigid_body({.shape = Box{half},
                                             .position = {0.0f, half.y, 0.0f},
                                             .orientation = rotation_about({0.0f, 1.0f, 0.0f}, yaw)})
                            .value();
            for (int i = 0; i < 10; ++i) world.update(dt).value();
            world.get(id).set_velocity({5.0f, 0.0f, 0.0f}).value();
            for (int i = 0; i < 150; ++i) world.update(dt).value();
            const Position end = world.get(id).position();
            EXPECT_NEAR(end.x, 25.0 / (2.0 * 0.3 * g), 1e-3) << half.x << " " << yaw;
            EXPECT_NEAR(end.z, 0.0, 1e-3) << half.x << " " << yaw;
        }
}

// Four balls are the feet of one body. What slides under one of them slides under all, so each must hold against the
// slope, not against its neighbours.
World table_on_slope(float angle, float mu, int width) {
    World world = WorldBuilder{}
                      .gravity({g * std::sin(angle), -g * std::cos(angle), 0.0f})
                      .friction(mu)
                      .sleep(false)
                      .width(width)
                      .build()
                      .value();
    world.add_static_body({.shape = Plane{}}).value();
    std::vector<ColliderDef> parts{{.shape = Box{{0.5f, 0.1f, 0.5f}}}};
    for (int i = 0; i < 4; ++i)
        parts.push_back({.shape = Sphere{0.1f}, .local = {{i % 2 ? 0.5f : -0.5f, -0.15f, i / 2 ? 0.5f : -0.5f}, {}}});
    world.add_rigid_body({.position = {0.0f, 0.25f, 0.0f}, .colliders = parts}).value();
    return world;
}

TEST(Friction, FeetHoldTogether) {
    for (float degrees : {5.0f, 30.0f})
        for (float share : {0.97f, 1.01f}) {
            const float angle = degrees * pi / 180.0f, mu = share * std::tan(angle);
            World world = table_on_slope(angle, mu, 0);
            const RigidBodyRef table = world.get(world.body(1));
            for (int i = 0; i < 30; ++i) world.update(dt).value();
            const float before = table.velocity().x;
            for (int i = 0; i < 120; ++i) world.update(dt).value();
            const float exact = g * std::max(std::sin(angle) - mu * std::cos(angle), 0.0f);
            EXPECT_NEAR((table.velocity().x - before) / 2.0f, exact, 2e-3f) << degrees << " " << share;
        }
}

TEST(Friction, WhatSlidesGivesTheSameBitsForEveryWidth) {
    uint64_t expected = 0;
    for (int width : {1, 4, 8, 16}) {
        World world = table_on_slope(0.5f, 0.4f, width);
        world
            .add_rigid_body({.shape = Box{{1.0f, 0.1f, 0.3f}},
                             .position = {-3.0f, 0.1f, 0.0f},
                             .orientation = rotation_about({0.0f, 1.0f, 0.0f}, 0.4f),
                             .angular_velocity = {0.0f, 2.0f, 0.0f}})
            .value();
        for (int i = 0; i < 120; ++i) world.update(dt).value();
        if (width == 1) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width;
    }
}

// A ring of radius r on a slope, by Coulomb's law at each of its points: until it has stopped.
struct RingEnd {
    double x, time;
};
RingEnd slide_ring(double speed, double spin, double r, double mu, double slope) {
    constexpr int n = 64;
    constexpr double h = 2e-4;
    double x = 0.0, time = 0.0;
    for (; time < 10.0 && (speed > 2e-3 || spin > 0.02); time += h) {
        double force = 0.0, torque = 0.0;
        for (int i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * (i + 0.5) / n, px = r * std::cos(angle),
                         pz = r * std::sin(angle);
            const double vx = speed + spin * pz, vz = -spin * px,
                         share = -mu * g * std::cos(slope) / (n * std::hypot(vx, vz));
            force += share * vx;
            torque += share * (pz * vx - px * vz);
        }
        speed += h * (force + g * std::sin(slope));
        spin += h * torque / (0.5 * r * r);
        x += h * speed;
    }
    return {x, time};
}

// What slides and spins at once is slowed less in either: the disc goes 1.64 m instead of the 1.02 without spin, and
// both end together. On a slope below the angle of friction what spins slides down, until it spins no more.
TEST(Friction, SlidingAndSpinningShareOneLimit) {
    struct Case {
        float speed, spin, mu, slope;
    };
    for (const Case& c : {Case{2.0f, 0.0f, 0.2f, 0.0f},
                          {2.0f, 5.0f, 0.2f, 0.0f},
                          {2.0f, 20.0f, 0.2f, 0.0f},
                          {0.3f, 30.0f, 0.2f, 0.0f},
                          {0.0f, 60.0f, 0.3f, 0.1f}})
        for (float step : {dt, dt / 4.0f}) {
            const float r = 0.15f, half = 0.005f;
            World world = WorldBuilder{}
                              .gravity({g * std::sin(c.slope), -g * std::cos(c.slope), 0.0f})
                              .friction(c.mu)
                              .sleep(false)
                              .build()
                              .value();
            world.add_static_body({.shape = Plane{}}).value();
            const RigidBodyRef disc = world.get(world
                                                    .add_rigid_body({.shape = Cylinder{half, r},
                                                                     .position = {0.0f, half, 0.0f},
                                                                     .velocity = {c.speed, 0.0f, 0.0f},
                                                                     .angular_velocity = {0.0f, c.spin, 0.0f}})
                                                    .value());
            const RingEnd exact = slide_ring(c.speed, c.spin, r, c.mu, c.slope);
            for (int i = 0; static_cast<float>(i) * step < static_cast<float>(exact.time) + 0.1f; ++i)
                world.update(step).value();
            // Four points in the ring's place, which do not carry alike.
            EXPECT_NEAR(disc.position().x, exact.x, 0.02 * exact.x) << c.speed << " " << c.spin << " " << step;
            EXPECT_LT(length(disc.velocity()) + r * length(disc.angular_velocity()), 1e-3f) << c.spin << " " << step;
        }
}

// A box that meets the floor with one corner and slides on is pushed against the slip that is left there.
TEST(Friction, ActsAgainstTheSlipOfAnImpact) {
    const Vec3 half{1.0f, 0.3f, 0.15f};
    int slid = 0;
    for (int k = 0; k < 40; ++k) {
        World world = WorldBuilder{}.no_gravity().friction(0.1f).bounciness(0.5f).build().value();
        world.add_static_body({.shape = Plane{}}).value();
        const float turn = 0.15f * static_cast<float>(k);
        const Quat tilted = rotation_about(normalize(Vec3{1.0f, turn, -0.5f}), 0.5f + 0.06f * static_cast<float>(k));
        const RigidBodyRef box = world.get(world
                                               .add_rigid_body({.shape = Box{half},
                                                                .position = {0.0f, 1.5f, 0.0f},
                                                                .orientation = tilted,
                                                                .velocity = {3.0f, -5.0f, 1.0f}})
                                               .value());
        const Vec3 before = box.velocity();
        // Until it is hit; the step is so short that it then is where it was hit.
        for (int i = 0; i < 400 && box.velocity() == before; ++i) world.update(1.0f / 960.0f).value();
        Vec3 corner{0.0f, 9.0f, 0.0f};
        float next = 9.0f;
        for (int i = 0; i < 8; ++i) {
            const Vec3 r = rotate(box.orientation(),
                                  {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
            next = std::min(next, std::max(r.y, corner.y));
            if (r.y < corner.y) corner = r;
        }
        const Vec3 pushed = box.velocity() - before, slip = box.velocity() + cross(box.angular_velocity(), corner);
        const float friction = std::hypot(pushed.x, pushed.z), speed = std::hypot(slip.x, slip.z);
        if (next - corner.y < 0.05f || friction < 0.0999f * pushed.y || speed < 1.0f) continue;
        ++slid;
        EXPECT_NEAR((pushed.x * slip.x + pushed.z * slip.z) / (friction * speed), -1.0f, 1e-3f) << k;
        EXPECT_NEAR(friction, 0.1f * pushed.y, 1e-4f * pushed.y) << k;
    }
    EXPECT_GT(slid, 10);
}

}  // namespace
}  // namespace lendulet
