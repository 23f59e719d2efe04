// Impacts at their time: bounces, and contacts of bodies so fast that rows of a whole substep cannot follow
// (contact_swift). Runs before each substep over the manifolds of these.
#pragma once

#include <cstdint>

#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/kernels.h"
#include "solver/watch.h"

namespace lendulet {

// What it takes to tell, without reading records, that a contact meets nothing in a substep: most do not.
struct alignas(64) BouncingContact {
    explicit BouncingContact(uint32_t of_record) : record(of_record) {}

    uint32_t record;
    int32_t a = -1, b = -1;                // bodies; -1: not prepared yet
    float gap = 0.0f;                      // least separation of its points at the start of the step, m
    float normal[3] = {};                  // or the way between the centres of two balls, m
    float radii = 0.0f;                    // of two balls, m; 0: others
    float reach_a = 0.0f, reach_b = 0.0f;  // how far the points are from the axes about which they turn, m
    float pull = 0.0f;                     // the bodies' accelerations, m/s^2
    float pull_a = 0.0f, pull_b = 0.0f;    // and by how much turning accelerates them: times the square of w, m
    float face_a = 0.0f, face_b = 0.0f;    // 1 where the normal turns with this body
    float span = 0.0f;                     // largest separation, m
};
static_assert(sizeof(BouncingContact) == 64);

// Its bodies; whether it passes (contact_passes): then nothing comes of it while both move as the step began; whether
// all of its points carried something then: these meet nothing before one of the bodies is struck; and whether it is
// one of a crowd, in which blows go on by rows.
struct ImpactEnds {
    int32_t a, b;
    bool passes, held, crowded;
};

// Contacts that can bounce or are swift, in order.
struct BouncingList {
    BouncingContact* list;
    const ImpactEnds* ends;
    int count;
    const ContactExtra* extras;  // what some have beside, by record; null where none has
    uint8_t* disturbed;          // by body: 1 where it no longer moves as the step began; null where no contact passes
    WatchList watched{};         // contacts whose impacts are noted
};

// Fills in all but `record`, which is given; once bodies are in their blocks.
void prepare_bouncing(const SolverBodies& bodies, const ContactRecord* records, BouncingContact& contact);

// Marks bodies of the range that constraints have moved since the last substep began; before its kick.
void mark_disturbed(const SolverBodies& bodies, BodyRange range, uint8_t* disturbed);

// What rows do for other contacts: leaves the separations that a contact without one has after the step.
void follow_passing(const SolverBodies& bodies, ContactRecord& record);

// Finds the points that in this substep, the given one of the step, will meet faster than k.bounce_speed, gives both
// bodies Newton's impulse with Coulomb friction on the whole of it (restitution included; with tangential restitution
// it may turn the slip round), and shifts them so that it acted at the time of impact. Sweeps over the list until no
// point approaches, at most 8 times, so that impulses travel through touching bodies one by one, as in a cradle.
// Returns whether any body was displaced.
bool resolve_impacts(SolverBodies& bodies, const ContactRecord* records, BouncingList bouncing,
                     const SubstepConstants& k, int substep);

}  // namespace lendulet
