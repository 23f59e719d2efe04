// Which islands take more substeps than are set: those under load, and not what has just landed.
#include <gtest/gtest.h>

#include <utility>

#include "world/support.h"

namespace lendulet::test {
namespace {

World awake_world() { return WorldBuilder{}.sleep(false).build().value(); }

// The most bodies at a time that took more substeps.
int most_hard(World& world, int steps) {
    int most = 0;
    for (int i = 0; i < steps; ++i) {
        run(world, 1);
        most = std::max(most, world.statistics().hard_bodies);
    }
    return most;
}

TEST(HardIslands, WhatLandsIsNoLoad) {
    for (float height : {0.6f, 0.9f, 1.7f, 3.1f, 5.3f}) {
        World world = awake_world();
        add_floor(world);
        for (int i = 0; i < 8; ++i) {
            RigidBodyDef def{.shape = Box{{0.5f, 0.5f, 0.5f}}};
            def.position = {3.0f * static_cast<float>(i), height + 0.07f * static_cast<float>(i), 0.0f};
            if (i % 2 == 1) def.shape = Sphere{0.5f};
            world.add_rigid_body(def).value();
        }
        EXPECT_EQ(most_hard(world, 150), 0) << height;
    }
}

// Nor is it one for what it lands on, though that has lain still and is pressed against the floor.
TEST(HardIslands, WhatIsLandedOnCarriesNoMore) {
    for (float height : {2.2f, 2.9f, 4.1f}) {
        World world = awake_world();
        add_floor(world);
        RigidBodyDef def{.shape = Box{{0.5f, 0.5f, 0.5f}}};
        for (int i = 0; i < 8; ++i) {
            def.position = {3.0f * static_cast<float>(i), 0.5f, 0.0f};
            world.add_rigid_body(def).value();
        }
        run(world, 30);
        for (int i = 0; i < 8; ++i) {
            RigidBodyDef falling = def;
            if (i % 2 == 1) falling.shape = Sphere{0.5f};
            falling.position = {3.0f * static_cast<float>(i) + 0.1f, height + 0.07f * static_cast<float>(i), 0.05f};
            world.add_rigid_body(falling).value();
        }
        EXPECT_EQ(most_hard(world, 120), 0) << height;
    }
}

TEST(HardIslands, ColumnsAndHeavyOnLightTakeMore) {
    World world = awake_world();
    add_floor(world);
    add_stack(world, 0.0f, 30);
    EXPECT_EQ(most_hard(world, 1), 30);
    World loaded = awake_world();
    add_floor(loaded);
    RigidBodyDef def{.shape = Box{{0.5f, 0.5f, 0.5f}}, .position = {0.0f, 0.5f, 0.0f}};
    def.mass = 1.0f;
    loaded.add_rigid_body(def).value();
    run(loaded, 30);
    EXPECT_EQ(loaded.statistics().hard_bodies, 0);
    // Dropped on it, it counts once both have been slow for three steps.
    def.position.y = 1.7f;
    def.mass = 1000.0f;
    loaded.add_rigid_body(def).value();
    run(loaded, 60);
    EXPECT_EQ(loaded.statistics().hard_bodies, 2);
}

// Nothing falls by sinking: where an island is so large that more substeps would be dear, it keeps to those set.
TEST(HardIslands, LargeOnesMaySink) {
    for (const auto& [side, hard] : {std::pair{6, true}, {13, false}}) {
        World world = awake_world();
        add_floor(world, 40.0f);
        const float half = static_cast<float>(side);
        for (int i = 0; i < side * side; ++i) {
            const auto x = static_cast<float>(i % side), z = static_cast<float>(i / side);
            world
                .add_rigid_body({.shape = Box{},
                                 .position = {2.0f * x - half + 1.0f, 0.5f, 2.0f * z - half + 1.0f},
                                 .density = 10.0f})
                .value();
        }
        world.add_rigid_body({.shape = Box{{half, 0.1f, half}}, .position = {0.0f, 1.1f, 0.0f}, .density = 1250.0f})
            .value();
        run(world, 10);
        EXPECT_EQ(world.statistics().hard_bodies, hard ? side * side + 1 : 0) << side;
        run(world, 120);
        EXPECT_LT(world.statistics().max_penetration, 6e-3f) << side;
    }
}

// A pyramid of a hundred layers is a wall that rocks out of its plane, softly; that mode must die out. Where too little
// of an impulse leaked it grew, to 7 kJ after 200 steps and 15 kJ after 240, and the wall fell within a minute.
TEST(HardIslands, AHighWallDoesNotRockByItself) {
    World world = WorldBuilder{}.friction(0.6f).gravity({0.0f, -10.0f, 0.0f}).sleep(false).build().value();
    add_floor(world, 100.0f);
    constexpr int base = 99;
    for (int layer = 0; layer < base; ++layer)
        for (int i = 0; i < base - layer; ++i)
            world
                .add_rigid_body({.shape = Box{},
                                 .position = {static_cast<float>(i) - 0.5f * static_cast<float>(base - layer - 1),
                                              0.5f + static_cast<float>(layer), 0.0f}})
                .value();
    run(world, 240);
    EXPECT_LT(world.kinetic_energy(), 1000.0);
}

// A column that is blown apart is none any more: its boxes do not go on for seconds as if they carried it.
TEST(HardIslands, WhatFallsApartTakesFewerSoon) {
    World world = awake_world();
    add_floor(world, 200.0f);
    const std::vector<BodyId> column = add_stack(world, 0.0f, 30);
    run(world, 10);
    EXPECT_EQ(world.statistics().hard_bodies, 30);
    for (size_t i = 0; i < column.size(); ++i)
        world.get(column[i]).set_velocity({i % 2 == 0 ? 9.0f : -9.0f, 5.0f, i % 3 == 0 ? 7.0f : -6.0f}).value();
    run(world, 60);
    EXPECT_EQ(world.statistics().hard_bodies, 0);
}

}  // namespace
}  // namespace lendulet::test
