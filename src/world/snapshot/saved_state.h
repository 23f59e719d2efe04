// What a snapshot holds, between a world and its bytes: capture() and apply() translate from and to a world, encode()
// and decode() from and to bytes. Shapes, masses and settings are not in it; a fingerprint of them is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/world_data.h"

namespace lendulet {

// The slots of one kind of object: how many there are, and which come next.
struct SavedSlots {
    uint32_t count = 0;     // alive
    uint32_t capacity = 0;  // ever made
    Array<uint32_t> free_list;
};

struct SavedBody {
    SlotUse id;
    bool follows = false;  // in the slot after that of the one before, used as often
    Pose pose;
    BodyMomenta momenta{};
    BodyChange change{};
    BodyForces forces{};
    float still_time = 0.0f;
    bool woken = false;
    bool kinematic = false, bullet = false, allow_sleep = true;
    bool drags_alike = false;  // the next three are those of the body before
    float linear_damping = 0.0f, angular_damping = 0.0f, gravity_factor = 1.0f;
    bool fixed = false;  // a static body: nothing but `placed` is saved of it, and its pose where it was moved
    bool altered = false;
    BodyMass mass;  // where it was set
    bool mover = false;
    bool asleep = false, has_forces = false, placed = false, capped = false, contained = false, stopped = false;
    // Of the island that it was in: class of substeps, and for how many steps fewer would have done, or, above
    // `pressed`, more were asked for.
    static constexpr uint8_t pressed = 128;
    bool loaded = false;
    uint8_t substeps = 0, waited = 0, calm = 0;
};

// Whom a collider meets, what it is made of and what it reports.
struct SavedCollider {
    CollisionFilter filter{};
    Material material{};
    Events events = Events::none;
};

struct SavedJoint {
    SlotUse id;
    bool follows = false;  // as with bodies
    Limit limit{}, twist_limit{};
    float swing_limit = 0.0f;
    Motor motor;
    Spring spring;
    float friction = 0.0f;
    JointImpulses impulses;
    bool has_axes = false;
    JointAxesInfo axes{};  // of joints whose rows are data: their motors, springs and impulses
};

struct SavedContact {
    ContactRecord record;
    FoundSeparations found;
    bool rolls = false, fresh = false;  // `extra` holds its impulse, and that is of the last step
    bool covered = false;               // see mark_covered()
    ContactExtra extra{};
};

struct SavedPair {
    uint32_t a = 0, b = 0;  // collider slots
    uint8_t contacts = 0;   // of SavedState::contacts, in order
    bool hit = false, begun = false, touches = false;
    bool listed = true;
    float rest_h = 0.0f;  // where it is not listed
    PairCache cache;
    bool kept = false;  // `pose` holds
    KeptPose pose{};
};

struct SavedState {
    uint64_t fingerprint = 0;
    Vec3 gravity;
    float last_h = 0.0f;
    double time = 0.0;
    uint64_t steps = 0;
    SavedSlots body_slots, collider_slots, joint_slots;
    Array<SavedBody> bodies;  // these two in creation order
    Array<SavedJoint> joints;
    Array<SavedCollider>
        colliders;          // in the order of bodies and their lists; those that differ from the one before ...
    Array<uint32_t> alike;  // ... and for how many each stands
    Array<BroadBox> boxes;  // of moving colliders, as the broad phase knows them
    Array<SavedPair> pairs;
    Array<SavedContact> contacts;
    // Events to be reported, their handles without the number of the world.
    Array<EndedTouch> ended;
    Array<ContactHit> pending;
};

inline bool alike(const CollisionFilter& x, const CollisionFilter& y) {
    return x.category == y.category && x.mask == y.mask && x.group == y.group;
}

// visit(id) for the handles of an event.
template <class Event, class Visit>
void for_each_handle(Event& event, Visit&& visit) {
    visit(event.body_a), visit(event.body_b);
    visit(event.collider_a), visit(event.collider_b);
}

// Who of a state's bodies and joints, by its place there, is to be brought back: its slot among those removed; no_slot:
// it is alive. Empty: all are.
struct Returning {
    Array<uint32_t> bodies, joints;
    uint32_t body(size_t place) const { return bodies.empty() ? no_slot : bodies[place]; }
    uint32_t joint(size_t place) const { return joints.empty() ? no_slot : joints[place]; }
};

// Hash of what the snapshot does not hold but depends on: settings, and its bodies and joints as they were added.
uint64_t fingerprint(const WorldData& world, const SavedState& state, const Returning& returning);

void capture(const WorldData& world, SavedState& state);
// Whether the state can be the world's: what apply() relies on. `state` is of the same fingerprint.
Status check_saved(const WorldData& world, const SavedState& state, const Returning& returning);
// Puts the checked state into the world, whose stores have its bodies and joints.
void apply(WorldData& world, const SavedState& state);

std::vector<uint8_t> encode(SavedState& state);
Status decode(std::span<const uint8_t> bytes, SavedState& state);

}  // namespace lendulet
