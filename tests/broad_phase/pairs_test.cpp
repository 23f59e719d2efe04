// The pairs of every broad phase are exactly those of brute force.
#include <gtest/gtest.h>

#include <cmath>

#include "broad_phase/support.h"
#include "scale.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

// All boxes moving, and again every third of them fixed.
void check(const Boxes& boxes, const std::string& what) {
    TaskPool tasks(1);
    Memory memory;
    for (size_t split : {boxes.size() + 1, size_t{3}}) {
        Boxes fixed, moving;
        for (size_t i = 0; i < boxes.size(); ++i) ((i + 1) % split == 0 ? fixed : moving).push_back(boxes[i]);
        Pairs expected = expected_pairs(fixed, moving);
        for (BroadPhaseType type : all_types) {
            BroadPhase broad_phase(type, &memory);
            set_fixed(broad_phase, fixed);
            set_moving(broad_phase, moving);
            ASSERT_EQ(found_pairs(broad_phase, tasks), expected) << what << ", split " << split << name_of(type);
            ASSERT_STREQ(broad_phase.check(), "") << what << name_of(type);
        }
    }
}

TEST(PairsTest, EveryDistributionAndCount) {
    for (const std::string& kind : distributions) {
        for (int n : {0, 1, 2, 3, 7, 8, 9, 10, 31, 32, 33, 63, 64, 65, 100, 257, 513, 700}) {
            check(make_boxes(kind, n, static_cast<uint32_t>(n)), kind + " " + std::to_string(n));
        }
    }
}

TEST(PairsTest, ThousandsOfBoxes) {
    for (const char* kind : {"uniform", "clustered", "line y", "ground", "sizes", "plane"}) {
        check(make_boxes(kind, 4200, 5), kind);
    }
}

TEST(PairsTest, TenThousandBoxesOnOneHugeGround) { check(make_boxes("ground", 10001, 8), "ground"); }

TEST(PairsTest, TwentyThousandBoxes) {
    TaskPool tasks(1);
    Memory memory;
    Boxes boxes = make_boxes("uniform", 20000, 11);
    Pairs expected = expected_pairs({}, boxes);
    for (BroadPhaseType type : all_types) {
        BroadPhase broad_phase(type, &memory);
        set_moving(broad_phase, boxes);
        EXPECT_EQ(found_pairs(broad_phase, tasks), expected) << name_of(type);
    }
}

TEST(PairsTest, AThousandSeeds) {
    for (int seed = 0; seed < scaled(1000, 20); ++seed) {
        Random random(static_cast<uint32_t>(seed) + 1000);
        int root = random.below(33);
        const std::string& kind = distributions[static_cast<size_t>(seed) % distributions.size()];
        bool dense = kind == "one point" || kind == "nested";  // all boxes overlap
        check(make_boxes(kind, dense ? root * 3 : root * root * 1000 / 1024, static_cast<uint32_t>(seed)), kind);
        if (HasFatalFailure()) return;
    }
}

TEST(PairsTest, TheSweepOfTheTestsIsItselfExact) {
    for (const std::string& kind : distributions) {
        bool dense = kind == "one point" || kind == "nested";
        Boxes boxes = make_boxes(kind, dense ? 300 : 3000, 77);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(pairs_by_sweep(boxes, axis), expected_pairs({}, boxes)) << kind;
        }
    }
    Boxes boxes = make_boxes("uniform", scaled(20000, 2000), 78);
    EXPECT_EQ(pairs_by_sweep(boxes, 0), expected_pairs({}, boxes));
}

// The structures whose time grows with the square of the count are left out, but for one run of the faster one.
TEST(PairsTest, TenSeedsOfAHundredThousandBoxes) {
    TaskPool tasks(1);
    Memory memory;
    const char* kinds[] = {"uniform", "ground", "line x", "line y", "line z"};
    for (int seed = 0; seed < scaled(10, 2); ++seed) {
        const std::string kind = kinds[seed % 5];
        Boxes boxes = make_boxes(kind, scaled(100000), static_cast<uint32_t>(seed) + 40);
        Pairs expected = pairs_by_sweep(boxes, kind == "line y" ? 1 : kind == "line z" ? 2 : 0);
        for (BroadPhaseType type : all_types) {
            if (type == BroadPhaseType::all_pairs || (type == BroadPhaseType::sweep_3 && seed > 0)) continue;
            BroadPhase broad_phase(type, &memory);
            set_moving(broad_phase, boxes);
            ASSERT_EQ(found_pairs(broad_phase, tasks), expected) << kind << ' ' << name_of(type);
        }
    }
}

// Corners on a coarse grid: most faces touch or coincide, many boxes are flat, points, or equal; some are infinite.
TEST(PairsTest, GridsWithTouchingFlatAndInfiniteBoxes) {
    for (uint32_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        Boxes boxes;
        int n = random.below(120), infinite = seed % 3 == 0 ? 12 : 1 << 20;
        for (int i = 0; i < n; ++i) {
            BroadBox box = make_box({}, {}, static_cast<uint32_t>(i));
            for (int d = 0; d < 3; ++d) {
                box.lower[d] = static_cast<float>(random.below(6)) - 2;
                box.upper[d] = box.lower[d] + static_cast<float>(random.below(3));
                if (box.lower[d] == 0 && random.below(2)) box.lower[d] = -0.0f;
                if (box.upper[d] == 0 && random.below(2)) box.upper[d] = -0.0f;
                if (random.below(infinite) == 0) box.lower[d] = -inf;
                if (random.below(infinite) == 0) box.upper[d] = inf;
            }
            boxes.push_back(box);
        }
        check(boxes, "grid " + std::to_string(seed));
    }
}

// A box without any end overlaps even what stands in the lanes of a block that hold no box.
TEST(PairsTest, ABoxWithoutAnyEndMeetsBoxesAlone) {
    for (int n = 1; n <= 24; ++n) {
        Boxes boxes;
        for (int i = 0; i < n; ++i) {
            BroadBox box = make_box({}, {}, static_cast<uint32_t>(i));
            for (int d = 0; d < 3; ++d) {
                box.lower[d] = i == n / 2 ? -inf : 3.0f * static_cast<float>(i);
                box.upper[d] = i == n / 2 ? inf : box.lower[d] + 1.0f;
            }
            boxes.push_back(box);
        }
        check(boxes, std::to_string(n) + " boxes");
    }
}

TEST(PairsTest, HugeAndInfiniteBoxes) {
    constexpr float most = std::numeric_limits<float>::max();
    Boxes boxes;
    auto add = [&](std::array<float, 3> lower, std::array<float, 3> upper) {
        boxes.push_back(make_box(lower, upper, static_cast<uint32_t>(boxes.size())));
    };
    add({-inf, -inf, -inf}, {inf, inf, inf});
    add({-inf, -inf, -inf}, {inf, 0, inf});
    add({-inf, 0, -inf}, {inf, inf, inf});
    add({inf, inf, inf}, {inf, inf, inf});
    add({-inf, 0, 0}, {-inf, 1, 1});
    add({-most, -most, -most}, {most, most, most});
    add({most, most, most}, {most, most, most});
    add({0.9f * most, 0, 0}, {most, 1, 1});
    add({-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f});
    add({1e30f, 1e30f, 1e30f}, {2e30f, 2e30f, 2e30f});
    add({0, 0, 0}, {0, 0, 0});
    check(boxes, "huge alone");
    Boxes small = make_boxes("uniform", 200, 3, static_cast<uint32_t>(boxes.size()));
    boxes.insert(boxes.end(), small.begin(), small.end());
    check(boxes, "huge among small");
}

TEST(PairsTest, TouchingFacesCountAndTheNextFloatDoesNot) {
    float beyond = std::nextafter(1.0f, 2.0f);
    check({make_box({0, 0, 0}, {1, 1, 1}, 0), make_box({1, 0, 0}, {2, 1, 1}, 1), make_box({beyond, 0, 0}, {2, 1, 1}, 2),
           make_box({0, 0, -1}, {0, 0, -0.0f}, 3)},
          "touching");
}

// The caller's indices may be in any order and have gaps.
TEST(PairsTest, IndicesAreTheCallers) {
    Boxes boxes = make_boxes("uniform", 300, 9);
    for (size_t i = 0; i < boxes.size(); ++i) boxes[i].index = static_cast<uint32_t>((i * 7919) % 100003);
    check(boxes, "scattered indices");
}

}  // namespace
