// A ball falls on a floor and bounces.
#include <cstdio>

#include "lendulet/lendulet.h"

using namespace lendulet;

int main() {
    World world = WorldBuilder{}.down_gravity(9.81f).friction(0.5f).build().value();
    world.add_static_body({.shape = Box{{10, 0.5f, 10}}, .position = {0, -0.5f, 0}}).value();
    BodyId ball =
        world.add_rigid_body({.shape = Sphere{1}, .position = {0, 10, 0}, .density = 500, .restitution = 0.9f}).value();

    for (int step = 1; step <= 300; ++step) {
        world.update(1.0f / 60).value();
        if (step % 30 == 0) {
            RigidBodyRef body = world.get(ball);
            std::printf("%4.1f s: %5.2f m high, momentum %9.1f kg m/s\n", world.time(), body.position().y,
                        body.momentum().y);
        }
    }
}
