// From bytes back to a world. Everything is checked before anything is changed.
#include "world/snapshot/saved_state.h"

namespace lendulet {
namespace {

// For each of a snapshot's objects no_slot where it is alive, else where it is among those removed, of whom `of` tells.
// Returns how many are neither.
template <class Saved, class Gone>
int find_removed(const Slots& slots, const Array<Saved>& saved, const Slots& removed, const Array<Gone>& of,
                 Array<uint32_t>& found) {
    Array<uint32_t> sought;  // by slot, the place in the snapshot
    sought.resize(slots.capacity(), no_slot);
    found.resize(saved.size(), no_slot);
    int missing = 0;
    for (uint32_t i = 0; i < saved.size(); ++i) {
        if (slots.holds(saved[i].id)) continue;
        ++missing;
        if (saved[i].id.slot < sought.size()) sought[saved[i].id.slot] = i;
    }
    if (missing == 0) return 0;
    for (uint32_t gone : removed.order()) {
        const uint32_t place = sought[of[gone].id.slot];
        if (place == no_slot || !(saved[place].id == of[gone].id)) continue;
        found[place] = gone;
        --missing;
    }
    return missing;
}

// Those alive that the snapshot does not have, the youngest first.
template <class Saved>
Array<uint32_t> strangers(const Slots& slots, const Array<Saved>& saved) {
    Array<uint8_t> stays;
    stays.resize(slots.capacity(), 0);
    for (const Saved& s : saved)
        if (slots.holds(s.id)) stays[s.id.slot] = 1;
    Array<uint32_t> list;
    for (int i = slots.count() - 1; i >= 0; --i)
        if (const uint32_t slot = slots.in_order(i); !stays[slot]) list.push_back(slot);
    return list;
}

}  // namespace

Status World::restore(std::span<const uint8_t> snapshot) {
    WorldData& world = data();
    if (world.in_step) return Error{ErrorCode::locked, "restore: called from inside a step"};
    SavedState state;
    if (Status s = decode(snapshot, state); !s) return s;
    Returning returning;
    const int bodies = find_removed(world.bodies.slots, state.bodies, world.removed.bodies.slots, world.removed.of_body,
                                    returning.bodies);
    const int joints = find_removed(world.joints.slots, state.joints, world.removed.joints.slots,
                                    world.removed.of_joint, returning.joints);
    if (bodies > 0 || joints > 0)
        return Error{ErrorCode::wrong_world,
                     "restore: " + std::to_string(bodies) + " bodies and " + std::to_string(joints) +
                         " joints of the snapshot are neither in this world nor among the last " +
                         std::to_string(config().kept_removed) + " of either that were removed (kept_removed)"};
    if (state.fingerprint != fingerprint(world, state, returning))
        return Error{ErrorCode::wrong_world,
                     "restore: the snapshot is of a world with other settings, or with other bodies or joints"};
    if (Status s = check_saved(world, state, returning); !s) return s;

    world.removed.restoring = true;
    for (uint32_t slot : strangers(world.joints.slots, state.joints))
        if (Status s = remove_joint(world.joints.id(slot)); !s) return s;
    for (uint32_t slot : strangers(world.bodies.slots, state.bodies))
        if (Status s = remove_body(world.bodies.id(slot)); !s) return s;
    world.removed.restoring = false;
    for (uint32_t slot : returning.bodies)
        if (slot != no_slot) bring_back_body(world, slot);
    for (uint32_t slot : returning.joints)
        if (slot != no_slot) bring_back_joint(world, slot);
    forget_oldest(world);
    apply(world, state);
    return {};
}

}  // namespace lendulet
