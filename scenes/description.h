// Built-in scenes as plain values: bodies, joints and settings, before any world exists. One description can be put
// into a World (build_scene) or into another engine (bench/), so that all of them simulate the very same scene.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace lendulet::scenes {

struct SceneBody {
    std::vector<ColliderDef> colliders;
    BodyType type = BodyType::dynamic;
    Position position;
    Quat orientation;
    Vec3 velocity;              // m/s
    Vec3 angular_velocity;      // world frame, rad/s
    std::optional<float> mass;  // kg; unset: from the colliders' densities
    bool allow_sleep = true;
    std::string name;  // "glass" is drawn so that one sees through it
};

// A joint by one frame in the world, at the bodies' first poses.
struct SceneJoint {
    JointType type = JointType::ball;
    int body_a = 0, body_b = 0;  // indices into SceneDescription::bodies
    Position anchor;
    Vec3 axis{1.0f, 0.0f, 0.0f};  // hinge and slider axis, twist axis of a ball joint
    Limit limit;                  // hinge: rad, slider: m
    float swing_limit = 4.0f;     // ball: rad, > pi: free
    Limit twist_limit;            // ball: rad
    Motor motor;                  // hinge and slider
    Spring spring;                // hinge and slider
};

// The triangles that a TriangleMesh of the scene was made of, for those who need them back.
struct SceneMesh {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    TriangleMesh mesh;
};

// What a running scene may do to its bodies between steps, in whatever engine it runs.
class SceneDriver {
public:
    virtual ~SceneDriver() = default;
    // The kinematic body arrives at `pose` at the end of the coming step.
    virtual void move_to(int body, const Pose& pose) = 0;
    virtual void set_velocity(int body, Vec3 velocity) = 0;
};

struct SceneDescription {
    std::string name;
    std::vector<SceneBody> bodies;
    std::vector<SceneJoint> joints;
    std::vector<SceneMesh> meshes;
    Vec3 gravity{0.0f, -10.0f, 0.0f};
    float friction = 0.6f, restitution = 0.0f;  // of all colliders that say nothing else
    float dt = 1.0f / 60.0f;
    int steps = 600;           // how long it is worth watching
    int warm_up_steps = 0;     // how long it takes to reach the state it is about; benchmarks measure after these
    bool about_sleep = false;  // benchmarks switch sleeping off unless the scene is about it
    std::function<void(SceneDriver&, int step)> before_step;  // may be empty
};

// The description of NAME, NAME:N or NAME_N. Errors: unknown_name, bad_config (a size out of range).
Result<SceneDescription> describe_scene(std::string_view name);

// Puts a description into a new world.
Result<Scene> instantiate(const SceneDescription& description, const Configure& configure = {});

}  // namespace lendulet::scenes
