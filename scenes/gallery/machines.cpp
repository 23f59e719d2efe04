// Gallery: machines driven by the motor of one joint.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

// A spur gear about z. Lengths are in modules: the pitch circle has a radius of half the number of teeth.
constexpr float module = 0.2f, half_thickness = 0.25f;  // m

float pitch_radius(int teeth) { return 0.5f * module * static_cast<float>(teeth); }

// One tooth pointing along x: a trapezium from below the root circle to the tip.
ConvexHull tooth(int teeth) {
    const float r = pitch_radius(teeth);
    const float stations[3][2] = {{r - 1.3f * module, 0.95f}, {r, 0.70f}, {r + 0.85f * module, 0.36f}};
    std::vector<Vec3> points;
    for (auto [x, half_width] : stations)
        for (float y : {-half_width, half_width})
            for (float z : {-half_thickness, half_thickness}) points.push_back({x, y * module, z});
    return ConvexHull::from_points(points).value();
}

// A gear on a hinge, with a tooth at `phase`; its index.
int add_gear(SceneDescription& scene, int frame, Position at, int teeth, float phase) {
    const ConvexHull shape = tooth(teeth);
    SceneBody& gear = scene.bodies.emplace_back();
    gear.position = at;
    gear.orientation = rotation_about(along_z, phase);
    gear.name = "gear";
    gear.allow_sleep = false;
    add_part(gear, Cylinder{half_thickness, pitch_radius(teeth) - 1.15f * module},
             {{}, rotation_about(along_x, 0.5f * pi)}, 1500.0f);
    for (int i = 0; i < teeth; ++i)
        add_part(gear, shape,
                 {{}, rotation_about(along_z, 2.0f * pi * static_cast<float>(i) / static_cast<float>(teeth))}, 1500.0f);
    for (ColliderDef& part : gear.colliders) part.material.static_friction = 0.1f;
    const int index = last_body(scene);
    add_hinge(scene, frame, index, at, along_z);
    return index;
}

// Phase of a gear of `teeth` that meets another one of `other` teeth at phase `other_phase`; it lies from that one in
// the direction `angle`. Where the other has a tooth this one has a gap, and they turn against each other.
float meshing_phase(int teeth, int other, float other_phase, float angle) {
    const float tooth_angle = 2.0f * pi / static_cast<float>(other);
    const float share = (angle - other_phase) / tooth_angle;  // teeth from the line of centres
    return angle + pi + (share - 0.5f) * 2.0f * pi / static_cast<float>(teeth);
}

}  // namespace

// Gears that drive each other by their teeth alone; the first has a motor.
SceneDescription gear_train(int gears) {
    constexpr int sizes[] = {12, 22, 14, 28, 10};
    constexpr float directions[] = {0.5f, -0.45f, 0.35f, -0.6f, 0.55f};
    constexpr float motor_speed = 1.5f;  // rad/s
    SceneDescription scene;
    scene.steps = 900;
    add_ground(scene, 40.0f);
    add_static(scene, Box{{0.1f, 0.1f, 0.1f}}, {0.0f, 3.5f, -0.8f}).name = "frame";
    const int frame = last_body(scene);
    Position at{-0.8f * static_cast<float>(2 * gears), 3.6f, 0.0f};
    float phase = 0.0f;
    for (int i = 0; i < gears; ++i) {
        const int teeth = sizes[i % 5];
        if (i > 0) {
            const int other = sizes[(i - 1) % 5];
            const float angle = directions[(i - 1) % 5];
            const SinCos s = sin_cos(angle);
            at = at + (pitch_radius(teeth) + pitch_radius(other)) * 1.015f * Vec3{s.cos, s.sin, 0.0f};
            phase = meshing_phase(teeth, other, phase, angle);
        }
        add_gear(scene, frame, at, teeth, phase);
        if (i == 0) scene.joints.back().motor = {motor_speed, 4000.0f};
        add_static(scene, Cylinder{0.4f, 0.12f}, {at.x, at.y, -0.7f}).orientation = rotation_about(along_x, 0.5f * pi);
    }
    return scene;
}

}  // namespace lendulet::scenes
