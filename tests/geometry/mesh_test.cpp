// Triangle meshes: checks, adjacency against brute force, and the hierarchy against a plain loop.
#include <numeric>

#include "geometry/mesh.h"
#include "hull_check.h"
#include "lendulet/shapes.h"

namespace lendulet {
namespace {

struct Soup {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    const MeshData& build() {
        Result<TriangleMesh> result = TriangleMesh::from_triangles(vertices, indices);
        EXPECT_TRUE(result.ok()) << result.error().message;
        mesh = std::move(result).value();
        return mesh.data();
    }
    TriangleMesh mesh;
};

// A height field of n x n cells with front faces up.
template <class Height>
Soup terrain(int n, Height height) {
    Soup s;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
            auto x = static_cast<float>(i), z = static_cast<float>(k);
            s.vertices.push_back({x, height(x, z), z});
        }
    auto at = [n](int i, int k) { return static_cast<uint32_t>(i * (n + 1) + k); };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            uint32_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
            s.indices.insert(s.indices.end(), {a, d, c, a, c, b});
        }
    return s;
}

Soup random_soup(std::mt19937& random, int count, float size) {
    Soup s;
    for (int t = 0; t < count; ++t) {
        Vec3 centre = random_vector(random, 10.0f);
        for (int k = 0; k < 3; ++k) {
            s.indices.push_back(static_cast<uint32_t>(s.vertices.size()));
            s.vertices.push_back(centre + random_vector(random, size));
        }
    }
    return s;
}

void expect_finds_all(const MeshData& mesh, std::mt19937& random, int queries, float range, float size) {
    for (int q = 0; q < queries; ++q) {
        Vec3 lower = random_vector(random, range), upper = lower + absolute(random_vector(random, size));
        std::vector<int> visits(mesh.triangles.size(), 0);
        int previous = -1, steps_back = 0;
        for_each_triangle(mesh, lower, upper, [&](uint32_t t) {
            ++visits[t];
            steps_back += static_cast<int>(t) < previous;
            previous = static_cast<int>(t);
        });
        for (size_t t = 0; t < visits.size(); ++t) {
            const uint32_t* v = mesh.triangles[t].vertex;
            Vec3 a = mesh.vertices[v[0]], b = mesh.vertices[v[1]], c = mesh.vertices[v[2]];
            Vec3 l = minimum(minimum(a, b), c), u = maximum(maximum(a, b), c);
            bool touches = max_component(l - upper) <= 0.0f && max_component(lower - u) <= 0.0f;
            ASSERT_LE(visits[t], 1);
            ASSERT_GE(visits[t], touches ? 1 : 0);
        }
    }
}

int visited(const MeshData& mesh, Vec3 lower, Vec3 upper) {
    int count = 0;
    for_each_triangle(mesh, lower, upper, [&](uint32_t) { ++count; });
    return count;
}

int depth_of(const MeshData& mesh, int32_t node = 0) {
    int deepest = 0;
    for (int i = 0; i < 8; ++i)
        if (mesh.nodes[static_cast<size_t>(node)].child[i] > 0)
            deepest = std::max(deepest, depth_of(mesh, mesh.nodes[static_cast<size_t>(node)].child[i]));
    return deepest + 1;
}

TEST(MeshTest, BadInputNamesTheIndex) {
    std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<uint32_t> indices{0, 1, 2};
    auto message = [](const std::vector<Vec3>& v, const std::vector<uint32_t>& i) {
        Result<TriangleMesh> mesh = TriangleMesh::from_triangles(v, i);
        EXPECT_FALSE(mesh.ok());
        if (mesh.ok()) return std::string();
        EXPECT_EQ(mesh.error().code, ErrorCode::bad_mesh);
        return mesh.error().message;
    };
    EXPECT_NE(message(vertices, {}).find("no triangles"), std::string::npos);
    EXPECT_NE(message(vertices, {0, 1}).find("three indices"), std::string::npos);
    EXPECT_NE(message(vertices, {0, 1, 3}).find("index 2 is 3"), std::string::npos);
    EXPECT_NE(message(vertices, {0, 1, 1}).find("any area"), std::string::npos);
    vertices[1].z = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(message(vertices, indices).find("vertex 1"), std::string::npos);
    vertices[1].z = 1e6f;
    EXPECT_NE(message(vertices, indices).find("vertex 1"), std::string::npos);
}

TEST(MeshTest, TrianglesWithoutAreaAreDroppedAndCounted) {
    Soup s;
    s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {1, 0, 0}, {9, 9, 9}};
    s.indices = {0, 1, 2, 0, 1, 3, 1, 4, 2, 2, 1, 3};
    const MeshData& mesh = s.build();
    EXPECT_EQ(s.mesh.triangle_count(), 2);
    EXPECT_EQ(s.mesh.dropped_triangles(), 2);
    EXPECT_EQ(mesh.vertices.size(), 4u);  // each position in use once
    EXPECT_EQ(mesh.upper, (Vec3{2, 1, 0}));
    EXPECT_EQ(mesh.hull, nullptr);
    std::set<uint32_t> originals;
    for (const MeshTriangle& t : mesh.triangles) originals.insert(t.original);
    EXPECT_EQ(originals, (std::set<uint32_t>{0, 3}));
}

TEST(MeshTest, NeighboursAreFoundAcrossDuplicatedVertices) {
    std::mt19937 random(41);
    Soup s = terrain(12, [&](float, float) { return std::uniform_real_distribution<float>(-1, 1)(random); });
    Soup split;  // every triangle with corners of its own
    for (uint32_t i : s.indices) {
        split.indices.push_back(static_cast<uint32_t>(split.vertices.size()));
        split.vertices.push_back(s.vertices[i]);
    }
    const MeshData& mesh = split.build();
    EXPECT_EQ(mesh.vertices.size(), s.vertices.size());
    int borders = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const MeshTriangle& triangle = mesh.triangles[t];
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t a = triangle.vertex[k], b = triangle.vertex[(k + 1) % 3];
            int expected = -1, far = 0;
            for (uint32_t n = 0; n < mesh.triangles.size(); ++n)
                for (uint32_t j = 0; j < 3; ++j)
                    if (mesh.triangles[n].vertex[j] == b && mesh.triangles[n].vertex[(j + 1) % 3] == a) {
                        expected = static_cast<int>(n);
                        far = static_cast<int>(mesh.triangles[n].vertex[(j + 2) % 3]);
                    }
            ASSERT_EQ(triangle.neighbour[k], expected);
            bool convex = triangle.convex_edges >> k & 1, concave = triangle.concave_edges >> k & 1;
            if (expected < 0) {
                ++borders;
                EXPECT_TRUE(convex && concave);
            } else {
                double height = dot_double(mesh.normals[t], mesh.vertices[static_cast<size_t>(far)] - mesh.vertices[a]);
                EXPECT_FALSE(convex && concave);
                EXPECT_TRUE(convex ? height < 0.0 : concave ? height > 0.0 : std::abs(height) < 0.03);
            }
        }
    }
    EXPECT_EQ(borders, 4 * 12);
}

TEST(MeshTest, FlatEdgesDoNotTouchAndFoldsDo) {
    Soup flat = terrain(4, [](float, float) { return 0.0f; });
    const MeshData& mesh = flat.build();
    for (const MeshTriangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(t.convex_edges >> k & 1, t.neighbour[k] < 0);
            EXPECT_EQ(t.concave_edges >> k & 1, t.neighbour[k] < 0);
        }
    Soup fold;  // the second triangle lies back on the first
    fold.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2f, 0.9f, 0}};
    fold.indices = {0, 1, 2, 1, 0, 3};
    const MeshData& folded = fold.build();
    EXPECT_EQ(folded.triangles[0].convex_edges, 7);
    EXPECT_EQ(folded.triangles[0].concave_edges, 7);
}

TEST(MeshTest, InconsistentWindingAndSharedEdgesHaveNoNeighbour) {
    Soup s;
    s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}};
    s.indices = {0, 1, 2, 1, 2, 3};  // both run along 1 -> 2
    for (const MeshTriangle& t : s.build().triangles) {
        for (int32_t n : t.neighbour) EXPECT_EQ(n, -1);
        EXPECT_EQ(t.convex_edges, 7);
    }
    s.indices = {0, 1, 2, 2, 1, 3, 2, 1, 4};  // three triangles at one edge
    for (const MeshTriangle& t : s.build().triangles)
        for (int32_t n : t.neighbour) EXPECT_EQ(n, -1);
    s.indices = {0, 1, 2, 0, 1, 2};
    EXPECT_EQ(s.build().triangles.size(), 2u);
}

TEST(MeshTest, HierarchyFindsWhatAPlainLoopFinds) {
    std::mt19937 random(42);
    for (int count : {1, 2, 3, 8, 17, 100, 1000}) {
        Soup s = random_soup(random, count, 1.0f);
        const MeshData& mesh = s.build();
        std::vector<uint32_t> originals;
        for (const MeshTriangle& t : mesh.triangles) originals.push_back(t.original);
        std::sort(originals.begin(), originals.end());
        std::vector<uint32_t> all(static_cast<size_t>(count));
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(originals, all);
        expect_finds_all(mesh, random, 100, 11.0f, 4.0f);
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const uint32_t* v = mesh.triangles[i].vertex;
            Vec3 n = cross(mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]]);
            EXPECT_GT(dot(normalize(n), mesh.normals[i]), 0.999f);
        }
    }
}

TEST(MeshTest, SmallQueriesVisitFewTriangles) {
    Soup s = terrain(200, [](float x, float z) { return 2.0f * sin_cos(0.1f * x).sin * sin_cos(0.13f * z).cos; });
    const MeshData& mesh = s.build();
    EXPECT_EQ(mesh.triangles.size(), 80000u);
    EXPECT_LE(visited(mesh, {100.2f, -3, 100.2f}, {100.8f, 3, 100.8f}), 8);
    EXPECT_EQ(visited(mesh, {-5, 10, -5}, {300, 11, 300}), 0);
    EXPECT_EQ(visited(mesh, {-5, -10, -5}, {300, 11, 300}), 80000);
    EXPECT_LE(depth_of(mesh), 9);
}

// Nested triangles of sizes 2^k, and triangles on one spot, defeat any choice by area.
TEST(MeshTest, DepthIsBounded) {
    Soup nested;
    for (int k = 0; k < 60; ++k) {
        float size = 1e5f * std::ldexp(1.0f, -k);
        for (Vec3 v : {Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, size, 0}}) {
            nested.indices.push_back(static_cast<uint32_t>(nested.vertices.size()));
            nested.vertices.push_back(v);
        }
    }
    EXPECT_LE(depth_of(nested.build()), max_mesh_depth);
    Soup same;
    same.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int k = 0; k < 5000; ++k) same.indices.insert(same.indices.end(), {0, 1, 2});
    const MeshData& mesh = same.build();
    EXPECT_LE(depth_of(mesh), 6);
    EXPECT_EQ(visited(mesh, {0, 0, 0}, {1, 1, 1}), 5000);
}

TEST(MeshTest, HullOfAMeshHoldsIt) {
    Soup s = terrain(10, [](float x, float z) { return 0.1f * x * z; });
    const MeshData& mesh = s.build();
    ASSERT_NE(mesh.hull, nullptr);
    expect_valid_hull(*mesh.hull, mesh.vertices);
}

}  // namespace
}  // namespace lendulet
