// Stage 5: which place each awake body has in the solver's arrays, by class of substeps and then in order of slots, and
// how these places divide the contacts among tiles and workers.
#include "world/world_data.h"

namespace lendulet {

void place_bodies(WorldData& world, float dt) {
    constexpr int classes = solver_parts + 1;
    BodyStore& bodies = world.bodies;
    // Each class begins a tile of its own.
    int counts[classes] = {};
    world.has_packed_kinematic = false;
    for (uint32_t slot : world.movers.bodies) {
        BodyInfo& info = bodies.info[slot];
        const BodyMomenta& m = bodies.momenta[slot];
        const bool dynamic = info.type == BodyType::dynamic;
        const bool packed = dynamic
                                ? !info.asleep
                                : info.type == BodyType::kinematic && length_squared(m.p) + length_squared(m.L) > 0.0f;
        world.has_packed_kinematic |= packed && !dynamic;
        info.solver_index = packed ? -1 - part_for(world, slot, dt) : static_body;
        if (packed) ++counts[-1 - info.solver_index];
    }
    int firsts[classes], place = reserved_bodies, awake = 0;
    auto range_of = [&](int c) -> BodyRange& { return c == alone_part ? world.alone : world.parts[c].bodies; };
    for (int c = 0; c < classes; ++c) {
        const TilePlaces places(place, counts[c]);
        range_of(c) = {place, places.end()};
        if (c != alone_part) world.parts[c].body_count = counts[c];
        place = places.end();
        firsts[c] = awake;
        awake += counts[c];
    }
    world.hard_bodies = awake - counts[0] - counts[flow_part] - counts[alone_part];
    world.flowing_bodies = counts[flow_part];
    world.solver_bodies.reset(place - reserved_bodies);
    world.awake.resize_unset(static_cast<size_t>(awake));
    for (uint32_t slot : world.movers.bodies) {
        const int32_t index = bodies.info[slot].solver_index;
        if (index < 0) world.awake[static_cast<size_t>(firsts[-1 - index]++)] = slot;
    }
    const uint32_t* next = world.awake.data();
    for (int c = 0; c < classes; ++c) {
        TilePlaces places(range_of(c).begin, counts[c]);
        for (int i = 0; i < counts[c]; ++i) bodies.info[*next++].solver_index = places.take();
        places.for_each_empty([&](int i) { world.solver_bodies.set_at_rest(i); });
    }
}

// Where there are long loops over contacts that tiles do not hold together, a worker gets those of his part of the
// bodies: bodies are dealt out to workers in this order in every other loop of a step too.
void cut_contacts(WorldData& world) {
    for (SolverPart& part : world.parts) {
        const Tiles tiles(part.bodies);
        const bool within = lie_within(tiles, world.active_ends.data() + part.first_contact, part.row_count);
        part.cut = {within ? tiles : Tiles{}, {0, 0}};
        if (part.cut.tiles.count == 1 && world.tasks.sharing() > 1) part.cut.near = part.bodies;
    }
}

}  // namespace lendulet
