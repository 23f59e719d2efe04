// A brick falls on a floor, through a zone that counts who passes, and tells what happened to it.
#include <cstdio>

#include "lendulet/lendulet.h"

using namespace lendulet;

int main() {
    World world = WorldBuilder().bounciness(0.3f).hit_speed(0.5f).build().value();
    world.add_static_body({.shape = Plane{}, .name = "ground"}).value();
    const ColliderDef zone{.shape = Box{{1.0f, 0.2f, 1.0f}}, .is_trigger = true, .events = Events::contacts};
    world.add_static_body({.position = {0.0f, 2.0f, 0.0f}, .colliders = {&zone, 1}, .name = "zone"}).value();
    world
        .add_rigid_body({.shape = Box{{0.1f, 0.05f, 0.2f}},
                         .position = {0.0f, 4.0f, 0.0f},
                         .angular_velocity = {0.5f, 0.0f, 1.0f},
                         .events = Events::all,
                         .name = "brick"})
        .value();

    auto name = [&](BodyId id) { return world.get_static(id).name().data(); };  // none of these is removed
    while (world.time() < 3.0) {
        world.update(1.0f / 60.0f).value();
        const double t = world.time();
        for (const Overlap& o : world.trigger_begins()) std::printf("%.2f s: %s enters\n", t, name(o.other_body));
        for (const Overlap& o : world.trigger_ends()) std::printf("%.2f s: %s leaves\n", t, name(o.other_body));
        for (const ContactHit& hit : world.contact_hits())
            std::printf("%.2f s: %s hits %s at %.2f m/s, %.1f N s\n", t, name(hit.body_b), name(hit.body_a), hit.speed,
                        hit.impulse);
        for (const SleepEvent& e : world.sleep_events())
            std::printf("%.2f s: %s %s\n", t, name(e.body), e.asleep ? "sleeps" : "wakes");
    }
}
