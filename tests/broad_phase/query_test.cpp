// Box and ray queries answer as a scan of all boxes does, and the structure can be drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "broad_phase/support.h"
#include "scale.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

struct Hit {
    uint32_t index = no_box;
    float t = 0;
};

// When a moving box (a point for a ray) enters another: the slab test written case by case.
bool enters(const BroadBox& box, const BroadBox& mover, const float along[3], float max_t, float& t) {
    float from = 0, to = max_t;
    for (int d = 0; d < 3; ++d) {
        if (along[d] == 0) {
            if (mover.upper[d] < box.lower[d] || mover.lower[d] > box.upper[d]) return false;
            continue;
        }
        float a = (box.lower[d] - mover.upper[d]) / along[d], b = (box.upper[d] - mover.lower[d]) / along[d];
        from = std::fmax(from, std::fmin(a, b));
        to = std::fmin(to, std::fmax(a, b));
    }
    t = from;
    return from <= to;
}

void take_better(Hit& best, uint32_t index, float t) {
    if (best.index == no_box || t < best.t || (t == best.t && index < best.index)) best = {index, t};
}

Hit expected_cast(const Boxes& boxes, const BroadBox& mover, const float along[3], float max_t) {
    Hit best;
    for (const BroadBox& box : boxes) {
        float t;
        if (enters(box, mover, along, max_t, t)) take_better(best, box.index, t);
    }
    return best;
}

Hit expected_nearest(const Boxes& boxes, const float point[3], float max_distance) {
    Hit best;
    for (const BroadBox& box : boxes) {
        float squared = 0;
        for (int d = 0; d < 3; ++d) {
            float gap = std::fmax(std::fmax(box.lower[d] - point[d], point[d] - box.upper[d]), 0.0f);
            squared += gap * gap;
        }
        if (max_distance >= 0 && squared <= max_distance * max_distance) take_better(best, box.index, squared);
    }
    best.t = std::sqrt(best.t);
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
    void expect_hit(const Hit& found, const Hit& expected, const char* what) {
        ASSERT_EQ(found.index, expected.index) << what << " of " << all_.size();
        if (expected.index != no_box) {
            ASSERT_EQ(found.t, expected.t) << what;
        }
    }
    void check_cast(const BroadBox& mover, std::array<float, 3> along, float max_t) {
        Hit found;
        found.index = broad_phase_.cast_box(mover.lower, mover.upper, along.data(), max_t, found.t);
        expect_hit(found, expected_cast(all_, mover, along.data(), max_t), "cast");
    }
    void check_ray(std::array<float, 3> origin, std::array<float, 3> along, float max_t) {
        Hit found;
        found.index = broad_phase_.ray(origin.data(), along.data(), max_t, found.t);
        expect_hit(found, expected_cast(all_, make_box(origin, origin, 0), along.data(), max_t), "ray");
    }
    void check_nearest(std::array<float, 3> point, float max_distance) {
        Hit found;
        found.index = broad_phase_.nearest(point.data(), max_distance, found.t);
        expect_hit(found, expected_nearest(all_, point.data(), max_distance), "nearest");
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
                check_cast(box_around(from, half, 0), along, random.below(5) ? 1 : random.uniform(0, 100));
                check_nearest(from, random.below(3) ? inf : random.uniform(0, 5));
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
    check_cast(make_box({3, 3, 3}, {9, 9, 9}, 0), {0, 0, 0}, 1);
    check_cast(make_box({-1e30f, 3, 3}, {-1e29f, 4, 4}, 0), {1e30f, 0, 0}, 2);
    check_nearest({3, 3, 3}, 0);
    check_nearest({3, 3, 3}, -1);
    check_nearest({1e15f, -1e15f, 3}, inf);
    check_ray({moving_[9].lower[0], moving_[9].lower[1], -100}, {0, 0, 1}, 1000);
    check_box(make_box({-inf, -inf, -inf}, {inf, inf, inf}, 0));
    check_box(make_box({inf, inf, inf}, {inf, inf, inf}, 0));
    check_box(make_box({-inf, 2, 2}, {inf, 2, 2}, 0));
    const BroadBox& corner = moving_[100];
    check_box(make_box({corner.upper[0], corner.upper[1], corner.upper[2]},
                       {corner.upper[0], corner.upper[1], corner.upper[2]}, 0));
}

// As many rays as make a million for all structures together, in scenes that change now and then.
TEST_P(QueryTest, ManyRays) {
    Random random(5);
    const char* kinds[] = {"uniform", "clustered", "sizes", "plane", "line z"};
    const int rays = scaled(1000000 / static_cast<int>(std::size(all_types)) + 1), per_scene = 500;
    for (int i = 0; i < rays; ++i) {
        if (i % per_scene == 0) fill(kinds[i / per_scene % 5], 20 + random.below(60));
        float reach = 3 + 0.05f * static_cast<float>(all_.size());
        std::array<float, 3> from, along;
        for (size_t d = 0; d < 3; ++d) {
            from[d] = random.uniform(-2, reach);
            along[d] = random.below(8) ? random.uniform(-20, 20) : 0;
        }
        check_ray(from, along, 1);
        if (HasFatalFailure()) return;
    }
}

TEST_P(QueryTest, BatchesAnswerAsSingleQueriesDo) {
    fill("clustered", 900);
    TaskPool tasks(3);
    Random random(8);
    constexpr int n = 500;
    std::vector<BoxQuery> boxes(n);
    std::vector<RayQuery> rays(n);
    std::vector<CastQuery> casts(n);
    std::vector<NearestQuery> points(n);
    for (size_t i = 0; i < n; ++i) {
        for (int d = 0; d < 3; ++d) {
            float from = random.uniform(-5, 30), along = random.uniform(-20, 20), half = random.uniform(0, 2);
            boxes[i].lower[d] = casts[i].lower[d] = from - half;
            boxes[i].upper[d] = casts[i].upper[d] = from + half;
            rays[i].origin[d] = points[i].point[d] = from;
            rays[i].translation[d] = casts[i].translation[d] = along;
        }
        rays[i].max_t = casts[i].max_t = 1;
        points[i].max_distance = random.uniform(0, 9);
    }
    Array<uint32_t> offsets, hits;
    hits.push_back(7);  // appended to
    broad_phase_.query_boxes(tasks, boxes.data(), n, offsets, hits);
    std::vector<BroadPhaseHit> by_ray(n), by_cast(n), by_point(n);
    broad_phase_.rays(tasks, rays.data(), n, by_ray.data());
    broad_phase_.cast_boxes(tasks, casts.data(), n, by_cast.data());
    broad_phase_.nearest_boxes(tasks, points.data(), n, by_point.data());
    ASSERT_EQ(offsets.count(), n + 1);
    EXPECT_EQ(offsets[0], 1u);
    EXPECT_EQ(offsets[n], hits.size());
    int found = 0;
    for (size_t i = 0; i < n; ++i) {
        Array<uint32_t> single;
        broad_phase_.query_box(boxes[i].lower, boxes[i].upper, single);
        EXPECT_EQ(std::vector<uint32_t>(single.begin(), single.end()),
                  std::vector<uint32_t>(hits.begin() + offsets[i], hits.begin() + offsets[i + 1]));
        float t = 0;
        auto same = [&](const BroadPhaseHit& hit, uint32_t index) {
            ASSERT_EQ(hit.index, index);
            if (index == no_box) return;
            ASSERT_EQ(hit.at, t);
            ++found;
        };
        same(by_ray[i], broad_phase_.ray(rays[i].origin, rays[i].translation, 1, t));
        same(by_cast[i], broad_phase_.cast_box(casts[i].lower, casts[i].upper, casts[i].translation, 1, t));
        same(by_point[i], broad_phase_.nearest(points[i].point, points[i].max_distance, t));
    }
    EXPECT_GT(found, n / 2);
    broad_phase_.query_boxes(tasks, nullptr, 0, offsets, hits);
    EXPECT_EQ(offsets.count(), 1);
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
