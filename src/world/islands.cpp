// Stage 4: groups of bodies that touch or are joined, and which of them rest. A group sleeps when all of it has been
// slow for a while, and wakes as a whole.
//
// Groups are formed of movers alone. Where one that does not rest touches a sleeping body, that body's whole group is
// followed through its contacts and joints and wakes, and groups are formed anew.
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr float sleep_time = 0.5f;    // s that a whole island must have been slow
constexpr float sleep_speed = 0.03f;  // m/s of the fastest material point; raises rest noise of the peers by twice
constexpr float endless = 1e30f;      // s

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
    return world.bodies.info[slot].placed_at == static_cast<uint32_t>(world.steps) ||
           length_squared(m.p) + length_squared(m.L) > 0.0f;
}

float surface_speed(const BodyStore& bodies, uint32_t slot) {
    return length(bodies.velocity(slot)) + bodies.info[slot].radius * length(bodies.angular_velocity(slot));
}

// visit(body) for the other body of every contact.
template <class Visit>
void for_each_touching(const WorldData& world, uint32_t slot, Visit&& visit) {
    for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
        world.pairs.for_each_of(c, [&](uint32_t number) {
            const ColliderPair& p = world.pairs.pairs[number];
            if (p.count > 0) visit(world.colliders.info[p.a == c ? p.b : p.a].body);
        });
}

// True where it was asleep.
bool wake_sleeper(WorldData& world, uint32_t slot) {
    if (!world.bodies.info[slot].asleep) return false;
    wake_body(world, slot);
    return true;
}

void wake_island(WorldData& world, uint32_t slot) {
    Array<uint32_t>& waking = world.waking;
    auto wake = [&](uint32_t body) {
        if (wake_sleeper(world, body)) waking.push_back(body);
    };
    wake(slot);
    while (!waking.empty()) {
        uint32_t body = waking.back();
        waking.pop_back();
        for_each_touching(world, body, wake);
        world.joints.for_each_of(body, [&](uint32_t joint) {
            wake(world.joints.info[joint].body_a);
            wake(world.joints.info[joint].body_b);
        });
    }
}

void count_slow_time(WorldData& world, float dt) {
    for (uint32_t slot : world.movers.bodies) {
        BodyInfo& info = world.bodies.info[slot];
        if (info.type != BodyType::dynamic) continue;
        bool slow = info.allow_sleep && !info.has_forces && surface_speed(world.bodies, slot) < sleep_speed;
        info.still_time = slow ? info.still_time + dt : 0.0f;
    }
}

void link(WorldData& world, uint32_t a, uint32_t b) {
    const BodyInfo &ia = world.bodies.info[a], &ib = world.bodies.info[b];
    bool moving_a = ia.type == BodyType::dynamic, moving_b = ib.type == BodyType::dynamic;
    if (moving_a && moving_b) {
        if (!ia.asleep && !ib.asleep) join(world.island_parent, a, b);
        else if (ia.asleep != ib.asleep) world.touched_sleepers.push_back(ia.asleep ? BodyPair{b, a} : BodyPair{a, b});
    }
    // A kinematic body in motion wakes what it touches, and so does whatever has just been put there.
    else if (moving_a && ia.asleep && disturbs(world, b)) {
        world.touched_sleepers.push_back({b, a});
    } else if (moving_b && ib.asleep && disturbs(world, a)) {
        world.touched_sleepers.push_back({a, b});
    }
}

// The groups of movers, and how long each has been at rest: the shortest time in it.
void form_islands(WorldData& world) {
    Array<uint32_t>& parent = world.island_parent;
    Array<float>& still = world.island_still;
    parent.resize_unset(world.bodies.slots.capacity());
    still.resize_unset(world.bodies.slots.capacity());
    for (uint32_t slot : world.movers.bodies) parent[slot] = slot, still[slot] = endless;
    world.touched_sleepers.clear();
    for (const TouchingBodies& t : world.touching_bodies) link(world, t.a, t.b);
    for (uint32_t joint : world.movers.joints)
        link(world, world.joints.info[joint].body_a, world.joints.info[joint].body_b);
    for (uint32_t slot : world.movers.bodies) {
        const BodyInfo& info = world.bodies.info[slot];
        if (info.type != BodyType::dynamic) continue;
        float& shortest = still[root(parent, slot)];
        shortest = minimum(shortest, info.still_time);
    }
}

bool rests(WorldData& world, uint32_t slot) {
    return world.island_still[root(world.island_parent, slot)] >= sleep_time;
}

// Wakes the groups of sleepers that are touched by what does not rest; false where there are none. Their contacts then
// are among those of the step.
bool wake_touched(WorldData& world) {
    const int points = world.resting.points;
    const float penetration = deepest_at_rest(world);
    bool any = false;
    for (const BodyPair& p : world.touched_sleepers) {
        if (!world.bodies.info[p.b].asleep) continue;
        if (world.bodies.info[p.a].type == BodyType::dynamic && rests(world, p.a)) continue;
        wake_island(world, p.b);
        any = true;
    }
    if (!any) return false;
    settle_movers(world);
    world.pairs.merge();
    list_contacts(world);
    world.awake_points += points - world.resting.points;
    world.awake_penetration = maximum(world.awake_penetration, penetration);
    return true;
}

void lay_to_rest(WorldData& world) {
    for (uint32_t slot : world.movers.bodies) {
        BodyInfo& info = world.bodies.info[slot];
        if (info.type != BodyType::dynamic || !rests(world, slot)) continue;
        info.asleep = true;
        world.events.fallen.push_back(slot);
        info.capped = false;
        if (slot < world.island_loads.size()) {
            IslandLoad& load = world.island_loads[slot];
            load.slept = load.step == world.steps;
        }
        BodyMomenta& m = world.bodies.momenta[slot];  // where it is stays as it was found
        m = {{}, {}, {}, m.x_low, m.turn_low};
        world.bodies.change[slot] = {};
        world.movers.leaving = true;  // once this step is over
    }
}

}  // namespace

void wake_body(WorldData& world, uint32_t slot) {
    BodyInfo& info = world.bodies.info[slot];
    if (info.type == BodyType::fixed) return;
    note_woken(world, slot);
    info.asleep = false;
    info.still_time = 0.0f;
    if (slot < world.island_loads.size() && world.island_loads[slot].slept) {
        // It goes on from what it slept with, if it is in contact at once.
        world.island_loads[slot].slept = false;
        world.island_loads[slot].step = world.steps;
    }
    add_mover(world, slot);
}

void wake_touching(WorldData& world, uint32_t slot) {
    for_each_touching(world, slot, [&](uint32_t body) { wake_sleeper(world, body); });
}

void update_islands(WorldData& world, float dt) {
    if (!world.config.allow_sleep) return;
    count_slow_time(world, dt);
    form_islands(world);
    while (wake_touched(world)) form_islands(world);
    lay_to_rest(world);
}

}  // namespace lendulet
