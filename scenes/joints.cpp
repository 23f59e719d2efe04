// Scenes of joints: a net of balls, a chain with a heavy end, a cradle.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {

// A net in a vertical plane, hanging from its top row; every ball is joined to the ones above and to the left of it.
SceneDescription joint_grid(int side) {
    SceneDescription scene;
    scene.steps = 100;
    for (int column = 0; column < side; ++column)
        for (int row = 0; row < side; ++row) {
            float x = static_cast<float>(column), y = static_cast<float>(-row);
            int here = column * side + row;
            SceneBody& ball = add_body(scene, Sphere{0.4f}, {x, y, 0.0f});
            ball.colliders[0].filter.group = 1;
            if (row == 0) {
                ball.type = BodyType::fixed;
                continue;
            }
            add_ball_joint(scene, here - 1, here, {x, y + 0.5f, 0.0f});
            if (column > 0) add_ball_joint(scene, here - side, here, {x - 0.5f, y, 0.0f});
        }
    return scene;
}

// Twenty links held out level, with a ball `ratio` times as heavy as a link at the end.
SceneDescription chain_heavy(int ratio) {
    constexpr int links = 20;
    constexpr float half_height = 0.35f, radius = 0.1f, ball_radius = 1.0f;
    constexpr float ball_volume = 4.0f / 3.0f * pi;  // per cubed radius
    constexpr float link_mass =
        (ball_volume * radius * radius * radius + pi * radius * radius * 2.0f * half_height) * light_density;
    SceneDescription scene;
    add_static(scene, Box{{0.2f, 0.2f, 0.2f}}, {}).name = "hook";
    for (int i = 0; i < links; ++i) {
        SceneBody& link = add_body(scene, Capsule{half_height, radius}, {static_cast<float>(i) + 0.5f, 0.0f, 0.0f});
        link.orientation = rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi);
        link.colliders[0].filter.group = 1;
        add_ball_joint(scene, i, i + 1, {static_cast<float>(i), 0.0f, 0.0f});
    }
    float density = static_cast<float>(ratio) * link_mass / (ball_volume * ball_radius * ball_radius * ball_radius);
    SceneBody& ball =
        add_body(scene, Sphere{ball_radius}, {static_cast<float>(links) + ball_radius, 0.0f, 0.0f}, density);
    ball.colliders[0].filter.group = 1;
    ball.name = "ball";
    add_ball_joint(scene, links, links + 1, {static_cast<float>(links), 0.0f, 0.0f});
    return scene;
}

// Balls that just touch, each on a rod of 1 m without mass; the first is lifted by 45 degrees.
SceneDescription newtons_cradle(int balls) {
    constexpr float radius = 0.1f, rod = 1.0f;
    constexpr Vec3 hinge_axis{0.0f, 0.0f, 1.0f};
    SceneDescription scene;
    scene.friction = 0.0f;
    scene.restitution = 1.0f;
    scene.bodies.reserve(static_cast<size_t>(balls) + 1);
    float middle = static_cast<float>(balls - 1) * radius;
    add_static(scene, Box{{middle + radius, 0.02f, 0.02f}}, {0.0f, rod, 0.0f}).name = "beam";
    for (int i = 0; i < balls; ++i) {
        Position pivot{static_cast<float>(2 * i) * radius - middle, rod, 0.0f};
        Quat turn = i == 0 ? rotation_about(hinge_axis, -0.25f * pi) : Quat{};
        SceneBody& ball = add_body(scene, Sphere{radius}, pivot + rotate(turn, Vec3{0.0f, -rod, 0.0f}), 7800.0f);
        ball.orientation = turn;
        add_hinge(scene, 0, i + 1, pivot, hinge_axis);
    }
    return scene;
}

}  // namespace lendulet::scenes
