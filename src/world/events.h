// What is kept for events: lists for the user, and what a step notes for them. See lendulet/events.h.
//
// Whether a pair touches is part of the pair (ColliderPair::touches), so that it is kept while the pair rests, and goes
// into snapshots. Where no collider asks a step spends nothing; else it looks at two bytes of every listed pair, and at
// more where one asks.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "lendulet/events.h"
#include "lendulet/world.h"
#include "solver/watch.h"

namespace lendulet {

// A pair that ended while its colliders touched; of those with a trigger A is the trigger.
struct EndedTouch {
    ContactEvent pair;
    bool trigger;
};

struct EventData {
    Array<ContactEvent> begins, ends;
    Array<ContactHit> hits;
    Array<Overlap> trigger_begins, trigger_ends;
    Array<SleepEvent> sleeps;
    Array<JointBreak> breaks;

    int askers = 0;                 // colliders that ask
    Array<uint8_t> asks;            // by collider: bits of Events
    Array<EndedTouch> ended;        // since the last report
    Array<ContactHit> pending;      // hits of the last step that were not over with it
    Array<uint32_t> woken, fallen;  // slots of bodies, since the last report
    Array<WatchedContact> watched;  // contacts of this step, by class of substeps and then in order
    Array<uint32_t> watch_of_record;

    explicit EventData(const Memory* memory)
        : begins(memory),
          ends(memory),
          hits(memory),
          trigger_begins(memory),
          trigger_ends(memory),
          sleeps(memory),
          breaks(memory),
          asks(memory),
          ended(memory),
          pending(memory),
          woken(memory),
          fallen(memory),
          watched(memory),
          watch_of_record(memory) {}
};

}  // namespace lendulet
