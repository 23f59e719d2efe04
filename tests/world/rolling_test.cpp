// Rolling and spinning friction and tangential restitution through the public interface. Their closed forms are cases
// A15 and A34 of `lendulet verify`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

World heap(int width, int workers, bool rolls = true) {
    World world = WorldBuilder{}.down_gravity(9.81f).width(width).workers(workers).build().value();
    const float arm = rolls ? 0.01f : 0.0f;
    world
        .add_static_body({.shape = Box{{20.0f, 0.5f, 20.0f}},
                          .position = {0.0f, -0.5f, 0.0f},
                          .rolling_friction = arm,
                          .spinning_friction = arm})
        .value();
    for (int i = 0; i < 120; ++i) {
        Shape shape = Sphere{0.2f};
        if (i % 3 == 1) shape = Capsule{0.2f, 0.15f};
        if (i % 3 == 2) shape = Box{{0.2f, 0.15f, 0.1f}};
        const float x = 0.5f * static_cast<float>(i % 5) - 1.0f, z = 0.5f * static_cast<float>(i / 5 % 5) - 1.0f;
        world
            .add_rigid_body(
                {.shape = shape,
                 .position = {x + 0.01f * static_cast<float>(i % 7), 0.5f + 0.5f * static_cast<float>(i / 25), z},
                 .angular_velocity = {1.0f, 0.5f * x, z},
                 .rolling_friction = arm,
                 .spinning_friction = 0.5f * arm})
            .value();
    }
    return world;
}

TEST(RollingFriction, EveryWidthAndNumberOfWorkersGivesTheSameBits) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 5}}) {
        World world = heap(width, workers);
        for (int i = 0; i < 180; ++i) world.update(dt).value();
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width << " " << workers;
    }
    World without = heap(8, 1, false);
    for (int i = 0; i < 180; ++i) without.update(dt).value();
    EXPECT_NE(without.hash(), expected);
}

TEST(RollingFriction, GoesOnFromASnapshotAsItWas) {
    World world = heap(8, 1);
    for (int i = 0; i < 90; ++i) world.update(dt).value();
    const std::vector<uint8_t> saved = world.snapshot();
    const uint64_t then = world.hash();
    for (int i = 0; i < 60; ++i) world.update(dt).value();
    const uint64_t after = world.hash();
    world.restore(saved).value();
    EXPECT_EQ(world.hash(), then);
    EXPECT_EQ(world.snapshot(), saved);
    for (int i = 0; i < 60; ++i) world.update(dt).value();
    EXPECT_EQ(world.hash(), after);
}

// The torque acts on both bodies: what one loses of L the other gains. Two balls that rubber presses together end up
// turning as one.
TEST(RollingFriction, ConservesAngularMomentum) {
    World world = WorldBuilder{}.no_gravity().no_friction().build().value();
    RigidBodyDef ball{.shape = Sphere{0.5f}, .rolling_friction = 0.1f, .spinning_friction = 0.1f};
    ball.position = {-0.499f, 0.0f, 0.0f};
    ball.angular_velocity = {3.0f, 1.0f, 2.0f};
    BodyId a = world.add_rigid_body(ball).value();
    ball.position.x = 0.499f;
    ball.angular_velocity = {-1.0f, 0.0f, 1.0f};
    BodyId b = world.add_rigid_body(ball).value();
    JointDef rubber;
    rubber.type = JointType::distance;
    rubber.body_a = a, rubber.body_b = b;
    rubber.spring = {500.0f, 50.0f};
    rubber.collide_connected = true;
    world.add_joint(rubber).value();
    const Momentum before = world.momentum();
    for (int i = 0; i < 240; ++i) world.update(dt).value();
    const Momentum after = world.momentum();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after.angular[k], before.angular[k], 2e-3) << k;  // of 200 kg m^2/s
    EXPECT_LT(length(world.get(b).angular_velocity() - world.get(a).angular_velocity()), 1e-4f);
}

// By the rule of friction, the first of both in the list of rules.
TEST(RollingFriction, IsCombinedLikeFriction) {
    auto slowing = [](CombineRule rule, float ball_arm, float ground_arm) {
        World world = WorldBuilder{}.down_gravity(9.81f).build().value();
        auto part = [&](Shape shape, float arm) {
            ColliderDef c;
            c.shape = shape;
            c.material.rolling_friction = arm;
            c.material.friction_combine = rule;
            return c;
        };
        ColliderDef ground = part(Box{{20.0f, 0.5f, 5.0f}}, ground_arm), round = part(Sphere{0.5f}, ball_arm);
        world.add_static_body({.position = {0.0f, -0.5f, 0.0f}, .colliders = {&ground, 1}}).value();
        BodyId ball = world
                          .add_rigid_body({.position = {0.0f, 0.5f, 0.0f},
                                           .velocity = {2.0f, 0.0f, 0.0f},
                                           .angular_velocity = {0.0f, 0.0f, -4.0f},
                                           .colliders = {&round, 1}})
                          .value();
        for (int i = 0; i < 60; ++i) world.update(dt).value();
        return 2.0f - world.get(ball).velocity().x;
    };
    auto exact = [](float arm) { return 5.0f / 7.0f * 9.81f * arm / 0.5f; };
    EXPECT_NEAR(slowing(CombineRule::average, 0.02f, 0.04f), exact(0.03f), 0.01f);
    EXPECT_NEAR(slowing(CombineRule::minimum, 0.02f, 0.04f), exact(0.02f), 0.01f);
    EXPECT_NEAR(slowing(CombineRule::maximum, 0.02f, 0.04f), exact(0.04f), 0.01f);
    EXPECT_NEAR(slowing(CombineRule::average, 0.0f, 0.0f), 0.0f, 1e-4f);
}

// A rolling ball with it comes to rest and sleeps.
TEST(RollingFriction, LetsABallSleep) {
    World world = WorldBuilder{}.down_gravity(9.81f).build().value();
    world.add_static_body({.shape = Plane{}, .rolling_friction = 0.02f}).value();
    BodyId ball = world
                      .add_rigid_body({.shape = Sphere{0.5f},
                                       .position = {0.0f, 0.5f, 0.0f},
                                       .velocity = {1.0f, 0.0f, 0.0f},
                                       .rolling_friction = 0.02f})
                      .value();
    for (int i = 0; i < 600; ++i) world.update(dt).value();
    EXPECT_TRUE(world.get(ball).asleep());
}

// Eight tumbling boxes between walls, all of them bouncing with all of both kinds of restitution. `shift` sets them a
// little aside, from where they soon go ways of their own.
World bouncing_boxes(float shift) {
    World world = WorldBuilder{}.no_gravity().build().value();
    StaticBodyDef wall{.friction = 2.0f, .restitution = 1.0f, .tangential_restitution = 1.0f};
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            wall.shape = Box{{axis == 0 ? 0.5f : 4.0f, axis == 1 ? 0.5f : 4.0f, axis == 2 ? 0.5f : 4.0f}};
            Vec3 x{axis == 0 ? 2.5f : 0.0f, axis == 1 ? 2.5f : 0.0f, axis == 2 ? 2.5f : 0.0f};
            wall.position = at(side * x);
            world.add_static_body(wall).value();
        }
    for (int i = 0; i < 8; ++i) {
        Vec3 x{(i % 2 ? 0.8f : -0.8f) + shift, i / 2 % 2 ? 0.8f : -0.8f, i / 4 ? 0.8f : -0.8f};
        world
            .add_rigid_body({.shape = Box{{0.4f, 0.1f, 0.25f}},
                             .position = at(x),
                             .velocity = {-3.0f * x.y, 4.0f * x.z, 2.0f * x.x + 1.0f},
                             .angular_velocity = {3.0f, -2.0f * x.x, 5.0f * x.y},
                             .friction = 2.0f,
                             .restitution = 1.0f,
                             .tangential_restitution = 1.0f})
            .value();
    }
    return world;
}

// They gain no energy in an impact. Rarely one is found too late and its overlap is undone, which costs or gives a
// little: in 200 starts, of ten seconds each, 26 times, by 0.19 % at most.
TEST(TangentialRestitution, AddsNoEnergy) {
    constexpr int starts = 10;
    int rises = 0;
    for (int k = 0; k < starts; ++k) {
        World world = bouncing_boxes(1e-3f * static_cast<float>(k));
        const double start = world.kinetic_energy();
        double energy = start, largest_rise = 0.0;
        for (int i = 0; i < 600; ++i) {
            world.update(dt).value();
            const double now = world.kinetic_energy();
            largest_rise = std::max(largest_rise, now / energy - 1.0);
            rises += now > energy * (1.0 + 2e-6);
            energy = now;
        }
        EXPECT_LT(largest_rise, 2.5e-3) << "start " << k;
        EXPECT_GT(energy, 1.0);
        EXPECT_LT(energy, start) << "start " << k;
    }
    EXPECT_LE(rises, 4);
}

TEST(RollingFriction, RefusesWhatIsNoCoefficient) {
    World world = WorldBuilder{}.build().value();
    auto code = [&](auto change) {
        RigidBodyDef def{.shape = Sphere{0.5f}};
        change(def);
        Result<BodyId> added = world.add_rigid_body(def);
        return added.ok() ? ErrorCode::io : added.error().code;
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(code([](RigidBodyDef& d) { d.rolling_friction = -0.1f; }), ErrorCode::bad_material);
    EXPECT_EQ(code([](RigidBodyDef& d) { d.rolling_friction = nan; }), ErrorCode::bad_material);
    EXPECT_EQ(code([](RigidBodyDef& d) { d.spinning_friction = -1.0f; }), ErrorCode::bad_material);
    EXPECT_EQ(code([](RigidBodyDef& d) { d.tangential_restitution = 1.1f; }), ErrorCode::bad_material);
    EXPECT_EQ(world.body_count(), 0);
}

}  // namespace
}  // namespace lendulet
