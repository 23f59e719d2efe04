// Bounces at their time of impact. Runs before each substep over the manifolds that can bounce.
#pragma once

#include <cstdint>

#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/kernels.h"

namespace lendulet {

// Records that can bounce, in order, and what some of them have beside; null where none has.
struct BouncingList {
    const uint32_t* list;
    int count;
    const ContactExtra* extras;
};

// Finds the points that in this substep, the given one of the step, will meet faster than k.bounce_speed, gives both
// bodies Newton's impulse with Coulomb friction on the whole of it (restitution included; with tangential restitution
// it may turn the slip round), and shifts them so that it acted at the time of impact. Sweeps over the list until no
// point approaches, at most 8 times, so that impulses travel through touching bodies one by one, as in a cradle.
// Returns whether any body was displaced.
bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, BouncingList bouncing,
                     const SubstepConstants& k, int substep);

}  // namespace lendulet
