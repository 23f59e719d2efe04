// Tall heaps stand for a minute with the default settings and sleeping off; what was put to rest stays where it is.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "scale.h"
#include "scenes/scene.h"

namespace lendulet {
namespace {

struct Stand {
    float sideways = 0.0f, sink = 0.0f;  // largest of all bodies at the end, m
    float top_sideways = 0.0f, top_sink = 0.0f;
    float speed = 0.0f;  // largest at the end, m/s
};

Stand stand_for_a_minute(const char* name) {
    Scene scene = build_scene(name, [](WorldBuilder& builder) { builder.sleep(false); }).value();
    World& world = scene.world;
    std::vector<Position> start;
    for (int i = 0; i < world.body_count(); ++i) start.push_back(world.get_static(world.body(i)).position());
    const int steps = scaled(3600, 300);
    for (int step = 0; step < steps; ++step) world.update(1.0f / 60.0f).value();
    Stand stand;
    for (int i = 1; i < world.body_count(); ++i) {
        const RigidBodyRef body = world.get(world.body(i));
        Vec3 moved = body.position() - start[static_cast<size_t>(i)];
        stand.top_sideways = std::hypot(moved.x, moved.z);
        stand.top_sink = -moved.y;
        stand.sideways = maximum(stand.sideways, stand.top_sideways);
        stand.sink = maximum(stand.sink, stand.top_sink);
        stand.speed = maximum(stand.speed, length(body.velocity()));
    }
    std::cout << "    " << name << ": top sideways " << 1e3f * stand.top_sideways << " mm, top sink "
              << 1e3f * stand.top_sink << " mm, largest sideways " << 1e3f * stand.sideways << " mm, largest sink "
              << 1e3f * stand.sink << " mm, speed " << stand.speed << " m/s\n";
    testing::Test::RecordProperty("top_sideways_mm", std::to_string(1e3f * stand.top_sideways));
    testing::Test::RecordProperty("top_sink_mm", std::to_string(1e3f * stand.top_sink));
    return stand;
}

// The top is within 5 mm of the axis and no joint of two boxes has sunk in by more than a fraction of a box.
TEST(Stability, StackOf20StandsForAMinute) {
    Stand stand = stand_for_a_minute("stack:20");
    EXPECT_LE(stand.top_sideways, 5e-3f);
    EXPECT_LE(stand.sideways, 5e-3f);
    EXPECT_LE(stand.top_sink, 0.01f);
    EXPECT_LE(stand.speed, 1e-2f);
}

// Islands that carry much take more substeps (docs/solver.md, hard islands): faces sink by less than 5 mm even where
// one box carries a thousand times its weight.
TEST(Stability, TallStacksStandForAMinute) {
    for (const char* name : {"stack:50", "stack:100"}) {
        Stand stand = stand_for_a_minute(name);
        EXPECT_LE(stand.sideways, 0.25f) << name;
        EXPECT_LE(stand.top_sink, 0.05f) << name;
        EXPECT_LE(stand.speed, 1e-2f) << name;
    }
}

TEST(Stability, LightBoxesCarryHeavyOnesForAMinute) {
    for (const char* name : {"mass_ratio:100", "mass_ratio:1000"}) {
        Stand stand = stand_for_a_minute(name);
        EXPECT_LE(stand.sideways, 5e-2f) << name;  // all of it in the first second, while impulses build up
        EXPECT_LE(stand.sink, 0.025f) << name;
        EXPECT_LE(stand.speed, 5e-2f) << name;
    }
}

TEST(Stability, PyramidOfBase20StandsForAMinute) {
    Stand stand = stand_for_a_minute("large_pyramid:20");
    EXPECT_LE(stand.top_sideways, 5e-3f);
    EXPECT_LE(stand.sideways, 2e-2f);
    EXPECT_LE(stand.top_sink, 0.02f);
    EXPECT_LE(stand.speed, 1e-2f);
}

// Boxes that land on each other turn fast and meet beside where they were nearest: it was 23 cm with points there
// alone.
TEST(Stability, PileLandsWithoutDeepOverlaps) {
    // Which pair meets worst is chance: several piles, and their mean.
    float sum = 0.0f;
    for (const char* name : {"box_pile:800", "box_pile:900", "box_pile:1000", "box_pile:1100"}) {
        Scene scene = build_scene(name).value();
        float deepest = 0.0f;
        for (int step = 0; step < 120; ++step) {
            scene.world.update(scene.dt).value();
            deepest = maximum(deepest, scene.world.statistics().max_penetration);
        }
        EXPECT_GT(deepest, 1e-3f) << name;
        EXPECT_LT(deepest, 0.16f) << name;
        sum += deepest;
    }
    EXPECT_LT(0.25f * sum, 0.11f);
}

// Boxes only: what is round may roll on for long, since nothing brakes rolling.
TEST(Stability, PileFallsAsleepInItsContainer) {
    for (const char* name : {"box_pile:60", "mixed_pile:60"}) {
        Scene scene = build_scene(name).value();
        World& world = scene.world;
        for (int step = 0; step < 900; ++step) world.update(scene.dt).value();
        constexpr float inner = 0.5f * 3.0f * 1.8f;  // 3 x 3 bodies a layer
        for (int i = 5; i < world.body_count(); ++i) {
            Position p = world.get_static(world.body(i)).position();
            EXPECT_GT(p.y, 0.0f) << name << ' ' << i;
            EXPECT_LT(absolute(p.x), inner) << name << ' ' << i;
            EXPECT_LT(absolute(p.z), inner) << name << ' ' << i;
        }
        if (name[0] == 'b') {
            EXPECT_EQ(world.statistics().awake_bodies, 0);
        }
    }
}

}  // namespace
}  // namespace lendulet
