// The user's own threads give the same bits as the world's, however the loops are cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "base/tasks.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

using Run = void (*)(void* context, int begin, int end, int worker);

// A fork-join of std::threads over chunks of its own choice; counts what it was asked for.
struct Threads {
    int workers;
    int loops = 0;
    std::atomic<int> running{0}, overlapping{0};

    void parallel_for(int count, int grain, Run run, void* context) {
        ++loops;
        if (running.exchange(1)) ++overlapping;
        std::atomic<int> next{0};
        int chunk = loops % 3 ? grain : 2 * grain + 1;  // results may not depend on the cuts
        auto work = [&](int worker) {
            for (int begin = next.fetch_add(chunk); begin < count; begin = next.fetch_add(chunk))
                run(context, begin, begin + chunk < count ? begin + chunk : count, worker);
        };
        std::vector<std::thread> others;
        for (int i = 1; i < workers; ++i) others.emplace_back(work, i);
        work(0);
        for (std::thread& t : others) t.join();
        running = 0;
    }
    TaskHook hook() {
        return {this, workers, [](void* user, int count, int grain, Run run, void* context) {
                    static_cast<Threads*>(user)->parallel_for(count, grain, run, context);
                }};
    }
};

uint64_t story(const WorldBuilder& builder) {
    World world = builder.build().value();
    add_mixed_pile(world, 8);
    run(world, 40);
    return world.hash();
}

// Of loops that could have been shared.
TaskHook counter_of(int& loops) {
    return {&loops, 4, [](void* user, int count, int, Run run, void* context) {
                ++*static_cast<int*>(user);
                run(context, 0, count, 0);
            }};
}

// Small worlds are stepped by one thread, now and then by all: nothing tells.
TEST(Threads, WhoStepsASmallWorldDoesNotTell) {
    const uint64_t expected = story(WorldBuilder{});
    TaskPool::shares_all = false;
    EXPECT_EQ(story(WorldBuilder{}.workers(3)), expected);
    TaskPool::shares_all = true;
}

TEST(Threads, StepsThatTakeLittleAreNotShared) {
    int loops = 0;
    World world = WorldBuilder{}.sleep(false).tasks(counter_of(loops)).build().value();
    add_floor(world);
    for (int i = 0; i < 100; ++i)
        add_cube(world, 2.0f * static_cast<float>(i % 10), 0, 2.0f * static_cast<float>(i / 10));
    TaskPool::shares_all = false;
    double longest = 0.0;
    for (int step = 0; step < 200; ++step) {
        if (step == 70) loops = 0;
        run(world, 1);
        if (step > 60) longest = std::max(longest, world.statistics().total_ms);
    }
    const int shared = loops;
    TaskPool::shares_all = true;
    loops = 0;
    run(world, 1);
    EXPECT_GT(loops, 0) << "there is something to share";
    if (longest > 0.3) GTEST_SKIP() << "a step took " << longest << " ms here";
    EXPECT_EQ(shared, 0);
}

TEST(Threads, OwnWorkersAndTaskHookGiveOneHash) {
    uint64_t expected = story(WorldBuilder{});
    for (int workers : {2, 5}) EXPECT_EQ(story(WorldBuilder{}.workers(workers)), expected) << workers;
    for (int workers : {1, 2, 5}) {
        Threads threads{workers};
        EXPECT_EQ(story(WorldBuilder{}.tasks(threads.hook())), expected) << workers << " of the user's threads";
        EXPECT_EQ(threads.overlapping.load(), 0);
        if (workers > 1) {
            EXPECT_GT(threads.loops, 40 * 3) << "the hook must have been used";
        }
    }
}

TEST(Threads, WorldsOnDifferentThreadsShareNothing) {
    uint64_t expected = story(WorldBuilder{}), found[2] = {};
    std::thread other([&] { found[0] = story(WorldBuilder{}); });
    found[1] = story(WorldBuilder{});
    other.join();
    EXPECT_EQ(found[0], expected);
    EXPECT_EQ(found[1], expected);
}

int points_of(const World& world) {
    int points = 0;
    for (int c = 0; c < world.contact_count(); ++c) points += world.contact(c).point_count;
    return points;
}

// Const calls may run at the same time between steps.
TEST(Threads, ReadersAgree) {
    World world = WorldBuilder{}.build().value();
    add_mixed_pile(world, 4);
    run(world, 30);
    uint64_t hash = world.hash();
    double energy = world.kinetic_energy();
    const int points = points_of(world);
    std::atomic<int> wrong{0};
    std::vector<std::thread> readers;
    for (int i = 0; i < 3; ++i)
        readers.emplace_back([&] {
            ColliderId found[64];
            for (int k = 0; k < 20; ++k) {
                wrong += world.hash() != hash || world.kinetic_energy() != energy || !world.check().empty();
                wrong += world.query_boxes({{-9.0f, -9.0f, -9.0f}, {9.0f, 9.0f, 9.0f}}, found, 64) < 64;
                wrong += points_of(world) != points;
            }
        });
    for (std::thread& t : readers) t.join();
    EXPECT_EQ(wrong.load(), 0);
}

}  // namespace
}  // namespace lendulet::test
