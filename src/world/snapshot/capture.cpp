// From a world to a saved state, and what tells worlds apart.
#include <algorithm>

#include "base/hash.h"
#include "world/snapshot/saved_state.h"

namespace lendulet {
namespace {

uint64_t mix(uint64_t h, Vec3 v) { return hash_floats(h, &v.x, 3); }
uint64_t mix(uint64_t h, const Transform& t) {
    const Quat& q = t.rotation;
    float values[4] = {q.x, q.y, q.z, q.w};
    return mix(hash_floats(h, values, 4), t.translation);
}

uint64_t mix_settings(uint64_t h, const WorldConfig& c) {
    float values[4] = {c.rigid_separation_speed, c.static_separation_speed, c.friction, c.restitution};
    h = hash_floats(h, values, 4);
    for (uint64_t word :
         {static_cast<uint64_t>(c.solver_steps), static_cast<uint64_t>(c.simplex), static_cast<uint64_t>(c.integrator),
          static_cast<uint64_t>(c.allow_sleep), static_cast<uint64_t>(c.continuous)})
        h = hash_combine(h, word);
    return h;
}

uint64_t mix_surface(uint64_t h, const Surface& s) {
    const float values[9] = {s.static_friction,  s.dynamic_friction,  s.restitution,
                             s.rolling_friction, s.spinning_friction, s.tangential_restitution,
                             s.velocity.x,       s.velocity.y,        s.velocity.z};
    return hash_floats(h, values, 9);
}

}  // namespace

uint64_t hash_body(const WorldData& world, uint32_t slot) {
    const BodyInfo& info = world.bodies.info[slot];
    const BodyMass& mass = world.bodies.mass_as_added(slot);
    uint64_t h = hash_combine(slot, world.bodies.slots.uses(slot));
    h = hash_combine(h, static_cast<uint64_t>(info.type == BodyType::fixed));
    h = hash_combine(h, static_cast<uint64_t>(info.massless));
    h = mix(hash_floats(h, &mass.mass, 1), mass.inertia);
    // Static bodies are in the snapshot only where they were moved: else they stand where they stand.
    const Pose& pose = world.bodies.pose_as_added(slot);
    if (info.type == BodyType::fixed) h = mix(h, Transform{from_origin(pose.position), pose.orientation});
    for (uint32_t c = info.first_collider; c != no_slot; c = world.colliders.info[c].next) {
        const ColliderInfo& collider = world.colliders.info[c];
        h = hash_combine(h, c);
        h = hash_combine(h, static_cast<uint64_t>(world.colliders.geometry[c].kind));
        h = hash_floats(h, &collider.radius, 1);
        h = mix(h, world.colliders.local[c]);
        h = mix(h, world.colliders.geometry[c].size);
        for (const Surface& s : world.colliders.materials[c]) h = mix_surface(h, s);
    }
    return h;
}

uint64_t hash_joint(const WorldData& world, uint32_t slot) {
    const JointInfo& joint = world.joints.info[slot];
    uint64_t h = hash_combine(slot, world.joints.slots.uses(slot));
    for (uint64_t word : {static_cast<uint64_t>(joint.type), uint64_t{joint.body_a}, uint64_t{joint.body_b}})
        h = hash_combine(h, word);
    h = hash_combine(h, static_cast<uint64_t>(joint.axes >= 0));
    const float breaks[2] = {joint.break_force, joint.break_torque};
    h = hash_floats(h, breaks, 2);
    return mix(mix(h, joint.frame_a), joint.frame_b);
}

namespace {

void capture_slots(const Slots& slots, SavedSlots& saved) {
    saved.count = static_cast<uint32_t>(slots.count());
    saved.capacity = static_cast<uint32_t>(slots.capacity());
    // Free ones that come last, in their order, might as well not have been made yet: states that are equal but for the
    // past give equal bytes.
    const Array<uint32_t>& free = slots.free_list();
    size_t first = 0;
    while (first < free.size() && free[first] + 1 == saved.capacity) ++first, --saved.capacity;
    saved.free_list.append(free.data() + first, free.size() - first);
}

// `before`: what was captured of the last body.
SavedBody capture_body(const WorldData& world, uint32_t slot, const SavedBody& before) {
    const BodyInfo& info = world.bodies.info[slot];
    SavedBody b;
    b.id = world.bodies.slots.use(slot);
    b.kinematic = info.type == BodyType::kinematic;
    b.bullet = info.bullet, b.allow_sleep = info.allow_sleep;
    b.linear_damping = info.linear_damping, b.angular_damping = info.angular_damping;
    b.gravity_factor = info.gravity_factor;
    b.drags_alike = b.linear_damping == before.linear_damping && b.angular_damping == before.angular_damping &&
                    b.gravity_factor == before.gravity_factor;
    b.fixed = info.type == BodyType::fixed;
    b.altered = info.altered;
    if (b.altered && !b.fixed) b.mass = world.bodies.mass_as_dynamic(slot);
    b.pose = world.bodies.pose[slot];
    b.momenta = world.bodies.momenta[slot];
    b.change = world.bodies.change[slot];
    b.forces = world.bodies.forces[slot];
    b.still_time = info.still_time;
    b.asleep = info.asleep, b.has_forces = info.has_forces;
    b.placed = info.placed_at == static_cast<uint32_t>(world.steps);
    b.woken = info.woken;
    b.mover = info.mover_place != no_slot;
    b.capped = info.capped, b.contained = info.contained, b.stopped = info.stopped;
    if (slot < world.island_loads.size()) {
        const IslandLoad& load = world.island_loads[slot];
        b.loaded = (load.step == world.steps && world.steps > 0) || load.slept;
        b.substeps = load.substeps, b.calm = load.calm;
        b.waited = load.pressed > 0 ? static_cast<uint8_t>(SavedBody::pressed + load.pressed) : load.waited;
    }
    return b;
}

bool alike(const Material& x, const Material& y) {
    return x.static_friction == y.static_friction && x.dynamic_friction == y.dynamic_friction &&
           x.restitution == y.restitution && x.rolling_friction == y.rolling_friction &&
           x.spinning_friction == y.spinning_friction && x.tangential_restitution == y.tangential_restitution &&
           x.surface_velocity == y.surface_velocity && x.friction_combine == y.friction_combine &&
           x.restitution_combine == y.restitution_combine;
}
bool alike(const SavedCollider& x, const SavedCollider& y) {
    return alike(x.filter, y.filter) && x.events == y.events && alike(x.material, y.material);
}

void capture_collider(const WorldData& world, uint32_t slot, SavedState& state) {
    const ColliderInfo& info = world.colliders.info[slot];
    const SavedCollider c{info.filter, world.colliders.material[slot], info.events};
    if (!state.colliders.empty() && alike(state.colliders.back(), c)) {
        ++state.alike.back();
        return;
    }
    state.colliders.push_back(c);
    state.alike.push_back(1u);
}

void capture_pair(const WorldData& world, uint32_t number, SavedState& state) {
    const ColliderPair& p = world.pairs.pairs[number];
    SavedPair s;
    s.a = p.a, s.b = p.b;
    s.contacts = p.count;
    s.hit = p.hit, s.begun = p.begun, s.touches = p.touches;
    s.listed = p.listed, s.rest_h = p.rest_h;
    s.cache = world.pairs.caches[number];
    s.pose = world.pairs.poses[number];
    s.kept = s.pose.clearance != unkept;
    state.pairs.push_back(s);
    const bool found = has_found_separations(p);  // those of others were never written
    for (uint32_t i = p.first_record; i < p.first_record + p.count; ++i) {
        SavedContact c{world.records[i], found ? world.found_separations[i] : FoundSeparations{}};
        c.rolls = (c.record.flags & contact_rolls) != 0;
        c.covered = (c.record.flags & contact_covered) != 0;
        if (c.rolls) c.extra = world.extras[i], c.fresh = c.extra.step == static_cast<uint32_t>(world.steps);
        state.contacts.push_back(c);
    }
}

// In the order of colliders, whether listed or not.
void capture_pairs(const WorldData& world, SavedState& state) {
    const Array<ColliderPair>& pairs = world.pairs.pairs;
    std::vector<uint32_t> numbers;
    for (size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].a != no_pair) numbers.push_back(static_cast<uint32_t>(i));
    std::sort(numbers.begin(), numbers.end(), [&](uint32_t x, uint32_t y) {  // order: total
        return pairs[x].a != pairs[y].a ? pairs[x].a < pairs[y].a : pairs[x].b < pairs[y].b;
    });
    for (uint32_t number : numbers) capture_pair(world, number, state);
}

constexpr auto without_world = [](auto& id) { id.generation = Slots::uses_of(id.generation); };

}  // namespace

uint64_t fingerprint(const WorldData& world, const SavedState& state, const Returning& returning) {
    uint64_t h = mix_settings(0, world.config);
    for (size_t i = 0; i < state.bodies.size(); ++i) {
        const uint32_t gone = returning.body(i);
        h = hash_combine(
            h, gone != no_slot ? world.removed.of_body[gone].hash : hash_body(world, state.bodies[i].id.slot));
    }
    for (size_t i = 0; i < state.joints.size(); ++i) {
        const uint32_t gone = returning.joint(i);
        h = hash_combine(
            h, gone != no_slot ? world.removed.of_joint[gone].hash : hash_joint(world, state.joints[i].id.slot));
    }
    return h;
}

void capture(const WorldData& world, SavedState& state) {
    capture_slots(world.bodies.slots, state.body_slots);
    capture_slots(world.colliders.slots, state.collider_slots);
    capture_slots(world.joints.slots, state.joint_slots);
    state.gravity = world.config.gravity;
    state.last_h = world.last_h;
    state.time = world.time;
    state.steps = world.steps;
    SavedBody before;
    for (uint32_t slot : world.bodies.slots.order()) {
        state.bodies.push_back(capture_body(world, slot, before));
        if (!state.bodies.back().fixed) before = state.bodies.back();
        for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
            capture_collider(world, c, state);
    }
    for (uint32_t slot : world.joints.slots.order()) {
        const JointInfo& j = world.joints.info[slot];
        const bool has_axes = j.axes >= 0;
        state.joints.push_back({world.joints.slots.use(slot), false, j.limit, j.twist_limit, j.swing_limit, j.motor,
                                j.spring, j.friction, joint_impulses(world, slot), has_axes,
                                has_axes ? joint_axes_impulses(world, slot) : JointAxesInfo{}});
    }
    state.fingerprint = fingerprint(world, state, {});
    state.boxes.append(world.moving_boxes.data(), world.moving_boxes.size());
    capture_pairs(world, state);
    for (EndedTouch e : world.events.ended) {
        for_each_handle(e.pair, without_world);
        state.ended.push_back(e);
    }
    for (ContactHit hit : world.events.pending) {
        for_each_handle(hit, without_world);
        state.pending.push_back(hit);
    }
}

std::vector<uint8_t> World::snapshot() const {
    SavedState state;
    capture(data(), state);
    return encode(state);
}

}  // namespace lendulet
