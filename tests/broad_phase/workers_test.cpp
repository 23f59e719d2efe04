// The list of pairs, not only the set, is the same for any number of workers.
#include <gtest/gtest.h>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

class WorkersTest : public testing::TestWithParam<BroadPhaseType> {};

// Two steps, a build and a refit, so that both share their work.
Pairs two_steps(BroadPhaseType type, TaskPool& tasks, TaskPool* shared, const Boxes& fixed, Boxes moving) {
    Memory memory;
    BroadPhase broad_phase(type, &memory);
    Array<BoxPair> out;
    broad_phase.set_fixed(fixed.data(), static_cast<int>(fixed.size()), shared);
    for (int step = 0; step < 2; ++step) {
        for (BroadBox& box : moving) {
            float by = 0.01f * static_cast<float>(box.index % 5);
            box.lower[0] += by;
            box.upper[0] += by;
        }
        broad_phase.set_moving(moving.data(), static_cast<int>(moving.size()), shared);
        broad_phase.find_pairs(tasks, out);
    }
    return as_written(out);
}

TEST_P(WorkersTest, SameOrderForAnyNumberOfWorkers) {
    int most = GetParam() == BroadPhaseType::all_pairs ? 2000 : 9000;  // 9000: more boxes than one building task takes
    for (int n : {100, 1000, most}) {
        for (const char* kind : {"uniform", "clustered", "ground"}) {
            Boxes fixed = make_boxes(kind, n / 2, 21, 100000), moving = make_boxes(kind, n, 22);
            moving[static_cast<size_t>(n / 3)].upper[1] = inf;
            fixed[5].lower[2] = -inf;
            TaskPool alone(1);
            Pairs expected = two_steps(GetParam(), alone, nullptr, fixed, moving);
            EXPECT_FALSE(expected.empty());
            for (int workers : {2, 4, 8}) {
                TaskPool tasks(workers);
                EXPECT_EQ(two_steps(GetParam(), tasks, &tasks, fixed, moving), expected) << kind << n << ' ' << workers;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(BroadPhase, WorkersTest, testing::ValuesIn(all_types));

}  // namespace
