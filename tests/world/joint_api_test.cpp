// Joints through the public interface: what is refused, what lives and dies with what, what is reported.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
using test::dt;

struct Pair {
    World world = WorldBuilder{}.down_gravity(9.81f).build().value();
    BodyId post = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
    BodyId rod = world
                     .add_rigid_body({.shape = Box{{0.5f, 0.05f, 0.05f}},
                                      .position = {0.5f, 0.0f, 0.0f},
                                      .mass = 1.0f,
                                      .allow_sleep = false})
                     .value();

    JointDef hinge() const { return world.joint_at(JointType::hinge, post, rod, {}, {0.0f, 0.0f, 1.0f}).value(); }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world.update(dt).value();
    }
};

ErrorCode refusal(const Result<JointId>& r) {
    EXPECT_FALSE(r.ok());
    return r.ok() ? ErrorCode::io : r.error().code;
}

TEST(JointApi, RefusesWhatMakesNoSense) {
    Pair p;
    BodyId other_post = p.world.add_static_body({.position = {5.0f, 0.0f, 0.0f}}).value();
    BodyId mover = p.world.add_rigid_body({.position = {9.0f, 0.0f, 0.0f}, .kinematic = true}).value();
    BodyId gone = p.world.add_rigid_body({.position = {20.0f, 0.0f, 0.0f}}).value();
    p.world.remove_body(gone).value();
    auto refused = [&](auto change) {
        JointDef def = p.hinge();
        change(def);
        return refusal(p.world.add_joint(def));
    };
    EXPECT_EQ(refused([&](JointDef& d) { d.body_a = gone; }), ErrorCode::stale_id);
    EXPECT_EQ(refused([&](JointDef& d) { d.body_b = BodyId{}; }), ErrorCode::stale_id);
    EXPECT_EQ(refused([&](JointDef& d) { d.body_a = d.body_b; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) { d.body_b = other_post; }), ErrorCode::no_dynamic_body);
    EXPECT_EQ(refused([&](JointDef& d) { d.body_b = mover; }), ErrorCode::no_dynamic_body);
    EXPECT_EQ(refused([&](JointDef& d) { d.frame_a.translation.x = nan_value; }), ErrorCode::non_finite);
    EXPECT_EQ(refused([&](JointDef& d) { d.frame_b.rotation = {0.0f, 0.0f, 0.0f, 2.0f}; }), ErrorCode::bad_rotation);
    EXPECT_EQ(refused([&](JointDef& d) { d.limit = {0.5f, 0.4f}; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) { d.limit = {nan_value, 0.4f}; }), ErrorCode::non_finite);
    EXPECT_EQ(refused([&](JointDef& d) { d.limit = {-7.0f, 0.4f}; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) { d.motor.max_force = -1.0f; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) { d.motor.target_velocity = nan_value; }), ErrorCode::non_finite);
    EXPECT_EQ(refused([&](JointDef& d) { d.spring.stiffness = -1.0f; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) { d.type = JointType::ball, d.swing_limit = -0.1f; }), ErrorCode::bad_joint);
    EXPECT_EQ(refused([&](JointDef& d) {
                  d.type = JointType::ball, d.twist_limit = {1.0f, 0.0f};
              }),
              ErrorCode::bad_joint);
    EXPECT_EQ(p.world.joint_count(), 0);
    EXPECT_EQ(p.world.joint_at(JointType::ball, p.post, p.rod, {}, {}).error().code, ErrorCode::bad_joint);
    EXPECT_EQ(p.world.joint_at(JointType::ball, p.post, p.rod, {nan_value, 0.0f, 0.0f}).error().code,
              ErrorCode::non_finite);
    Result<JointId> refused_sentence = p.world.add_joint({.body_a = p.rod, .body_b = p.rod});
    EXPECT_EQ(refused_sentence.error().message, "add_joint: body A and body B are the same");
}

TEST(JointApi, StaleIdsAreDetectedAlsoWhenSlotsAreUsedAgain) {
    Pair p;
    JointId first = p.world.add_joint(p.hinge()).value();
    EXPECT_TRUE(p.world.alive(first));
    p.world.remove_joint(first).value();
    EXPECT_FALSE(p.world.alive(first));
    JointId second = p.world.add_joint(p.hinge()).value();
    EXPECT_EQ(first.index, second.index);
    EXPECT_EQ(p.world.remove_joint(first).error().code, ErrorCode::stale_id);
    EXPECT_EQ(p.world.set_motor(first, {}).error().code, ErrorCode::stale_id);
    EXPECT_EQ(p.world.joint_count(), 1);
    EXPECT_EQ(p.world.joint_id(0), second);
    EXPECT_FALSE(p.world.joint_id(1));
}

TEST(JointApi, RemovingABodyRemovesItsJoints) {
    Pair p;
    BodyId tip = p.world.add_rigid_body({.position = {2.0f, 0.0f, 0.0f}}).value();
    JointId hinge = p.world.add_joint(p.hinge()).value();
    JointId ball = p.world.add_joint(p.world.joint_at(JointType::ball, p.rod, tip, {1.0f, 0.0f, 0.0f}).value()).value();
    JointId weld =
        p.world.add_joint(p.world.joint_at(JointType::fixed, p.post, tip, {1.0f, 0.0f, 0.0f}).value()).value();
    p.run(5);
    p.world.remove_body(p.rod).value();
    EXPECT_FALSE(p.world.alive(hinge));
    EXPECT_FALSE(p.world.alive(ball));
    EXPECT_TRUE(p.world.alive(weld));
    EXPECT_EQ(p.world.joint_count(), 1);
    p.run(5);
    EXPECT_EQ(p.world.check(), "");
    EXPECT_EQ(p.world.joint(weld).body_b, tip);
}

TEST(JointApi, ConnectedBodiesPassThroughEachOtherUnlessAskedOtherwise) {
    for (bool collide : {false, true}) {
        World world = WorldBuilder{}.no_gravity().build().value();
        BodyId a = world.add_rigid_body({.shape = Sphere{0.5f}}).value();
        BodyId b = world.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.8f, 0.0f, 0.0f}}).value();
        JointDef def = world.joint_at(JointType::slider, a, b, {}).value();
        def.collide_connected = collide;
        JointId joint = world.add_joint(def).value();
        world.update(dt).value();
        EXPECT_EQ(world.contact_count(), collide ? 1 : 0);
        world.remove_joint(joint).value();
        world.update(dt).value();
        EXPECT_EQ(world.contact_count(), 1);
    }
}

TEST(JointApi, PendulumReportsAngleSpeedAndForce) {
    Pair p;
    JointId joint = p.world.add_joint(p.hinge()).value();
    double start = p.world.kinetic_energy() + p.world.potential_energy();
    float lowest = 0.0f;
    for (int i = 0; i < 600; ++i) {
        p.run(1);
        JointState s = p.world.joint(joint);
        ASSERT_NEAR(p.world.kinetic_energy() + p.world.potential_energy(), start, 1e-3);
        ASSERT_LT(length(s.linear_error), 5e-6f);
        ASSERT_LT(s.angular_error, 1e-5f);
        RigidBodyRef rod = p.world.get(p.rod);
        ASSERT_NEAR(s.velocity, rod.angular_velocity().z, 1e-4f);
        ASSERT_NEAR(std::cos(s.position), rod.centre_of_mass().x / 0.5f, 1e-3f);
        lowest = std::min(lowest, s.position);
    }
    EXPECT_NEAR(lowest, -pi, 0.05f);
}

TEST(JointApi, JointCarriesTheWeight) {
    Pair p;
    JointId weld = p.world.add_joint(p.world.joint_at(JointType::fixed, p.post, p.rod, {}).value()).value();
    p.run(120);
    JointState s = p.world.joint(weld);
    EXPECT_EQ(s.type, JointType::fixed);
    EXPECT_NEAR(s.force.y, 9.81f, 0.01f);
    EXPECT_NEAR(s.torque.z, 9.81f * 0.5f, 0.01f);
}

// A wheel on a hinge that has gone to sleep.
struct SleepingWheel {
    World world = WorldBuilder{}.no_gravity().build().value();
    BodyId wheel = world.add_rigid_body({.shape = Cylinder{0.1f, 0.5f}, .position = {0.0f, 3.0f, 0.0f}}).value();
    JointId axle = world
                       .add_joint(world
                                      .joint_at(JointType::hinge, world.add_static_body({}).value(), wheel,
                                                {0.0f, 3.0f, 0.0f}, {0.0f, 1.0f, 0.0f})
                                      .value())
                       .value();
    SleepingWheel() {
        for (int i = 0; i < 120; ++i) world.update(dt).value();
        EXPECT_TRUE(world.get(wheel).asleep());
    }
};

TEST(JointApi, MotorIsSetAndWakesItsBodies) {
    SleepingWheel w;
    auto& [world, wheel, axle] = w;
    world.set_motor(axle, {5.0f, 1e4f}).value();
    for (int i = 0; i < 10; ++i) world.update(dt).value();
    EXPECT_FALSE(world.get(wheel).asleep());
    EXPECT_NEAR(world.get(wheel).angular_velocity().y, 5.0f, 1e-4f);
    EXPECT_NEAR(world.joint(axle).velocity, 5.0f, 1e-4f);
    EXPECT_EQ(world.set_motor(axle, {nan_value, 1.0f}).error().code, ErrorCode::non_finite);
}

TEST(JointApi, MotorIsRefusedByOtherJoints) {
    Pair p;
    JointId ball = p.world.add_joint(p.world.joint_at(JointType::ball, p.post, p.rod, {}).value()).value();
    EXPECT_EQ(p.world.set_motor(ball, {1.0f, 1.0f}).error().code, ErrorCode::bad_joint);
}

// A servo: the spring's target is set, and a resting arm goes there.
TEST(JointApi, SpringIsSetAndWakesItsBodies) {
    SleepingWheel w;
    auto& [world, wheel, axle] = w;
    for (float target : {1.2f, -0.7f}) {
        const Spring spring{.stiffness = 1000.0f, .damping = 200.0f, .target = target};
        world.set_spring(axle, spring).value();
        world.update(dt).value();
        EXPECT_FALSE(world.get(wheel).asleep());
        for (int i = 0; i < 240; ++i) world.update(dt).value();
        EXPECT_NEAR(world.joint(axle).position, target, 1e-3f);
        EXPECT_EQ(world.joint_def(axle).spring.target, target);
        EXPECT_EQ(world.joint_def(axle).spring.stiffness, 1000.0f);
    }
}

// As if the joint had been made with it, whichever way its rows are kept.
TEST(JointApi, SpringSetLaterIsThatOfTheDefinition) {
    const Spring spring{.stiffness = 300.0f, .damping = 5.0f, .target = 0.6f, .max_force = 400.0f};
    for (JointType type : {JointType::hinge, JointType::slider, JointType::distance}) {
        uint64_t hashes[2];
        for (bool later : {false, true}) {
            Pair p;
            JointDef def = p.world.joint_at(type, p.post, p.rod, {}).value();
            if (!later) def.spring = spring;
            JointId joint = p.world.add_joint(def).value();
            if (later) p.world.set_spring(joint, spring).value();
            p.run(90);
            hashes[later] = p.world.hash();
        }
        EXPECT_EQ(hashes[0], hashes[1]) << static_cast<int>(type);
    }
}

TEST(JointApi, SpringIsRefused) {
    Pair p;
    JointId ball = p.world.add_joint(p.world.joint_at(JointType::ball, p.post, p.rod, {}).value()).value();
    EXPECT_EQ(p.world.set_spring(ball, {1.0f, 1.0f}).error().code, ErrorCode::bad_joint);
    EXPECT_EQ(p.world.set_spring(ball, Coordinate::x, {1.0f, 1.0f}).error().code, ErrorCode::bad_joint);
    JointId hinge = p.world.add_joint(p.world.joint_at(JointType::hinge, p.post, p.rod, {}).value()).value();
    p.world.set_spring(hinge, {3.0f, 1.0f}).value();
    EXPECT_EQ(p.world.set_spring(hinge, {-1.0f, 1.0f}).error().code, ErrorCode::bad_joint);
    EXPECT_EQ(p.world.set_spring(hinge, {.stiffness = 1.0f, .target = nan_value}).error().code, ErrorCode::non_finite);
    EXPECT_EQ(p.world.joint_def(hinge).spring.stiffness, 3.0f);
    p.world.remove_joint(hinge).value();
    EXPECT_EQ(p.world.set_spring(hinge, {1.0f, 1.0f}).error().code, ErrorCode::stale_id);
}

// A kinematic body carries what hangs on it, whichever side of the joint it is.
TEST(JointApi, KinematicBodyDrivesThroughAJoint) {
    for (bool first : {true, false}) {
        World world = WorldBuilder{}.no_gravity().build().value();
        BodyId turntable =
            world.add_rigid_body({.shape = Sphere{0.1f}, .angular_velocity = {0.0f, 0.0f, 2.0f}, .kinematic = true})
                .value();
        BodyId load = world.add_rigid_body({.shape = Sphere{0.2f}, .position = {1.0f, 0.0f, 0.0f}}).value();
        BodyId a = first ? turntable : load, b = first ? load : turntable;
        JointId weld = world.add_joint(world.joint_at(JointType::fixed, a, b, {0.5f, 0.0f, 0.0f}).value()).value();
        for (int i = 0; i < 120; ++i) world.update(dt).value();
        EXPECT_NEAR(length(world.get(load).velocity()), 2.0f, 1e-3f);
        EXPECT_NEAR(world.get(load).angular_velocity().z, 2.0f, 1e-3f);
        EXPECT_LT(length(world.joint(weld).linear_error), 1e-4f);
    }
}

// Slider-crank (r 0.2 m, l 0.5 m): x = r cos(phi) + sqrt(l^2 - r^2 sin^2(phi)), a closed loop through all joint types.
TEST(JointApi, SliderCrankFollowsItsLaw) {
    World world = WorldBuilder{}.no_gravity().build().value();
    constexpr float r = 0.2f, l = 0.5f;
    constexpr Vec3 axis{0.0f, 0.0f, 1.0f};
    CollisionFilter apart{.category = 1, .mask = 0};
    BodyId ground = world.add_static_body({.filter = apart}).value();
    auto bar = [&](float from, float to) {
        return world
            .add_rigid_body({.shape = Box{{0.5f * (to - from), 0.02f, 0.02f}},
                             .position = {0.5f * (from + to), 0.0f, 0.0f},
                             .filter = apart,
                             .mass = 1.0f,
                             .allow_sleep = false})
            .value();
    };
    BodyId crank = bar(0.0f, r), rod = bar(r, r + l);
    BodyId piston =
        world.add_rigid_body({.shape = Sphere{0.05f}, .position = {r + l, 0.0f, 0.0f}, .filter = apart, .mass = 1.0f})
            .value();
    JointDef drive = world.joint_at(JointType::hinge, ground, crank, {}, axis).value();
    drive.motor = {10.0f, 1e5f};
    JointId motor = world.add_joint(drive).value();
    JointId joints[] = {
        motor, world.add_joint(world.joint_at(JointType::hinge, crank, rod, {r, 0.0f, 0.0f}, axis).value()).value(),
        world.add_joint(world.joint_at(JointType::hinge, rod, piston, {r + l, 0.0f, 0.0f}, axis).value()).value(),
        world.add_joint(world.joint_at(JointType::slider, ground, piston, {r + l, 0.0f, 0.0f}).value()).value()};
    for (int i = 0; i < 600; ++i) {
        world.update(dt).value();
        float phi = world.joint(motor).position;
        float x = r * std::cos(phi) + std::sqrt(l * l - r * r * std::sin(phi) * std::sin(phi));
        ASSERT_NEAR(world.get(piston).position().x, x, 1e-3f) << i;
        for (JointId joint : joints) ASSERT_LT(length(world.joint(joint).linear_error), 5e-4f) << i;
        if (i > 10) {
            ASSERT_NEAR(world.joint(motor).velocity, 10.0f, 0.1f) << i;
        }
    }
}

// A jointed chain dropped on the ground comes to rest and sleeps, the same for every width and number of workers.
TEST(JointApi, ChainOnTheGroundRestsAlikeForEveryWidthAndWorker) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 5}}) {
        World world = WorldBuilder{}.down_gravity(9.81f).width(width).workers(workers).build().value();
        world.add_static_body({.shape = Box{{20.0f, 0.5f, 20.0f}}, .position = {0.0f, -0.5f, 0.0f}}).value();
        BodyId last{};
        for (int i = 0; i < 12; ++i) {
            BodyId link = world
                              .add_rigid_body({.shape = Box{{0.25f, 0.1f, 0.1f}},
                                               .position = {0.6f * static_cast<float>(i),
                                                            0.5f + 0.05f * static_cast<float>(i), 0.0f}})
                              .value();
            Position anchor{0.6f * static_cast<float>(i) - 0.3f, 0.5f + 0.05f * static_cast<float>(i), 0.0f};
            if (i > 0) {
                JointDef def = world
                                   .joint_at(i % 3 == 0 ? JointType::hinge : JointType::ball, last, link, anchor,
                                             {0.0f, 0.0f, 1.0f})
                                   .value();
                def.swing_limit = 1.0f;
                def.twist_limit = {-0.5f, 0.5f};
                def.limit = {-0.8f, 0.8f};
                world.add_joint(def).value();
            }
            last = link;
        }
        for (int i = 0; i < 240; ++i) world.update(dt).value();
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width << " " << workers;
        EXPECT_LT(length(world.get(last).velocity()), 0.05f);
        for (int i = 0; i < world.joint_count(); ++i)
            EXPECT_LT(length(world.joint(world.joint_id(i)).linear_error), 2e-3f);
    }
}

}  // namespace
}  // namespace lendulet
