// TriangleMesh::from_triangles: checks, one vertex for each position, neighbours across edges, and the hierarchy.
#include <algorithm>
#include <array>
#include <string>

#include "geometry/hull.h"
#include "geometry/mesh.h"
#include "lendulet/shapes.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
constexpr uint32_t none = ~0u;
constexpr float largest_coordinate = 1e5f;  // m
// A triangle has no area where its height is below this fraction of its longest side: rounding of its corners alone can
// make such a triangle of three points on a line.
constexpr double flat_triangle = 1e-7;

Vec3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3 to_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

Error error(const std::string& text) { return {ErrorCode::bad_mesh, "TriangleMesh: " + text}; }

Error check(std::span<const Vec3> vertices, std::span<const uint32_t> indices, const TriangleOptions& options) {
    if (indices.empty()) return error("there are no triangles.");
    if (indices.size() % 3 != 0) {
        return error("there must be three indices for each triangle, but there are " + std::to_string(indices.size()) +
                     ".");
    }
    if (indices.size() / 3 > 0x3fffffff) return error("there are more than 2^30 triangles.");
    if (!options.materials.empty() && options.materials.size() != indices.size() / 3) {
        return error("there must be a material for each of the " + std::to_string(indices.size() / 3) +
                     " triangles, but there are " + std::to_string(options.materials.size()) + ".");
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
        Vec3 zero = vertices[i] - vertices[i];
        if (!(zero == Vec3{})) return error("vertex " + std::to_string(i) + " is not finite.");
        if (max_component(absolute(vertices[i])) > largest_coordinate) {
            return error("vertex " + std::to_string(i) + " has a coordinate beyond 1e5 m.");
        }
    }
    for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < vertices.size()) continue;
        return error("index " + std::to_string(i) + " is " + std::to_string(indices[i]) + ", but there are only " +
                     std::to_string(vertices.size()) + " vertices.");
    }
    return {ErrorCode::bad_mesh, {}};
}

// For each vertex the first one at exactly the same position.
std::vector<uint32_t> weld(std::span<const Vec3> vertices) {
    std::vector<uint32_t> order(vertices.size()), first(vertices.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    // order: total, ties by index; 0 and -0 compare equal
    std::sort(order.begin(), order.end(), [&](uint32_t i, uint32_t j) {
        Vec3 a = vertices[i], b = vertices[j];
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : i < j;
    });
    for (size_t k = 0; k < order.size(); ++k) {
        bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    return first;
}

// Normal of a triangle, or the zero vector where it has no area.
Vec3d area_normal(Vec3 a, Vec3 b, Vec3 c) {
    Vec3d ab = to_double(b) - to_double(a), ac = to_double(c) - to_double(a), bc = ac - ab;
    Vec3d n = cross(ab, ac);
    double area = __builtin_sqrt(dot(n, n)), longest = dot(ab, ab);
    if (dot(ac, ac) > longest) longest = dot(ac, ac);
    if (dot(bc, bc) > longest) longest = dot(bc, bc);
    return area > flat_triangle * longest ? (1.0 / area) * n : Vec3d{};
}

// Triangles with area over vertices in use, in the user's order.
void add_triangles(MeshData& mesh, std::span<const Vec3> vertices, std::span<const uint32_t> indices) {
    std::vector<uint32_t> first = weld(vertices), number(vertices.size(), none);
    for (size_t t = 0; t < indices.size() / 3; ++t) {
        MeshTriangle triangle{};
        uint32_t corner[3];
        for (size_t k = 0; k < 3; ++k) corner[k] = first[indices[3 * t + k]];
        Vec3d normal = area_normal(vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]);
        if (dot(normal, normal) == 0.0) {
            ++mesh.dropped;
            continue;
        }
        for (size_t k = 0; k < 3; ++k) {
            if (number[corner[k]] == none) {
                number[corner[k]] = static_cast<uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(vertices[corner[k]]);
            }
            triangle.vertex[k] = number[corner[k]];
            triangle.neighbour[k] = -1;
        }
        triangle.original = static_cast<uint32_t>(t);
        triangle.convex_edges = triangle.concave_edges = triangle.sharp_edges = 7;
        mesh.triangles.push_back(triangle);
        mesh.normals.push_back(normalize(to_float(normal)));
    }
}

// Puts triangles and normals into the order of the hierarchy's leaves.
void make_hierarchy(MeshData& mesh) {
    std::vector<TriangleBounds> bounds;
    bounds.reserve(mesh.triangles.size());
    for (const MeshTriangle& t : mesh.triangles) {
        Vec3 a = mesh.vertices[t.vertex[0]], b = mesh.vertices[t.vertex[1]], c = mesh.vertices[t.vertex[2]];
        bounds.push_back({minimum(minimum(a, b), c), maximum(maximum(a, b), c)});
    }
    std::vector<uint32_t> order = build_hierarchy(bounds, mesh.nodes);
    std::vector<MeshTriangle> triangles;
    std::vector<Vec3> normals;
    triangles.reserve(order.size()), normals.reserve(order.size());
    for (uint32_t i : order) {
        triangles.push_back(mesh.triangles[i]);
        normals.push_back(mesh.normals[i]);
    }
    mesh.triangles.swap(triangles);
    mesh.normals.swap(normals);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.place[mesh.triangles[i].original] = i;
}

void classify_edge(MeshData& mesh, uint32_t t, uint32_t k, uint32_t n, uint32_t far_corner) {
    MeshTriangle& triangle = mesh.triangles[t];
    triangle.neighbour[k] = static_cast<int32_t>(n);
    EdgeBend bend = bend_across(mesh.vertices[triangle.vertex[k]], mesh.vertices[triangle.vertex[(k + 1) % 3]],
                                mesh.vertices[mesh.triangles[n].vertex[far_corner]], mesh.normals[t], mesh.normals[n]);
    auto cleared = static_cast<uint8_t>(~(1u << k));
    if (!bend.touches_front) triangle.convex_edges &= cleared;
    if (!bend.touches_back) triangle.concave_edges &= cleared;
    if (!bend.sharp) triangle.sharp_edges &= cleared;
}

// Two triangles are neighbours where exactly these two share an edge and run along it in opposite directions.
void find_neighbours(MeshData& mesh) {
    struct Edge {
        uint64_t corners;  // the smaller index in the high half
        uint32_t half_edge;
    };
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            uint64_t a = mesh.triangles[t].vertex[k], b = mesh.triangles[t].vertex[(k + 1) % 3];
            edges.push_back({a < b ? a << 32 | b : b << 32 | a, 3 * t + k});
        }
    // order: total, no half edge comes twice
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.half_edge < b.half_edge;
    });
    for (size_t first = 0, last; first < edges.size(); first = last) {
        for (last = first + 1; last < edges.size() && edges[last].corners == edges[first].corners;) ++last;
        if (last != first + 2) continue;
        uint32_t e = edges[first].half_edge, f = edges[first + 1].half_edge;
        bool opposite = mesh.triangles[e / 3].vertex[e % 3] != mesh.triangles[f / 3].vertex[f % 3];
        if (!opposite) continue;
        classify_edge(mesh, e / 3, e % 3, f / 3, (f + 2) % 3);
        classify_edge(mesh, f / 3, f % 3, e / 3, (e + 2) % 3);
    }
}

void set_extent(MeshData& mesh) {
    mesh.lower = mesh.upper = mesh.vertices[0];
    for (Vec3 v : mesh.vertices) {
        mesh.lower = minimum(mesh.lower, v);
        mesh.upper = maximum(mesh.upper, v);
        mesh.radius = maximum(length(v), mesh.radius);
    }
}

}  // namespace

// The height of the neighbour's far corner over the triangle's plane decides. A neighbour that folds back onto the
// triangle makes the edge a border to both sides.
EdgeBend bend_across(Vec3 from, Vec3 to, Vec3 far, Vec3 normal, Vec3 neighbour_normal) {
    Vec3d a = to_double(from), edge = to_double(to) - a, out = to_double(far) - a, n = to_double(normal);
    Vec3d across = out - (dot(out, edge) / dot(edge, edge)) * edge;
    double height = dot(n, across), reach = __builtin_sqrt(dot(across, across));
    bool folded = dot(n, to_double(neighbour_normal)) < 0.0;
    bool rises = height > flat_edge_sine * reach, falls = height < -flat_edge_sine * reach;
    bool gentle = height <= gentle_edge_sine * reach && height >= -gentle_edge_sine * reach;
    return {falls || (folded && !rises), rises || (folded && !falls), folded || !gentle};
}

Vec3 normal_of_triangle(Vec3 a, Vec3 b, Vec3 c) {
    Vec3d n = area_normal(a, b, c);
    return dot(n, n) == 0.0 ? Vec3{} : normalize(to_float(n));
}

Result<TriangleMesh> TriangleMesh::from_triangles(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                                                  const TriangleOptions& options) {
    Error refused = check(vertices, indices, options);
    if (!refused.message.empty()) return refused;
    auto data = std::make_shared<MeshData>();
    data->one_sided = options.one_sided;
    data->materials.assign(options.materials.begin(), options.materials.end());
    for (uint8_t m : data->materials) data->most_material = m > data->most_material ? m : data->most_material;
    add_triangles(*data, vertices, indices);
    if (data->triangles.empty()) return error("none of its triangles has any area.");
    data->place.assign(indices.size() / 3, 0);
    make_hierarchy(*data);
    find_neighbours(*data);
    set_extent(*data);
    if (Result<ConvexHull> hull = ConvexHull::from_points(data->vertices)) {
        // The hull's data lives as long as the ConvexHull that shares it: the mesh keeps that one alive.
        auto owner = std::make_shared<ConvexHull>(hull.value());
        data->hull = std::shared_ptr<const HullData>(owner, &owner->data());
    }
    TriangleMesh mesh;
    mesh.data_ = std::move(data);
    return mesh;
}

int TriangleMesh::triangle_count() const { return data_ ? static_cast<int>(data_->triangles.size()) : 0; }

std::span<const Vec3> TriangleMesh::vertices() const {
    return data_ ? std::span<const Vec3>(data_->vertices) : std::span<const Vec3>{};
}

std::vector<uint32_t> TriangleMesh::triangles() const {
    if (!data_) return {};
    std::vector<uint32_t> place(data_->triangles.size()), indices;
    for (uint32_t i = 0; i < place.size(); ++i) place[i] = i;
    auto given = [&](uint32_t i) { return data_->triangles[i].original; };
    // order: total, each was given once
    std::sort(place.begin(), place.end(), [&](uint32_t a, uint32_t b) { return given(a) < given(b); });
    indices.reserve(3 * place.size());
    for (uint32_t i : place) indices.insert(indices.end(), data_->triangles[i].vertex, data_->triangles[i].vertex + 3);
    return indices;
}

int TriangleMesh::material(int triangle) const {
    auto i = static_cast<size_t>(triangle);
    return data_ && triangle >= 0 && i < data_->materials.size() ? data_->materials[i] : 0;
}

bool TriangleMesh::is_one_sided() const { return data_ && data_->one_sided; }

int TriangleMesh::dropped_triangles() const { return data_ ? data_->dropped : 0; }

}  // namespace lendulet
