// Faces handed to clipping: on the surface, convex, counter-clockwise, named steadily.
#include <set>

#include "geometry/geometry.h"
#include "hull_check.h"
#include "lendulet/shapes.h"

namespace lendulet {
namespace {

void expect_polygon(const Geometry& g, const Face& face, Vec3 direction) {
    ASSERT_GE(face.count, 3);
    ASSERT_LE(face.count, max_face_vertices);
    EXPECT_NEAR(length(face.normal), 1.0f, 1e-6f);
    EXPECT_GT(dot(face.normal, direction), 0.0f);
    std::set<uint16_t> ids;
    float plane = dot(support_core(g, face.normal), face.normal);
    for (int i = 0; i < face.count; ++i) {
        Vec3 a = face.vertices[i], b = face.vertices[(i + 1) % face.count], c = face.vertices[(i + 2) % face.count];
        EXPECT_NEAR(dot(a, face.normal), plane, 1e-5f);
        EXPECT_GT(dot(cross(b - a, c - b), face.normal), 0.0f);
        EXPECT_TRUE(ids.insert(face.ids[i]).second);
    }
}

// Every vertex lies on the core: it is its support along some direction, which for one or two points is the normal.
void expect_on_surface(const Geometry& g, const Face& face, float tolerance) {
    for (int i = 0; i < face.count; ++i)
        EXPECT_NEAR(dot(face.vertices[i], face.normal), dot(support_core(g, face.normal), face.normal), tolerance);
}

TEST(BestFaceTest, Box) {
    Geometry g = make_geometry(Box{{1, 2, 3}}).value();
    std::mt19937 random(31);
    for (int i = 0; i < 200; ++i) {
        Vec3 d = random_unit(random);
        Face face = best_face(g, 5.0f * d);
        EXPECT_EQ(face.count, 4);
        expect_polygon(g, face, d);
        EXPECT_EQ(dot(face.normal, d), max_component(absolute(d)));
        for (int k = 0; k < 4; ++k)  // names tell the corner
            EXPECT_EQ(face.vertices[k].x > 0, (face.ids[k] & 1) != 0);
    }
}

TEST(BestFaceTest, SphereAndCapsule) {
    Geometry sphere = make_geometry(Sphere{1}).value();
    Face point = best_face(sphere, {1, 2, 3});
    EXPECT_EQ(point.count, 1);
    EXPECT_EQ(point.vertices[0], Vec3{});
    Geometry capsule = make_geometry(Capsule{2, 1}).value();
    EXPECT_EQ(best_face(capsule, {1, 0, 0}).count, 2);
    EXPECT_EQ(best_face(capsule, {1, 0.1f, 0}).count, 2);
    EXPECT_EQ(best_face(capsule, {1, 0.3f, 0}).count, 1);
    EXPECT_EQ(best_face(capsule, {0, 1, 0}).vertices[0], (Vec3{0, 2, 0}));
    EXPECT_EQ(best_face(capsule, {0, -1, 0}).vertices[0], (Vec3{0, -2, 0}));
    EXPECT_NE(best_face(capsule, {0, -1, 0}).ids[0], best_face(capsule, {0, 1, 0}).ids[0]);
}

TEST(BestFaceTest, CylinderCapSideAndRim) {
    Geometry g = make_geometry(Cylinder{0.5f, 2}).value();
    for (float sign : {1.0f, -1.0f}) {
        for (float tilt : {0.0f, 1e-4f, 0.05f, 0.2f}) {
            Vec3 d{0, sign * square_root(1 - tilt * tilt), tilt};
            Face cap = best_face(g, d);
            EXPECT_EQ(cap.count, 16);
            expect_polygon(g, cap, d);
            EXPECT_EQ(cap.extra_radius, 0.0f);
            float reach = -10.0f;
            for (int i = 0; i < cap.count; ++i) reach = maximum(reach, dot(cap.vertices[i], d));
            // A cap that rolls on its rim touches at the very point, one at rest within 0.2 mm.
            EXPECT_NEAR(reach, dot(support_core(g, d), d), tilt > 0.01f ? 1e-6f : 2e-4f);
        }
    }
    // A cap that rocks keeps its corners; the lowest point of its rim is one more, between the two beside it.
    const Face still = best_face(g, {0, 1, 0});
    for (float azimuth : {0.1f, 1.0f, 2.5f, 4.0f, 6.0f}) {
        const Vec3 low{std::cos(azimuth), 0.0f, std::sin(azimuth)};
        const Vec3 d = normalize(Vec3{0.1f * low.x, 1.0f, 0.1f * low.z});
        const Face rocked = best_face(g, d);
        expect_polygon(g, rocked, d);
        ASSERT_EQ(rocked.count, 17);
        int kept = 0;
        for (int i = 0, k = 0; i < rocked.count; ++i) {
            if (k < still.count && rocked.ids[i] == still.ids[k] && rocked.vertices[i] == still.vertices[k])
                ++k, ++kept;
            else EXPECT_LT(length(rocked.vertices[i] - (2.0f * low + Vec3{0, 0.5f, 0})), 1e-5f);
        }
        EXPECT_EQ(kept, 16);
    }
    // At rest the points do not wander with the noise of the normal.
    Face a = best_face(g, {1e-6f, -1, 2e-6f}), b = best_face(g, {-3e-6f, -1, 1e-6f});
    for (int i = 0; i < a.count; ++i) {
        EXPECT_EQ(a.vertices[i], b.vertices[i]);
        EXPECT_EQ(a.ids[i], b.ids[i]);
    }
    Face side = best_face(g, {0.6f, 0.02f, 0.8f});
    ASSERT_EQ(side.count, 2);
    EXPECT_EQ(side.extra_radius, 2.0f);
    EXPECT_LT(length(side.vertices[0] - Vec3{1.2f, -0.5f, 1.6f}), 1e-3f);
    EXPECT_LT(length(side.vertices[1] - Vec3{1.2f, 0.5f, 1.6f}), 1e-3f);
    Vec3 down = normalize(Vec3{0.6f, -1, 0.8f});
    Face rim = best_face(g, down);
    ASSERT_EQ(rim.count, 1);
    EXPECT_LT(length(rim.vertices[0] - support_core(g, down)), 1e-6f);
    EXPECT_EQ(rim.ids[0], side.ids[0]);  // the same point of the rim keeps its name
    EXPECT_EQ(rim.extra_radius, 0.0f);
}

TEST(BestFaceTest, ConeLiesOnItsSideAndStandsOnItsTip) {
    Geometry g = make_geometry(Cone{1, 0.5f}).value();
    Vec3 side_normal = normalize(Vec3{0, 0.5f, 2});  // (2 h, bottom - top) in the y-z plane
    Face side = best_face(g, side_normal);
    ASSERT_EQ(side.count, 2);
    expect_on_surface(g, side, 1e-6f);
    EXPECT_EQ(side.extra_radius, 0.0f);
    Face tip = best_face(g, {0, 1, 0});
    ASSERT_EQ(tip.count, 1);
    EXPECT_EQ(tip.vertices[0], (Vec3{0, 1, 0}));
    EXPECT_EQ(best_face(g, {0, -1, 0}).count, 16);
    EXPECT_EQ(best_face(g, normalize(Vec3{0, -1, 2})).count, 1);
}

// The side of a nearly flat frustum is as close to the axis as the cap.
TEST(BestFaceTest, FlatFrustumTellsSideFromCap) {
    Geometry g = make_geometry(TaperedCylinder{0.1f, 3, 1}).value();
    Vec3 side_normal = normalize(Vec3{0.2f, 2, 0});
    EXPECT_EQ(best_face(g, side_normal).count, 2);
    expect_on_surface(g, best_face(g, side_normal), 1e-5f);
    EXPECT_EQ(best_face(g, {0, 1, 0}).count, 16);
    EXPECT_EQ(best_face(g, {0, -1, 0}).count, 16);
}

TEST(BestFaceTest, TaperedCapsule) {
    Geometry g = make_geometry(TaperedCapsule{1, 0.75f, 0.25f}).value();
    float sine = 0.25f, cosine = square_root(1 - sine * sine);
    Vec3 side_normal{cosine, sine, 0};
    Face side = best_face(g, side_normal);
    ASSERT_EQ(side.count, 2);
    expect_on_surface(g, side, 1e-6f);
    Face bottom = best_face(g, {0, -1, 0});
    ASSERT_EQ(bottom.count, 1);
    EXPECT_EQ(bottom.vertices[0], (Vec3{0, -1.5f, 0}));
    EXPECT_EQ(bottom.extra_radius, 0.5f);  // with the rounding of 0.25 the ball of radius 0.75
    Face top = best_face(g, {0, 1, 0});
    EXPECT_EQ(top.vertices[0], (Vec3{0, 1, 0}));
    EXPECT_NE(top.ids[0], bottom.ids[0]);
    // One ball within the other: always a point of the larger one.
    Geometry ball = make_geometry(TaperedCapsule{0.25f, 0.25f, 1}).value();
    std::mt19937 random(32);
    for (int i = 0; i < 100; ++i) {
        Vec3 d = random_unit(random);
        Face face = best_face(ball, d);
        ASSERT_EQ(face.count, 1);
        EXPECT_LT(length(face.vertices[0] - (Vec3{0, 0.25f, 0} + 0.75f * normalize(d))), 1e-6f);
    }
}

TEST(BestFaceTest, HullFacesAreItsPolygons) {
    std::mt19937 random(33);
    for (int i = 0; i < 20; ++i) {
        std::vector<Vec3> points;
        for (int k = 0; k < 30; ++k) points.push_back(random_vector(random));
        ConvexHull hull = ConvexHull::from_points(points).value();
        Geometry g = make_geometry(hull).value();
        for (int k = 0; k < 50; ++k) {
            Vec3 d = random_unit(random);
            Face face = best_face(g, d);
            expect_polygon(g, face, d);
            for (const HullFace& other : hull.data().faces)
                EXPECT_LE(dot(other.normal, d), dot(face.normal, d) + 1e-6f);
            for (int v = 0; v < face.count; ++v) EXPECT_EQ(hull.vertices()[face.ids[v]], face.vertices[v]);
        }
    }
}

TEST(BestFaceTest, ManyCornersAreReducedToTheirOutline) {
    std::vector<Vec3> points;
    for (int i = 0; i < 500; ++i) {
        SinCos a = sin_cos(2.0f * pi * static_cast<float>(i) / 500.0f);
        points.push_back({a.cos, -0.5f, 3.0f * a.sin});
        points.push_back({a.cos, 0.5f, 3.0f * a.sin});
    }
    ConvexHull hull = ConvexHull::from_points(points).value();
    Geometry g = make_geometry(hull).value();
    for (float y : {1.0f, -1.0f}) {
        Face face = best_face(g, {0, y, 0});
        EXPECT_EQ(face.count, 32);
        expect_polygon(g, face, {0, y, 0});
        float x = 0.0f, z = 0.0f;
        for (int i = 0; i < face.count; ++i) {
            x = maximum(x, face.vertices[i].x);
            z = maximum(z, face.vertices[i].z);
        }
        EXPECT_GT(x, 0.995f);
        EXPECT_GT(z, 2.985f);
    }
}

TEST(BestFaceTest, TriangleHasTwoSides) {
    Vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Geometry g{.kind = GeometryKind::triangle, .triangle = corners};
    for (float z : {1.0f, -1.0f}) {
        Face face = best_face(g, {0, 0, z});
        EXPECT_EQ(face.count, 3);
        expect_polygon(g, face, {0, 0, z});
    }
    EXPECT_NE(best_face(g, {0, 0, 1}).id, best_face(g, {0, 0, -1}).id);
}

TEST(BestFaceTest, PlanesHaveNone) { EXPECT_EQ(best_face(make_geometry(Plane{}).value(), {0, 1, 0}).count, 0); }

}  // namespace
}  // namespace lendulet
