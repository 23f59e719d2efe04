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

ColliderDef& add_part(SceneBody& body, Shape shape, Transform local, float density) {
    ColliderDef& collider = body.colliders.emplace_back();
    collider.shape = std::move(shape);
    collider.local = local;
    collider.density = density;
    return collider;
}

SceneJoint& add_ball_joint(SceneDescription& scene, int a, int b, Position anchor) {
    SceneJoint& joint = scene.joints.emplace_back();
    joint.body_a = a;
    joint.body_b = b;
    joint.anchor = anchor;
    return joint;
}

SceneJoint& add_hinge(SceneDescription& scene, int a, int b, Position anchor, Vec3 axis) {
    SceneJoint& joint = add_ball_joint(scene, a, b, anchor);
    joint.type = JointType::hinge;
    joint.axis = axis;
    return joint;
}

float terrain_height(float x, float z) {
    float hills = 3.0f * sin_cos(0.15f * x).sin * sin_cos(0.15f * z).cos;
    return hills + 0.3f * sin_cos(1.1f * x).sin * sin_cos(0.9f * z).sin;
}

void add_terrain(SceneDescription& scene, uint32_t cells, float cell, float rise) {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    float half = 0.5f * static_cast<float>(cells) * cell;
    for (uint32_t row = 0; row <= cells; ++row)
        for (uint32_t column = 0; column <= cells; ++column) {
            float x = static_cast<float>(column) * cell - half, z = static_cast<float>(row) * cell - half;
            vertices.push_back({x, rise * terrain_height(x, z), z});
        }
    for (uint32_t row = 0; row < cells; ++row)
        for (uint32_t column = 0; column < cells; ++column) {
            uint32_t a = row * (cells + 1) + column, b = a + 1, c = a + cells + 1, d = c + 1;
            for (uint32_t corner : {a, c, b, b, c, d}) indices.push_back(corner);
        }
    TriangleMesh mesh = TriangleMesh::from_triangles(vertices, indices).value();
    add_static(scene, mesh, {}).name = "terrain";
    scene.meshes.push_back({std::move(vertices), std::move(indices), std::move(mesh)});
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
