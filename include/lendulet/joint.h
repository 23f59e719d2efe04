// Joints between two bodies. A joint is six rows in a frame fixed to body A: three along its axes (linear) and three
// about them (angular); each row is free, locked, limited, driven or sprung. Ball, hinge, slider and fixed joints are
// this one joint with the usual rows locked; with six_degrees they are given one by one.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "lendulet/body.h"

namespace lendulet {

// Bounds of a joint coordinate, in m or rad; lower > upper means free, lower == upper locked. Angles lie within one
// turn of 0; lengths are refused where the whole world, 4e7 m across, is out of bounds.
struct Limit {
    float lower = 1.0f, upper = -1.0f;
    constexpr bool free() const { return lower > upper; }
    constexpr bool locked() const { return lower == upper; }
};

// Drives a joint coordinate to a velocity with at most the given force.
struct Motor {
    float target_velocity = 0.0f;  // m/s or rad/s
    float max_force = 0.0f;        // N or N m; 0: no motor
};

// Pulls a joint coordinate to a target as a damped spring: force = -stiffness (x - target) - damping (x' -
// target_velocity), at most max_force.
struct Spring {
    float stiffness = 0.0f;  // N/m or N m/rad; 0: no spring
    float damping = 0.0f;    // N s/m or N m s/rad
    float target = 0.0f;     // m, within 4e7, or rad, within one turn of 0
    float max_force = std::numeric_limits<float>::infinity();
    float target_velocity = 0.0f;  // m/s or rad/s
};

enum class JointType : uint8_t { fixed, ball, hinge, slider, distance, six_degrees };

// One coordinate of a six-degree joint: free unless it has bounds, and driven by motor and spring. Equal bounds lock
// it.
struct JointAxis {
    Limit limit{};
    Motor motor{};
    Spring spring{};
    // Where the stiffness is not 0 the bounds give way: beyond them a spring (N/m or N m/rad) with damping (N s/m or
    // N m s/rad) pushes back, which never pulls outward.
    float limit_stiffness = 0.0f, limit_damping = 0.0f;
    // Dry friction: while no motor drives the coordinate, its rate meets a force of at most this, N or N m, >= 0.
    float friction = 0.0f;
};

// The coordinates of a six-degree joint. Place and turn of B's frame are measured in A's: the place of its origin along
// x, y, z (m), and the turn about each of them, 2 atan(q_i / q_w) in (-pi, pi] rad with q the rotation from A's frame
// to B's. That is the angle of a hinge where the other two are locked, and the twist of a ball joint where they are
// free. With a static body as A this keeps a body from moving along or turning about axes of the world: a world in a
// plane locks z and the turns about x and y. Two more are about several axes at once: the distance of the origins
// within the plane or space of the axes named, and the angle between the frames' third axes (two axes named) or the
// whole turn (three), in [0, pi].
struct SixDegrees {
    JointAxis linear[3], angular[3];
    JointAxis distance, swing;
    bool distance_axes[3] = {}, swing_axes[3] = {};  // two or three of each where it is used, else none
};
// Places of the coordinates in World::set_motor, World::set_spring and JointState.
enum class Coordinate : uint8_t { x, y, z, about_x, about_y, about_z, distance, swing };
inline constexpr int joint_coordinates = 8;

// Common to every joint: the two bodies and the joint's frame on each. The frames' x axis is the axis of hinges and
// sliders and the twist axis of ball joints. Use the joint_at helper to give one frame in the world instead.
struct JointDef {
    JointType type = JointType::fixed;
    BodyId body_a{}, body_b{};       // not both static; A may be static or kinematic, or B
    Transform frame_a{}, frame_b{};  // joint frame in each body's frame, within 4e7 m
    // hinge: angle about x, rad in (-pi, pi]; slider: travel along x, m; distance: of the two frames' origins, m, where
    // {0, l} is a rope, {l, l} a rod and a spring alone a spring; others: ignored
    Limit limit{};
    Motor motor{};    // hinge, slider and distance
    Spring spring{};  // hinge, slider and distance
    // Dry friction in the joint, >= 0: what its motion meets at most, N m for hinges and balls, N for sliders and
    // distances; infinity holds it like a brake. It keeps still what less would move. A ball joint's acts about all
    // axes at once, against the turning of its bodies to each other. A motor takes its place while it has a force.
    float friction = 0.0f;
    // ball: half angle of the cone in which B's x axis stays about A's, rad; > pi: free
    float swing_limit = 4.0f;
    Limit twist_limit{};             // ball: turn of B about the x axis, rad
    SixDegrees axes{};               // six_degrees
    bool collide_connected = false;  // whether the two bodies' colliders still meet
    // A joint whose force or torque (JointState) exceeds these in a step is removed at its end, and
    // World::joint_breaks() tells so; N and N m, > 0, infinity: never.
    float break_force = std::numeric_limits<float>::infinity(), break_torque = std::numeric_limits<float>::infinity();
    uint64_t user_data = 0;
    std::string_view name{};
};

// What a joint does at present.
struct JointState {
    JointType type;
    BodyId body_a, body_b;
    float position = 0.0f;       // hinge: angle, rad; slider: travel, m; distance: distance, m
    float velocity = 0.0f;       // rad/s or m/s
    Vec3 linear_error;           // gap of the locked linear rows, world axes, m
    float angular_error = 0.0f;  // rad
    Vec3 force, torque;          // mean over the last step on body B at the anchor, world axes, N and N m
    // six_degrees: all coordinates and their rates, those of distance and swing where they are used; else zero
    float coordinates[joint_coordinates]{}, rates[joint_coordinates]{};
};

}  // namespace lendulet
