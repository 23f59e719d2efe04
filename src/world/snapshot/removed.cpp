// From the world's stores to those of what was removed, and back.
#include "world/snapshot/removed.h"

#include "world/world_data.h"

namespace lendulet {
namespace {

// But for what snapshots hold of a body.
void move_body(BodyStore& from, uint32_t slot, BodyStore& to, uint32_t place) {
    BodyInfo info = from.info[slot];
    if (info.type != BodyType::fixed) info.type = info.massless ? BodyType::kinematic : BodyType::dynamic;
    info.altered = false;
    info.mover_place = info.first_collider = no_slot;
    to.info[place] = info;
    to.pose[place] = from.pose_as_added(slot);
    to.mass[place] = from.mass_as_added(slot);
    to.principal[place] = from.principal[slot];
    to.name[place].swap(from.name[slot]);
}

// The same: filter, material and events.
void move_collider(ColliderStore& from, uint32_t slot, ColliderStore& to, uint32_t place) {
    to.geometry[place] = from.geometry[slot];
    to.local[place] = from.local[slot];
    to.given[place] = from.given[slot];
    to.info[place] = from.info[slot];
    to.info[place].next = no_slot;
    to.shape[place] = std::move(from.shape[slot]);
    to.materials[place].swap(from.materials[slot]);
    to.table[place].swap(from.table[slot]);
}

// place(collider): where one goes.
template <class Place>
void move_colliders(ColliderStore& from, uint32_t first, ColliderStore& to, BodyInfo& body, Place&& place) {
    uint32_t last = no_slot;
    for (uint32_t c = first; c != no_slot; c = from.info[c].next) {
        const uint32_t at = place(c);
        move_collider(from, c, to, at);
        (last == no_slot ? body.first_collider : to.info[last].next) = at;
        last = at;
    }
}

void forget_body(Removed& r, uint32_t slot) {
    for (uint32_t c = r.bodies.info[slot].first_collider; c != no_slot; c = r.colliders.info[c].next) {
        r.colliders.let_go(c);
        r.colliders.slots.remove(c);
    }
    r.bodies.slots.remove(slot);
}

void forget_beyond(Removed& r, int most) {
    while (r.bodies.slots.count() > most) forget_body(r, r.bodies.slots.oldest());
    while (r.joints.count() > most) r.joints.remove(r.joints.slots.oldest());
}

}  // namespace

void Removed::copy(const Removed& o) {
    bodies.copy(o.bodies);
    colliders.copy(o.colliders);
    joints.copy(o.joints);
    copy_array(o.of_body, of_body);
    copy_array(o.of_collider, of_collider);
    copy_array(o.of_joint, of_joint);
}

void keep_removed_body(WorldData& world, uint32_t slot) {
    if (world.config.kept_removed == 0) return;
    Removed& r = world.removed;
    const uint32_t place = r.bodies.add();
    r.of_body.resize(r.bodies.slots.capacity());
    r.of_body[place] = {world.bodies.slots.use(slot), hash_body(world, slot)};
    move_body(world.bodies, slot, r.bodies, place);
    move_colliders(world.colliders, world.bodies.info[slot].first_collider, r.colliders, r.bodies.info[place],
                   [&](uint32_t c) {
                       const uint32_t at = r.colliders.add();
                       r.of_collider.resize(r.colliders.slots.capacity());
                       r.of_collider[at] = world.colliders.slots.use(c);
                       return at;
                   });
    forget_oldest(world);
}

void keep_removed_joint(WorldData& world, uint32_t slot) {
    if (world.config.kept_removed == 0) return;
    Removed& r = world.removed;
    const JointStore& joints = world.joints;
    const JointInfo& info = joints.info[slot];
    const uint32_t place =
        r.joints.add(info, info.axes >= 0 ? &joints.axes[static_cast<size_t>(info.axes)] : nullptr, joints.name[slot]);
    const Slots& bodies = world.bodies.slots;
    r.of_joint.resize(r.joints.slots.capacity());
    r.of_joint[place] = {joints.slots.use(slot), hash_joint(world, slot), bodies.use(info.body_a),
                         bodies.use(info.body_b)};
    forget_oldest(world);
}

void forget_oldest(WorldData& world) {
    if (!world.removed.restoring) forget_beyond(world.removed, world.config.kept_removed);
}

void bring_back_body(WorldData& world, uint32_t removed) {
    Removed& r = world.removed;
    const SlotUse id = r.of_body[removed].id;
    world.bodies.slots.give_back(id);
    move_body(r.bodies, removed, world.bodies, id.slot);
    move_colliders(r.colliders, r.bodies.info[removed].first_collider, world.colliders, world.bodies.info[id.slot],
                   [&](uint32_t c) {
                       const SlotUse collider = r.of_collider[c];
                       world.colliders.slots.give_back(collider);
                       world.query_scene.changed(collider.slot);
                       return collider.slot;
                   });
    world.bodies.clear_motion(id.slot);
    world.continuous.colliders_changed = true;
    forget_body(r, removed);
}

void bring_back_joint(WorldData& world, uint32_t removed) {
    JointStore& joints = world.removed.joints;
    const SlotUse id = world.removed.of_joint[removed].id;
    const JointInfo& info = joints.info[removed];
    world.joints.slots.give_back(id);
    world.joints.put(id.slot, info, info.axes >= 0 ? &joints.axes[static_cast<size_t>(info.axes)] : nullptr,
                     joints.name[removed]);
    joints.remove(removed);
}

void World::forget_removed() { forget_beyond(data().removed, 0); }

}  // namespace lendulet
