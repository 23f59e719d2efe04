// Shape casts, by their certificate: at the reported fraction the shapes are within a small part of their size, at
// every fraction before they are apart. Distances along the way come from the distance query, which is tested on its
// own, and for polytopes from the oracle.
#include "collision/query/cast.h"

#include <algorithm>

#include "collision/query/proximity.h"
#include "family.h"
#include "geometry/hull.h"
#include "geometry/triangle_surface.h"
#include "meshes.h"
#include "oracle.h"
#include "scale.h"

namespace pairs {
namespace {

double separation_at(const Geometry& a, const Motion& ma, const Geometry& b, const Motion& mb, double t) {
    auto origin = [t](const Motion& m) {
        return pivot_at(m, t) - exact_rotation(rotation_at(m, t)) * to_double(m.local_pivot);
    };
    Nearness n;
    EXPECT_TRUE(nearness({&a, &b, rotation_at(ma, t), rotation_at(mb, t), origin(mb) - origin(ma)}, 1e30, n));
    return n.distance;
}

struct Count {
    int hits = 0, misses = 0, inside = 0, most_rounds = 0;
    double worst = 0.0, rounds = 0.0;
};

void certify(const Geometry& a, const Motion& ma, const Geometry& b, const Motion& mb, double tolerance, int samples,
             const std::string& what, Count& count) {
    CastHit hit;
    bool met = cast_shapes(a, ma, b, mb, 1.0, hit);
    count.most_rounds = std::max(count.most_rounds, hit.rounds);
    count.rounds += hit.rounds;
    double end = met ? hit.fraction : 1.0;
    if (met && hit.overlapping) {
        ++count.inside;
        EXPECT_EQ(hit.fraction, 0.0) << what;
        EXPECT_LE(separation_at(a, ma, b, mb, 0.0), 1e-6) << what;
        return;
    }
    for (int i = 0; i < samples; ++i) {
        double t = end * i / samples;
        EXPECT_GT(separation_at(a, ma, b, mb, t), -1e-6) << what << " at " << t << " of " << end;
    }
    if (!met) {
        ++count.misses;
        EXPECT_GT(separation_at(a, ma, b, mb, 1.0), -1e-6) << what;
        return;
    }
    ++count.hits;
    double rest = separation_at(a, ma, b, mb, end);
    count.worst = std::max(count.worst, std::abs(rest));
    EXPECT_LE(std::abs(rest), tolerance) << what << " at " << end << " after " << hit.rounds;
    EXPECT_NEAR(length(hit.normal), 1.0, 1e-6) << what;
}

Motion random_motion(Random& random, bool turns, bool aimed) {
    Motion m;
    m.pivot = 2.0 * to_double(random.direction());
    m.rotation = random.rotation();
    m.translation = aimed ? to_double(random.vector(-0.5f, 0.5f)) - m.pivot : to_double(random.vector(-3.0f, 3.0f));
    if (turns) {
        m.axis = random.direction();
        m.angle = random.in(-4.0f, 4.0f);
        m.local_pivot = random.vector(-0.3f, 0.3f);
    }
    return m;
}

TEST(Casts, LinearOnesOfEveryPair) {
    std::vector<Kind> kinds = every_kind();
    Random random(5);
    Count count;
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            for (int i = 0; i < scaled(40, 2); ++i) {
                Motion still, moving = random_motion(random, false, i % 3 != 0);
                still.rotation = random.rotation();
                if (i % 10 == 9) moving.pivot = to_double(random.vector(-0.1f, 0.1f));
                certify(a.geometry, still, b.geometry, moving, 1e-5, 16,
                        std::string(ka.name) + " and " + kb.name + " case " + std::to_string(i), count);
            }
        }
    }
    EXPECT_GT(count.hits, scaled(1500, 80));
    EXPECT_GT(count.misses, scaled(500, 20));
    if (scaled(2) == 2) {  // a slow build meets none of these
        EXPECT_GT(count.inside, 300);
    }
    EXPECT_LT(count.most_rounds, 64);
    RecordProperty("worst_distance", std::to_string(count.worst));
}

TEST(Casts, TurningOnesOfEveryPair) {
    std::vector<Kind> kinds = every_kind();
    Random random(6);
    Count count;
    for (const Kind& ka : kinds) {
        for (const Kind& kb : kinds) {
            Solid a(ka.shape), b(kb.shape);
            for (int i = 0; i < scaled(20, 1); ++i) {
                Motion first, second = random_motion(random, true, i % 3 != 0);
                first.rotation = random.rotation();
                if (i % 2) first = random_motion(random, true, false), first.pivot = {}, first.translation = {};
                certify(a.geometry, first, b.geometry, second, 1e-4, 48,
                        std::string(ka.name) + " and " + kb.name + " case " + std::to_string(i), count);
            }
        }
    }
    if (scaled(2) == 2) {  // a slow build takes one case of each pair, most of which miss
        EXPECT_GT(count.hits, 700);
        EXPECT_GT(count.misses, 200);
    }
    EXPECT_LT(count.most_rounds, 400);
    if (std::getenv("LENDULET_TEST_REPORT"))
        std::printf("turning casts: mean %.1f rounds, most %d, worst distance %.2g\n",
                    count.rounds / (count.hits + count.misses), count.most_rounds, count.worst);
}

// The distance at the hit by the oracle, for boxes and rocks.
TEST(Casts, OfPolytopesByTheOracle) {
    Random random(9);
    Solid box(Box{{0.3f, 0.4f, 0.5f}}), stone(ConvexHull::from_points(rock(4, 24, 0.5f)).value());
    oracle::Body box_body = oracle::make_box({0.3f, 0.4f, 0.5f});
    std::vector<oracle::Vec> corners;
    for (Vec3 v : stone.geometry.hull->vertices) corners.push_back({v.x, v.y, v.z});
    oracle::Body rock_body = oracle::make_hull(corners);
    int hits = 0;
    for (int i = 0; i < scaled(150, 8); ++i) {
        Motion still, moving = random_motion(random, i % 2 == 1, true);
        moving.local_pivot = {};
        CastHit hit;
        if (!cast_convex(box.geometry, still, stone.geometry, moving, 1.0, hit) || hit.overlapping) continue;
        ++hits;
        auto at = [&](double t) {
            Quat q = rotation_at(moving, t);
            Vec3d x = pivot_at(moving, t);
            oracle::Body b = oracle::moved(rock_body, oracle::make_pose(q.x, q.y, q.z, q.w, {x.x, x.y, x.z}));
            return static_cast<double>(oracle::distance(box_body, b).distance);
        };
        EXPECT_LT(std::abs(at(hit.fraction)), 1e-4) << "case " << i;
        for (int k = 0; k < 4; ++k) EXPECT_GT(at(hit.fraction * (0.2 * k + 0.19)), 0.0) << "case " << i;
    }
    EXPECT_GT(hits, scaled(80, 3));
}

TEST(Casts, OntoPlanesAndMeshes) {
    Random random(12);
    Solid plane(Plane{{0.0f, 1.0f, 0.0f}, 0.1f});
    Solid mesh(grid(12, 0.3f, [](float x, float z) { return 0.2f * sin_cos(2.0f * x).sin * sin_cos(3.0f * z).sin; }));
    Count count;
    for (const Kind& k : every_kind()) {
        Solid b(k.shape);
        for (int i = 0; i < scaled(12, 1); ++i) {
            Motion still, moving = random_motion(random, i % 2 == 1, false);
            moving.pivot.y = 1.5;
            moving.translation.y = -2.0;
            certify(plane.geometry, still, b.geometry, moving, 1e-4, 16, std::string("plane and ") + k.name, count);
            certify(mesh.geometry, still, b.geometry, moving, 1e-4, 16, std::string("mesh and ") + k.name, count);
        }
    }
    EXPECT_GT(count.hits, scaled(150, 8));
}

// What is left out of a mesh could not have been met: its triangles one by one give the same.
TEST(Casts, OverAMeshAreThoseOverItsTriangles) {
    Random random(14);
    Solid mesh(grid(12, 0.3f, [](float x, float z) { return 0.2f * sin_cos(2.0f * x).sin * sin_cos(3.0f * z).sin; }));
    const TriangleSurface surface(mesh.geometry);
    int hits = 0, misses = 0;
    for (const Kind& k : every_kind()) {
        Solid b(k.shape);
        for (int i = 0; i < scaled(60, 6); ++i) {
            Motion still, moving = random_motion(random, i % 2 == 1, false);
            moving.pivot.y = i % 3 == 0 ? 0.9 : 0.6;
            moving.translation.y = i % 3 == 0 ? -0.5 : -0.1;
            CastHit hit, single, first;
            first.fraction = 2.0;
            for (uint32_t t = 0; t < surface.mesh()->triangles.size(); ++t) {
                Vec3 corners[3];
                surface.corners(t, corners);
                Geometry core;
                core.kind = GeometryKind::triangle;
                core.triangle = corners;
                if (cast_convex(core, still, b.geometry, moving, 1.0, single) && single.fraction < first.fraction)
                    first = single;
            }
            const bool met = cast_shapes(mesh.geometry, still, b.geometry, moving, 1.0, hit);
            EXPECT_EQ(met, first.fraction <= 1.0) << k.name << " " << i;
            if (met) {
                EXPECT_NEAR(hit.fraction, first.fraction, 1e-4) << k.name << " " << i;
            }
            ++(met ? hits : misses);
        }
    }
    EXPECT_GT(hits, scaled(100, 10));
    EXPECT_GT(misses, scaled(100, 10));
}

// A mesh that turns itself (on a kinematic body) against a shape that stands still.
TEST(Casts, OfATurningMesh) {
    Random random(13);
    Solid mesh(box_mesh({0.4f, 0.4f, 0.4f})), ball(Sphere{0.2f});
    Count count;
    for (int i = 0; i < scaled(60, 4); ++i) {
        Motion turning = random_motion(random, true, true), still;
        still.pivot = to_double(random.vector(-0.3f, 0.3f));
        certify(mesh.geometry, turning, ball.geometry, still, 1e-4, 32, "case " + std::to_string(i), count);
    }
    EXPECT_GT(count.hits, scaled(30, 2));
}

// Closed forms: balls, and a box onto a box.
TEST(Casts, ExactFigures) {
    CastHit hit;
    Solid big(Sphere{0.75f}), small(Sphere{0.25f});
    Motion still, moving;
    moving.pivot = {-4.0, 0.6, 0.0};
    moving.translation = {8.0, 0.0, 0.0};
    ASSERT_TRUE(cast_convex(big.geometry, still, small.geometry, moving, 1.0, hit));
    EXPECT_NEAR(hit.fraction, (4.0 - 0.8) / 8.0, 1e-7);
    EXPECT_NEAR(hit.normal.x, -0.8, 1e-5);
    EXPECT_NEAR(hit.point.y, 0.45, 1e-5);
    Solid box(Box{{0.5f, 0.5f, 0.5f}});
    moving.pivot = {0.2, 3.0, 0.1};
    moving.translation = {0.0, -4.0, 0.0};
    ASSERT_TRUE(cast_convex(box.geometry, still, box.geometry, moving, 1.0, hit));
    EXPECT_NEAR(hit.fraction, 0.5, 1e-6);
    EXPECT_NEAR(hit.normal.y, 1.0, 1e-9);
    // Touching and leaving is no hit, touching and approaching is one at once.
    moving.pivot = {0.0, 1.0, 0.0};
    moving.translation = {0.0, 1.0, 0.0};
    EXPECT_FALSE(cast_convex(box.geometry, still, box.geometry, moving, 1.0, hit));
    moving.translation = {0.0, -1.0, 0.0};
    ASSERT_TRUE(cast_convex(box.geometry, still, box.geometry, moving, 1.0, hit));
    EXPECT_LT(hit.fraction, 1e-5);
    EXPECT_FALSE(hit.overlapping);
    // A rod of length 2 turned by a right angle hits a pin 0.6 above its middle, 0.8 to the side: at atan(0.6 / 0.8).
    Solid rod(Capsule{1.0f, 0.01f}), pin(Sphere{0.01f});
    Motion turn;
    turn.rotation = rotation_about({0.0f, 0.0f, 1.0f}, -0.5f * pi);  // along x
    turn.axis = {0.0f, 0.0f, 1.0f};
    turn.angle = 0.5f * pi;
    still.pivot = {0.8, 0.6, 0.0};
    ASSERT_TRUE(cast_convex(pin.geometry, still, rod.geometry, turn, 1.0, hit));
    EXPECT_NEAR(hit.fraction * 0.5 * 3.14159265358979, std::atan2(0.6, 0.8) - std::asin(0.02), 2e-4);
}

TEST(Casts, AreSymmetric) {
    std::vector<Kind> kinds = every_kind();
    Random random(15);
    for (int i = 0; i < scaled(300, 20); ++i) {
        Solid a(kinds[static_cast<size_t>(i) % kinds.size()].shape);
        Solid b(kinds[static_cast<size_t>(i / 7) % kinds.size()].shape);
        Motion ma = random_motion(random, false, false), mb = random_motion(random, false, true);
        ma.pivot = {}, mb.translation = mb.translation + ma.translation;
        CastHit ab, ba;
        bool first = cast_convex(a.geometry, ma, b.geometry, mb, 1.0, ab);
        bool second = cast_convex(b.geometry, mb, a.geometry, ma, 1.0, ba);
        ASSERT_EQ(first, second) << "case " << i;
        if (!first || ab.overlapping) continue;
        EXPECT_NEAR(ab.fraction, ba.fraction, 1e-4) << "case " << i;
    }
}

}  // namespace
}  // namespace pairs
