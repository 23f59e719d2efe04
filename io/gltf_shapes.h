// Collision shapes of a glTF file: KHR_implicit_shapes and meshes, with the scale of their node worked into them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_container.h"
#include "io/gltf_nodes.h"
#include "lendulet/body.h"

namespace lendulet {

// Sentences about what was left out or approximated; at most 200 are kept, so that a hostile file cannot pile them up.
class Warnings {
public:
    void add(const std::string& where, const std::string& what);
    std::vector<std::string> take();

private:
    std::vector<std::string> list_;
    size_t omitted_ = 0;
};

// A shape and where it stands in its node's rigid frame.
struct PlacedShape {
    Shape shape;
    Transform local;
};

// The shape of one entry of KHR_implicit_shapes under a node's stretch, for a body of type `type`; nothing where such a
// body cannot have it (a warning says so). Sizes scale by the absolute value of the node's scale. A sphere or capsule
// stretched unevenly, a cylinder stretched unevenly across its axis, and any sheared shape become the hull of points on
// their surface, with a warning.
std::optional<PlacedShape> implicit_shape(const Field& shape, const NodeFrame& frame, BodyType type,
                                          const std::string& where, Warnings& warnings);

// Shapes from the meshes of a node and its children. Colliders that use the same geometry at the same stretch share
// one.
class MeshShapes {
public:
    MeshShapes(const GltfContainer& container, const NodeTree& tree, Warnings& warnings)
        : container_(container), tree_(tree), warnings_(warnings) {}

    // The geometry of node `source`, seen in its own space, under `stretch`: a hull where `convex` or where the body
    // moves, else a triangle mesh. Nothing where the geometry is empty or spans no volume (a warning says so).
    std::optional<Shape> shape(int source, const Mat3d& stretch, bool convex, BodyType type, const std::string& where);

private:
    struct Triangles {
        std::vector<Vec3> points;
        std::vector<uint32_t> indices;
    };
    Triangles gather(int source, const Mat3d& stretch, const std::string& where);
    void add_mesh(int mesh, const Affine& placement, Triangles& out);
    std::optional<Shape> build(const Triangles& triangles, bool convex, BodyType type, const std::string& where);
    void charge(uint64_t bytes, const std::string& where);

    const GltfContainer& container_;
    const NodeTree& tree_;
    Warnings& warnings_;
    struct Key {
        int source;
        bool convex;
        BodyType type;
        std::array<double, 9> stretch;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::optional<Shape>> built_;
    uint64_t bytes_ = 0;  // that the shapes built so far take, about
};

// The hull of `points`; flat ones are given a thickness of half a percent of their size. Empty for fewer than three
// points, points on a line, or all in one. Refuses hulls that are too small or too large.
std::optional<ConvexHull> hull_or_slab(const std::vector<Vec3>& points, const std::string& where, bool& was_flat);

}  // namespace lendulet
