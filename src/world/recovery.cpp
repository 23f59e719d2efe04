// Recovery from deep overlaps. A contact undoes overlap at the separation speed that is set, which is a speed for two
// bodies: one that nine others push at once would leave at a multiple of it. Where a body has more than four contacts
// so deep that they push at that speed, each of them gets its share, so that the body keeps to about the speed that is
// set.
#include "base/hash.h"
#include "base/prefetch.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr float least_share = 0.4f;  // of a thousand at one point too: they shall come apart
constexpr int most_full = 4;         // contacts that may push with all of it: their directions differ

float separation_speed(const WorldData& world, const ContactRecord& r) {
    return world.pairs.pairs[r.pair].fixed_a ? world.config.static_separation_speed
                                             : world.config.rigid_separation_speed;
}

bool is_deep(const ContactRecord& r, float speed, float h) {
    float deepest = 0.0f;
    for (int j = 0; j < r.point_count; ++j) deepest = minimum(deepest, r.points[j].separation);
    return contact_bias * deepest < -speed * h;
}

// Balls whose centres coincide lie apart in no direction: without one of its own for each pair all would be pushed out
// along one line.
void choose_normal(const WorldData& world, ContactRecord& r) {
    const Vec3 apart{r.arm_offset[0], r.arm_offset[1], r.arm_offset[2]};
    const float size = r.radius_a + r.radius_b;
    if (r.point_count != 1 || !(length_squared(apart) < 1e-10f * size * size)) return;
    const ColliderPair& p = world.pairs.pairs[r.pair];
    uint64_t h = hash_combine(hash_combine(0, p.a), p.b);
    auto next = [&] {
        float x = static_cast<float>(h & 1023u) - 511.5f;
        h >>= 10;
        return x;
    };
    const float x = next(), y = next(), z = next();
    const Vec3 n = normalize(Vec3{x, y, z});
    r.normal[0] = n.x, r.normal[1] = n.y, r.normal[2] = n.z;
}

}  // namespace

void limit_recovery(WorldData& world, float dt) {
    for (uint32_t i : world.eased) world.records[i].separation_speed = separation_speed(world, world.records[i]);
    world.eased.clear();
    const float h = dt / static_cast<float>(world.config.solver_steps);
    const float least = minimum(world.config.rigid_separation_speed, world.config.static_separation_speed);
    if (!(contact_bias * world.awake_penetration > least * h)) return;
    Array<uint16_t>& deep = world.deep_contacts;
    deep.assign(static_cast<size_t>(world.solver_bodies.count), uint16_t{0});
    const size_t count = world.active.size();
    for (size_t k = 0; k < count; ++k) {
        if (k + prefetch_distance < count) prefetch<2>(&world.records[world.active[k + prefetch_distance]]);
        ContactRecord& r = world.records[world.active[k]];
        if (!is_deep(r, least, h) || !is_deep(r, separation_speed(world, r), h)) continue;
        choose_normal(world, r);
        world.eased.push_back(world.active[k]);
        for (int32_t body : {r.body_a, r.body_b})
            if (deep[static_cast<size_t>(body)] < 1000) ++deep[static_cast<size_t>(body)];
    }
    for (size_t i = 0; i < reserved_bodies; ++i) deep[i] = 0;  // what cannot be moved
    for (uint32_t i : world.eased) {
        ContactRecord& r = world.records[i];
        int most = deep[static_cast<size_t>(r.body_a)], other = deep[static_cast<size_t>(r.body_b)];
        most = most > other ? most : other;
        if (most > most_full)
            r.separation_speed *= maximum(static_cast<float>(most_full) / static_cast<float>(most), least_share);
    }
}

}  // namespace lendulet
