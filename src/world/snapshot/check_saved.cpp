// Whether a saved state can be that of a world: nothing is changed before all of it was looked at.
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

// Of one kind of object: every slot there was is either that of one, or free, once.
class SlotCheck {
public:
    SlotCheck(const SavedSlots& s, const Slots& now)
        : good_(s.capacity <= now.capacity() && uint64_t{s.count} + s.free_list.size() == s.capacity),
          seen_(good_ ? s.capacity : 0, false) {
        for (uint32_t slot : s.free_list) see(slot);
    }
    void see(uint32_t slot) {
        good_ = good_ && slot < seen_.size() && !seen_[slot];
        if (good_) seen_[slot] = true, ++count_;
    }
    bool good() const { return good_ && count_ == seen_.size(); }

private:
    bool good_;
    size_t count_ = 0;
    std::vector<bool> seen_;
};

// The bodies of a snapshot as they were added, alive or not, by their places in it.
struct Cast {
    const WorldData& world;
    const SavedState& state;
    const Returning& returning;

    const BodyInfo& body(size_t place) const {
        const uint32_t gone = returning.body(place);
        return gone != no_slot ? world.removed.bodies.info[gone] : world.bodies.info[state.bodies[place].id.slot];
    }
    const JointInfo& joint(size_t place) const {
        const uint32_t gone = returning.joint(place);
        return gone != no_slot ? world.removed.joints.info[gone] : world.joints.info[state.joints[place].id.slot];
    }
    // visit(slot, geometry, info) for the colliders of a body.
    template <class Visit>
    void for_each_collider(size_t place, Visit&& visit) const {
        const bool gone = returning.body(place) != no_slot;
        const ColliderStore& store = gone ? world.removed.colliders : world.colliders;
        for (uint32_t c = body(place).first_collider; c != no_slot; c = store.info[c].next)
            visit(gone ? world.removed.of_collider[c].slot : c, store.geometry[c], store.info[c]);
    }
};

Status check_slots(const Cast& cast) {
    const SavedState& state = cast.state;
    SlotCheck bodies(state.body_slots, cast.world.bodies.slots);
    SlotCheck colliders(state.collider_slots, cast.world.colliders.slots);
    SlotCheck joints(state.joint_slots, cast.world.joints.slots);
    for (size_t i = 0; i < state.bodies.size(); ++i) {
        bodies.see(state.bodies[i].id.slot);
        cast.for_each_collider(i, [&](uint32_t c, const Geometry&, const ColliderInfo&) { colliders.see(c); });
    }
    for (const SavedJoint& j : state.joints) joints.see(j.id.slot);
    if (!bodies.good() || !colliders.good() || !joints.good()) return bad("counts its bodies and joints wrongly");
    return {};
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

// A collider of the snapshot; without `body`: it knows none in that slot.
struct Owned {
    const SavedBody* body = nullptr;
    bool trigger = false, mesh = false;
};

// By slot.
std::vector<Owned> owners(const Cast& cast) {
    std::vector<Owned> owner(cast.world.colliders.slots.capacity());
    for (size_t i = 0; i < cast.state.bodies.size(); ++i)
        cast.for_each_collider(i, [&](uint32_t c, const Geometry& geometry, const ColliderInfo& info) {
            owner[c] = {&cast.state.bodies[i], info.is_trigger, has_triangles(geometry)};
        });
    return owner;
}

bool good_mass(const BodyMass& m) {
    return check_mass(m.mass, "restore") && is_finite(m.inverse_mass) && can_be_inverted(m.inertia) &&
           is_finite(m.inverse_inertia) && is_finite(m.anisotropy);
}

// Static bodies never take part in steps, those awake always do.
Status check_bodies(const Cast& cast) {
    for (size_t i = 0; i < cast.state.bodies.size(); ++i) {
        const SavedBody& b = cast.state.bodies[i];
        const BodyInfo& info = cast.body(i);
        const BodyType type = info.type;
        if (!b.fixed && info.massless && !b.kinematic) return bad("takes a body without mass for a dynamic one");
        if (b.fixed != (type == BodyType::fixed)) return bad("takes a static body for a moving one");
        bool good = b.fixed ? !b.mover : good_body(b) && (b.mover || b.asleep || b.kinematic);
        if (b.altered) good = good && (b.fixed ? good_pose(b.pose) : !info.massless && good_mass(b.mass));
        if (!good) return bad("holds a body whose state cannot be");
    }
    return {};
}

// Joints hang on bodies of the snapshot. Those whose rows are data have motors, springs and impulses for each.
Status check_joints(const Cast& cast) {
    const SavedState& state = cast.state;
    std::vector<SlotUse> there(cast.world.bodies.slots.capacity());
    for (const SavedBody& b : state.bodies) there[b.id.slot] = b.id;
    for (size_t i = 0; i < state.joints.size(); ++i) {
        const JointInfo& j = cast.joint(i);
        const uint32_t gone = cast.returning.joint(i);
        const Slots& bodies = cast.world.bodies.slots;
        SlotUse a = bodies.use(j.body_a), b = bodies.use(j.body_b);
        if (gone != no_slot) a = cast.world.removed.of_joint[gone].body_a, b = cast.world.removed.of_joint[gone].body_b;
        if (!(there[a.slot] == a) || !(there[b.slot] == b)) return bad("holds a joint of bodies that it does not hold");
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
Status check_boxes(const SavedState& state, std::vector<Owned> without) {
    for (const BroadBox& box : state.boxes) {
        bool good = box.index < without.size() && without[box.index].body && !without[box.index].body->fixed;
        for (int d = 0; d < 3 && good; ++d) good = box.lower[d] <= box.upper[d];
        if (!good) return bad("holds a box that cannot be");
        without[box.index].body = nullptr;
    }
    for (const Owned& o : without)
        if (o.body && !o.body->fixed && !o.body->mover) return bad("lacks a box");
    return {};
}

int room_for_contacts(const Owned& a, const Owned& b) {
    if (a.trigger || b.trigger) return 0;
    return a.mesh || b.mesh ? max_mesh_manifolds : 1;
}

Status check_pairs(const SavedState& state, const std::vector<Owned>& owner) {
    size_t contacts = 0;
    const SavedPair* before = nullptr;
    for (const SavedPair& p : state.pairs) {
        bool sorted = p.a < p.b && (!before || before->a < p.a || (before->a == p.a && before->b < p.b));
        if (!sorted || p.b >= owner.size() || !owner[p.a].body || !owner[p.b].body ||
            (!p.listed && !is_finite(p.rest_h)))
            return bad("holds a pair that cannot be");
        if (p.cache.gjk.face > GjkCache::unknown_face) return bad("holds a face that boxes do not have");
        if (p.cache.gjk.count > 4 || p.contacts > room_for_contacts(owner[p.a], owner[p.b]))
            return bad("holds too many contacts");
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

}  // namespace

Status check_saved(const WorldData& world, const SavedState& state, const Returning& returning) {
    if (state.bodies.size() != state.body_slots.count || state.joints.size() != state.joint_slots.count)
        return bad("holds another number of bodies or joints than it says");
    if (!is_finite(state.gravity) || !(state.last_h >= 0.0f) || !is_finite(state.last_h) ||
        !(state.time >= 0.0 && state.time < 1e300))
        return bad("holds a time or a gravity that cannot be");
    const Cast cast{world, state, returning};
    if (Status s = check_slots(cast); !s) return s;
    if (Status s = check_bodies(cast); !s) return s;
    if (Status s = check_joints(cast); !s) return s;
    if (Status s = check_colliders(world, state); !s) return s;
    const std::vector<Owned> owner = owners(cast);
    if (Status s = check_boxes(state, owner); !s) return s;
    return check_pairs(state, owner);
}

}  // namespace lendulet
