// Hard islands in which nothing moves leave most of their substeps out, and go on with all of them in the same step in
// which something does.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr int courses = 30;

World sleepless() { return WorldBuilder{}.sleep(false).build().value(); }

// A heavy cube on a light one, each 1 m; returns the heavy one.
BodyId add_heavy_on_light(World& world) {
    RigidBodyDef def{.shape = Box{{0.5f, 0.5f, 0.5f}}, .position = {0.0f, 0.5f, 0.0f}};
    def.mass = 1.0f;
    world.add_rigid_body(def).value();
    def.position.y = 1.5f;
    def.mass = 1000.0f;
    return world.add_rigid_body(def).value();
}

TEST(IslandRest, ColumnsThatStandLeaveSubstepsOut) {
    World world = sleepless();
    add_floor(world);
    const std::vector<BodyId> column = add_stack(world, 0.0f, courses);
    run(world, 60);
    const Position before = world.get(column.back()).position();
    int rested = 0;
    for (int i = 0; i < 240; ++i) {
        run(world, 1);
        rested += world.statistics().rested_bodies == courses;
        // It would have to sink first if it went on with fewer substeps.
        EXPECT_EQ(world.statistics().hard_bodies, courses) << i;
    }
    EXPECT_GT(rested, 230);
    EXPECT_LT(length(world.get(column.back()).position() - before), 1e-5f);
}

TEST(IslandRest, NothingRestsThatTakesTheSubstepsSet) {
    World world = sleepless();
    add_floor(world);
    add_cube(world, 0.0f, 0);
    run(world, 60);
    EXPECT_EQ(world.statistics().hard_bodies, 0);
    EXPECT_EQ(world.statistics().rested_bodies, 0);
}

TEST(IslandRest, WhatLosesItsSupportFallsAtOnce) {
    World world = sleepless();
    const BodyId slab = add_floor(world);
    const std::vector<BodyId> column = add_stack(world, 0.0f, courses);
    run(world, 60);
    ASSERT_EQ(world.statistics().rested_bodies, courses);
    world.remove_body(slab).value();
    run(world, 1);
    EXPECT_EQ(world.statistics().rested_bodies, 0);
    run(world, 5);
    float sum = 0.0f;  // boxes spring apart, and some are slower than others
    for (BodyId id : column) sum += world.get(id).velocity().y;
    EXPECT_NEAR(sum / static_cast<float>(courses), -length(world.config().gravity) * 6.0f * dt, 1e-4f);
}

TEST(IslandRest, ForcesAndBlowsActInFull) {
    World world = sleepless();
    add_floor(world);
    const BodyId heavy = add_heavy_on_light(world);
    const float g = length(world.config().gravity);
    run(world, 60);
    ASSERT_EQ(world.statistics().rested_bodies, 2);
    for (int i = 0; i < 4; ++i) {
        world.get(heavy).apply_force({0.0f, 1000.0f * (g + 3.0f), 0.0f}).value();
        run(world, 1);
    }
    // Not less, though the overlap gives it a little more.
    EXPECT_GT(world.get(heavy).velocity().y, 3.0f * 4.0f * dt - 1e-3f);
    EXPECT_LT(world.get(heavy).velocity().y, 3.0f * 4.0f * dt + 4e-2f);

    World struck = sleepless();
    add_floor(struck);
    const BodyId body = add_heavy_on_light(struck);
    run(struck, 60);
    ASSERT_EQ(struck.statistics().rested_bodies, 2);
    struck.get(body).apply_impulse({0.0f, 1000.0f, 0.0f}).value();
    run(struck, 1);
    EXPECT_EQ(struck.statistics().rested_bodies, 0);
    EXPECT_NEAR(struck.get(body).velocity().y, 1.0f - g * dt, 1e-3f);
}

// What is slow but does not rest: a column on a slope that slips goes on as gravity and friction tell.
TEST(IslandRest, WhatBeginsToSlideIsNotHeldBack) {
    World world = sleepless();
    const float slope = 0.3f;
    const Quat tilt = rotation_about({0.0f, 0.0f, 1.0f}, slope);
    world.add_static_body({.shape = Box{{40.0f, 0.5f, 5.0f}}, .orientation = tilt, .friction = 0.1f}).value();
    RigidBodyDef def{.shape = Box{{1.0f, 0.1f, 1.0f}}, .orientation = tilt, .friction = 0.1f};
    const Vec3 up = rotate(tilt, Vec3{0.0f, 1.0f, 0.0f});
    def.mass = 1.0f;
    def.position = Position{} + 0.6f * up;
    world.add_rigid_body(def).value();
    def.mass = 300.0f;
    def.position = Position{} + 0.8f * up;
    def.friction = 2.0f;
    const BodyId upper = world.add_rigid_body(def).value();
    run(world, 30);
    const float g = length(world.config().gravity);
    const float a = g * (std::sin(slope) - 0.1f * std::cos(slope));
    EXPECT_GT(world.statistics().hard_bodies, 0);
    EXPECT_NEAR(length(world.get(upper).velocity()), 30.0f * dt * a, 0.03f * 30.0f * dt * a);
}

TEST(IslandRest, WidthsAndWorkersDoNotTell) {
    uint64_t first = 0;
    for (int width : widths)
        for (int workers : {1, 3}) {
            World world = WorldBuilder{}.sleep(false).width(width).workers(workers).build().value();
            add_floor(world);
            add_stack(world, 0.0f, courses);
            add_stack(world, 4.0f, 12);
            run(world, 60);
            EXPECT_GT(world.statistics().rested_bodies, 0);
            if (first == 0) first = world.hash();
            EXPECT_EQ(world.hash(), first) << width << " " << workers;
        }
}

}  // namespace
}  // namespace lendulet::test
