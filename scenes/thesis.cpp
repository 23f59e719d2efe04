// The demos of the thesis that the engine is named after. Where it gives a box's size it means full edges. Only the
// first has gravity; a unit box weighs 1 kg.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

constexpr float bounciness = 0.9f;  // of the demos of a few bodies, as in the thesis's printed example
constexpr float unit_density = 1.0f;

SceneDescription weightless(int steps) {
    SceneDescription scene;
    scene.gravity = {};
    scene.steps = steps;
    return scene;
}

SceneDescription two_bodies(Shape left, Shape right) {
    SceneDescription scene = weightless(300);
    scene.restitution = bounciness;
    // Half a radius beside each other: an oblique impact that leaves both turning.
    add_body(scene, std::move(left), {-5.0f, 0.0f, 0.0f}, unit_density).velocity = {4.0f, 0.0f, 0.0f};
    add_body(scene, std::move(right), {5.0f, 0.5f, 0.0f}, unit_density).velocity = {-4.0f, 0.0f, 0.0f};
    return scene;
}

// Unit boxes in a grid with a centimetre between them, centred on the origin.
void add_grid(SceneDescription& scene, int nx, int ny, int nz) {
    constexpr float pitch = 1.01f;
    for (int x = 0; x < nx; ++x)
        for (int y = 0; y < ny; ++y)
            for (int z = 0; z < nz; ++z) {
                Position position{(static_cast<float>(x) - 0.5f * static_cast<float>(nx - 1)) * pitch,
                                  (static_cast<float>(y) - 0.5f * static_cast<float>(ny - 1)) * pitch,
                                  (static_cast<float>(z) - 0.5f * static_cast<float>(nz - 1)) * pitch};
                add_body(scene, Box{half_metre}, position).mass = 1.0f;
            }
}

// A box of 4 m and 20 kg, given by its momentum.
void add_striker(SceneDescription& scene, Position position, Vec3 momentum) {
    constexpr float mass = 20.0f;
    SceneBody& body = add_body(scene, Box{{2.0f, 2.0f, 2.0f}}, position);
    body.mass = mass;
    body.velocity = (1.0f / mass) * momentum;
}

// A square of balls of radius 0.5 in a plane across z.
void add_balls(SceneDescription& scene, int side, float z, Vec3 velocity) {
    constexpr float pitch = 1.1f;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            float middle = 0.5f * static_cast<float>(side - 1);
            Position position{(static_cast<float>(i) - middle) * pitch, (static_cast<float>(j) - middle) * pitch, z};
            SceneBody& ball = add_body(scene, Sphere{0.5f}, position, unit_density);
            ball.velocity = velocity;
        }
}

}  // namespace

// Boxes and balls of all sizes, 4 m apart, so that the largest boxes start inside their neighbours and are pushed apart
// at the bounded separation speed.
SceneDescription many_things(int side) {
    SceneDescription scene;
    scene.steps = 1200;
    add_ground(scene, 500.0f);
    Random random;
    float middle = 0.5f * static_cast<float>(side - 1);
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) {
                Position position;
                position.x = (static_cast<float>(x) - middle) * 4.0f + random.range(-0.5f, 0.5f);
                position.y = static_cast<float>(y) * 4.0f + 5.0f + random.range(-0.5f, 0.5f);
                position.z = (static_cast<float>(z) - middle) * 4.0f + random.range(-0.5f, 0.5f);
                if (random.unit() < 0.5f) {
                    Vec3 half;
                    half.x = random.range(0.5f, 3.0f);
                    half.y = random.range(0.5f, 3.0f);
                    half.z = random.range(0.5f, 3.0f);
                    add_body(scene, Box{half}, position, unit_density);
                } else {
                    add_body(scene, Sphere{random.range(0.25f, 1.5f)}, position, unit_density);
                }
            }
    return scene;
}

SceneDescription two_spheres(int) { return two_bodies(Sphere{1.0f}, Sphere{1.0f}); }
SceneDescription sphere_and_box(int) { return two_bodies(Sphere{1.0f}, Box{{1.0f, 1.0f, 1.0f}}); }
SceneDescription two_boxes(int) { return two_bodies(Box{{1.0f, 1.0f, 1.0f}}, Box{{1.0f, 1.0f, 1.0f}}); }

SceneDescription wrecking_ball(int side) {
    SceneDescription scene = weightless(600);
    add_grid(scene, side, side, 5);
    add_striker(scene, {0.0f, 0.0f, 30.0f}, {0.0f, 0.0f, -450.0f});
    return scene;
}

SceneDescription carpet_bomb(int side) {
    SceneDescription scene = weightless(900);
    add_grid(scene, side, 1, side);
    constexpr int bombs = 7;          // along each side
    constexpr float distance = 8.0f;  // between two bombs on their way, m: they arrive 0.2 s apart
    float pitch = static_cast<float>(side) * 1.01f / static_cast<float>(bombs);
    for (int i = 0; i < bombs * bombs; ++i) {
        float x = (static_cast<float>(i % bombs) - 0.5f * static_cast<float>(bombs - 1)) * pitch;
        float z = (static_cast<float>(i / bombs) - 0.5f * static_cast<float>(bombs - 1)) * pitch;
        add_striker(scene, {x, 30.0f + distance * static_cast<float>(i), z}, {0.0f, -800.0f, 0.0f});
    }
    return scene;
}

// The great ball keeps its place and its spin: a kinematic body whose angular velocity is that of a ball of unit
// density with angular momentum 5e6 kg m^2/s.
SceneDescription spinning_ball(int side) {
    constexpr float radius = 20.0f, angular_momentum = 5e6f;
    constexpr float mass = 4.0f / 3.0f * pi * radius * radius * radius * unit_density;
    constexpr float inertia = 0.4f * mass * radius * radius;
    SceneDescription scene = weightless(600);
    SceneBody& ball = add_body(scene, Sphere{radius}, {}, unit_density);
    ball.type = BodyType::kinematic;
    ball.angular_velocity = {0.0f, angular_momentum / inertia, 0.0f};
    ball.name = "spinning_ball";
    add_balls(scene, side, 30.0f, {0.0f, 0.0f, -5.0f});
    return scene;
}

SceneDescription rotating_board(int side) {
    SceneDescription scene = weightless(600);
    SceneBody& board = add_body(scene, Box{{20.0f, 5.0f, 0.5f}}, {}, unit_density);
    board.type = BodyType::kinematic;
    board.angular_velocity = {0.0f, 1.0f, 0.0f};
    board.name = "board";
    add_balls(scene, side, 8.0f, {});
    return scene;
}

}  // namespace lendulet::scenes
