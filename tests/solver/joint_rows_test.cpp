// What each class of joint holds, lets go, limits and drives; conservation; the same bits for every width and order.
#include <gtest/gtest.h>

#include <cmath>

#include "joint_rig.h"

namespace lendulet::test {
namespace {

constexpr JointClass all_classes[] = {JointClass::ball,   JointClass::limited_ball,  JointClass::rubbing_ball,
                                      JointClass::hinge,  JointClass::limited_hinge, JointClass::driven_hinge,
                                      JointClass::slider, JointClass::driven_slider, JointClass::fixed};
bool slides(JointClass type) { return type == JointClass::slider || type == JointClass::driven_slider; }
bool is_limited_ball(JointClass type) { return type == JointClass::limited_ball || type == JointClass::rubbing_ball; }
bool turns_within_limits(JointClass type) {
    return type == JointClass::limited_hinge || type == JointClass::driven_hinge;
}
constexpr float dt = 1.0f / 60.0f;

RigBody lump(Position x, float mass = 1.0f, Vec3 inertia = {0.1f, 0.2f, 0.25f}) {
    RigBody b;
    b.position = x;
    b.mass = mass;
    b.inertia = inertia;
    return b;
}

void give_bounds(JointRecord& r) {
    r.lower = -0.4f;
    r.upper = 0.5f;
    r.swing_limit = 0.5f;
}

// Two bodies that fly and turn about each other, joined off both centres.
void make_flying_pair(JointRig& rig, JointClass type) {
    rig.gravity = {};
    rig.add(lump({}));
    rig.add(lump({1.2f, 0.3f, 0.0f}, 2.5f, {0.5f, 0.2f, 0.4f}));
    rig.bodies[0].v = {0.3f, 1.0f, 0.2f};
    rig.bodies[1].v = {-0.2f, -2.0f, 0.4f};
    rig.bodies[0].set_w({1.0f, 2.0f, 3.0f});
    rig.bodies[1].set_w({-2.0f, 1.0f, 1.0f});
    give_bounds(rig.join(type, 0, 1, {0.5f, 0.2f, 0.1f}, {1.0f, 0.3f, 0.2f}));
}

TEST(JointRows, JointsConserveLinearAndAngularMomentum) {
    for (JointClass type : all_classes) {
        JointRig rig;
        make_flying_pair(rig, type);
        double p0[3], l0[3], p[3], l[3];
        rig.momentum(p0, l0);
        for (int i = 0; i < 120; ++i) {
            rig.step(dt);
            rig.momentum(p, l);
            for (int k = 0; k < 3; ++k) {
                ASSERT_NEAR(p[k], p0[k], 1e-5) << static_cast<int>(type) << " step " << i;  // of 6 kg m/s in all
                ASSERT_NEAR(l[k], l0[k], 5e-5) << static_cast<int>(type) << " step " << i;  // of 5 kg m^2/s
            }
        }
    }
}

TEST(JointRows, FreelyFlyingPairsKeepTheirEnergyOnceJoined) {
    for (JointClass type : {JointClass::ball, JointClass::hinge, JointClass::fixed}) {
        JointRig rig;
        make_flying_pair(rig, type);
        rig.step(dt);  // the joint stops what it forbids
        double joined = rig.energy();
        for (int i = 0; i < 600; ++i) rig.step(dt);
        EXPECT_NEAR(rig.energy() / joined, 1.0, 2e-3) << static_cast<int>(type);
    }
}

TEST(JointRows, LockedRowsStayLocked) {
    for (JointClass type : all_classes) {
        JointRig rig;
        make_flying_pair(rig, type);
        for (int i = 0; i < 300; ++i) {
            rig.step(dt);
            Vec3 gap = rig.gap(0);
            Quat q = rig.rotation(0);
            if (slides(type)) {  // what is left across the axis, which is x of the frame on A
                const JointRecord& r = rig.joints[0];
                Quat frame = rig.bodies[0].orientation * Quat{r.frame_a[0], r.frame_a[1], r.frame_a[2], r.frame_a[3]};
                gap = rotate_inverse(frame, gap);
                EXPECT_LT(gap.x, 0.5f + 2e-3f);
                EXPECT_GT(gap.x, -0.4f - 2e-3f);
                gap.x = 0.0f;
            }
            ASSERT_LT(length(gap), 1e-4f) << static_cast<int>(type) << " step " << i;
            if (type == JointClass::fixed || slides(type)) {
                ASSERT_LT(length(Vec3{q.x, q.y, q.z}), 1e-4f);
            }
            if (type == JointClass::hinge || turns_within_limits(type)) {
                ASSERT_LT(rig.swing(0), 2e-4f);
            }
            if (turns_within_limits(type) || is_limited_ball(type)) {
                ASSERT_LT(rig.angle(0), 0.5f + 5e-3f);
                ASSERT_GT(rig.angle(0), -0.4f - 5e-3f);
            }
            if (is_limited_ball(type)) {
                ASSERT_LT(rig.swing(0), 0.5f + 5e-3f);
            }
        }
    }
}

TEST(JointRows, JointsPulledFarApartCloseAtLimitedSpeed) {
    for (JointClass type : all_classes) {
        JointRig rig;
        make_flying_pair(rig, type);
        rig.bodies[1].position = {1000.0f, 50.0f, -30.0f};
        float fastest = 0.0f;
        for (int i = 0; i < 120; ++i) {
            rig.step(dt);
            for (const RigBody& b : rig.bodies) fastest = maximum(fastest, length(b.v));
        }
        EXPECT_TRUE(std::isfinite(fastest));
        if (!slides(type)) {
            EXPECT_LT(length(rig.gap(0)), 985.0f) << static_cast<int>(type);
        }
        EXPECT_LT(fastest, 100.0f) << static_cast<int>(type);
    }
}

// A door of inertia I about its hinge.
void make_door(JointRig& rig, Vec3 gravity = {}) {
    rig.gravity = gravity;
    rig.add({{}, {}, 0.0f});
    rig.add(lump({0.5f, 0.0f, 0.0f}, 1.0f, {0.01f, 0.1f, 0.1f}));
    rig.join(JointClass::driven_hinge, 0, 1, {}, {0.0f, 0.0f, 1.0f});
}
constexpr float door_inertia = 0.1f + 0.25f;

TEST(JointRows, MotorReachesItsSpeedWithItsTorque) {
    JointRig rig;
    make_door(rig);
    rig.joints[0].motor_velocity = 2.0f;
    rig.joints[0].motor_force = 0.35f;  // 1 rad/s^2
    for (int i = 0; i < 60; ++i) rig.step(dt);
    EXPECT_NEAR(rig.bodies[1].w().z, 1.0f, 1e-3f);
    for (int i = 0; i < 90; ++i) rig.step(dt);
    EXPECT_NEAR(rig.bodies[1].w().z, 2.0f, 1e-3f);
    EXPECT_LT(rig.largest_gap(), 1e-5f);
}

TEST(JointRows, MotorAtRestHoldsAgainstGravityUpToItsTorque) {
    for (float share : {0.98f, 1.02f}) {
        JointRig rig;
        make_door(rig, {0.0f, -9.81f, 0.0f});
        rig.joints[0].motor_force = share * 9.81f * 0.5f;
        for (int i = 0; i < 60; ++i) rig.step(dt);
        if (share > 1.0f) {
            EXPECT_NEAR(rig.angle(0), 0.0f, 1e-5f);
        } else {
            EXPECT_LT(rig.angle(0), -0.01f);
        }
    }
}

TEST(JointRows, LimitStopsADoorWithoutBounceAndHoldsItAgainstGravity) {
    JointRig rig;
    make_door(rig, {0.0f, -9.81f, 0.0f});
    rig.joints[0].lower = -0.7f;
    rig.joints[0].upper = 0.2f;
    float lowest = 0.0f;
    for (int i = 0; i < 240; ++i) {
        rig.step(dt);
        lowest = minimum(lowest, rig.angle(0));
    }
    EXPECT_GT(lowest, -0.7f - 1e-3f);
    EXPECT_NEAR(rig.angle(0), -0.7f, 1e-3f);
    EXPECT_NEAR(rig.bodies[1].w().z, 0.0f, 1e-3f);
}

TEST(JointRows, LimitsMayReachBeyondHalfATurn) {
    JointRig rig;
    make_door(rig);
    rig.joints[0].lower = 0.0f;
    rig.joints[0].upper = 4.0f;
    rig.bodies[1].set_w({0.0f, 0.0f, 3.0f});
    rig.bodies[1].v = {0.0f, 1.5f, 0.0f};
    for (int i = 0; i < 120; ++i) rig.step(dt);
    EXPECT_NEAR(rig.angle(0), 4.0f - 2.0f * pi, 2e-3f);
    EXPECT_NEAR(rig.bodies[1].w().z, 0.0f, 1e-3f);
}

// f = sqrt(k / I) / (2 pi); a free swing keeps its amplitude, a damped one loses exp(-zeta w t).
TEST(JointRows, SpringSwingsAtItsFrequency) {
    for (float frequency : {1.0f, 4.0f, 15.0f})
        for (float zeta : {0.0f, 0.05f}) {
            JointRig rig;
            make_door(rig);
            float w0 = 2.0f * pi * frequency;
            rig.joints[0].stiffness = w0 * w0 * door_inertia;
            rig.joints[0].damping = 2.0f * zeta * w0 * door_inertia;
            rig.joints[0].target = 0.1f;
            double first = 0.0, last = 0.0, before = -0.1;
            float highest = 0.0f;
            int crossings = 0, steps = static_cast<int>(600.0f / frequency);
            for (int i = 1; i <= steps; ++i) {
                rig.step(1.0f / 240.0f);
                double x = static_cast<double>(rig.angle(0)) - 0.1;
                if (before < 0.0 && x >= 0.0)
                    (crossings++ == 0 ? first : last) = (i - 1 + before / (before - x)) / 240.0;
                if (i > steps - static_cast<int>(250.0f / frequency)) highest = maximum(highest, static_cast<float>(x));
                before = x;
            }
            double damped = frequency * std::sqrt(1.0 - static_cast<double>(zeta) * zeta);
            EXPECT_NEAR((crossings - 1) / (last - first) / damped, 1.0, 2e-3) << frequency;
            if (zeta == 0.0f) {
                EXPECT_NEAR(highest, 0.1f, 1e-3f) << frequency;
            }
        }
}

TEST(JointRows, VeryStiffSpringIsStable) {
    JointRig rig;
    make_door(rig, {0.0f, -9.81f, 0.0f});
    rig.joints[0].stiffness = 1e7f;
    rig.joints[0].damping = 1e3f;
    for (int i = 0; i < 120; ++i) rig.step(dt);
    EXPECT_NEAR(rig.angle(0), 0.0f, 1e-4f);
    EXPECT_NEAR(rig.bodies[1].w().z, 0.0f, 1e-3f);
}

TEST(JointRows, SpringForceIsBounded) {
    JointRig rig;
    make_door(rig);
    rig.joints[0].stiffness = 1e5f;
    rig.joints[0].target = 3.0f;
    rig.joints[0].spring_force = 0.35f;
    for (int i = 0; i < 60; ++i) rig.step(dt);
    EXPECT_NEAR(rig.bodies[1].w().z, 1.0f, 1e-3f);
}

// A beam of welded boxes held at one end: the weight's torque at the wall is n^2 m g / 2.
TEST(JointRows, WeldedBeamReportsTheWallsTorque) {
    JointRig rig;
    rig.add({{}, {}, 0.0f});
    constexpr int boxes = 4;
    for (int i = 0; i < boxes; ++i) {
        rig.add(lump({static_cast<float>(i) + 0.5f, 0.0f, 0.0f}, 1.0f, {1.0f / 6.0f, 1.0f / 6.0f, 1.0f / 6.0f}));
        rig.join(JointClass::fixed, i, i + 1, {static_cast<float>(i), 0.0f, 0.0f});
    }
    for (int i = 0; i < 600; ++i) rig.step(dt);
    const JointRecord& wall = rig.joints[0];
    EXPECT_NEAR(wall.impulse[1] / dt, boxes * 9.81f, 0.01f * boxes * 9.81f);
    EXPECT_NEAR(wall.angular_impulse[2] / dt, 0.5f * boxes * boxes * 9.81f, 0.02f * 0.5f * boxes * boxes * 9.81f);
    EXPECT_GT(rig.bodies[boxes].position.y, -0.01f);
}

// Joints of all classes in one tangle, more of them on one body than there are colours, a pair of joints twice.
void make_tangle(JointRig& rig) {
    rig.add({{0.0f, 3.0f, 0.0f}, {0.0f, 0.6f, 0.0f, 0.8f}, 0.0f});
    int n = 0;
    for (int i = 0; i < 60; ++i) {
        float x = static_cast<float>(i % 8), y = static_cast<float>(i / 8), z = 0.3f * static_cast<float>(i % 3);
        RigBody b = lump({x, -y, z}, 1.0f + 0.1f * static_cast<float>(i % 7));
        b.orientation = normalize(Quat{0.1f * x, 0.2f, 0.05f * y, 0.9f});
        b.set_w({0.1f * x, -0.2f, 0.3f * z});
        int here = rig.add(b);
        auto link = [&](int other) {
            JointRecord& r =
                rig.join(all_classes[n++ % 8], other, here, {x - 0.4f, -y + 0.3f, z}, {1.0f, 0.2f * x, 0.3f});
            give_bounds(r);
            if (n % 5 == 0) r.motor_velocity = 1.0f, r.motor_force = 2.0f;
            if (n % 7 == 0) r.stiffness = 50.0f, r.damping = 1.0f;
        };
        if (i % 8 > 0) link(here - 1);
        if (i % 11 == 0) link(0);
        if (i > 20) link(9);
        if (i % 13 == 5) link(here - 1);
    }
}

TEST(JointRows, EveryWidthGivesTheSameBits) {
    uint64_t expected = 0;
    for (int width : {1, 4, 8, 16}) {
        JointRig rig(width);
        make_tangle(rig);
        for (int i = 0; i < 3; ++i) rig.step(dt);  // longer, and forty contradictory joints on one body fly apart
        EXPECT_GT(rig.solver().joints().overflow(), 0);
        if (width == 1) expected = rig.hash();
        else EXPECT_EQ(rig.hash(), expected) << width;
        EXPECT_TRUE(std::isfinite(rig.energy()));
    }
}

TEST(JointRows, EveryNumberOfWorkersGivesTheSameBits) {
    uint64_t expected = 0;
    for (int workers : {1, 2, 5}) {
        JointRig rig(4, workers);
        make_tangle(rig);
        for (int i = 0; i < 10; ++i) rig.step(dt);
        if (workers == 1) expected = rig.hash();
        else EXPECT_EQ(rig.hash(), expected) << workers;
    }
}

TEST(JointRows, ManyEqualAndContradictoryJointsStayFinite) {
    JointRig rig;
    rig.add(lump({}));
    rig.add(lump({1.0f, 0.0f, 0.0f}));
    for (int i = 0; i < 100; ++i) rig.join(JointClass::fixed, 0, 1, {0.5f, 0.0f, 0.0f});
    rig.bodies[1].position = {1.1f, 0.2f, 0.0f};
    rig.join(JointClass::fixed, 0, 1, {0.5f, 0.0f, 0.0f});
    for (int i = 0; i < 300; ++i) rig.step(dt);
    EXPECT_LT(length(rig.bodies[1].v - rig.bodies[0].v), 1.0f);
    EXPECT_LT(length(rig.gap(0)), 0.3f);
}

}  // namespace
}  // namespace lendulet::test
