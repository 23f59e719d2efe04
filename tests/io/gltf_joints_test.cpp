// Joints of glTF files: which description becomes which joint, and that they hold what they should.
#include <cmath>

#include "io/gltf_fixture.h"
#include "io/gltf_joint_kinds.h"

namespace lendulet::test {
namespace {

// The kind of a description in single quotes; the reason in `why` where there is none.
std::optional<JointKind> kind_of(std::string text, std::string* why = nullptr) {
    for (char& c : text) c = c == '\'' ? '"' : c;
    Json json = Json::parse(text);
    std::string reason;
    auto kind = joint_kind({&json, "joint"}, reason);
    if (why) *why = reason;
    return kind;
}

const std::string point = "{'linearAxes':[0,1,2],'max':0}";

TEST(GltfJointKinds, LocksMakeTheType) {
    EXPECT_EQ(kind_of("{'limits':[" + point + ",{'angularAxes':[0,1,2],'min':0,'max':0}]}")->type, JointType::fixed);
    EXPECT_EQ(kind_of("{'limits':[" + point + "]}")->type, JointType::ball);
    auto hinge = kind_of("{'limits':[" + point +
                         ",{'angularAxes':[0],'min':0,'max':0},{'angularAxes':[2],'max':0,"
                         "'min':0},{'angularAxes':[1],'min':-0.5}]}");
    EXPECT_EQ(hinge->type, JointType::hinge);
    EXPECT_EQ(hinge->axis, 1);
    EXPECT_FLOAT_EQ(hinge->limit.lower, -0.5f);
    EXPECT_NEAR(hinge->limit.upper, pi, 1e-4f);
    auto slider = kind_of(
        "{'limits':[{'linearAxes':[0,1],'max':0},{'angularAxes':[0,1,2],'max':0},"
        "{'linearAxes':[2],'min':-1,'max':2}]}");
    EXPECT_EQ(slider->type, JointType::slider);
    EXPECT_EQ(slider->axis, 2);
    EXPECT_FLOAT_EQ(slider->limit.upper, 2.0f);
    auto cone = kind_of("{'limits':[" + point + ",{'angularAxes':[0,2],'max':0.7}]}");
    EXPECT_EQ(cone->type, JointType::ball);
    EXPECT_EQ(cone->axis, 1);
    EXPECT_FLOAT_EQ(cone->swing_limit, 0.7f);
    EXPECT_TRUE(cone->twist_limit.free());
    auto held = kind_of("{'limits':[{'linearAxes':[1],'min':0.5,'max':0.5},{'linearAxes':[0,2],'max':0}]}");
    EXPECT_FLOAT_EQ(held->offset.y, 0.5f);
}

TEST(GltfJointKinds, OtherFreedomsMakeSixDegreeJoints) {
    EXPECT_EQ(kind_of("{}")->type, JointType::six_degrees);
    auto rope = kind_of("{'limits':[{'linearAxes':[0,1,2],'max':1}]}");
    EXPECT_EQ(rope->type, JointType::six_degrees);
    EXPECT_FLOAT_EQ(rope->axes.distance.limit.upper, 1.0f);
    EXPECT_TRUE(rope->axes.distance_axes[0] && rope->axes.distance_axes[1] && rope->axes.distance_axes[2]);
    auto cylinder = kind_of("{'limits':[{'linearAxes':[0,1],'max':0},{'angularAxes':[0,1],'max':0}]}");
    EXPECT_EQ(cylinder->type, JointType::six_degrees);
    EXPECT_TRUE(cylinder->axes.linear[1].limit.locked() && cylinder->axes.linear[2].limit.free());
    auto universal = kind_of("{'limits':[" + point +
                             ",{'angularAxes':[0],'min':-0.3,'max':0.4},{'angularAxes':[1],'max':0,'min':0},"
                             "{'angularAxes':[2],'min':-0.5,'max':0.5}]}");
    EXPECT_EQ(universal->type, JointType::six_degrees);
    EXPECT_FLOAT_EQ(universal->axes.angular[0].limit.upper, 0.4f);
    EXPECT_TRUE(universal->axes.angular[1].limit.locked());
    EXPECT_TRUE(universal->approximations.empty());
    auto soft = kind_of("{'limits':[" + point + ",{'angularAxes':[0,1],'max':0.5,'stiffness':20,'damping':2}]}");
    EXPECT_EQ(soft->type, JointType::six_degrees);
    EXPECT_FLOAT_EQ(soft->axes.swing.limit_stiffness, 20.0f);
    EXPECT_FLOAT_EQ(soft->axes.swing.limit_damping, 2.0f);
    auto turned = kind_of("{'limits':[" + point +
                          ",{'angularAxes':[0],'min':1,'max':1},{'angularAxes':[1],'min':0.5,'max':0.5}]}");
    EXPECT_EQ(turned->type, JointType::six_degrees);
    EXPECT_FLOAT_EQ(turned->axes.angular[1].limit.upper, 0.5f);
}

TEST(GltfJointKinds, WhatCannotBeIsNamed) {
    std::string why;
    EXPECT_FALSE(
        kind_of("{'limits':[" + point + ",{'angularAxes':[0],'min':1,'max':2},{'angularAxes':[0],'max':0.5}]}", &why));
    EXPECT_EQ(why, "a pair of limits that exclude each other is");
    EXPECT_FALSE(kind_of("{'limits':[{'linearAxes':[0,1],'max':1},{'linearAxes':[1,2],'max':1}]}", &why));
    EXPECT_EQ(why, "more than one distance limit is");
}

TEST(GltfJointKinds, DrivesAndSoftLocks) {
    const std::string slider = "{'limits':[{'linearAxes':[0,1],'max':0},{'angularAxes':[0,1,2],'max':0}";
    auto driven = kind_of(slider +
                          "],'drives':[{'type':'linear','mode':'acceleration','axis':2,'stiffness':9,"
                          "'positionTarget':0.5,'damping':2,'velocityTarget':1,'maxForce':7}]}");
    EXPECT_EQ(driven->type, JointType::slider);
    ASSERT_EQ(driven->drives.size(), 1u);
    EXPECT_EQ(driven->drives[0].axis, 2);
    EXPECT_TRUE(driven->drives[0].acceleration);
    EXPECT_FLOAT_EQ(driven->drives[0].stiffness, 9.0f);
    EXPECT_FLOAT_EQ(driven->drives[0].max_force, 7.0f);
    auto soft = kind_of(slider + ",{'linearAxes':[2],'min':0.1,'max':0.1,'stiffness':50,'damping':3}]}");
    EXPECT_TRUE(soft->limit.free());
    EXPECT_FLOAT_EQ(soft->spring.stiffness, 50.0f);
    EXPECT_FLOAT_EQ(soft->spring.damping, 3.0f);
    EXPECT_FLOAT_EQ(soft->spring.target, 0.1f);
    auto ball = kind_of("{'limits':[" + point + "],'drives':[{'type':'angular','mode':'force','axis':0,'damping':1}]}");
    EXPECT_EQ(ball->type, JointType::six_degrees);
    ASSERT_EQ(ball->drives.size(), 1u);
    EXPECT_EQ(ball->drives[0].axis, 3);
    const std::string drive = "{'type':'linear','mode':'force','axis':2,'damping':1}";
    EXPECT_EQ(kind_of(slider + "],'drives':[" + drive + "," + drive + "]}")->approximations.size(), 1u);
    EXPECT_THROW(kind_of(slider + "],'drives':[{'type':'linear','mode':'force','axis':5}]}"), LoadFailure);
    EXPECT_THROW(kind_of("{'limits':[{'linearAxes':[0,0]}]}"), LoadFailure);
    EXPECT_THROW(kind_of("{'limits':[{'linearAxes':[0],'angularAxes':[0]}]}"), LoadFailure);
}

class GltfJoints : public testing::Test {
protected:
    Scene scene = load(scene_file("joints.gltf"));

    JointState joint(int index) { return scene.world.joint(scene.world.joint_id(index)); }
};

// In the order of the tree; the one to the fixed world comes last.
TEST_F(GltfJoints, TypesAndWarnings) {
    std::vector<JointType> types;
    for (int i = 0; i < scene.world.joint_count(); ++i) types.push_back(joint(i).type);
    using enum JointType;
    EXPECT_EQ(types, (std::vector<JointType>{fixed, ball, hinge, hinge, slider, ball, ball, six_degrees, hinge, slider,
                                             slider, six_degrees, six_degrees, ball}));
    EXPECT_FALSE(warns(scene, "simulated"));
    EXPECT_EQ(scene.world.get_static(joint(0).body_a).name(), "FixedHolder");
    EXPECT_EQ(scene.world.get_static(joint(0).body_b).name(), "Fixed");
    EXPECT_EQ(scene.world.get_static(joint(13).body_b).name(), "Hanging");
}

TEST_F(GltfJoints, HoldWhatTheyShould) {
    run(scene, 240);
    for (int i = 0; i < scene.world.joint_count(); ++i) {
        EXPECT_LT(length(joint(i).linear_error), 0.01f) << i;
        if (joint(i).type != JointType::ball) {
            EXPECT_LT(joint(i).angular_error, 0.02f) << i;
        }
    }
    const World& world = scene.world;
    EXPECT_LT(distance(from_origin(moving(world, "Fixed").position()), {0.5f, 2.5f, 0.0f}), 0.01f);
    EXPECT_NEAR(moving(world, "HingeX").position().x, 4.5f, 0.01f);  // a hinge about x keeps x
    EXPECT_NEAR(joint(3).position, -0.5f, 0.03f);  // falls as far as its limit lets it, clockwise about z
    EXPECT_NEAR(joint(4).position, -0.5f, 0.02f);  // the slider's lower stop
    EXPECT_NEAR(joint(9).position, 0.3f - 9.81f / 200.0f, 0.02f);  // spring of 200 N/m under 1 kg
    EXPECT_NEAR(joint(10).position, -9.81f / 100.0f, 0.02f);       // soft lock of 100 N/m
    constexpr int distance = static_cast<int>(Coordinate::distance);
    EXPECT_LT(joint(11).coordinates[distance], 1.0f + 1e-3f);  // the rope hangs at its length
    EXPECT_GT(joint(11).coordinates[distance], 0.9f);
    EXPECT_LT(absolute(joint(7).coordinates[3]), 0.4f + 5e-3f);  // both angles of the universal joint
    EXPECT_LT(absolute(joint(7).coordinates[5]), 0.4f + 5e-3f);
    // Slides along y and turns about it, nothing else.
    EXPECT_LT(absolute(joint(12).coordinates[0]) + absolute(joint(12).coordinates[2]), 1e-3f);
    EXPECT_LT(absolute(joint(12).coordinates[3]) + absolute(joint(12).coordinates[5]), 1e-3f);
    EXPECT_GT(absolute(joint(12).coordinates[1]), 5.0f);
}

TEST_F(GltfJoints, DriveReachesItsSpeed) {
    Scene weightless = load_gltf(scene_file("joints.gltf"), [](WorldBuilder& b) { b.no_gravity(); }).value();
    run(weightless, 90);
    JointState motor = weightless.world.joint(weightless.world.joint_id(8));
    EXPECT_NEAR(motor.velocity, 2.0f, 0.05f);
    EXPECT_NEAR(moving(weightless.world, "HingeMotor").angular_velocity().z, 2.0f, 0.05f);
}

}  // namespace
}  // namespace lendulet::test
