// Contacts that no colour has room for, since one of their bodies touches very many others: a slab on a bed of balls, a
// drum full of boxes. They go sixteen at a time, in the same wide kernels as all others.
//
// Each of the sixteen has stand-ins for its two bodies, to itself. A body that n of them share stands in for with n
// stand-ins of an n-th of its mass each, and moves as they do on average: what all give it is neither lost nor counted
// twice, and sixteen at once cannot push harder than each alone would (mass splitting: Tonge, Benevolenski, Voroshilov
// 2012). From sixteen to sixteen every contact sees what those before have done.
//
// One after the other, in one lane, they took 0.1 us each in a pass, most of it waiting for the one before.
#pragma once

#include <cstdint>

#include "solver/kernels.h"

namespace lendulet {

// The two bodies of a contact, and how many of its sixteen share them.
struct SharedEnds {
    int32_t body[2];
    float sharers[2];
};

// Fills in the group's ends, and packs its rows.
void prepare_shared(const SolverKernels& kernels, const ContactGroup& group, const ContactRecord* records,
                    SolverBodies& bodies);
void pass_shared(const SolverKernels& kernels, SolverKernels::Pass pass, const ContactGroup& group,
                 SolverBodies& bodies, const SubstepConstants& k);

}  // namespace lendulet
