// Cylinders, cones and tapered capsules: against closed forms where there are some, against the certificate everywhere.
#include <cmath>

#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

// A random direction of the whole sphere never needs less depth than the answer says.
void expect_least_depth(Tally& tally, Random& random, const Core& a, const Core& b, const Transform& t,
                        const ConvexDistance& r) {
    if (r.distance >= 0.0f) return;
    oracle::Pose pose = oracle_pose(t);
    auto support = [](const Core& core, oracle::Vec n) {
        return core.curved ? oracle::support(*core.curved, n) : oracle::support(core.body, n);
    };
    double s = a.size + b.size;
    for (int i = 0; i < 60; ++i) {
        // Half of the tries close to the normal, at all angles down to a thousandth of a radian.
        float spread = random.log_uniform(1e-3f, 1.0f);
        Vec3 n = i % 2 ? random.direction() : normalize(r.normal + spread * random.direction());
        oracle::Vec wide_n = (1 / norm(wide(n))) * wide(n);
        oracle::Vec back{dot(pose.columns[0], wide_n), dot(pose.columns[1], wide_n), dot(pose.columns[2], wide_n)};
        oracle::Real separation =
            dot(wide_n, pose.translation) - support(b, oracle::Real(-1) * back) - support(a, wide_n);
        if (separation > r.distance + 1e-5L * s) return tally.fail("a direction needs less depth", a, b, t, r);
    }
}

float wanted_distance(Random& random, int regime, float scale) {
    switch (regime) {
        case 0:
            return scale * random.uniform(0.1f, 2.0f);
        case 1:
            return scale * random.log_uniform(1e-4f, 1e-2f);
        case 2:
            return 0.0f;
        case 3:
            return -scale * random.uniform(1e-3f, 0.05f);
        default:
            return -scale * random.uniform(0.1f, 0.5f);
    }
}

TEST(GjkCurved, PointsAgreeWithTheClosedForm) {
    Random random(5);
    for (float scale : scales) {
        Tally tally("point, tapered " + std::to_string(scale));
        for (int i = 0; i < cases(3000); ++i) {
            Core a = random_tapered(random, scale), b = make_point();
            Transform t{scale * random.uniform(0, 2) * random.direction(), random.rotation()};
            if (random.integer(2)) t = place(random, a, b, wanted_distance(random, random.integer(5), scale));
            oracle::Answer answer{oracle::signed_distance(*a.curved, wide(t.translation)), {}, {}};
            for (SimplexSolver method : both_methods) {
                ConvexDistance r = query(a, b, t, method);
                answer.normal = wide(r.normal);  // its direction is judged by the certificate
                tally.judge(a, b, t, r, answer);
                expect_least_depth(tally, random, a, b, t, r);
            }
        }
        EXPECT_LE(tally.max_expansions, 64);
    }
}

TEST(GjkCurved, NormalsOfPointsAgreeWithTheClosedForm) {
    Random random(6);
    double worst = 0.0;
    for (int i = 0; i < cases(3000); ++i) {
        Core a = random_tapered(random, 1.0f), b = make_point();
        Transform t = place(random, a, b, random.log_uniform(1e-5f, 1.0f));
        oracle::Vec p = wide(t.translation);
        // Gradient of the closed form by central differences.
        oracle::Real h = 1e-9L, d = oracle::signed_distance(*a.curved, p);
        if (d < 1e-5L) continue;
        auto along = [&](oracle::Vec step) {
            return (oracle::signed_distance(*a.curved, p + step) - oracle::signed_distance(*a.curved, p - step)) /
                   (2 * h);
        };
        oracle::Vec n{along({h, 0, 0}), along({0, h, 0}), along({0, 0, h})};
        for (SimplexSolver method : both_methods) {
            oracle::Real angle = norm(cross(wide(query(a, b, t, method).normal), n)) * 57.3L;
            worst = std::max(worst, static_cast<double>(angle));
        }
    }
    EXPECT_LE(worst, 0.05) << "degrees";
}

TEST(GjkCurved, SegmentsAgreeWithTheClosedForm) {
    Random random(7);
    Tally tally("segments");
    for (int i = 0; i < cases(10000); ++i) {
        Core a = make_segment(random.uniform(0.1f, 1)), b = make_segment(random.uniform(0.1f, 1));
        Transform t{random.uniform(0, 2) * random.direction(), random.rotation()};
        if (random.integer(4) == 0) t.rotation = rotation_about({1, 0, 0}, random.log_uniform(1e-7f, 1e-2f));
        oracle::Pose pose = oracle_pose(t);
        oracle::Real truth = oracle::segment_distance({}, {0, a.geometry.size.y, 0}, pose.translation,
                                                      oracle::Real(b.geometry.size.y) * pose.columns[1]);
        for (SimplexSolver method : both_methods) {
            ConvexDistance r = query(a, b, t, method);
            tally.judge(a, b, t, r, {truth, wide(r.normal), -1e300L});
        }
    }
}

template <class MakeOther>
void certify_pairs(const std::string& name, int count, MakeOther make_other) {
    Random random(8);
    for (float scale : scales) {
        Tally tally(name + " " + std::to_string(scale));
        for (int i = 0; i < count; ++i) {
            Core a = random_tapered(random, scale), b = make_other(random, scale);
            if (random.integer(2)) std::swap(a, b);
            Transform t = place(random, a, b, wanted_distance(random, i % 5, scale));
            for (SimplexSolver method : both_methods) {
                ConvexDistance r = query(a, b, t, method);
                tally.certify(a, b, t, r);
                expect_least_depth(tally, random, a, b, t, r);
            }
        }
        EXPECT_LE(tally.max_expansions, 64);
        EXPECT_LE(tally.max_iterations, 64);
    }
}

TEST(GjkCurved, PairsOfCurvedCoresAreCertified) {
    certify_pairs("tapered, tapered", cases(33400),
                  [](Random& random, float scale) { return random_tapered(random, scale); });
}
TEST(GjkCurved, CurvedCoresAndBoxesAreCertified) {
    certify_pairs("tapered, box", cases(33400), [](Random& random, float scale) { return random_box(random, scale); });
}
TEST(GjkCurved, CurvedCoresAndSegmentsAreCertified) {
    certify_pairs("tapered, segment", cases(33400),
                  [](Random& random, float scale) { return make_segment(scale * random.uniform(0.25f, 1)); });
}
TEST(GjkCurved, CurvedCoresAndHullsAreCertified) {
    certify_pairs("tapered, hull", cases(6700),
                  [](Random& random, float scale) { return random_hull(random, scale, 20); });
}

// Pairs whose difference has a valley of directions that are nearly as good, with several minima, of which the full
// polytope of EPA proves none; and two that nearly touch along a rim, where GJK's distance falls by less than rounding
// before its direction is right. True distances by search from 20000 directions.
TEST(GjkCurved, ValleysAndRimsThatOnceMisledAreCertified) {
    struct Known {
        Core a, b;
        Transform b_in_a;
        float distance;
    };
    auto balls = [](float bottom, float half, float top) { return make_tapered(true, bottom, half, top); };
    auto discs = [](float bottom, float half, float top) { return make_tapered(false, bottom, half, top); };
    const Known known[] = {
        {balls(0.378327847f, 0.897848725f, 0.378327847f),
         discs(0.870349348f, 0.821593881f, 0.916896105f),
         {{0.682721376f, 0.733158231f, 1.00772452f}, {0.336378217f, -0.137992471f, 0.00166574481f, -0.931560457f}},
         -0.381308820f},
        {discs(0.0f, 0.280073017f, 0.483266354f),
         discs(0.490417928f, 0.423519611f, 0.490417928f),
         {{-0.10984236f, 0.360191226f, -0.595852256f}, {-0.629902959f, 0.672002316f, 0.0517806597f, 0.385945588f}},
         -0.480168698f},
        {balls(4282.81152f, 6343.87012f, 0.0f),
         discs(5798.19922f, 9732.48145f, 0.0f),
         {{9623.2207f, -5085.13281f, -669.526367f}, {0.138627663f, -0.076347284f, 0.73839283f, 0.655537546f}},
         -4280.95556f},
        {discs(0.585555196f, 0.306161582f, 0.535092592f),
         balls(0.291090727f, 0.937970042f, 0.274044305f),
         {{0.824043453f, 0.990733385f, 0.00566008687f}, {-0.312137902f, -0.920416594f, 0.193410352f, 0.134147108f}},
         -0.291189976f},
        {make_box({0.878034472f, 0.985913515f, 0.69445461f}),
         discs(0.710915625f, 0.632181764f, 0.710915625f),
         {{0.820069551f, 1.66767859f, -1.35543191f}, {-0.699072838f, -0.452569783f, -0.539198697f, 0.125469074f}},
         -1.41607075e-7f},
        {make_box({4762.00049f, 8457.52637f, 6678.13232f}),
         discs(5490.76416f, 8467.7959f, 5490.76416f),
         {{-9104.22852f, 6392.04395f, -15551.1758f}, {-0.575192332f, -0.248451635f, 0.712896228f, 0.314967483f}},
         3.40447074e-4f}};
    Tally tally("valleys and rims");
    for (const Known& k : known)
        for (SimplexSolver method : both_methods) {
            ConvexDistance r = query(k.a, k.b, k.b_in_a, method);
            tally.judge(k.a, k.b, k.b_in_a, r, {k.distance, wide(r.normal), -1e300L});
        }
}

// A capsule lies between two edges of a tetrahedron and is nearly as deep in both: where the search begins decides
// which faces the polytope gets, but not which edge is found.
TEST(GjkCurved, DepthDoesNotDependOnWhereTheSearchBegins) {
    Core a = make_hull({{0.541480243f, 0.655487239f, 0.145861834f},
                        {-0.0411983281f, -0.501353323f, -0.125439584f},
                        {0.244601533f, 0.247089356f, 0.337952346f},
                        {0.310024649f, -0.598959565f, 0.251901299f}});
    Core b = make_tapered(true, 0.26586929f, 0.719809592f, 0.26586929f);
    const Transform b_in_a{{1.024104f, 0.907225966f, -0.299295545f},
                           {-0.684520662f, 0.554497659f, 0.466636747f, -0.078829363f}};
    Random random(37);
    for (int i = 0; i < cases(2000); ++i) {
        GjkCache start;
        start.count = static_cast<uint8_t>(random.integer(5));
        for (int k = 0; k < start.count; ++k) {
            start.a[k] = support_core(a.geometry, random.direction());
            start.b[k] = support_core(b.geometry, random.direction());
        }
        ConvexDistance r = distance({&a.geometry, &b.geometry, b_in_a}, start, both_methods[i % 2], 1e30f);
        ASSERT_NEAR(r.distance, -0.268506f, 1e-6f) << "start " << i;
    }
}

// Caps, rims and sides that meet exactly, concentric and coaxial bodies: every direction of a circle is as good.
TEST(GjkCurved, AlignedBodiesAgreeWithClosedForms) {
    for (SimplexSolver method : both_methods) {
        Core a = make_tapered(false, 0.5f, 1.0f, 0.5f), ball = make_tapered(true, 0.75f, 0.25f, 0.75f);
        Tally tally("aligned");
        auto check = [&](const Core& p, const Core& q, Transform t, float truth) {
            ConvexDistance r = query(p, q, t, method);
            tally.certify(p, q, t, r);
            EXPECT_NEAR(r.distance, truth, 1e-5f)
                << "at " << t.translation.x << ", " << t.translation.y << ", " << t.translation.z;
        };
        for (float gap : {0.5f, 1e-3f, 1e-6f, 0.0f, -1e-6f, -1e-3f, -0.2f}) {
            check(a, a, {{0, 2.0f + gap, 0}, {}}, gap);        // cap on cap
            check(a, a, {{0.3f, 2.0f + gap, 0.2f}, {}}, gap);  // caps that overlap in part
            check(a, a, {{1.0f + gap, 0, 0}, {}}, gap);        // side by side
            check(a, a, {{1.0f + gap, 0.5f, 0}, {}}, gap);
            check(a, a, {{1.0f + gap, 0, 0}, rotation_about({1, 0, 0}, 0.3f)}, gap);       // sides that cross
            check(a, a, {{0, 1.5f + gap, 0}, rotation_about({1, 0, 0}, 0.5f * pi)}, gap);  // side on cap
            check(a, ball, {{1.25f + gap, 0, 0}, {}}, gap);
            check(ball, ball, {{0, 2.0f + gap, 0}, {}}, gap);
        }
        check(a, a, {}, -1.0f);
        check(a, make_tapered(false, 0.1f, 0.2f, 0.1f), {}, -0.6f);
        check(ball, ball, {}, -1.5f);
        check(make_tapered(true, 1, 1e-3f, 1), make_tapered(true, 1, 1e-3f, 1), {}, -2.0f);  // nearly concentric balls
        check(a, make_point(), {{0.5f, 1.0f, 0}, {}}, 0.0f);                                 // on the rim
        check(a, make_point(), {}, -0.5f);
        check(make_tapered(false, 0.5f, 1, 0), make_point(), {{0, 1, 0}, {}}, 0.0f);  // at the tip
    }
}

}  // namespace
}  // namespace lendulet::gjk_test
