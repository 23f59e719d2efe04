// A game that rewinds and looks ahead: snapshots, a second world that tries out what would happen, and the same bits
// again when the same is done.
#include <cstdio>
#include <deque>
#include <vector>

#include "lendulet/lendulet.h"

using namespace lendulet;

int main() {
    World world = WorldBuilder{}.build().value();
    world.add_static_body({.shape = Plane{}}).value();
    for (int i = 0; i < 60; ++i)
        world
            .add_rigid_body({.shape = Box{{0.05f, 0.25f, 0.12f}}, .position = {0.3f * static_cast<float>(i), 0.25f, 0}})
            .value();
    BodyId first = world.body(1), last = world.body(60);

    // The last two seconds, a snapshot for every twelfth step.
    std::deque<std::vector<uint8_t>> past;
    world.get(first).apply_impulse({6, 0, 0}, world.get(first).position() + Vec3{0, 0.2f, 0}).value();
    for (int i = 0; i < 240; ++i) {
        if (i % 12 == 0) past.push_back(world.snapshot());
        if (past.size() > 10) past.pop_front();
        world.update(1.0f / 60).value();
    }
    const uint64_t once = world.hash();

    // Back by two seconds, and the same again.
    world.restore(past.front()).value();
    const double from = world.time();
    for (int i = 0; i < 120; ++i) world.update(1.0f / 60).value();
    std::printf("from %.1f s on again: %s\n", from, world.hash() == once ? "the same bits" : "something else");

    // What if a domino had been taken out? In a world of its own; the first one knows nothing of it.
    world.restore(past.front()).value();
    World other = world.fork().value();
    other.remove_body(other.body(45)).value();
    for (World* w : {&world, &other})
        for (int i = 0; i < 900; ++i) w->update(1.0f / 60).value();
    auto fell = [&](const World& w) { return w.get(last).position().y < 0.2f ? "falls" : "stands"; };
    std::printf("the last domino %s; without the 45th it %s\n", fell(world), fell(other));
}
