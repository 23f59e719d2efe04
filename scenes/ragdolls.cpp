// Ragdolls: eleven capsules each, joined by ball joints with swing and twist limits and by hinges, dropped in layers.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

enum Part {
    pelvis,
    torso,
    head,
    left_arm,
    left_hand,
    right_arm,
    right_hand,
    left_leg,
    left_foot,
    right_leg,
    right_foot
};
constexpr int part_count = 11;

struct PartShape {
    Vec3 centre;
    bool along_x;  // else along y
    float half_height, radius;
};
constexpr PartShape part_shapes[part_count] = {
    {{0.0f, 1.00f, 0.0f}, true, 0.08f, 0.12f},    {{0.0f, 1.35f, 0.0f}, false, 0.15f, 0.14f},
    {{0.0f, 1.75f, 0.0f}, false, 0.04f, 0.10f},   {{0.32f, 1.50f, 0.0f}, true, 0.11f, 0.05f},
    {{0.60f, 1.50f, 0.0f}, true, 0.11f, 0.045f},  {{-0.32f, 1.50f, 0.0f}, true, 0.11f, 0.05f},
    {{-0.60f, 1.50f, 0.0f}, true, 0.11f, 0.045f}, {{0.10f, 0.70f, 0.0f}, false, 0.15f, 0.075f},
    {{0.10f, 0.27f, 0.0f}, false, 0.15f, 0.06f},  {{-0.10f, 0.70f, 0.0f}, false, 0.15f, 0.075f},
    {{-0.10f, 0.27f, 0.0f}, false, 0.15f, 0.06f},
};

// swing > 0: a ball joint with this cone and twist; else a hinge that turns by +-1.2 rad.
struct PartJoint {
    Part a, b;
    float x, y;  // anchor in the ragdoll's plane
    Vec3 axis;
    float swing, twist;
};
constexpr Vec3 right{1.0f, 0.0f, 0.0f}, up{0.0f, 1.0f, 0.0f};
constexpr PartJoint part_joints[] = {
    {pelvis, torso, 0.0f, 1.12f, up, 0.5f, 0.4f},           {torso, head, 0.0f, 1.62f, up, 0.5f, 0.6f},
    {torso, left_arm, 0.17f, 1.50f, right, 1.2f, 0.6f},     {torso, right_arm, -0.17f, 1.50f, -right, 1.2f, 0.6f},
    {left_arm, left_hand, 0.46f, 1.50f, up, 0.0f, 0.0f},    {right_arm, right_hand, -0.46f, 1.50f, up, 0.0f, 0.0f},
    {pelvis, left_leg, 0.10f, 0.90f, -up, 0.9f, 0.4f},      {pelvis, right_leg, -0.10f, 0.90f, -up, 0.9f, 0.4f},
    {left_leg, left_foot, 0.10f, 0.49f, right, 0.0f, 0.0f}, {right_leg, right_foot, -0.10f, 0.49f, right, 0.0f, 0.0f},
};

// A ragdoll's parts do not collide with each other: they share `group`.
void add_ragdoll(SceneDescription& scene, const Pose& root, uint32_t group) {
    int first = static_cast<int>(scene.bodies.size());
    for (const PartShape& part : part_shapes) {
        Capsule capsule{part.half_height, part.radius};
        SceneBody& body = add_body(scene, capsule, root * part.centre, 1000.0f);
        Quat turn = part.along_x ? rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi) : Quat{};
        body.orientation = root.orientation * turn;
        body.colliders[0].filter.group = group;
    }
    for (const PartJoint& part : part_joints) {
        SceneJoint& joint = scene.joints.emplace_back();
        joint.body_a = first + part.a;
        joint.body_b = first + part.b;
        joint.anchor = root * Vec3{part.x, part.y, 0.0f};
        joint.axis = rotate(root.orientation, part.axis);
        if (part.swing > 0.0f) {
            joint.swing_limit = part.swing;
            joint.twist_limit = {-part.twist, part.twist};
        } else {
            joint.type = JointType::hinge;
            joint.limit = {-1.2f, 1.2f};
        }
    }
}

}  // namespace

SceneDescription ragdolls(int count) {
    SceneDescription scene;
    scene.steps = 300;
    add_ground(scene, 50.0f);
    Random random;
    for (int i = 0; i < count; ++i) {
        Position position{static_cast<float>(i % 5 - 2) * 1.6f, 0.5f + 2.2f * static_cast<float>(i / 25),
                          static_cast<float>(i / 5 % 5 - 2) * 1.0f};
        add_ragdoll(scene, {position, rotation_about(up, random.range(-0.3f, 0.3f))}, static_cast<uint32_t>(i) + 1);
    }
    return scene;
}

// Ragdolls slide down a slope between posts.
SceneDescription ragdoll_avalanche(int count) {
    constexpr float angle = 0.52f;  // rad
    constexpr Vec3 back{0.0f, 0.0f, 1.0f};
    SceneDescription scene;
    scene.steps = 900;
    scene.friction = 0.25f;
    add_ground(scene, 60.0f);
    const Quat tilt = rotation_about(back, -angle);
    const SinCos slope = sin_cos(angle);
    auto on_slope = [&](float along, float across, float above) {  // along: from its foot at x = 4
        return Position{4.0f - along * slope.cos + above * slope.sin, along * slope.sin + above * slope.cos, across};
    };
    add_static(scene, Box{{11.0f, 0.5f, 6.0f}}, on_slope(11.0f, 0.0f, -0.5f)).orientation = tilt;
    for (float side : {-6.1f, 6.1f})
        add_static(scene, Box{{11.0f, 1.0f, 0.1f}}, on_slope(11.0f, side, 0.5f)).orientation = tilt;
    for (int i = 0; i < 9; ++i) {
        float along = 4.0f + 3.0f * static_cast<float>(i / 3);
        float across = 3.6f * static_cast<float>(i % 3 - 1) + (i / 3 % 2 != 0 ? 1.8f : 0.0f);
        add_static(scene, Cylinder{0.8f, 0.18f}, on_slope(along, across, 0.8f)).orientation = tilt;
    }
    Random random;
    for (int i = 0; i < count; ++i) {
        float along = 14.5f + 1.5f * static_cast<float>(i / 6 % 5), across = 1.9f * (static_cast<float>(i % 6) - 2.5f);
        Position position = on_slope(along, across, 0.4f + 2.6f * static_cast<float>(i / 30));
        Quat turn = rotation_about(up, random.range(1.2f, 1.9f));
        add_ragdoll(scene, {position, turn}, static_cast<uint32_t>(i) + 1);
    }
    return scene;
}

}  // namespace lendulet::scenes
