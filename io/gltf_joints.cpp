// Joints of KHR_physics_rigid_bodies between the bodies that gltf_bodies.cpp made.
//
// The node with the joint is the frame on body A, the connected node that on body B: the specification measures the
// connected node's motion in the joint node's frame, as the engine measures B's in A's.
#include <cmath>

#include "io/gltf_bodies.h"
#include "io/gltf_joint_kinds.h"

namespace lendulet {

namespace {

// A body to join, and the pose of its frame.
struct End {
    BodyId body;
    Pose pose;
    bool own_collider = true;  // whether the node belongs to that body, rather than to the fixed world at large
};

// The rotation that takes x onto the given axis, y and z onto the next two: the engine's joints turn about x.
Quat axis_first(int axis) {
    if (axis == 1) return {0.5f, 0.5f, 0.5f, 0.5f};
    if (axis == 2) return {-0.5f, -0.5f, -0.5f, 0.5f};
    return {};
}

class JointAdder {
public:
    JointAdder(World& world, const GltfContainer& container, const NodeTree& tree, const GltfBodies& bodies,
               Warnings& warnings)
        : world_(world),
          tree_(tree),
          bodies_(bodies),
          warnings_(warnings),
          descriptions_(container.root()["extensions"]["KHR_physics_rigid_bodies"]["physicsJoints"]) {}

    void add_all() {
        for (int node : tree_.order) {
            Field joint = tree_.nodes[static_cast<size_t>(node)].physics_field(node)["joint"];
            if (joint) add(node, joint);
        }
    }

private:
    void add(int node, const Field& joint) {
        std::string where = tree_.describe(node);
        int other = joint["connectedNode"].index(tree_.nodes.size(), "nodes");
        size_t description = static_cast<size_t>(joint["joint"].index(descriptions_.size(), "physicsJoints"));
        bool collide = joint["enableCollision"].boolean_or(false);
        if (!tree_.nodes[static_cast<size_t>(other)].in_scene) {
            return warnings_.add(where, "its joint leads to a node outside the scene and is left out");
        }
        std::string why;
        std::optional<JointKind> kind = joint_kind(descriptions_.at(description), why);
        if (!kind) return warnings_.add(where, "its joint is not simulated: " + why + " not supported");
        if (!can_move(node) && !can_move(other)) {
            return warnings_.add(where, "its joint connects nothing that is free to move");
        }
        if (tree_.nodes[static_cast<size_t>(node)].mover == tree_.nodes[static_cast<size_t>(other)].mover) {
            return warnings_.add(where, "its joint connects a body to itself");
        }
        for (const std::string& sentence : kind->approximations) warnings_.add(where, sentence);
        create(node, other, *kind, collide, where);
    }

    bool can_move(int node) const {
        int mover = tree_.nodes[static_cast<size_t>(node)].mover;
        return mover >= 0 && world_.get_static(bodies_.of_node[static_cast<size_t>(mover)]).type() == BodyType::dynamic;
    }

    void create(int node, int other, const JointKind& kind, bool collide, const std::string& where) {
        const NodeFrame &frame_a = tree_.nodes[static_cast<size_t>(node)].frame,
                        &frame_b = tree_.nodes[static_cast<size_t>(other)].frame;
        End a = end_of(node), b = end_of(other);
        JointDef def{};
        def.type = kind.type;
        def.body_a = a.body;
        def.body_b = b.body;
        def.frame_a = frame_on(a, frame_a) * Transform{kind.offset, axis_first(kind.axis)};
        def.frame_b = frame_on(b, frame_b) * Transform{{}, axis_first(kind.axis)};
        def.limit = kind.limit;
        def.spring = kind.spring;
        def.swing_limit = kind.swing_limit;
        def.twist_limit = kind.twist_limit;
        // A body that only stands in for the fixed world keeps colliding.
        def.collide_connected = collide || !a.own_collider || !b.own_collider;
        def.name = tree_.nodes[static_cast<size_t>(node)].name;
        def.axes = kind.axes;
        for (const JointDrive& drive : kind.drives) {
            Spring spring = spring_of(drive, a, b, frame_a);
            if (kind.type != JointType::six_degrees) def.spring = spring;
            else (drive.axis < 3 ? def.axes.linear[drive.axis] : def.axes.angular[drive.axis - 3]).spring = spring;
        }
        Result<JointId> added = world_.add_joint(def);
        if (!added.ok()) refuse(where, added.error().message, added.error().code);
    }

    // The joint node as seen from the body's own frame. Nodes below a moving one stand in its frame exactly.
    Transform frame_on(const End& end, const NodeFrame& node) const {
        Quat back = conjugate(end.pose.orientation);
        return {to_local(end.pose, at(to_float(node.origin))), normalize(back * node.orientation())};
    }

    End end_of(int node) {
        int owner = tree_.nodes[static_cast<size_t>(node)].mover;
        bool own = true;
        BodyId body;
        if (owner >= 0) {
            body = bodies_.of_node[static_cast<size_t>(owner)];
        } else {
            for (int n = node; n >= 0 && !body; n = tree_.nodes[static_cast<size_t>(n)].parent) {
                body = bodies_.of_node[static_cast<size_t>(n)];
            }
            if (!body) body = fixed_world(), own = false;
        }
        StaticBodyRef ref = world_.get_static(body);
        return {body, {ref.position(), ref.orientation()}, own};
    }

    // Any body that never moves can stand for the fixed world; only a scene without one gets a point of its own.
    BodyId fixed_world() {
        if (fixed_world_) return fixed_world_;
        for (int i = 0; i < world_.body_count() && !fixed_world_; ++i) {
            if (world_.get_static(world_.body(i)).type() == BodyType::fixed) fixed_world_ = world_.body(i);
        }
        if (fixed_world_) return fixed_world_;
        ColliderDef nothing{};
        nothing.shape = Sphere{0.1f};
        nothing.filter = {0, 0, 0};
        StaticBodyDef def{};
        def.colliders = {&nothing, 1};
        def.name = "fixed_world";
        return fixed_world_ = world_.add_static_body(def).value();
    }

    // 1 / effective mass (1/kg) along an axis, 1 / effective inertia about one. A joint turns a body about a point
    // beside its centre of mass, which adds m r^2 (Steiner).
    float inverse_effective(const End& end, bool along, Position anchor, Vec3 axis) const {
        if (world_.get_static(end.body).type() != BodyType::dynamic) return 0.0f;
        const RigidBodyRef body = static_cast<const World&>(world_).get(end.body);
        if (along) return body.inverse_mass();
        float about_centre = 1.0f / dot(axis, body.inverse_inertia() * axis);
        Vec3 arm = cross(axis, body.centre_of_mass() - anchor);
        return 1.0f / (about_centre + body.mass() * length_squared(arm));
    }

    // A drive's force is k (x_target - x) + c (v_target - v), a spring.
    Spring spring_of(const JointDrive& drive, const End& a, const End& b, const NodeFrame& frame) const {
        float scale = 1.0f;
        if (drive.acceleration) {
            constexpr Vec3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
            Position anchor = at(to_float(frame.origin));
            Vec3 axis = rotate(frame.orientation(), axes[drive.axis % 3]);
            float inverse =
                inverse_effective(a, drive.axis < 3, anchor, axis) + inverse_effective(b, drive.axis < 3, anchor, axis);
            scale = inverse > 0.0f ? 1.0f / inverse : 0.0f;
        }
        return {scale * drive.stiffness, scale * drive.damping, drive.position, drive.max_force, drive.velocity};
    }

    World& world_;
    const NodeTree& tree_;
    const GltfBodies& bodies_;
    Warnings& warnings_;
    Field descriptions_;
    BodyId fixed_world_;
};

}  // namespace

void add_joints(World& world, const GltfContainer& container, const NodeTree& tree, const GltfBodies& bodies,
                Warnings& warnings) {
    JointAdder(world, container, tree, bodies, warnings).add_all();
}

}  // namespace lendulet
