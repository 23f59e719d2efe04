// Bodies that touch, or are joined to, more others than there are colours: see solver/stand_ins.h.
#include <gtest/gtest.h>

#include <cmath>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

struct Bed {
    World world;
    BodyId slab;
};

// A slab on a bed of balls that a rim holds together.
Bed slab_on_balls(int width, int workers) {
    Bed bed{WorldBuilder{}.width(width).workers(workers).sleep(false).build().value(), {}};
    test::add_floor(bed.world);
    for (int i = 0; i < 4; ++i) {
        const float x = i == 0 ? 4.3f : i == 1 ? -4.3f : 0.0f, z = i == 2 ? 4.3f : i == 3 ? -4.3f : 0.0f;
        bed.world
            .add_static_body({.shape = Box{{i < 2 ? 0.5f : 5.0f, 1.0f, i < 2 ? 5.0f : 0.5f}}, .position = {x, 0.2f, z}})
            .value();
    }
    for (int i = 0; i < 144; ++i) {
        const float x = 0.62f * static_cast<float>(i % 12) - 3.41f, z = 0.62f * static_cast<float>(i / 12) - 3.41f;
        bed.world.add_rigid_body({.shape = Sphere{0.3f}, .position = {x, 0.3f, z}}).value();
    }
    bed.slab =
        bed.world
            .add_rigid_body({.shape = Box{{3.7f, 0.2f, 3.7f}}, .position = {0.0f, 0.81f, 0.0f}, .density = 3000.0f})
            .value();
    return bed;
}

TEST(SharedBody, ASlabLiesOnManyBalls) {
    Bed bed = slab_on_balls(0, 1);
    test::run(bed.world, 180);
    ASSERT_GT(bed.world.statistics().overflow_manifolds, 80);
    const RigidBodyRef slab = bed.world.get(bed.slab);
    EXPECT_NEAR(slab.position().y, 0.8, 1e-3);
    EXPECT_LT(length(slab.velocity()), 1e-3f);
    EXPECT_GT(rotate(slab.orientation(), {0.0f, 1.0f, 0.0f}).y, 1.0f - 1e-6f);
    EXPECT_LT(bed.world.statistics().max_penetration, 1.5e-3f);
}

TEST(SharedBody, HasTheSameBitsForAllWidthsAndWorkers) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 3}}) {
        Bed bed = slab_on_balls(width, workers);
        test::run(bed.world, 40);
        bed.world.get(bed.slab).apply_impulse({9e3f, 0.0f, 5e3f}, {1.0, 1.0, 2.0}).value();
        test::run(bed.world, 60);
        if (expected == 0) expected = bed.world.hash();
        EXPECT_EQ(bed.world.hash(), expected) << width << " " << workers;
    }
}

// Sixty-four balls strike a plate at once, off its middle.
TEST(SharedBody, NothingOfTheirMomentaIsLost) {
    World world = WorldBuilder{}.no_gravity().friction(0.6f).build().value();
    world.add_rigid_body({.shape = Box{{2.0f, 0.1f, 2.0f}}, .position = {0.0f, 0.0f, 0.0f}, .mass = 50.0f}).value();
    for (int i = 0; i < 64; ++i) {
        const float x = 0.4f * static_cast<float>(i % 8) - 1.7f, z = 0.4f * static_cast<float>(i / 8) - 1.1f;
        world
            .add_rigid_body({.shape = Sphere{0.15f},
                             .position = {x, 0.26f, z},
                             .velocity = {1.0f, -3.0f - 0.2f * x, 0.5f},
                             .angular_velocity = {z, 4.0f, x},
                             .mass = 2.0f})
            .value();
    }
    const Momentum before = world.momentum();
    const double energy = world.kinetic_energy();
    test::run(world, 10);
    ASSERT_GT(world.statistics().overflow_manifolds, 16);
    const Momentum after = world.momentum();
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(after.linear[i], before.linear[i], 1e-4 * std::fabs(before.linear[1])) << i;
        EXPECT_NEAR(after.angular[i], before.angular[i], 1e-3 * std::fabs(before.linear[1])) << i;
    }
    EXPECT_LT(world.kinetic_energy(), energy);
}

TEST(SharedBody, JointsThatShareItHaveTheSameBitsForAllWidths) {
    uint64_t expected = 0;
    for (const int width : test::widths) {
        World world = WorldBuilder{}.width(width).sleep(false).build().value();
        const BodyId hub = world.add_rigid_body({.shape = Sphere{1.0f}, .position = {0.0f, 5.0f, 0.0f}}).value();
        for (int i = 0; i < 48; ++i) {
            const float turn = 2.0f * pi * static_cast<float>(i) / 48.0f, x = std::cos(turn), z = std::sin(turn);
            const BodyId arm =
                world
                    .add_rigid_body(
                        {.shape = Sphere{0.1f}, .position = {1.5f * x, 5.0f, 1.5f * z}, .filter = {.group = 1}})
                    .value();
            const JointDef joint = world.joint_at(JointType::ball, hub, arm, {1.1f * x, 5.0f, 1.1f * z}).value();
            world.add_joint(joint).value();
        }
        test::run(world, 60);
        for (int i = 0; i < world.joint_count(); ++i)
            EXPECT_LT(length(world.joint(world.joint_id(i)).linear_error), 5e-3f) << i;
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width;
    }
}

}  // namespace
}  // namespace lendulet
