// Impacts of many points at once: each leaves e times as fast as it came, or faster where it carries nothing. What is
// dropped flat is case A08 of `lendulet verify`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

struct Thrown {
    Vec3 half_extents{0.5f, 0.5f, 0.5f};
    Vec3 velocity{0.0f, -5.0f, 0.0f};
    Vec3 spin{};
    float tilt = 0.0f;  // about x, rad
};

constexpr float gap = 0.03f;

World throw_at_floor(const Thrown& t, float friction, float restitution) {
    World world = WorldBuilder{}.no_gravity().friction(friction).bounciness(restitution).sleep(false).build().value();
    test::add_floor(world);
    world
        .add_rigid_body({.shape = Box{t.half_extents},
                         .position = {0.0f, t.half_extents.y + gap, 0.0f},
                         .orientation = rotation_about({1.0f, 0.0f, 0.0f}, t.tilt),
                         .velocity = t.velocity,
                         .angular_velocity = t.spin})
        .value();
    return world;
}

// Of the lower face's corners.
std::vector<Vec3> corner_velocities(const World& world, Vec3 h) {
    const RigidBodyRef box = world.get(world.body(1));
    std::vector<Vec3> list;
    for (float x : {-h.x, h.x})
        for (float z : {-h.z, h.z}) list.push_back(box.velocity_at(box.pose() * Vec3{x, -h.y, z}));
    return list;
}

TEST(FlatImpact, ASlightTiltDoesNotTell) {
    for (const float tilt : {0.0f, 1e-4f, 1e-3f, -2e-3f})
        for (const Vec3 half : {Vec3{0.5f, 0.5f, 0.5f}, Vec3{0.5f, 0.1f, 0.3f}, Vec3{0.05f, 1.0f, 0.05f}}) {
            Thrown t;
            t.half_extents = half, t.tilt = tilt;
            World world = throw_at_floor(t, 0.5f, 0.5f);
            test::run(world, 3);
            const RigidBodyRef box = world.get(world.body(1));
            EXPECT_NEAR(box.velocity().y, 2.5f, 0.01f) << tilt << " " << half.y;
            EXPECT_LT(length(box.angular_velocity()) * length(half), 0.05f) << tilt << " " << half.y;
        }
}

// One that slides is pressed more in front, which no corner tells.
TEST(FlatImpact, OfABoxThatSlidesTakesFrictionAtOnce) {
    const float mu = 0.3f, e = 0.6f;
    Thrown t;
    t.half_extents = {0.5f, 0.25f, 0.5f}, t.velocity = {6.0f, -5.0f, 0.0f};
    World world = throw_at_floor(t, mu, e);
    test::run(world, 3);
    const RigidBodyRef box = world.get(world.body(1));
    EXPECT_NEAR(box.velocity().x, 6.0f - mu * (1.0f + e) * 5.0f, 0.02f);
    EXPECT_NEAR(box.velocity().y, e * 5.0f, 0.02f);
    EXPECT_LT(length(box.angular_velocity()), 0.02f);
}

// A tall one cannot: its front edge carries all, and it turns over it.
TEST(FlatImpact, OfATallBoxThatSlidesTurnsItOverItsEdge) {
    Thrown t;
    t.half_extents = {0.1f, 1.0f, 0.1f}, t.velocity = {6.0f, -5.0f, 0.0f};
    World world = throw_at_floor(t, 0.6f, 0.4f);
    test::run(world, 3);
    const RigidBodyRef box = world.get(world.body(1));
    EXPECT_LT(box.angular_velocity().z, -1.0f);
    EXPECT_NEAR(box.angular_velocity().x, 0.0f, 0.02f);
    EXPECT_NEAR(box.angular_velocity().y, 0.0f, 0.02f);
    EXPECT_LT(box.kinetic_energy(), 0.5f * box.mass() * (36.0f + 25.0f));
}

// A seesaw: a box that turns as it comes down meets with one edge faster than with the other.
TEST(FlatImpact, EachCornerLeavesAsFastAsItShould) {
    const float e = 0.7f;
    for (const float spin : {0.0f, 0.5f, 2.0f, 6.0f}) {
        Thrown t;
        t.spin = {spin, 0.0f, 0.3f * spin};
        // So turned that all corners meet the floor in the same moment.
        const float time = gap / 5.0f;
        World world = WorldBuilder{}.no_gravity().friction(0.0f).bounciness(e).sleep(false).build().value();
        test::add_floor(world);
        world
            .add_rigid_body({.shape = Box{},
                             .position = {0.0f, 0.5f + gap, 0.0f},
                             .orientation = rotation_about(t.spin, -time * length(t.spin)),
                             .velocity = t.velocity,
                             .angular_velocity = t.spin})
            .value();
        const std::vector<Vec3> came = [&] {
            std::vector<Vec3> list;
            for (float x : {-0.5f, 0.5f})
                for (float z : {-0.5f, 0.5f}) list.push_back(t.velocity + cross(t.spin, {x, -0.5f, z}));
            return list;
        }();
        test::run(world, 1);
        const std::vector<Vec3> left = corner_velocities(world, {0.5f, 0.5f, 0.5f});
        for (size_t i = 0; i < came.size(); ++i) EXPECT_GT(left[i].y, -e * came[i].y - 0.1f) << spin << " " << i;
        const RigidBodyRef box = world.get(world.body(1));
        const float before = 0.5f * box.mass() * (25.0f + dot(t.spin, t.spin) / 6.0f);
        EXPECT_LT(box.kinetic_energy(), before * 1.0001f) << spin;
    }
}

// What is made of several shapes, or lands on several.
TEST(FlatImpact, OfATableIsOneImpactOfItsLegs) {
    std::vector<ColliderDef> parts(5);
    parts[0].shape = Box{{0.8f, 0.05f, 0.5f}};
    for (size_t i = 1; i < 5; ++i) {
        parts[i].shape = Box{{0.05f, 0.4f, 0.05f}};
        parts[i].local.translation = {i % 2 ? 0.7f : -0.7f, -0.45f, i < 3 ? 0.4f : -0.4f};
    }
    for (ColliderDef& part : parts) part.material.restitution = 0.6f;
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    test::add_floor(world);
    const BodyId table =
        world.add_rigid_body({.position = {0.0f, 0.87f, 0.0f}, .velocity = {0.0f, -4.0f, 0.0f}, .colliders = parts})
            .value();
    test::run(world, 4);
    EXPECT_NEAR(world.get(table).velocity().y, 2.4f, 0.01f);
    EXPECT_LT(length(world.get(table).angular_velocity()), 0.01f);
}

TEST(FlatImpact, OnTheSeamOfTwoTilesIsOneImpact) {
    World world = WorldBuilder{}.no_gravity().bounciness(0.8f).sleep(false).build().value();
    for (float x : {-2.0f, 2.0f})
        for (float z : {-2.0f, 2.0f})
            world.add_static_body({.shape = Box{{2.0f, 0.5f, 2.0f}}, .position = {x, -0.5f, z}}).value();
    for (const float aside : {0.0f, 0.1f, 0.4f}) {
        const BodyId box =
            world.add_rigid_body({.shape = Box{}, .position = {aside, 0.55f, 0.1f}, .velocity = {0.0f, -3.0f, 0.0f}})
                .value();
        test::run(world, 3);
        EXPECT_NEAR(world.get(box).velocity().y, 2.4f, 0.01f) << aside;
        EXPECT_LT(length(world.get(box).angular_velocity()), 0.01f) << aside;
        world.remove_body(box).value();
    }
}

TEST(FlatImpact, OnAnEdgeIsOneImpactOfItsTwoCorners) {
    Thrown t;
    t.velocity = {0.0f, -4.0f, 0.0f};
    World world = WorldBuilder{}.no_gravity().no_friction().bounciness(0.5f).sleep(false).build().value();
    test::add_floor(world);
    const float tilt = 0.6f, high = 0.5f * (std::cos(tilt) + std::sin(tilt));
    const BodyId box = world
                           .add_rigid_body({.shape = Box{},
                                            .position = {0.0f, high + gap, 0.0f},
                                            .orientation = rotation_about({1.0f, 0.0f, 0.0f}, tilt),
                                            .velocity = t.velocity})
                           .value();
    test::run(world, 2);
    EXPECT_GT(std::fabs(world.get(box).angular_velocity().x), 1.0f);
    EXPECT_NEAR(world.get(box).angular_velocity().y, 0.0f, 0.01f);
    EXPECT_NEAR(world.get(box).angular_velocity().z, 0.0f, 0.01f);
}

// Two moving cubes, face to face: they exchange their velocities, and where they only half cover each other nothing is
// lost either.
TEST(FlatImpact, OfTwoCubesKeepsMomentaAndEnergy) {
    for (const float aside : {0.0f, 0.3f, 0.7f}) {
        World world = WorldBuilder{}.no_gravity().no_friction().max_bounciness().sleep(false).build().value();
        const BodyId a = world.add_rigid_body({.shape = Box{}, .velocity = {2.0f, 0.0f, 0.0f}}).value();
        const BodyId b = world.add_rigid_body({.shape = Box{}, .position = {1.02f, aside, 0.0f}}).value();
        const double energy = world.kinetic_energy();
        const Momentum before = world.momentum();
        test::run(world, 6);
        EXPECT_NEAR(world.kinetic_energy(), energy, 1e-4 * energy) << aside;
        const Momentum after = world.momentum();
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(after.linear[i], before.linear[i], 1e-3) << aside;
            EXPECT_NEAR(after.angular[i], before.angular[i], 0.5) << aside;
        }
        if (aside > 0.0f) continue;
        EXPECT_NEAR(world.get(a).velocity().x, 0.0f, 2e-3f);
        EXPECT_NEAR(world.get(b).velocity().x, 2.0f, 2e-3f);
        EXPECT_LT(length(world.get(b).angular_velocity()), 1e-3f);
    }
}

}  // namespace
}  // namespace lendulet
