// Swinging joints against closed forms: a pendulum, a heavy top, a conical pendulum.
#include <gtest/gtest.h>

#include <cmath>

#include "joint_rig.h"

namespace lendulet::test {
namespace {

constexpr double g = 9.81;

// A rod of 1 m x 0.1 m x 0.1 m, hinged at its end, released level.
struct Pendulum {
    JointRig rig;
    double inertia = (1.0 + 0.01) / 12.0;

    explicit Pendulum(int substeps) {
        rig.substeps = substeps;
        rig.add({{}, {}, 0.0f});
        RigBody rod;
        rod.position = {0.5f, 0.0f, 0.0f};
        float along = 0.02f / 12.0f, across = static_cast<float>(inertia);
        rod.inertia = {along, across, across};
        rig.add(rod);
        rig.join(JointClass::hinge, 0, 1, {}, {0.0f, 0.0f, 1.0f});
    }
    // T = 4 sqrt(I / m g d) K(sin(theta0 / 2)) with K(sin 45 degrees).
    double period() const { return 4.0 * std::sqrt((inertia + 0.25) / (g * 0.5)) * 1.8540746773013719; }
};

struct PendulumResult {
    double period_error, energy_error, gap;
};
PendulumResult swing(int substeps, float dt, double seconds) {
    Pendulum p(substeps);
    double start = p.rig.energy(), most = 0.0, gap = 0.0, first = 0.0, last = 0.0;
    int crossings = 0;
    float before = p.rig.bodies[1].position.x;
    for (int i = 1; i <= static_cast<int>(std::lround(seconds / dt)); ++i) {
        p.rig.step(dt);
        most = std::max(most, std::abs(p.rig.energy() - start));
        gap = std::max(gap, static_cast<double>(length(p.rig.gap(0))));
        float x = p.rig.bodies[1].position.x;
        if (before > 0.0f && x <= 0.0f) {
            double t = dt * (i - 1 + before / (before - x));
            (crossings++ == 0 ? first : last) = t;
        }
        before = x;
    }
    return {(last - first) / (crossings - 1) / p.period() - 1.0, most / (g * 0.5), gap};
}

TEST(JointMotion, PendulumKeepsItsPeriodAndItsEnergyForAMinute) {
    PendulumResult r = swing(8, 1.0f / 60.0f, 60.0);
    EXPECT_LT(std::abs(r.period_error), 5e-5);
    EXPECT_LT(r.energy_error, 3e-4);
    EXPECT_LT(r.gap, 5e-6);
}

TEST(JointMotion, PendulumWithFewSubsteps) {
    PendulumResult r = swing(4, 1.0f / 60.0f, 20.0);
    EXPECT_LT(std::abs(r.period_error), 2e-4);
    EXPECT_LT(r.energy_error, 1e-3);
    EXPECT_LT(r.gap, 2e-5);
}

// A disc that spins at the end of its axle, held at the other end: it precesses level at Omega = m g l / (I3 w3).
TEST(JointMotion, HeavyTopPrecessesLevel) {
    for (float spin : {50.0f, 100.0f}) {
        JointRig rig;
        rig.add({{}, {}, 0.0f});
        RigBody disc;
        float axial = 0.125f, transverse = (3.0f * 0.25f + 0.01f) / 12.0f;
        disc.inertia = {axial, transverse, transverse};
        disc.position = {1.0f, 0.0f, 0.0f};
        double omega = g / (axial * spin);
        Vec3 w{spin, static_cast<float>(omega), 0.0f};
        disc.set_w(w);
        disc.v = cross(w, Vec3{1.0f, 0.0f, 0.0f});
        rig.add(disc);
        rig.join(JointClass::ball, 0, 1, {});
        double turned = 0.0, before = 0.0, tilt = 0.0, gap = 0.0;
        for (int i = 0; i < 600; ++i) {
            rig.step(1.0f / 60.0f);
            Position x = rig.bodies[1].position;
            double angle = std::atan2(-x.z, x.x), change = angle - before;
            turned += change < -3.0 ? change + 2.0 * 3.14159265358979 : change;
            before = angle;
            tilt = std::max(tilt, std::abs(std::asin(static_cast<double>(x.y))));
            gap = std::max(gap, static_cast<double>(length(rig.gap(0))));
        }
        EXPECT_LT(tilt, 2e-4) << spin;
        EXPECT_NEAR(turned / 10.0 / omega, 1.0, 2e-4) << spin;
        EXPECT_LT(gap, 1e-4) << spin;
    }
}

// Either body may be the one that does not move.
TEST(JointMotion, FixedSideMayBeAOrB) {
    for (JointClass type : {JointClass::ball, JointClass::hinge}) {
        JointRig ab, ba;
        for (JointRig* rig : {&ab, &ba}) {
            rig->add({{}, {0.0f, 0.6f, 0.0f, 0.8f}, 0.0f});
            RigBody rod;
            rod.position = {0.5f, 0.0f, 0.0f};
            rod.inertia = {0.01f, 0.1f, 0.1f};
            rig->add(rod);
        }
        ab.join(type, 0, 1, {}, {0.0f, 0.0f, 1.0f});
        ba.join(type, 1, 0, {}, {0.0f, 0.0f, 1.0f});
        for (int i = 0; i < 20; ++i) ab.step(1.0f / 60.0f), ba.step(1.0f / 60.0f);
        EXPECT_LT(ab.bodies[1].position.y, -0.1f);
        EXPECT_NEAR(ab.bodies[1].position.x, ba.bodies[1].position.x, 1e-4f);
        EXPECT_NEAR(ab.bodies[1].position.y, ba.bodies[1].position.y, 1e-4f);
        EXPECT_LT(ba.largest_gap(), 1e-5f);
    }
}

// A net and a chain with a heavy end, as in the built-in scenes.
TEST(JointMotion, HeavyChainHoldsTogether) {
    JointRig rig;
    rig.gravity = {0.0f, -10.0f, 0.0f};
    rig.add({{}, {}, 0.0f});
    constexpr int links = 20;
    for (int i = 0; i < links; ++i) {
        RigBody link;
        link.position = {static_cast<float>(i) + 0.5f, 0.0f, 0.0f};
        link.inertia = {0.005f, 0.07f, 0.07f};
        rig.add(link);
        rig.join(JointClass::ball, i, i + 1, {static_cast<float>(i), 0.0f, 0.0f});
    }
    RigBody load;
    load.mass = 100.0f;
    load.inertia = {40.0f, 40.0f, 40.0f};
    load.position = {links + 1.0f, 0.0f, 0.0f};
    rig.add(load);
    rig.join(JointClass::ball, links, links + 1, {static_cast<float>(links), 0.0f, 0.0f});
    double start = rig.energy(), scale = 100.0 * 10.0 * links;
    float widest = 0.0f, lowest = 0.0f;
    for (int i = 0; i < 300; ++i) {
        rig.step(1.0f / 60.0f);
        widest = maximum(widest, rig.largest_gap());
        lowest = minimum(lowest, rig.bodies[links + 1].position.y);
        ASSERT_LT(rig.energy(), start + 1e-3 * scale);
    }
    EXPECT_LT(widest, 0.04f);
    EXPECT_NEAR(lowest, -(links + 1.0f), 0.3f);  // 1.1 % longer at the bottom of the swing, where it carries 300 kg
}

// Twenty rods of 1 kg with a load of 100 kg, hanging or released level, at eight times the usual substeps, which worlds
// give such chains. The sum of all gaps over the length.
double stretch(bool hangs) {
    JointRig rig;
    rig.substeps = 64;
    constexpr int rods = 20;
    auto at = [&](float way) { return hangs ? Position{0.0f, -way, 0.0f} : Position{way, 0.0f, 0.0f}; };
    rig.add({{}, {}, 0.0f});
    float along = 0.0017f, across = 0.0842f;
    for (int i = 0; i < rods; ++i) {
        RigBody rod;
        rod.position = at(static_cast<float>(i) + 0.5f);
        rod.inertia = hangs ? Vec3{across, along, across} : Vec3{along, across, across};
        rig.add(rod);
        rig.join(JointClass::ball, i, i + 1, at(static_cast<float>(i)));
    }
    RigBody load;
    load.mass = 100.0f;
    load.inertia = {16.7f, 16.7f, 16.7f};
    load.position = at(rods + 0.5f);
    rig.add(load);
    rig.join(JointClass::ball, rods, rods + 1, at(rods));
    double most = 0.0;
    for (int i = 0; i < 600; ++i) {
        rig.step(1.0f / 60.0f);
        double sum = 0.0;
        for (size_t j = 0; j < rig.joints.size(); ++j) sum += static_cast<double>(length(rig.gap(j)));
        most = std::max(most, sum / rods);
    }
    return most;
}
TEST(JointMotion, PayloadChainHangsAndSwingsAtItsLength) {
    EXPECT_LT(stretch(true), 5e-4);
    EXPECT_LT(stretch(false), 1e-2);
}

TEST(JointMotion, NetSagsLittle) {
    JointRig rig;
    rig.gravity = {0.0f, -10.0f, 0.0f};
    constexpr int side = 30;
    for (int column = 0; column < side; ++column)
        for (int row = 0; row < side; ++row) {
            RigBody ball;
            ball.position = {static_cast<float>(column), -static_cast<float>(row), 0.0f};
            ball.mass = row == 0 ? 0.0f : 1.0f;
            ball.inertia = {0.064f, 0.064f, 0.064f};
            int here = rig.add(ball);
            if (row == 0) continue;
            Position up{ball.position.x, ball.position.y + 0.5f, 0.0f},
                left{ball.position.x - 0.5f, ball.position.y, 0.0f};
            rig.join(JointClass::ball, here - 1, here, up);
            if (column > 0) rig.join(JointClass::ball, here - side, here, left);
        }
    float mean = 0.0f;
    for (int i = 0; i < 100; ++i) {
        rig.step(1.0f / 60.0f);
        mean = 0.0f;
        for (size_t j = 0; j < rig.joints.size(); ++j) mean += length(rig.gap(j));
        mean /= static_cast<float>(rig.joints.size());
        ASSERT_LT(mean, 1.5e-3f) << i;
    }
    EXPECT_EQ(rig.solver().joints().overflow(), 0);
}

}  // namespace
}  // namespace lendulet::test
