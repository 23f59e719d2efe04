// Graph colouring of manifolds: those of one colour share no body that constraints move, so they are solved side by side,
// in lanes and on threads, with one result.
//
// Greedy in the order of the list, lowest free colour first (Welsh, Powell 1967, without sorting). Manifolds with a static
// or kinematic body have colours of their own, solved last in every pass: what rests on the ground is then as exact as an
// iteration can leave it. Manifolds that find no free colour (a body with very many neighbours) overflow and are solved
// one by one.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/contact.h"
#include "solver/kernels.h"

namespace lendulet {

struct ColourSchedule {
    Array<uint32_t> order;        // indices of records, by group
    Array<ContactGroup> groups;   // in the order in which they are solved
    Array<int> colour_ends;       // one past the last group of each colour: a barrier follows
    Array<std::byte> rows;
    int first_overflow_group = 0; // groups from here on hold manifolds that share bodies: one lane, one thread
    int overflow = 0;

    explicit ColourSchedule(const Memory* memory)
        : order(memory), groups(memory), colour_ends(memory), rows(memory), used_moving(memory), used_fixed(memory),
          keys(memory), counts(memory) {}

    // Colours the `count` records that `list` names. Where only one body of a record is moved, it is B.
    void build(const ContactRecord* records, const uint32_t* list, int count, const SolverBodies& bodies, const SolverKernels& kernels,
               const SolverKernels& scalar_kernels);
    int colour_count() const { return colour_ends.count(); }

private:
    Array<uint32_t> used_moving, used_fixed;  // a bit per colour and body
    Array<uint8_t> keys;
    Array<uint32_t> counts;
};

}  // namespace lendulet
