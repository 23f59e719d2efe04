// Collision geometry from the meshes of a node: triangle meshes and convex hulls.
#include <algorithm>
#include <utility>

#include "io/gltf_accessor.h"
#include "io/gltf_shapes.h"

namespace lendulet {

void Warnings::add(const std::string& where, const std::string& what) {
    constexpr size_t most = 200;
    std::string sentence = where.empty() ? what : where + ": " + what;
    if (list_.size() < most) list_.push_back(std::move(sentence));
    else ++omitted_;
}

std::vector<std::string> Warnings::take() {
    if (omitted_) list_.push_back("and " + std::to_string(omitted_) + " further warnings");
    return std::move(list_);
}

namespace {

// The triangles of a primitive as index triples, whatever its mode; fewer than three for points and lines.
std::vector<uint32_t> triangulate(std::vector<uint32_t> list, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        list.resize(list.size() / 3 * 3);
        return list;
    }
    std::vector<uint32_t> out;
    if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) return out;
    for (size_t i = 2; i < list.size(); ++i) {
        bool odd = (i & 1) != 0;
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) out.insert(out.end(), {list[0], list[i - 1], list[i]});
        else if (odd) out.insert(out.end(), {list[i - 1], list[i - 2], list[i]});
        else out.insert(out.end(), {list[i - 2], list[i - 1], list[i]});
    }
    return out;
}

// Drops points that no index names: primitives may share one long list of positions.
void keep_used(std::vector<Vec3>& points, std::vector<uint32_t>& indices) {
    constexpr uint32_t unused = ~uint32_t{0};
    std::vector<uint32_t> place(points.size(), unused);
    for (uint32_t i : indices) place[i] = 0;
    uint32_t kept = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        if (place[i] == unused) continue;
        points[kept] = points[i];
        place[i] = kept++;
    }
    points.resize(kept);
    for (uint32_t& i : indices) i = place[i];
}

// The index of the point at which a measure is largest.
template <class Measure>
size_t farthest(const std::vector<Vec3>& points, Measure measure) {
    size_t best = 0;
    for (size_t i = 1; i < points.size(); ++i) {
        if (measure(points[i]) > measure(points[best])) best = i;
    }
    return best;
}

}  // namespace

std::optional<ConvexHull> hull_or_slab(const std::vector<Vec3>& points, const std::string& where, bool& was_flat) {
    was_flat = false;
    if (points.size() < 3) return std::nullopt;
    Result<ConvexHull> hull = ConvexHull::from_points(points);
    if (hull.ok()) return std::move(hull).value();
    if (hull.error().code != ErrorCode::degenerate_hull) refuse(where, hull.error().message, hull.error().code);
    // A triangle as large as can be found quickly gives the plane: the point farthest from the first, then the one
    // farthest from the line through both.
    Vec3 a = points[0];
    Vec3 b = points[farthest(points, [&](Vec3 p) { return length_squared(p - a); })];
    Vec3 c = points[farthest(points, [&](Vec3 p) { return length_squared(cross(p - a, b - a)); })];
    float size = length(b - a);
    Vec3 normal = cross(b - a, c - a);
    if (!(length(normal) > 1e-4f * size * size) || !(size > 0.0f)) return std::nullopt;
    Vec3 offset = maximum(0.005f * size, 1e-4f) * normalize(normal);
    std::vector<Vec3> slab;
    slab.reserve(2 * points.size());
    for (Vec3 p : points) slab.insert(slab.end(), {p + offset, p - offset});
    Result<ConvexHull> thick = ConvexHull::from_points(slab);
    if (!thick.ok()) return std::nullopt;
    was_flat = true;
    return std::move(thick).value();
}

void MeshShapes::charge(uint64_t bytes, const std::string& where) {
    bytes_ += bytes;
    if (bytes_ > container_.memory_limit)
        refuse(where, "the meshes that collide are larger than the file's size allows");
}

void MeshShapes::add_mesh(int mesh, const Affine& placement, Triangles& out) {
    std::string where = "meshes[" + std::to_string(mesh) + "]";
    if (container_.compressed_meshes[static_cast<size_t>(mesh)]) {
        refuse(where, "is compressed with KHR_draco_mesh_compression, which is not read");
    }
    for (const tinygltf::Primitive& primitive : container_.model.meshes[static_cast<size_t>(mesh)].primitives) {
        auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) continue;
        std::vector<Vec3> points = read_points(container_, position->second);
        std::vector<uint32_t> indices;
        if (primitive.indices >= 0) {
            indices = read_indices(container_, primitive.indices);
        } else {
            indices.resize(points.size());
            for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
        }
        for (uint32_t i : indices) {
            if (i >= points.size()) {
                refuse(where,
                       "has index " + std::to_string(i) + " among " + std::to_string(points.size()) + " vertices");
            }
        }
        charge(sizeof(Vec3) * points.size() + 100 * (indices.size() / 3), where);
        keep_used(points, indices);
        uint32_t base = static_cast<uint32_t>(out.points.size());
        for (Vec3 p : points) {
            out.points.push_back(to_float(placement.linear * Vec3d{p.x, p.y, p.z} + placement.translation));
        }
        int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        bool mirrored = determinant(placement.linear) < 0.0;
        indices = triangulate(std::move(indices), mode);
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            if (mirrored) std::swap(indices[i + 1], indices[i + 2]);
            out.indices.insert(out.indices.end(), {base + indices[i], base + indices[i + 1], base + indices[i + 2]});
        }
    }
}

MeshShapes::Triangles MeshShapes::gather(int source, const Mat3d& stretch, const std::string& where) {
    Triangles out;
    std::vector<std::pair<int, Affine>> stack{{source, {stretch, {}}}};
    while (!stack.empty()) {
        auto [index, placement] = stack.back();
        stack.pop_back();
        const GltfNode& node = tree_.nodes[static_cast<size_t>(index)];
        if (node.skinned) warnings_.add(where, "the skin of " + tree_.describe(index) + " is ignored");
        if (node.mesh >= 0) add_mesh(node.mesh, placement, out);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            stack.push_back({*child, placement * tree_.nodes[static_cast<size_t>(*child)].local});
        }
    }
    return out;
}

std::optional<Shape> MeshShapes::build(const Triangles& triangles, bool convex, BodyType type,
                                       const std::string& where) {
    if (!convex && type != BodyType::dynamic) {
        Result<TriangleMesh> mesh = TriangleMesh::from_triangles(triangles.points, triangles.indices);
        if (!mesh.ok()) {
            warnings_.add(where, "its mesh cannot collide (" + mesh.error().message + "); the collider is left out");
            return std::nullopt;
        }
        return Shape{std::move(mesh).value()};
    }
    if (!convex) warnings_.add(where, "a mesh on a moving body collides as its convex hull");
    bool was_flat = false;
    std::optional<ConvexHull> hull = hull_or_slab(triangles.points, where, was_flat);
    if (!hull) {
        warnings_.add(where, "its mesh spans no volume; the collider is left out");
        return std::nullopt;
    }
    if (was_flat) warnings_.add(where, "its convex hull is flat and collides as a thin slab");
    return Shape{std::move(*hull)};
}

std::optional<Shape> MeshShapes::shape(int source, const Mat3d& stretch, bool convex, BodyType type,
                                       const std::string& where) {
    const Mat3d& s = stretch;
    Key key{source, convex, type, {s.x.x, s.x.y, s.x.z, s.y.x, s.y.y, s.y.z, s.z.x, s.z.y, s.z.z}};
    auto found = built_.find(key);
    if (found != built_.end()) return found->second;
    Triangles triangles = gather(source, stretch, where);
    if (triangles.points.empty()) {
        warnings_.add(where, "its geometry has no vertices; the collider is left out");
        return built_[key] = std::nullopt;
    }
    return built_[key] = build(triangles, convex, type, where);
}

}  // namespace lendulet
