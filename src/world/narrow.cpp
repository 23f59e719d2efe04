// Stages 2 and 3: which colliders may touch, and where they do.
#include "collision/narrow_phase.h"

#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int pairs_per_task = 32;
// Two points of one manifold are the same from step to step where their names agree, or else where they lie this close,
// in units of the smaller shape's radius.
constexpr float same_point_distance = 0.05f;

bool moved_by_constraints(const BodyInfo& info) { return info.type == BodyType::dynamic; }

bool wanted(const WorldData& world, const BoxPair& p) {
    const ColliderInfo& a = world.colliders.info[p.a];
    const ColliderInfo& b = world.colliders.info[p.b];
    if (a.body == b.body || !filters_match(a.filter, b.filter)) return false;
    if (a.is_trigger && b.is_trigger) return false;
    const BodyInfo& ba = world.bodies.info[a.body];
    const BodyInfo& bb = world.bodies.info[b.body];
    if (!moved_by_constraints(ba) && !moved_by_constraints(bb) && !a.is_trigger && !b.is_trigger) return false;
    return !world.joints.keeps_apart(a.body, b.body);
}

// How far the two shapes may come closer within the step, and a little more.
float pair_margin(const WorldData& world, const ColliderPair& p, float dt) {
    const ColliderInfo& a = world.colliders.info[p.a];
    const ColliderInfo& b = world.colliders.info[p.b];
    const BodyStore& bodies = world.bodies;
    float near = minimum(contact_margin, 0.25f * minimum(a.radius, b.radius));
    float speed = length(bodies.velocity(b.body) - bodies.velocity(a.body));
    auto turning = [&](const ColliderInfo& c, uint32_t slot) {
        if (bodies.info[c.body].type == BodyType::fixed) return 0.0f;
        float reach = length(world.colliders.place[slot].arm) + c.radius;
        return minimum(dt * length(bodies.angular_velocity(c.body)), 2.0f) * reach;
    };
    float fall = 0.5f * dt * dt * length(world.config.gravity);
    return near + dt * speed + fall + turning(a, p.a) + turning(b, p.b);
}

void fill_point(ContactRecord& r, int j, const ManifoldPoint& p, Vec3 arm_a) {
    Vec3 x = arm_a + p.position;
    r.points[j] = {{x.x, x.y, x.z}, p.separation};
    r.id[j] = p.id;
}

// Impulses of the points that were there in the step before.
void warm_start(ContactRecord& r, const ContactRecord& old, float tolerance, float scale) {
    bool used[4] = {};
    auto take = [&](int j, int i) {
        used[i] = true;
        r.normal_impulse[j] = scale * old.normal_impulse[i];
    };
    bool found[4] = {};
    for (int j = 0; j < r.point_count; ++j)
        for (int i = 0; i < old.point_count && !found[j]; ++i)
            if (!used[i] && old.id[i] == r.id[j]) take(j, i), found[j] = true;
    for (int j = 0; j < r.point_count; ++j) {
        if (found[j]) continue;
        int best = -1;
        float nearest = tolerance * tolerance;
        for (int i = 0; i < old.point_count; ++i) {
            const float *p = r.points[j].position, *q = old.points[i].position;
            float d = length_squared(Vec3{p[0], p[1], p[2]} - Vec3{q[0], q[1], q[2]});
            if (!used[i] && d < nearest) nearest = d, best = i;
        }
        if (best >= 0) take(j, best);
    }
    for (int k = 0; k < 3; ++k) r.friction_impulse[k] = scale * old.friction_impulse[k];
    r.twist_impulse = scale * old.twist_impulse;
}

struct PairSides {
    uint32_t collider_a, collider_b;  // A is the one that constraints do not move, where there is one
    bool flipped;
};

PairSides sides(const WorldData& world, const ColliderPair& p) {
    bool flip = !moved_by_constraints(world.bodies.info[world.colliders.info[p.b].body]);
    return flip ? PairSides{p.b, p.a, true} : PairSides{p.a, p.b, false};
}

CollidePair collide_input(const WorldData& world, const PairSides& s, float margin) {
    const ColliderStore& c = world.colliders;
    const ColliderPlace &pa = c.place[s.collider_a], &pb = c.place[s.collider_b];
    Vec3 centres =
        world.bodies.pose[c.info[s.collider_b].body].position - world.bodies.pose[c.info[s.collider_a].body].position;
    return {&c.geometry[s.collider_a],
            &c.geometry[s.collider_b],
            pa.rotation,
            pb.rotation,
            centres + (pb.arm - pa.arm),
            margin};
}

void fill_record(const WorldData& world, const PairSides& s, const Manifold& m, uint32_t pair, ContactRecord& r) {
    const ColliderStore& c = world.colliders;
    uint32_t body_a = c.info[s.collider_a].body, body_b = c.info[s.collider_b].body;
    ContactSurface surface = combine(c.surface[s.collider_a], c.surface[s.collider_b]);
    Vec3 centres = world.bodies.pose[body_b].position - world.bodies.pose[body_a].position;
    bool fixed_a = !moved_by_constraints(world.bodies.info[body_a]);
    r = ContactRecord{};
    r.normal[0] = m.normal.x, r.normal[1] = m.normal.y, r.normal[2] = m.normal.z;
    r.static_friction = surface.static_friction;
    r.dynamic_friction = surface.dynamic_friction;
    r.restitution = surface.restitution;
    r.point_count = m.count;
    for (int j = 0; j < 4; ++j) {
        if (j < m.count) fill_point(r, j, m.points[j], c.place[s.collider_a].arm);
        else r.points[j] = {{0.0f, 0.0f, 0.0f}, far_separation};
    }
    r.radius_a = m.radius_a, r.radius_b = m.radius_b, r.follow = m.follow;
    r.arm_offset[0] = centres.x, r.arm_offset[1] = centres.y, r.arm_offset[2] = centres.z;
    r.separation_speed = fixed_a ? world.config.static_separation_speed : world.config.rigid_separation_speed;
    r.key = m.key;
    r.triangle = m.triangle;
    r.flags = s.flipped ? contact_flipped : 0u;
    r.pair = pair;
}

// All manifolds of one pair; the pair's own records and cache are written, nothing else.
void collide_pair(WorldData& world, uint32_t index, uint32_t old_first, int old_count, float dt, float scale) {
    ColliderPair& p = world.pairs.now[index];
    const ColliderInfo &a = world.colliders.info[p.a], &b = world.colliders.info[p.b];
    PairSides s = sides(world, p);
    CollideSettings settings{world.config.simplex};
    PairCache& cache = world.pairs.caches[p.cache];
    p.count = 0;
    if (a.is_trigger || b.is_trigger) {
        world.trigger_hits[index] = overlap(collide_input(world, s, 0.0f), cache, settings) ? 1 : 0;
        return;
    }
    ContactRecord* out = &world.records[p.first_record];
    Manifold manifolds[max_mesh_manifolds];
    int count = collide(collide_input(world, s, pair_margin(world, p, dt)), cache, settings, manifolds, p.capacity);
    float tolerance = same_point_distance * minimum(a.radius, b.radius);
    for (int i = 0; i < count; ++i) {
        fill_record(world, s, manifolds[i], index, out[i]);
        for (int k = 0; k < old_count; ++k) {
            const ContactRecord& old = world.old_records[old_first + static_cast<uint32_t>(k)];
            if (old.key == out[i].key) {
                warm_start(out[i], old, tolerance, scale);
                break;
            }
        }
    }
    p.count = static_cast<uint16_t>(count);
}

}  // namespace

void find_box_pairs(WorldData& world) {
    world.box_pairs.clear();
    world.broad_phase.find_pairs(world.tasks, world.box_pairs);
}

void match_pairs(WorldData& world) {
    size_t kept = 0;
    for (const BoxPair& p : world.box_pairs)
        if (wanted(world, p)) world.box_pairs[kept++] = p;
    world.box_pairs.resize_unset(kept);
    world.pairs.update(world.box_pairs);
}

void find_contacts(WorldData& world, float dt) {
    PairTable& pairs = world.pairs;
    float h = dt / static_cast<float>(world.config.solver_steps);
    float scale = world.last_h > 0.0f ? h / world.last_h : 0.0f;
    world.records.swap(world.old_records);
    uint32_t total = 0;
    world.old_places.resize_unset(pairs.now.size());  // where a pair's records of the last step are
    for (size_t i = 0; i < pairs.now.size(); ++i) {
        ColliderPair& p = pairs.now[i];
        world.old_places[i] = {p.first_record, p.count};
        bool mesh = world.colliders.geometry[p.a].kind == GeometryKind::mesh ||
                    world.colliders.geometry[p.b].kind == GeometryKind::mesh;
        p.capacity = mesh ? max_mesh_manifolds : 1;
        p.first_record = total;
        total += p.capacity;
    }
    world.records.resize_unset(total);
    world.trigger_hits.assign(pairs.now.size(), 0);
    world.tasks.for_each(pairs.now.count(), pairs_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            const OldPlace& old = world.old_places[static_cast<size_t>(i)];
            collide_pair(world, static_cast<uint32_t>(i), old.first, old.count, dt, scale);
        }
    });
    world.touching.clear();
    world.overlaps.clear();
    for (size_t i = 0; i < pairs.now.size(); ++i) {
        const ColliderPair& p = pairs.now[i];
        for (uint32_t k = 0; k < p.count; ++k) world.touching.push_back(p.first_record + k);
        if (!world.trigger_hits[i]) continue;
        bool first_is_trigger = world.colliders.info[p.a].is_trigger;
        uint32_t trigger = first_is_trigger ? p.a : p.b, other = first_is_trigger ? p.b : p.a;
        world.overlaps.push_back({world.bodies.id(world.colliders.info[trigger].body),
                                  world.bodies.id(world.colliders.info[other].body), world.colliders.id(trigger),
                                  world.colliders.id(other)});
    }
}

}  // namespace lendulet
