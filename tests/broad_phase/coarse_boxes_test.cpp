// The bytes that stand for the sides of boxes: they keep order wherever a box lies, so that no pair is lost, and are
// fine enough to be of use.
#include "broad_phase/wide_tree/coarse_boxes.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "broad_phase/support.h"
#include "broad_phase/wide_tree/wide_tree.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

Bounds6 bounds_of(const Boxes& boxes) {
    Bounds6 bounds{{inf, inf, inf, -inf, -inf, -inf}};
    for (const BroadBox& box : boxes) {
        for (int d = 0; d < 3; ++d) {
            bounds.at[d] = std::min(bounds.at[d], box.lower[d]);
            bounds.at[3 + d] = std::max(bounds.at[3 + d], box.upper[d]);
        }
    }
    return bounds;
}

int step_of(const CoarseBoxes& frame, float x) { return steps_of(frame, make_box({x, x, x}, {x, x, x}, 0))[0]; }

TEST(CoarseBoxesTest, StepsNeverFallAsTheirNumberGrows) {
    const Bounds6 frames[] = {
        {{-1, -1, -1, 1, 1, 1}},
        {{0, 0, 0, 7, 7, 7}},
        {{1e6f, 1e6f, 1e6f, 1e6f + 8, 1e6f + 8, 1e6f + 8}},
        {{5, 5, 5, 5, 5, 5}},                                                  // no extent
        {{0, 0, 0, 1e-44f, 1e-44f, 1e-44f}},                                   // denormal
        {{-FLT_MAX, -FLT_MAX, -FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX}},           // its extent overflows
        {{FLT_MAX / 2, FLT_MAX / 2, FLT_MAX / 2, FLT_MAX, FLT_MAX, FLT_MAX}},  //
        {{inf, inf, inf, -inf, -inf, -inf}},                                   // of no boxes
    };
    for (const Bounds6& bounds : frames) {
        CoarseBoxes frame;
        set_frame(frame, bounds);
        std::vector<float> at = {-inf, -FLT_MAX, -1, -1e-45f, 0, 1e-45f, 1, FLT_MAX, inf};
        Random random(7);
        for (int i = 0; i < 3000; ++i) {
            const float exponent = random.uniform(-140, 128), x = std::exp2(exponent);
            at.push_back(random.below(2) ? x : -x);
            const float inside = bounds.at[0] + random.uniform(-0.5f, 1.5f) * (bounds.at[3] - bounds.at[0]);
            if (!std::isfinite(inside)) continue;
            at.push_back(inside);
            at.push_back(std::nextafter(inside, inf));
        }
        std::sort(at.begin(), at.end());
        for (size_t i = 1; i < at.size(); ++i) {
            ASSERT_LE(step_of(frame, at[i - 1]), step_of(frame, at[i])) << at[i - 1] << ' ' << at[i];
        }
        EXPECT_GE(step_of(frame, -inf), -128);
        EXPECT_LE(step_of(frame, inf), 126);  // 127 and -128 are an empty lane's, which nothing may overlap
    }
}

TEST(CoarseBoxesTest, FewThatAreApartShareSteps) {
    const Boxes boxes = make_boxes("uniform", 64, 3);
    CoarseBoxes group;
    set_frame(group, bounds_of(boxes));
    for (uint32_t i = 0; i < 64; ++i) set_steps(group, i, boxes[i]);
    int overlap = 0, pass = 0;
    for (size_t i = 0; i < 64; ++i) {
        for (size_t j = 0; j < i; ++j) {
            bool meet = true;
            for (int d = 0; d < 3; ++d) {
                meet &= group.bounds[d][i] <= group.bounds[3 + d][j] && group.bounds[d][j] <= group.bounds[3 + d][i];
            }
            if (overlapping(boxes[i], boxes[j])) {
                EXPECT_TRUE(meet);
                ++overlap;
            }
            pass += meet;
        }
    }
    EXPECT_GT(overlap, 15);
    EXPECT_LE(pass, overlap + overlap / 4);
}

// Boxes drift far out of the frames their groups were built with, and jump to loose groups, at every scale and place.
TEST(CoarseBoxesTest, NoPairIsLostOutsideTheFrames) {
    struct Place {
        const char* kind;
        float scale, from;
    };
    const Place places[] = {{"uniform", 1, 0},     {"sizes", 1, 0},      {"sizes", 1e3f, -4e5f}, {"uniform", 1, 3e6f},
                            {"uniform", 1e30f, 0}, {"sizes", 1e-36f, 0}, {"one point", 1, 1e4f}, {"nested", 1e33f, 0}};
    for (const Place& place : places) {
        for (int width : {4, 8, 16}) {
            const std::string what = std::string(place.kind) + ' ' + std::to_string(place.scale) + ' ' +
                                     std::to_string(place.from) + ' ' + std::to_string(width);
            Boxes boxes = make_boxes(place.kind, 400, 11);
            for (BroadBox& box : boxes) {
                for (int d = 0; d < 3; ++d) {
                    box.lower[d] = box.lower[d] * place.scale + place.from;
                    box.upper[d] = box.upper[d] * place.scale + place.from;
                }
            }
            Memory memory;
            TaskPool tasks(1);
            WideTree tree(&memory, width);
            tree.set_moving(boxes.data(), 400);
            Random random(5);
            for (int frame = 0; frame < 12; ++frame) {
                const Pairs old = expected_pairs({}, boxes);
                std::vector<uint32_t> changed;
                for (uint32_t i = 0; i < 400; ++i) {
                    if (random.below(3)) continue;
                    const bool jumps = random.below(40) == 0;
                    const float by = place.scale * (jumps ? random.uniform(-90, 90) : i % 2 ? 0.9f : -0.9f);
                    const int d = random.below(3);
                    boxes[i].lower[d] += by;
                    boxes[i].upper[d] += by;
                    changed.push_back(i);
                }
                Array<BoxPair> begun, ended;
                tree.update(tasks, boxes.data(), 400, changed.data(), static_cast<int>(changed.size()), begun, ended);
                const Pairs now = expected_pairs({}, boxes);
                Pairs expected_begun, expected_ended;
                std::set_difference(now.begin(), now.end(), old.begin(), old.end(), std::back_inserter(expected_begun));
                std::set_difference(old.begin(), old.end(), now.begin(), now.end(), std::back_inserter(expected_ended));
                ASSERT_EQ(as_written(begun), expected_begun) << what << " frame " << frame;
                ASSERT_EQ(as_written(ended), expected_ended) << what << " frame " << frame;
                ASSERT_STREQ(tree.check(), "") << what << " frame " << frame;
            }
        }
    }
}

}  // namespace
