// Impacts at their time: bounces, and contacts of bodies so fast that rows of a whole substep cannot follow
// (contact_swift). Runs before each substep over the manifolds of these.
#pragma once

#include <cstdint>

#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/impact_joints.h"
#include "solver/kernels.h"
#include "solver/watch.h"

namespace lendulet {

// Contacts that can bounce or are swift, in order, sixteen to a block.
struct ImpactList {
    const ImpactContact* contacts;
    int count;
    const MeetingBlock* blocks;
    const ContactExtra* extras;  // what some have beside, by record; null where none has
    uint8_t* disturbed;          // by body: 1 where it no longer moves as the step began; null where no contact passes
    WatchList watched{};         // contacts whose impacts are noted
    ImpactJoints* joints = nullptr;  // of this step; null where there are none
};

// Marks bodies of the range that constraints have moved since the last substep began; before its kick.
void mark_disturbed(const SolverBodies& bodies, BodyRange range, uint8_t* disturbed);

// What rows do for other contacts: leaves the separations that a contact without one has after the step.
void follow_passing(const SolverBodies& bodies, ContactRecord& record);

// Finds the points that in this substep, the given one of the step, will meet faster than slowest_bounce(), gives both
// bodies Newton's impulse with Coulomb friction on the whole of it (restitution included; with tangential restitution
// it may turn the slip round), and shifts them so that it acted at the time of impact. Sweeps over the list until no
// point approaches, at most 8 times, so that impulses travel through touching bodies one by one, as in a cradle.
// Returns whether any body was displaced.
bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, const ImpactList& list,
                     const SubstepConstants& k, int substep);

}  // namespace lendulet
