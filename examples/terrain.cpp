// Hills from a height field, a ramp of triangles with ice on it, hammers made of two shapes, and rocks of points.
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "lendulet/lendulet.h"

using namespace lendulet;

namespace {

// 64 x 64 samples a metre apart, around the origin.
HeightField hills() {
    constexpr int samples = 64;
    std::vector<float> heights;
    for (int z = 0; z < samples; ++z)
        for (int x = 0; x < samples; ++x)
            heights.push_back(0.6f * std::sin(0.35f * static_cast<float>(x)) * std::cos(0.3f * static_cast<float>(z)));
    return HeightField::from_heights(
               {.columns = samples, .rows = samples, .heights = heights, .origin = {-31.5f, 0, -31.5f}})
        .value();
}

// Two triangles, the left half of the ramp of wood and the right one of ice.
BodyId add_ramp(World& world) {
    const std::vector<Vec3> corners{{-2, 3, 0}, {0, 3, 0}, {2, 3, 0}, {-2, 0, 6}, {0, 0, 6}, {2, 0, 6}};
    const std::vector<uint32_t> triangles{0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5};
    const std::vector<uint8_t> kinds{0, 0, 1, 1};  // places in the table below
    const std::array table{
        Material{.static_friction = 0.7f, .dynamic_friction = 0.6f},
        Material{.static_friction = 0.02f, .dynamic_friction = 0.02f, .friction_combine = CombineRule::minimum}};
    const ColliderDef ramp{.shape = TriangleMesh::from_triangles(corners, triangles, {.materials = kinds}).value(),
                           .materials = table};
    return world.add_static_body({.position = {0, 1, 0}, .colliders = {&ramp, 1}, .name = "ramp"}).value();
}

// A wooden handle and an iron head: mass, centre and inertia follow from shapes and densities.
BodyId add_hammer(World& world, Position position) {
    const std::array parts{
        ColliderDef{.shape = Cylinder{0.15f, 0.015f}, .density = 700},
        ColliderDef{.shape = Box{{0.05f, 0.02f, 0.02f}}, .local = {{0, 0.17f, 0}, {}}, .density = 7800}};
    return world.add_rigid_body({.position = position, .colliders = parts, .name = "hammer"}).value();
}

ConvexHull rock() {
    std::vector<Vec3> points;
    for (int i = 0; i < 24; ++i) {  // along a spiral on an ellipsoid
        const float y = -1 + 2 * (static_cast<float>(i) + 0.5f) / 24, r = std::sqrt(1 - y * y);
        const float turn = 2.4f * static_cast<float>(i);
        points.push_back({0.5f * r * std::cos(turn), 0.3f * y, 0.4f * r * std::sin(turn)});
    }
    return ConvexHull::from_points(points).value();
}

}  // namespace

int main() {
    World world = WorldBuilder{}.build().value();
    BodyId ground = world.add_static_body({.shape = hills(), .name = "hills"}).value();
    add_ramp(world);
    BodyId hammer = add_hammer(world, {6, 3, 0});
    const ConvexHull stone = rock();  // one set of points for all rocks
    for (int i = 0; i < 50; ++i)
        world
            .add_rigid_body({.shape = stone,
                             .position = {8 + static_cast<float>(i % 5), 3 + static_cast<float>(i / 5), 8},
                             .density = 2600})
            .value();
    BodyId on_wood = world.add_rigid_body({.shape = Box{{0.2f, 0.1f, 0.2f}}, .position = {-1, 3.7f, 1}}).value();
    BodyId on_ice = world.add_rigid_body({.shape = Box{{0.2f, 0.1f, 0.2f}}, .position = {1, 3.7f, 1}}).value();

    for (int i = 0; i < 90; ++i) world.update(1.0f / 60).value();
    std::printf("after 1.5 s the box on wood is at z = %.1f m, the one on ice at %.1f\n",
                world.get(on_wood).position().z, world.get(on_ice).position().z);
    for (int i = 0; i < 510; ++i) world.update(1.0f / 60).value();

    std::printf("the hammer, %.2f kg, lies on %s\n", world.get(hammer).mass(), [&] {
        for (int i = 0; i < world.contact_count(); ++i) {
            const Contact c = world.contact(i);
            if (c.body_a == ground && c.body_b == hammer) return "the hills";
        }
        return "nothing";
    }());
    const StepStatistics& s = world.statistics();
    std::printf("%d of %d bodies are awake after %.0f s\n", s.awake_bodies, s.bodies, world.time());
}
