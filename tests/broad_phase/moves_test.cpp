// Boxes that move, jump, come and go from step to step: pairs stay exact, and a step in the steady state allocates
// nothing.
#include <gtest/gtest.h>

#include <thread>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

void move(BroadBox& box, std::array<float, 3> by) {
    for (int d = 0; d < 3; ++d) {
        box.lower[d] += by[static_cast<size_t>(d)];
        box.upper[d] += by[static_cast<size_t>(d)];
    }
}

class MovesTest : public testing::TestWithParam<BroadPhaseType> {};

TEST_P(MovesTest, DriftingAndJumpingBoxes) {
    TaskPool tasks(1);
    Memory memory;
    for (int n : {5, 60, 900}) {
        Random random(static_cast<uint32_t>(n));
        Boxes fixed = make_boxes("uniform", n / 3, 1, 10000), moving = make_boxes("uniform", n, 2);
        std::vector<std::array<float, 3>> velocity(moving.size());
        for (auto& v : velocity) v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        BroadPhase broad_phase(GetParam(), &memory);
        set_fixed(broad_phase, fixed);
        for (int frame = 0; frame < 100; ++frame) {
            for (size_t i = 0; i < moving.size(); ++i) {
                move(moving[i], {velocity[i][0] / 20, velocity[i][1] / 20, velocity[i][2] / 20});
            }
            if (frame % 7 == 0) move(moving[static_cast<size_t>(random.below(n))], {random.uniform(-9, 9), 3, -5});
            if (frame == 50) {  // all at once, to places that have nothing to do with the old ones
                for (BroadBox& box : moving) move(box, {random.uniform(-5, 5), random.uniform(-5, 5), 0});
            }
            set_moving(broad_phase, moving);
            ASSERT_EQ(found_pairs(broad_phase, tasks), expected_pairs(fixed, moving)) << n << " frame " << frame;
        }
    }
}

TEST_P(MovesTest, BoxesComeGoAndTurnInfinite) {
    TaskPool tasks(1);
    Memory memory;
    Random random(77);
    BroadPhase broad_phase(GetParam(), &memory);
    Boxes fixed = make_boxes("plane", 40, 1, 10000), moving;
    uint32_t next_index = 0;
    for (int frame = 0; frame < 300; ++frame) {
        switch (random.below(6)) {
            case 0:
                moving.push_back(make_boxes("uniform", 1, random.below(1000), next_index++)[0]);
                break;
            case 1:
                if (!moving.empty()) moving.erase(moving.begin() + random.below(static_cast<int>(moving.size())));
                break;
            case 2:  // as many boxes, but another one in this place
                if (!moving.empty()) moving.back() = make_boxes("ground", 3, 5, next_index++)[1], next_index += 3;
                break;
            case 3:
                if (!moving.empty()) moving[moving.size() / 2].upper[1] = frame % 2 ? inf : moving[0].upper[0] + 100;
                break;
            case 4:
                if (!moving.empty()) moving.front().lower[0] = moving.front().upper[0] = inf;
                break;
            default: {
                Boxes more = make_boxes("clustered", 30, static_cast<uint32_t>(frame), next_index);
                next_index += 30;
                if (moving.size() < 150) moving.insert(moving.end(), more.begin(), more.end());
                else moving.clear();
            }
        }
        if (frame % 20 == 0) {
            if (!fixed.empty()) fixed.pop_back();
            set_fixed(broad_phase, fixed);
        }
        set_moving(broad_phase, moving);
        ASSERT_EQ(found_pairs(broad_phase, tasks), expected_pairs(fixed, moving)) << "frame " << frame;
    }
}

TEST_P(MovesTest, TheSteadyStateAllocatesNothing) {
    struct Counter {
        int allocations = 0;
        size_t bytes = 0;
        std::thread::id stepping = std::this_thread::get_id();  // the only thread that may call the hook
    } counter;
    Memory memory{&counter,
                  [](void* user, size_t bytes, size_t) {
                      auto* counted = static_cast<Counter*>(user);
                      EXPECT_EQ(std::this_thread::get_id(), counted->stepping);
                      ++counted->allocations;
                      counted->bytes += bytes;
                      return Memory{}.allocate(bytes);
                  },
                  [](void* user, void* block, size_t bytes, size_t) {
                      static_cast<Counter*>(user)->bytes -= bytes;
                      Memory{}.free(block, bytes);
                  }};
    {
        TaskPool tasks(2);
        BroadPhase broad_phase(GetParam(), &memory);
        Array<BoxPair> out(&memory);
        Boxes fixed = make_boxes("plane", 300, 1, 10000), moving = make_boxes("uniform", 3000, 2);
        set_fixed(broad_phase, fixed);
        auto step = [&](float offset) {
            for (BroadBox& box : moving) move(box, {offset, 0, 0});
            broad_phase.set_moving(moving.data(), static_cast<int>(moving.size()), &tasks);
            out.clear();
            broad_phase.find_pairs(tasks, out);
        };
        for (float offset : {0.0f, 0.125f, -0.125f}) step(offset);
        int before = counter.allocations;
        EXPECT_GT(before, 0);
        EXPECT_EQ(broad_phase.bytes() + out.bytes(), counter.bytes);
        for (int i = 0; i < 100; ++i) step(i % 2 ? -0.125f : 0.125f);
        EXPECT_EQ(counter.allocations, before);
    }
    EXPECT_EQ(counter.bytes, 0u);
}

INSTANTIATE_TEST_SUITE_P(BroadPhase, MovesTest, testing::ValuesIn(all_types));

// Boxes that hardly move are refitted; boxes thrown into disorder are bulk-loaded again at once.
TEST(RtreeOmtTest, RefitsWhileTheTreeIsGood) {
    Memory memory;
    RtreeOmt tree(&memory);
    Boxes boxes = make_boxes("uniform", 2000, 4);
    auto set = [&] { tree.set_moving(boxes.data(), static_cast<int>(boxes.size())); };
    set();
    EXPECT_EQ(tree.moving().builds(), 1);
    for (int frame = 0; frame < 30; ++frame) {
        for (BroadBox& box : boxes) move(box, {0.01f, 0.02f, -0.01f});
        set();
    }
    EXPECT_EQ(tree.moving().builds(), 1);
    for (size_t i = 0; i < boxes.size(); i += 2) std::swap(boxes[i], boxes[(i * 37) % boxes.size()]);
    set();
    EXPECT_EQ(tree.moving().builds(), 2);
}

}  // namespace
