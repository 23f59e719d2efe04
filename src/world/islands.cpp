// Stage 4: groups of bodies that touch or are joined, and which of them rest. A group sleeps when all of it has been
// slow for a while, and wakes as a whole.
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr float sleep_time = 0.5f;    // s that a whole island must have been slow
constexpr float sleep_speed = 0.03f;  // m/s of the fastest material point; raises rest noise of the peers by twice

uint32_t root(Array<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

void join(Array<uint32_t>& parent, uint32_t a, uint32_t b) {
    a = root(parent, a);
    b = root(parent, b);
    if (a != b) parent[a > b ? a : b] = a > b ? b : a;  // the smaller slot leads: independent of the order of contacts
}

// A static or kinematic body that does not leave in peace what rests on it.
bool disturbs(const WorldData& world, uint32_t slot) {
    const BodyMomenta& m = world.bodies.momenta[slot];
    return world.bodies.info[slot].placed || length_squared(m.p) + length_squared(m.L) > 0.0f;
}

float surface_speed(const BodyStore& bodies, uint32_t slot) {
    return length(bodies.velocity(slot)) + bodies.info[slot].radius * length(bodies.angular_velocity(slot));
}

void set_awake(BodyInfo& info) {
    if (info.asleep) info.asleep = false, info.still_time = 0.0f;
}

}  // namespace

void wake_body(WorldData& world, uint32_t slot) {
    world.bodies.info[slot].asleep = false;
    world.bodies.info[slot].still_time = 0.0f;
}

void wake_touching(WorldData& world, uint32_t slot) {
    for (uint32_t i : world.touching) {
        const ColliderPair& p = world.pairs.now[world.records[i].pair];
        uint32_t a = world.colliders.info[p.a].body, b = world.colliders.info[p.b].body;
        if (a == slot) set_awake(world.bodies.info[b]);
        if (b == slot) set_awake(world.bodies.info[a]);
    }
}

void update_islands(WorldData& world, float dt) {
    if (!world.config.allow_sleep) return;
    BodyStore& bodies = world.bodies;
    Array<uint32_t>& parent = world.island_parent;
    parent.resize_unset(bodies.slots.capacity());
    for (uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
    auto link = [&](uint32_t a, uint32_t b) {
        bool moving_a = bodies.info[a].type == BodyType::dynamic, moving_b = bodies.info[b].type == BodyType::dynamic;
        if (moving_a && moving_b) join(parent, a, b);
        // A kinematic body in motion wakes what it touches, and so does whatever has just been put there.
        else if (moving_a && disturbs(world, b)) set_awake(bodies.info[a]);
        else if (moving_b && disturbs(world, a)) set_awake(bodies.info[b]);
    };
    for (uint32_t i : world.touching) {
        const ColliderPair& p = world.pairs.now[world.records[i].pair];
        link(world.colliders.info[p.a].body, world.colliders.info[p.b].body);
    }
    world.joints.for_each_link(link);

    // The shortest rest in each island decides for all of it; sleeping bodies have rested long enough.
    Array<float>& still = world.island_still;
    still.assign(bodies.slots.capacity(), 1e30f);
    for (uint32_t slot : bodies.slots.order()) {
        BodyInfo& info = bodies.info[slot];
        if (info.type != BodyType::dynamic) continue;
        if (!info.asleep) {
            bool slow = info.allow_sleep && !info.has_forces && surface_speed(bodies, slot) < sleep_speed;
            info.still_time = slow ? info.still_time + dt : 0.0f;
        }
        float& s = still[root(parent, slot)];
        s = minimum(s, info.asleep ? sleep_time : info.still_time);
    }
    for (uint32_t slot : bodies.slots.order()) {
        BodyInfo& info = bodies.info[slot];
        info.placed = false;
        if (info.type != BodyType::dynamic) continue;
        bool rest = still[root(parent, slot)] >= sleep_time;
        if (rest && !info.asleep) {
            info.asleep = true;
            bodies.momenta[slot] = {};
            bodies.change[slot] = {};
        } else if (!rest) {
            set_awake(info);
        }
    }
}

}  // namespace lendulet
