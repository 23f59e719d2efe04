// Distance joints as rods, ropes, springs and winches, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

// A ball of 1 kg whose centre a distance joint ties to a hook at the origin.
struct Tied {
    World world = WorldBuilder{}.down_gravity(9.81f).sleep(false).build().value();
    BodyId hook, ball;
    JointId joint;

    Tied(Position from, Vec3 velocity, const JointDef& rows) {
        hook = world.add_static_body({.shape = Sphere{0.05f}}).value();
        ball = world.add_rigid_body({.shape = Sphere{0.05f}, .position = from, .velocity = velocity, .mass = 1.0f})
                   .value();
        JointDef def = rows;
        def.type = JointType::distance;
        def.body_a = hook;
        def.body_b = ball;
        joint = world.add_joint(def).value();
    }
    JointState state() const { return world.joint(joint); }
    double energy() const { return world.kinetic_energy() + world.potential_energy(); }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world.update(dt).value();
    }
};

JointDef of_length(float lower, float upper) {
    JointDef def;
    def.limit = {lower, upper};
    return def;
}

// T = 4 sqrt(l / g) K(sin(theta0 / 2)) from level: K(sin 45 degrees).
TEST(DistanceJoint, RodIsAPendulum) {
    Tied p({1.0f, 0.0f, 0.0f}, {}, of_length(1.0f, 1.0f));
    const double start = p.energy(), period = 4.0 * std::sqrt(1.0 / 9.81) * 1.8540746773013719;
    double first = 0.0, last = 0.0, most = 0.0;
    float before = 1.0f;
    int crossings = 0;
    for (int i = 1; i <= 1800; ++i) {
        p.run(1);
        ASSERT_NEAR(p.state().position, 1.0f, 2e-5f) << i;
        most = std::max(most, std::abs(p.energy() - start));
        float x = p.world.get(p.ball).position().x;
        if (before > 0.0f && x <= 0.0f) (crossings++ == 0 ? first : last) = (i - 1 + before / (before - x)) / 60.0;
        before = x;
    }
    EXPECT_NEAR((last - first) / (crossings - 1) / period, 1.0, 2e-4);
    EXPECT_LT(most / 9.81, 2e-3);
}

// Thrown up with the rope slack it flies freely until that is taut, and never beyond it.
TEST(DistanceJoint, RopeIsSlackUntilItIsTaut) {
    Tied p({0.3f, 0.0f, 0.0f}, {0.5f, 2.0f, 0.0f}, of_length(0.0f, 1.0f));
    p.run(12);
    EXPECT_NEAR(p.world.get(p.ball).position().y, 2.0f * 0.2f - 0.5f * 9.81f * 0.04f, 1e-5f);
    EXPECT_EQ(length(p.state().force), 0.0f);
    const double before = p.energy();
    for (int i = 0; i < 600; ++i) {
        p.run(1);
        ASSERT_LT(p.state().position, 1.0f + 2e-4f) << i;
        ASSERT_LT(p.energy(), before + 1e-3);
    }
    EXPECT_GT(p.state().position, 0.5f);
}

TEST(DistanceJoint, StrutKeepsApart) {
    Tied p({0.0f, 1.0f, 0.0f}, {}, of_length(0.8f, 10.0f));
    p.run(30);
    EXPECT_NEAR(p.state().position, 0.8f, 1e-4f);
    EXPECT_NEAR(p.state().force.y, 9.81f, 0.05f);
}

TEST(DistanceJoint, PassesThroughNoDistanceAtAll) {
    Tied p({0.0f, 1.0f, 0.0f}, {}, of_length(0.0f, 2.0f));
    p.run(60);
    EXPECT_LT(p.world.get(p.ball).position().y, -0.5f);  // fell past the hook
    EXPECT_EQ(p.world.statistics().contained_bodies, 0);
}

// m l'' = -k (l - l0) + m g: swings about l0 + m g / k at sqrt(k / m).
TEST(DistanceJoint, SpringSwingsAtItsFrequency) {
    JointDef def;
    def.spring = {39.4784176f, 0.0f, 0.5f};  // 1 Hz, pulls to 0.5 m
    Tied p({0.0f, -0.5f, 0.0f}, {}, def);
    const float middle = 0.5f + 9.81f / 39.4784176f;
    double first = 0.0, last = 0.0, before = 0.5 - static_cast<double>(middle);
    float highest = 0.0f;
    int crossings = 0;
    for (int i = 1; i <= 1200; ++i) {
        p.run(1);
        double x = static_cast<double>(p.state().position - middle);
        if (before < 0.0 && x >= 0.0) (crossings++ == 0 ? first : last) = (i - 1 + before / (before - x)) / 60.0;
        highest = maximum(highest, static_cast<float>(x));
        before = x;
    }
    EXPECT_NEAR((crossings - 1) / (last - first), 1.0, 1e-3);
    EXPECT_NEAR(highest, middle - 0.5f, 2e-3f);
}

TEST(DistanceJoint, WinchPullsAtItsSpeed) {
    JointDef def;
    def.motor = {-0.5f, 100.0f};
    Tied p({0.0f, -2.0f, 0.0f}, {}, def);
    p.run(60);
    EXPECT_NEAR(p.state().velocity, -0.5f, 1e-4f);
    EXPECT_NEAR(p.state().position, 1.5f, 0.02f);
    p.world.set_motor(p.joint, Motor{0.25f, 100.0f}).value();
    p.run(60);
    EXPECT_NEAR(p.state().velocity, 0.25f, 1e-4f);
    p.world.set_motor(p.joint, Motor{0.0f, 5.0f}).value();  // too weak for 9.81 N
    p.run(30);
    EXPECT_NEAR(p.state().velocity, 0.25f + 0.5f * (9.81f - 5.0f), 0.02f);
}

// Anchors off both centres of free bodies: momenta stay.
TEST(DistanceJoint, ConservesMomenta) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    CollisionFilter apart{.category = 1, .mask = 0};
    BodyId a = world
                   .add_rigid_body({.shape = Box{{0.5f, 0.2f, 0.1f}},
                                    .angular_velocity = {1.0f, 2.0f, 3.0f},
                                    .filter = apart,
                                    .mass = 1.0f})
                   .value();
    BodyId b = world
                   .add_rigid_body({.shape = Box{{0.3f, 0.5f, 0.2f}},
                                    .position = {2.0f, 0.0f, 0.0f},
                                    .velocity = {0.0f, 2.0f, -1.0f},
                                    .filter = apart,
                                    .mass = 2.0f})
                   .value();
    JointDef def;
    def.type = JointType::distance;
    def.body_a = a, def.body_b = b;
    def.frame_a.translation = {0.5f, 0.2f, 0.1f};
    def.frame_b.translation = {-0.3f, 0.1f, 0.2f};
    def.limit = {1.0f, 1.3f};
    JointId joint = world.add_joint(def).value();
    const Momentum before = world.momentum();
    for (int i = 0; i < 300; ++i) {
        world.update(dt).value();
        float x = world.joint(joint).position;
        ASSERT_TRUE(x > 1.0f - 1e-3f && x < 1.3f + 1e-3f) << i << " " << x;
    }
    const Momentum after = world.momentum();
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(after.linear[k], before.linear[k], 1e-5);
        EXPECT_NEAR(after.angular[k], before.angular[k], 2e-4);
    }
}

TEST(DistanceJoint, RefusesBadBounds) {
    Tied p({0.0f, 1.0f, 0.0f}, {}, of_length(0.0f, 2.0f));
    auto code = [&](Limit limit) {
        JointDef def;
        def.type = JointType::distance;
        def.body_a = p.hook, def.body_b = p.ball;
        def.limit = limit;
        Result<JointId> added = p.world.add_joint(def);
        return added.ok() ? ErrorCode::io : added.error().code;
    };
    EXPECT_EQ(code({-2.0f, -1.0f}), ErrorCode::bad_joint);
    EXPECT_EQ(code({2.0f, 1.0f}), ErrorCode::bad_joint);
    EXPECT_EQ(code({0.0f, std::numeric_limits<float>::quiet_NaN()}), ErrorCode::non_finite);
}

}  // namespace
}  // namespace lendulet
