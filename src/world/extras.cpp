// Rolling and spinning friction and tangential restitution of this step's contacts. Few worlds have any, and those that
// have none spend nothing on it.
#include "world/world_data.h"

namespace lendulet {
namespace {

// `h`: the substep that the contact is solved with, s. Impulses are those of the step before, or none.
void pack_extra(WorldData& world, uint32_t record, float h) {
    ContactRecord& r = world.records[record];
    const ColliderPair& p = world.pairs.pairs[r.pair];
    const ColliderStore& c = world.colliders;
    const ExtraSurface s = combine_extra(c.surface_at(p.a, r.triangle), c.surface_at(p.b, r.triangle));
    ContactExtra& e = world.extras[record];
    const uint32_t step = static_cast<uint32_t>(world.steps);
    const bool same =
        e.pair == r.pair && e.key == r.key && e.step == step && e.h > 0.0f && (r.flags & contact_passes) == 0;
    const float scale = same ? h / e.h : 0.0f;
    for (float& x : e.impulse) x = scale > 0.0f ? scale * x : 0.0f;
    e.rolling = s.rolling_friction;
    e.spinning = s.spinning_friction;
    e.tangential_restitution = s.tangential_restitution;
    e.h = h;
    e.pair = r.pair;
    e.key = r.key;
    e.step = step + 1;
    r.flags &= ~contact_rolls;
    if (e.rolling > 0.0f || e.spinning > 0.0f) r.flags |= contact_rolls;
}

}  // namespace

void pack_extras(WorldData& world, float dt) {
    if (!world.has_extras) return;
    world.extras.resize(world.records.size(), ContactExtra{});
    for (int c = 0; c < solver_parts; ++c) {
        const SolverPart& part = world.parts[c];
        const float h = dt / (substep_multiple(c) * static_cast<float>(world.config.solver_steps));
        const uint32_t* list = world.active.data() + part.first_contact;
        ContactEnds* ends = world.active_ends.data() + part.first_contact;
        world.tasks.for_each(part.contact_count, 256, [&](int begin, int end, int) {
            for (int i = begin; i < end; ++i) {
                pack_extra(world, list[i], h);
                ends[i].kind = contact_kind(world.records[list[i]]);
            }
        });
    }
}

}  // namespace lendulet
