// Contacts that somebody wants to be told of: what they carry over a whole step, and how fast their points meet. Rows
// and impacts know nothing of it; a step in which no contact is watched is as it was.
#pragma once

#include <cstdint>

#include "lendulet/math.h"
#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/kernels.h"

namespace lendulet {

// A point on its way to meet the other body.
struct NearingPoint {
    float speed = 0.0f;  // with which it will, along the normal, m/s; 0: it does not
    Vec3 normal, place;  // then; see WatchedContact
};

struct WatchedContact {
    uint32_t record = 0;
    bool speeds = false;   // how fast it meets is asked for ...
    bool follows = false;  // and what it carries, which it is as soon as it meets
    // Its row; -1: it has none.
    int32_t group = -1, place = 0;
    NearingPoint nearing[4];
    // The results. Along the normal, since it is followed, N s.
    float impulse = 0.0f;
    // Of the point that met fastest, before that was answered, m/s; 0: none has met. The normal from A to B, and where,
    // from B's centre of mass as it was when the step began, m.
    float speed = 0.0f;
    Vec3 normal, place_of_hit;
    bool unanswered = false;  // it met in the last substep, and its bodies still approach: rows go on in the next step
};

// Those of a solver, with where to find them: by record, one more than the index in `list`, or 0.
struct WatchList {
    WatchedContact* list = nullptr;
    const uint32_t* of_record = nullptr;
    int first = 0, count = 0;  // this solver's
    float least_speed = 0.0f;  // slower meetings are not told, m/s

    WatchedContact* of(uint32_t record) const {
        return of_record && of_record[record] != 0 ? list + (of_record[record] - 1) : nullptr;
    }
};

// The constants by which find_meetings() tells which contacts are worth the next call.
SubstepConstants look_ahead(const SubstepConstants& k, float least_speed);
// Before the rows of a substep, once impacts are done: how fast points that carry nothing will meet. `held`: what they
// carried in the substep before.
void foresee_meetings(SolverBodies& bodies, const ContactRecord* records, WatchedContact& contact, const float held[4],
                      float least_speed, float h);
// After the rows of a substep, whose impulses at the points are given: sums up, and takes for met what was foreseen
// and carries something now. `last`: substep of the step.
void note_impulses(SolverBodies& bodies, const ContactRecord* records, WatchedContact& contact, const float impulses[4],
                   float h, bool last);
// An impact of a watched contact.
void note_impact(WatchedContact& contact, float speed, float impulse, Vec3 normal, Vec3 place);

}  // namespace lendulet
