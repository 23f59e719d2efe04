// Balls, capsules and boxes with balls in batches: one result for every width, and that of the closed forms for one
// pair.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "collision/narrow_phase.h"
#include "scenes/random.h"
#include "world/narrow/kernels.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

using scenes::Random;
constexpr int pair_count = batch_capacity;
constexpr float near_surfaces = 0.05f;

enum class Mix { balls, capsules, balls_and_capsules, boxes_and_balls };

struct RoundPairs {
    std::vector<Geometry> geometry;
    std::vector<ShapeFrame> frames;
    RoundBatch batch;
    std::vector<BatchManifold> out = std::vector<BatchManifold>(RoundBatch::room);

    Geometry shape(Random& random, Mix mix, int i) const {
        Geometry g{};
        bool ball = mix == Mix::balls || (mix == Mix::balls_and_capsules && random.range(0.0f, 1.0f) < 0.5f) ||
                    (mix == Mix::boxes_and_balls && i % 2 == 1);
        g.kind = ball ? GeometryKind::point : mix == Mix::boxes_and_balls ? GeometryKind::box : GeometryKind::segment;
        g.rounding = random.range(0.2f, 0.4f);
        if (g.kind == GeometryKind::segment) g.size = {0.0f, random.range(0.1f, 0.6f), 0.0f};
        if (g.kind == GeometryKind::box) {
            g.size = {random.range(0.1f, 0.5f), random.range(0.1f, 0.5f), random.range(0.1f, 0.5f)};
            if (i % 4 == 0) g.rounding = 0.0f;
        }
        return g;
    }

    RoundPairs(Mix mix, int count) {
        Random random(11);
        for (int i = 0; i < 2 * count; ++i) {
            geometry.push_back(shape(random, mix, i));
            ShapeFrame f{};
            // Every third pair lies parallel, every fifth has one centre.
            Quat q = i / 2 % 3 == 0 ? Quat{} : random.rotation();
            const float rotation[4] = {q.x, q.y, q.z, q.w};
            std::memcpy(f.rotation, rotation, sizeof rotation);
            for (float& x : f.centre) x = random.range(-0.4f, 0.4f);
            for (float& x : f.arm) x = random.range(-0.1f, 0.1f);
            if (i / 2 % 5 == 0) std::memset(f.centre, 0, sizeof f.centre), std::memset(f.arm, 0, sizeof f.arm);
            f.near = near_surfaces;
            const Geometry& g = geometry.back();
            f.half[0] = g.size.x, f.half[1] = g.size.y, f.half[2] = g.size.z;
            f.rounding = g.rounding;
            frames.push_back(f);
        }
        batch.frames = frames.data();
        batch.dt = 1.0f / 60.0f, batch.fall = 0.0f;
        batch.count = count;
        for (int k = 0; k < count; ++k) {
            batch.a[k] = 2 * k, batch.b[k] = 2 * k + 1;
            batch.exchanged[k] = k % 2 == 1 ? 1.0f : 0.0f;
        }
    }

    void collide(Mix mix, int width) {
        const NarrowKernels& kernels = narrow_kernels(width);
        (mix == Mix::boxes_and_balls ? kernels.collide_box_balls : kernels.collide_segments)(batch, out.data());
    }

    // By the function for one pair, as from the batch's A to its B, exchanged where that is.
    int one(int k, Manifold& manifold) const {
        size_t a = static_cast<size_t>(2 * k), b = a + 1;
        if (batch.exchanged[k] > 0.0f) std::swap(a, b);
        const ShapeFrame &fa = frames[a], &fb = frames[b];
        auto quat = [](const float* q) { return Quat{q[0], q[1], q[2], q[3]}; };
        auto vector = [](const float* v) { return Vec3{v[0], v[1], v[2]}; };
        Vec3 offset = (vector(fb.centre) + vector(fb.arm)) - (vector(fa.centre) + vector(fa.arm));
        PairCache cache;
        int count =
            lendulet::collide({&geometry[a], &geometry[b], quat(fa.rotation), quat(fb.rotation), offset, near_surfaces},
                              cache, {}, &manifold, 1);
        for (int i = 0; i < count * manifold.count; ++i) manifold.points[i].position += vector(fa.arm);
        return count;
    }
};

class RoundBatches : public ::testing::TestWithParam<Mix> {};

TEST_P(RoundBatches, GiveOneResultForEveryWidth) {
    for (int count : {1, 7, 100, pair_count}) {
        std::vector<BatchManifold> expected;
        for (int width : widths) {
            auto pairs = std::make_unique<RoundPairs>(GetParam(), count);
            pairs->collide(GetParam(), width);
            if (expected.empty()) expected = pairs->out;
            for (int k = 0; k < count; ++k) {
                const size_t i = static_cast<size_t>(k);
                EXPECT_EQ(std::memcmp(&pairs->out[i], &expected[i], sizeof(BatchManifold)), 0)
                    << "width " << width << ", pair " << k << " of " << count;
            }
        }
    }
}

TEST_P(RoundBatches, AgreeWithSinglePairs) {
    auto pairs = std::make_unique<RoundPairs>(GetParam(), pair_count);
    pairs->collide(GetParam(), 16);
    int touching = 0, apart = 0, two = 0;
    for (int k = 0; k < pair_count; ++k) {
        Manifold one;
        int count = pairs->one(k, one);
        const BatchManifold& m = pairs->out[static_cast<size_t>(k)];
        ASSERT_EQ(m.count > 0, count > 0) << "pair " << k;
        ++(count > 0 ? touching : apart);
        if (count == 0) continue;
        ASSERT_EQ(m.count, one.count) << "pair " << k;
        two += m.count == 2;
        Vec3 normal{m.normal[0], m.normal[1], m.normal[2]};
        // Where cores meet any direction out is as good as another, but it must be one.
        EXPECT_NEAR(length(normal), 1.0f, 1e-5f) << "pair " << k;
        bool decided = k % 5 != 0;
        if (decided) {
            EXPECT_LT(length(normal - one.normal), 1e-4f) << "pair " << k;
            EXPECT_NEAR(m.follow, one.follow, 1e-5f) << "pair " << k;
        }
        EXPECT_EQ(m.radius_a, one.radius_a) << "pair " << k;
        EXPECT_EQ(m.radius_b, one.radius_b) << "pair " << k;
        for (int i = 0; i < m.count; ++i) {
            const auto& p = m.points[i];
            // The two ends of a stretch are those on the axis of A: of nearly parallel capsules others where the pair
            // is exchanged, and in the other order.
            const float tolerance = m.count == 2 && pairs->batch.exchanged[k] > 0.0f ? 1e-2f : 1e-4f;
            float nearest = 1e9f, separation = 0.0f;
            for (int j = 0; j < one.count; ++j) {
                float d = length(Vec3{p.position[0], p.position[1], p.position[2]} - one.points[j].position);
                if (d < nearest) nearest = d, separation = one.points[j].separation;
            }
            if (decided) {
                EXPECT_LT(nearest, tolerance) << "pair " << k;
            }
            EXPECT_NEAR(p.separation, separation, 0.1f * tolerance) << "pair " << k;
        }
    }
    EXPECT_GT(touching, 50);
    EXPECT_GT(apart, 10);
    if (GetParam() == Mix::capsules) {
        EXPECT_GT(two, 10);
    }
}

INSTANTIATE_TEST_SUITE_P(All, RoundBatches,
                         ::testing::Values(Mix::balls, Mix::capsules, Mix::balls_and_capsules, Mix::boxes_and_balls));

}  // namespace
}  // namespace lendulet::test
