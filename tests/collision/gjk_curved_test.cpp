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
