// A joint as the solver sees it for one step: 256 bytes in quads, so that wide kernels load it by transposes. The world
// fills it, the solver reads it into rows and writes impulses back.
//
// Which rows a joint has is its class. Locked rows (three linear ones at the anchor, or two across a slider's axis, and
// up to three angular ones) are solved together, directly; then bounded rows (a hinge's angle or slider's travel with
// limit, motor and spring, or a ball joint's swing and twist) with the locked ones held.
#pragma once

#include <cstdint>

namespace lendulet {

enum class JointClass : int32_t { ball, limited_ball, hinge, driven_hinge, slider, fixed };
inline constexpr int joint_classes = 6;

inline constexpr float unlimited = 1e30f;  // bound of a coordinate that has none; large, but finite in sums

// The joint frame's x axis is the axis of hinges and sliders and the twist axis of ball joints. "Side" impulses come in
// two sets: [0] of the biased pass, [1] of the relax pass.
struct alignas(64) JointRecord {
    float arm_a[3];        // anchor from A's centre of mass, in A's principal frame, m
    float swing_limit;     // ball joints: half angle of the cone, rad
    float arm_b[3];        // the same for B
    float motor_velocity;  // target, m/s or rad/s
    float frame_a[4];      // rotation from the joint frame to A's principal frame
    float frame_b[4];
    float offset[3];         // B's centre of mass minus A's at the start of the step, world axes, m
    float motor_force;       // largest, N or N m
    int32_t body_a, body_b;  // solver bodies; at least one is moved by constraints
    JointClass type;
    uint32_t flags;      // joint_split and joint_alone, set by the solver
    float lower, upper;  // bounds of angle, travel or twist; +-unlimited where there are none
    float relaxation;    // share of its solution that a joint takes in a pass, 0 .. 1; set by the solver
    float unused1;
    float stiffness, damping, target, spring_force;  // spring_force: largest, N or N m
    float linear_0[3], limit_0;   // impulses on B: locked linear rows; limit, or a ball joint's swing
    float angular_0[3], limit_1;  // locked angular rows; a ball joint's twist limit
    float linear_1[3], motor_0;   // as linear_0, angular_0, of the relax pass; motor in both passes
    float angular_1[3], motor_1;
    float spring;
    uint32_t old_flags;  // flags under which the impulses above were found
    float unused2, unused3;
    float impulse[3];  // result: all of it on B in the last substep, world axes, N s ...
    float unused4;
    float angular_impulse[3];  // ... and N m s, about the anchor
    float unused5;
    float unused6[4];
};
static_assert(sizeof(JointRecord) == 256);

// Applied forces act half before and half after the drift, because nothing but joints constrains the two bodies' group.
inline constexpr uint32_t joint_split = 1;
// Neither body has another joint: one sweep solves it exactly, so it needs no softness.
inline constexpr uint32_t joint_alone = 2;

// Where joints share bodies, a sweep leaves slow modes unsolved; as for contacts these must be damped by giving up a
// share of the impulse in every biased pass, with `bias` the share of the gap that is undone. See docs/solver.md.
inline constexpr float joint_bias = 0.2f;
inline constexpr float joint_leak = 0.1f;
// A sweep over joints with cycles through one body may overshoot, and impulses kept from substep to substep then grow.
// Joints of a body with more joints than this take smaller shares of their solution: with 40 long-armed joints on a
// light body full shares blow up within ten steps.
inline constexpr float joint_crowd = 4.0f;
// Fastest that a gap is closed, and that the motion's curvature is met in advance, m/s or rad/s.
inline constexpr float joint_push_speed = 10.0f;

}  // namespace lendulet
