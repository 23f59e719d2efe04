// Every pair of convex kinds: manifolds that are sound, agree with the distance of the two shapes, mirror when the pair
// is swapped, and stand up to bad poses.
#include "family.h"

using namespace pairs;

namespace {

// Signed distance of two solids along the best direction.
float signed_distance(const Placed& a, const Placed& b, Vec3 offset) {
    GjkCache cache;
    Transform b_in_a{rotate_inverse(a.rotation, offset), conjugate(a.rotation) * b.rotation};
    const Geometry &ga = a.solid.geometry, &gb = b.solid.geometry;
    return distance({&ga, &gb, b_in_a}, cache, SimplexSolver::barycentric, 1e9f).distance - ga.rounding - gb.rounding;
}

TEST(ConvexPairs, PointsLieBetweenTheSurfaces) {
    Random random(23);
    std::vector<Kind> kinds = every_kind();
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            for (int i = 0; i < 60; ++i) {
                SCOPED_TRACE(testing::Message() << ka.name << " - " << kb.name << " case " << i);
                Placed pa{a, random.rotation()}, pb{b, random.rotation()};
                Vec3 offset = random.in(0.3f, 1.2f) * random.direction();
                const float margin = 0.05f;
                float expected = signed_distance(pa, pb, offset);
                Manifold m = manifold(pair_of(pa, pb, offset, margin));
                if (absolute(expected - margin) < 1e-4f) continue;
                ASSERT_EQ(m.count > 0, expected < margin);
                if (m.count == 0) continue;
                ASSERT_NO_FATAL_FAILURE(expect_sound(m, margin));
                // Preferred faces and fixed corners on round rims cost a little of the depth.
                EXPECT_NEAR(deepest(m), expected, 0.01f);
                for (int k = 0; k < m.count; ++k) {
                    Vec3 half_gap = (0.5f * m.points[k].separation) * m.normal;
                    EXPECT_LE(outside(pa, m.points[k].position - half_gap), 0.01f);
                    EXPECT_LE(outside(pb, m.points[k].position + half_gap - offset), 0.01f);
                }
            }
        }
    }
}

TEST(ConvexPairs, SwapMirrors) {
    Random random(31);
    std::vector<Kind> kinds = every_kind();
    int compared = 0, mirrored = 0;
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            for (int i = 0; i < 20; ++i) {
                Placed pa{a, random.rotation()}, pb{b, random.rotation()};
                Vec3 offset = random.in(0.5f, 1.1f) * random.direction();
                Manifold m = manifold(pair_of(pa, pb, offset, 0.05f)), back = manifold(pair_of(pb, pa, -offset, 0.05f));
                ASSERT_EQ(m.count > 0, back.count > 0) << ka.name << " - " << kb.name;
                if (m.count == 0) continue;
                EXPECT_NEAR(deepest(m), deepest(back), 0.01f) << ka.name << " - " << kb.name;
                if (dot(m.normal, back.normal) > -0.999f) continue;  // a tie of directions
                ++compared;
                mirrored += absolute(m.follow + back.follow - 1.0f) < 1e-5f;
            }
        }
    }
    EXPECT_GT(compared, 500);
    EXPECT_GT(mirrored, compared * 98 / 100);  // the rest are ties of reference faces
}

TEST(ConvexPairs, OverlapAgreesWithDistance) {
    Random random(37);
    std::vector<Kind> kinds = every_kind();
    kinds.push_back({"plane", Plane{{0.0f, 1.0f, 0.0f}, 0.1f}});
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            bool plane_a = a.geometry.kind == GeometryKind::plane, plane_b = b.geometry.kind == GeometryKind::plane;
            for (int i = 0; i < 20; ++i) {
                Placed pa{a, random.rotation()}, pb{b, random.rotation()};
                Vec3 offset = random.in(0.3f, 1.3f) * random.direction();
                PairCache cache;
                bool touching = overlap(pair_of(pa, pb, offset, 0.0f), cache, {});
                if (plane_a || plane_b) {
                    EXPECT_EQ(touching, manifold(pair_of(pa, pb, offset, 0.0f)).count > 0);
                    if (plane_a && plane_b) {
                        EXPECT_FALSE(touching);
                    }
                    continue;
                }
                float expected = signed_distance(pa, pb, offset);
                if (absolute(expected) > 1e-4f) {
                    EXPECT_EQ(touching, expected < 0.0f) << ka.name << " - " << kb.name << " " << expected;
                }
            }
        }
    }
}

TEST(ConvexPairs, BadPosesGiveSoundManifolds) {
    Random random(41);
    std::vector<Kind> kinds = every_kind();
    kinds.push_back({"slab", Box{{1.0f, 1e-4f, 1.0f}}});
    kinds.push_back({"needle", Cylinder{1.0f, 1e-4f}});
    kinds.push_back({"ground", Box{{1e4f, 1.0f, 1e4f}}});
    kinds.push_back({"grain", Box{{1e-3f, 1e-3f, 1e-3f}}});
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            for (int i = 0; i < 8; ++i) {
                SCOPED_TRACE(testing::Message() << ka.name << " - " << kb.name << " case " << i);
                // Same centre and pose, same centre, deep inside, same pose apart by a touch.
                Quat qa = random.rotation(), qb = i % 2 == 0 ? qa : random.rotation();
                Vec3 offset = i < 4 ? Vec3{} : 0.05f * random.direction();
                Manifold m = manifold(pair_of({a, qa}, {b, qb}, offset, 0.01f));
                ASSERT_GE(m.count, i < 4 ? 1 : 0);
                if (m.count > 0) {
                    ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.01f));
                }
            }
        }
    }
}

TEST(ConvexPairs, SphereOnAHullFaceAndCorner) {
    Solid cube(
        ConvexHull::from_points(
            std::vector<Vec3>{
                {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}})
            .value());
    Solid ball(Sphere{0.5f});
    Manifold m = manifold(pair_of({cube, {}}, {ball, {}}, {0.3f, 1.4f, 0.2f}, 0.0f));
    ASSERT_EQ(m.count, 1);
    expect_near(m.normal, {0.0f, 1.0f, 0.0f}, 1e-5f);
    expect_near(m.points[0].position, {0.3f, 0.95f, 0.2f}, 1e-5f);
    EXPECT_NEAR(m.points[0].separation, -0.1f, 1e-5f);
    EXPECT_EQ(m.follow, 1.0f);
    EXPECT_EQ(m.radius_b, 0.5f);
    m = manifold(pair_of({ball, {}}, {cube, {}}, {-1.2f, -1.2f, -1.2f}, 0.0f));
    ASSERT_EQ(m.count, 1);
    float third = -std::sqrt(1.0f / 3.0f);
    expect_near(m.normal, {third, third, third}, 1e-5f);
    EXPECT_EQ(m.follow, 1.0f);  // rides on the cube's corner
}

TEST(ConvexPairs, FacesKeepTheirNamesUnderSmallMotion) {
    Random random(43);
    Solid base(ConvexHull::from_points(octagonal_prism(1.0f, 0.5f)).value());
    Solid top(ConvexHull::from_points(octagonal_prism(0.4f, 0.3f)).value());
    PairCache cache;
    uint32_t names[4] = {};
    for (int i = 0; i < 100; ++i) {
        Vec3 offset{0.2f + random.in(-1e-3f, 1e-3f), 0.7999f + random.in(-1e-4f, 1e-4f), random.in(-1e-3f, 1e-3f)};
        Manifold m;
        Quat turn = rotation_about(random.direction(), 1e-4f);
        ASSERT_EQ(collide(pair_of({base, {}}, {top, turn}, offset, 0.02f), cache, {}, &m, 1), 1);
        ASSERT_EQ(m.count, 4);
        for (int k = 0; k < 4; ++k) {
            if (i == 0) names[k] = m.points[k].id;
            bool known = false;
            for (uint32_t name : names) known |= name == m.points[k].id;
            EXPECT_TRUE(known) << i;
        }
    }
}

}  // namespace
