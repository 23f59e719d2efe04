// Slender bodies that spin fast and touch something: in one step they turn so far that they answer many times as much
// to an impulse as at its start. They must neither gain energy nor become numbers that are none.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "lendulet/lendulet.h"
#include "numbers.h"
#include "scale.h"

namespace lendulet {
namespace {

Shape slender(int kind, float size) {
    if (kind == 0) return Capsule{size, 0.3f * size};
    if (kind == 1) return Box{{size, 0.3f * size, 0.3f * size}};
    if (kind == 2) return Cylinder{size, 0.3f * size};
    return TaperedCapsule{size, 0.2f * size, 0.6f * size};
}

// `count` bodies thrown onto a plane, each spinning at up to `spin`.
World thrown(RandomNumbers& numbers, int kind, int count, float spin) {
    World world = WorldBuilder().sleep(false).build().value();
    world.add_static_body({.shape = Plane{}}).value();
    for (int i = 0; i < count; ++i) {
        const float size = 0.06f + 2.0f * numbers.in(0.0f, 1.0f) * numbers.in(0.0f, 1.0f);
        const float x = numbers.in(-0.5f, 0.5f), y = size * numbers.in(0.5f, 3.0f), z = numbers.in(-0.5f, 0.5f);
        const Vec3 axis = numbers.vector(1.0f);
        world
            .add_rigid_body({.shape = slender(kind, size),
                             .position = {x, y, z},
                             .orientation = normalize(Quat{axis.x, axis.y, axis.z, 0.5f}),
                             .velocity = numbers.vector(20.0f),
                             .angular_velocity = numbers.vector(spin / 1.7f)})
            .value();
    }
    return world;
}

double energy(const World& world) { return world.kinetic_energy() + world.potential_energy(); }

class Spinning : public testing::TestWithParam<std::tuple<int, float>> {};

TEST_P(Spinning, LandsWithoutGainingEnergy) {
    const auto [kind, dt] = GetParam();
    for (float spin : {100.0f, 300.0f, 1000.0f, 2900.0f})
        for (int i = 0; i < scaled(100, 10); ++i) {
            RandomNumbers numbers{static_cast<uint32_t>(7919 * i + 1)};
            World world = thrown(numbers, kind, 1, spin);
            const double before = energy(world);
            for (int k = 0; k < 10; ++k) {
                ASSERT_TRUE(world.update(dt).ok());
                ASSERT_EQ(world.statistics().contained_bodies, 0) << "case " << i << ", " << spin << " rad/s";
                ASSERT_LT(energy(world), 1.05 * before) << "case " << i << ", " << spin << " rad/s";
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Spinning,
                         testing::Combine(testing::Values(0, 1, 2, 3),
                                          testing::Values(1.0f / 60.0f, 1.0f / 30.0f, 0.1f)));

// Bodies with two equal moments go round L as the closed form has it (Euler 1758), however far within a substep.
TEST(FastTops, PrecessAsTheClosedForm) {
    for (float spin : {60.0f, 400.0f, 2500.0f})
        for (int kind = 0; kind < 3; ++kind) {
            const float size = 0.1f;
            World world = WorldBuilder().gravity({}).sleep(false).build().value();
            const Vec3 w = spin * normalize(Vec3{0.5f, 0.3f, -0.7f});
            BodyId id = world.add_rigid_body({.shape = slender(kind, size), .angular_velocity = w}).value();
            const Vec3 L = world.get(id).angular_momentum(), axis = kind == 1 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
            const Vec3 aside = normalize(w - dot(w, axis) * axis);
            const double rate = static_cast<double>(dot(w, aside)) / dot(L, aside) * length(L);  // |L| / moment across
            const double before = energy(world);
            for (int k = 0; k < 60; ++k) ASSERT_TRUE(world.update(1.0f / 60.0f).ok());
            const double angle = rate * 60.0 * static_cast<double>(1.0f / 60.0f);
            const Vec3 n = normalize(L), across = cross(n, axis), along = dot(n, axis) * n;
            const Vec3 expected = along + static_cast<float>(std::cos(angle)) * (axis - along) +
                                  static_cast<float>(std::sin(angle)) * across;
            // Rates are known to single precision.
            EXPECT_LT(length(rotate(world.get(id).orientation(), axis) - expected), 2e-4f + 4e-7f * angle)
                << spin << " " << kind;
            EXPECT_NEAR(energy(world), before, 4e-5 * before) << spin << " " << kind;  // rounding of 480 turns
        }
}

// Of several that meet in long steps energy is not asked, but numbers are.
TEST(SpinningHeap, StaysFinite) {
    for (float dt : {1.0f / 60.0f, 1.0f / 30.0f, 0.15f})
        for (float spin : {100.0f, 1000.0f, 2900.0f})
            for (int i = 0; i < scaled(40, 5); ++i) {
                RandomNumbers numbers{static_cast<uint32_t>(7919 * i + 1)};
                World world = thrown(numbers, i % 4, 4, spin);
                for (int k = 0; k < 10; ++k) {
                    ASSERT_TRUE(world.update(dt).ok());
                    ASSERT_EQ(world.statistics().contained_bodies, 0) << "case " << i << ", " << spin << " rad/s";
                }
            }
}

}  // namespace
}  // namespace lendulet
