// What is gone from a world and comes back with a snapshot of before: the bodies and joints that were removed last, as
// they were added. Their state is in the snapshot. They lie in stores like those of the living.
#pragma once

#include <cstdint>

#include "dynamics/body_store.h"
#include "dynamics/collider_store.h"
#include "dynamics/joint_store.h"

namespace lendulet {

struct WorldData;

// What an object was among the living, and a hash of what restore() relies on: see hash_body(), hash_joint().
struct RemovedBody {
    SlotUse id;
    uint64_t hash = 0;
};
struct RemovedJoint {
    SlotUse id;
    uint64_t hash = 0;
    SlotUse body_a, body_b;
};

struct Removed {
    BodyStore bodies;
    ColliderStore colliders;
    JointStore joints;
    // By slots of these stores.
    Array<RemovedBody> of_body;
    Array<SlotUse> of_collider;
    Array<RemovedJoint> of_joint;
    bool restoring = false;  // nothing is forgotten meanwhile

    explicit Removed(const Memory* memory)
        : bodies(memory, 1),
          colliders(memory, 1),
          joints(memory, 1),
          of_body(memory),
          of_collider(memory),
          of_joint(memory) {}
    void copy(const Removed& o);
};

// Hashes of what is not in a snapshot, of one object.
uint64_t hash_body(const WorldData& world, uint32_t slot);
uint64_t hash_joint(const WorldData& world, uint32_t slot);

// Takes over what the world's stores hold of an object that is about to be removed, if any are kept.
void keep_removed_body(WorldData& world, uint32_t slot);
void keep_removed_joint(WorldData& world, uint32_t slot);
// Forgets the oldest ones beyond WorldConfig::kept_removed.
void forget_oldest(WorldData& world);

// Moves an object from the removed ones to the world's stores, where its slot is free. It is not alive yet (see
// Slots::set_alive()), and bodies do not know of joints.
void bring_back_body(WorldData& world, uint32_t removed);
void bring_back_joint(WorldData& world, uint32_t removed);

}  // namespace lendulet
