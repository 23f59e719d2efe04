// Small bodies far from their joints: what a joint holds goes with the arms, or it spins such bodies by itself.
#include <gtest/gtest.h>

#include <cmath>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

constexpr JointType arm_joints[] = {JointType::ball, JointType::hinge, JointType::slider, JointType::fixed,
                                    JointType::six_degrees};

enum class HubKind { turns_by_hand, shakes_by_hand, flies, hangs };

struct FarArm {
    World world;
    BodyId hub;
    JointId joint;
};

// A cube of 1 kg and `size` metres, one metre from where a joint holds it to a hub that turns at 5 rad/s about y.
FarArm make_far_arm(HubKind kind, JointType type, float size) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    const bool by_hand = kind == HubKind::turns_by_hand || kind == HubKind::shakes_by_hand;
    const Vec3 spin{0.0f, kind == HubKind::shakes_by_hand ? 0.0f : 5.0f, 0.0f}, place{1.5f, 0.0f, 0.0f};
    RigidBodyDef def{.shape = Box{},
                     .angular_velocity = spin,
                     .filter = {.category = 1, .mask = 0},
                     .mass = 1000.0f,
                     .kinematic = by_hand};
    if (by_hand) def.mass.reset();
    const BodyId hub = world.add_rigid_body(def).value();
    const BodyId body = world
                            .add_rigid_body({.shape = Box{{0.5f * size, 0.5f * size, 0.5f * size}},
                                             .position = at(place),
                                             .velocity = cross(spin, place),
                                             .angular_velocity = spin,
                                             .filter = {.category = 1, .mask = 0},
                                             .mass = 1.0f})
                            .value();
    const Vec3 axis = type == JointType::slider ? Vec3{0.0f, 1.0f, 0.0f} : Vec3{0.0f, 0.0f, 1.0f};
    JointDef joint = world.joint_at(type, hub, body, at(Vec3{0.5f, 0.0f, 0.0f}), axis).value();
    if (type == JointType::slider) joint.limit = {-0.01f, 0.01f};
    if (type == JointType::six_degrees) {
        for (auto& a : joint.axes.linear) a.limit = {0.0f, 0.0f};
        for (auto& a : joint.axes.angular) a.limit = {0.0f, 0.0f};
    }
    const JointId id = world.add_joint(joint).value();
    if (kind == HubKind::hangs) {
        const BodyId ground = world.add_static_body({.filter = {.category = 1, .mask = 0}}).value();
        world.add_joint(world.joint_at(JointType::hinge, ground, hub, {}, {0.0f, 1.0f, 0.0f}).value()).value();
    }
    return {std::move(world), hub, id};
}

struct WorstGaps {
    float gap = 0.0f, turn = 0.0f;
};
WorstGaps worst_gaps(FarArm& arm, HubKind kind) {
    WorstGaps most;
    for (int i = 0; i < 240; ++i) {
        const float phase = 20.0f * dt * static_cast<float>(i);
        if (kind == HubKind::shakes_by_hand)
            arm.world.get(arm.hub)
                .set_angular_velocity({0.0f, 5.0f * std::sin(phase), 3.0f * std::cos(1.3f * phase)})
                .value();
        arm.world.update(dt).value();
        const auto state = arm.world.joint(arm.joint);
        most.gap = std::fmax(most.gap, length(state.linear_error));
        most.turn = std::fmax(most.turn, std::fabs(state.angular_error));
    }
    return most;
}

// What is a sixth of the arm, and less than a hundredth. Joints that share a body give way by what they carry, 25 N;
// elsewhere the slider at its bound on the hub that shakes is the worst.
TEST(FarArms, HoldSmallBodies) {
    for (HubKind kind : {HubKind::turns_by_hand, HubKind::shakes_by_hand, HubKind::flies, HubKind::hangs})
        for (JointType type : arm_joints)
            for (float size : {0.15f, 0.024f, 0.008f}) {
                FarArm arm = make_far_arm(kind, type, size);
                const WorstGaps most = worst_gaps(arm, kind);
                const int which = static_cast<int>(kind), what = static_cast<int>(type);
                EXPECT_LT(most.gap, kind == HubKind::hangs ? 1.2e-4f : 4e-5f) << which << ' ' << what << ' ' << size;
                EXPECT_LT(most.turn, 1e-4f) << which << ' ' << what << ' ' << size;
            }
}

// A bob on an arm of 250 times its size, let go at the height of its anchor, swings there and keeps its energy.
TEST(FarArms, SmallBobsSwing) {
    World world = WorldBuilder{}.down_gravity(9.81f).sleep(false).build().value();
    const BodyId bob = world
                           .add_rigid_body({.shape = Box{{0.004f, 0.004f, 0.004f}},
                                            .position = {1.0f, 0.0f, 0.0f},
                                            .filter = {.category = 1, .mask = 0},
                                            .mass = 1.0f})
                           .value();
    const BodyId ground = world.add_static_body({.filter = {.category = 1, .mask = 0}}).value();
    const JointId joint = world.add_joint(world.joint_at(JointType::ball, ground, bob, {}).value()).value();
    for (int i = 0; i < 600; ++i) {
        world.update(dt).value();
        EXPECT_LT(length(world.joint(joint).linear_error), 5e-6f) << i;
    }
    const RigidBodyRef b = world.get(bob);
    const float v = length(b.velocity());
    EXPECT_NEAR(0.5f * v * v + 9.81f * from_origin(b.position()).y, 0.0f, 9.81f * 2e-3f);
}

}  // namespace
}  // namespace lendulet
