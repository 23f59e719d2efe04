#include "scenes/parts.h"

#include <utility>

namespace lendulet::scenes {

SceneBody& add_body(SceneDescription& scene, Shape shape, Position position, float density) {
    SceneBody& body = scene.bodies.emplace_back();
    ColliderDef& collider = body.colliders.emplace_back();
    collider.shape = std::move(shape);
    collider.density = density;
    body.position = position;
    return body;
}

SceneBody& add_static(SceneDescription& scene, Shape shape, Position position) {
    SceneBody& body = add_body(scene, std::move(shape), position);
    body.type = BodyType::fixed;
    return body;
}

void add_ground(SceneDescription& scene, float half) {
    add_static(scene, Box{{half, 1.0f, half}}, {0.0f, -1.0f, 0.0f}).name = "ground";
}

void add_container(SceneDescription& scene, float inner, float height) {
    constexpr float t = 1.0f;  // half the thickness of walls and floor
    float outer = inner + 2.0f * t, middle = inner + t, half = 0.5f * height;
    add_static(scene, Box{{outer, t, outer}}, {0.0f, -t, 0.0f}).name = "ground";
    add_static(scene, Box{{t, half, outer}}, {middle, half, 0.0f});
    add_static(scene, Box{{t, half, outer}}, {-middle, half, 0.0f});
    add_static(scene, Box{{inner, half, t}}, {0.0f, half, middle});
    add_static(scene, Box{{inner, half, t}}, {0.0f, half, -middle});
}

ConvexHull rock(Random& random, int count, float radius) {
    float y = radius * random.range(0.75f, 1.0f);
    float z = radius * random.range(0.75f, 1.0f);
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(multiply(Vec3{radius, y, z}, random.direction()));
    return ConvexHull::from_points(points).value();
}

Props::Props(Random& random) {
    for (int i = 0; i < 8; ++i) rocks_.push_back(rock(random, 24, 0.6f));
}

Shape Props::shape(Kind kind, int number) const {
    constexpr Kind turns[4] = {Kind::box, Kind::sphere, Kind::capsule, Kind::convex};
    switch (kind == Kind::mixed ? turns[number % 4] : kind) {
        case Kind::box:
            return Box{half_metre};
        case Kind::sphere:
            return Sphere{0.5f};
        case Kind::capsule:
            return Capsule{0.4f, 0.3f};
        default:
            return rocks_[static_cast<size_t>(number / 4 % 8)];
    }
}

}  // namespace lendulet::scenes
