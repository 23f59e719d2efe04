// Bounces at their time of impact. Runs before each substep over the manifolds that can bounce.
#pragma once

#include <cstdint>

#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/kernels.h"

namespace lendulet {

// Finds the points that will meet within the substep faster than k.bounce_speed, gives both bodies Newton's impulse
// with Coulomb friction on the whole of it (restitution included), and shifts them so that it acted at the time of
// impact. Sweeps over `list` (indices of records, in order) until no point approaches, at most 8 times, so that
// impulses travel through touching bodies one by one, as in a cradle. Returns whether any body was displaced.
bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, const uint32_t* list, int count,
                     const SubstepConstants& k);

}  // namespace lendulet
