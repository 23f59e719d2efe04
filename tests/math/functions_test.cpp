// Trigonometry and rotations against the C library in long double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "lendulet/math.h"

namespace lendulet {
namespace {

// Distance of `value` from `exact` in units of the last place of the exact value as a float.
double ulps(float value, long double exact) {
    auto nearest = static_cast<float>(std::fabs(exact));
    float ulp = std::nextafter(nearest, std::numeric_limits<float>::infinity()) - nearest;
    return static_cast<double>(std::fabs(static_cast<long double>(value) - exact) / ulp);
}

double worst_sin_cos(float angle) {
    SinCos r = sin_cos(angle);
    long double x = angle;
    return std::max(ulps(r.sin, std::sin(x)), ulps(r.cos, std::cos(x)));
}

TEST(SinCosTest, WithinOneUlpInTheUsualRange) {
    std::mt19937 random(1);
    double worst = 0.0;
    for (float range : {1.0f, 10.0f, 1e3f, 1e4f}) {
        std::uniform_real_distribution<float> angles(-range, range);
        for (int i = 0; i < 100000; ++i) worst = std::max(worst, worst_sin_cos(angles(random)));
    }
    EXPECT_LT(worst, 0.51);
}

TEST(SinCosTest, WithinOneUlpAtMultiplesOfAQuarterTurn) {
    double worst = 0.0;
    for (int k = -7000; k <= 7000; ++k) {
        auto angle = static_cast<float>(k * 1.57079632679489661923L);
        for (int step = -2; step <= 2; ++step) {
            float a = angle;
            for (int i = 0; i < std::abs(step); ++i) a = std::nextafter(a, step < 0 ? -1e30f : 1e30f);
            worst = std::max(worst, worst_sin_cos(a));
        }
    }
    EXPECT_LT(worst, 0.51);
}

TEST(SinCosTest, HugeArgumentsOfEveryExponent) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> mantissas(1.0f, 2.0f);
    double worst = 0.0;
    for (int exponent = 15; exponent <= 127; ++exponent)
        for (int i = 0; i < 1000; ++i) {
            float a = std::ldexp(mantissas(random), exponent);
            worst = std::max({worst, worst_sin_cos(a), worst_sin_cos(-a)});
        }
    EXPECT_LT(worst, 0.51);
}

TEST(SinCosTest, BothReductionsAgreeAtTheirBorder) {
    float below = std::nextafter(1e6f, 0.0f);
    EXPECT_LT(worst_sin_cos(below), 0.51);
    EXPECT_LT(worst_sin_cos(1e6f), 0.51);
    EXPECT_LT(worst_sin_cos(-1e6f), 0.51);
}

TEST(SinCosTest, SpecialValues) {
    EXPECT_EQ(sin_cos(0.0f).sin, 0.0f);
    EXPECT_EQ(sin_cos(0.0f).cos, 1.0f);
    EXPECT_EQ(sin_cos(1e-40f).sin, 1e-40f);
    for (float a : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                    std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_TRUE(std::isnan(sin_cos(a).sin));
        EXPECT_TRUE(std::isnan(sin_cos(a).cos));
    }
}

TEST(ArcTangentTest, AgreesWithLongDouble) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> values(-1.0f, 1.0f);
    double worst = 0.0;
    for (int i = 0; i < 200000; ++i) {
        float y = std::ldexp(values(random), static_cast<int>(random() % 60) - 30);
        float x = std::ldexp(values(random), static_cast<int>(random() % 60) - 30);
        worst = std::max(worst, ulps(arc_tangent2(y, x), std::atan2(static_cast<long double>(y), x)));
    }
    EXPECT_LT(worst, 0.51);
}

TEST(ArcTangentTest, SpecialValues) {
    float infinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(arc_tangent2(0.0f, 0.0f), 0.0f);
    EXPECT_EQ(arc_tangent2(0.0f, 1.0f), 0.0f);
    EXPECT_EQ(arc_tangent2(0.0f, -1.0f), pi);
    EXPECT_EQ(arc_tangent2(-0.0f, -1.0f), pi);  // the range is half open
    EXPECT_EQ(arc_tangent2(1.0f, 0.0f), 0.5f * pi);
    EXPECT_EQ(arc_tangent2(-1.0f, 0.0f), -0.5f * pi);
    EXPECT_EQ(arc_tangent2(infinite, infinite), 0.25f * pi);
    EXPECT_EQ(arc_tangent2(1.0f, infinite), 0.0f);
    EXPECT_EQ(arc_tangent2(1e-40f, 1e-40f), 0.25f * pi);
    EXPECT_TRUE(std::isnan(arc_tangent2(std::numeric_limits<float>::quiet_NaN(), 1.0f)));
}

TEST(ArcCosineTest, AgreesWithLongDoubleAndClamps) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> values(-1.0f, 1.0f);
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i) {
        float x = values(random);
        worst = std::max(worst, ulps(arc_cosine(x), std::acos(static_cast<long double>(x))));
    }
    EXPECT_LT(worst, 0.51);
    EXPECT_LT(ulps(arc_cosine(0.99999994f), std::acos(0.99999994039535522461L)), 0.51);
    EXPECT_EQ(arc_cosine(1.0f), 0.0f);
    EXPECT_EQ(arc_cosine(5.0f), 0.0f);
    EXPECT_EQ(arc_cosine(-1.0f), pi);
    EXPECT_EQ(arc_cosine(-5.0f), pi);
}

Vec3 random_unit(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return normalize(Vec3{normal(random), normal(random), normal(random)});
}

TEST(RotationTest, AboutAnAxisTurnsByTheAngle) {
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
        Vec3 axis = random_unit(random), v = perpendicular(axis);
        float angle = std::uniform_real_distribution<float>(-pi, pi)(random);
        Quat q = rotation_about(3.0f * axis, angle);
        EXPECT_NEAR(dot(q, q), 1.0f, 3e-7f);
        Vec3 turned = rotate(q, v), w = cross(axis, v);
        EXPECT_NEAR(arc_tangent2(dot(turned, w), dot(turned, v)), angle, 2e-6f);
        EXPECT_LT(length(rotate(q, axis) - axis), 1e-6f);
    }
}

TEST(RotationTest, BetweenTakesOneOntoTheOther) {
    std::mt19937 random(6);
    for (int i = 0; i < 3000; ++i) {
        Vec3 a = random_unit(random), b = random_unit(random);
        if (i % 3 == 1) b = normalize(-a + std::ldexp(1.0f, -static_cast<int>(random() % 40)) * b);
        if (i % 3 == 2) b = normalize(a + std::ldexp(1.0f, -static_cast<int>(random() % 40)) * b);
        Quat q = rotation_between(a, b);
        EXPECT_NEAR(dot(q, q), 1.0f, 3e-7f);
        EXPECT_LT(length(rotate(q, a) - b), 1e-6f);
        // Shortest: the axis is at right angles to both.
        EXPECT_NEAR(dot(Vec3{q.x, q.y, q.z}, a), 0.0f, 1e-6f);
    }
    for (Vec3 a : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        EXPECT_LT(length(rotate(rotation_between(a, -a), a) + a), 1e-6f);
        EXPECT_EQ(rotation_between(a, a), (Quat{0, 0, 0, 1}));
    }
}

// Even turns: shares add up, the way is the shorter one, and both signs of a quaternion are the same rotation.
TEST(Interpolation, TurnsEvenlyByTheShorterWay) {
    std::mt19937 random(31);
    std::normal_distribution<float> component;
    auto pick = [&] {
        return normalize(Quat{component(random), component(random), component(random), component(random)});
    };
    for (int i = 0; i < 2000; ++i) {
        const Quat a = pick();
        const Vec3 axis = normalize(Vec3{component(random), component(random), component(random)});
        const float angle = std::ldexp(3.1f, -(i % 24)), t = 0.001f * static_cast<float>(i % 1001);
        const Quat b = rotation_about(axis, angle) * a;
        const Quat expected = rotation_about(axis, t * angle) * a;
        EXPECT_NEAR(absolute(dot(interpolate(a, b, t), expected)), 1.0f, 4e-7f);
        EXPECT_NEAR(absolute(dot(interpolate(a, {-b.x, -b.y, -b.z, -b.w}, t), expected)), 1.0f, 4e-7f);
        for (Vec3 v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}})
            EXPECT_LT(length(rotate(interpolate(a, b, t), v) - rotate(expected, v)), 2e-6f);
    }
    EXPECT_EQ(interpolate(Quat{}, Quat{}, 0.3f), Quat{});
    const Pose half = interpolate(Pose{{1, 2, 3}, {}}, Pose{{3, 2, -3}, rotation_about({0, 1, 0}, 1.0f)}, 0.5f);
    EXPECT_EQ(half.position, (Position{2, 2, 0}));
    EXPECT_NEAR(dot(half.orientation, rotation_about({0, 1, 0}, 0.5f)), 1.0f, 1e-7f);
}

}  // namespace
}  // namespace lendulet
