// Height fields: what is refused, the same triangles and edges as a mesh of them, and bounds that leave nothing out.
#include "geometry/height_field.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "geometry/triangle_surface.h"

namespace lendulet {
namespace {

struct Samples {
    std::vector<float> heights;
    std::vector<uint8_t> holes, materials;
    HeightFieldDef def;
    Samples(int columns, int rows, unsigned seed, float rough) {
        std::mt19937 random(seed);
        auto unit = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
        for (int i = 0; i < columns * rows; ++i) heights.push_back(rough * (unit() - 0.5f));
        for (int i = 0; i < (columns - 1) * (rows - 1); ++i) holes.push_back(random() % 7 == 0);
        for (int i = 0; i < 2 * (columns - 1) * (rows - 1); ++i)
            materials.push_back(static_cast<uint8_t>(random() % 5));
        def.columns = columns, def.rows = rows;
        def.cell_x = 0.5f, def.cell_z = 0.7f;
        def.origin = {-3.0f, 0.25f, 1.0f};
        def.heights = heights;
    }
};

std::string refusal(const HeightFieldDef& def) {
    Result<HeightField> field = HeightField::from_heights(def);
    EXPECT_FALSE(field.ok());
    if (field.ok()) return {};
    EXPECT_EQ(field.error().code, ErrorCode::bad_mesh);
    return field.error().message;
}

TEST(HeightField, BadInputNamesTheProblem) {
    Samples s(5, 4, 1, 1.0f);
    ASSERT_TRUE(HeightField::from_heights(s.def).ok());
    EXPECT_NE(refusal({}).find("at least two columns"), std::string::npos);
    auto refused = [&](const char* sentence, auto&& change) {
        Samples bad = s;
        bad.def.heights = bad.heights;
        change(bad);
        EXPECT_NE(refusal(bad.def).find(sentence), std::string::npos) << sentence << ": " << refusal(bad.def);
    };
    refused("there are 20 heights, but there must be 25", [](Samples& b) { b.def.columns = b.def.rows = 5; });
    refused("there are 12 holes, but there must be 16", [&](Samples& b) {
        b.heights.resize(25);
        b.def.columns = b.def.rows = 5, b.def.heights = b.heights, b.def.holes = s.holes;
    });
    refused("there are 3 materials", [&](Samples& b) { b.def.materials = std::span(s.materials).first(3); });
    refused("column 2, row 1 is not finite",
            [](Samples& b) { b.heights[7] = std::numeric_limits<float>::quiet_NaN(); });
    refused("column 0, row 0 is beyond 1e5 m", [](Samples& b) { b.heights[0] = 2e5f; });
    refused("more than 1000 times", [](Samples& b) { b.heights[3] = 600.0f; });
    refused("x: cells must be", [](Samples& b) { b.def.cell_x = -1.0f; });
    refused("z: cells must be", [](Samples& b) { b.def.cell_z = std::numeric_limits<float>::quiet_NaN(); });
    refused("100 times as long as wide", [](Samples& b) { b.def.cell_z = 100.0f; });
    refused("x: the origin must be finite", [](Samples& b) { b.def.origin.x = INFINITY; });
    refused("the origin must be finite", [](Samples& b) { b.def.origin.y = INFINITY; });
    refused("beyond 1e5 m", [](Samples& b) { b.def.origin.z = 1e5f; });
    refused("65536 cells", [](Samples& b) { b.def.origin.z = 6e4f; });
    refused("more than 2^29 cells", [](Samples& b) { b.def.columns = b.def.rows = 1 << 20; });
    refused("nothing but holes", [](Samples& b) {
        b.holes.assign(12, 1);
        b.def.holes = b.holes;
    });
}

// The same triangles as a mesh: their normals to the bit, neighbours, how edges bend, and materials.
TEST(HeightField, IsTheMeshOfItsTriangles) {
    for (float rough : {0.0f, 0.004f, 1.0f}) {  // the middle one bends by about what still counts as flat
        Samples s(23, 14, 3, rough);
        s.def.holes = s.holes, s.def.materials = s.materials;
        HeightField field = HeightField::from_heights(s.def).value();
        std::vector<uint32_t> indices = field.triangles(), number;
        for (uint32_t t = 0; t < field.data().edges.size(); ++t)
            if (!field.is_hole(static_cast<int>(t / 2) % 22, static_cast<int>(t / 2) / 22)) number.push_back(t);
        ASSERT_EQ(number.size() * 3, indices.size());
        ASSERT_EQ(static_cast<size_t>(field.triangle_count()), number.size());
        TriangleMesh mesh = TriangleMesh::from_triangles(field.vertices(), indices).value();
        Geometry of_mesh = make_geometry(mesh).value(), of_field = make_geometry(field).value();
        TriangleSurface a(of_mesh), b(of_field);
        int bent = 0;
        for (uint32_t t = 0; t < mesh.data().triangles.size(); ++t) {
            uint32_t n = number[a.original(t)];
            Vec3 p[3], q[3];
            a.corners(t, p), b.corners(n, q);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(p[k], q[k]);
            EXPECT_EQ(a.normal(t), b.normal(n));
            EXPECT_EQ(a.convex_edges(t), b.convex_edges(n)) << n;
            EXPECT_EQ(a.concave_edges(t), b.concave_edges(n)) << n;
            bent += a.convex_edges(t) != 0;
            for (int k = 0; k < 3; ++k) {
                int32_t over = a.neighbour(t, k);
                int32_t expected =
                    over < 0 ? -1 : static_cast<int32_t>(number[a.original(static_cast<uint32_t>(over))]);
                EXPECT_EQ(b.neighbour(n, k), expected);
            }
            EXPECT_EQ(field.material(static_cast<int>(n)), s.materials[n]);
        }
        EXPECT_GT(bent, 20);
        EXPECT_EQ(field.data().lower, mesh.data().lower);
        EXPECT_EQ(field.data().upper, mesh.data().upper);
        EXPECT_EQ(field.data().most_material, 4);
    }
}

TEST(HeightField, BoxesFindAllTrianglesThatTouchThem) {
    std::mt19937 random(11);
    auto in = [&](float low, float high) {
        return low + (high - low) * (static_cast<float>(random() >> 8) / 16777216.0f);
    };
    for (auto [columns, rows] : {std::pair{2, 2}, {40, 3}, {33, 65}}) {
        Samples s(columns, rows, 5, 2.0f);
        if (columns > 2) s.def.holes = s.holes;
        HeightField field = HeightField::from_heights(s.def).value();
        const HeightFieldData& f = field.data();
        int found = 0;
        for (int q = 0; q < 400; ++q) {
            Vec3 lower{in(-5.0f, 20.0f), in(-1.5f, 1.5f), in(-5.0f, 50.0f)};
            float size = q % 5 == 0 ? 40.0f : 1.0f;
            Vec3 upper = lower + Vec3{in(0.0f, size), in(0.0f, 1.0f), in(0.0f, size)};
            if (q % 7 == 0) lower = f.vertex(q % columns, q % rows), upper = lower;  // just touches
            std::vector<int> visits(f.edges.size(), 0);
            for_each_triangle(f, lower, upper, [&](uint32_t t) { ++visits[t]; });
            for (uint32_t t = 0; t < visits.size(); ++t) {
                Vec3 p[3];
                f.corners(t, p);
                Vec3 l = minimum(minimum(p[0], p[1]), p[2]), u = maximum(maximum(p[0], p[1]), p[2]);
                bool touches = max_component(l - upper) <= 0.0f && max_component(lower - u) <= 0.0f;
                bool hole = (f.edges[t] & HeightFieldData::no_triangle) != 0;
                ASSERT_LE(visits[t], hole ? 0 : 1);
                ASSERT_GE(visits[t], touches && !hole ? 1 : 0);
                found += visits[t];
            }
        }
        EXPECT_GT(found, 50);
    }
}

TEST(HeightField, MassIsNone) {
    Samples s(5, 4, 1, 1.0f);
    EXPECT_EQ(mass_properties(HeightField::from_heights(s.def).value(), 1000.0f).mass, 0.0f);
    EXPECT_FALSE(make_geometry(HeightField{}).ok());
    EXPECT_EQ(HeightField{}.triangle_count(), 0);
}

}  // namespace
}  // namespace lendulet
