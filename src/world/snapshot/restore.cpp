// From bytes back to a world. Everything is checked before anything is changed.
#include "world/narrow/manifold_records.h"
#include "world/snapshot/saved_state.h"
#include "world/validate.h"

namespace lendulet {
namespace {

Error bad(const char* what) { return {ErrorCode::bad_snapshot, std::string("restore: the snapshot ") + what}; }

bool is_unit(const float* v, int n) {
    float sum = 0.0f;
    for (int i = 0; i < n; ++i) sum += v[i] * v[i];
    return sum > 0.99f && sum < 1.01f;
}

// Every slot there was is either one of the oldest `count` objects' or free, once.
bool good_slots(const SavedSlots& s, const Slots& now) {
    if (s.capacity > now.capacity() || uint64_t{s.count} + s.free_list.size() != s.capacity) return false;
    std::vector<bool> seen(s.capacity, false);
    for (uint32_t i = 0; i < s.capacity; ++i) {
        uint32_t slot = i < s.count ? now.in_order(static_cast<int>(i)) : s.free_list[i - s.count];
        if (slot >= s.capacity || seen[slot]) return false;
        seen[slot] = true;
    }
    return true;
}

bool good_pose(const Pose& pose) {
    const Quat& q = pose.orientation;
    const float orientation[4] = {q.x, q.y, q.z, q.w};
    return is_finite(from_origin(pose.position)) && is_unit(orientation, 4);
}

bool good_body(const SavedBody& b) {
    return good_pose(b.pose) && is_finite(b.momenta.p) && is_finite(b.momenta.L) && is_finite(b.momenta.p_low) &&
           is_finite(b.momenta.x_low) && is_finite(b.momenta.turn_low) && is_finite(b.change.v) &&
           is_finite(b.change.L) && is_finite(b.forces.force) && is_finite(b.forces.torque) &&
           is_finite(b.still_time) && b.substeps < substep_classes;
}

bool good_contact(const SavedContact& c) {
    const ContactRecord& r = c.record;
    if (r.point_count < 1 || r.point_count > 4 || !is_unit(r.normal, 3)) return false;
    for (int j = 0; j < 4; ++j)
        if (!(r.normal_impulse[j] >= 0.0f) || !is_finite(r.normal_impulse[j])) return false;
    for (float x : c.extra.impulse)
        if (!is_finite(x)) return false;
    return is_finite(c.extra.h) && c.extra.h >= 0.0f;
}

// Of each collider of the world, by slot: the body among the snapshot's that it belongs to; null: it knows none.
std::vector<const SavedBody*> owners(const WorldData& world, const SavedState& state) {
    std::vector<const SavedBody*> owner(world.colliders.slots.capacity(), nullptr);
    for (uint32_t i = 0; i < state.body_slots.count; ++i) {
        uint32_t slot = world.bodies.slots.in_order(static_cast<int>(i));
        for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
            owner[c] = &state.bodies[i];
    }
    return owner;
}

bool good_mass(const BodyMass& m) {
    return check_mass(m.mass, "restore") && is_finite(m.inverse_mass) && can_be_inverted(m.inertia) &&
           is_finite(m.inverse_inertia) && is_finite(m.anisotropy);
}

// Static bodies never take part in steps, those awake always do.
Status check_bodies(const WorldData& world, const SavedState& state) {
    for (uint32_t i = 0; i < state.body_slots.count; ++i) {
        const SavedBody& b = state.bodies[i];
        const BodyInfo& info = world.bodies.info[world.bodies.slots.in_order(static_cast<int>(i))];
        const BodyType type = info.type;
        if (!b.fixed && info.massless && !b.kinematic) return bad("takes a body without mass for a dynamic one");
        if (b.fixed != (type == BodyType::fixed)) return bad("takes a static body for a moving one");
        bool good = b.fixed ? !b.mover : good_body(b) && (b.mover || b.asleep || b.kinematic);
        if (b.altered) good = good && (b.fixed ? good_pose(b.pose) : !info.massless && good_mass(b.mass));
        if (!good) return bad("holds a body whose state cannot be");
    }
    return {};
}

// Joints whose rows are data have motors, springs and impulses for each.
Status check_joints(const WorldData& world, const SavedState& state) {
    for (uint32_t i = 0; i < state.joint_slots.count; ++i) {
        const JointInfo& j = world.joints.info[world.joints.slots.in_order(static_cast<int>(i))];
        if (state.joints[i].has_axes != (j.axes >= 0)) return bad("holds a joint that cannot be");
    }
    return {};
}

// One entry for each collider, or for several that follow each other, with coefficients that a material may have.
Status check_colliders(const WorldData& world, const SavedState& state) {
    uint64_t known = 0;
    for (uint32_t count : state.alike) known += count;
    if (state.alike.size() != state.colliders.size() || known != state.collider_slots.count)
        return bad("holds another number of colliders than it says");
    for (uint32_t count : state.alike)
        if (count == 0) return bad("holds a collider that is none");
    for (const SavedCollider& c : state.colliders) {
        const bool rules = c.material.friction_combine <= CombineRule::multiply &&
                           c.material.restitution_combine <= CombineRule::multiply && c.events <= Events::all;
        if (!rules || !make_surface(world.config, c.material, "restore")) return bad("holds a material that cannot be");
    }
    return {};
}

// Every collider of the bodies that do not take part has its box, and none has two.
Status check_boxes(const WorldData& world, const SavedState& state) {
    std::vector<const SavedBody*> without = owners(world, state);
    for (const BroadBox& box : state.boxes) {
        bool good = box.index < without.size() && without[box.index] && !without[box.index]->fixed;
        for (int d = 0; d < 3 && good; ++d) good = box.lower[d] <= box.upper[d];
        if (!good) return bad("holds a box that cannot be");
        without[box.index] = nullptr;
    }
    for (const SavedBody* body : without)
        if (body && !body->fixed && !body->mover) return bad("lacks a box");
    return {};
}

int room_for_contacts(const WorldData& world, const SavedPair& p) {
    const ColliderStore& c = world.colliders;
    if (c.info[p.a].is_trigger || c.info[p.b].is_trigger) return 0;
    bool mesh = has_triangles(c.geometry[p.a]) || has_triangles(c.geometry[p.b]);
    return mesh ? max_mesh_manifolds : 1;
}

Status check_pairs(const WorldData& world, const SavedState& state) {
    const std::vector<const SavedBody*> owner = owners(world, state);
    size_t contacts = 0;
    const SavedPair* before = nullptr;
    for (const SavedPair& p : state.pairs) {
        bool sorted = p.a < p.b && (!before || before->a < p.a || (before->a == p.a && before->b < p.b));
        if (!sorted || p.b >= owner.size() || !owner[p.a] || !owner[p.b] || (!p.listed && !is_finite(p.rest_h)))
            return bad("holds a pair that cannot be");
        if (p.cache.gjk.face > GjkCache::unknown_face) return bad("holds a face that boxes do not have");
        if (p.cache.gjk.count > 4 || p.contacts > room_for_contacts(world, p)) return bad("holds too many contacts");
        contacts += p.contacts;
        before = &p;
    }
    if (contacts != state.contacts.size()) return bad("holds contacts of no pair");
    for (const ContactHit& h : state.pending)
        if (!is_finite(from_origin(h.position)) || !is_finite(h.normal) || !is_finite(h.speed) || !is_finite(h.impulse))
            return bad("holds a hit that cannot be");
    for (const SavedContact& c : state.contacts)
        if (!good_contact(c)) return bad("holds a contact that cannot be");
    return {};
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

Status check_saved(const WorldData& world, const SavedState& state) {
    bool slots = state.collider_slots.count <= static_cast<uint32_t>(world.colliders.slots.count()) &&
                 good_slots(state.body_slots, world.bodies.slots) &&
                 good_slots(state.collider_slots, world.colliders.slots) &&
                 good_slots(state.joint_slots, world.joints.slots);
    if (!slots) return bad("counts its bodies and joints wrongly");
    if (state.bodies.size() != state.body_slots.count || state.joints.size() != state.joint_slots.count)
        return bad("holds another number of bodies or joints than it says");
    if (!is_finite(state.gravity) || !(state.last_h >= 0.0f) || !is_finite(state.last_h) ||
        !(state.time >= 0.0 && state.time < 1e300))
        return bad("holds a time or a gravity that cannot be");
    if (Status s = check_bodies(world, state); !s) return s;
    if (Status s = check_joints(world, state); !s) return s;
    if (Status s = check_colliders(world, state); !s) return s;
    if (Status s = check_boxes(world, state); !s) return s;
    return check_pairs(world, state);
}

void apply(WorldData& world, const SavedState& state) {
    world.bodies.slots.set_free_list(state.body_slots.free_list, state.body_slots.capacity);
    world.colliders.slots.set_free_list(state.collider_slots.free_list, state.collider_slots.capacity);
    world.joints.slots.set_free_list(state.joint_slots.free_list, state.joint_slots.capacity);
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

Status World::restore(std::span<const uint8_t> snapshot) {
    WorldData& world = data();
    if (world.in_step) return Error{ErrorCode::locked, "restore: called from inside a step"};
    SavedState state;
    if (Status s = decode(snapshot, state); !s) return s;
    const auto bodies = static_cast<uint32_t>(body_count()), joints = static_cast<uint32_t>(joint_count());
    if (state.body_slots.count > bodies || state.joint_slots.count > joints ||
        state.fingerprint != fingerprint(world, state.body_slots.count, state.joint_slots.count))
        return Error{ErrorCode::wrong_world, "restore: the snapshot is of " + std::to_string(state.body_slots.count) +
                                                 " bodies and " + std::to_string(state.joint_slots.count) +
                                                 " joints that are not in this world, or not all of them any more"};
    if (Status s = check_saved(world, state); !s) return s;
    while (joint_count() > static_cast<int>(state.joint_slots.count))
        if (Status s = remove_joint(joint_id(joint_count() - 1)); !s) return s;
    while (body_count() > static_cast<int>(state.body_slots.count))
        if (Status s = remove_body(body(body_count() - 1)); !s) return s;
    apply(world, state);
    return {};
}

}  // namespace lendulet
