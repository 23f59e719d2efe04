// Bodies that nothing acts on but gravity: they take a step at once, and go as by substeps.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "world/support.h"

namespace lendulet::test {
namespace {

// The thrown body's state after a second, in steps of so many substeps.
struct Flown {
    Vec3 place, momentum, angular_momentum;
    Quat orientation;
};
Flown flown(const RigidBodyDef& def, int substeps) {
    World world = WorldBuilder{}.down_gravity(9.81f).sleep(false).solver_steps(substeps).build().value();
    const BodyId body = world.add_rigid_body(def).value();
    run(world, 60);
    const RigidBodyRef ref = world.get(body);
    return {from_origin(ref.position()), ref.momentum(), ref.angular_momentum(), ref.orientation()};
}

// How far two orientations are apart, rad.
float between(Quat a, Quat b) {
    const Quat d = a * conjugate(b);
    return 2.0f * std::asin(std::fmin(1.0f, length(Vec3{d.x, d.y, d.z})));
}

RigidBodyDef thrown(Shape shape, Vec3 spin) {
    RigidBodyDef def{.shape = std::move(shape), .position = {1.0f, 2.0f, 3.0f}};
    def.velocity = {3.0f, 4.0f, -5.0f};
    def.angular_velocity = spin;
    return def;
}

TEST(FreeFall, BallsTurnEvenlyHoweverFast) {
    for (float spin : {0.1f, 5.0f, 40.0f, 900.0f}) {
        const RigidBodyDef def = thrown(Sphere{0.2f}, {0.0f, 0.6f * spin, 0.8f * spin});
        const Flown end = flown(def, 8);
        EXPECT_NEAR(end.place.x, 4.0f, 1e-5f);
        EXPECT_NEAR(end.place.y, 2.0f + 4.0f - 0.5f * 9.81f, 1e-5f);
        EXPECT_NEAR(end.place.z, -2.0f, 1e-5f);
        const double angle = std::remainder(static_cast<double>(spin), 2.0 * 3.14159265358979323846);
        const auto s = static_cast<float>(std::sin(0.5 * angle)), c = static_cast<float>(std::cos(0.5 * angle));
        EXPECT_LT(between(end.orientation, {0.0f, 0.6f * s, 0.8f * s, c}), 2e-6f * (10.0f + spin)) << spin;
    }
}

// Also where a body's own motion asks for substeps: the box that tumbles is none of those that go at once.
TEST(FreeFall, StepsInOneAndInPartsAgree) {
    const std::pair<RigidBodyDef, float> cases[] = {{thrown(Sphere{0.3f}, {20.0f, 0.0f, 3.0f}), 2e-5f},
                                                    {thrown(Box{{0.2f, 0.2f, 0.2f}}, {1.0f, 7.0f, 3.0f}), 2e-5f},
                                                    {thrown(Capsule{0.5f, 0.1f}, {4.0f, 9.0f, -2.0f}), 1e-4f},
                                                    {thrown(Box{{0.5f, 0.2f, 0.1f}}, {}), 1e-6f},
                                                    {thrown(Box{{0.5f, 0.2f, 0.1f}}, {1.0f, 2.0f, 3.0f}), 3e-4f}};
    for (const auto& [def, tolerance] : cases) {
        const Flown one = flown(def, 8), other = flown(def, 64);
        EXPECT_LT(length(one.place - other.place), 1e-5f);
        EXPECT_EQ(one.momentum, other.momentum);
        EXPECT_EQ(one.angular_momentum, other.angular_momentum);
        EXPECT_LT(between(one.orientation, other.orientation), tolerance);
    }
}

// Bodies come and go among those that take the step at once: the same bits for every width and number of workers.
TEST(FreeFall, RainGivesTheSameBits) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 3}, {8, 1}, {16, 2}}) {
        World world = WorldBuilder{}.width(width).workers(workers).build().value();
        add_floor(world);
        for (int i = 0; i < 60; ++i) {
            RigidBodyDef def = thrown(Sphere{0.2f}, {0.0f, static_cast<float>(i), 1.0f});
            if (i % 7 == 3) def.angular_velocity = {1e-13f, 0.3f, 0.0f};  // side by side in lanes with ...
            if (i % 7 == 4) def.angular_velocity = {0.0f, 900.0f, 0.0f};
            if (i % 3 == 1) def.shape = Box{{0.3f, 0.2f, 0.1f}};
            if (i % 3 == 2) def.shape = Capsule{0.2f, 0.1f};
            def.position = {static_cast<float>(i % 8), 1.0f + 0.3f * static_cast<float>(i), static_cast<float>(i % 5)};
            def.velocity = {};
            def.restitution = i % 2 == 0 ? 0.5f : 0.0f;
            world.add_rigid_body(def).value();
        }
        run(world, 150);
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width << " " << workers;
    }
}

}  // namespace
}  // namespace lendulet::test
