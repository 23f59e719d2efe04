// From a saved state that was checked to the world.
#include "world/narrow/manifold_records.h"
#include "world/snapshot/saved_state.h"
#include "world/validate.h"

namespace lendulet {
namespace {

// Who is alive, in the order in which they were added.
void apply_slots(WorldData& world, const SavedState& state) {
    Array<uint32_t> bodies(&world.memory), colliders(&world.memory), joints(&world.memory);
    for (const SavedBody& b : state.bodies) {
        bodies.push_back(b.id.slot);
        for (uint32_t c = world.bodies.info[b.id.slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
            colliders.push_back(c);
    }
    for (const SavedJoint& j : state.joints) joints.push_back(j.id.slot);
    world.bodies.slots.set_alive(bodies, state.body_slots.free_list, state.body_slots.capacity);
    world.colliders.slots.set_alive(colliders, state.collider_slots.free_list, state.collider_slots.capacity);
    world.joints.slots.set_alive(joints, state.joint_slots.free_list, state.joint_slots.capacity);
    world.joints.hang_all();
}

// A body that was altered before the snapshot or since, after its type.
void apply_alteration(WorldData& world, uint32_t slot, const SavedBody& b) {
    BodyStore& bodies = world.bodies;
    if (!b.altered && !bodies.info[slot].altered) return;
    if (b.fixed) bodies.alter_pose(slot, b.altered ? b.pose : bodies.first_pose[slot]);
    else bodies.alter_mass(slot, b.altered ? b.mass : BodyMass(bodies.first_mass[slot]));
    bodies.info[slot].altered = b.altered;
    if (!b.fixed) return;
    world.continuous.colliders_changed = true;
    for (uint32_t c = bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
        world.query_scene.changed(c);
}

// `drags`: what holds its damping and gravity factor.
void apply_body(WorldData& world, uint32_t slot, const SavedBody& b, const SavedBody& drags) {
    BodyInfo& info = world.bodies.info[slot];
    const BodyType type = b.kinematic ? BodyType::kinematic : BodyType::dynamic;
    if (type != info.type) set_body_type(world, slot, type);
    apply_alteration(world, slot, b);
    world.bodies.pose[slot] = b.pose;
    world.bodies.momenta[slot] = b.momenta;
    world.bodies.change[slot] = b.change;
    world.bodies.forces[slot] = b.forces;
    info.still_time = b.still_time;
    info.bullet = b.bullet, info.allow_sleep = b.allow_sleep;
    info.linear_damping = drags.linear_damping, info.angular_damping = drags.angular_damping;
    info.gravity_factor = drags.gravity_factor;
    info.woken = b.woken;
    if (b.woken) world.events.woken.push_back(slot);
    info.asleep = b.asleep, info.has_forces = b.has_forces;
    info.capped = b.capped, info.contained = b.contained, info.stopped = b.stopped;
    IslandLoad load{};
    load.step = b.loaded ? world.steps : 0;
    load.substeps = b.substeps, load.calm = b.calm;
    if (b.waited > SavedBody::pressed) load.pressed = static_cast<uint8_t>(b.waited - SavedBody::pressed);
    else load.waited = b.waited;
    load.slept = b.loaded && b.asleep;
    world.island_loads[slot] = load;
}

void apply_bodies(WorldData& world, const SavedState& state) {
    world.island_loads.resize(world.bodies.slots.capacity());
    world.frames.resize(world.colliders.slots.capacity());
    world.at_rest.resize(world.frames.size());
    Movers& movers = world.movers;
    movers.bodies.clear();
    Array<uint32_t> colliders(&world.memory);
    size_t next = 0;
    const SavedBody usual;
    const SavedBody* drags = &usual;
    for (uint32_t slot : world.bodies.slots.order()) {
        const SavedBody& saved = state.bodies[next++];
        BodyInfo& info = world.bodies.info[slot];
        info.placed_at = static_cast<uint32_t>(world.steps) - (saved.placed ? 0u : 1u);
        info.mover_place = saved.mover ? static_cast<uint32_t>(movers.bodies.size()) : no_slot;
        if (saved.mover) movers.bodies.push_back(slot);
        else info.solver_index = static_body;
        if (!saved.fixed && !saved.drags_alike) drags = &saved;
        if (saved.fixed) apply_alteration(world, slot, saved);
        else apply_body(world, slot, saved, *drags);
        for (uint32_t c = info.first_collider; c != no_slot; c = world.colliders.info[c].next) {
            world.at_rest[c] = saved.mover ? 0 : 1;
            colliders.push_back(c);
        }
    }
    set_frames(world, colliders);  // what sleeps has not moved since the step before: its frames are where it is
    movers.leaving = movers.joints_changed = true;  // to be listed anew
}

// After bodies, before pairs are made.
void apply_colliders(WorldData& world, const SavedState& state) {
    size_t next = 0;
    uint32_t left = state.alike.empty() ? 0 : state.alike[0];
    for (uint32_t slot : world.bodies.slots.order())
        for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next) {
            while (left == 0) left = state.alike[++next];
            --left;
            const SavedCollider& saved = state.colliders[next];
            if (!alike(world.colliders.info[c].filter, saved.filter)) world.query_scene.changed(c);
            world.colliders.info[c].filter = saved.filter;
            set_collider_material(world, c, saved.material);
            set_asks(world, c, saved.events);
        }
}

// The broad phase is to find all pairs anew, among the same boxes.
void apply_boxes(WorldData& world, const SavedState& state) {
    world.moving_boxes.clear();
    world.moving_boxes.append(state.boxes.data(), state.boxes.size());
    world.box_place.assign(world.frames.size(), no_box);
    for (size_t i = 0; i < state.boxes.size(); ++i) world.box_place[state.boxes[i].index] = static_cast<uint32_t>(i);
    for (Array<uint32_t>* list : {&world.changed_boxes, &world.forgotten}) list->clear();
    world.rejoined.clear(), world.refiltered.clear();
    world.fixed_changed = world.all_pairs_sought = true;
}

void apply_joints(WorldData& world, const SavedState& state) {
    forget_joint_records(world);
    world.joint_groups_changed = true;
    size_t next = 0;
    for (uint32_t slot : world.joints.slots.order()) {
        const SavedJoint& joint = state.joints[next++];
        world.joints.info[slot].limit = joint.limit;
        world.joints.info[slot].twist_limit = joint.twist_limit;
        world.joints.info[slot].swing_limit = joint.swing_limit;
        world.joints.info[slot].motor = joint.motor;
        world.joints.info[slot].spring = joint.spring;
        world.joints.info[slot].friction = joint.friction;
        world.joints.impulses[slot] = joint.impulses;
        if (world.joints.info[slot].axes < 0) continue;
        JointAxesInfo& axes = world.joints.axes[static_cast<size_t>(world.joints.info[slot].axes)];
        for (int i = 0; i < joint_coordinates; ++i) {
            axes.row[i].limit = joint.axes.row[i].limit;
            axes.row[i].motor = joint.axes.row[i].motor;
            axes.row[i].spring = joint.axes.row[i].spring;
            axes.row[i].friction = joint.axes.row[i].friction;
            axes.limit[i] = joint.axes.limit[i];
            axes.motor[i] = joint.axes.motor[i];
            axes.spring[i] = joint.axes.spring[i];
        }
    }
}

void restore_extra(WorldData& world, uint32_t record, const SavedContact& saved) {
    world.extras.resize(world.records.size(), ContactExtra{});
    ContactExtra& e = world.extras[record];
    ContactRecord& r = world.records[record];
    e = saved.extra;
    e.pair = r.pair, e.key = r.key;
    e.step = static_cast<uint32_t>(world.steps) - (saved.fresh ? 0u : 1u);
    r.flags |= contact_rolls;
}

void apply_pair(WorldData& world, const SavedPair& saved, const SavedContact* contacts) {
    const uint32_t number = begin_pair(world, {saved.a, saved.b});
    ColliderPair& p = world.pairs.pairs[number];
    world.records.resize(world.pairs.record_count(), ContactRecord{});
    world.found_separations.resize(world.pairs.record_count(), FoundSeparations{});
    world.pairs.caches[number] = saved.cache;
    if (saved.kept) world.pairs.poses[number] = saved.pose;
    p.count = p.prepared = saved.contacts;
    p.hit = saved.hit, p.begun = saved.begun, p.touches = saved.touches;
    for (uint32_t k = 0; k < p.count; ++k) {
        ContactRecord& r = world.records[p.first_record + k];
        r = contacts[k].record;
        prepare_record(world, p, r);
        if (contacts[k].covered) r.flags |= contact_covered, p.covered = true;
        set_surface(world, p, r);
        r.pair = number;
        world.found_separations[p.first_record + k] = contacts[k].found;
        if (contacts[k].rolls) restore_extra(world, p.first_record + k, contacts[k]);
    }
}

void apply_pairs(WorldData& world, const SavedState& state) {
    world.pairs.clear();
    world.records.clear();
    world.eased.clear();
    world.found_separations.clear();
    RestingContacts& rest = world.resting;
    for (Array<uint32_t>* list : {&rest.records, &rest.hits}) list->clear();
    rest.points = 0, rest.penetration = 0.0f;
    rest.penetration_stale = false, rest.hits_changed = true;
    const SavedContact* contacts = state.contacts.data();
    for (const SavedPair& saved : state.pairs) {  // they get the numbers 0, 1, 2 ...
        apply_pair(world, saved, contacts);
        contacts += saved.contacts;
    }
    rest.place.resize_unset(world.records.size());
    world.pairs.merge();
    auto saved_of = [&](uint32_t number) -> const SavedPair& { return state.pairs[number]; };
    auto number_of = [&](const ColliderPair& p) { return static_cast<uint32_t>(&p - world.pairs.pairs.data()); };
    world.pairs.sweep([&](const ColliderPair& p) { return !saved_of(number_of(p)).listed; },
                      [&](uint32_t number) {
                          rest_pair(world, number);
                          world.pairs.pairs[number].rest_h = saved_of(number).rest_h;
                      });
    world.pairs_to_rest = true;
    list_contacts(world);
}

// Bodies that woke since the last step: they stand behind the others, and their pairs rest until the next one begins.
void set_apart_woken(WorldData& world) {
    Movers& m = world.movers;
    auto has_just_woken = [&](uint32_t slot) {
        bool has = false;
        for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
            world.pairs.for_each_of(c, [&](uint32_t number) { has |= !world.pairs.pairs[number].listed; });
        return has;
    };
    m.merged.clear();
    m.sorted = 0;
    for (uint32_t slot : m.bodies) {
        if (has_just_woken(slot)) m.merged.push_back(slot);
        else m.bodies[m.sorted++] = slot;
    }
    for (size_t i = 0; i < m.merged.size(); ++i) m.bodies[m.sorted + i] = m.merged[i];
    for (size_t i = 0; i < m.bodies.size(); ++i) world.bodies.info[m.bodies[i]].mover_place = static_cast<uint32_t>(i);
}

void apply_events(WorldData& world, const SavedState& state) {
    EventData& e = world.events;
    clear_events(e);
    e.ended.clear(), e.pending.clear();
    struct WithWorld {
        const WorldData& world;
        void operator()(BodyId& id) const { id.generation = world.bodies.slots.generation_after(id.generation); }
        void operator()(ColliderId& id) const { id.generation = world.colliders.slots.generation_after(id.generation); }
    };
    for (EndedTouch touch : state.ended) {
        for_each_handle(touch.pair, WithWorld{world});
        e.ended.push_back(touch);
    }
    for (ContactHit hit : state.pending) {
        for_each_handle(hit, WithWorld{world});
        e.pending.push_back(hit);
    }
}

}  // namespace

void apply(WorldData& world, const SavedState& state) {
    apply_slots(world, state);
    world.config.gravity = state.gravity;
    world.last_h = world.joints_h = state.last_h;
    world.time = state.time;
    world.steps = state.steps;
    world.events.woken.clear(), world.events.fallen.clear();
    apply_bodies(world, state);
    apply_colliders(world, state);
    apply_boxes(world, state);
    apply_joints(world, state);
    apply_pairs(world, state);
    set_apart_woken(world);
    apply_events(world, state);
    world.query_scene.all_moved();
}

}  // namespace lendulet
