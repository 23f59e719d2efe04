// Gallery: things on wheels. Wheels turn about z in their own frames and are driven by the motors of their hinges.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

// A wheel whose axle is along z; its index.
int add_wheel(SceneDescription& scene, Position at, float radius, float half_width, float density) {
    SceneBody& wheel = add_body(scene, Cylinder{half_width, radius - 0.04f, 0.04f}, at, density);
    wheel.orientation = rotation_about(along_x, 0.5f * pi);
    wheel.colliders[0].material.static_friction = 1.1f;
    wheel.name = "wheel";
    return last_body(scene);
}

// A chassis with a cab and a load, on six driven wheels, standing at x with its wheels at height y; heads for +x.
void add_lorry(SceneDescription& scene, float x, float y) {
    constexpr float radius = 0.5f, track = 0.95f, speed = 3.5f;  // m, m, m/s
    const float deck = y + radius + 0.25f;
    SceneBody& chassis = add_body(scene, Box{{2.2f, 0.14f, 0.7f}}, {x, deck, 0.0f}, 500.0f);
    add_part(chassis, Box{{0.5f, 0.62f, 0.78f}, 0.05f}, {{1.65f, 0.85f, 0.0f}, {}}, 150.0f);
    add_part(chassis, Box{{1.5f, 0.3f, 0.04f}}, {{-0.65f, 0.4f, 0.76f}, {}}, 150.0f);
    add_part(chassis, Box{{1.5f, 0.3f, 0.04f}}, {{-0.65f, 0.4f, -0.76f}, {}}, 150.0f);
    add_part(chassis, Box{{0.04f, 0.3f, 0.8f}}, {{-2.15f, 0.4f, 0.0f}, {}}, 150.0f);
    chassis.name = "lorry";
    const int body = last_body(scene);
    for (float along : {-1.6f, -0.5f, 1.6f})
        for (float side : {-track, track}) {
            const Position at{x + along, y + radius, side};
            const int wheel = add_wheel(scene, at, radius, 0.12f, 300.0f);
            add_hinge(scene, body, wheel, at, along_z).motor = {-speed / radius, 900.0f};
        }
    for (int i = 0; i < 6; ++i) {
        const Position at{x - 1.5f + 0.62f * static_cast<float>(i % 3), deck + 0.5f + 0.55f * static_cast<float>(i / 3),
                          0.0f};
        add_body(scene, Box{{0.25f, 0.25f, 0.5f}}, at, 300.0f);
    }
}

// A wheel on a sprung hub below the chassis.
void add_sprung_wheel(SceneDescription& scene, int chassis, Position at, float steer, float speed, uint32_t group) {
    constexpr float radius = 0.42f;
    add_body(scene, Sphere{0.12f}, at, 2500.0f).colliders[0].filter.group = group;
    const int hub = last_body(scene);
    SceneJoint& spring = add_ball_joint(scene, chassis, hub, at);
    spring.type = JointType::slider;
    spring.axis = along_y;
    spring.limit = {-0.22f, 0.22f};
    spring.spring.stiffness = 26000.0f;
    spring.spring.damping = 2600.0f;
    spring.spring.target = -0.12f;
    const int wheel = add_wheel(scene, at, radius, 0.13f, 250.0f);
    const Quat turn = rotation_about(along_y, steer);
    SceneBody& body = scene.bodies[static_cast<size_t>(wheel)];
    body.orientation = turn * body.orientation;
    body.colliders[0].filter.group = group;
    add_hinge(scene, hub, wheel, at, rotate(turn, along_z)).motor = {-speed / radius, 350.0f};
}

}  // namespace

// Planks joined along their edges hang between two cliffs, and a loaded lorry drives over them.
SceneDescription bridge(int planks) {
    constexpr float half_plank = 0.42f, half_width = 1.5f, thickness = 0.07f, sag = 0.5f;  // sag: rad, of the whole arc
    SceneDescription scene;
    scene.steps = 900;
    const float step = sag / static_cast<float>(planks);
    const SinCos half_step = sin_cos(0.5f * step), half_arc = sin_cos(0.5f * sag);
    const float radius = half_plank / half_step.sin, half_span = radius * half_arc.sin;
    for (float side : {-1.0f, 1.0f}) {
        add_static(scene, Box{{9.0f, 5.0f, 4.0f}}, {side * (half_span + 9.0f), -5.0f, 0.0f}).name = "cliff";
        add_static(scene, Box{{0.2f, 0.4f, 2.5f}}, {side * (half_span + 17.0f), 0.4f, 0.0f});
    }
    const int left = 0, right = 2;
    auto node = [&](int i) {
        SinCos s = sin_cos(step * static_cast<float>(i) - 0.5f * sag);
        return Position{radius * s.sin, radius * (half_arc.cos - s.cos) - thickness, 0.0f};
    };
    int before = left;
    for (int i = 0; i <= planks; ++i) {
        const Position at = node(i);
        int here = right;
        if (i < planks) {
            const Position next = node(i + 1);
            SceneBody& plank =
                add_body(scene, Box{{half_plank - 0.02f, thickness, half_width}}, at + 0.5f * (next - at), 500.0f);
            plank.orientation = rotation_about(along_z, arc_tangent2(next.y - at.y, next.x - at.x));
            plank.name = "plank";
            here = last_body(scene);
        }
        for (float side : {-0.9f * half_width, 0.9f * half_width})
            add_ball_joint(scene, before, here, {at.x, at.y, side});
        before = here;
    }
    add_lorry(scene, -half_span - 4.5f, 0.01f);
    return scene;
}

// A car with sprung, driven wheels goes in circles over hills.
SceneDescription car(int) {
    constexpr float speed = 9.0f, steer = 0.16f;  // m/s, rad
    SceneDescription scene;
    scene.steps = 1800;
    add_terrain(scene, 160, 0.75f, 0.55f);
    const Position at{0.0f, 1.6f, 20.0f};
    SceneBody& chassis = add_body(scene, Box{{1.75f, 0.2f, 0.72f}, 0.06f}, at, 260.0f);
    add_part(chassis, Box{{0.8f, 0.26f, 0.62f}, 0.08f}, {{-0.25f, 0.5f, 0.0f}, {}}, 60.0f);
    chassis.name = "car";
    for (ColliderDef& part : chassis.colliders) part.filter.group = 1;
    const int body = last_body(scene);
    for (float along : {-1.2f, 1.25f})
        for (float side : {-0.95f, 0.95f})
            add_sprung_wheel(scene, body, {at.x + along, at.y - 0.35f, at.z + side}, along > 0.0f ? steer : 0.0f, speed,
                             1);
    return scene;
}

}  // namespace lendulet::scenes
