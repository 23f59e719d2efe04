// From a description to a world that runs it.
#include <memory>
#include <utility>

#include "scenes/description.h"

namespace lendulet::scenes {
namespace {

Result<BodyId> add(World& world, const SceneBody& body) {
    if (body.type == BodyType::fixed)
        return world.add_static_body({.position = body.position,
                                      .orientation = body.orientation,
                                      .colliders = body.colliders,
                                      .name = body.name});
    return world.add_rigid_body({.position = body.position,
                                 .orientation = body.orientation,
                                 .velocity = body.velocity,
                                 .angular_velocity = body.angular_velocity,
                                 .colliders = body.colliders,
                                 .mass = body.mass,
                                 .allow_sleep = body.allow_sleep,
                                 .kinematic = body.type == BodyType::kinematic,
                                 .name = body.name});
}

Status add(World& world, const SceneJoint& joint, const std::vector<BodyId>& ids) {
    BodyId a = ids[static_cast<size_t>(joint.body_a)], b = ids[static_cast<size_t>(joint.body_b)];
    Result<JointDef> def = world.joint_at(joint.type, a, b, joint.anchor, joint.axis);
    if (!def) return def.error();
    def.value().limit = joint.limit;
    def.value().swing_limit = joint.swing_limit;
    def.value().twist_limit = joint.twist_limit;
    def.value().motor = joint.motor;
    def.value().spring = joint.spring;
    Result<JointId> id = world.add_joint(def.value());
    if (!id) return id.error();
    return {};
}

// Drives bodies of a World; one that was removed meanwhile is left alone.
class WorldDriver final : public SceneDriver {
public:
    WorldDriver(World& world, const std::vector<BodyId>& ids, float dt) : world_(world), ids_(ids), dt_(dt) {}

    void move_to(int body, const Pose& pose) override {
        BodyId id = ids_[static_cast<size_t>(body)];
        if (world_.alive(id)) world_.get(id).move_to(pose.position, pose.orientation, dt_).value();
    }
    void set_velocity(int body, Vec3 velocity) override {
        BodyId id = ids_[static_cast<size_t>(body)];
        if (world_.alive(id)) world_.get(id).set_velocity(velocity).value();
    }

private:
    World& world_;
    const std::vector<BodyId>& ids_;
    float dt_;
};

}  // namespace

Result<Scene> instantiate(const SceneDescription& description, const Configure& configure) {
    WorldBuilder builder;
    builder.gravity(description.gravity).friction(description.friction).bounciness(description.restitution);
    if (configure) configure(builder);
    Result<World> built = builder.build();
    if (!built) return built.error();
    Scene scene{std::move(built).value(), description.name, description.dt, description.steps, {}, {}};

    scene.world
        .reserve({.bodies = static_cast<int>(description.bodies.size()),
                  .joints = static_cast<int>(description.joints.size())})
        .value();
    std::vector<BodyId> ids;
    ids.reserve(description.bodies.size());
    for (const SceneBody& body : description.bodies) {
        Result<BodyId> id = add(scene.world, body);
        if (!id) return id.error();
        ids.push_back(id.value());
    }
    for (const SceneJoint& joint : description.joints)
        if (Status added = add(scene.world, joint, ids); !added) return added.error();
    if (description.before_step)
        scene.before_step = [hook = description.before_step, ids = std::move(ids), dt = description.dt](World& world,
                                                                                                        int step) {
            WorldDriver driver(world, ids, dt);
            hook(driver, step);
        };
    return scene;
}

}  // namespace lendulet::scenes
