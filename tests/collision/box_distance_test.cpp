// Two boxes by the faces of their difference: whatever face a query begins with, the answer is the oracle's.
#include <cmath>

#include "collision/box_candidates.h"
#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

constexpr uint8_t faces = GjkCache::unknown_face + 1;  // what a cache may hold

// Boxes like dice, plates, rods and such without any thickness, of very different sizes, near each other, touching or
// overlapping; every fourth pair is parallel or nearly so.
struct Pair {
    Core a, b;
    Transform t;
};
Core any_box(Random& random) {
    const float size = random.integer(3) == 0 ? random.log_uniform(1e-3f, 1e4f) : 1.0f;
    Vec3 half{size * random.uniform(0.25f, 1.0f), size * random.uniform(0.25f, 1.0f), size};
    for (int i = 0; i < 2; ++i)
        if (random.integer(4) == 0) set_component(half, i, random.integer(2) ? 0.0f : 1e-4f * size);
    return make_box(half);
}
Pair any_pair(Random& random) {
    Pair p{any_box(random), any_box(random), {}};
    const float least = std::min(p.a.size, p.b.size);
    const float wanted[5] = {0.0f, random.log_uniform(1e-6f, 1e-4f), random.log_uniform(1e-4f, 1e-1f),
                             -random.log_uniform(1e-6f, 1e-2f), -random.uniform(0.01f, 0.3f)};
    p.t = place(random, p.a, p.b, least * wanted[random.integer(5)]);
    if (random.integer(4) == 0) {
        const float lean = random.integer(2) ? 0.0f : random.log_uniform(1e-6f, 1e-2f);
        p.t.rotation = rotation_about(random.direction(), lean);
        const ConvexDistance d = query(p.a, p.b, p.t, both_methods[0]);
        p.t.translation -= (d.distance - least * wanted[random.integer(5)]) * d.normal;
    }
    return p;
}
void move(Random& random, Pair& p) {
    const float least = std::min(p.a.size, p.b.size);
    p.t.translation += random.uniform(0.0f, 2e-3f * least) * random.direction();
    p.t.rotation = normalize(rotation_about(random.direction(), random.uniform(0.0f, 2e-3f)) * p.t.rotation);
}

TEST(BoxDistance, AlongAPathTheAnswerIsTheOracles) {
    Tally tally("boxes, warm");
    Random random(41);
    for (int n = 0; n < cases(4000); ++n) {
        Pair p = any_pair(random);
        GjkCache cache;
        for (int frame = 0; frame < 6; ++frame) {
            const ConvexDistance r = distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[n % 2], 1e30f);
            tally.judge(p.a, p.b, p.t, r, oracle_answer(p.a, p.b, p.t));
            move(random, p);
        }
    }
}

// Also one that no query could have left there.
TEST(BoxDistance, TheRememberedFaceDoesNotChangeTheAnswer) {
    Tally tally("boxes, any face");
    Random random(42);
    for (int n = 0; n < cases(2000); ++n) {
        Pair p = any_pair(random);
        GjkCache left;
        distance({&p.a.geometry, &p.b.geometry, p.t}, left, both_methods[n % 2], 1e30f);
        move(random, p);
        const oracle::Answer answer = oracle_answer(p.a, p.b, p.t);
        const ConvexDistance cold = query(p.a, p.b, p.t, both_methods[n % 2]);
        for (uint8_t face = 0; face < faces; ++face) {
            GjkCache cache = left;
            cache.face = face;
            const ConvexDistance r = distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[n % 2], 1e30f);
            tally.judge(p.a, p.b, p.t, r, answer);
            ASSERT_NEAR(r.distance, cold.distance, 1e-6 * (p.a.size + p.b.size)) << "case " << n << " face " << +face;
            ASSERT_LE(cache.face, GjkCache::unknown_face);
        }
    }
}

// Pairs without special places: no search, and to the last bits the same as cold.
TEST(BoxDistance, NearBoxesNeedNoSearchWarm) {
    Random random(43);
    int searched = 0, count = 0;
    for (int n = 0; n < cases(20000); ++n) {
        Pair p{random_box(random, 1.0f), random_box(random, 1.0f), {}};
        p.t = place(random, p.a, p.b, random.uniform(-0.05f, 0.02f));
        GjkCache cache;
        distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[n % 2], 1e30f);
        EXPECT_NE(cache.face, 0) << "case " << n;
        move(random, p);
        const ConvexDistance r = distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[n % 2], 1e30f);
        const ConvexDistance cold = query(p.a, p.b, p.t, both_methods[n % 2]);
        ASSERT_NEAR(r.distance, cold.distance, 1e-7) << "case " << n;
        searched += r.iterations + r.expansions;
        ++count;
    }
    EXPECT_LE(searched, 1e-3 * count);
}

// From afar, where GJK is at work, in small steps or at once.
TEST(BoxDistance, BoxesThatComeNearGoByFaces) {
    Random random(46);
    for (int n = 0; n < cases(2000); ++n) {
        Pair p{random_box(random, 1.0f), random_box(random, 1.0f), {}};
        p.t = place(random, p.a, p.b, 0.5f);
        GjkCache cache;
        const ConvexDistance first = distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[0], 1e30f);
        GjkCache at_once = cache;
        for (float wanted : {0.02f, -0.03f, -0.08f}) {
            const Transform t{p.t.translation - (0.5f - wanted) * first.normal, p.t.rotation};
            const bool by_face = cache.face != 0;
            const ConvexDistance r = distance({&p.a.geometry, &p.b.geometry, t}, cache, both_methods[0], 1e30f);
            ASSERT_EQ(r.expansions, 0) << "case " << n << " at " << wanted;
            ASSERT_TRUE(!by_face || r.iterations == 0) << "case " << n << " at " << wanted;
            ASSERT_NE(cache.face, 0) << "case " << n << " at " << wanted;
        }
        const Transform t{p.t.translation - 0.58f * first.normal, p.t.rotation};
        ASSERT_EQ(distance({&p.a.geometry, &p.b.geometry, t}, at_once, both_methods[0], 1e30f).expansions, 0);
    }
}

TEST(BoxDistance, EndsEarlyOnlyBeyondTheLimit) {
    Random random(44);
    int early = 0;
    for (int n = 0; n < cases(10000); ++n) {
        Pair p{random_box(random, 1.0f), random_box(random, 1.0f), {}};
        p.t = place(random, p.a, p.b, random.log_uniform(1e-3f, 5e-2f));
        GjkCache cache;
        distance({&p.a.geometry, &p.b.geometry, p.t}, cache, both_methods[n % 2], 1e30f);
        move(random, p);
        const ConvexDistance full = query(p.a, p.b, p.t, both_methods[n % 2]);
        for (uint8_t face = 0; face < faces; ++face) {
            GjkCache from = cache;
            from.face = face;
            const float limit = random.integer(4) ? random.uniform(0.0f, 5e-2f) : 0.0f;
            const ConvexDistance r = distance({&p.a.geometry, &p.b.geometry, p.t}, from, both_methods[n % 2], limit);
            ASSERT_TRUE(r.converged);
            ASSERT_LE(r.distance, full.distance + 1e-6f) << "case " << n << " face " << +face;
            ASSERT_GE(r.distance, std::min(full.distance, limit) - 1e-6f) << "case " << n << " face " << +face;
            early += r.distance > limit && r.distance < full.distance - 1e-4f;
        }
    }
    EXPECT_GT(early, 0);
}

// Single precision rules out no axis that doubles find best, and few others; doubles decide. Boxes corner to corner
// have many axes that are equally good but for rounding.
TEST(BoxDistance, RoundingDropsNoAxis) {
    Random random(45);
    long left = 0, count = 0, several = 0;
    for (int n = 0; n < cases(20000); ++n) {
        const float size = random.log_uniform(1e-3f, 1e4f), other = size * random.log_uniform(1e-3f, 1.0f);
        Pair p{random_box(random, size), random_box(random, other), {}};
        p.t = place(random, p.a, p.b, -other * (n % 2 ? 1e-7f : random.uniform(0.0f, 0.5f)));
        const BoxDifference boxes(CoreDifference({&p.a.geometry, &p.b.geometry, p.t}));
        double separation[face_count], most = -1e300;
        for (int k = 0; k < face_count; ++k) {
            const FacePlane plane = plane_of(boxes, k);
            separation[k] = plane.separation_times_sine / std::sqrt(plane.sine_squared);
            most = std::max(most, separation[k]);
        }
        const uint32_t candidates = best_candidates(boxes);
        if (candidates == 0) continue;  // edges are parallel
        for (int k = 0; k < face_count; ++k) {
            const bool is_left = (candidates >> k & 1) != 0;
            ASSERT_TRUE(is_left || separation[k] < most) << "case " << n << " axis " << k;
            ASSERT_TRUE(!is_left || separation[k] >= most - 4e-6 * boxes.size) << "case " << n << " axis " << k;
            left += is_left;
        }
        if (most < 0.0) {
            const float d = query(p.a, p.b, p.t, both_methods[0]).distance;
            ASSERT_NEAR(d, most, 1e-7 * std::abs(most)) << "case " << n;
        }
        several += (candidates & (candidates - 1)) != 0;
        ++count;
    }
    EXPECT_GT(several, count / 20);
    EXPECT_LE(left, 3 * count);
}

}  // namespace
}  // namespace lendulet::gjk_test
