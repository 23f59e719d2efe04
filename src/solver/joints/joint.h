// A joint as the solver sees it: 192 bytes in quads, so that wide kernels load it by transposes. The world fills it
// when a set of joints starts to be solved and keeps it while the set stays the same; the solver reads it into rows and
// writes impulses back after every step.
//
// Which rows a joint has is its class. Locked rows (three linear ones at the anchor, or two across a slider's axis, and
// up to three angular ones) are solved together, directly; then bounded rows (a hinge's angle or slider's travel with
// limit, motor and spring, or a ball joint's swing and twist) with the locked ones held. What a joint does not use has
// no place in its row: a hinge is free, limited or driven, each a class of its own; a ball joint with friction resists
// turning about all axes before its limits are looked at. A six-degree joint, of which a
// distance joint is a case, has all rows that there can be; which of them act is data, in a second record.
#pragma once

#include <cstdint>

namespace lendulet {

enum class JointClass : int32_t {
    ball,
    limited_ball,
    rubbing_ball,
    hinge,
    limited_hinge,
    driven_hinge,
    slider,
    driven_slider,
    fixed,
    six_degrees
};
inline constexpr int joint_classes = 10;

inline constexpr float unlimited = 1e30f;  // bound of a coordinate that has none; large, but finite in sums

// The joint frame's x axis is the axis of hinges and sliders and the twist axis of ball joints. Sides whose body is not
// packed (static_body) are given in the world: the anchor as a position, the frame as a rotation.
struct alignas(64) JointRecord {
    float arm_a[3];        // anchor from A's centre of mass, in A's principal frame, m
    float swing_limit;     // ball joints: half angle of the cone, rad
    float arm_b[3];        // the same for B
    float motor_velocity;  // target, m/s or rad/s
    float frame_a[4];      // rotation from the joint frame to A's principal frame
    float frame_b[4];
    float motor_force;       // largest, N or N m; a ball joint's friction
    float relaxation;        // share of its solution that a joint takes in a pass, 0 .. 1; set by the solver
    float lower, upper;      // bounds of angle, travel or twist; +-unlimited where there are none
    int32_t body_a, body_b;  // solver bodies; at least one is moved by constraints
    JointClass type;
    uint16_t flags, old_flags;  // joint_split and its like, of this step and the one before; set by the solver
    float stiffness, damping, target, spring_force;  // spring_force: largest, N or N m
    float linear[3], limit_0;   // impulses on B: locked linear rows; limit, or a ball joint's swing
    float angular[3], limit_1;  // locked angular rows, or a ball joint's friction along world axes; its twist limit
    float motor, spring;
    int32_t axes;  // six_degrees: its JointAxesRecord
    float unused1;
    float impulse[3], unused2;          // result: all of it on B in the whole step, world axes, N s ...
    float angular_impulse[3], unused3;  // ... and N m s, about the anchor
};
static_assert(sizeof(JointRecord) == 192);

// One bounded coordinate of a six-degree joint, and its impulses in the last substep.
struct JointAxisRecord {
    float lower, upper;  // +-unlimited where there are none
    // Where they are not 0, a bound gives way as a spring and damper instead of being hard; N/m or N m/rad.
    float limit_stiffness, limit_damping;
    float motor_velocity, motor_force;
    float stiffness, damping, target, target_velocity, spring_force;
    float limit, motor, spring;  // impulses on B
};

// Bounded rows of a six-degree joint: travel along x, y, z of the frame on A, turning about them, and a distance within
// the plane or space of several axes, an angle about several.
inline constexpr int joint_axes = 8;
inline constexpr int distance_row = 6, swing_row = 7;
struct JointAxesRecord {
    JointAxisRecord axis[joint_axes];
    float held_at[6];                   // coordinates of locked axes
    uint8_t locked;                     // bits of the axes that are locked
    uint8_t used;                       // bits of the rows that have anything to do
    uint8_t distance_axes, swing_axes;  // bits of the axes that those two rows are about: two or three
};

// Nothing but joints constrains the two bodies' group: see passes.inl.
inline constexpr uint16_t joint_split = 1;
// Neither body has another joint: one sweep solves it exactly, so it needs no softness.
inline constexpr uint16_t joint_alone = 2;
// The joint has been through a step: the other two bits tell of it.
inline constexpr uint16_t joint_stepped = 4;

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
