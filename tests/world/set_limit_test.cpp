// Joints' bounds that are changed while the world runs.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

ErrorCode code_of(const Status& s) { return s.ok() ? ErrorCode::io : s.error().code; }

struct Arm {
    World world = WorldBuilder().build().value();
    BodyId post = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
    BodyId rod =
        world.add_rigid_body({.shape = Box{{0.5f, 0.05f, 0.05f}}, .position = {0.6f, 0.0f, 0.0f}, .mass = 1.0f})
            .value();
    JointId add(JointType type, Vec3 axis) {
        return world.add_joint(world.joint_at(type, post, rod, {0.1f, 0.0f, 0.0f}, axis).value()).value();
    }
};

TEST(SetLimit, OfAHinge) {
    Arm a;
    const JointId hinge = a.add(JointType::hinge, {0.0f, 0.0f, 1.0f});
    a.world.set_limit(hinge, {-0.5f, 0.5f}).value();
    run(a.world, 240);
    EXPECT_NEAR(a.world.joint(hinge).position, -0.5f, 0.01f);
    a.world.set_limit(hinge, {-1.0f, 0.5f}).value();  // wakes it
    run(a.world, 240);
    EXPECT_NEAR(a.world.joint(hinge).position, -1.0f, 0.01f);
    EXPECT_EQ(a.world.joint_def(hinge).limit.lower, -1.0f);
    a.world.set_limit(hinge, {}).value();
    run(a.world, 20);
    EXPECT_LT(a.world.joint(hinge).position, -1.05f);
    EXPECT_EQ(code_of(a.world.set_limit(hinge, {0.5f, 0.4f})), ErrorCode::bad_joint);
    EXPECT_EQ(code_of(a.world.set_limit(hinge, {std::nanf(""), 0.4f})), ErrorCode::non_finite);
    EXPECT_EQ(code_of(a.world.set_limit(hinge, Coordinate::x, {0.0f, 0.4f})), ErrorCode::bad_joint);
    EXPECT_TRUE(a.world.joint_def(hinge).limit.free());
    a.world.remove_joint(hinge).value();
    EXPECT_EQ(code_of(a.world.set_limit(hinge, {})), ErrorCode::stale_id);
}

TEST(SetLimit, OfASliderAndARope) {
    Arm a;
    const JointId slider = a.add(JointType::slider, {0.0f, 1.0f, 0.0f});
    a.world.set_limit(slider, {-0.3f, 0.0f}).value();
    run(a.world, 240);
    EXPECT_NEAR(a.world.joint(slider).position, -0.3f, 0.005f);
    a.world.set_limit(slider, {-0.7f, 0.0f}).value();
    run(a.world, 240);
    EXPECT_NEAR(a.world.joint(slider).position, -0.7f, 0.005f);
    a.world.remove_joint(slider).value();
    const JointId rope = a.add(JointType::distance, {1.0f, 0.0f, 0.0f});
    for (float length : {2.0f, 1.2f}) {
        a.world.set_limit(rope, {0.0f, length}).value();
        run(a.world, 600);
        EXPECT_NEAR(a.world.joint(rope).position, length, 0.01f);
    }
    EXPECT_EQ(code_of(a.world.set_limit(rope, {-3.0f, -1.0f})), ErrorCode::bad_joint);
}

TEST(SetLimit, OfABallJoint) {
    Arm a;
    const JointId ball = a.add(JointType::ball, {1.0f, 0.0f, 0.0f});
    for (float cone : {0.4f, 0.9f}) {
        a.world.set_limit(ball, Coordinate::swing, {0.0f, cone}).value();
        EXPECT_EQ(a.world.joint_def(ball).swing_limit, cone);
        run(a.world, 400);
        const Vec3 axis = rotate(a.world.get(a.rod).orientation(), {1.0f, 0.0f, 0.0f});
        EXPECT_NEAR(std::acos(axis.x), cone, 0.02f);
    }
    a.world.set_limit(ball, Coordinate::about_x, {-0.1f, 0.2f}).value();
    EXPECT_EQ(a.world.joint_def(ball).twist_limit.upper, 0.2f);
    EXPECT_EQ(code_of(a.world.set_limit(ball, {0.0f, 1.0f})), ErrorCode::bad_joint);
    EXPECT_EQ(code_of(a.world.set_limit(ball, Coordinate::y, {0.0f, 1.0f})), ErrorCode::bad_joint);
    EXPECT_EQ(code_of(a.world.set_limit(ball, Coordinate::swing, {-2.0f, -1.0f})), ErrorCode::bad_joint);
}

TEST(SetLimit, OfACoordinateOfSix) {
    Arm a;
    JointDef def = a.world.joint_at(JointType::six_degrees, a.post, a.rod, {0.1f, 0.0f, 0.0f}).value();
    for (JointAxis& axis : def.axes.linear) axis.limit = {0.0f, 0.0f};
    for (JointAxis& axis : def.axes.angular) axis.limit = {0.0f, 0.0f};
    const JointId joint = a.world.add_joint(def).value();
    run(a.world, 60);
    a.world.set_limit(joint, Coordinate::y, {-0.4f, 0.1f}).value();  // was locked
    run(a.world, 120);
    EXPECT_NEAR(a.world.joint(joint).coordinates[1], -0.4f, 0.005f);
    a.world.set_limit(joint, Coordinate::y, {-0.2f, -0.2f}).value();  // and is again, elsewhere
    run(a.world, 120);
    EXPECT_NEAR(a.world.joint(joint).coordinates[1], -0.2f, 0.005f);
    EXPECT_EQ(code_of(a.world.set_limit(joint, Coordinate::swing, {0.0f, 1.0f})), ErrorCode::bad_joint);
    EXPECT_EQ(code_of(a.world.set_limit(joint, Limit{0.0f, 1.0f})), ErrorCode::bad_joint);
}

}  // namespace
}  // namespace lendulet::test
