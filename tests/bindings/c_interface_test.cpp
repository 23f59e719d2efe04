// Runs the tests of c_interface.c, which is compiled as C.
#include <gtest/gtest.h>

#include "scenes/scene.h"

extern "C" {
const char* test_scenes(void);
const char* test_run_is_reproducible(const char* scene, int steps, uint64_t* hash);
const char* test_bodies_and_figures(void);
const char* test_shapes(void);
const char* test_picking_and_pulling(void);
const char* test_snapshots(void);
const char* test_building(void);
const char* test_forks_and_settings(void);
const char* test_structures(void);
const char* test_changes_and_events(void);
const char* test_steering(void);
const char* test_refusals(void);
}

namespace lendulet {
namespace {

void passes(const char* problem) { EXPECT_EQ(problem ? std::string(problem) : std::string(), ""); }

TEST(CInterface, ListsScenes) { passes(test_scenes()); }
TEST(CInterface, ReadsAndWritesBodies) { passes(test_bodies_and_figures()); }
TEST(CInterface, DescribesShapes) { passes(test_shapes()); }
TEST(CInterface, PicksAndPulls) { passes(test_picking_and_pulling()); }
TEST(CInterface, SavesAndRestores) { passes(test_snapshots()); }
TEST(CInterface, BuildsBodiesAndJoints) { passes(test_building()); }
TEST(CInterface, ForksAndTunes) { passes(test_forks_and_settings()); }
TEST(CInterface, ShowsItsStructures) { passes(test_structures()); }
TEST(CInterface, ChangesAndTells) { passes(test_changes_and_events()); }
TEST(CInterface, SteersBodiesAndAsks) { passes(test_steering()); }
TEST(CInterface, RefusesWithASentence) { passes(test_refusals()); }

TEST(CInterface, ComputesWhatTheCppInterfaceDoes) {
    for (const char* name : {"box_pile:40", "tumbler:3", "newtons_cradle"}) {
        uint64_t hash = 0;
        passes(test_run_is_reproducible(name, 50, &hash));
        Scene scene = build_scene(name).value();
        for (int step = 0; step < 50; ++step) {
            if (scene.before_step) scene.before_step(scene.world, step);
            scene.world.update(scene.dt).value();
        }
        EXPECT_EQ(hash, scene.world.hash()) << name;
    }
}

}  // namespace
}  // namespace lendulet
