// A contact manifold as it lives from step to step: 192 bytes in quads, so that wide kernels load and store it by
// transposes. The narrow phase fills it, the solver reads it into rows and writes impulses back.
#pragma once

#include <cstdint>

namespace lendulet {

inline constexpr float far_separation = 1e9f;  // of points that are not there: never pushes, and 0 * it is 0

// What a contact or a soft joint holds may change its bodies' velocities by at most this much in a substep, m/s at the
// point and rad/s of a body; what is beyond is let go. At 480 substeps a second that is 4900 times the weight. Where
// what cannot give way presses a body between a joint and a floor, each would hold ever more against the other, and
// with it grows what it gives up in a substep and what a turning arm makes of it: bodies left such a press at 10 km/s.
inline constexpr float most_held_speed = 100.0f, most_held_spin = 500.0f;

struct ContactPointRecord {
    float position[3];  // half way between the surfaces, from A's centre of mass, world axes, m
    float separation;   // m, negative = overlap
};

struct alignas(64) ContactRecord {
    float normal[3];  // unit, from A to B
    float static_friction;
    float normal_impulse[4];    // of the last substep, N s
    float friction_impulse[3];  // on B at the centre of the points, world axes, N s
    float twist_impulse;        // on B about the normal, N m s
    int32_t body_a, body_b;     // solver bodies; where only one of them is moved by constraints, it is B
    int32_t point_count;
    float dynamic_friction;
    ContactPointRecord points[4];
    float radius_a, radius_b;  // sweep radii of the surfaces at the points, see Manifold
    float follow;              // on which body the points ride, see Manifold
    float restitution;
    float arm_offset[3];     // B's centre of mass minus A's, m
    float separation_speed;  // fastest that overlap is undone, m/s
    uint32_t id[4];          // feature names of the points
    uint32_t key;            // name among the manifolds of the pair
    int32_t triangle;
    uint32_t flags;
    uint32_t pair;  // number of the pair
};
static_assert(sizeof(ContactRecord) == 192);

inline constexpr uint32_t contact_flipped = 1;  // A and B are exchanged against the order of the two colliders
inline constexpr uint32_t contact_rolls = 2;    // it resists rolling or spinning, or its surfaces run: see ContactExtra
inline constexpr uint32_t contact_sharp = 8;    // neither shape is round anywhere: corners meet faces
inline constexpr uint32_t contact_balls = 16;   // of two balls: its normal is the line between their centres
inline constexpr uint32_t contact_swift = 32;   // in a substep an arm grows by much of a body's size, see impacts.h
inline constexpr uint32_t contact_passes = 64;  // met only if something else changes how the bodies move in this step
inline constexpr uint32_t contact_crowded = 128;  // see ContactEnds; of those that bounce

// What it takes to schedule a contact, so that those who go through all of them, one by one, need not read the records.
struct ContactEnds {
    int32_t a, b;  // solver bodies; see ContactRecord
    uint8_t kind;  // see contact_kind()
    bool fixed_a;  // A is not moved by constraints
    bool bounces;  // with a restitution
    bool held;     // all of its points carried something in the last step
    bool crowded;  // bounces among so many others that blows are not followed from body to body
    bool idle;     // held nothing in the last step
    bool passes;   // gets no row: it is left to impacts, see contact_passes
};

// What few contacts have, by record, where any material of the world has it.
struct ContactExtra {
    float rolling, spinning;       // greatest torque per normal force against rolling and about the normal, m
    float tangential_restitution;  // share of the slip at an impact that turns round, 0 .. 1
    float running[3];              // of the surfaces over their bodies, B's less A's, in the contact's plane, m/s
    float impulse[3];              // the result: against turning, on B in the last substep, world axes, N m s
    float h;                       // that substep, s
    uint32_t pair, key;            // the manifold that the impulse is of, ...
    uint32_t step;                 // ... and in which step it was
};

}  // namespace lendulet
