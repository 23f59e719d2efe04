// Two bodies that meet at speeds at which they go by each other within a step, or even a substep: they gain no energy,
// keep their momenta, and balls meet only where they would.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lendulet/lendulet.h"
#include "numbers.h"
#include "scale.h"

namespace lendulet {
namespace {

constexpr int kinds = 6;

Shape shape_of(int kind) {
    switch (kind) {
        case 0:
            return Sphere{0.1f};
        case 1:
            return Box{{0.1f, 0.1f, 0.1f}};
        case 2:
            return Capsule{0.15f, 0.05f};
        case 3:
            return Cylinder{0.1f, 0.1f};
        case 4:
            return Box{{0.3f, 0.02f, 0.1f}};
        default: {
            std::vector<Vec3> corners;
            for (int i = 0; i < 5; ++i)
                for (float y : {-0.1f, 0.1f})
                    corners.push_back({0.1f * std::cos(1.2566f * static_cast<float>(i)), y,
                                       0.1f * std::sin(1.2566f * static_cast<float>(i))});
            return ConvexHull::from_points(corners).value();
        }
    }
}

// On their way towards each other, so that they meet after one to three steps of 1/60 s, up to 0.4 m beside the middle.
struct Meeting {
    World world;
    float beside;
};
Meeting meeting(RandomNumbers numbers, int kind_a, int kind_b, float speed, float restitution) {
    Meeting m{WorldBuilder{}.no_gravity().bounciness(restitution).build().value(), 0.0f};
    const float y = numbers.in(-0.4f, 0.4f), z = numbers.in(-0.4f, 0.4f), way = numbers.in(0.5f, 2.5f) * speed / 60.0f;
    const Quat turn_a = numbers.turn(), turn_b = numbers.turn();
    m.beside = std::hypot(y, z);
    for (bool first : {true, false})
        m.world
            .add_rigid_body({.shape = shape_of(first ? kind_a : kind_b),
                             .position = {(first ? -1.0f : 1.0f) * (way + 0.5f), first ? y : 0.0f, first ? z : 0.0f},
                             .orientation = first ? turn_a : turn_b,
                             .velocity = {first ? speed : -speed, 0.0f, 0.0f}})
            .value();
    return m;
}

struct Case {
    int a, b;
    float restitution;
};

class FastPair : public testing::TestWithParam<Case> {};

TEST_P(FastPair, GainsNoEnergyAndKeepsMomenta) {
    const Case c = GetParam();
    const double most =
        c.restitution < 1.0f ? 1.0 + 1e-5 : 1.02;  // elastic ones leave little room: one in 3000 used it
    for (float speed : {5.0f, 20.0f, 50.0f, 100.0f, 200.0f, 400.0f})
        for (int i = 0; i < scaled(50, 5); ++i) {
            World world = meeting({static_cast<uint32_t>(7919 * i + 1)}, c.a, c.b, speed, c.restitution).world;
            const std::string name = "case " + std::to_string(i) + ", " + std::to_string(speed) + " m/s";
            const double before = world.kinetic_energy();
            const Momentum start = world.momentum();
            const double p = world.get(world.body(0)).mass() * speed;
            for (int k = 0; k < 8; ++k) {
                ASSERT_TRUE(world.update(1.0f / 60.0f).ok());
                ASSERT_LT(world.kinetic_energy(), most * before) << name;
            }
            const Momentum end = world.momentum();
            for (int k = 0; k < 3; ++k) {
                ASSERT_NEAR(end.linear[k], start.linear[k], 1e-5 * p) << name;
                // Faster ones come to spin faster than bodies may, and are cut.
                if (speed > 100.0f) continue;
                ASSERT_NEAR(end.angular[k], start.angular[k], 1e-4 * p) << name;
            }
        }
}

std::vector<Case> all_pairs() {
    std::vector<Case> cases;
    for (int a = 0; a < kinds; ++a)
        for (int b = a; b < kinds; ++b) cases.push_back({a, b, (a + b) % 3 == 0 ? 0.5f : 0.0f});
    for (int a = 0; a < kinds; ++a) cases.push_back({0, a, 1.0f});
    return cases;
}
INSTANTIATE_TEST_SUITE_P(Shapes, FastPair, testing::ValuesIn(all_pairs()));

// Contacts are foreseen for a whole step, in which these balls go by each other by up to 70 radii.
TEST(FastBalls, MeetOnlyWhereTheyWould) {
    for (float restitution : {0.0f, 0.5f})
        for (float speed : {5.0f, 20.0f, 100.0f, 400.0f})
            for (int i = 0; i < scaled(200, 20); ++i) {
                Meeting m = meeting({static_cast<uint32_t>(7919 * i + 1)}, 0, 0, speed, restitution);
                if (std::fabs(m.beside - 0.2f) < 5e-3f) continue;  // they graze, and may touch or not
                const float before = m.world.get(m.world.body(0)).velocity().x;
                for (int k = 0; k < 8; ++k) ASSERT_TRUE(m.world.update(1.0f / 60.0f).ok());
                const bool met = m.world.get(m.world.body(0)).velocity().x != before;
                ASSERT_EQ(met, m.beside < 0.2f) << "case " << i << ", " << speed << " m/s, " << m.beside
                                                << " m beside, restitution " << restitution;
            }
}

// Sixty of them in a box of 8 m, without gravity.
class FastCrowd : public testing::TestWithParam<float> {};

TEST_P(FastCrowd, GainsNoEnergy) {
    const float restitution = GetParam();
    for (float speed : {30.0f, 100.0f, 300.0f}) {
        World world = WorldBuilder{}.no_gravity().bounciness(restitution).build().value();
        for (int axis = 0; axis < 3; ++axis)
            for (float side : {-5.0f, 5.0f}) {
                Vec3 half{6.0f, 6.0f, 6.0f}, place{};
                set_component(half, axis, 1.0f);
                set_component(place, axis, side);
                world.add_static_body({.shape = Box{half}, .position = Position{} + place}).value();
            }
        RandomNumbers numbers{3};
        for (int i = 0; i < 60; ++i) {
            const Vec3 place = numbers.vector(3.3f), velocity = numbers.vector(speed);
            const Quat turn = numbers.turn();
            world
                .add_rigid_body({.shape = shape_of(i % kinds),
                                 .position = Position{} + place,
                                 .orientation = turn,
                                 .velocity = velocity,
                                 .angular_velocity = numbers.vector(10.0f)})
                .value();
        }
        for (int k = 0; k < 6; ++k) world.update(1.0f / 60.0f).value();  // some begin within each other
        double before = world.kinetic_energy();
        for (int k = 0; k < scaled(120, 30); ++k) {
            ASSERT_TRUE(world.update(1.0f / 60.0f).ok());
            ASSERT_LT(world.kinetic_energy(), (1.0 + 1e-3) * before) << speed << " m/s, step " << k;
            before = world.kinetic_energy();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Restitutions, FastCrowd, testing::Values(0.0f, 0.5f, 0.9f));

}  // namespace
}  // namespace lendulet
