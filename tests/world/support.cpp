#include "world/support.h"

namespace lendulet::test {

void add_mixed_pile(World& world, int side) {
    world.add_static_body({.shape = wavy_ground(8, 12.0f, 0.1f), .name = "ground"}).value();
    for (float s : {-1.0f, 1.0f}) {
        world.add_static_body({.shape = Box{{0.5f, 4.0f, 8.0f}}, .position = {6.0f * s, 2.0f, 0.0f}}).value();
        world.add_static_body({.shape = Box{{8.0f, 4.0f, 0.5f}}, .position = {0.0f, 2.0f, 6.0f * s}}).value();
    }
    const Shape shapes[] = {Box{{0.4f, 0.3f, 0.5f}}, Sphere{0.4f}, Capsule{0.3f, 0.3f}, octahedron(0.5f)};
    std::vector<BodyId> bodies;
    for (int i = 0; i < side * side * side; ++i) {
        int x = i % side, z = i / side % side, y = i / (side * side);
        float shift = 0.07f * static_cast<float>(i % 5);
        Position at{1.2f * static_cast<float>(x - side / 2) + shift, 1.0f + 1.1f * static_cast<float>(y),
                    1.2f * static_cast<float>(z - side / 2) - shift};
        bodies.push_back(world.add_rigid_body({.shape = shapes[i % 4], .position = at, .friction = 0.6f}).value());
    }
    for (size_t i = 0; i + 1 < bodies.size(); i += 9) {
        Position a = world.get(bodies[i]).position(), b = world.get(bodies[i + 1]).position();
        JointType type = i % 2 ? JointType::hinge : JointType::ball;
        world.add_joint(world.joint_at(type, bodies[i], bodies[i + 1], a + 0.5f * (b - a), {0.0f, 1.0f, 0.0f}).value())
            .value();
    }
}

}  // namespace lendulet::test
