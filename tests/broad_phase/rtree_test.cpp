// The parts of the R-tree family: splits, choices, tiles, and what removal leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "broad_phase/rtree/str.h"
#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

using Split = uint32_t (*)(const RtreeEntry*);
constexpr Split splits[] = {split_quadratic, split_star};

void fill_entries(RtreeEntry entries[split_count], const Boxes& boxes) {
    for (int i = 0; i < split_count; ++i) {
        const BroadBox& box = boxes[static_cast<size_t>(i)];
        for (int d = 0; d < 3; ++d) {
            entries[i].lower[d] = box.lower[d];
            entries[i].upper[d] = box.upper[d];
        }
    }
}

TEST(RtreeSplitTest, BothGroupsAreFullEnough) {
    for (const std::string& kind : distributions) {
        for (uint32_t seed = 0; seed < 100; ++seed) {
            RtreeEntry entries[split_count];
            fill_entries(entries, make_boxes(kind, split_count, seed));
            for (Split split : splits) {
                int second = __builtin_popcount(split(entries));
                EXPECT_GE(second, least_entries);
                EXPECT_LE(second, split_count - least_entries);
            }
        }
    }
}

// Two clumps far apart are told apart on whatever axis they lie.
TEST(RtreeSplitTest, ClumpsAreSeparated) {
    for (int axis = 0; axis < 3; ++axis) {
        for (int size = least_entries; size <= split_count - least_entries; ++size) {
            Boxes boxes = make_boxes("uniform", split_count, static_cast<uint32_t>(size));
            for (int i = 0; i < size; ++i) {
                boxes[static_cast<size_t>(i)].lower[axis] += 100;
                boxes[static_cast<size_t>(i)].upper[axis] += 100;
            }
            RtreeEntry entries[split_count];
            fill_entries(entries, boxes);
            for (Split split : splits) {
                uint32_t second = split(entries), clump = (1u << size) - 1, all = (1u << split_count) - 1;
                EXPECT_TRUE(second == clump || second == (all & ~clump)) << axis << ' ' << size;
            }
        }
    }
}

TEST(RtreeSplitTest, TheChildThatHoldsTheBoxIsChosen) {
    BoxBlock block;
    for (int k = 0; k < block_size; ++k) clear_lane(block, k);
    const float at[3] = {0, 10, 20};
    for (int k = 0; k < 3; ++k) {
        float lower[3] = {at[k], 0, 0}, upper[3] = {at[k] + 5, 5, 5};
        set_lane(block, k, lower, upper);
    }
    float lower[3] = {11, 1, 1}, upper[3] = {12, 2, 2}, near_last[3] = {18, 1, 1}, flat[3] = {18, 2, 2};
    for (auto* choose : {choose_least_growth, choose_least_overlap}) {
        EXPECT_EQ(choose(block, 3, lower, upper), 1);
        EXPECT_EQ(choose(block, 3, near_last, flat), 2);
    }
}

TEST(StrTest, TilesAreAPermutationInRunsOfEight) {
    for (int n : {1, 8, 9, 64, 100, 1000}) {
        Random random(static_cast<uint32_t>(n));
        std::vector<BoxCentre> centres(static_cast<size_t>(n));
        for (size_t i = 0; i < centres.size(); ++i) {
            for (int32_t& at : centres[i].at) at = random.below(1000);
            centres[i].slot = static_cast<uint32_t>(i);
        }
        str_tile(centres.data(), n);
        std::vector<int> seen(centres.size(), 0);
        for (const BoxCentre& c : centres) ++seen[c.slot];
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), n);
        // 125 nodes are five slabs of 25, each of five bars of 5 along y: the slabs do not overlap.
        if (n != 1000) continue;
        for (size_t slab = 1; slab < 5; ++slab) {
            auto begin = centres.begin() + static_cast<std::ptrdiff_t>(slab * 200);
            auto by_x = [](const BoxCentre& a, const BoxCentre& b) { return a.at[0] < b.at[0]; };
            EXPECT_LE(std::max_element(begin - 200, begin, by_x)->at[0],
                      std::min_element(begin, begin + 200, by_x)->at[0]);
        }
    }
}

class RtreeTest : public testing::TestWithParam<RtreePolicy> {};
INSTANTIATE_TEST_SUITE_P(All, RtreeTest, testing::Values(RtreePolicy::quadratic, RtreePolicy::star, RtreePolicy::str));

// Down to nothing and up again, one box at a time, last ones first and with holes.
TEST_P(RtreeTest, ShrinksToNothingAndGrowsAgain) {
    Memory memory;
    TaskPool tasks(1);
    RTree tree(&memory, GetParam());
    Boxes boxes = make_boxes("uniform", 600, 3);
    boxes[40].lower[2] = -inf;
    tree.build(boxes.data(), static_cast<int>(boxes.size()), nullptr);
    ASSERT_STREQ(tree.check(), "");
    int levels = tree.levels();
    EXPECT_LE(levels, 7);
    Random random(4);
    while (!boxes.empty()) {
        uint32_t place = static_cast<uint32_t>(random.below(static_cast<int>(boxes.size())));
        boxes[place] = boxes.back();
        boxes.pop_back();
        int changed = place < boxes.size() ? 1 : 0;
        tree.change({boxes.data(), static_cast<int>(boxes.size()), &place, changed}, tasks);
        ASSERT_STREQ(tree.check(), "") << boxes.size();
    }
    EXPECT_TRUE(tree.empty());
    EXPECT_EQ(tree.levels(), 2);
    for (const BroadBox& box : make_boxes("clustered", 600, 5)) {
        boxes.push_back(box);
        tree.change({boxes.data(), static_cast<int>(boxes.size()), nullptr, 0}, tasks);
        ASSERT_STREQ(tree.check(), "") << boxes.size();
    }
    EXPECT_LE(tree.levels(), 7);
}

// What the papers promise of their trees, and the reason for the family: less surface for the same boxes.
TEST(RtreeFamilyTest, BetterAlgorithmsMakeBetterTrees) {
    Memory memory;
    Boxes boxes = make_boxes("uniform", 5000, 6);
    auto cost = [&](BroadPhaseType type) {
        BroadPhase broad_phase(type, &memory);
        set_moving(broad_phase, boxes);
        Array<BroadPhaseBox> drawn;
        broad_phase.boxes(drawn);
        float sum = 0;
        for (const BroadPhaseBox& b : drawn) {
            float x = b.upper[0] - b.lower[0], y = b.upper[1] - b.lower[1], z = b.upper[2] - b.lower[2];
            if (!b.leaf) sum += x * y + y * z + z * x;
        }
        return sum;
    };
    float quadratic = cost(BroadPhaseType::rtree_quadratic);
    EXPECT_LT(cost(BroadPhaseType::rtree_star), 0.9f * quadratic);
    EXPECT_LT(cost(BroadPhaseType::rtree_str), 0.9f * quadratic);
    EXPECT_LT(cost(BroadPhaseType::rtree_omt), 0.9f * quadratic);
}

}  // namespace
