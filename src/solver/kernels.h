// The wide kernels of the solver as a table of functions, one table a SIMD width. One source (kernels.inl) is compiled
// once per instruction set; the table is chosen when a world is built. All widths give the same bits: constraints of
// one colour share no body, so how they are packed into lanes cannot matter.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/meetings.h"

namespace lendulet {

struct SubstepConstants {
    float h;  // substep, s
    float inverse_h;
    float bias_rate;     // share of the overlap undone in a substep, divided by h
    float leak;          // share of the accumulated normal impulse given up in the biased pass
    float bounce_speed;  // slower impacts do not bounce, m/s
    float still_drift;   // bodies that move less than this relative to each other rest on each other, m
    bool joints;         // whether there are any
    bool moved;          // bodies were displaced since the last relax or prepare: impacts shift them
    bool first, last;    // substep of the step
    // Bodies whose kick is split: by what their constraints' changes in the last substep are multiplied when they are
    // repeated in this one, and when half of them is added at the end of the step.
    float repeat_scale, end_scale;
    float substeps_so_far;  // of the step, this one included
};

struct SharedEnds;  // stand_ins.h

// Contacts that are solved at once where they share bodies, whatever the width: results depend on it. And which
// stand-in such a contact has for A (0) or B (1), by its place in the group.
inline constexpr int shared_contacts = 16;
constexpr int32_t stand_in(int place, int end) { return 2 * (place % shared_contacts) + end; }

// What rows reach bodies by: those of the step, or stand-ins for some of them.
struct BodyArrays {
    BodyState* state;
    const BodyInertia* inertia;
    const BodyStart* start;

    static BodyArrays of(SolverBodies& b) { return {b.state.data(), b.inertia.data(), b.start.data()}; }
};

// Manifolds of one colour and one size class: `count` of them, named by `order`, in rows from `rows` on.
struct ContactGroup {
    int points;      // rows have room for 1, 2 or 4
    bool fixed_a;    // A is static or kinematic in all of them: not stored
    bool shares;     // manifolds share bodies: their rows name stand-ins, see stand_ins.h; one thread
    int colour;      // its number: groups of one number share no body
    int32_t filler;  // reserved body for the empty lanes of the last block
    int count;
    const uint32_t* order;         // indices of the records ...
    const ContactRecord* records;  // ... in here
    std::byte* rows;
    float impulse_unit;    // a record's impulses are multiplied by it on their way into rows: a power of two
    std::byte* rolling;    // rows against rolling, or null
    ContactExtra* extras;  // by record, where `rolling` is not null
    SharedEnds* ends;      // by place, where it `shares`
};

struct SolverKernels {
    int width;
    size_t row_bytes[3];   // of one block of `width` manifolds with 1, 2, 4 points
    size_t rolling_bytes;  // and of their rows against rolling

    // Contacts: blocks [begin, end) of a group.
    using Pass = void (*)(const ContactGroup&, const BodyArrays&, const SubstepConstants&, int begin, int end);
    void (*prepare)(const ContactGroup&, const ContactRecord*, const BodyArrays&, int begin, int end);
    Pass warm_start, solve, relax;
    void (*store)(const ContactGroup&, ContactRecord*, int begin, int end);
    // What the points of one manifold of a group carry in this substep, N s; 0 where there is none.
    void (*read_impulses)(const ContactGroup&, int place, float impulses[4]);

    // Bodies [begin, end), both multiples of 16. `begin_step` before the first kick, `settle` after the last relax.
    void (*begin_step)(SolverBodies&, int begin, int end);
    void (*kick)(SolverBodies&, const SubstepConstants&, int begin, int end);
    void (*drift)(SolverBodies&, const SubstepConstants&, int begin, int end);
    void (*settle)(SolverBodies&, int begin, int end);

    // Fills in a block, and tells which contacts of it may meet.
    void (*prepare_meetings)(MeetingBlock&, const SolverBodies&, const ContactRecord*, const MeetingContacts&);
    void (*find_meetings)(MeetingBlock&, const SolverBodies&, const SubstepConstants&);
};

inline int row_class(int points) { return points > 2 ? 2 : points - 1; }

// The kernels for 1, 4, 8 or 16 lanes in the best instructions this machine has for that width.
const SolverKernels& solver_kernels(int width);
// The width to use where the user has no wish: the widest with instructions of its own.
int native_width();

}  // namespace lendulet
