// Gallery: things built without mortar, and what brings them down.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

// The rotation about y that turns x towards (x, z).
Quat facing(float x, float z) { return rotation_about(along_y, -arc_tangent2(z, x)); }

// A round tower of `courses` rings of bricks, each ring turned by half a brick.
void add_round_tower(SceneDescription& scene, int courses) {
    constexpr int bricks = 14;
    constexpr float radius = 2.0f, thickness = 0.25f, half_height = 0.2f;
    const SinCos half_angle = sin_cos(pi / static_cast<float>(bricks));
    const float inner_half = (radius - thickness) * half_angle.sin / half_angle.cos - 0.004f;
    for (int course = 0; course < courses; ++course)
        for (int i = 0; i < bricks; ++i) {
            float angle = 2.0f * pi * (static_cast<float>(i) + 0.5f * static_cast<float>(course % 2)) / bricks;
            SinCos s = sin_cos(angle);
            Position at{radius * s.cos, half_height * static_cast<float>(2 * course + 1), radius * s.sin};
            SceneBody& brick = add_body(scene, Box{{thickness, half_height, inner_half}}, at, 1200.0f);
            brick.orientation = facing(s.cos, s.sin);
        }
}

// One stone of an arch between two angles of its circle, around its own middle.
ConvexHull voussoir(float from, float to, float inner, float outer, float half_depth, Vec3 middle) {
    std::vector<Vec3> points;
    for (float angle : {from, to})
        for (float radius : {inner, outer})
            for (float z : {-half_depth, half_depth}) {
                SinCos s = sin_cos(angle);
                points.push_back(Vec3{radius * s.cos, radius * s.sin, z} - middle);
            }
    return ConvexHull::from_points(points).value();
}

// Two cards leaning against each other over `x`, standing at height `y`.
struct Card {
    float half_height, half_thickness, half_width;
};
void add_pair(SceneDescription& scene, const Card& card, float x, float y, SinCos lean, float angle) {
    const float out = card.half_thickness * lean.cos + card.half_height * lean.sin;
    const float rise = card.half_height * lean.cos + card.half_thickness * lean.sin;
    for (float side : {-1.0f, 1.0f}) {
        SceneBody& body = add_body(scene, Box{{card.half_thickness, card.half_height, card.half_width}},
                                   {x + side * out, y + rise, 0.0f}, 300.0f);
        body.orientation = rotation_about(along_z, side * angle);
    }
}

}  // namespace

// Dominoes on a spiral of Archimedes; the outermost is given a push inwards along it.
SceneDescription domino_spiral(int count) {
    constexpr Vec3 half{0.0375f, 0.24f, 0.12f};
    constexpr float pitch = 0.2f, arms = 0.62f, first_radius = 0.9f;  // m
    constexpr float growth = arms / (2.0f * pi);                      // of the radius per radian
    SceneDescription scene;
    scene.steps = 400 + 5 * count;
    add_ground(scene, maximum(10.0f, 0.1f * static_cast<float>(count)));
    float angle = first_radius / growth;
    Vec3 forward;
    for (int i = 0; i < count; ++i) {
        SinCos s = sin_cos(angle);
        float radius = growth * angle;
        Vec3 tangent = normalize(Vec3{growth * s.cos - radius * s.sin, 0.0f, growth * s.sin + radius * s.cos});
        SceneBody& body = add_body(scene, Box{half}, {radius * s.cos, half.y, radius * s.sin}, 1000.0f);
        body.orientation = facing(tangent.x, tangent.z);
        forward = -tangent;
        angle += pitch / square_root(radius * radius + growth * growth);
    }
    // Turning about its lower front edge, fast enough to pass the tipping point.
    constexpr float spin = 3.0f;
    SceneBody& last = scene.bodies.back();
    last.angular_velocity = spin * cross(along_y, forward);
    last.velocity = spin * (half.y * forward + half.x * along_y);
    return scene;
}

// A heavy ball on a rod swings into a round tower.
SceneDescription brick_tower(int courses) {
    constexpr float radius = 1.1f, rod = 10.0f, raised = 1.4f;  // m, m, rad
    SceneDescription scene;
    scene.steps = 480;
    add_ground(scene, 60.0f);
    add_round_tower(scene, courses);
    const float hit = 0.55f * 0.4f * static_cast<float>(courses);
    const Position pivot{-2.4f, maximum(hit, 1.2f) + rod, 0.0f};
    add_static(scene, Box{{0.4f, 0.15f, 0.4f}}, pivot).name = "crane";
    int crane = last_body(scene);
    const Quat turn = rotation_about(along_z, -raised);
    SceneBody& ball = add_body(scene, Sphere{radius}, pivot + rotate(turn, Vec3{0.0f, -rod, 0.0f}), 6000.0f);
    ball.orientation = turn;
    ball.name = "ball";
    add_part(ball, Capsule{0.5f * (rod - radius) - 0.3f, 0.05f}, {{0.0f, 0.5f * (rod + radius), 0.0f}, {}}, 200.0f);
    add_hinge(scene, crane, last_body(scene), pivot, along_z);
    return scene;
}

// A half circle of wedge-shaped stones that stands by its shape alone, and crates that fall on its crown.
SceneDescription arch(int stones) {
    constexpr float inner = 3.0f, outer = 3.9f, half_depth = 0.7f;
    SceneDescription scene;
    scene.friction = 0.7f;
    add_ground(scene, 30.0f);
    const float middle_radius = 0.5f * (inner + outer);
    for (int i = 0; i < stones; ++i) {
        float from = pi * static_cast<float>(i) / static_cast<float>(stones);
        float to = pi * static_cast<float>(i + 1) / static_cast<float>(stones);
        SinCos s = sin_cos(0.5f * (from + to));
        Vec3 middle{middle_radius * s.cos, middle_radius * s.sin, 0.0f};
        add_body(scene, voussoir(from, to, inner, outer, half_depth, middle), Position{} + middle, 2400.0f);
    }
    for (int i = 0; i < 3; ++i)
        add_body(scene, Box{{0.3f, 0.3f, 0.3f}}, {0.0f, outer + 0.9f + 1.5f * static_cast<float>(i), 0.0f}, 400.0f);
    return scene;
}

// Leaning pairs of cards carry level ones, and these the next storey.
SceneDescription card_house(int storeys) {
    constexpr Card card{0.44f, 0.012f, 0.3f};
    constexpr float angle = 0.40f, roof_gap = 0.004f;  // rad, m
    const SinCos lean = sin_cos(angle);
    const float pitch = 4.0f * card.half_height * lean.sin + 0.05f;
    const float storey = 2.0f * (card.half_height * lean.cos + card.half_thickness * lean.sin);
    SceneDescription scene;
    scene.friction = 0.8f;
    add_ground(scene, 20.0f);
    for (int level = 0; level < storeys; ++level) {
        const int pairs = storeys - level;
        const float y = static_cast<float>(level) * (storey + 2.0f * card.half_thickness);
        const float left = -0.5f * pitch * static_cast<float>(pairs - 1);
        for (int i = 0; i < pairs; ++i) add_pair(scene, card, left + pitch * static_cast<float>(i), y, lean, angle);
        for (int i = 0; i + 1 < pairs; ++i) {
            Position at{left + pitch * (static_cast<float>(i) + 0.5f), y + storey + card.half_thickness, 0.0f};
            add_body(scene, Box{{0.5f * pitch - roof_gap, card.half_thickness, card.half_width}}, at, 300.0f);
        }
    }
    return scene;
}

}  // namespace lendulet::scenes
