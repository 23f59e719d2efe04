// Rolling and spinning friction, tangential restitution and running surfaces of this step's contacts. Few worlds have
// any, and those that have none spend nothing on it.
#include "world/world_data.h"

namespace lendulet {
namespace {

// How fast a collider's surface runs, world axes, m/s.
Vec3 running_of(const WorldData& world, uint32_t collider, const Surface& surface) {
    if (!surface.runs()) return {};
    const Quat turn = world.bodies.user_pose(world.colliders.info[collider].body).orientation;
    return rotate(turn, rotate(world.colliders.given[collider].rotation, surface.velocity));
}

// `h`: the substep that the contact is solved with, s. Impulses are those of the step before, or none.
void pack_extra(WorldData& world, uint32_t record, float h) {
    ContactRecord& r = world.records[record];
    const ColliderPair& p = world.pairs.pairs[r.pair];
    const ColliderStore& c = world.colliders;
    const Surface &a = c.surface_at(p.a, r.triangle), &b = c.surface_at(p.b, r.triangle);
    const ExtraSurface s = combine_extra(a, b);
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
    const bool runs = a.runs() || b.runs();
    Vec3 running{};
    if (runs) {
        const Vec3 n{r.normal[0], r.normal[1], r.normal[2]},
            difference = running_of(world, p.b, b) - running_of(world, p.a, a);
        running = (r.flags & contact_flipped) != 0 ? -difference : difference;
        running = running - dot(running, n) * n;
    }
    e.running[0] = running.x, e.running[1] = running.y, e.running[2] = running.z;
    r.flags &= ~contact_rolls;
    if (e.rolling > 0.0f || e.spinning > 0.0f || runs) r.flags |= contact_rolls;
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
