// Two boxes: manifolds by hand, depth against brute force, symmetry and names.
#include <algorithm>
#include <set>

#include "oracle.h"
#include "pairs.h"

using namespace pairs;

namespace {

oracle::Body body_of(Vec3 half, Quat q, Vec3 at) {
    return oracle::moved(oracle::make_box({half.x, half.y, half.z}),
                         oracle::make_pose(q.x, q.y, q.z, q.w, {at.x, at.y, at.z}));
}
oracle::Vec to_oracle(Vec3 v) { return {v.x, v.y, v.z}; }

std::set<uint32_t> ids(const Manifold& m) {
    std::set<uint32_t> s;
    for (int i = 0; i < m.count; ++i) s.insert(m.points[i].id);
    return s;
}

// Whether m has a point there.
bool has_point(const Manifold& m, Vec3 position, float tolerance) {
    return std::any_of(m.points, m.points + m.count,
                       [&](const ManifoldPoint& p) { return length(p.position - position) < tolerance; });
}

TEST(BoxBox, StackedBoxesTouchInTheCornersOfTheSmaller) {
    Solid big(Box{{2.0f, 1.0f, 2.0f}}), small(Box{{0.5f, 0.5f, 0.25f}});
    Manifold m = manifold(pair_of({big, identity}, {small, identity}, {0.5f, 1.49f, 0.25f}, 0.02f));
    ASSERT_EQ(m.count, 4);
    expect_near(m.normal, {0.0f, 1.0f, 0.0f}, 0.0f);
    for (float x : {0.0f, 1.0f})
        for (float z : {0.0f, 0.5f}) EXPECT_TRUE(has_point(m, {x, 0.995f, z}, 1e-5f));
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(m.points[i].separation, -0.01f, 1e-6f);
    EXPECT_EQ(m.follow, 1.0f);
    Manifold back = manifold(pair_of({small, identity}, {big, identity}, {-0.5f, -1.49f, -0.25f}, 0.02f));
    ASSERT_EQ(back.count, 4);
    expect_near(back.normal, {0.0f, -1.0f, 0.0f}, 0.0f);
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(has_point(back, m.points[i].position - Vec3{0.5f, 1.49f, 0.25f}, 1e-5f));
}

TEST(BoxBox, EqualBoxesTouchInTheirCorners) {
    Solid box(Box{{0.5f, 0.5f, 0.5f}});
    // Shifts of round-off size and either sign neither lose points nor rename them.
    Manifold first = manifold(pair_of({box, identity}, {box, identity}, {0.0f, 1.0f, 0.0f}, 0.02f));
    ASSERT_EQ(first.count, 4);
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Vec3 offset{random.in(-1e-5f, 1e-5f), 1.0f + random.in(-1e-4f, 1e-4f), random.in(-1e-5f, 1e-5f)};
        Quat turn = rotation_about(random.direction(), random.in(-1e-5f, 1e-5f));
        Manifold m = manifold(pair_of({box, identity}, {box, turn}, offset, 0.02f));
        ASSERT_EQ(m.count, 4);
        EXPECT_EQ(ids(m), ids(first));
        for (int k = 0; k < 4; ++k) EXPECT_TRUE(has_point(m, first.points[k].position, 1e-3f));
    }
}

TEST(BoxBox, TurnedByAnEighthTheEightCornersThinToFourOpposite) {
    Solid box(Box{{0.5f, 0.5f, 0.5f}});
    Quat turn = rotation_about({0.0f, 1.0f, 0.0f}, 0.25f * pi);
    Manifold m = manifold(pair_of({box, identity}, {box, turn}, {0.0f, 0.99f, 0.0f}, 0.02f));
    ASSERT_EQ(m.count, 4);
    Vec3 mean{};
    for (int i = 0; i < 4; ++i) mean += 0.25f * m.points[i].position;
    expect_near(mean, {0.0f, 0.495f, 0.0f}, 1e-4f);
    float area =
        length(cross(m.points[1].position - m.points[0].position, m.points[2].position - m.points[0].position));
    EXPECT_GT(area, 0.5f);
}

TEST(BoxBox, CrossedEdgesTouchInOnePoint) {
    Solid box(Box{{1.0f, 0.5f, 0.5f}});
    // Ridge of A along x, ridge of B along z, one above the other.
    Quat qa = rotation_about({1.0f, 0.0f, 0.0f}, 0.25f * pi);
    Quat qb = rotation_about({0.0f, 1.0f, 0.0f}, 0.5f * pi) * qa;
    float ridge = std::sqrt(0.5f);
    Manifold m = manifold(pair_of({box, qa}, {box, qb}, {0.1f, 2.0f * ridge - 0.01f, 0.2f}, 0.0f));
    ASSERT_EQ(m.count, 1);
    expect_near(m.normal, {0.0f, 1.0f, 0.0f}, 1e-5f);
    expect_near(m.points[0].position, {0.1f, ridge - 0.005f, 0.0f}, 1e-5f);
    EXPECT_NEAR(m.points[0].separation, -0.01f, 1e-5f);
    EXPECT_EQ(m.follow, 0.5f);
}

// Deepest separation, position and mirror image over random overlapping pairs of three sizes.
TEST(BoxBox, DepthAgreesWithBruteForce) {
    Random random(11);
    for (float scale : {1e-2f, 1.0f, 1e3f}) {
        for (int i = 0; i < 1500; ++i) {
            Vec3 ha = scale * random.vector(0.2f, 1.0f), hb = scale * random.vector(0.2f, 1.0f);
            Solid a(Box{ha}), b(Box{hb});
            Quat qa = random.rotation(), qb = random.rotation();
            Vec3 offset = scale * random.vector(-1.0f, 1.0f);
            float margin = 0.02f * scale;
            oracle::Body body_a = body_of(ha, qa, {}), body_b = body_of(hb, qb, offset);
            auto expected = static_cast<float>(oracle::distance(body_a, body_b).distance);
            Manifold m = manifold(pair_of({a, qa}, {b, qb}, offset, margin));
            if (expected > margin) {
                EXPECT_EQ(m.count, 0);
                continue;
            }
            ASSERT_NO_FATAL_FAILURE(expect_sound(m, margin));
            float smallest = minimum(min_component(ha), min_component(hb));
            EXPECT_LE(deepest(m), expected + 2e-3f * scale);
            if (expected < 0.0f) {
                EXPECT_GE(deepest(m), expected - 5e-3f * smallest);
            }
            for (int k = 0; k < m.count; ++k) {
                Vec3 half_gap = (0.5f * m.points[k].separation) * m.normal;
                EXPECT_LE(oracle::outside(body_a, to_oracle(m.points[k].position - half_gap)), 2e-3f * scale);
                EXPECT_LE(oracle::outside(body_b, to_oracle(m.points[k].position + half_gap)), 2e-3f * scale);
            }
            Manifold back = manifold(pair_of({b, qb}, {a, qa}, -offset, margin));
            ASSERT_GE(back.count, 1);
            EXPECT_NEAR(deepest(back), deepest(m), 5e-3f * smallest + 2e-3f * scale);
        }
    }
}

// Away from ties, swapping the boxes mirrors every point.
TEST(BoxBox, SwapMirrors) {
    Random random(5);
    Solid a(Box{{0.5f, 0.4f, 0.3f}}), b(Box{{0.35f, 0.45f, 0.25f}});
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
        Quat qa = random.rotation(), qb = random.rotation();
        Vec3 offset = random.vector(-0.8f, 0.8f);
        Manifold m = manifold(pair_of({a, qa}, {b, qb}, offset, 0.02f));
        Manifold back = manifold(pair_of({b, qb}, {a, qa}, -offset, 0.02f));
        EXPECT_EQ(m.count == 0, back.count == 0);
        if (m.count == 0 || dot(m.normal, back.normal) > -0.9999f) continue;  // a tie of axes
        ++compared;
        ASSERT_EQ(m.count, back.count);
        EXPECT_NEAR(m.follow, 1.0f - back.follow, 1e-6f);
        for (int k = 0; k < m.count; ++k) EXPECT_TRUE(has_point(back, m.points[k].position - offset, 1e-4f));
    }
    EXPECT_GT(compared, 400);
}

TEST(BoxBox, NamesLastWhileABoxSlides) {
    Solid floor(Box{{5.0f, 0.5f, 5.0f}}), box(Box{{0.5f, 0.5f, 0.5f}});
    PairCache cache;
    Manifold m;
    std::set<uint32_t> first;
    for (int i = 0; i < 200; ++i) {
        float s = 0.01f * static_cast<float>(i);
        Quat turn = rotation_about({0.0f, 1.0f, 0.0f}, 0.005f * static_cast<float>(i));
        CollidePair pair = pair_of({floor, identity}, {box, turn}, {s, 0.999f, -s}, 0.02f);
        ASSERT_EQ(collide(pair, cache, {}, &m, 1), 1);
        ASSERT_EQ(m.count, 4);
        if (i == 0) first = ids(m);
        EXPECT_EQ(ids(m), first);
    }
}

TEST(BoxBox, CornersPassingEachOtherAtADistanceAreSeen) {
    // Apart in two directions, the faces overlap in none: the nearest corners are found all the same.
    Solid box(Box{{0.5f, 0.5f, 0.5f}});
    Manifold m = manifold(pair_of({box, identity}, {box, identity}, {1.3f, 1.4f, 0.0f}, 0.6f));
    ASSERT_GE(m.count, 1);
    expect_near(m.normal, {0.6f, 0.8f, 0.0f}, 1e-4f);
    EXPECT_NEAR(deepest(m), 0.5f, 1e-5f);
    EXPECT_EQ(manifold(pair_of({box, identity}, {box, identity}, {1.3f, 1.4f, 0.0f}, 0.45f)).count, 0);
}

TEST(BoxBox, DegenerateInput) {
    Random random(17);
    for (Vec3 half :
         {Vec3{1.0f, 1e-4f, 1.0f}, Vec3{1e-4f, 1e4f, 1e-4f}, Vec3{1e4f, 1.0f, 1e4f}, Vec3{0.5f, 0.5f, 0.5f}}) {
        Solid a(Box{half}), b(Box{{0.5f, 1e-3f, 0.5f}});
        for (int i = 0; i < 300; ++i) {
            Quat qa = random.rotation(), qb = i % 3 == 0 ? qa : random.rotation();
            Vec3 offset = i % 2 == 0 ? Vec3{} : multiply(half, random.vector(-1.0f, 1.0f));
            for (const Solid* other : {&a, &b}) {
                Manifold m = manifold(pair_of({a, qa}, {*other, qb}, rotate(qa, offset), 0.01f));
                bool same_centre = i % 2 == 0;
                EXPECT_TRUE(m.count > 0 || !same_centre);
                if (m.count > 0) {
                    ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.01f));
                }
            }
        }
    }
}

}  // namespace
