// Joints between two bodies. A joint is six rows in a frame fixed to body A: three along its axes (linear) and three
// about them (angular); each row is free, locked, limited, driven or sprung. Ball, hinge, slider and fixed joints are
// this one joint with the usual rows locked.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "lendulet/body.h"

namespace lendulet {

// Bounds of a joint coordinate, in m or rad; lower > upper means free, lower == upper locked.
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

// Pulls a joint coordinate to a target as a damped spring: force = -stiffness (x - target) - damping x'.
struct Spring {
    float stiffness = 0.0f;  // N/m or N m/rad; 0: no spring
    float damping = 0.0f;    // N s/m or N m s/rad
    float target = 0.0f;     // m or rad
    float max_force = std::numeric_limits<float>::infinity();
};

enum class JointType : uint8_t { fixed, ball, hinge, slider };

// Common to every joint: the two bodies and the joint's frame on each. The frames' x axis is the axis of hinges and
// sliders and the twist axis of ball joints. Use the joint_at helper to give one frame in the world instead.
struct JointDef {
    JointType type = JointType::fixed;
    BodyId body_a{}, body_b{};       // not both static; A may be static or kinematic, or B
    Transform frame_a{}, frame_b{};  // joint frame in each body's frame
    // hinge: angle about x, rad in (-pi, pi]; slider: travel along x, m; others: ignored
    Limit limit{};
    Motor motor{};    // hinge and slider
    Spring spring{};  // hinge and slider
    // ball: half angle of the cone in which B's x axis stays about A's, rad; > pi: free
    float swing_limit = 4.0f;
    Limit twist_limit{};             // ball: turn of B about the x axis, rad
    bool collide_connected = false;  // whether the two bodies' colliders still meet
    uint64_t user_data = 0;
    std::string_view name{};
};

// What a joint does at present.
struct JointState {
    JointType type;
    BodyId body_a, body_b;
    float position = 0.0f;       // hinge: angle, rad; slider: travel, m
    float velocity = 0.0f;       // rad/s or m/s
    Vec3 linear_error;           // gap of the locked linear rows, world axes, m
    float angular_error = 0.0f;  // rad
    Vec3 force, torque;          // mean over the last substep on body B at the anchor, world axes, N and N m
};

}  // namespace lendulet
