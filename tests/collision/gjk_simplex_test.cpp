// The two simplex solvers against each other and against the conditions that define the closest point: it is a convex
// combination of points of the simplex, and no point of the simplex lies nearer along its direction (Wolfe 1976).
#include <cmath>

#include "collision/simplex.h"
#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

struct Points {
    Vec3d y[4];
    int count;
    double size;
};

Vec3d random_point(Random& random, double scale) {
    return {scale * random.uniform(-1, 1), scale * random.uniform(-1, 1), scale * random.uniform(-1, 1)};
}

Points random_points(Random& random) {
    Points points;
    points.count = 1 + random.integer(4);
    Vec3d shift = random_point(random, random.integer(2) ? 0.3 : 2.0);
    for (int i = 0; i < points.count; ++i) points.y[i] = shift + random_point(random, 1.0);
    return points;
}

// Duplicates, collinear and coplanar points, slivers, points at and around the origin.
Points degenerate_points(Random& random) {
    Points points = random_points(random);
    points.count = 2 + random.integer(3);
    for (int i = 0; i < points.count; ++i) points.y[i] = random_point(random, 1.0);
    double noise[] = {0.0, 1e-16, 1e-12, 1e-8, 1e-4};
    double e = noise[random.integer(5)];
    int last = points.count - 1;
    switch (random.integer(5)) {
        case 0:
            points.y[last] = points.y[0] + random_point(random, e);
            break;
        case 1:
            points.y[last] = 0.5 * (points.y[0] + points.y[last - 1]) + random_point(random, e);
            break;
        case 2: {
            double s = random.uniform(-1, 2), t = random.uniform(-1, 2);
            Vec3d u = points.y[1] - points.y[0], v = points.y[last] - points.y[0];
            points.y[last] = points.y[0] + s * u + t * v + random_point(random, e);
            break;
        }
        case 3:
            points.y[random.integer(points.count)] = random_point(random, e);
            break;
        default:
            for (int i = 0; i < points.count; ++i) points.y[i].z = e * points.y[i].z;
    }
    return points;
}

void check(const Points& points, const SubSimplex& part, double tolerance, const char* name) {
    double size = 0.0, sum = 0.0;
    for (int i = 0; i < points.count; ++i) size = maximum(size, largest_component(points.y[i]));
    Vec3d combination{};
    for (int i = 0; i < part.count; ++i) {
        ASSERT_LT(part.index[i], points.count) << name;
        ASSERT_TRUE(i == 0 || part.index[i] > part.index[i - 1]) << name;
        ASSERT_GE(part.weight[i], 0.0) << name;
        sum += part.weight[i];
        combination += part.weight[i] * points.y[part.index[i]];
    }
    ASSERT_NEAR(sum, 1.0, 1e-12) << name;
    ASSERT_LE(length(combination - part.point), tolerance * size) << name;
    // Where the closest point is the origin but for rounding, its direction means nothing.
    double slack = tolerance * size * (length(part.point) + tolerance * size);
    for (int i = 0; i < points.count; ++i)
        ASSERT_GE(dot(part.point, points.y[i]), length_squared(part.point) - slack) << name;
}

void compare_solvers(int count, Points (*make)(Random&), double tolerance, uint64_t seed) {
    Random random(seed);
    for (int n = 0; n < count; ++n) {
        Points points = make(random);
        double size = 0.0;
        for (int i = 0; i < points.count; ++i) size = maximum(size, largest_component(points.y[i]));
        SubSimplex barycentric = closest_barycentric(points.y, points.count);
        SubSimplex half_space = closest_half_space(points.y, points.count);
        check(points, barycentric, tolerance, "barycentric");
        check(points, half_space, tolerance, "half-space");
        ASSERT_NEAR(length(barycentric.point), length(half_space.point), tolerance * size) << "case " << n;
        if (::testing::Test::HasFatalFailure()) FAIL() << "case " << n << " of " << points.count << " points";
    }
}

TEST(GjkSimplex, SolversAgreeOnRandomSimplices) { compare_solvers(cases(200000), random_points, 1e-10, 1); }

// Near the thresholds of flatness a part may be left out that would be nearer by a billionth of its size.
TEST(GjkSimplex, SolversAgreeOnDegenerateSimplices) { compare_solvers(cases(200000), degenerate_points, 1e-7, 2); }

TEST(GjkSimplex, SolversFindTheSamePartWhereItIsClear) {
    Random random(3);
    int inside = 0, clear = cases(20000);
    for (int n = 0; n < clear; ++n) {
        Points points = random_points(random);
        SubSimplex a = closest_barycentric(points.y, points.count), b = closest_half_space(points.y, points.count);
        double least = 1.0;
        for (int i = 0; i < a.count; ++i) least = minimum(least, a.weight[i]);
        for (int i = 0; i < b.count; ++i) least = minimum(least, b.weight[i]);
        if (least < 1e-6) continue;  // the closest point lies on the border of two parts
        ASSERT_EQ(a.count, b.count);
        for (int i = 0; i < a.count; ++i) {
            ASSERT_EQ(a.index[i], b.index[i]);
            ASSERT_NEAR(a.weight[i], b.weight[i], 1e-8);
        }
        inside += a.count == 4;
    }
    EXPECT_GT(inside, clear / 500);  // the case of the origin inside was among them
}

// One corner lies at 1e-12 of the others: reached from another, the closest point would be off by all of its distance.
TEST(GjkSimplex, PointsNearTheOriginKeepTheirDigits) {
    const Points face{{{-0x1.b44f68p-1, 0x1.f91d2cp-1, 0x1.2e62f8p-2},
                       {0x1.5c251cp-1, 0x1.9822d8p-2, 0x1.25bfacp-1},
                       {-0x1.5c872b68fd61fp-49, -0x1.e5ccd51f08f9ap-41, 0x1.4efb60ecfe684p-41},
                       {-0x1.9270c8p-2, -0x1.be94ap-4, -0x1.7e15ep-4}},
                      4,
                      1.0};
    const Points edge{{{0x1.5349f4p-1, -0x1.2c84ap-4, 0x1.a6a438p-1},
                       {-0x1.156414283d2a2p-40, -0x1.2cee5d51f6284p-41, 0x1.98b95b8c54153p-41},
                       {-0x1.76db8cp-1, -0x1.47ac8p-4, -0x1.fe5618p-2}},
                      3,
                      1.0};
    for (SimplexSolver method : both_methods)
        for (const Points& points : {face, edge}) {
            SubSimplex part = closest_sub_simplex(method, points.y, points.count);
            ASSERT_EQ(part.count, points.count - 1);
            for (int i = 0; i < part.count; ++i)
                ASSERT_NEAR(dot(part.point, points.y[part.index[i]]), length_squared(part.point), 1e-26);
        }
}

TEST(GjkSimplex, ExactCasesByHand) {
    const Vec3d y[4] = {{1, 1, 1}, {1, -1, 1}, {1, 0, -1}, {2, 0, 0}};
    for (SimplexSolver method : both_methods) {
        SubSimplex face = closest_sub_simplex(method, y, 4);  // the face x = 1, nearest at (1, 0, 0)
        ASSERT_EQ(face.count, 3);
        EXPECT_EQ(face.point.x, 1.0);
        EXPECT_EQ(face.point.y, 0.0);
        EXPECT_EQ(face.point.z, 0.0);
        EXPECT_EQ(face.weight[2], 0.5);
        const Vec3d around[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
        SubSimplex inside = closest_sub_simplex(method, around, 4);
        ASSERT_EQ(inside.count, 4);
        for (double weight : inside.weight) EXPECT_EQ(weight, 0.25);
    }
}

}  // namespace
}  // namespace lendulet::gjk_test
