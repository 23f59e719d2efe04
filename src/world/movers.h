// Who takes part in a step, and what is kept of those that do not.
//
// A step looks at movers: dynamic bodies that are awake, and kinematic ones that move or have just been touched. All
// others rest. Their boxes stay in the broad phase as they are, their pairs stay in the table but off its list, and
// their contacts with what else rests are kept here with their impulses. So a step costs nothing for them, and to wake
// a body costs what hangs on it.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace lendulet {

struct Movers {
    // Slots in creation order up to `sorted`; behind them those that became movers since; no_slot where one was
    // removed. BodyInfo::mover_place leads back.
    Array<uint32_t> bodies;
    size_t sorted = 0;
    bool leaving = false;         // some have come to rest or were removed
    bool joints_changed = false;  // joints came or went
    Array<uint32_t> colliders;    // of the bodies, in their order
    Array<uint32_t> joints;       // slots of those with at least one mover, in creation order
    Array<uint32_t> merged;

    explicit Movers(const Memory* memory) : bodies(memory), colliders(memory), joints(memory), merged(memory) {}
};

// What a contact record that rests, or one that the last step went through, is found by.
struct RestingContacts {
    Array<uint32_t> records;   // with points
    Array<uint32_t> hits;      // pairs of triggers that overlap; their first_record is the place here
    Array<uint32_t> place;     // by record: in `records`, or in WorldData::touching
    int points = 0;            // that touch or overlap
    float penetration = 0.0f;  // the deepest, m
    bool penetration_stale = false, hits_changed = false;
    int listed_hits = 0;  // at the head of WorldData::overlaps

    explicit RestingContacts(const Memory* memory) : records(memory), hits(memory), place(memory) {}
};

}  // namespace lendulet
