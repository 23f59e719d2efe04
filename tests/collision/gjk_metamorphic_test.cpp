// Relations between queries that must hold whatever the truth is: swapped bodies, mirrored and scaled worlds, permuted
// vertices, remembered simplices, early ends.
#include <cmath>
#include <cstring>

#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

Core random_core(Random& random) {
    switch (random.integer(4)) {
        case 0:
            return random_box(random, 1);
        case 1:
            return random_hull(random, 1, 24);
        case 2:
            return make_segment(random.uniform(0.1f, 1));
        default:
            return random_tapered(random, 1);
    }
}
float random_distance(Random& random) {
    float d[5] = {random.uniform(0.1f, 2), random.log_uniform(1e-4f, 1e-2f), 0.0f, -random.uniform(1e-3f, 0.05f),
                  -random.uniform(0.1f, 0.5f)};
    return d[random.integer(5)];
}
double tolerance(const Core& a, const Core& b, const ConvexDistance& r) {
    double s = std::max<double>(a.size + b.size, r.distance);
    return (r.distance < 0.0f ? 1e-5 : 2e-6) * s;
}
float angle_between(Vec3 a, Vec3 b) { return dot(a, b) < 0 ? pi : length(cross(a, b)); }

TEST(GjkMetamorphic, SwappedBodiesGiveTheMirroredResult) {
    Random random(21);
    for (int i = 0; i < cases(10000); ++i) {
        Core a = random_core(random), b = random_core(random);
        Transform t = place(random, a, b, random_distance(random)), back = inverse(t);
        ConvexDistance r = query(a, b, t, both_methods[i % 2]), s = query(b, a, back, both_methods[i % 2]);
        ASSERT_NEAR(r.distance, s.distance, 2.0 * tolerance(a, b, r)) << "case " << i;
        // Apart, the normal is unique; the inverse transform is rounded, which matters more the nearer the bodies are.
        if (r.distance > 1e-2f) {
            ASSERT_LE(angle_between(r.normal, -rotate(t.rotation, s.normal)), 1e-3f) << "case " << i;
        }
    }
}

// Sizes and offsets times a power of two give the result times that power, to the last bit.
TEST(GjkMetamorphic, PowersOfTwoScaleExactly) {
    Random random(22);
    for (int i = 0; i < cases(10000); ++i) {
        int k = random.integer(17) - 8;
        float scale = std::ldexp(1.0f, k);
        Core a = random_core(random), b = random_core(random);
        Transform t = place(random, a, b, random_distance(random)), scaled_t{scale * t.translation, t.rotation};
        auto scaled = [&](const Core& core) {
            Core result = core;
            result.geometry.size = scale * core.geometry.size;
            if (core.hull) {
                std::vector<Vec3> points;
                for (Vec3 p : core.hull->vertices) points.push_back(scale * p);
                result = make_hull(points);
            }
            return result;
        };
        Core sa = scaled(a), sb = scaled(b);
        for (SimplexSolver method : both_methods) {
            ConvexDistance r = query(a, b, t, method), s = query(sa, sb, scaled_t, method);
            ASSERT_EQ(scale * r.distance, s.distance) << "case " << i << " scale 2^" << k;
            ASSERT_TRUE(r.normal == s.normal) << "case " << i << " scale 2^" << k;
            ASSERT_TRUE(scale * r.point_a == s.point_a && scale * r.point_b == s.point_b) << "case " << i;
            ASSERT_EQ(r.iterations, s.iterations);
        }
    }
}

TEST(GjkMetamorphic, MirroredWorldsGiveMirroredResults) {
    Random random(23);
    for (int i = 0; i < cases(10000); ++i) {
        Core a = random_box(random, 1), b = random_tapered(random, 1);
        Transform t = place(random, a, b, random_distance(random)), m = t;
        m.translation.x = -t.translation.x;
        m.rotation = {t.rotation.x, -t.rotation.y, -t.rotation.z, t.rotation.w};
        ConvexDistance r = query(a, b, t, both_methods[i % 2]), s = query(a, b, m, both_methods[i % 2]);
        ASSERT_NEAR(r.distance, s.distance, 2.0 * tolerance(a, b, r)) << "case " << i;
        if (r.distance > 1e-2f) {
            ASSERT_LE(angle_between(r.normal, {-s.normal.x, s.normal.y, s.normal.z}), 1e-3f) << "case " << i;
        }
    }
}

TEST(GjkMetamorphic, OrderOfVerticesDoesNotMatter) {
    Random random(24);
    for (int i = 0; i < cases(2000); ++i) {
        Core a = random_hull(random, 1, 20), b = random_hull(random, 1, 20);
        Transform t = place(random, a, b, random_distance(random));
        std::vector<Vec3> points = a.hull->vertices;
        for (size_t n = points.size() - 1; n > 0; --n)
            std::swap(points[n], points[random.integer(static_cast<int>(n + 1))]);
        ConvexDistance r = query(a, b, t, both_methods[i % 2]), s = query(make_hull(points), b, t, both_methods[i % 2]);
        ASSERT_NEAR(r.distance, s.distance, 2e-6 * (a.size + b.size)) << "case " << i;
    }
}

TEST(GjkMetamorphic, BothSimplexSolversGiveOneAnswer) {
    Random random(25);
    for (int i = 0; i < cases(20000); ++i) {
        Core a = random_core(random), b = random_core(random);
        Transform t = place(random, a, b, random_distance(random));
        ConvexDistance r = query(a, b, t, both_methods[0]), s = query(a, b, t, both_methods[1]);
        ASSERT_NEAR(r.distance, s.distance, tolerance(a, b, r)) << "case " << i;
        if (r.distance > 1e-4f) {
            ASSERT_LE(angle_between(r.normal, s.normal), 1e-3f) << "case " << i;
        }
    }
}

TEST(GjkMetamorphic, ResultDependsOnPosesAndCacheAlone) {
    Random random(26);
    for (int i = 0; i < cases(5000); ++i) {
        Core a = random_core(random), b = random_core(random);
        Transform t = place(random, a, b, random_distance(random));
        ConvexPair pair{&a.geometry, &b.geometry, t};
        GjkCache cache;
        distance(pair, cache, both_methods[i % 2], 1e30f);
        pair.b_in_a.translation += 1e-3f * random.direction();
        GjkCache copy = cache;
        ConvexDistance r = distance(pair, cache, both_methods[i % 2], 1e30f);
        query(b, a, inverse(t), both_methods[i % 2]);  // another pair in between
        ConvexDistance s = distance(pair, copy, both_methods[i % 2], 1e30f);
        ASSERT_EQ(std::memcmp(&r.distance, &s.distance, sizeof(float)), 0);
        ASSERT_TRUE(r.normal == s.normal && r.point_a == s.point_a && r.point_b == s.point_b);
        ASSERT_EQ(cache.count, copy.count);
        for (int k = 0; k < cache.count; ++k) ASSERT_TRUE(cache.a[k] == copy.a[k] && cache.b[k] == copy.b[k]);
    }
}

TEST(GjkMetamorphic, EndsEarlyOnlyBeyondTheLimit) {
    Random random(27);
    int early = 0;
    for (int i = 0; i < cases(10000); ++i) {
        Core a = random_core(random), b = random_core(random);
        Transform t = place(random, a, b, random_distance(random));
        ConvexDistance full = query(a, b, t, both_methods[i % 2]);
        float limit = random.integer(4) ? random.uniform(0, 1) : 0.0f;
        GjkCache cache;
        ConvexDistance r = distance({&a.geometry, &b.geometry, t}, cache, both_methods[i % 2], limit);
        double slack = tolerance(a, b, full);
        if (full.distance <= limit) {
            ASSERT_NEAR(r.distance, full.distance, slack) << "case " << i;
        } else {
            ASSERT_GT(r.distance, limit - slack) << "case " << i;
            ASSERT_LE(r.distance, full.distance + slack) << "case " << i;
            ASSERT_TRUE(r.converged);
            early += r.distance < full.distance - 1e-3f;
        }
    }
    EXPECT_GT(early, 0);
}

// A pair that drifts as bodies do: remembered simplices give the cold answer, at next to no cost.
TEST(GjkSequence, WarmAndColdAgreeAlongAPath) {
    Random random(28);
    long warm_iterations = 0, frames_apart = 0;
    for (int n = 0; n < cases(1000); ++n) {
        bool boxes = n % 2 == 0;
        Core a = boxes ? random_box(random, 1) : random_core(random),
             b = boxes ? random_box(random, 1) : random_core(random);
        Transform t = place(random, a, b, random.uniform(-0.1f, 0.8f));
        // Up to 2 mm and 1e-3 rad a frame, in a direction that changes now and then.
        Vec3 velocity = 1e-3f * random.direction(), spin = 1e-3f * random.direction();
        GjkCache cache;
        for (int frame = 0; frame < 1000; ++frame) {
            if (frame % 200 == 199)
                velocity = random.uniform(0, 2e-3f) * random.direction(), spin = 1e-3f * random.direction();
            t.translation += velocity;
            t.rotation = normalize(Quat{0.5f * spin.x, 0.5f * spin.y, 0.5f * spin.z, 1.0f} * t.rotation);
            SimplexSolver method = both_methods[n / 2 % 2];
            ConvexDistance warm = distance({&a.geometry, &b.geometry, t}, cache, method, 1e30f);
            ConvexDistance cold = query(a, b, t, method);
            double slack = warm.distance < 0.0f ? tolerance(a, b, warm) : 2e-6 * (a.size + b.size + warm.distance);
            ASSERT_NEAR(warm.distance, cold.distance, slack) << "sequence " << n << " frame " << frame;
            ASSERT_TRUE(warm.converged) << "sequence " << n << " frame " << frame;
            if (!boxes || frame == 0 || warm.distance < 0.0f) continue;
            warm_iterations += warm.iterations;
            ++frames_apart;
        }
    }
    EXPECT_LE(warm_iterations, 0.5 * frames_apart);
}

// Cylinders and cones that lie on each other or on a box, a little apart or overlapping: the feature that gave the last
// normal gives the cold answer, apart without any iteration and overlapping with few expansions.
TEST(GjkSequence, FeaturesOfCylindersGiveTheColdAnswer) {
    Random random(29);
    long apart = 0, iterations = 0, overlapping = 0, expansions = 0;
    for (int n = 0; n < cases(2000); ++n) {
        const float half = random.uniform(0.05f, 0.8f), radius = random.uniform(0.2f, 0.6f);
        Core a =
            n % 4 == 0 ? make_box({2.0f, 1.0f, 2.0f}) : make_tapered(false, 0.5f, 0.4f, random.uniform(0.0f, 0.5f));
        Core b = make_tapered(false, radius, half, n % 3 == 0 ? 0.0f : radius);
        // Caps, sides across each other, or a cap against a side, leaning by up to a few hundredths.
        const Vec3 x{1.0f, 0.0f, 0.0f}, z{0.0f, 0.0f, 1.0f};
        const Quat lean = rotation_about(random.direction(), random.uniform(0.0f, 0.03f));
        Transform t{{0.0f, 3.0f, 0.0f}, lean};
        if (n % 5 == 1) t = {{0.0f, 0.0f, 3.0f}, lean * rotation_about(z, 0.5f * pi)};
        if (n % 5 == 2) t = {{0.0f, 0.0f, 3.0f}, lean * rotation_about(x, 0.5f * pi)};
        t.translation -= query(a, b, t, both_methods[0]).distance * query(a, b, t, both_methods[0]).normal;
        GjkCache cache;
        for (int frame = 0; frame < 40; ++frame) {
            t.translation += 1e-3f * random.direction();
            t.rotation = normalize(rotation_about(random.direction(), 1e-3f) * t.rotation);
            ConvexDistance warm = distance({&a.geometry, &b.geometry, t}, cache, both_methods[n % 2], 1e30f);
            ConvexDistance cold = query(a, b, t, both_methods[n % 2]);
            ASSERT_NEAR(warm.distance, cold.distance, tolerance(a, b, warm)) << "sequence " << n << " frame " << frame;
            ASSERT_TRUE(warm.converged) << "sequence " << n << " frame " << frame;
            ASSERT_NEAR(length(warm.point_b - warm.point_a), absolute(warm.distance), tolerance(a, b, warm));
            if (frame == 0) continue;
            ++(warm.distance < 0.0f ? overlapping : apart);
            if (warm.distance < 0.0f) expansions += warm.expansions;
            else iterations += warm.iterations;
        }
    }
    EXPECT_LE(iterations, apart);
    EXPECT_LE(expansions, 3 * overlapping);
}

// Deep within each other, what a query remembers must not lead it farther round than a cold one goes.
TEST(GjkSequence, DeepHullsTakeNoMoreWarmThanCold) {
    Random random(30);
    long warm_expansions = 0, cold_expansions = 0;
    for (int n = 0; n < cases(2000); ++n) {
        Core a = random_hull(random, 1.0f, 32), b = random_hull(random, 1.0f, 32);
        Transform t = place(random, a, b, random.uniform(-0.4f, -0.2f));
        const SimplexSolver method = both_methods[n % 2];
        GjkCache cache;
        distance({&a.geometry, &b.geometry, t}, cache, method, 1e30f);
        for (int frame = 0; frame < 4; ++frame) {
            t.translation += 1e-3f * random.direction();
            t.rotation = normalize(rotation_about(random.direction(), 1e-3f) * t.rotation);
            ConvexDistance warm = distance({&a.geometry, &b.geometry, t}, cache, method, 1e30f);
            ConvexDistance cold = query(a, b, t, method);
            ASSERT_NEAR(warm.distance, cold.distance, tolerance(a, b, warm)) << "sequence " << n << " frame " << frame;
            ASSERT_TRUE(warm.converged) << "sequence " << n << " frame " << frame;
            warm_expansions += warm.expansions;
            cold_expansions += cold.expansions;
        }
    }
    EXPECT_LE(warm_expansions, 1.05 * cold_expansions);
}

// The features along the best axis of two boxes near each other, touching or overlapping are the nearest ones, or next
// to these: no search is needed but to prove it.
TEST(GjkSequence, BoxesNearEachOtherHardlySearch) {
    Random random(31);
    long iterations = 0, queries = 0;
    for (int n = 0; n < cases(20000); ++n) {
        Core a = random_box(random, 1.0f), b = random_box(random, 1.0f);
        const float wanted = n % 3 == 0 ? 0.0f : n % 3 == 1 ? random.uniform(0.0f, 0.01f) : random.uniform(-0.1f, 0.0f);
        const Transform t = place(random, a, b, wanted);
        for (SimplexSolver method : both_methods) {
            const ConvexDistance r = query(a, b, t, method);
            ASSERT_TRUE(r.converged) << "case " << n;
            iterations += r.iterations;
            ++queries;
        }
    }
    EXPECT_LE(iterations, 0.5 * queries);
}

}  // namespace
}  // namespace lendulet::gjk_test
