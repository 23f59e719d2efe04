// Rays against every shape. The reference is the distance of the ray's points from the core in long double: a convex
// function of the fraction, whose first root is found by search and bisection.
#include <algorithm>

#include "collision/query/ray.h"
#include "family.h"
#include "geometry/hull.h"
#include "geometry/mesh.h"
#include "meshes.h"
#include "oracle.h"
#include "scale.h"

namespace pairs {
namespace {

using oracle::Real;
using oracle::Vec;

Vec wide(Vec3d v) { return {v.x, v.y, v.z}; }
Vec wide(Vec3 v) { return {v.x, v.y, v.z}; }

// Distance of a point from the core, 0 inside, by the oracle.
std::function<Real(Vec)> distance_from_core(const Geometry& g) {
    switch (g.kind) {
        case GeometryKind::point:
            return [](Vec p) { return oracle::norm(p); };
        case GeometryKind::segment: {
            Real h = g.size.y;
            return [h](Vec p) {
                Real y = p.y > h ? p.y - h : p.y < -h ? p.y + h : 0;
                return oracle::norm({p.x, y, p.z});
            };
        }
        case GeometryKind::box: {
            Vec half = wide(g.size);
            return [half](Vec p) {
                auto out = [](Real x, Real h) { return std::max(std::abs(x) - h, Real(0)); };
                return oracle::norm({out(p.x, half.x), out(p.y, half.y), out(p.z, half.z)});
            };
        }
        case GeometryKind::hull: {
            std::vector<Vec> corners;
            for (Vec3 v : g.hull->vertices) corners.push_back(wide(v));
            oracle::Body body = oracle::make_hull(corners);
            return [body](Vec p) { return oracle::outside(body, p); };
        }
        default: {
            oracle::Tapered t{g.kind == GeometryKind::tapered_capsule, g.size.x, g.size.y, g.size.z};
            return [t](Vec p) { return std::max(oracle::signed_distance(t, p), Real(0)); };
        }
    }
}

struct Reference {
    Real fraction;  // 2: none
    Real nearest;   // least distance from the solid's surface, outside
};
Reference first_root(const std::function<Real(Vec)>& core, Real rounding, const LocalRay& ray) {
    auto f = [&](Real t) { return core(wide(ray.origin) + t * wide(ray.translation)) - rounding; };
    if (f(0) <= 0) return {0, 0};
    Real lo = 0, hi = ray.max_fraction;
    for (int i = 0; i < 160; ++i) {
        Real a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
        Real fa = f(a), fb = f(b);
        if (fa <= 0) lo = hi = a;
        else if (fb <= 0) lo = hi = b;
        else if (fa <= fb) hi = b;
        else lo = a;
    }
    Real bottom = hi;
    if (f(bottom) > 0) return {2, f(bottom)};
    Real outside = 0, inside = bottom;
    for (int i = 0; i < 80; ++i) {
        Real m = (outside + inside) / 2;
        (f(m) > 0 ? outside : inside) = m;
    }
    return {inside, 0};
}

LocalRay random_ray(Random& random, double far) {
    Vec3 from = random.direction(), to = random.vector(-0.45f, 0.45f);
    LocalRay ray{far * to_double(from), {}, 1.0};
    ray.translation = to_double(to) - ray.origin;
    if (random.in(0, 1) < 0.2f) ray.translation = 0.6 * ray.translation;  // some end inside or before
    return ray;
}

TEST(Rays, MeetEveryShapeWhereTheDistanceVanishes) {
    for (const Kind& kind : every_kind()) {
        Solid solid(kind.shape);
        auto core = distance_from_core(solid.geometry);
        Random random(1);
        double worst = 0.0, worst_normal = 0.0;
        int hits = 0, misses = 0;
        for (int i = 0; i < scaled(1500, 60); ++i) {
            LocalRay ray = random_ray(random, i % 3 ? 2.0 : 30.0);
            Reference reference = first_root(core, solid.geometry.rounding, ray);
            LocalRayHit hit;
            bool met = cast_ray(solid.geometry, ray, hit);
            if (reference.fraction > 1.0L) {
                ++misses;
                if (reference.nearest > 1e-6L) {
                    EXPECT_FALSE(met) << kind.name << " case " << i;
                }
                continue;
            }
            ++hits;
            ASSERT_TRUE(met) << kind.name << " case " << i;
            Real size = oracle::norm(wide(ray.translation));
            Vec at = wide(ray.origin) + Real(hit.fraction) * wide(ray.translation);
            // The point lies on the surface. Along the ray, a grazing one may be off by more.
            worst = std::max(worst, double(std::abs(core(at) - solid.geometry.rounding)));
            EXPECT_LE(hit.fraction, double(reference.fraction) + 1e-5 / double(size)) << kind.name << " case " << i;
            EXPECT_NEAR(length(hit.normal), 1.0, 1e-6);
            EXPECT_LE(dot(hit.normal, ray.translation), 1e-6 * length(ray.translation));
            // A step along the normal leads away from the solid as fast as it can.
            Real step = 1e-3L;
            Real away = core(at + step * wide(hit.normal)) - core(at);
            if (!hit.inside && solid.geometry.rounding > 0.01f)
                worst_normal = std::max(worst_normal, double(std::abs(away - step) / step));
            if (!hit.inside) {
                EXPECT_GT(away, 0.5L * step) << kind.name << " case " << i;
            }
        }
        EXPECT_GT(hits, scaled(300, 8)) << kind.name;
        EXPECT_GT(misses, scaled(50, 1)) << kind.name;
        EXPECT_LT(worst, 2e-6) << kind.name;
        EXPECT_LT(worst_normal, 1e-3) << kind.name;
    }
}

TEST(Rays, StartInside) {
    for (const Kind& kind : every_kind()) {
        Solid solid(kind.shape);
        LocalRay ray{{0.01, 0.02, 0.0}, {0.3, -0.4, 0.0}, 1.0};
        LocalRayHit hit;
        ASSERT_TRUE(cast_ray(solid.geometry, ray, hit)) << kind.name;
        EXPECT_EQ(hit.fraction, 0.0) << kind.name;
        EXPECT_TRUE(hit.inside) << kind.name;
        EXPECT_NEAR(hit.normal.x, -0.6, 1e-12) << kind.name;
        EXPECT_NEAR(hit.normal.y, 0.8, 1e-12) << kind.name;
    }
}

TEST(Rays, OfNoReachMeetWhatTheyStartIn) {
    Solid box(Box{{0.5f, 0.5f, 0.5f}});
    LocalRayHit hit;
    EXPECT_TRUE(cast_ray(box.geometry, {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0}, hit));
    EXPECT_FALSE(cast_ray(box.geometry, {{0.501, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.0}, hit));
}

// Closed forms in the numbers of the case.
TEST(Rays, ExactFigures) {
    LocalRayHit hit;
    Solid ball(Sphere{0.5f});
    ASSERT_TRUE(cast_ray(ball.geometry, {{-3.0, 0.3, 0.0}, {6.0, 0.0, 0.0}, 1.0}, hit));
    EXPECT_NEAR(hit.fraction, (3.0 - std::sqrt(0.25 - 0.09)) / 6.0, 1e-14);
    EXPECT_NEAR(hit.normal.y, 0.6, 1e-12);
    Solid cone(Cone{1.0f, 1.0f});  // the side is x = (1 - y) / 2
    ASSERT_TRUE(cast_ray(cone.geometry, {{4.0, 0.5, 0.0}, {-4.0, 0.0, 0.0}, 1.0}, hit));
    EXPECT_NEAR(hit.fraction, 3.75 / 4.0, 1e-14);
    EXPECT_NEAR(hit.normal.x, 2.0 / std::sqrt(5.0), 1e-12);
    EXPECT_NEAR(hit.normal.y, 1.0 / std::sqrt(5.0), 1e-12);
    ASSERT_TRUE(cast_ray(cone.geometry, {{0.0, 3.0, 0.0}, {0.0, -4.0, 0.0}, 1.0}, hit));  // onto the tip
    EXPECT_NEAR(hit.fraction, 0.5, 1e-12);
    EXPECT_NEAR(hit.normal.y, 1.0, 1e-12);
    EXPECT_FALSE(cast_ray(cone.geometry, {{0.2, 3.0, 0.0}, {0.0, -2.3, 0.0}, 1.0}, hit));  // above the side: y = 0.6
    Solid plane(Plane{{0.0f, 2.0f, 0.0f}, 1.0f});                                          // y <= 0.5
    ASSERT_TRUE(cast_ray(plane.geometry, {{1.0, 2.0, 0.0}, {1.0, -3.0, 0.0}, 1.0}, hit));
    EXPECT_NEAR(hit.fraction, 0.5, 1e-7);
    EXPECT_FALSE(cast_ray(plane.geometry, {{1.0, 2.0, 0.0}, {1.0, 3.0, 0.0}, 1.0}, hit));
    EXPECT_FALSE(cast_ray(plane.geometry, {{1.0, 2.0, 0.0}, {1.0, 0.0, 0.0}, 1.0}, hit));
    EXPECT_TRUE(cast_ray(plane.geometry, {{1.0, -2.0, 0.0}, {1.0, 0.0, 0.0}, 1.0}, hit) && hit.inside);
}

// From 1000 km away the answer is as good as positions in double allow.
TEST(Rays, FromFarAway) {
    for (const Kind& kind : every_kind()) {
        Solid solid(kind.shape);
        LocalRayHit near, far;
        ASSERT_TRUE(cast_ray(solid.geometry, {{3.0, 0.1, 0.05}, {-3.0, 0.0, 0.0}, 1.0}, near)) << kind.name;
        ASSERT_TRUE(cast_ray(solid.geometry, {{1e6, 0.1, 0.05}, {-1e6, 0.0, 0.0}, 1.0}, far)) << kind.name;
        EXPECT_NEAR(3.0 - 3.0 * near.fraction, 1e6 - 1e6 * far.fraction, 1e-6) << kind.name;
    }
}

TEST(Rays, MeetTheFirstOfAMeshsTriangles) {
    TriangleMesh mesh =
        grid(24, 0.25f, [](float x, float z) { return 0.3f * sin_cos(2.0f * x).sin * sin_cos(1.7f * z).cos; });
    Solid solid(mesh);
    const MeshData& data = mesh.data();
    Random random(7);
    int hits = 0;
    for (int i = 0; i < scaled(3000, 100); ++i) {
        LocalRay ray{to_double(random.vector(-3.0f, 3.0f)), to_double(random.vector(-6.0f, 6.0f)), 1.0};
        Real best = 2;
        int32_t triangle = -1;
        for (const MeshTriangle& t : data.triangles) {
            Vec p[3];
            for (int k = 0; k < 3; ++k) p[k] = wide(data.vertices[t.vertex[k]]);
            Vec n = oracle::cross(p[1] - p[0], p[2] - p[0]), o = wide(ray.origin), d = wide(ray.translation);
            Real along = oracle::dot(n, d);
            if (along == 0) continue;
            Real f = oracle::dot(n, p[0] - o) / along;
            Vec at = o + f * d;
            bool in = f >= 0 && f <= 1;
            for (int k = 0; k < 3; ++k) in = in && oracle::dot(n, oracle::cross(p[(k + 1) % 3] - p[k], at - p[k])) >= 0;
            if (in && f < best) best = f, triangle = static_cast<int32_t>(t.original);
        }
        LocalRayHit hit;
        bool met = cast_ray(solid.geometry, ray, hit);
        ASSERT_EQ(met, triangle >= 0) << "case " << i;
        if (!met) continue;
        ++hits;
        EXPECT_NEAR(hit.fraction, double(best), 1e-12);
        EXPECT_EQ(hit.triangle, triangle);
        EXPECT_LE(dot(hit.normal, ray.translation), 0.0);
    }
    EXPECT_GT(hits, scaled(500, 15));
}

// Rays straight onto vertices and edges of a closed surface never slip through.
TEST(Rays, FindNoGapBetweenTriangles) {
    TriangleMesh mesh = flat_grid(16, 0.1f);
    Solid solid(mesh);
    Random random(3);
    for (int i = 0; i < scaled(20000, 500); ++i) {
        int a = static_cast<int>(random.in(1, 15.99f)), b = static_cast<int>(random.in(1, 15.99f));
        float step = 0.1f, start = -0.8f;
        float u = i % 3 == 0 ? 0.0f : random.in(0, 1), v = i % 3 == 1 ? 0.0f : i % 3 == 2 ? 1.0f - u : 0.0f;
        Vec3 target{start + step * static_cast<float>(a - 1) + u * step, 0.0f,
                    start + step * static_cast<float>(b - 1) + v * step};
        Vec3 from = target + random.in(0.5f, 5.0f) * normalize(Vec3{random.in(-1, 1), 1.0f, random.in(-1, 1)});
        LocalRay ray{to_double(from), 1.5 * (to_double(target) - to_double(from)), 1.0};
        LocalRayHit hit;
        EXPECT_TRUE(cast_ray(solid.geometry, ray, hit)) << "case " << i;
    }
}

TEST(Rays, AtHullsOfManyFaces) {
    ConvexHull round = ConvexHull::from_points(rock(5, 900, 0.5f)).value();
    ASSERT_GT(round.face_count(), 256);
    Solid solid(round);
    Random random(11);
    for (int i = 0; i < scaled(500, 30); ++i) {
        LocalRay ray = random_ray(random, 2.0);
        LocalRayHit hit;
        Chord chord;
        bool met = cast_ray(solid.geometry, ray, hit);
        bool crosses = chord_of_hull(ray, *solid.geometry.hull, chord) && chord.enter <= 1.0;
        if (crosses && chord.leave - chord.enter < 1e-3) continue;  // grazing
        ASSERT_EQ(met, crosses) << "case " << i;
        if (met) {
            EXPECT_NEAR(hit.fraction, chord.enter, 1e-5);
        }
    }
}

}  // namespace
}  // namespace pairs
