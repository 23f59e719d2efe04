// ConvexHull::from_points: every kind of awkward cloud gives a closed convex hull that holds its points.
#include <fstream>

#include "hull_check.h"
#include "lendulet/shapes.h"

namespace lendulet {
namespace {

std::vector<Vec3> turned(std::vector<Vec3> points, Quat q, Vec3 offset = {}) {
    for (Vec3& p : points) p = rotate(q, p) + offset;
    return points;
}

// A box's surface as a grid of n x n points on each face.
std::vector<Vec3> box_grid(Vec3 half, int n) {
    std::vector<Vec3> points;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2)
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < n; ++k) {
                    Vec3 p;
                    auto along = [&](int step) {
                        return static_cast<float>(2 * step - n + 1) / static_cast<float>(n - 1);
                    };
                    set_component(p, axis, static_cast<float>(side));
                    set_component(p, (axis + 1) % 3, along(i));
                    set_component(p, (axis + 2) % 3, along(k));
                    points.push_back(multiply(p, half));
                }
    return points;
}

std::vector<Vec3> on_sphere(std::mt19937& random, int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(random_unit(random));
    return points;
}

std::vector<Vec3> prism(int sides, float half_height, float radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < sides; ++i) {
        SinCos a = sin_cos(2.0f * pi * static_cast<float>(i) / static_cast<float>(sides));
        points.push_back({radius * a.cos, -half_height, radius * a.sin});
        points.push_back({radius * a.cos, half_height, radius * a.sin});
    }
    return points;
}

HullData build(std::span<const Vec3> points) {
    Result<ConvexHull> hull = ConvexHull::from_points(points);
    EXPECT_TRUE(hull.ok()) << hull.error().message;
    return hull.ok() ? hull.value().data() : HullData{};
}

TEST(HullTest, TetrahedronAndCube) {
    std::vector<Vec3> tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    HullData t = build(tetrahedron);
    expect_valid_hull(t, tetrahedron);
    EXPECT_EQ(t.faces.size(), 4u);
    EXPECT_FLOAT_EQ(t.volume, 1.0f / 6.0f);
    EXPECT_NEAR(length(t.centroid - Vec3{0.25f, 0.25f, 0.25f}), 0.0f, 1e-7f);

    std::vector<Vec3> cube = box_grid({1, 2, 3}, 2);
    HullData c = build(cube);
    expect_valid_hull(c, cube);
    EXPECT_EQ(c.vertices.size(), 8u);
    EXPECT_EQ(c.faces.size(), 6u);
    EXPECT_EQ(c.edges.size(), 24u);
    EXPECT_EQ(c.dropped_points, 16);
    EXPECT_FLOAT_EQ(c.volume, 48.0f);
    EXPECT_FLOAT_EQ(c.unit_inertia.xx, 48.0f / 3.0f * (4 + 9));
    EXPECT_FLOAT_EQ(c.unit_inertia.yy, 48.0f / 3.0f * (9 + 1));
    EXPECT_FLOAT_EQ(c.unit_inertia.zz, 48.0f / 3.0f * (1 + 4));
    EXPECT_NEAR(c.unit_inertia.xy, 0.0f, 1e-5f);
    EXPECT_EQ(c.lower, (Vec3{-1, -2, -3}));
    EXPECT_EQ(c.upper, (Vec3{1, 2, 3}));
}

// Coordinates of a turned box are rounded, so its faces are no longer plane; still it has six faces and eight corners.
TEST(HullTest, GridsOnTurnedBoxesGiveSixFaces) {
    std::mt19937 random(11);
    for (int i = 0; i < 60; ++i) {
        Vec3 half = i % 3 == 0 ? Vec3{1, 1, 1} : i % 3 == 1 ? Vec3{1, 0.01f, 0.5f} : Vec3{3, 0.2f, 0.1f};
        Vec3 offset = i % 2 == 0 ? Vec3{} : 2.0f * random_unit(random);
        std::vector<Vec3> points = turned(box_grid(half, 2 + i % 11), random_rotation(random), offset);
        HullData hull = build(points);
        expect_valid_hull(hull, points);
        EXPECT_EQ(hull.vertices.size(), 8u) << i;
        EXPECT_EQ(hull.faces.size(), 6u) << i;
    }
}

TEST(HullTest, RandomCloudsHoldAllTheirPoints) {
    std::mt19937 random(12);
    for (int i = 0; i < 300; ++i) {
        int count = 4 + static_cast<int>(random() % 60);
        std::vector<Vec3> points;
        for (int k = 0; k < count; ++k) points.push_back(random_vector(random));
        if (i % 3 == 1) points = on_sphere(random, count);
        // Duplicates and near duplicates.
        for (int k = 0; k < count / 2; ++k)
            points.push_back(points[random() % points.size()] + (i % 2 == 0 ? 0.0f : 1e-7f) * random_unit(random));
        expect_valid_hull(build(points), points);
    }
}

TEST(HullTest, PointsOnACoarseLatticeAreFullOfCoplanarities) {
    std::mt19937 random(13);
    for (int i = 0; i < 300; ++i) {
        std::vector<Vec3> points;
        for (int k = 0; k < 40; ++k) {
            auto coordinate = [&] { return static_cast<float>(random() % 4); };
            float x = coordinate(), y = coordinate(), z = coordinate();
            points.push_back({x, y, z});
        }
        points = turned(points, i % 2 == 0 ? Quat{} : random_rotation(random));
        HullData hull = build(points);
        expect_valid_hull(hull, points);
        // Faces in one plane are one face.
        for (const HullEdge& e : hull.edges)
            EXPECT_LT(dot(hull.faces[e.face].normal, hull.faces[hull.edges[e.twin].face].normal), 0.9999f);
    }
}

TEST(HullTest, NeedlesAndPlatesOfAspect1e4) {
    std::mt19937 random(14);
    for (int i = 0; i < 200; ++i) {
        Vec3 scale = i % 2 == 0 ? Vec3{1, 1e-4f, 1e-4f} : Vec3{1, 1e-4f, 1};
        std::vector<Vec3> points;
        for (int k = 0; k < 40; ++k) points.push_back(multiply(scale, random_vector(random)));
        if (i % 4 >= 2) points = box_grid(scale, 4);
        points = turned(points, random_rotation(random));
        HullData hull = build(points);
        expect_valid_hull(hull, points);
        if (i % 4 >= 2) {
            EXPECT_NEAR(hull.volume, 8.0f * scale.x * scale.y * scale.z, 0.02f * 8.0f * scale.x * scale.y * scale.z);
        }
    }
}

// Blades hardly thicker than what counts as flat: points beyond a sharp edge stand out of neither face, but of the one
// that cuts the edge off later.
TEST(HullTest, BladesHoldTheirPoints) {
    std::mt19937 random(20);
    int built = 0;
    for (int i = 0; i < 2000; ++i) {
        float thickness = std::ldexp(1.0f, -static_cast<int>(random() % 20));
        std::vector<Vec3> points;
        for (int k = 0; k < 60; ++k)
            points.push_back(multiply({1, thickness, 1}, i % 2 == 0 ? random_vector(random) : random_unit(random)));
        Vec3 offset = i % 3 == 0 ? Vec3{} : random_vector(random, i % 3 == 1 ? 10.0f : 2000.0f);
        points = turned(points, random_rotation(random), offset);
        Result<ConvexHull> hull = ConvexHull::from_points(points);
        if (!hull.ok()) continue;  // flat
        ++built;
        expect_valid_hull(hull.value().data(), points);
    }
    EXPECT_GT(built, 1500);
}

// Thousands of points close to one face: the cone, the prism and the tilted grid that break tolerance-based builders.
TEST(HullTest, NearlyFlatFaces) {
    std::mt19937 random(15);
    for (float bump : {1e-8f, 1e-7f, 3e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f}) {
        std::vector<Vec3> points = box_grid({1, 1, 1}, 8);
        for (Vec3& p : points) p += bump * random_vector(random);
        points = turned(points, random_rotation(random));
        expect_valid_hull(build(points), points);
        std::vector<Vec3> dome;  // a cap of a very large ball
        for (int k = 0; k < 300; ++k) {
            Vec3 p = random_vector(random);
            dome.push_back({p.x, -bump * (p.x * p.x + p.z * p.z), p.z});
        }
        dome.push_back({0, -1, 0});
        expect_valid_hull(build(dome), dome);
    }
}

TEST(HullTest, PrismsKeepTheirRims) {
    for (int sides : {3, 5, 16, 33, 100, 1000, 5000}) {
        std::vector<Vec3> points = prism(sides, 0.5f, 1.0f);
        HullData hull = build(points);
        if (sides <= 100) expect_valid_hull(hull, points);
        EXPECT_EQ(topology_fault(hull), "");
        if (sides <= 1000) {
            EXPECT_EQ(hull.vertices.size(), 2 * static_cast<size_t>(sides));
            EXPECT_EQ(hull.faces.size(), static_cast<size_t>(sides) + 2);
        }
        float area = 0.5f * static_cast<float>(sides) * sin_cos(2.0f * pi / static_cast<float>(sides)).sin;
        EXPECT_NEAR(hull.volume, area, 2e-5f);
    }
}

TEST(HullTest, DegenerateCloudsAreRefusedWithTheirRank) {
    std::mt19937 random(16);
    auto message = [](const std::vector<Vec3>& points) {
        Result<ConvexHull> hull = ConvexHull::from_points(points);
        EXPECT_FALSE(hull.ok());
        if (hull.ok()) return std::string();
        EXPECT_EQ(hull.error().code, ErrorCode::degenerate_hull);
        return hull.error().message;
    };
    EXPECT_NE(message({}).find("four points"), std::string::npos);
    EXPECT_NE(message({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).find("four points"), std::string::npos);
    EXPECT_NE(message({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).find("coincide"), std::string::npos);
    EXPECT_NE(message({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}).find("one line"), std::string::npos);
    for (int i = 0; i < 100; ++i) {
        std::vector<Vec3> flat;
        for (int k = 0; k < 30; ++k) flat.push_back(multiply({1, 0, 1}, random_vector(random)));
        Quat q = i == 0 ? Quat{} : random_rotation(random);
        EXPECT_NE(message(turned(flat, q)).find("one plane"), std::string::npos);
    }
    // Just thick enough.
    EXPECT_TRUE(ConvexHull::from_points(box_grid({1, 1e-5f, 1}, 3)).ok());
}

TEST(HullTest, BadInputIsRefused) {
    std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    auto code = [](const std::vector<Vec3>& p, float rounding = 0.0f) {
        Result<ConvexHull> hull = ConvexHull::from_points(p, rounding);
        EXPECT_FALSE(hull.ok());
        return hull.ok() ? ErrorCode::io : hull.error().code;
    };
    float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (float bad : {infinite, -infinite, nan}) {
        std::vector<Vec3> p = points;
        p[2].y = bad;
        EXPECT_EQ(code(p), ErrorCode::non_finite);
        EXPECT_NE(ConvexHull::from_points(p).error().message.find("point 2"), std::string::npos);
        EXPECT_EQ(code(points, bad), ErrorCode::non_finite);
    }
    EXPECT_EQ(code(points, -0.1f), ErrorCode::bad_extent);
    std::vector<Vec3> far = points;
    far[3].x = 2e5f;
    EXPECT_EQ(code(far), ErrorCode::bad_extent);
    for (Vec3& p : points) p = 1e-5f * p;
    EXPECT_EQ(code(points), ErrorCode::bad_extent);
}

TEST(HullTest, TooManyCornersAreRefused) {
    std::mt19937 random(17);
    std::vector<Vec3> points = on_sphere(random, 70000);
    for (Vec3& p : points) p = 1000.0f * p;
    Result<ConvexHull> hull = ConvexHull::from_points(points);
    ASSERT_FALSE(hull.ok());
    EXPECT_EQ(hull.error().code, ErrorCode::too_many_vertices);
}

TEST(HullTest, TenThousandPoints) {
    std::mt19937 random(18);
    std::vector<Vec3> points = on_sphere(random, 10000);
    HullData hull = build(points);
    EXPECT_EQ(topology_fault(hull), "");
    EXPECT_GT(hull.vertices.size(), 9900u);
    EXPECT_NEAR(hull.volume, 4.0f / 3.0f * pi, 0.01f);
    for (const HullFace& face : hull.faces)
        for (size_t i = 0; i < points.size(); i += 50) ASSERT_LT(dot(face.normal, points[i]) - face.offset, 1e-5f);
}

TEST(HullTest, OrderOfThePointsHardlyMatters) {
    std::mt19937 random(19);
    std::vector<Vec3> points = on_sphere(random, 100);
    HullData a = build(points);
    std::reverse(points.begin(), points.end());
    HullData b = build(points);
    EXPECT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_FLOAT_EQ(a.volume, b.volume);
    HullData again = build(points);
    EXPECT_EQ(again.vertices, b.vertices);
    ASSERT_EQ(again.edges.size(), b.edges.size());
    for (size_t e = 0; e < b.edges.size(); ++e) EXPECT_EQ(again.edges[e].twin, b.edges[e].twin);
}

TEST(HullTest, CloudsOfAShippedGame) {
    std::ifstream file("../shared/assets/hulls/point_clouds.bin", std::ios::binary);
    if (!file) GTEST_SKIP() << "../shared/assets/hulls/point_clouds.bin is absent";
    int clouds = 0, flat = 0;
    for (uint32_t count; file.read(reinterpret_cast<char*>(&count), 4); ++clouds) {
        std::vector<Vec3> points(count);
        ASSERT_TRUE(file.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(12 * count)));
        Result<ConvexHull> hull = ConvexHull::from_points(points);
        if (!hull.ok()) {
            EXPECT_EQ(hull.error().code, ErrorCode::degenerate_hull);
            ++flat;
        } else {
            SCOPED_TRACE("cloud " + std::to_string(clouds));
            expect_valid_hull(hull.value().data(), points);
        }
    }
    EXPECT_EQ(clouds, 5000);
    EXPECT_EQ(flat, 19);
}

}  // namespace
}  // namespace lendulet
