// Checks of sizes, support points, boxes and radii of every shape, against dense samples of its surface.
#include <functional>

#include "geometry/geometry.h"
#include "geometry/mesh.h"
#include "hull_check.h"
#include "lendulet/shapes.h"

namespace lendulet {
namespace {

struct Sample {
    const char* name;
    Shape shape;
    std::function<bool(Vec3)> contains;  // with a little tolerance
};

// Distance from the segment from (0, -h, 0) to (0, h, 0).
float axis_distance(Vec3 p, float h) { return length(p - Vec3{0, clamp(p.y, -h, h), 0}); }

std::vector<Sample> samples() {
    constexpr float e = 1e-5f;
    auto radius = [](Vec3 p) { return square_root(p.x * p.x + p.z * p.z); };
    auto in_cone = [=](Vec3 p, float h, float bottom, float top) {
        float t = (p.y + h) / (2.0f * h);
        return absolute(p.y) <= h + e && radius(p) <= bottom + t * (top - bottom) + 4.0f * e;
    };
    std::vector<Vec3> corners{{0.5f, 0, 0}, {-0.5f, 0, 0.25f}, {0, 1, 0}, {0.25f, -1, 0.5f}, {0, 0.5f, -0.5f}};
    return {
        {"sphere", Sphere{0.5f}, [=](Vec3 p) { return length(p) <= 0.5f + e; }},
        {"capsule", Capsule{1.0f, 0.25f}, [=](Vec3 p) { return axis_distance(p, 1.0f) <= 0.25f + e; }},
        {"box", Box{{0.5f, 1.0f, 2.0f}},
         [=](Vec3 p) {
             return max_component(absolute(p) - Vec3{0.5f, 1.0f, 2.0f}) <= e;
         }},
        {"rounded box", Box{{0.5f, 1.0f, 2.0f}, 0.25f},
         [=](Vec3 p) {
             return length(maximum(absolute(p) - Vec3{0.5f, 1.0f, 2.0f}, Vec3{})) <= 0.25f + e;
         }},
        {"cylinder", Cylinder{0.5f, 1.0f}, [=](Vec3 p) { return in_cone(p, 0.5f, 1.0f, 1.0f); }},
        {"cone", Cone{1.0f, 0.5f}, [=](Vec3 p) { return in_cone(p, 1.0f, 0.5f, 0.0f); }},
        {"tapered cylinder", TaperedCylinder{1.0f, 0.25f, 0.75f},
         [=](Vec3 p) { return in_cone(p, 1.0f, 0.25f, 0.75f); }},
        {"tapered capsule", TaperedCapsule{1.0f, 0.75f, 0.25f},
         [=](Vec3 p) {  // a ball of the hull's family: radius and centre blend together
             bool inside = false;
             for (int k = 0; k <= 2000; ++k) {
                 float t = static_cast<float>(k) / 2000.0f;
                 inside |= length(p - Vec3{0, 2.0f * t - 1.0f, 0}) <= 0.75f - 0.5f * t + 2.0f * e;
             }
             return inside;
         }},
        {"tapered capsule in one ball", TaperedCapsule{0.25f, 1.0f, 0.25f},
         [=](Vec3 p) {
             return length(p - Vec3{0, -0.25f, 0}) <= 1.0f + e;
         }},
        {"hull", ConvexHull::from_points(corners, 0.125f).value(), [](Vec3) { return true; }},
    };
}

Vec3 support(const Geometry& g, Vec3 d) { return support_core(g, d) + g.rounding * normalize(d); }

// Points of the shape: random ones that it contains, and its own supports.
std::vector<Vec3> points_of(const Sample& sample, const Geometry& g, std::mt19937& random) {
    std::vector<Vec3> points;
    for (int i = 0; i < 300; ++i) points.push_back(support(g, random_unit(random)));
    if (g.kind == GeometryKind::hull) return points;
    for (int i = 0; i < 3000; ++i) {
        Vec3 p = random_vector(random, 2.5f);
        if (sample.contains(p)) points.push_back(p);
    }
    return points;
}

TEST(SupportTest, LiesInTheShapeAndBeforeAllOfIt) {
    std::mt19937 random(21);
    for (const Sample& sample : samples()) {
        SCOPED_TRACE(sample.name);
        Geometry g = make_geometry(sample.shape).value();
        std::vector<Vec3> points = points_of(sample, g, random);
        for (int i = 0; i < 300; ++i) {
            Vec3 d = random_unit(random);
            if (i % 4 == 1) set_component(d, i / 4 % 3, 0.0f);
            if (i % 4 == 2) d = i % 8 < 4 ? Vec3{0, 1, 0} : Vec3{0, -1, 0};
            d = normalize(d);
            Vec3 s = support(g, d);
            EXPECT_TRUE(sample.contains(s)) << d.x << ' ' << d.y << ' ' << d.z;
            for (Vec3 p : points) EXPECT_LE(dot(p, d), dot(s, d) + 2e-4f);
            // The length of the direction does not matter.
            for (float scale : {1e-30f, 1e-12f, 1e12f, 1e30f})
                EXPECT_LT(length(support_core(g, scale * d) - support_core(g, d)), 1e-5f) << scale;
        }
        Vec3 zero = support_core(g, {});
        EXPECT_TRUE(sample.contains(zero));
        EXPECT_EQ(zero, support_core(g, {}));
    }
}

TEST(SupportTest, BoxesAndRadiiAreTight) {
    std::mt19937 random(22);
    for (const Sample& sample : samples()) {
        SCOPED_TRACE(sample.name);
        Geometry g = make_geometry(sample.shape).value();
        for (int i = 0; i < 100; ++i) {
            Quat q = i == 0 ? Quat{} : random_rotation(random);
            CentredBox box = bounds(g, q);
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 e{};
                set_component(e, axis, 1.0f);
                Vec3 local = rotate_inverse(q, e);
                EXPECT_NEAR(component(box.centre + box.half, axis), dot(support(g, local), local), 1e-5f);
                EXPECT_NEAR(component(box.centre - box.half, axis), dot(support(g, -local), local), 1e-5f);
            }
        }
        float farthest = 0.0f;
        for (int i = 0; i < 20000; ++i) farthest = maximum(farthest, length(support(g, random_unit(random))));
        EXPECT_LE(farthest, bounding_radius(g) + 1e-5f);
        EXPECT_GE(farthest, 0.93f * bounding_radius(g));
    }
}

TEST(SupportTest, PlaneAndMeshHaveBounds) {
    Geometry plane = make_geometry(Plane{{0, 3, 4}, 10.0f}).value();
    EXPECT_EQ(plane.size, (Vec3{0, 0.6f, 0.8f}));
    EXPECT_FLOAT_EQ(plane.offset, 2.0f);
    EXPECT_EQ(bounds(plane, {}).half.x, std::numeric_limits<float>::infinity());
    std::vector<Vec3> vertices{{0, 0, 0}, {2, 0, 0}, {0, 0, 2}, {0, 4, 0}};
    std::vector<uint32_t> indices{0, 1, 2, 0, 3, 1};
    TriangleMesh mesh = TriangleMesh::from_triangles(vertices, indices).value();
    Geometry g = make_geometry(mesh).value();
    EXPECT_EQ(bounds(g, {}).centre, (Vec3{1, 2, 1}));
    EXPECT_EQ(bounds(g, {}).half, (Vec3{1, 2, 1}));
    EXPECT_FLOAT_EQ(bounding_radius(g), 4.0f);
}

TEST(SupportTest, TriangleIsAFlatCore) {
    Vec3 corners[3] = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    Geometry g{.kind = GeometryKind::triangle, .rounding = 0.5f, .triangle = corners};
    EXPECT_EQ(support_core(g, {1, 0, 0}), corners[0]);
    EXPECT_EQ(support_core(g, {0, 1, 0}), corners[1]);
    EXPECT_EQ(support_core(g, {0, 0, 1}), corners[2]);
    EXPECT_EQ(bounds(g, {}).half, (Vec3{1.0f, 1.5f, 2.0f}));
    EXPECT_FLOAT_EQ(bounding_radius(g), 3.5f);
}

// The wide search and the clusters give what a plain loop gives.
TEST(SupportTest, HullSearchEqualsAPlainLoop) {
    std::mt19937 random(23);
    for (int count : {4, 5, 8, 15, 16, 17, 33, 64, 65, 100, 300, 2000}) {
        std::vector<Vec3> points;
        for (int i = 0; i < count; ++i) points.push_back(random_unit(random) + Vec3{0.5f, 0, 0});
        ConvexHull hull = ConvexHull::from_points(points).value();
        const HullData& data = hull.data();
        EXPECT_EQ(data.clusters.count != 0, data.vertices.size() > scanned_vertices);
        for (int i = 0; i < 300; ++i) {
            Vec3 d = random_unit(random);
            if (i % 3 == 1) set_component(d, i % 2, 0.0f);
            uint32_t best = 0, face = 0;
            for (uint32_t v = 1; v < data.vertices.size(); ++v)
                if (dot(data.vertices[v], d) > dot(data.vertices[best], d)) best = v;
            for (uint32_t f = 1; f < data.faces.size(); ++f)
                if (dot(data.faces[f].normal, d) > dot(data.faces[face].normal, d)) face = f;
            ASSERT_EQ(support_vertex(data, d), best);
            ASSERT_EQ(support_face(data, d), face);
        }
        EXPECT_EQ(support_vertex(data, {}), 0u);  // all equal: the first
    }
}

// Cube corners tie in most axis directions.
TEST(SupportTest, TiesGoToTheFirstCorner) {
    std::vector<Vec3> cube;
    for (int i = 0; i < 8; ++i) cube.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
    ConvexHull hull = ConvexHull::from_points(cube).value();
    EXPECT_EQ(hull.vertices()[support_vertex(hull.data(), {0, 1, 0})], (Vec3{-1, 1, -1}));
    EXPECT_EQ(hull.vertices()[support_vertex(hull.data(), {0, 0, -1})], (Vec3{-1, -1, -1}));
}

ErrorCode refusal(const Shape& shape) {
    Result<Geometry> g = make_geometry(shape);
    EXPECT_FALSE(g.ok());
    if (g.ok()) return ErrorCode::io;
    EXPECT_EQ(g.error().message.back(), '.');
    return g.error().code;
}

TEST(MakeGeometryTest, SizesOutOfRangeAreRefused) {
    float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    for (float bad : {0.0f, -1.0f, 1e-5f, 2e4f}) {
        EXPECT_EQ(refusal(Sphere{bad}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(Capsule{bad, 1}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(Capsule{1, bad}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(Box{{1, bad, 1}}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(Cylinder{1, bad}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(Cone{1, bad}), ErrorCode::bad_extent);
        EXPECT_EQ(refusal(TaperedCylinder{bad, 1, 1}), ErrorCode::bad_extent);
    }
    for (float bad : {nan, infinite, -infinite}) {
        EXPECT_EQ(refusal(Sphere{bad}), ErrorCode::non_finite);
        EXPECT_EQ(refusal(Box{{1, 1, 1}, bad}), ErrorCode::non_finite);
        EXPECT_EQ(refusal(TaperedCapsule{1, bad, 1}), ErrorCode::non_finite);
        EXPECT_EQ(refusal(TaperedCylinder{1, 1, bad}), ErrorCode::non_finite);
        EXPECT_EQ(refusal(Plane{{0, bad, 0}, 0}), ErrorCode::non_finite);
        EXPECT_EQ(refusal(Plane{{0, 1, 0}, bad}), ErrorCode::non_finite);
    }
    EXPECT_EQ(refusal(Box{{1, 1, 1}, -0.1f}), ErrorCode::bad_extent);
    EXPECT_EQ(refusal(Cone{1, 1, -0.1f}), ErrorCode::bad_extent);
    EXPECT_EQ(refusal(TaperedCylinder{1, 0, 0}), ErrorCode::bad_extent);
    EXPECT_EQ(refusal(TaperedCapsule{1, 0, 0}), ErrorCode::bad_extent);
    EXPECT_EQ(refusal(Plane{{0, 0, 0}, 0}), ErrorCode::bad_extent);
    EXPECT_EQ(refusal(ConvexHull{}), ErrorCode::degenerate_hull);
    EXPECT_EQ(refusal(TriangleMesh{}), ErrorCode::bad_mesh);
    EXPECT_NE(make_geometry(Box{{1, -3, 1}}).error().message.find("half_extents.y"), std::string::npos);
}

TEST(MakeGeometryTest, CoresAndRoundings) {
    Geometry capsule = make_geometry(TaperedCapsule{1, 0.5f, 0.5f}).value();
    EXPECT_EQ(capsule.kind, GeometryKind::segment);
    EXPECT_EQ(capsule.rounding, 0.5f);
    Geometry tapered = make_geometry(TaperedCapsule{1, 0.75f, 0.5f}).value();
    EXPECT_EQ(tapered.kind, GeometryKind::tapered_capsule);
    EXPECT_EQ(tapered.rounding, 0.5f);
    EXPECT_EQ(tapered.size, (Vec3{0.25f, 1, 0}));
    Geometry cone = make_geometry(Cone{1, 0.5f}).value();
    EXPECT_EQ(cone.kind, GeometryKind::tapered_cylinder);
    EXPECT_EQ(cone.size, (Vec3{0.5f, 1, 0}));
    EXPECT_EQ(make_geometry(Sphere{2}).value().rounding, 2.0f);
    EXPECT_TRUE(make_geometry(TaperedCylinder{1, 0, 1}).ok());
}

}  // namespace
}  // namespace lendulet
