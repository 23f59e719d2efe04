// Gallery: many balls on their way through something.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

constexpr Position middle{0.0f, 2.9f, 0.0f};  // of the hourglass
constexpr Position hub{0.0f, 3.2f, 0.0f};     // of the wheel of buckets

// A surface of revolution about y through the points (radius, height), seen from outside.
TriangleMesh revolved(SceneDescription& scene, const std::vector<Vec3>& profile) {
    constexpr uint32_t segments = 36;
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    for (const Vec3& p : profile)
        for (uint32_t i = 0; i < segments; ++i) {
            SinCos s = sin_cos(2.0f * pi * static_cast<float>(i) / static_cast<float>(segments));
            vertices.push_back({p.x * s.cos, p.y, p.x * s.sin});
        }
    for (uint32_t row = 0; row + 1 < profile.size(); ++row)
        for (uint32_t i = 0; i < segments; ++i) {
            uint32_t p = row * segments + i, q = row * segments + (i + 1) % segments, r = p + segments,
                     s = q + segments;
            for (uint32_t corner : {p, r, q, q, r, s}) indices.push_back(corner);
        }
    TriangleMesh mesh = TriangleMesh::from_triangles(vertices, indices).value();
    scene.meshes.push_back({std::move(vertices), std::move(indices), mesh});
    return mesh;
}

// 0 to 1 with level ends.
float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

constexpr float glass_height = 2.1f, bulb = 1.15f, neck = 0.24f, grain = 0.062f;  // m; height from the waist

float glass_radius(float y) { return neck + (bulb - neck) * smooth(minimum(1.25f * absolute(y) / glass_height, 1.0f)); }

// Grains in layers inside the upper bulb, as many as there is room for.
void add_grains(SceneDescription& scene, int count) {
    constexpr float pitch = 2.1f * grain;
    constexpr int most = 10;  // from the axis
    for (float y = 0.7f; y < glass_height - pitch; y += pitch) {
        const float inside = glass_radius(y - grain) - 1.6f * grain;
        for (int i = -most; i <= most; ++i)
            for (int k = -most; k <= most; ++k) {
                const float x = pitch * static_cast<float>(i), z = pitch * static_cast<float>(k);
                if (x * x + z * z > inside * inside) continue;
                if (count-- <= 0) return;
                add_body(scene, Sphere{grain}, middle + Vec3{x, y, z}, 1500.0f);
            }
    }
}

}  // namespace

// Glass with a narrow waist, turned over every 15 seconds.
SceneDescription hourglass(int grains) {
    constexpr float height = glass_height;
    constexpr int period = 900, turning = 150;  // steps
    SceneDescription scene;
    scene.steps = 2 * period;
    scene.friction = 0.3f;
    add_ground(scene, 30.0f);
    std::vector<Vec3> profile;
    for (int i = 0; i <= 28; ++i) {
        float y = height * static_cast<float>(i - 14) / 14.0f;
        profile.push_back({glass_radius(y), y, 0.0f});
    }
    SceneBody& glass = scene.bodies.emplace_back();
    glass.type = BodyType::kinematic;
    glass.position = middle;
    glass.name = "glass";
    add_part(glass, revolved(scene, profile));
    const int glass_index = last_body(scene);
    SceneBody& frame = scene.bodies.emplace_back();
    frame.type = BodyType::kinematic;
    frame.position = middle;
    frame.name = "frame";
    for (float side : {-1.0f, 1.0f})
        add_part(frame, Cylinder{0.1f, bulb + 0.25f}, {{0.0f, side * (height + 0.1f), 0.0f}, {}});
    for (int i = 0; i < 3; ++i) {
        SinCos s = sin_cos(2.0f * pi * static_cast<float>(i) / 3.0f + 0.5f);
        add_part(frame, Cylinder{height, 0.07f}, {{(bulb + 0.12f) * s.cos, 0.0f, (bulb + 0.12f) * s.sin}, {}});
    }
    add_grains(scene, grains);
    scene.before_step = [glass_index](SceneDriver& driver, int step) {
        const int turn = (step + 1) / period, within = (step + 1) % period;
        float angle = static_cast<float>(turn % 2) * pi;
        if (within >= period - turning) angle += pi * smooth(static_cast<float>(within - period + turning) / turning);
        for (int body : {glass_index, glass_index + 1}) driver.move_to(body, {middle, rotation_about(along_z, angle)});
    };
    return scene;
}

namespace {

// A channel along x: floor and two walls, its middle at `at`, sloping by `slope` rad.
void add_channel(SceneDescription& scene, Position at, float half_length, float slope) {
    const Quat turn = rotation_about(along_z, slope);
    SceneBody& body = scene.bodies.emplace_back();
    body.type = BodyType::fixed;
    body.position = at;
    body.orientation = turn;
    body.name = "channel";
    add_part(body, Box{{half_length, 0.05f, 0.3f}});
    for (float side : {-0.3f, 0.3f}) add_part(body, Box{{half_length, 0.16f, 0.04f}}, {{0.0f, 0.12f, side}, {}});
}

}  // namespace

// Marbles run down a zigzag of channels into a wheel of buckets, which lifts them to the top again.
SceneDescription marble_machine(int marbles) {
    constexpr float marble = 0.13f, wheel_radius = 2.6f;  // m
    constexpr float turns_per_step = 1.0f / 720.0f;
    SceneDescription scene;
    scene.steps = 2400;
    scene.friction = 0.3f;
    scene.restitution = 0.2f;
    add_ground(scene, 40.0f);
    SceneBody& wheel = scene.bodies.emplace_back();
    wheel.type = BodyType::kinematic;
    wheel.position = hub;
    wheel.name = "wheel";
    constexpr int rim = 30;
    for (int i = 0; i < rim; ++i) {
        float angle = 2.0f * pi * static_cast<float>(i) / rim;
        SinCos s = sin_cos(angle);
        Quat turn = rotation_about(along_z, angle);
        add_part(wheel, Box{{0.06f, 0.3f, 0.34f}}, {{wheel_radius * s.cos, wheel_radius * s.sin, 0.0f}, turn});
        if (i % 3 == 0)
            add_part(wheel, Box{{0.26f, 0.03f, 0.34f}},
                     {{(wheel_radius - 0.3f) * s.cos, (wheel_radius - 0.3f) * s.sin, 0.0f},
                      turn * rotation_about(along_z, -0.9f)});
    }
    const int wheel_index = last_body(scene);
    SceneBody& back = scene.bodies.emplace_back();
    back.type = BodyType::kinematic;
    back.position = hub;
    back.name = "glass";
    for (float side : {-1.0f, 1.0f})
        add_part(back, Cylinder{0.03f, wheel_radius + 0.1f},
                 {{0.0f, 0.0f, 0.38f * side}, rotation_about(along_x, 0.5f * pi)});
    add_channel(scene, {0.15f, hub.y + 1.15f, 0.0f}, 1.15f, -0.16f);
    add_channel(scene, {0.55f, hub.y + 0.25f, 0.0f}, 1.15f, 0.16f);
    add_channel(scene, {-0.5f, hub.y - 0.65f, 0.0f}, 1.15f, -0.16f);
    for (int i = 0; i < marbles; ++i) {
        Position at{-0.9f + 0.3f * static_cast<float>(i % 7), hub.y - 1.75f + 0.3f * static_cast<float>(i / 14),
                    i / 7 % 2 != 0 ? 0.14f : -0.14f};
        add_body(scene, Sphere{marble}, at, 2000.0f).allow_sleep = false;
    }
    scene.before_step = [wheel_index](SceneDriver& driver, int step) {
        float turn = static_cast<float>((step + 1) % 720) * turns_per_step;
        for (int body : {wheel_index, wheel_index + 1})
            driver.move_to(body, {hub, rotation_about(along_z, 2.0f * pi * turn)});
    };
    return scene;
}

}  // namespace lendulet::scenes
