// The cuts of OMT: exact selection, parts of nearly equal count, and less overlap than chance.
#include "broad_phase/rtree/omt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

using Centres = std::vector<BoxCentre>;

Centres random_centres(int n, uint32_t seed, int distinct) {
    Random random(seed);
    Centres centres(static_cast<size_t>(n));
    for (size_t i = 0; i < centres.size(); ++i) {
        for (int32_t& at : centres[i].at) {
            float x = random.uniform(-10, 10);
            at = ordered(distinct ? std::floor(x * static_cast<float>(distinct)) : x);
        }
        centres[i].slot = static_cast<uint32_t>(i);
    }
    for (size_t i = centres.size(); i > 1; --i)
        std::swap(centres[i - 1], centres[static_cast<size_t>(random.below(i))]);
    return centres;
}

TEST(OmtTest, OrderedIntegersAreInTheOrderOfFloats) {
    const float rising[] = {-std::numeric_limits<float>::max(), -1e30f, -1, -1e-40f, 0, 1e-40f, 1, 1e30f};
    for (size_t i = 1; i < std::size(rising); ++i) EXPECT_LT(ordered(rising[i - 1]), ordered(rising[i]));
    for (float x : rising) EXPECT_EQ(from_ordered(ordered(x)), x);
    EXPECT_EQ(ordered(-0.0f), ordered(0.0f));
}

TEST(OmtTest, SelectsExactlyTheSmallest) {
    for (int n : {1, 2, 5, 24, 25, 33, 100, 255, 256, 1000, 5000}) {
        for (int distinct : {0, 1, 100}) {  // no ties; hardly anything but ties; some
            for (int wanted : {0, 1, n / 3, n / 2, n - 1, n}) {
                Centres centres = random_centres(n, static_cast<uint32_t>(n + wanted), distinct), sorted = centres;
                int axis = wanted % 3;
                auto before = [axis](const BoxCentre& a, const BoxCentre& b) {
                    return std::pair(a.at[axis], a.slot) < std::pair(b.at[axis], b.slot);
                };
                std::sort(sorted.begin(), sorted.end(), before);
                select_smallest(centres.data(), n, wanted, axis);
                std::sort(centres.begin(), centres.begin() + wanted, before);
                std::sort(centres.begin() + wanted, centres.end(), before);
                for (size_t i = 0; i < centres.size(); ++i) ASSERT_EQ(centres[i].slot, sorted[i].slot);
            }
        }
    }
}

TEST(OmtTest, PartsAreNearlyEqualSmallerFirst) {
    for (int count : {0, 1, 7, 8, 9, 100}) {
        for (int parts = 1; parts <= 8; ++parts) {
            EXPECT_EQ(part_begin(count, parts, 0), 0);
            EXPECT_EQ(part_begin(count, parts, parts), count);
            int last = 0;
            for (int k = 0; k < parts; ++k) {
                int size = part_begin(count, parts, k + 1) - part_begin(count, parts, k);
                EXPECT_GE(size, last);
                EXPECT_TRUE(size == count / parts || size == count / parts + 1);
                last = size;
            }
        }
    }
}

// Eight parts of a long block: 2 x 2 x 2 by the formula, each cut across what is then longest.
TEST(OmtTest, CutsEightPartsByThreeHalvings) {
    constexpr int n = 1001;
    Centres centres = random_centres(n, 3, 0);
    for (BoxCentre& c : centres)
        c.at[1] = ordered(1.9f * from_ordered(c.at[1])), c.at[2] = ordered(1.1f * from_ordered(c.at[2]));
    omt_divide(centres.data(), n, 8);
    auto extreme = [&](int first_part, int last_part, int axis, bool largest) {
        int32_t best = centres[static_cast<size_t>(part_begin(n, 8, first_part))].at[axis];
        for (int i = part_begin(n, 8, first_part); i < part_begin(n, 8, last_part); ++i) {
            int32_t at = centres[static_cast<size_t>(i)].at[axis];
            best = largest ? std::max(best, at) : std::min(best, at);
        }
        return best;
    };
    EXPECT_LT(extreme(0, 4, 1, true), extreme(4, 8, 1, false));  // y is longest
    for (int half : {0, 4}) {
        EXPECT_LT(extreme(half, half + 2, 2, true), extreme(half + 2, half + 4, 2, false));
        for (int quarter : {half, half + 2}) {
            EXPECT_LT(extreme(quarter, quarter + 1, 0, true), extreme(quarter + 1, quarter + 2, 0, false));
        }
    }
}

// Every fan-out keeps all boxes, whatever ties there are.
TEST(OmtTest, DivideIsAPermutation) {
    for (int fan_out = 1; fan_out <= 8; ++fan_out) {
        for (int n : {8, 9, 63, 500}) {
            Centres centres = random_centres(n, 6, fan_out % 2);
            omt_divide(centres.data(), n, fan_out);
            std::vector<bool> seen(static_cast<size_t>(n));
            for (const BoxCentre& c : centres) seen[c.slot] = true;
            EXPECT_EQ(std::count(seen.begin(), seen.end(), true), n);
        }
    }
}

TEST(NamesTest, EveryBroadPhaseHasItsName) {
    EXPECT_EQ(name_of(BroadPhaseType::all_pairs), "all-pairs");
    EXPECT_EQ(name_of(BroadPhaseType::sweep_1), "sweep-1");
    EXPECT_EQ(name_of(BroadPhaseType::rtree_omt), "rtree-omt");
    for (BroadPhaseType type : all_types) {
        auto parsed = broad_phase_from_name(name_of(type));
        ASSERT_TRUE(parsed.ok());
        EXPECT_EQ(parsed.value(), type);
    }
    auto refused = broad_phase_from_name("octree");
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::unknown_name);
    EXPECT_NE(refused.error().message.find("\"octree\""), std::string::npos);
    EXPECT_NE(refused.error().message.find("all-pairs, sweep-1, "), std::string::npos);
}

}  // namespace
