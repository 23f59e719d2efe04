// Dry friction in joints: what moves comes to rest, and what less would move stays where it is.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

ErrorCode refusal_of(const Status& s) { return s.ok() ? ErrorCode::io : s.error().code; }

// A box of 10 kg, weightless or not, on a joint to a post at its centre or beside it.
struct Machine {
    World world;
    BodyId post, body;
    JointId joint;
    float inertia(Vec3 axis) const { return 1.0f / dot(axis, world.get(body).inverse_inertia() * axis); }
};
Machine machine(JointType type, Vec3 axis, float friction, Vec3 place = {}, Vec3 gravity = {}, int width = 8) {
    World world = WorldBuilder{}.gravity(gravity).width(width).build().value();
    const BodyId post = world.add_static_body({.shape = Sphere{0.1f}}).value();
    const BodyId body =
        world.add_rigid_body({.shape = Box{{0.5f, 0.1f, 0.15f}}, .position = at(place), .mass = 10.0f}).value();
    JointDef def = world.joint_at(type, post, body, {}, axis).value();
    if (type == JointType::six_degrees) {
        for (auto& a : def.axes.linear) a.limit = {0.0f, 0.0f};
        def.axes.angular[1].limit = def.axes.angular[2].limit = {0.0f, 0.0f};
        def.axes.angular[0].friction = friction;
    } else {
        def.friction = friction;
    }
    const JointId joint = world.add_joint(def).value();
    return {std::move(world), post, body, joint};
}

// Angular speed falls by torque / inertia until it is nothing.
TEST(JointFriction, SlowsATurningBodyEvenly) {
    for (JointType type : {JointType::hinge, JointType::ball, JointType::six_degrees})
        for (int width : widths) {
            const Vec3 axis{0.0f, 1.0f, 0.0f};
            Machine m = machine(type, axis, 0.4f, {}, {}, width);
            m.world.get(m.body).set_angular_velocity({0.0f, 2.0f, 0.0f}).value();
            run(m.world, 60);
            EXPECT_NEAR(m.world.get(m.body).angular_velocity().y, 2.0f - 0.4f / m.inertia(axis), 2e-3f)
                << static_cast<int>(type);
            EXPECT_NEAR(m.world.joint(m.joint).torque.y, -0.4f, 1e-4f);
            run(m.world, 240);
            EXPECT_LT(length(m.world.get(m.body).angular_velocity()), 1e-5f);
            EXPECT_TRUE(m.world.get(m.body).asleep());
        }
}

TEST(JointFriction, SlowsASliderAndADistance) {
    for (JointType type : {JointType::slider, JointType::distance}) {
        Machine m = machine(type, {1.0f, 0.0f, 0.0f}, 5.0f, {2.0f, 0.0f, 0.0f});
        m.world.get(m.body).set_velocity({1.0f, 0.0f, 0.0f}).value();
        run(m.world, 60);
        EXPECT_NEAR(m.world.get(m.body).velocity().x, 0.5f, 2e-3f);
        run(m.world, 90);
        EXPECT_NEAR(m.world.get(m.body).position().x, 3.0f, 5e-3f);  // v^2 m / (2 F)
        EXPECT_LT(length(m.world.get(m.body).velocity()), 1e-5f);
    }
}

// An arm that stands out: 10 kg at 0.5 m need 49 N m.
TEST(JointFriction, HoldsWhatLessWouldMove) {
    for (JointType type : {JointType::hinge, JointType::ball}) {
        const Vec3 axis{0.0f, 0.0f, 1.0f};
        Machine m = machine(type, axis, 50.0f, {0.5f, 0.0f, 0.0f}, {0.0f, -9.81f, 0.0f});
        run(m.world, 300);
        EXPECT_GT(m.world.get(m.body).position().y, -1e-3f) << static_cast<int>(type);
        m.world.set_friction(m.joint, 40.0f).value();  // wakes it
        run(m.world, 6);
        const float about_post = m.inertia(axis) + 10.0f * 0.25f;
        EXPECT_NEAR(m.world.get(m.body).angular_velocity().z, -(9.81f * 5.0f - 40.0f) / about_post * 0.1f, 0.01f);
        m.world.set_friction(m.joint, infinite).value();
        run(m.world, 2);
        EXPECT_LT(length(m.world.get(m.body).angular_velocity()), 1e-4f);
    }
}

// The moments about two axes are as 10 to 1: friction must not turn the axis of rotation beyond what both slow down at.
TEST(JointFriction, OfABallActsAgainstTheTurning) {
    Machine m = machine(JointType::ball, {1.0f, 0.0f, 0.0f}, 0.3f);
    const Vec3 spin{1.5f, 1.0f, 0.5f};
    m.world.get(m.body).set_angular_velocity(spin).value();
    float energy = m.world.get(m.body).kinetic_energy();
    for (int i = 0; i < 40; ++i) {
        const Vec3 before = m.world.get(m.body).angular_velocity();
        run(m.world, 1);
        const Vec3 after = m.world.get(m.body).angular_velocity(), torque = m.world.joint(m.joint).torque;
        ASSERT_NEAR(length(torque), 0.3f, 2e-3f) << i;
        const Vec3 mean = normalize(0.5f * (before + after));
        ASSERT_LT(dot(normalize(torque), mean), -0.999f) << i;
        ASSERT_LT(m.world.get(m.body).kinetic_energy(), energy) << i;
        energy = m.world.get(m.body).kinetic_energy();
    }
}

TEST(JointFriction, KeepsMomentumAndAngularMomentum) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    BodyId ids[2];
    for (int i = 0; i < 2; ++i)
        ids[i] = world
                     .add_rigid_body({.shape = Capsule{0.1f, 0.4f},
                                      .position = {static_cast<float>(i), 0.0f, 0.0f},
                                      .angular_velocity = {1.0f, i == 0 ? 2.0f : -3.0f, 0.5f},
                                      .mass = 1.0f + static_cast<float>(i)})
                     .value();
    JointDef def = world.joint_at(JointType::ball, ids[0], ids[1], {0.5f, 0.1f, 0.0f}, {1.0f, 0.0f, 0.0f}).value();
    def.friction = 0.2f;
    def.swing_limit = 0.8f;
    world.add_joint(def).value();
    run(world, 1);
    const Momentum before = world.momentum();
    run(world, 600);
    const Momentum after = world.momentum();
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(after.linear[i], before.linear[i], 1e-5);
        EXPECT_NEAR(after.angular[i], before.angular[i], 1e-4);
    }
    // They turn as one in the end.
    EXPECT_LT(length(world.get(ids[0]).angular_velocity() - world.get(ids[1]).angular_velocity()), 1e-3f);
}

// Limbs that hang from each other swing for a minute without.
TEST(JointFriction, BringsAHangingChainToRest) {
    for (float friction : {0.0f, 10.0f}) {
        World world = WorldBuilder{}.build().value();
        BodyId last = world.add_static_body({.shape = Sphere{0.05f}, .position = {0.0f, 5.0f, 0.0f}}).value();
        for (int i = 0; i < 4; ++i) {
            const float x = 0.5f * static_cast<float>(i);
            const BodyId limb =
                world
                    .add_rigid_body(
                        {.shape = Box{{0.25f, 0.05f, 0.05f}}, .position = {x + 0.25f, 5.0f, 0.0f}, .mass = 4.0f})
                    .value();
            JointDef def = world.joint_at(JointType::ball, last, limb, {x, 5.0f, 0.0f}).value();
            def.twist_limit = {-0.5f, 0.5f};
            def.friction = friction;
            world.add_joint(def).value();
            last = limb;
        }
        run(world, 60 * 15);
        EXPECT_EQ(world.get(last).asleep(), friction > 0.0f);
        EXPECT_EQ(world.check(), "");
    }
}

TEST(JointFriction, AMotorTakesItsPlace) {
    Machine m = machine(JointType::hinge, {0.0f, 1.0f, 0.0f}, infinite);
    m.world.set_motor(m.joint, {1.0f, 100.0f}).value();
    run(m.world, 10);
    EXPECT_NEAR(m.world.joint(m.joint).velocity, 1.0f, 1e-4f);
    m.world.set_motor(m.joint, {}).value();
    run(m.world, 2);
    EXPECT_LT(std::abs(m.world.joint(m.joint).velocity), 1e-4f);
}

TEST(JointFriction, OfACone) {
    // Without width a ball joint is a hinge.
    World world = WorldBuilder{}.no_gravity().build().value();
    const BodyId post = world.add_static_body({.shape = Sphere{0.1f}}).value();
    const BodyId body =
        world.add_rigid_body({.shape = Box{{0.5f, 0.1f, 0.1f}}, .angular_velocity = {0.0f, 2.0f, 0.0f}, .mass = 10.0f})
            .value();
    JointDef def = world.joint_at(JointType::ball, post, body, {}, {0.0f, 1.0f, 0.0f}).value();
    def.swing_limit = 0.0f;
    def.friction = 1.0f;
    const JointId joint = world.add_joint(def).value();
    run(world, 30);
    EXPECT_NEAR(world.get(body).angular_velocity().y, 2.0f - 0.5f * world.get(body).inverse_inertia().yy, 2e-3f);
    world.set_limit(joint, Coordinate::swing, {0.0f, 1.0f}).value();
    run(world, 30);
    EXPECT_NEAR(world.get(body).angular_velocity().y, 2.0f - world.get(body).inverse_inertia().yy, 4e-3f);
    world.set_friction(joint, 0.0f).value();
    const float speed = world.get(body).angular_velocity().y;
    run(world, 30);
    EXPECT_NEAR(world.get(body).angular_velocity().y, speed, 1e-4f);
}

TEST(JointFriction, IsRefusedWhereItCannotBe) {
    Machine m = machine(JointType::hinge, {0.0f, 1.0f, 0.0f}, 1.0f);
    const float nan = std::nanf("");
    EXPECT_EQ(refusal_of(m.world.set_friction(m.joint, nan)), ErrorCode::non_finite);
    EXPECT_EQ(refusal_of(m.world.set_friction(m.joint, -1.0f)), ErrorCode::bad_joint);
    EXPECT_EQ(refusal_of(m.world.set_friction(m.joint, Coordinate::x, 1.0f)), ErrorCode::bad_joint);
    EXPECT_EQ(m.world.joint_def(m.joint).friction, 1.0f);
    JointDef def = m.world.joint_def(m.joint);
    def.friction = -1.0f;
    EXPECT_EQ(m.world.add_joint(def).error().code, ErrorCode::bad_joint);
    def.friction = nan;
    EXPECT_EQ(m.world.add_joint(def).error().code, ErrorCode::non_finite);
    def = m.world.joint_at(JointType::fixed, m.post, m.body, {}).value();
    const JointId fixed = m.world.add_joint(def).value();
    EXPECT_EQ(refusal_of(m.world.set_friction(fixed, 1.0f)), ErrorCode::bad_joint);
    def.type = JointType::six_degrees;
    def.axes.angular[1].friction = -1.0f;
    EXPECT_EQ(m.world.add_joint(def).error().code, ErrorCode::bad_joint);
    def.axes.angular[1].friction = 2.0f;
    const JointId six = m.world.add_joint(def).value();
    EXPECT_EQ(refusal_of(m.world.set_friction(six, 1.0f)), ErrorCode::bad_joint);
    EXPECT_EQ(refusal_of(m.world.set_friction(six, Coordinate::distance, 1.0f)), ErrorCode::bad_joint);
    EXPECT_EQ(refusal_of(m.world.set_friction(six, Coordinate::about_y, nan)), ErrorCode::non_finite);
    m.world.set_friction(six, Coordinate::about_y, 3.0f).value();
    EXPECT_EQ(m.world.joint_def(six).axes.angular[1].friction, 3.0f);
    m.world.remove_joint(six).value();
    EXPECT_EQ(refusal_of(m.world.set_friction(six, Coordinate::about_y, 1.0f)), ErrorCode::stale_id);
}

// A snapshot goes back before the change, and holds what friction held.
TEST(JointFriction, IsInSnapshots) {
    for (JointType type : {JointType::hinge, JointType::ball, JointType::six_degrees}) {
        Machine m = machine(type, {0.0f, 1.0f, 0.0f}, 0.4f, {}, {0.0f, -1.0f, 0.0f});
        auto set = [&](float friction) {
            if (type == JointType::six_degrees) m.world.set_friction(m.joint, Coordinate::about_x, friction).value();
            else m.world.set_friction(m.joint, friction).value();
        };
        m.world.get(m.body).set_angular_velocity({0.3f, 2.0f, 0.1f}).value();
        run(m.world, 20);
        const std::vector<uint8_t> saved = m.world.snapshot();
        World other = m.world.fork().value();
        run(other, 30);
        run(m.world, 30);
        const uint64_t expected = m.world.hash();
        EXPECT_EQ(other.hash(), expected);
        set(0.0f);
        run(m.world, 5);
        m.world.restore(saved).value();
        EXPECT_EQ(m.world.snapshot(), saved);
        run(m.world, 30);
        EXPECT_EQ(m.world.hash(), expected) << static_cast<int>(type);
    }
}

// The same bits for any number of lanes and workers, beside joints without friction.
TEST(JointFriction, GivesTheSameBits) {
    uint64_t expected = 0;
    for (int width : widths)
        for (int workers : {1, 3}) {
            World world = WorldBuilder{}.width(width).workers(workers).build().value();
            add_floor(world);
            for (int k = 0; k < 12; ++k) {
                BodyId last{};
                for (int i = 0; i < 5; ++i) {
                    const Position place{0.6f * static_cast<float>(i), 2.0f + 0.1f * static_cast<float>(k),
                                         static_cast<float>(k)};
                    const BodyId limb =
                        world.add_rigid_body({.shape = Capsule{0.1f, 0.25f}, .position = place}).value();
                    if (i > 0) {
                        JointDef def = world
                                           .joint_at(i == 4 ? JointType::hinge : JointType::ball, last, limb,
                                                     place - Vec3{0.3f, 0.0f, 0.0f})
                                           .value();
                        def.friction = static_cast<float>((i + k) % 3);
                        if (i == 2) def.swing_limit = 0.7f;
                        world.add_joint(def).value();
                    }
                    last = limb;
                }
            }
            run(world, 90);
            if (expected == 0) expected = world.hash();
            EXPECT_EQ(world.hash(), expected) << width << " lanes, " << workers << " workers";
        }
}

}  // namespace
}  // namespace lendulet::test
