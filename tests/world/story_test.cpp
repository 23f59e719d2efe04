// Random stories told to several worlds at once: what no test was written for must not depend on threads, lanes, broad
// phase, snapshots or forks either, and nothing comes of nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scale.h"
#include "world/story.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

struct Telling {
    World world;
    Story story;
    Telling(uint32_t seed, StoryCast cast, int workers, int width, BroadPhaseType broad_phase)
        : world(WorldBuilder{}.workers(workers).width(width).broad_phase(broad_phase).build().value()),
          story(seed, cast) {
        story.begin(world);
    }
};

TEST(Stories, HaveTheSameBitsForAllWorkersWidthsAndBroadPhases) {
    for (uint32_t seed = 0; seed < static_cast<uint32_t>(scaled(4, 1)); ++seed) {
        Telling first(seed, {}, 1, 8, BroadPhaseType::wide_tree);
        Telling others[] = {{seed, {}, 2, 4, BroadPhaseType::rtree_star},
                            {seed, {}, 4, 16, BroadPhaseType::sweep_1},
                            {seed, {}, 1, 1, BroadPhaseType::wide_tree}};
        for (int step = 0; step < scaled(200, 60); ++step) {
            first.story.go_on(first.world, dt);
            const bool asks = step % 25 == 24;
            const std::vector<uint8_t> state = asks ? first.world.snapshot() : std::vector<uint8_t>{};
            for (Telling& other : others) {
                other.story.go_on(other.world, dt);
                ASSERT_EQ(other.world.hash(), first.world.hash()) << seed << " step " << step;
                if (!asks) continue;
                ASSERT_EQ(other.world.snapshot(), state) << seed << " step " << step;
            }
            if (!asks) continue;
            ASSERT_EQ(first.world.check(), "") << seed << " step " << step;
            ASSERT_TRUE(all_finite(first.world)) << seed << " step " << step;
        }
    }
}

void there_and_back(World& world, uint32_t seed, int step) {
    const std::vector<uint8_t> saved = world.snapshot();
    World fork = world.fork().value();
    run(fork, 10);
    run(world, 10);
    ASSERT_EQ(fork.hash(), world.hash()) << seed << " step " << step;
    ASSERT_TRUE(world.restore(saved).ok()) << seed << " step " << step;
    ASSERT_EQ(world.snapshot(), saved) << seed << " step " << step;
}

// One world goes ahead and is put back time and again, another one never; a fork goes ahead with the first. Every
// second time that is between something that happens and the step after it.
TEST(Stories, GoOnAsIfNeverLeft) {
    for (uint32_t seed = 20; seed < 20 + static_cast<uint32_t>(scaled(6, 2)); ++seed) {
        Telling plain(seed, {}, 1, 0, BroadPhaseType::wide_tree), back(seed, {}, 1, 0, BroadPhaseType::wide_tree);
        for (int step = 0; step < scaled(240, 80); ++step) {
            plain.story.go_on(plain.world, dt);
            back.story.go_on(back.world);
            if (step % 40 == 19) there_and_back(back.world, seed, step);
            back.world.update(dt).value();
            ASSERT_EQ(back.world.hash(), plain.world.hash()) << seed << " step " << step;
            if (step % 40 < 2) {
                ASSERT_EQ(back.world.snapshot(), plain.world.snapshot()) << seed << " step " << step;
            }
            if (step % 40 == 39) there_and_back(back.world, seed, step);
            if (HasFatalFailure()) return;
        }
    }
}

// Where nothing drives what has come together, its energy ends in friction. What was put into each other comes apart
// with 3 m/s and joints close gaps with 10 m/s, so that it may rise a little for a moment.
TEST(Stories, GainNothingByThemselves) {
    StoryCast cast;
    cast.kinematic = cast.driven = cast.extremes = cast.six_degrees = false;
    for (uint32_t seed = 0; seed < static_cast<uint32_t>(scaled(8, 2)); ++seed) {
        Telling telling(seed, cast, 1, 0, BroadPhaseType::wide_tree);
        World& world = telling.world;
        for (int step = 0; step < 150; ++step) telling.story.go_on(world, dt);
        run(world, 60);
        double least = world.kinetic_energy() + world.potential_energy();
        for (int step = 0; step < 240; ++step) {
            run(world, 1);
            const double energy = world.kinetic_energy() + world.potential_energy();
            ASSERT_LT(energy, 1.1 * least) << seed << " step " << step;
            least = std::min(least, energy);
        }
    }
}

}  // namespace
}  // namespace lendulet::test
