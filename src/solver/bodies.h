// The bodies of one step as the solver sees them: awake bodies only, packed without holes, split by who reads what.
//
// BodyState is one cache line and all that constraint rows touch besides inertia; rows gather and scatter it by
// transposing quads (hardware gather and component arrays were both slower). BodyMotion is what is packed before
// the step and unpacked after it; BodyBlock is what the integrator works on.
//
// The first `reserved_bodies` entries are at rest with infinite mass: they stand for every static body and for the
// empty lanes of a partly filled block, so kernels need no branches.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace lendulet {

inline constexpr int reserved_bodies = 16;
inline constexpr int static_body = 8;  // the reserved entry that contacts with static bodies name; never stored to

struct alignas(64) BodyState {
    float v[3];          // change of the velocity since the start of the step, m/s
    float inverse_mass;  // 0: not moved by constraints
    float w[3];          // change of the angular velocity, world axes, rad/s
    float drift_x;       // how far the last drift moved the body, until the kick; the rest is in BodyInertia
    float dp[3];         // displacement since the start of the step, m
    float gyro_z;        // see BodyInertia
    float dq[4];         // rotation since the start of the step
};

// Velocities at the start of the step: they stay while it runs. Rows work on changes, so that what contacts add and
// take away again in every substep is not rounded to the precision of a large velocity.
struct alignas(32) BodyStart {
    float v[3];
    int32_t struck;  // in which sweep over the impacts of the step last; those alone write it
    float w[3], unused1;
};

// World inverse inertia of this substep: xx yy zz xy xz yz.
struct alignas(32) BodyInertia {
    float inverse[6];
    // From drift to kick how far the drift moved the body along y and z, m; where there are joints, from kick to drift
    // the angular acceleration by the body's own spin, rad/s^2.
    float gyro_x, gyro_y;
};

// Centre of mass at the start of the step, m, and what rounding took from it.
struct alignas(32) BodyPlace {
    float x[3], unused0;
    float x_low[3], unused1;
};

// What a body brings into the step and, of L and the changes, what it takes out of it.
struct alignas(64) BodyMotion {
    float q0[4];               // orientation of the principal axes at the start of the step
    float inertia[3];          // principal, kg m^2; 0 for kinematic bodies
    float linear_loss;         // 1 - exp(-damping h)
    float inverse_inertia[3];  // principal
    float angular_loss;
    float angular_momentum[3];  // L, world axes
    float anisotropy;           // largest over smallest principal moment; 1: turns about a fixed axis
    float acceleration[3];      // gravity and applied forces over the substep, damping included
    float free;  // 1: no constraint acts on this body in this step; -1: ones to other moving bodies, -2: and others
    float torque[3];             // applied, world axes, damping included
    float joints;                // 0: has none; joints_touching and its like below. Set by the solver
    float change_v[3], unused1;  // how the last substep changed velocity and L: the acceleration the drift expects
    float change_L[3], unused2;
};

// As BodyMotion::joints: the group that joints connect touches something, or nothing, by which its kick is split. Added
// to either in the step in which that changes.
inline constexpr float joints_touching = 1.0f, joints_split = 2.0f, joints_change = 0.25f;

// Sixteen bodies as kick and drift see them, component by component: read and written front to back twice a substep,
// never gathered, so lanes need no transposing. Begun from BodyMotion before the first substep.
inline constexpr int block_bodies = 16;
struct alignas(64) BodyBlock {
    using Lanes = float[block_bodies];
    Lanes q0[4], inertia[3], inverse_inertia[3];
    Lanes acceleration[3], torque[3];
    Lanes start_v[3], start_w[3];
    Lanes linear_loss, angular_loss, anisotropy, free, joints;
    Lanes L[3], L_low[3];      // and what rounding added to L in this step
    Lanes v_ref[3], w_ref[3];  // velocities as the running pass of constraints found them
    // What constraints added to v and L since the last kick: the next substep's warm start.
    Lanes dv[3], dL[3];
    Lanes v_start[3], L_start[3];    // velocity and L at the start of the substep ...
    Lanes change_v[3], change_L[3];  // ... and how the substep before changed them
};
static_assert(sizeof(BodyState) == 64 && sizeof(BodyInertia) == 32 && sizeof(BodyMotion) == 128);

// Bodies [begin, end), both multiples of block_bodies.
struct BodyRange {
    int begin, end;
};

struct SolverBodies {
    Array<BodyState> state;
    Array<BodyInertia> inertia;
    Array<BodyStart> start;
    Array<BodyMotion> motion;
    Array<BodyPlace> place;
    Array<BodyBlock> blocks;
    int count = 0;  // with the reserved ones; arrays are padded to a multiple of 16

    explicit SolverBodies(const Memory* memory)
        : state(memory), inertia(memory), start(memory), motion(memory), place(memory), blocks(memory) {}
    // Makes room for `moving` bodies and sets the reserved and padding entries.
    void reset(int moving);
    // Takes memory for so many entries.
    void make_ready(size_t entries);
    // Makes an entry that is part of no constraint.
    void set_at_rest(int body);
};

}  // namespace lendulet
