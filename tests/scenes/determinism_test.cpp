// One scene has one result: for any number of workers, any SIMD width and every broad phase.
#include <gtest/gtest.h>

#include <string>

#include "scale.h"
#include "scenes/scene.h"

namespace lendulet {
namespace {

const int steps = scaled(60, 10);

uint64_t hash_after(const char* name, const Configure& configure) {
    Scene scene = build_scene(name, configure).value();
    for (int step = 0; step < steps; ++step) {
        if (scene.before_step) scene.before_step(scene.world, step);
        scene.world.update(scene.dt).value();
    }
    EXPECT_EQ(scene.world.check(), "") << name;
    return scene.world.hash();
}

class Determinism : public testing::TestWithParam<const char*> {
protected:
    void same_as(uint64_t expected, const Configure& configure, const std::string& what) {
        EXPECT_EQ(hash_after(GetParam(), configure), expected) << GetParam() << " with " << what;
    }
};

TEST_P(Determinism, WorkersAndWidths) {
    uint64_t expected = hash_after(GetParam(), [](WorldBuilder& builder) { builder.workers(1).width(1); });
    for (int workers : {1, 2, 5, 8})
        for (int width : {1, 4, 8, 16}) {
            if (workers == 1 && width == 1) continue;
            // Every worker count with two widths and every width with two counts: all pairs would show no more.
            if (workers != 1 && workers != 5 && width != 1 && width != 8) continue;
            same_as(
                expected, [&](WorldBuilder& builder) { builder.workers(workers).width(width); },
                std::to_string(workers) + " workers, width " + std::to_string(width));
        }
}

// Heaps so large that workers share the colours of their contacts.
TEST(LargeHeaps, WorkersAndWidths) {
    for (const char* name : {"box_pile:1500", "ragdolls:120"}) {
        auto hash = [&](int workers, int width) {
            return hash_after(name, [=](WorldBuilder& b) { b.workers(workers).width(width); });
        };
        const uint64_t expected = hash(1, 0);
        for (int workers : {2, 3, 8}) EXPECT_EQ(hash(workers, workers == 3 ? 8 : 0), expected) << name << workers;
    }
}

TEST_P(Determinism, BroadPhases) {
    uint64_t expected = hash_after(GetParam(), {});
    for (BroadPhaseType type :
         {BroadPhaseType::all_pairs, BroadPhaseType::sweep_1, BroadPhaseType::sweep_3, BroadPhaseType::rtree_quadratic,
          BroadPhaseType::rtree_star, BroadPhaseType::rtree_str, BroadPhaseType::rtree_omt, BroadPhaseType::wide_tree})
        same_as(
            expected, [&](WorldBuilder& builder) { builder.broad_phase(type).workers(2); }, std::string(name_of(type)));
}

TEST_P(Determinism, EverySteppedWorldHashesDifferently) {
    Scene scene = build_scene(GetParam()).value();
    uint64_t start = scene.world.hash();
    scene.world.update(scene.dt).value();
    EXPECT_NE(scene.world.hash(), start);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism,
                         testing::Values("box_pile:200", "mixed_pile:200", "ragdolls:4", "mesh_terrain:60",
                                         "height_field:60", "tumbler:4", "newtons_cradle", "stack:50",
                                         "mass_ratio:1000", "domino_spiral:20", "brick_tower:4", "arch:9",
                                         "card_house:2", "ragdoll_avalanche:4", "bridge:12", "car", "gear_train:3",
                                         "walker", "hourglass:60", "marble_machine:40", "t_handle"),
                         [](const testing::TestParamInfo<const char*>& info) {
                             std::string name = info.param;
                             for (char& c : name)
                                 if (c == ':') c = '_';
                             return name;
                         });

}  // namespace
}  // namespace lendulet
