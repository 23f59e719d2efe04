// What the tests of worlds share: small scenes, and figures of a whole world.
#pragma once

#include <cmath>
#include <vector>

#include "lendulet/lendulet.h"

namespace lendulet::test {

inline constexpr float dt = 1.0f / 60.0f;
inline constexpr int widths[] = {1, 4, 8, 16};  // of SIMD lanes

inline void run(World& world, int steps, float step = dt) {
    for (int i = 0; i < steps; ++i) world.update(step).value();
}

inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Whether everything that the world reports of its bodies is a number.
inline bool all_finite(const World& world) {
    for (int i = 0; i < world.body_count(); ++i) {
        BodyId id = world.body(i);
        StaticBodyRef body = world.get_static(id);
        Quat q = body.orientation();
        if (!finite(from_origin(body.position())) || !std::isfinite(dot(q, q))) return false;
        if (body.type() != BodyType::fixed) {
            const RigidBodyRef moving = world.get(id);
            if (!finite(moving.momentum()) || !finite(moving.angular_momentum()) || !finite(moving.velocity()) ||
                !finite(moving.angular_velocity()))
                return false;
        }
    }
    return std::isfinite(world.kinetic_energy());
}

// A floor whose top is y = 0.
inline BodyId add_floor(World& world, float half_size = 20.0f) {
    return world
        .add_static_body({.shape = Box{{half_size, 0.5f, half_size}}, .position = {0.0f, -0.5f, 0.0f}, .name = "floor"})
        .value();
}

// A floor with walls, 6 m wide.
inline void add_bowl(World& world) {
    add_floor(world);
    for (int i = 0; i < 4; ++i) {
        const float x = i == 0 ? 4.0f : i == 1 ? -4.0f : 0.0f, z = i == 2 ? 4.0f : i == 3 ? -4.0f : 0.0f;
        world
            .add_static_body({.shape = Box{{i < 2 ? 1.0f : 5.0f, 8.0f, i < 2 ? 5.0f : 1.0f}}, .position = {x, 4.0f, z}})
            .value();
    }
}

// A unit cube of 1000 kg resting at height `level` cubes above the ground.
inline BodyId add_cube(World& world, float x, int level, float z = 0.0f) {
    return world.add_rigid_body({.shape = Box{}, .position = {x, 0.5f + static_cast<float>(level), z}}).value();
}
inline std::vector<BodyId> add_stack(World& world, float x, int height) {
    std::vector<BodyId> stack;
    for (int i = 0; i < height; ++i) stack.push_back(add_cube(world, x, i));
    return stack;
}

inline ConvexHull octahedron(float size) {
    const Vec3 points[] = {{size, 0.0f, 0.0f},  {-size, 0.0f, 0.0f}, {0.0f, size, 0.0f},
                           {0.0f, -size, 0.0f}, {0.0f, 0.0f, size},  {0.0f, 0.0f, -size}};
    return ConvexHull::from_points(points).value();
}

// A square of n x n quads in the plane y = 0, with low waves of the given height.
inline TriangleMesh wavy_ground(int n, float half_size, float height) {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    auto place = [&](int i) { return half_size * (2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f); };
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) vertices.push_back({place(i), (i + k) % 2 ? height : 0.0f, place(k)});
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            uint32_t a = static_cast<uint32_t>(i * (n + 1) + k), b = a + static_cast<uint32_t>(n) + 1;
            for (uint32_t v : {a, a + 1, b, a + 1, b + 1, b}) indices.push_back(v);
        }
    return TriangleMesh::from_triangles(vertices, indices).value();
}

// Boxes, balls, capsules and octahedra above a mesh, some joined by ball joints and hinges.
void add_mixed_pile(World& world, int side);

}  // namespace lendulet::test
