// Motors on what turns: a coordinate changes by what its motor was told, though the motion itself would change it.
#include <gtest/gtest.h>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt, test::run;

constexpr CollisionFilter apart{.category = 1, .mask = 0};

struct Machine {
    World world;
    BodyId hub, body;
    JointId joint;
};

// A hub that turns evenly about y, and a box of 10 kg at `place` that begins at rest as seen from it, on a joint there.
Machine turning(JointType type, Vec3 place, float tilt, Vec3 anchor, Vec3 axis, Motor motor, float spin, int width = 8,
                int workers = 1) {
    World world = WorldBuilder{}.no_gravity().sleep(false).width(width).workers(workers).build().value();
    const Vec3 w{0.0f, spin, 0.0f};
    BodyId hub =
        world.add_rigid_body({.shape = Cylinder{0.1f, 0.1f}, .angular_velocity = w, .filter = apart, .kinematic = true})
            .value();
    BodyId body = world
                      .add_rigid_body({.shape = Box{{0.5f, 0.05f, 0.05f}},
                                       .position = at(place),
                                       .orientation = rotation_about({0.0f, 0.0f, 1.0f}, tilt),
                                       .velocity = cross(w, place),
                                       .angular_velocity = w,
                                       .filter = apart,
                                       .mass = 10.0f})
                      .value();
    JointDef def = world.joint_at(type, hub, body, at(anchor), axis).value();
    if (type == JointType::six_degrees) {
        for (auto& a : def.axes.linear) a.limit = {0.0f, 0.0f};
        for (auto& a : def.axes.angular) a.limit = {0.0f, 0.0f};
        def.axes.linear[0] = {.motor = motor};
    } else {
        def.motor = motor;
    }
    const JointId joint = world.add_joint(def).value();
    return {std::move(world), hub, body, joint};
}
Machine on_rail(JointType type, Motor motor, float spin = 10.0f) {
    return turning(type, {1.0f, 0.0f, 0.0f}, 0.0f, {1.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, motor, spin);
}
float travel(const Machine& m) {
    const Vec3 way = m.world.get(m.body).position() - m.world.get(m.hub).position();
    return length(way) - 1.0f;
}

TEST(TurningMotors, HoldASliderWhereItIs) {
    for (JointType type : {JointType::slider, JointType::six_degrees}) {
        Machine m = on_rail(type, {0.0f, 1e6f});
        run(m.world, 120);
        EXPECT_LT(std::abs(travel(m)), 1e-4f);
    }
}

TEST(TurningMotors, DriveASliderAtTheirSpeed) {
    for (JointType type : {JointType::slider, JointType::six_degrees}) {
        Machine m = on_rail(type, {0.1f, 1e6f});
        run(m.world, 120);
        EXPECT_NEAR(travel(m), 0.2f, 2e-4f);
    }
}

// 10 kg at 1 m and 10 rad/s pull with 1000 N: a motor that has less gives way by r (cosh(sqrt(1 - F / 1000 N) w t) - 1)
// in the beginning, and one that has more holds.
TEST(TurningMotors, GiveWayToMoreThanTheirForce) {
    Machine strong = on_rail(JointType::slider, {0.0f, 1010.0f}), weak = on_rail(JointType::slider, {0.0f, 500.0f});
    run(strong.world, 120);
    EXPECT_LT(std::abs(travel(strong)), 1e-3f);
    run(weak.world, 6);
    EXPECT_NEAR(travel(weak), 0.5 * (std::cosh(1.0) - 1.0), 3e-3);  // x'' = w^2 (1 + x) - 50 m/s^2
}

TEST(TurningMotors, HoldAHingeAgainstCentrifugalTorque) {
    const float tilt = 0.8f;
    Machine m = turning(JointType::hinge, 0.5f * Vec3{std::cos(tilt), std::sin(tilt), 0.0f}, tilt, {},
                        {0.0f, 0.0f, 1.0f}, {0.0f, 1e6f}, 6.0f);
    run(m.world, 120);
    const Vec3 along = rotate(m.world.get(m.body).orientation(), {1.0f, 0.0f, 0.0f});
    EXPECT_NEAR(std::asin(along.y), tilt, 2e-4);
    EXPECT_LT(std::abs(m.world.joint(m.joint).position), 2e-4f);
}

TEST(TurningMotors, HoldADistanceInOrbit) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    BodyId post = world.add_static_body({.shape = Sphere{0.05f}, .filter = apart}).value();
    BodyId ball = world
                      .add_rigid_body({.shape = Sphere{0.1f},
                                       .position = {1.0f, 0.0f, 0.0f},
                                       .velocity = {0.0f, 0.0f, -3.0f},
                                       .filter = apart,
                                       .mass = 10.0f})
                      .value();
    JointDef def{.type = JointType::distance, .body_a = post, .body_b = ball};
    def.motor = {0.0f, 1e6f};
    const JointId joint = world.add_joint(def).value();
    run(world, 120);
    EXPECT_NEAR(world.joint(joint).position, 1.0f, 1e-4f);
    EXPECT_NEAR(length(world.get(ball).velocity()), 3.0f, 1e-3f);
}

// Two balls on rails of a disc that flies freely, drawn in to 0.65 m: it turns faster as a skater does, L stays.
TEST(TurningMotors, DrawInASkatersArms) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    BodyId disc =
        world.add_rigid_body({.shape = Cylinder{0.8f, 0.2f}, .angular_velocity = {0.0f, 3.0f, 0.0f}, .filter = apart})
            .value();
    JointId joints[2];
    BodyId arms[2];
    for (int i = 0; i < 2; ++i) {
        const float s = i == 0 ? 1.0f : -1.0f;
        arms[i] = world
                      .add_rigid_body({.shape = Sphere{0.15f},
                                       .position = {s, 0.0f, 0.0f},
                                       .velocity = {0.0f, 0.0f, -3.0f * s},
                                       .angular_velocity = {0.0f, 3.0f, 0.0f},
                                       .filter = apart})
                      .value();
        JointDef def = world.joint_at(JointType::slider, disc, arms[i], {s, 0.0f, 0.0f}, {s, 0.0f, 0.0f}).value();
        def.motor = {-0.35f, 1e6f};
        joints[i] = world.add_joint(def).value();
    }
    run(world, 1);  // the arms are set in motion
    const Momentum before = world.momentum();
    const float start = world.joint(joints[0]).position;
    run(world, 120);
    for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(world.joint(joints[i]).position - start, -0.7f, 1e-3f);
        EXPECT_NEAR(world.joint(joints[i]).velocity, -0.35f, 1e-3f);
    }
    const Momentum after = world.momentum();
    EXPECT_NEAR(after.angular[1] / before.angular[1], 1.0, 1e-6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after.linear[k], before.linear[k], 1e-3);  // of 42 kg m/s in each arm
}

TEST(TurningMotors, EveryWidthAndNumberOfWorkersGivesTheSameBits) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 5}}) {
        Machine m = turning(JointType::slider, {1.0f, 0.0f, 0.0f}, 0.0f, {1.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f},
                            {0.1f, 1e6f}, 10.0f, width, workers);
        run(m.world, 60);
        if (expected == 0) expected = m.world.hash();
        EXPECT_EQ(m.world.hash(), expected) << width;
    }
}

}  // namespace
}  // namespace lendulet
