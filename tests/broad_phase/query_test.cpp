// Box and ray queries answer as a scan of all boxes does, and the structure can be drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

struct Hit {
    uint32_t index = no_box;
    float t = 0;
};

// Where the segment enters a box: the slab test written case by case.
bool enters(const BroadBox& box, const float origin[3], const float along[3], float max_t, float& t) {
    float from = 0, to = max_t;
    for (int d = 0; d < 3; ++d) {
        if (along[d] == 0) {
            if (origin[d] < box.lower[d] || origin[d] > box.upper[d]) return false;
            continue;
        }
        float a = (box.lower[d] - origin[d]) / along[d], b = (box.upper[d] - origin[d]) / along[d];
        from = std::fmax(from, std::fmin(a, b));
        to = std::fmin(to, std::fmax(a, b));
    }
    t = from;
    return from <= to;
}

Hit expected_hit(const Boxes& boxes, const float origin[3], const float along[3], float max_t) {
    Hit best;
    for (const BroadBox& box : boxes) {
        float t;
        if (!enters(box, origin, along, max_t, t)) continue;
        if (best.index == no_box || t < best.t || (t == best.t && box.index < best.index)) best = {box.index, t};
    }
    return best;
}

class QueryTest : public testing::TestWithParam<BroadPhaseType> {
protected:
    void fill(const std::string& kind, int n) {
        fixed_ = make_boxes(kind, n / 2, 31, 50000);
        moving_ = make_boxes(kind, n, 32);
        if (n > 50) {
            fixed_[3].lower[1] = -inf;
            moving_[7].lower[0] = -inf;
            moving_[7].upper[0] = inf;
        }
        set_fixed(broad_phase_, fixed_);
        set_moving(broad_phase_, moving_);
        all_ = moving_;
        all_.insert(all_.end(), fixed_.begin(), fixed_.end());
    }
    void check_ray(std::array<float, 3> origin, std::array<float, 3> along, float max_t) {
        Hit expected = expected_hit(all_, origin.data(), along.data(), max_t);
        Hit found;
        found.index = broad_phase_.ray(origin.data(), along.data(), max_t, found.t);
        ASSERT_EQ(found.index, expected.index) << origin[0] << ' ' << origin[1] << ' ' << origin[2];
        if (expected.index != no_box) {
            ASSERT_EQ(found.t, expected.t);
        }
    }
    void check_box(const BroadBox& box) {
        Array<uint32_t> found;
        broad_phase_.query_box(box.lower, box.upper, found);
        std::vector<uint32_t> expected;
        for (const BroadBox& other : all_) {
            if (overlapping(box, other)) expected.push_back(other.index);
        }
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(std::vector<uint32_t>(found.begin(), found.end()), expected);
    }

    Memory memory_;
    BroadPhase broad_phase_{GetParam(), &memory_};
    Boxes fixed_, moving_, all_;
};

TEST_P(QueryTest, BoxesAndRaysEqualAScan) {
    for (const char* kind : {"uniform", "clustered", "line x", "nested", "ground", "plane"}) {
        for (int n : {0, 1, 6, 40, 1200}) {
            fill(kind, n);
            Random random(static_cast<uint32_t>(n));
            for (int i = 0; i < 60; ++i) {
                std::array<float, 3> from, along, half;
                for (size_t d = 0; d < 3; ++d) {
                    from[d] = random.uniform(-5, 20);
                    along[d] = random.below(4) ? random.uniform(-20, 20) : 0;
                    half[d] = random.uniform(0, 3);
                }
                check_ray(from, along, random.below(5) ? 1 : random.uniform(0, 100));
                check_box(box_around(from, half, 0));
            }
        }
    }
}

TEST_P(QueryTest, DegenerateQueries) {
    fill("uniform", 600);
    check_ray({3, 3, 3}, {0, 0, 0}, 1);
    check_ray({3, 3, 3}, {1, 0, 0}, 0);
    check_ray({3, -50, 3}, {-0.0f, 1, 0}, inf);
    check_ray({-1e30f, 3, 3}, {1e30f, 0, 0}, 2);
    check_ray({moving_[9].lower[0], moving_[9].lower[1], -100}, {0, 0, 1}, 1000);
    check_box(make_box({-inf, -inf, -inf}, {inf, inf, inf}, 0));
    check_box(make_box({inf, inf, inf}, {inf, inf, inf}, 0));
    check_box(make_box({-inf, 2, 2}, {inf, 2, 2}, 0));
    const BroadBox& corner = moving_[100];
    check_box(make_box({corner.upper[0], corner.upper[1], corner.upper[2]},
                       {corner.upper[0], corner.upper[1], corner.upper[2]}, 0));
}

TEST_P(QueryTest, EqualHitsGiveTheSmallestIndex) {
    for (uint32_t i = 0; i < 200; ++i) all_.push_back(make_box({5, -1, -1}, {6 + 0.1f * (i % 7), 1, 1}, 300 - i));
    set_moving(broad_phase_, all_);
    float origin[3] = {0, 0, 0}, along[3] = {10, 0, 0}, t = 0;
    EXPECT_EQ(broad_phase_.ray(origin, along, 1, t), 101u);
    EXPECT_EQ(t, 0.5f);
    EXPECT_EQ(broad_phase_.ray(origin, along, 0.5f, t), 101u);
    EXPECT_EQ(broad_phase_.ray(origin, along, 0.49f, t), no_box);
}

TEST_P(QueryTest, BoxesOfTheStructure) {
    for (int n : {0, 1, 20, 3000}) {
        fill("uniform", n);
        Array<BroadPhaseBox> boxes;
        broad_phase_.boxes(boxes);
        std::vector<uint32_t> leaves, expected;
        int deepest = 0;
        for (const BroadPhaseBox& box : boxes) {
            deepest = std::max(deepest, box.depth);
            if (box.leaf) leaves.push_back(box.index);
            for (int d = 0; d < 3; ++d) EXPECT_LE(box.lower[d], box.upper[d]);
            bool inside = box.depth == 0;  // some box of the level above contains it
            for (const BroadPhaseBox& parent : boxes) {
                if (inside) break;
                bool contains = !parent.leaf && parent.depth == box.depth - 1;
                for (int d = 0; d < 3; ++d) {
                    contains = contains && parent.lower[d] <= box.lower[d] && parent.upper[d] >= box.upper[d];
                }
                inside = contains;
            }
            EXPECT_TRUE(inside);
        }
        for (const BroadBox& box : all_) expected.push_back(box.index);
        std::sort(leaves.begin(), leaves.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(leaves, expected);
        if (GetParam() == BroadPhaseType::rtree_omt && n == 3000) {
            EXPECT_EQ(deepest, 4);  // 8^3 < 3000 <= 8^4
        }
    }
}

INSTANTIATE_TEST_SUITE_P(BroadPhase, QueryTest, testing::ValuesIn(all_types));

}  // namespace
