// Spheres and capsules against each other and against boxes: exact answers by hand.
#include "pairs.h"

using namespace pairs;

namespace {

const Quat along_x = rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi);  // turns the axis y to -x

void expect_point(const Manifold& m, Vec3 position, float separation, Vec3 normal) {
    ASSERT_EQ(m.count, 1);
    expect_near(m.normal, normal, 1e-6f, "normal");
    expect_near(m.points[0].position, position, 2e-6f, "position");
    EXPECT_NEAR(m.points[0].separation, separation, 2e-6f);
}

TEST(Balls, SphereSphere) {
    Solid a(Sphere{1.0f}), b(Sphere{0.5f});
    Manifold m = manifold(pair_of({a, identity}, {b, identity}, {1.4f, 0.0f, 0.0f}, 0.0f));
    expect_point(m, {0.95f, 0.0f, 0.0f}, -0.1f, {1.0f, 0.0f, 0.0f});
    EXPECT_EQ(m.radius_a, 1.0f);
    EXPECT_EQ(m.radius_b, 0.5f);
    EXPECT_NEAR(m.follow, 2.0f / 3.0f, 1e-6f);
    EXPECT_EQ(manifold(pair_of({a, identity}, {b, identity}, {0.0f, 1.7f, 0.0f}, 0.1f)).count, 0);
    EXPECT_EQ(manifold(pair_of({a, identity}, {b, identity}, {0.0f, 1.7f, 0.0f}, 0.3f)).count, 1);
}

TEST(Balls, SameCentreHasAFixedNormal) {
    Solid a(Sphere{1.0f}), b(Sphere{0.5f});
    Manifold m = manifold(pair_of({a, identity}, {b, identity}, {}, 0.0f));
    expect_point(m, {0.0f, 0.25f, 0.0f}, -1.5f, {0.0f, 1.0f, 0.0f});
}

TEST(Balls, CapsuleSphere) {
    Solid a(Capsule{1.0f, 0.25f}), b(Sphere{0.5f});
    // Beside the cylinder, beyond the end, and from the other side of the pair.
    expect_point(manifold(pair_of({a, identity}, {b, identity}, {0.7f, 0.5f, 0.0f}, 0.0f)), {0.225f, 0.5f, 0.0f},
                 -0.05f, {1.0f, 0.0f, 0.0f});
    expect_point(manifold(pair_of({a, identity}, {b, identity}, {0.0f, 1.7f, 0.0f}, 0.0f)), {0.0f, 1.225f, 0.0f},
                 -0.05f, {0.0f, 1.0f, 0.0f});
    expect_point(manifold(pair_of({b, identity}, {a, identity}, {-0.7f, -0.5f, 0.0f}, 0.0f)), {-0.475f, 0.0f, 0.0f},
                 -0.05f, {-1.0f, 0.0f, 0.0f});
    // On the axis the sphere goes out sideways.
    Manifold m = manifold(pair_of({a, identity}, {b, identity}, {0.0f, 0.3f, 0.0f}, 0.0f));
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.normal.y, 0.0f, 1e-6f);
    EXPECT_NEAR(m.points[0].separation, -0.75f, 1e-6f);
}

TEST(Balls, CrossedCapsulesTouchInAPoint) {
    Solid a(Capsule{1.0f, 0.25f}), b(Capsule{1.0f, 0.25f});
    Manifold m = manifold(pair_of({a, identity}, {b, along_x}, {0.0f, 0.2f, 0.45f}, 0.0f));
    expect_point(m, {0.0f, 0.2f, 0.225f}, -0.05f, {0.0f, 0.0f, 1.0f});
    EXPECT_EQ(m.follow, 0.5f);
    // Axes that meet: out along the common perpendicular.
    m = manifold(pair_of({a, identity}, {b, along_x}, {}, 0.0f));
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(absolute(m.normal.z), 1.0f, 1e-6f);
    EXPECT_NEAR(m.points[0].separation, -0.5f, 1e-6f);
}

TEST(Balls, ParallelCapsulesTouchAlongALine) {
    Solid a(Capsule{1.0f, 0.25f}), b(Capsule{0.5f, 0.5f});
    for (Quat turn : {identity, rotation_about({1.0f, 0.0f, 0.0f}, pi)}) {  // and head to foot
        Manifold m = manifold(pair_of({a, identity}, {b, turn}, {0.7f, 0.8f, 0.0f}, 0.0f));
        ASSERT_EQ(m.count, 2);
        expect_near(m.normal, {1.0f, 0.0f, 0.0f}, 1e-6f);
        expect_near(m.points[0].position, {0.225f, 0.3f, 0.0f}, 1e-5f);
        expect_near(m.points[1].position, {0.225f, 1.0f, 0.0f}, 1e-5f);
        for (int i = 0; i < 2; ++i) EXPECT_NEAR(m.points[i].separation, -0.05f, 1e-6f);
    }
    // End to end in one line there is no stretch to share; side by side beyond the ends neither.
    EXPECT_EQ(manifold(pair_of({a, identity}, {b, identity}, {0.0f, 2.2f, 0.0f}, 0.0f)).count, 1);
    EXPECT_EQ(manifold(pair_of({a, identity}, {b, identity}, {0.3f, 1.9f, 0.0f}, 0.0f)).count, 1);
    EXPECT_EQ(manifold(pair_of({a, identity}, {a, identity}, {}, 0.0f)).count, 2);
}

TEST(Balls, BoxSphere) {
    Solid box(Box{{1.0f, 2.0f, 3.0f}}), ball(Sphere{0.5f});
    auto at = [&](Vec3 p) { return manifold(pair_of({box, identity}, {ball, identity}, p, 1e-5f)); };
    expect_point(at({1.4f, 1.0f, 1.0f}), {0.95f, 1.0f, 1.0f}, -0.1f, {1.0f, 0.0f, 0.0f});
    EXPECT_EQ(at({1.4f, 1.0f, 1.0f}).follow, 1.0f);
    expect_point(at({1.3f, 2.4f, 0.0f}), {1.0f, 2.0f, 0.0f}, 0.0f, {0.6f, 0.8f, 0.0f});
    EXPECT_EQ(at({1.3f, 2.399f, 0.0f}).follow, 0.5f);
    EXPECT_EQ(at({1.1f, 2.1f, 3.1f}).follow, 0.0f);
    // The centre inside: out through the nearest face.
    expect_point(at({0.75f, 0.0f, 0.0f}), {0.625f, 0.0f, 0.0f}, -0.75f, {1.0f, 0.0f, 0.0f});
    expect_point(at({}), {0.25f, 0.0f, 0.0f}, -1.5f, {1.0f, 0.0f, 0.0f});
    // Seen from the ball, and a turned box.
    expect_point(manifold(pair_of({ball, identity}, {box, identity}, {-1.4f, 0.0f, 0.0f}, 0.0f)), {-0.45f, 0.0f, 0.0f},
                 -0.1f, {-1.0f, 0.0f, 0.0f});
    expect_point(manifold(pair_of({box, along_x}, {ball, identity}, {2.4f, 0.0f, 0.0f}, 0.0f)), {1.95f, 0.0f, 0.0f},
                 -0.1f, {1.0f, 0.0f, 0.0f});
}

TEST(Balls, RoundedBoxSphere) {
    Solid box(Box{{1.0f, 1.0f, 1.0f}, 0.25f}), ball(Sphere{0.5f});
    Manifold m = manifold(pair_of({box, identity}, {ball, identity}, {1.3f, 1.4f, 0.0f}, 0.0f));
    expect_point(m, {1.075f, 1.1f, 0.0f}, -0.25f, {0.6f, 0.8f, 0.0f});
    EXPECT_EQ(m.radius_a, 0.25f);
}

}  // namespace
