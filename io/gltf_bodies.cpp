#include "io/gltf_bodies.h"

#include <map>

#include "io/gltf_materials.h"
#include "io/gltf_motion.h"

namespace lendulet {

namespace {

// Reads colliders and triggers of single nodes.
class ColliderReader {
public:
    ColliderReader(const GltfContainer& container, const NodeTree& tree, Warnings& warnings)
        : tree_(tree),
          warnings_(warnings),
          meshes_(container, tree, warnings),
          shapes_(container.root()["extensions"]["KHR_implicit_shapes"]["shapes"]) {
        Field physics = container.root()["extensions"]["KHR_physics_rigid_bodies"];
        materials_ = read_materials(physics["physicsMaterials"], warnings);
        filters_ = read_filters(physics["collisionFilters"], warnings);
    }

    // Appends the collider and the trigger of `node`, if it has them, placed in the frame of the body at `frame`.
    void read(int node, const NodeFrame& frame, BodyType type, std::vector<ColliderDef>& out) {
        Field physics = tree_.nodes[static_cast<size_t>(node)].physics_field(node);
        for (const char* kind : {"collider", "trigger"}) {
            Field field = physics[kind];
            // A trigger made of the triggers of other nodes has no geometry; those nodes have.
            if (!field || (!field["geometry"] && field["nodes"])) continue;
            std::optional<PlacedShape> placed = read_geometry(node, field["geometry"], type);
            if (!placed) continue;
            ColliderDef collider{};
            collider.shape = std::move(placed->shape);
            collider.local = relative(frame, tree_.nodes[static_cast<size_t>(node)].frame) * placed->local;
            collider.is_trigger = kind[0] == 't';
            collider.user_data = static_cast<uint64_t>(node);
            int filter = field["collisionFilter"].index_or(-1, filters_.size(), "collisionFilters");
            if (filter >= 0) collider.filter = filters_[static_cast<size_t>(filter)];
            int material = field["physicsMaterial"].index_or(-1, materials_.size(), "physicsMaterials");
            if (material >= 0) collider.material = materials_[static_cast<size_t>(material)];
            out.push_back(std::move(collider));
        }
    }

private:
    std::optional<PlacedShape> read_geometry(int node, const Field& geometry, BodyType type) {
        const NodeFrame& frame = tree_.nodes[static_cast<size_t>(node)].frame;
        std::string where = tree_.describe(node);
        Field shape = geometry["shape"], source = geometry["node"];
        if (!geometry) geometry.refuse("is missing");
        if (shape.present() == source.present()) geometry.refuse("must name either a shape or a node");
        Vec3d scale = frame.scale();
        if (scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0) {
            bool all = scale.x == 0.0 && scale.y == 0.0 && scale.z == 0.0;
            warnings_.add(where,
                          all ? "its scale of 0 disables the collider" : "is scaled flat; the collider is left out");
            return std::nullopt;
        }
        if (shape) {
            int index = shape.index(shapes_.size(), "shapes");
            return implicit_shape(shapes_.at(static_cast<size_t>(index)), frame, type, where, warnings_);
        }
        int mesh_node = source.index(tree_.nodes.size(), "nodes");
        bool convex = geometry["convexHull"].boolean_or(false);
        std::optional<Shape> built = meshes_.shape(mesh_node, frame.stretch, convex, type, where);
        if (!built) return std::nullopt;
        return PlacedShape{std::move(*built), {}};
    }

    const NodeTree& tree_;
    Warnings& warnings_;
    MeshShapes meshes_;
    Field shapes_;
    std::vector<Material> materials_;
    std::vector<CollisionFilter> filters_;
};

// A body needs a collider; this one touches nothing.
ColliderDef phantom(int node) {
    ColliderDef collider{};
    collider.shape = Sphere{0.1f};
    collider.filter = {0, 0, 0};
    collider.user_data = static_cast<uint64_t>(node);
    return collider;
}

// The name under which the trigger of a node is reported: that of the compound trigger it is a part of, or its own.
std::vector<int> trigger_owners(const NodeTree& tree) {
    std::vector<int> owner(tree.nodes.size());
    for (size_t i = 0; i < owner.size(); ++i) owner[i] = static_cast<int>(i);
    for (int node : tree.order) {
        Field parts = tree.nodes[static_cast<size_t>(node)].physics_field(node)["trigger"]["nodes"];
        for (size_t i = 0; i < parts.size(); ++i) {
            owner[static_cast<size_t>(parts.at(i).index(owner.size(), "nodes"))] = owner[static_cast<size_t>(node)];
        }
    }
    return owner;
}

class BodyAdder {
public:
    BodyAdder(World& world, const GltfContainer& container, const NodeTree& tree, Warnings& warnings)
        : world_(world),
          tree_(tree),
          warnings_(warnings),
          colliders_(container, tree, warnings),
          owners_(trigger_owners(tree)) {
        bodies_.of_node.resize(tree.nodes.size());
        // Colliders go to the nearest ancestor that moves.
        for (int node : tree.order) {
            if (!tree.nodes[static_cast<size_t>(node)].physics) continue;
            int owner = tree.nodes[static_cast<size_t>(node)].mover;
            if (owner >= 0 && owner != node) parts_[owner].push_back(node);
        }
    }

    GltfBodies add_all() {
        for (int node : tree_.order) {
            const GltfNode& n = tree_.nodes[static_cast<size_t>(node)];
            if (!n.physics) continue;
            if (n.mover == node) add_moving(node);
            else if (n.mover < 0) add_static(node);
        }
        return std::move(bodies_);
    }

private:
    void add_moving(int node) {
        const GltfNode& n = tree_.nodes[static_cast<size_t>(node)];
        RigidBodyDef def{};
        read_motion(n.physics_field(node)["motion"], n.frame, tree_.describe(node), def, warnings_);
        BodyType type = def.kinematic ? BodyType::kinematic : BodyType::dynamic;
        std::vector<ColliderDef> colliders;
        colliders_.read(node, n.frame, type, colliders);
        for (int part : parts_[node]) colliders_.read(part, n.frame, type, colliders);
        bool solid = false;
        for (const ColliderDef& c : colliders) solid |= !c.is_trigger;
        if (!solid) {
            warnings_.add(tree_.describe(node), "moves but has no collider, so nothing can touch it");
            colliders.push_back(phantom(node));
            if (!def.mass && !def.kinematic) def.mass = 1.0f;
        }
        def.colliders = colliders;
        def.name = n.name;
        finish(node, world_.add_rigid_body(def), colliders);
    }

    void add_static(int node) {
        const GltfNode& n = tree_.nodes[static_cast<size_t>(node)];
        std::vector<ColliderDef> colliders;
        colliders_.read(node, n.frame, BodyType::fixed, colliders);
        if (colliders.empty()) return;
        StaticBodyDef def{};
        def.position = at(to_float(n.frame.origin));
        def.orientation = n.frame.orientation();
        def.colliders = colliders;
        def.name = n.name;
        finish(node, world_.add_static_body(def), colliders);
    }

    void finish(int node, Result<BodyId> added, const std::vector<ColliderDef>& colliders) {
        if (!added.ok()) refuse(tree_.describe(node), added.error().message, added.error().code);
        BodyId id = added.value();
        bodies_.of_node[static_cast<size_t>(node)] = id;
        StaticBodyRef body = world_.get_static(id);
        for (int i = 0; i < body.collider_count(); ++i) {
            size_t from = static_cast<size_t>(colliders[static_cast<size_t>(i)].user_data);
            int named = colliders[static_cast<size_t>(i)].is_trigger ? owners_[from] : static_cast<int>(from);
            const std::string& name = tree_.nodes[static_cast<size_t>(named)].name;
            if (named != node && !name.empty()) bodies_.collider_names.emplace_back(body.collider(i), name);
        }
    }

    World& world_;
    const NodeTree& tree_;
    Warnings& warnings_;
    ColliderReader colliders_;
    std::vector<int> owners_;
    std::map<int, std::vector<int>> parts_;  // nodes with colliders below each moving node
    GltfBodies bodies_;
};

}  // namespace

GltfBodies add_bodies(World& world, const GltfContainer& container, const NodeTree& tree, Warnings& warnings) {
    return BodyAdder(world, container, tree, warnings).add_all();
}

}  // namespace lendulet
