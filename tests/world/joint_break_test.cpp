// Joints that break: at which force and torque, and what is told of it.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

// A mass on a joint: the force that holds it is its weight.
TEST(JointBreaks, WeightAtTheLimit) {
    for (JointType type : {JointType::fixed, JointType::ball, JointType::hinge, JointType::distance})
        for (float share : {0.98f, 1.02f}) {
            World world = WorldBuilder().build().value();
            const BodyId post = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
            const BodyId mass =
                world.add_rigid_body({.shape = Sphere{0.2f}, .position = {0.0f, -1.0f, 0.0f}, .mass = 2.0f}).value();
            JointDef def = world.joint_at(type, post, mass, {0.0f, 0.0f, 0.0f}).value();
            if (type == JointType::distance) def.frame_b.translation = {}, def.limit = {1.0f, 1.0f};
            def.break_force = share * 2.0f * 9.81f;
            def.user_data = 77;
            const JointId joint = world.add_joint(def).value();
            EXPECT_EQ(world.joint_def(joint).break_force, def.break_force);
            int breaks = 0;
            for (int i = 0; i < 120; ++i) {
                run(world, 1);
                for (const JointBreak& b : world.joint_breaks()) {
                    ++breaks;
                    EXPECT_EQ(b.joint, joint);
                    EXPECT_EQ(b.body_a, post);
                    EXPECT_EQ(b.body_b, mass);
                    EXPECT_EQ(b.user_data, 77u);
                    EXPECT_NEAR(b.force.y, 2.0f * 9.81f, 0.01f * 2.0f * 9.81f);
                    EXPECT_FALSE(world.alive(b.joint));
                }
            }
            EXPECT_EQ(breaks, share < 1.0f ? 1 : 0) << static_cast<int>(type);
            EXPECT_EQ(world.alive(joint), share > 1.0f);
            EXPECT_EQ(world.get(mass).position().y < -2.0f, share < 1.0f);
            EXPECT_EQ(world.check(), "");
        }
}

// A beam held at one end: m g l / 2.
TEST(JointBreaks, TorqueOfABeam) {
    for (float share : {0.97f, 1.03f}) {
        World world = WorldBuilder().build().value();
        const BodyId wall = world.add_static_body({.position = {-1.0f, 0.0f, 0.0f}}).value();
        const BodyId beam =
            world.add_rigid_body({.shape = Box{{1.0f, 0.1f, 0.1f}}, .position = {1.0f, 0.0f, 0.0f}, .mass = 3.0f})
                .value();
        JointDef def = world.joint_at(JointType::fixed, wall, beam, {0.0f, 0.0f, 0.0f}).value();
        def.break_torque = share * 3.0f * 9.81f;
        world.add_joint(def).value();
        size_t breaks = 0;
        for (int i = 0; i < 60; ++i) {
            run(world, 1);
            breaks += world.joint_breaks().size();
            for (const JointBreak& b : world.joint_breaks()) EXPECT_NEAR(b.torque.z, 3.0f * 9.81f, 0.3f);
        }
        EXPECT_EQ(breaks, share < 1.0f ? 1u : 0u);
        EXPECT_EQ(world.joint_count(), share < 1.0f ? 0 : 1);
    }
}

TEST(JointBreaks, RefusesLimitsThatAreNone) {
    World world = WorldBuilder().build().value();
    const BodyId a = add_cube(world, 0.0f, 0), b = add_cube(world, 2.0f, 0);
    JointDef def = world.joint_at(JointType::ball, a, b, {1.0f, 0.5f, 0.0f}).value();
    for (float bad : {0.0f, -1.0f, std::nanf("")}) {
        JointDef force = def, torque = def;
        force.break_force = bad, torque.break_torque = bad;
        EXPECT_EQ(world.add_joint(force).error().code, ErrorCode::bad_joint);
        EXPECT_EQ(world.add_joint(torque).error().code, ErrorCode::bad_joint);
    }
    EXPECT_EQ(world.joint_count(), 0);
}

// A chain of which the strongest blow breaks one joint, or several, the same for any workers and widths.
TEST(JointBreaks, ChainTornByABlow) {
    std::vector<std::vector<uint32_t>> broken;
    for (int width : widths)
        for (int workers : {1, 2}) {
            World world = WorldBuilder().workers(workers).width(width).build().value();
            BodyId last = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
            for (int i = 0; i < 12; ++i) {
                const float y = -0.3f - 0.5f * static_cast<float>(i);
                const BodyId next =
                    world.add_rigid_body({.shape = Sphere{0.2f}, .position = {0.0f, y, 0.0f}, .mass = 1.0f}).value();
                JointDef def = world.joint_at(JointType::ball, last, next, {0.0f, y + 0.25f, 0.0f}).value();
                def.break_force = 250.0f;
                world.add_joint(def).value();
                last = next;
            }
            broken.emplace_back();
            for (int i = 0; i < 90; ++i) {
                if (i == 30) world.get(last).apply_impulse({0.0f, -40.0f, 0.0f}).value();
                run(world, 1);
                for (const JointBreak& b : world.joint_breaks()) {
                    EXPECT_GE(i, 30);
                    EXPECT_GT(length(b.force), 250.0f);
                    broken.back().push_back(b.joint.index);
                }
            }
            EXPECT_EQ(world.check(), "");
        }
    EXPECT_FALSE(broken[0].empty());
    for (const auto& b : broken) EXPECT_EQ(b, broken[0]);
}

}  // namespace
}  // namespace lendulet::test
