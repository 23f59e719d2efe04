// Mass properties against closed forms, against hulls of fine tessellations, and against sums over small cubes.
#include "geometry/mass.h"

#include "geometry/hull_mass.h"
#include "hull_check.h"

namespace lendulet {
namespace {

void expect_near(const MassProperties& a, const MassProperties& b, float relative) {
    EXPECT_NEAR(a.mass, b.mass, relative * b.mass);
    float size = square_root(maximum(b.inertia.xx, maximum(b.inertia.yy, b.inertia.zz)) / b.mass);
    EXPECT_LT(length(a.centre - b.centre), 2.0f * relative * size);
    float scale = relative * b.mass * size * size;
    EXPECT_NEAR(a.inertia.xx, b.inertia.xx, scale);
    EXPECT_NEAR(a.inertia.yy, b.inertia.yy, scale);
    EXPECT_NEAR(a.inertia.zz, b.inertia.zz, scale);
    EXPECT_NEAR(a.inertia.xy, b.inertia.xy, scale);
    EXPECT_NEAR(a.inertia.xz, b.inertia.xz, scale);
    EXPECT_NEAR(a.inertia.yz, b.inertia.yz, scale);
}

MassProperties of(float mass, Vec3 centre, Vec3 inertia) {
    return {mass, centre, {inertia.x, inertia.y, inertia.z, 0, 0, 0}};
}

TEST(MassTest, ClosedFormsOfTheTextbooks) {
    constexpr float r = 0.4f, h = 0.7f, density = 3.0f;
    float ball = density * 4.0f / 3.0f * pi * r * r * r;
    float i = 0.4f * ball * r * r;
    expect_near(mass_properties(Sphere{r}, density), of(ball, {}, {i, i, i}), 1e-6f);

    float box = density * 8.0f * 1 * 2 * 3;
    expect_near(mass_properties(Box{{1, 2, 3}}, density), of(box, {}, {box * 13 / 3, box * 10 / 3, box * 5 / 3}),
                1e-6f);

    float rod = density * pi * r * r * 2 * h, across = rod * (r * r / 4 + h * h / 3);
    expect_near(mass_properties(Cylinder{h, r}, density), of(rod, {}, {across, rod * r * r / 2, across}), 1e-6f);

    // Two half balls, each with its centre of mass 3/8 r beyond the rod's end.
    float halves = 0.4f * ball * r * r + ball * (h * h + 0.75f * h * r);
    expect_near(mass_properties(Capsule{h, r}, density),
                of(rod + ball, {}, {across + halves, rod * r * r / 2 + i, across + halves}), 1e-6f);

    float cone = rod / 3.0f, height = 2 * h;
    float cone_across = cone * (3.0f / 20.0f * r * r + 3.0f / 80.0f * height * height);
    expect_near(mass_properties(Cone{h, r}, density),
                of(cone, {0, -0.25f * height, 0}, {cone_across, 0.3f * cone * r * r, cone_across}), 1e-6f);
}

// The hull of many support points of the rounded shape is a little smaller than the shape.
MassProperties of_tessellation(const Geometry& g, float density) {
    std::vector<Vec3> points;
    constexpr int rings = 90, sectors = 120;
    for (int i = 0; i <= rings; ++i)
        for (int k = 0; k < sectors; ++k) {
            SinCos up = sin_cos((static_cast<float>(i) / rings - 0.5f) * pi * 0.99999f);
            SinCos around = sin_cos(2.0f * pi * static_cast<float>(k) / sectors);
            Vec3 d{up.cos * around.cos, up.sin, up.cos * around.sin};
            points.push_back(support_core(g, d) + g.rounding * normalize(d));
        }
    const ConvexHull hull = ConvexHull::from_points(points).value();
    const HullData& data = hull.data();
    MassProperties unit{data.volume, data.centroid, data.unit_inertia};
    return with_mass(unit, density * data.volume);
}

TEST(MassTest, EveryShapeAgreesWithTheHullOfItsTessellation) {
    const std::pair<const char*, Shape> shapes[] = {
        {"sphere", Sphere{0.7f}},
        {"capsule", Capsule{0.8f, 0.3f}},
        {"tapered capsule", TaperedCapsule{0.8f, 0.5f, 0.2f}},
        {"tapered capsule, wide top", TaperedCapsule{0.4f, 0.2f, 0.9f}},
        {"tapered capsule with a tip", TaperedCapsule{0.8f, 0.5f, 0.0f}},
        {"one ball", TaperedCapsule{0.1f, 0.7f, 0.3f}},
        {"the other ball", TaperedCapsule{0.1f, 0.3f, 0.7f}},
        {"box", Box{{0.3f, 0.5f, 0.7f}}},
        {"rounded box", Box{{0.3f, 0.5f, 0.7f}, 0.4f}},
        {"cylinder", Cylinder{0.6f, 0.4f}},
        {"rounded cylinder", Cylinder{0.6f, 0.4f, 0.3f}},
        {"tapered cylinder", TaperedCylinder{0.6f, 0.4f, 0.7f}},
        {"rounded tapered cylinder", TaperedCylinder{0.6f, 0.7f, 0.3f, 0.2f}},
        {"cone", Cone{0.6f, 0.4f}},
        {"rounded cone", Cone{0.6f, 0.4f, 0.2f}},
    };
    for (const auto& [name, shape] : shapes) {
        SCOPED_TRACE(name);
        Geometry g = make_geometry(shape).value();
        MassProperties exact = mass_properties(shape, 2.5f), hull = of_tessellation(g, 2.5f);
        EXPECT_GE(exact.mass, 0.99999f * hull.mass);
        expect_near(exact, hull, 4e-3f);
    }
}

// Sums over a random point in each cell of a grid.
MassProperties of_cells(float reach, float density, bool (*inside)(Vec3)) {
    constexpr int n = 100;
    std::mt19937 random(53);
    std::uniform_real_distribution<float> within(0.0f, 1.0f);
    double step = 2.0 * reach / n, m = 0, x[3] = {}, xx[3] = {};
    for (int i = 0; i < n * n * n; ++i) {
        float p[3];
        int cell[3] = {i % n, i / n % n, i / n / n};
        for (int k = 0; k < 3; ++k)
            p[k] = (static_cast<float>(cell[k]) + within(random)) * static_cast<float>(step) - reach;
        if (!inside({p[0], p[1], p[2]})) continue;
        m += 1;
        for (int k = 0; k < 3; ++k) x[k] += p[k], xx[k] += double{p[k]} * p[k];
    }
    for (int k = 0; k < 3; ++k) x[k] /= m, xx[k] = xx[k] / m - x[k] * x[k];
    auto mass = static_cast<float>(density * m * step * step * step);
    return of(mass, {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])},
              mass * Vec3{static_cast<float>(xx[1] + xx[2]), static_cast<float>(xx[2] + xx[0]),
                          static_cast<float>(xx[0] + xx[1])});
}

TEST(MassTest, RoundedSolidsAgreeWithSumsOverCells) {
    expect_near(mass_properties(Box{{0.3f, 0.5f, 0.4f}, 0.4f}, 2.0f),
                of_cells(1.0f, 2.0f,
                         [](Vec3 p) {
                             return length(maximum(absolute(p) - Vec3{0.3f, 0.5f, 0.4f}, Vec3{})) <= 0.4f;
                         }),
                1e-3f);
    expect_near(mass_properties(Cylinder{0.5f, 0.4f, 0.4f}, 2.0f),
                of_cells(1.0f, 2.0f,
                         [](Vec3 p) {
                             float out = square_root(p.x * p.x + p.z * p.z) - 0.4f;
                             return length(maximum(Vec3{out, absolute(p.y) - 0.5f, 0}, Vec3{})) <= 0.4f;
                         }),
                1e-3f);
    // A ball of radius 0.5 with a cone tangent to it and its tip at y = 0.9, 1.2 above the ball's centre.
    expect_near(mass_properties(TaperedCapsule{0.6f, 0.5f, 0.0f}, 2.0f),
                of_cells(1.2f, 2.0f,
                         [](Vec3 p) {
                             float r = square_root(p.x * p.x + p.z * p.z), sine = 0.5f / 1.2f;
                             float cosine = square_root(1 - sine * sine), y = p.y + 0.6f;
                             if (r * r + y * y <= 0.25f) return true;
                             return y >= 0.5f * sine && cosine * r + sine * y <= 0.5f;
                         }),
                1e-3f);
}

TEST(MassTest, HullsTakeTheirPlaceIntoAccount) {
    std::mt19937 random(51);
    for (int i = 0; i < 50; ++i) {
        Vec3 half = Vec3{1.2f, 1.2f, 1.2f} + random_vector(random);
        Transform place{2.0f * random_vector(random), random_rotation(random)};
        std::vector<Vec3> corners;
        for (int k = 0; k < 8; ++k)
            corners.push_back(place * multiply(half, {k & 1 ? 1.f : -1.f, k & 2 ? 1.f : -1.f, k & 4 ? 1.f : -1.f}));
        MassProperties hull = mass_properties(ConvexHull::from_points(corners).value(), 7.0f);
        MassProperties box = placed(mass_properties(Box{half}, 7.0f), place);
        expect_near(hull, box, 1e-5f);
        EXPECT_LT(length(box.centre - place.translation), 1e-6f);
    }
}

TEST(MassTest, RoundedHullHasTheVolumeOfSteinersFormula) {
    std::vector<Vec3> corners;
    Vec3 half{0.6f, 0.9f, 0.7f};
    for (int k = 0; k < 8; ++k)
        corners.push_back(multiply(half, {k & 1 ? 1.f : -1.f, k & 2 ? 1.f : -1.f, k & 4 ? 1.f : -1.f}));
    HullSurface surface = hull_surface(ConvexHull::from_points(corners).value().data());
    EXPECT_NEAR(surface.area, 8.0 * (0.6 * 0.9 + 0.9 * 0.7 + 0.7 * 0.6), 1e-5);
    EXPECT_NEAR(surface.mean_curvature, 2.0 * 3.14159265 * (0.6 + 0.9 + 0.7), 1e-5);
    MassProperties hull = mass_properties(ConvexHull::from_points(corners, 0.1f).value(), 5.0f);
    MassProperties box = mass_properties(Box{half, 0.1f}, 5.0f);
    EXPECT_NEAR(hull.mass, box.mass, 1e-5f * box.mass);
    expect_near(hull, box, 0.04f);  // its inertia is an approximation
}

TEST(MassTest, MeshesCountAsTheirHullAndPlanesHaveNoMass) {
    std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<uint32_t> solid{0, 2, 1, 0, 1, 3}, flat{0, 1, 2};
    EXPECT_NEAR(mass_properties(TriangleMesh::from_triangles(vertices, solid).value(), 6.0f).mass, 1.0f, 1e-6f);
    EXPECT_EQ(mass_properties(TriangleMesh::from_triangles(vertices, flat).value(), 6.0f).mass, 0.0f);
    EXPECT_EQ(mass_properties(Plane{}, 6.0f).mass, 0.0f);
    EXPECT_EQ(mass_properties(Sphere{-1.0f}, 6.0f).mass, 0.0f);
}

TEST(MassTest, PartsMakeTheWhole) {
    // A box cut across x into three unequal slices, each turned about its own axis of symmetry.
    MassProperties parts[3];
    float borders[4] = {-1.0f, -0.4f, 0.5f, 1.0f};
    for (int i = 0; i < 3; ++i) {
        float half = 0.5f * (borders[i + 1] - borders[i]);
        Transform place{{borders[i] + half, 0, 0}, rotation_about({0, 0, 1}, 0.5f * pi)};
        parts[i] = placed(mass_properties(Box{{0.5f, half, 0.7f}}, 2.0f), place);  // turned, x and y are exchanged
    }
    expect_near(combined(parts), mass_properties(Box{{1.0f, 0.5f, 0.7f}}, 2.0f), 2e-6f);
    EXPECT_EQ(combined({}).mass, 0.0f);
    MassProperties heavy = with_mass(parts[0], 3.0f * parts[0].mass);
    EXPECT_FLOAT_EQ(heavy.inertia.xx, 3.0f * parts[0].inertia.xx);
}

TEST(PrincipalAxesTest, RebuildTheTensor) {
    std::mt19937 random(52);
    for (int i = 0; i < 2000; ++i) {
        Vec3 d = absolute(random_vector(random)) + Vec3{0.1f, 0.1f, 0.1f};
        if (i % 4 == 1) d.y = d.x;
        if (i % 4 == 2) d = {d.x, d.x * (1.0f + 1e-5f), d.x};
        if (i % 4 == 3) d.z = 1e-3f * d.x;
        Quat q = random_rotation(random);
        Mat3 r = rotation_matrix(q);
        SymMat3 tensor = rotate_diagonal(Mat3T<float>{r.x, r.y, r.z}, d);
        PrincipalInertia p = principal_axes(tensor);
        EXPECT_NEAR(dot(p.rotation, p.rotation), 1.0f, 1e-6f);
        Mat3 back = rotation_matrix(p.rotation);
        SymMat3 again = rotate_diagonal(Mat3T<float>{back.x, back.y, back.z}, p.inertia);
        float tolerance = 2e-6f * max_component(d);
        EXPECT_NEAR(again.xx, tensor.xx, tolerance);
        EXPECT_NEAR(again.yy, tensor.yy, tolerance);
        EXPECT_NEAR(again.zz, tensor.zz, tolerance);
        EXPECT_NEAR(again.xy, tensor.xy, tolerance);
        EXPECT_NEAR(again.xz, tensor.xz, tolerance);
        EXPECT_NEAR(again.yz, tensor.yz, tolerance);
    }
}

TEST(PrincipalAxesTest, DiagonalTensorsKeepTheirAxes) {
    PrincipalInertia p = principal_axes({3, 1, 2, 0, 0, 0});
    EXPECT_EQ(p.rotation, Quat{});
    EXPECT_EQ(p.inertia, (Vec3{3, 1, 2}));
    p = principal_axes({1, 1, 1, 1e-8f, -1e-8f, 1e-8f});  // rounding alone does not turn a cube's axes
    EXPECT_EQ(p.rotation, Quat{});
    EXPECT_EQ(principal_axes({}).rotation, Quat{});
}

}  // namespace
}  // namespace lendulet
