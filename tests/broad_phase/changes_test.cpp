// update(): the pairs it says begin and end are the difference of all pairs before and after.
#include <gtest/gtest.h>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

class ChangesTest : public testing::TestWithParam<BroadPhaseType> {
protected:
    // Brings the structure to `next` and compares; `extra` says that changed places are also listed where nothing
    // changed.
    void check_update(const Boxes& next, const std::string& what) {
        std::vector<uint32_t> changed;
        size_t common = std::min(moving_.size(), next.size());
        for (size_t i = 0; i < common; ++i) {
            if (std::memcmp(&moving_[i], &next[i], sizeof(BroadBox)) != 0) changed.push_back(static_cast<uint32_t>(i));
        }
        Array<BoxPair> begun, ended;
        broad_phase_.update(tasks_, next.data(), static_cast<int>(next.size()), changed.data(),
                            static_cast<int>(changed.size()), begun, ended);
        Pairs after = expected_pairs(fixed_, next), expected_begun, expected_ended;
        std::set_difference(after.begin(), after.end(), pairs_.begin(), pairs_.end(),
                            std::back_inserter(expected_begun));
        std::set_difference(pairs_.begin(), pairs_.end(), after.begin(), after.end(),
                            std::back_inserter(expected_ended));
        ASSERT_EQ(as_written(begun), expected_begun) << what;
        ASSERT_EQ(as_written(ended), expected_ended) << what;
        ASSERT_STREQ(broad_phase_.check(), "") << what;
        moving_ = next;
        pairs_ = after;
    }
    void start(const Boxes& fixed, const Boxes& moving) {
        fixed_ = fixed;
        moving_ = moving;
        set_fixed(broad_phase_, fixed_);
        set_moving(broad_phase_, moving_);
        pairs_ = expected_pairs(fixed_, moving_);
    }

    Memory memory_;
    TaskPool tasks_{2};
    BroadPhase broad_phase_{GetParam(), &memory_};
    Boxes fixed_, moving_;
    Pairs pairs_;
};

TEST_P(ChangesTest, FewAndManyMoveComeAndGo) {
    for (int n : {0, 3, 20, 400}) {
        Random random(static_cast<uint32_t>(n));
        start(make_boxes("plane", n / 3, 1, 100000), make_boxes("uniform", n, 2));
        uint32_t next_index = 5000;
        for (int frame = 0; frame < 60; ++frame) {
            Boxes next = moving_;
            int one_in = frame % 3 == 0 ? 2 : 50;
            for (BroadBox& box : next) {
                if (random.below(one_in)) continue;
                box = box_around({random.uniform(0, 10), random.uniform(0, 10), random.uniform(0, 10)},
                                 {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)}, box.index);
                if (random.below(20) == 0) box.upper[random.below(3)] = inf;
            }
            for (int removed = random.below(frame % 4 == 0 ? 30 : 3); removed > 0 && !next.empty(); --removed) {
                next[static_cast<size_t>(random.below(static_cast<int>(next.size())))] = next.back();
                next.pop_back();
            }
            for (int added = random.below(frame % 4 == 2 ? 30 : 3); added > 0; --added) {
                next.push_back(make_boxes("uniform", 1, next_index, next_index)[0]);
                ++next_index;
            }
            check_update(next, std::to_string(n) + " frame " + std::to_string(frame));
        }
    }
}

TEST_P(ChangesTest, ABoxThatOnlyChangesItsPlaceChangesNoPair) {
    start({}, make_boxes("uniform", 200, 3));
    Boxes next = moving_;
    std::swap(next[5], next[70]);
    std::rotate(next.begin() + 100, next.begin() + 101, next.begin() + 120);
    check_update(next, "changed places");
    std::reverse(next.begin(), next.end());
    check_update(next, "reversed");
}

TEST_P(ChangesTest, TheCallerMayOverwriteHisBoxes) {
    Boxes boxes = make_boxes("uniform", 300, 4), fixed = make_boxes("uniform", 100, 5, 1000);
    start(fixed, boxes);
    Boxes scratch = boxes;
    broad_phase_.set_moving(scratch.data(), static_cast<int>(scratch.size()));
    std::fill(scratch.begin(), scratch.end(), make_box({}, {}, 7));
    EXPECT_EQ(found_pairs(broad_phase_, tasks_), pairs_);
    for (BroadBox& box : boxes)
        box = box_around({0.02f * static_cast<float>(box.index), 0, 0}, {1, 0.1f, 5}, box.index);
    check_update(boxes, "along another axis");
}

INSTANTIATE_TEST_SUITE_P(BroadPhase, ChangesTest, testing::ValuesIn(all_types));

}  // namespace
