// A second world in the state of a first: its stores are copied, the rest comes as from a snapshot.
#include "world/snapshot/saved_state.h"

namespace lendulet {
namespace {

void fill_defaults(WorldData& world, const WorldConfig& before) {
    const WorldConfig& now = world.config;
    if (now.friction == before.friction && now.restitution == before.restitution) return;
    for (size_t slot = 0; slot < world.colliders.slots.capacity(); ++slot) {
        ColliderStore& c = world.colliders;
        c.surface[slot] = with_defaults(c.material[slot], now.friction, now.restitution);
        for (size_t i = 0; i < c.materials[slot].size(); ++i)
            c.materials[slot][i] = with_defaults(c.table[slot][i], now.friction, now.restitution);
    }
}

}  // namespace

Result<World> World::fork() const { return fork(config()); }

Result<World> World::fork(const WorldConfig& settings) const {
    const WorldData& from = data();
    if (from.in_step) return Error{ErrorCode::locked, "fork: called from inside a step"};
    Result<World> built = WorldBuilder(settings).build();
    if (!built) return built.error();
    WorldData& to = built.value().data();
    to.bodies.copy(from.bodies);
    to.colliders.copy(from.colliders);
    to.joints.copy(from.joints);
    to.removed.copy(from.removed);
    forget_oldest(to);
    to.has_extras = from.has_extras;
    for (uint32_t c : to.colliders.slots.order()) set_asks(to, c, to.colliders.info[c].events);
    fill_defaults(to, from.config);
    SavedState state;
    capture(from, state);
    apply(to, state);
    for (uint32_t slot : to.bodies.slots.order())
        for (uint32_t c = to.bodies.info[slot].first_collider; c != no_slot; c = to.colliders.info[c].next)
            to.query_scene.changed(c);
    to.statistics = from.statistics;
    to.warnings = from.warnings;
    if (settings.gravity != from.config.gravity || settings.allow_sleep != from.config.allow_sleep)
        if (Status s = built.value().set_gravity(settings.gravity); !s) return s.error();
    return built;
}

}  // namespace lendulet
