// Ordered heaps: pyramids, columns, a wall and a row of dominoes.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {

SceneDescription large_pyramid(int base) {
    SceneDescription scene;
    scene.steps = 200;
    add_ground(scene, maximum(400.0f, static_cast<float>(base)));
    for (int row = 0; row < base; ++row)
        for (int i = row; i < base; ++i) {
            float x =
                static_cast<float>(row + 1) * 0.5f + static_cast<float>(i - row) - 0.5f * static_cast<float>(base);
            add_body(scene, Box{half_metre}, {x, static_cast<float>(row) + 0.5f, 0.0f});
        }
    return scene;
}

SceneDescription many_pyramids(int side) {
    constexpr int base = 10;
    constexpr float e = 0.5f;  // half a box
    SceneDescription scene;
    scene.steps = 100;
    float half = e * static_cast<float>(side) * (static_cast<float>(base) + 1.0f);
    add_ground(scene, half);
    float row_distance = side > 1 ? 2.0f * (half - 2.0f * e) / (static_cast<float>(side) - 1.0f) : 0.0f;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            for (int level = 0; level < base; ++level)
                for (int i = level; i < base; ++i) {
                    float left = -half + static_cast<float>(column) * (2.0f * e * static_cast<float>(base) + 2.0f * e) +
                                 2.0f * e;
                    float x =
                        left + static_cast<float>(level + 1) * e + 2.0f * static_cast<float>(i - level) * e - 0.5f;
                    float z = -half + 2.0f * e + static_cast<float>(row) * row_distance;
                    add_body(scene, Box{{e, e, e}}, {x, static_cast<float>(2 * level + 1) * e, z});
                }
    return scene;
}

SceneDescription stack(int height) {
    SceneDescription scene;
    add_ground(scene, 50.0f);
    for (int i = 0; i < height; ++i) add_body(scene, Box{half_metre}, {0.0f, 0.5f + static_cast<float>(i), 0.0f});
    return scene;
}

SceneDescription mass_ratio(int ratio) {
    SceneDescription scene;
    add_ground(scene, 50.0f);
    for (int i = 0; i < 6; ++i) {
        float density = i == 5 ? light_density * static_cast<float>(ratio) : light_density;
        add_body(scene, Box{half_metre}, {0.0f, 0.5f + static_cast<float>(i), 0.0f}, density);
    }
    return scene;
}

SceneDescription wall_ball(int rows) {
    SceneDescription scene;
    scene.steps = 180;
    add_ground(scene, 200.0f);
    for (int row = 0; row < rows; ++row) {
        float y = 0.25f + 0.5f * static_cast<float>(row);
        bool odd = row % 2 != 0;
        for (int i = 0; i < 30; ++i) {
            float x = static_cast<float>(i) - 14.5f + (odd ? 0.25f : -0.25f);
            add_body(scene, Box{{0.5f, 0.25f, 0.25f}}, {x, y, 0.0f});
        }
        add_body(scene, Box{{0.25f, 0.25f, 0.25f}}, {odd ? -15.0f : 15.0f, y, 0.0f});
    }
    SceneBody& ball = add_body(scene, Sphere{1.0f}, {0.0f, 5.0f, -45.0f}, 20.0f * light_density);
    ball.velocity = {0.0f, 2.8f, 80.0f};
    ball.name = "ball";
    return scene;
}

// Real dominoes (48 x 24 x 7.5 mm, 20 mm apart) ten times enlarged; the first is given a push.
SceneDescription dominoes(int count) {
    constexpr Vec3 half{0.0375f, 0.24f, 0.12f};
    constexpr float pitch = 0.2f;
    SceneDescription scene;
    scene.steps = 300 + 4 * count;
    float middle = 0.5f * static_cast<float>(count - 1);
    add_ground(scene, maximum(10.0f, pitch * static_cast<float>(count)));
    for (int i = 0; i < count; ++i)
        add_body(scene, Box{half}, {(static_cast<float>(i) - middle) * pitch, half.y, 0.0f}, 1000.0f);
    // Turning about its lower front edge, fast enough to pass the tipping point.
    constexpr float spin = -3.0f;
    scene.bodies[1].angular_velocity = {0.0f, 0.0f, spin};
    scene.bodies[1].velocity = cross(Vec3{0.0f, 0.0f, spin}, Vec3{-half.x, half.y, 0.0f});
    return scene;
}

}  // namespace lendulet::scenes
