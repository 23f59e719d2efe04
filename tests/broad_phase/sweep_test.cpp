// The parts of the sweeps: the order that is kept and the axis that is chosen.
#include <gtest/gtest.h>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

TEST(IntervalOrderTest, RepairedOrSortedItIsTheSame) {
    Memory memory;
    IntervalOrder kept(&memory);
    Random random(3);
    std::vector<float> x(700);
    for (float& at : x) at = random.uniform(-50, 50);
    for (int frame = 0; frame < 60; ++frame) {
        int one_in = frame % 10 == 9 ? 1 : 40;  // all of them, or a few
        for (float& at : x) {
            if (random.below(one_in) == 0) at = frame % 3 ? at + random.uniform(-1, 1) : random.uniform(-50, 50);
        }
        if (frame == 20) x.resize(300);
        if (frame == 40) x.resize(900, -0.0f);
        IntervalOrder fresh(&memory);
        auto coordinate = [&](uint32_t place) { return x[place]; };
        kept.sort(static_cast<int>(x.size()), coordinate);
        fresh.sort(static_cast<int>(x.size()), coordinate);
        ASSERT_TRUE(kept.sorted());
        ASSERT_EQ(kept.count(), static_cast<int>(x.size()));
        for (int i = 0; i < kept.count(); ++i) ASSERT_EQ(kept.place(i), fresh.place(i)) << "frame " << frame;
    }
}

TEST(IntervalOrderTest, TiesAreInTheOrderOfPlaces) {
    Memory memory;
    IntervalOrder order(&memory);
    order.sort(500, [](uint32_t place) { return place % 2 ? 0.0f : -0.0f; });
    for (int i = 0; i < 500; ++i) EXPECT_EQ(order.place(i), static_cast<uint32_t>(i));
}

TEST(Sweep1Test, TheAxisFollowsTheScene) {
    Memory memory;
    Sweep1 sweep(&memory);
    Boxes fixed = make_boxes("plane", 100, 1, 5000);
    sweep.set_fixed(fixed.data(), static_cast<int>(fixed.size()));
    for (const char* kind : {"line z", "line x", "line y", "line z"}) {
        Boxes boxes = make_boxes(kind, 200, 2);
        boxes[7].upper[0] = inf;
        sweep.set_moving(boxes.data(), static_cast<int>(boxes.size()));
        EXPECT_EQ(sweep.axis(), kind[5] - 'x');
        EXPECT_STREQ(sweep.check(), "");
    }
}

}  // namespace
