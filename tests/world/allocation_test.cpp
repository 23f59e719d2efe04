// Memory: everything comes through the hook, a busy world's step takes none, and a dead world has given all back.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "world/support.h"

namespace {

std::atomic<long> heap_calls{0};  // of operator new, by anyone in this program

void* from_heap(std::size_t bytes) {
    heap_calls.fetch_add(1, std::memory_order_relaxed);
    if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
    std::abort();
}

}  // namespace

// Counts what goes past the hook as well. Where GCC sees one of the two inlined and the other not it takes them for a
// mismatch.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t bytes) { return from_heap(bytes); }
void* operator new[](std::size_t bytes) { return from_heap(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace lendulet::test {
namespace {

struct Counter {
    std::atomic<long> allocations{0}, frees{0}, live_bytes{0}, misaligned{0}, largest{0};  // `largest`: at once
    std::atomic<long> strange{0};                                                          // by other threads
    std::thread::id stepping = std::this_thread::get_id();

    AllocatorHook hook() {
        return {this,
                [](void* user, size_t bytes, size_t alignment) {
                    Counter& c = *static_cast<Counter*>(user);
                    c.allocations.fetch_add(1);
                    if (std::this_thread::get_id() != c.stepping) c.strange.fetch_add(1);
                    c.live_bytes.fetch_add(static_cast<long>(bytes));
                    c.largest = std::max(c.largest.load(), static_cast<long>(bytes));
                    size_t rounded = (bytes + alignment - 1) / alignment * alignment;
                    return std::aligned_alloc(alignment, rounded);
                },
                [](void* user, void* memory, size_t bytes, size_t alignment) {
                    Counter& c = *static_cast<Counter*>(user);
                    c.frees.fetch_add(1);
                    c.live_bytes.fetch_sub(static_cast<long>(bytes));
                    if (reinterpret_cast<uintptr_t>(memory) % alignment) c.misaligned.fetch_add(1);
                    std::free(memory);
                }};
    }
};

class Allocation : public ::testing::TestWithParam<int> {};

TEST_P(Allocation, SettledPileTakesNoMemory) {
    Counter counter;
    {
        World world = WorldBuilder{}.sleep(false).workers(GetParam()).allocator(counter.hook()).build().value();
        add_mixed_pile(world, 5);
        run(world, 900);  // until the pile lies: the last ball rolls for a quarter of a minute
        ASSERT_GT(world.statistics().contact_points, 100);
        ASSERT_GT(world.statistics().joints, 3);
        EXPECT_GT(counter.allocations.load(), 10);
        long hooked = counter.allocations.load(), heap = heap_calls.load();
        for (int i = 0; i < 60; ++i) {
            Status status = world.update(dt);
            if (!status) break;  // without a message being built while we count
        }
        EXPECT_EQ(heap_calls.load(), heap) << "operator new was called in a step";
        EXPECT_EQ(counter.allocations.load(), hooked) << "the hook was asked for memory in a step";
        EXPECT_EQ(world.step_count(), 960u);
        EXPECT_GT(counter.live_bytes.load(), 0);
    }
    EXPECT_EQ(counter.allocations.load(), counter.frees.load());
    EXPECT_EQ(counter.live_bytes.load(), 0);
    EXPECT_EQ(counter.misaligned.load(), 0);
}
INSTANTIATE_TEST_SUITE_P(Workers, Allocation, ::testing::Values(1, 2));

// Sleeping, waking, and falling asleep again reuse what is there.
TEST(AllocationAfterWarmUp, SleepAndWakeTakeNoMemory) {
    Counter counter;
    World world = WorldBuilder{}.allocator(counter.hook()).build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 4);
    run(world, 200);
    long hooked = counter.allocations.load(), heap = heap_calls.load();
    for (int round = 0; round < 3; ++round) {
        Status pushed = world.get(stack[0]).apply_impulse({10.0f, 0.0f, 0.0f});
        for (int i = 0; i < 60 && pushed; ++i) pushed = world.update(dt);
    }
    EXPECT_EQ(heap_calls.load(), heap);
    EXPECT_EQ(counter.allocations.load(), hooked);
    EXPECT_EQ(world.step_count(), 380u);
}

TEST(AllocationAfterWarmUp, RemovedBodiesMakeRoomForNewOnes) {
    Counter counter;
    World world = WorldBuilder{}.kept_removed(12).allocator(counter.hook()).build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 8);
    run(world, 60);
    auto rebuild = [&] {
        for (BodyId id : stack) world.remove_body(id).value();
        stack = add_stack(world, 0.0f, 8);
        run(world, 60);
    };
    for (int round = 0; round < 4; ++round) rebuild();  // until as many are remembered as may be
    long hooked = counter.allocations.load();
    for (int round = 0; round < 20; ++round) rebuild();
    EXPECT_EQ(counter.allocations.load(), hooked);
}

// The walls of bricks that two runs build, one of them with room taken ahead.
World bricks(Counter& counter, bool ahead) {
    World world = WorldBuilder{}.sleep(false).allocator(counter.hook()).build().value();
    if (ahead) world.reserve({.bodies = 400, .contacts = 2400}).value();
    add_floor(world);
    for (int i = 0; i < 400; ++i)
        world
            .add_rigid_body(
                {.shape = Box{{0.5f, 0.25f, 0.25f}},
                 .position = {1.02f * static_cast<float>(i % 20), 0.25f + 0.5f * static_cast<float>(i / 20), 0.0f}})
            .value();
    return world;
}

TEST(Reserve, FirstStepsTakeLittleMemory) {
    Counter plain, ahead;
    World without = bricks(plain, false), with = bricks(ahead, true);
    const long before = plain.live_bytes.load(), reserved = ahead.live_bytes.load();
    run(without, 3);
    run(with, 3);
    EXPECT_EQ(with.hash(), without.hash());
    const long taken = ahead.live_bytes.load() - reserved;  // for scratch, and the islands that take more substeps
    EXPECT_LT(taken, (plain.live_bytes.load() - before) / 3);
}

TEST(Reserve, ABusyWorldLosesNothing) {
    Counter counter;
    World world = bricks(counter, false), same = bricks(counter, false);
    run(world, 5);
    run(same, 5);
    world.reserve({.bodies = 1000, .contacts = 5000, .joints = 10}).value();
    EXPECT_EQ(world.hash(), same.hash());
    run(world, 5);
    run(same, 5);
    EXPECT_EQ(world.hash(), same.hash());
    EXPECT_EQ(world.check(), "");
}

TEST(Reserve, RefusesCountsThatCannotBe) {
    World world = WorldBuilder{}.build().value();
    for (const Capacity& wrong : {Capacity{.bodies = -1}, Capacity{.contacts = -5}, Capacity{.joints = 1 << 25},
                                  Capacity{.bodies = 2147483647}}) {
        const Status refused = world.reserve(wrong);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_config);
        EXPECT_NE(refused.error().message.find("reserve"), std::string::npos);
    }
    EXPECT_TRUE(world.reserve({}));
}

// Balls that come together in a heap, from far enough to touch nothing at first.
World falling_balls(Counter& counter, const Capacity& room) {
    World world = WorldBuilder{}.sleep(false).allocator(counter.hook()).build().value();
    world.reserve(room).value();
    add_floor(world);
    for (int i = 0; i < 800; ++i)
        world
            .add_rigid_body({.shape = Sphere{0.25f},
                             .position = {0.6f * static_cast<float>(i % 10) + (i / 100 % 2 ? 0.25f : 0.0f),
                                          1.0f + 0.6f * static_cast<float>(i / 100),
                                          0.6f * static_cast<float>(i / 10 % 10) + (i / 100 % 2 ? 0.2f : 0.0f)}})
            .value();
    run(world, 1);
    return world;
}

// A heap that comes together finds its room: no array with an entry for each contact is copied into a larger one.
TEST(Reserve, AHeapFindsItsRoom) {
    Counter counter;
    World world = falling_balls(counter, {.bodies = 800});
    counter.largest = 0;
    run(world, 120);
    ASSERT_GT(world.statistics().manifolds, 1200);
    EXPECT_LT(counter.largest.load(), 64 * 1024);
}

// Who says how many contacts there will be is given room for those, and more when more come.
TEST(Reserve, TakesACountOfContactsAtItsWord) {
    Counter expecting, told;
    World open = falling_balls(expecting, {.bodies = 800}),
          exact = falling_balls(told, {.bodies = 800, .contacts = 100});
    EXPECT_LT(told.live_bytes.load() + 4'000'000, expecting.live_bytes.load());
    told.largest = 0;
    run(open, 120);
    run(exact, 120);
    EXPECT_GT(told.largest.load(), 64 * 1024);
    EXPECT_EQ(exact.hash(), open.hash());
}

// Fast balls fly through a hundred boxes each: what is near their ways is listed by several threads.
TEST(AllocatorHooks, AreCalledByTheSteppingThreadAlone) {
    Counter counter;
    World world = WorldBuilder{}.gravity({0, 0, 0}).workers(4).allocator(counter.hook()).build().value();
    for (int x = 0; x < 30; ++x)
        for (int y = 0; y < 30; ++y)
            ASSERT_TRUE(world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}, .position = Position(x, y, 0)}));
    for (int i = 0; i < 200; ++i)
        ASSERT_TRUE(world.add_rigid_body({.shape = Sphere{0.05f},
                                          .position = Position(-1.0f, 0.1f * static_cast<float>(i) + 0.5f, 0.5f),
                                          .velocity = {900.0f, 300.0f, 0}}));
    run(world, 4);
    EXPECT_GT(counter.allocations.load(), 10);
    EXPECT_EQ(counter.strange.load(), 0);
}

TEST(AllocatorHooks, NeedBothFunctions) {
    Counter counter;
    AllocatorHook half = counter.hook();
    half.free = nullptr;
    Result<World> world = WorldBuilder{}.allocator(half).build();
    ASSERT_FALSE(world);
    EXPECT_EQ(world.error().code, ErrorCode::bad_config);
}

}  // namespace
}  // namespace lendulet::test
