// Scenes about motion itself: a turning drum, a world that mostly sleeps, a free body that turns over and over.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

constexpr Position drum_centre{0.0f, 21.0f, 0.0f};
constexpr Vec3 drum_axis{0.0f, 0.0f, 1.0f};

// 36 walls round the axis, four paddles, two caps.
SceneBody drum() {
    SceneBody body;
    body.type = BodyType::kinematic;
    body.position = drum_centre;
    body.name = "drum";
    for (int i = 0; i < 36; ++i) {
        float angle = static_cast<float>(i) * pi / 18.0f;
        SinCos s = sin_cos(angle);
        Quat turn = rotation_about(drum_axis, angle);
        add_part(body, Box{{1.0f, 1.6f, 10.0f}}, {{17.0f * s.cos, 17.0f * s.sin, 0.0f}, turn});
        if (i % 9 == 0) add_part(body, Box{{1.0f, 0.7f, 10.0f}}, {{15.0f * s.cos, 15.0f * s.sin, 0.0f}, turn});
    }
    add_part(body, Box{{18.0f, 18.0f, 0.5f}}, {{0.0f, 0.0f, 10.5f}, {}});
    add_part(body, Box{{18.0f, 18.0f, 0.5f}}, {{0.0f, 0.0f, -10.5f}, {}});
    return body;
}

}  // namespace

SceneDescription tumbler(int side) {
    constexpr float half = 0.2f, turns_per_minute = 25.0f / 6.0f;
    SceneDescription scene;
    scene.steps = 300;
    add_ground(scene, 60.0f);
    scene.bodies.push_back(drum());
    constexpr int drum_index = 1;
    scene.before_step = [dt = scene.dt](SceneDriver& driver, int step) {
        constexpr float speed = turns_per_minute * 2.0f * pi / 60.0f;
        // Whole turns are taken off first: the sine stays exact however long the drum turns.
        float turn = static_cast<float>(step + 1) * dt * speed / (2.0f * pi);
        turn -= static_cast<float>(static_cast<int>(turn));
        driver.move_to(drum_index, {drum_centre, rotation_about(drum_axis, 2.0f * pi * turn)});
    };
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (int k = 0; k < side; ++k) {
                float x = static_cast<float>(4 * i - 2 * side + 2) * half;
                float y = static_cast<float>(4 * j - 2 * side + 2) * half + drum_centre.y;
                float z = static_cast<float>(4 * k - 2 * side + 2) * half;
                add_body(scene, Box{{half, half, half}}, {x, y, z});
            }
    return scene;
}

// Pairs of boxes on a floor that fall asleep, and beside them a walled yard in which 200 balls and boxes jump every
// second.
SceneDescription large_world_sleep(int count) {
    constexpr int jumpers = 200;
    SceneDescription scene;
    scene.steps = 300;
    scene.warm_up_steps = 180;
    scene.about_sleep = true;
    add_ground(scene, 400.0f);
    for (int i = 0; i < count; ++i)
        add_body(scene, Box{half_metre},
                 {static_cast<float>(i / 2 % 100 - 50) * 2.5f, 0.5f + static_cast<float>(i % 2),
                  static_cast<float>(i / 200 - 50) * 2.5f});
    add_static(scene, Box{{1.0f, 3.0f, 22.0f}}, {179.0f, 3.0f, 0.0f});
    add_static(scene, Box{{1.0f, 3.0f, 22.0f}}, {221.0f, 3.0f, 0.0f});
    add_static(scene, Box{{20.0f, 3.0f, 1.0f}}, {200.0f, 3.0f, 21.0f});
    add_static(scene, Box{{20.0f, 3.0f, 1.0f}}, {200.0f, 3.0f, -21.0f});
    int first = static_cast<int>(scene.bodies.size());
    for (int i = 0; i < jumpers; ++i) {
        Shape shape = i % 2 != 0 ? Shape{Box{half_metre}} : Shape{Sphere{0.5f}};
        Position position{190.0f + static_cast<float>(i % 10) * 2.0f, 1.0f + 1.5f * static_cast<float>(i / 100),
                          (static_cast<float>(i / 10 % 10) - 4.5f) * 2.0f};
        add_body(scene, shape, position).allow_sleep = false;
    }
    scene.before_step = [first](SceneDriver& driver, int step) {
        if (step % 60 != 0) return;
        // Drawn anew from the step: a world that was put back to an earlier step goes on as it did.
        Random random(static_cast<uint64_t>(step) + 1);
        for (int i = first; i < first + jumpers; ++i) {
            Vec3 velocity;
            velocity.x = random.range(-4.0f, 4.0f);
            velocity.y = random.range(1.0f, 3.0f);
            velocity.z = random.range(-4.0f, 4.0f);
            driver.set_velocity(i, velocity);
        }
    };
    return scene;
}

// The tennis racket theorem: a body turning about its middle axis of inertia flips over again and again (Landau and
// Lifshitz, Mechanics, paragraph 37). Half a period is 4.04 s.
SceneDescription dzhanibekov(int) {
    SceneDescription scene;
    scene.gravity = {};
    scene.steps = 3600;
    SceneBody& body = add_body(scene, Box{{1.0f, 0.5f, 0.2f}}, {});
    body.mass = 12.0f;
    body.angular_velocity = {0.05f, 5.0f, 0.05f};
    body.name = "box";
    return scene;
}

}  // namespace lendulet::scenes
