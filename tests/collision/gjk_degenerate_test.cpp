// The degenerate classes of the acceptance list: touching and coplanar features, equal shapes, slivers, extreme ratios
// of size, flat and duplicate points, nearly parallel faces, zero and denormal offsets. All against the oracle.
#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

constexpr Quat no_turn{};

struct Case {
    Core a, b;
    Transform t;
};

// Runs a class of cases; `make` may place B where it likes.
template <class Make>
void run_class(const char* name, int count, Make make) {
    Tally tally(name);
    Random random(17);
    for (int i = 0; i < count; ++i) {
        Case c = make(random);
        oracle::Answer answer = oracle_answer(c.a, c.b, c.t);
        for (SimplexSolver method : both_methods) tally.judge(c.a, c.b, c.t, query(c.a, c.b, c.t, method), answer);
    }
    EXPECT_LE(tally.max_iterations, 24) << name;
    EXPECT_LE(tally.max_expansions, 64) << name;
}

Quat quarter_turns(Random& random) {
    const float h = 0.70710678f;
    const Quat turns[6] = {{}, {h, 0, 0, h}, {0, h, 0, h}, {0, 0, h, h}, {1, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}};
    return turns[random.integer(6)];
}
// A coordinate that stands for touching exactly, or by little either way.
float about(Random& random, float touching) {
    const float by[7] = {0.0f, 1e-6f, -1e-6f, 1e-4f, -1e-4f, 1e-2f, -1e-2f};
    return touching * (1.0f + by[random.integer(7)]);
}

TEST(GjkDegenerate, FacesTouchingAndCoplanar) {
    run_class("faces touching", cases(10000), [](Random& random) {
        Case c{random_box(random, 1), random_box(random, 1), {{}, no_turn}};
        int i = random.integer(3), j = (i + 1) % 3;
        set_component(c.t.translation, i,
                      about(random, component(c.a.geometry.size, i) + component(c.b.geometry.size, i)));
        if (random.integer(2)) set_component(c.t.translation, j, random.uniform(-1, 1));
        if (random.integer(3) == 0)  // coplanar sides as well
            set_component(c.t.translation, j, component(c.a.geometry.size, j) - component(c.b.geometry.size, j));
        return c;
    });
}

TEST(GjkDegenerate, EdgesAndCornersMeeting) {
    run_class("edges and corners", cases(10000), [](Random& random) {
        Case c{random_box(random, 1), random_box(random, 1), {{}, quarter_turns(random)}};
        Vec3 b = absolute(rotate(c.t.rotation, c.b.geometry.size)), a = c.a.geometry.size;
        int features = 2 + random.integer(2);  // edge on edge, corner on corner
        for (int i = 0; i < features; ++i)
            set_component(c.t.translation, i, about(random, component(a, i) + component(b, i)));
        return c;
    });
}

TEST(GjkDegenerate, CrossingEdgesAtRightAngles) {
    run_class("edges crossing", cases(10000), [](Random& random) {
        // Both boxes stand on an edge, the edges cross above each other.
        Core a = make_box({0.5f, 0.5f, random.uniform(0.5f, 2)}), b = make_box({random.uniform(0.5f, 2), 0.5f, 0.5f});
        const float h = 0.38268343f, g = 0.92387953f;  // an eighth of a turn
        Transform t{{}, Quat{0, 0, -h, g} * Quat{h, 0, 0, g}};
        t.translation = rotate(Quat{0, 0, -h, g}, {0.0f, about(random, 1.41421356f), 0.0f});
        return Case{a, b, t};
    });
}

TEST(GjkDegenerate, PointsOnFacesEdgesAndCorners) {
    run_class("points on features", cases(10000), [](Random& random) {
        Case c{random_box(random, 1), make_point(), {{}, random.rotation()}};
        Vec3 h = c.a.geometry.size;
        for (int i = 0; i < 3; ++i) {
            int where = random.integer(4);
            float at = where == 0 ? -1.0f : where == 1 ? 0.0f : where == 2 ? 1.0f : random.uniform(-1, 1);
            set_component(c.t.translation, i, at * component(h, i));
        }
        return c;
    });
}

TEST(GjkDegenerate, SamePlaceSameShape) {
    run_class("same centre", cases(10000), [](Random& random) {
        Core a = random.integer(2) ? random_box(random, 1) : random_hull(random, 1, 16);
        Core b = random.integer(2) ? a : random_box(random, random.integer(2) ? 1.0f : 0.1f);
        return Case{a, b, {{}, random.integer(2) ? no_turn : random.rotation()}};
    });
}

TEST(GjkDegenerate, OneInsideTheOther) {
    run_class("inside", cases(10000), [](Random& random) {
        Core a = make_box({1, 1, 1}), b = random_box(random, 0.2f);
        return Case{a, b, {0.5f * random.uniform(0, 1) * random.direction(), random.rotation()}};
    });
}

TEST(GjkDegenerate, Slivers) {
    run_class("slivers", cases(10000), [](Random& random) {
        auto sliver = [&] {
            Vec3 half{random.uniform(0.5f, 1), random.uniform(0.5f, 1), random.uniform(0.5f, 1)};
            set_component(half, random.integer(3), 1e-4f);
            if (random.integer(3) == 0) set_component(half, random.integer(3), 1e-4f);
            return make_box(half);
        };
        Core a = sliver(), b = sliver();
        float by[5] = {0.3f, 1e-3f, 0.0f, -5e-5f, -1e-4f};
        return Case{a, b, place(random, a, b, by[random.integer(5)])};
    });
}

TEST(GjkDegenerate, TinyAgainstHuge) {
    run_class("tiny on huge", cases(10000), [](Random& random) {
        Core a = make_box({1e4f, 1e4f, random.integer(2) ? 1e4f : 1e-3f}), b = random_box(random, 1e-3f);
        float by[4] = {1.0f, 1e-3f, 0.0f, -3e-4f};
        Transform t = place(random, a, b, by[random.integer(4)]);
        if (random.integer(2)) std::swap(a, b), t = inverse(t);
        return Case{a, b, t};
    });
}

TEST(GjkDegenerate, FlatHullsNeedlesAndPoints) {
    run_class("flat cores", cases(10000), [](Random& random) {
        auto flat = [&] {
            std::vector<Vec3> points;
            int count = 1 + random.integer(3);
            for (int i = 0; i < count; ++i) points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), 0.0f});
            return count == 3 && random.integer(2) ? make_triangle(points[0], points[1], points[2])
                                                   : make_hull(points, true);
        };
        Core a = flat(), b = random.integer(3) ? flat() : random_box(random, 1);
        // In the same plane, in planes that cross, or anywhere.
        Transform t{{random.uniform(-1, 1), random.uniform(-1, 1), 0.0f}, no_turn};
        int how = random.integer(4);
        if (how == 1) t.rotation = {0, 0, 0.6f, 0.8f};
        if (how == 2) t.rotation = quarter_turns(random);
        if (how == 3) t = {random.direction(), random.rotation()};
        if (random.integer(5) == 0) t.translation = {};
        return Case{a, b, t};
    });
}

TEST(GjkDegenerate, DuplicateAndInteriorPoints) {
    run_class("duplicates", cases(300), [](Random& random) {
        auto hull = [&] {
            std::vector<Vec3> points;
            int count = 4 + random.integer(8);
            for (int i = 0; i < count; ++i) points.push_back(random.direction());
            for (int i = 0; i < 3; ++i) points.push_back(points[random.integer(count)]);
            for (int i = 0; i < 3; ++i) points.push_back(points[random.integer(count)] + 1e-7f * random.direction());
            for (int i = 0; i < 3; ++i) points.push_back(0.3f * (points[i] + points[i + 1]));
            return make_hull(points);
        };
        Core a = hull(), b = hull();
        float by[4] = {0.3f, 1e-3f, 0.0f, -0.2f};
        return Case{a, b, place(random, a, b, by[random.integer(4)])};
    });
}

TEST(GjkDegenerate, NearlyParallelFaces) {
    run_class("nearly parallel", cases(10000), [](Random& random) {
        Core a = random_box(random, 1), b = random_box(random, 1);
        float tilt = random.log_uniform(1e-7f, 1e-3f);
        Transform t{{random.uniform(-0.3f, 0.3f), 0, random.uniform(-0.3f, 0.3f)},
                    rotation_about(random.direction(), tilt)};
        t.translation.y = about(random, a.geometry.size.y + b.geometry.size.y);
        return Case{a, b, t};
    });
}

TEST(GjkDegenerate, DenormalAndSignedZeroOffsets) {
    run_class("denormal offsets", cases(10000), [](Random& random) {
        const float tiny[6] = {0.0f, -0.0f, 1e-45f, -1e-40f, 1e-38f, 1e-30f};
        Core a = random_box(random, 1), b = random.integer(2) ? a : random_box(random, 1);
        Transform t{{}, random.integer(2) ? no_turn : random.rotation()};
        for (int i = 0; i < 3; ++i) set_component(t.translation, i, tiny[random.integer(6)]);
        if (random.integer(2)) t.translation.y += a.geometry.size.y + b.geometry.size.y;
        return Case{a, b, t};
    });
}

// Far from anything only the relative placement counts, so distance from the world's origin cannot matter; here the
// local points themselves are far from the shape's origin.
TEST(GjkDegenerate, HullsFarFromTheirOrigin) {
    run_class("far hulls", cases(200), [](Random& random) {
        Vec3 away = 100.0f * random.direction();
        auto hull = [&] {
            std::vector<Vec3> points;
            for (int i = 0; i < 8; ++i) points.push_back(away + random.direction());
            return make_hull(points);
        };
        return Case{hull(), hull(), {random.uniform(0, 3) * random.direction(), no_turn}};
    });
}

// Many faces at nearly one depth: more than the polytope has expansions for.
TEST(GjkDegenerate, RoundHullsInsideEachOther) {
    auto ball = [](Random& random, int corners) {
        std::vector<Vec3> points;
        for (int i = 0; i < corners; ++i) points.push_back(random.direction());
        return make_hull(points);
    };
    auto make = [&](Random& random, int corners) {
        Core a = ball(random, corners), b = ball(random, corners);
        return Case{a, b, {random.log_uniform(1e-4f, 0.3f) * random.direction(), random.rotation()}};
    };
    run_class("round hulls", cases(30), [&](Random& random) { return make(random, 16); });
    Tally tally("rounder hulls");  // too many directions for the oracle
    Random random(18);
    for (int i = 0; i < cases(200); ++i) {
        Case c = make(random, 64);
        tally.certify(c.a, c.b, c.t, query(c.a, c.b, c.t, both_methods[i % 2]));
    }
    EXPECT_LE(tally.max_expansions, 64);
}

TEST(GjkDegenerate, NormalsOfFlatDifferencesAreChosenAlike) {
    for (SimplexSolver method : both_methods) {
        Core point = make_point(), segment = make_segment(1.0f);
        ConvexDistance same = query(point, point, {}, method);
        EXPECT_EQ(same.distance, 0.0f);
        EXPECT_EQ(length(same.normal), 1.0f);
        // Two segments that cross: the normal is perpendicular to both.
        ConvexDistance crossing = query(segment, segment, {{}, rotation_about({0, 0, 1}, 0.5f * pi)}, method);
        EXPECT_NEAR(crossing.distance, 0.0f, 1e-7f);
        EXPECT_NEAR(absolute(crossing.normal.z), 1.0f, 1e-6f);
        // One segment lies in the other: perpendicular to their line.
        ConvexDistance along = query(segment, segment, {{0, 0.5f, 0}, {}}, method);
        EXPECT_EQ(along.distance, 0.0f);
        EXPECT_NEAR(along.normal.y, 0.0f, 1e-7f);
        EXPECT_NEAR(length(along.normal), 1.0f, 1e-6f);
        // The side is that of the centres where there is one.
        Core flat = make_triangle({-1, 0, -1}, {1, 0, -1}, {0, 0, 1});
        ConvexDistance above = query(flat, make_box({0.1f, 0.1f, 0.1f}), {{0, 0.05f, 0}, {}}, method);
        EXPECT_NEAR(above.normal.y, 1.0f, 1e-6f);
        EXPECT_NEAR(above.distance, -0.05f, 1e-7f);
    }
}

}  // namespace
}  // namespace lendulet::gjk_test
