// Reading a joint description of KHR_physics_rigid_bodies, a set of limits and drives on six axes, as the joint type of
// the engine that has just its freedoms, or else as a six-degree joint.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/json_field.h"
#include "lendulet/joint.h"

namespace lendulet {

// A drive along or about an axis. In acceleration mode stiffness and damping are per unit of the mass or inertia that
// the axis moves.
struct JointDrive {
    int axis = 0;  // of the description: 0 .. 2 along, 3 .. 5 about x, y, z
    float stiffness = 0.0f, damping = 0.0f, position = 0.0f, velocity = 0.0f;
    float max_force = std::numeric_limits<float>::infinity();
    bool acceleration = false;
};

// What a description amounts to.
struct JointKind {
    JointType type = JointType::fixed;
    int axis = 0;                    // the axis of hinge and slider, the twist axis of a ball joint: 0 x, 1 y, 2 z
    Limit limit;                     // hinge, slider
    float swing_limit = 4.0f;        // ball
    Limit twist_limit;               // ball
    Spring spring;                   // hinge, slider: a soft lock of the free axis
    Vec3 offset;                     // where a linear axis is locked away from 0: B's origin in A's frame, m
    SixDegrees axes;                 // six_degrees, in the axes of the description
    std::vector<JointDrive> drives;  // those on axes that are not locked, one an axis
    std::vector<std::string> approximations;  // what is not simulated quite as described
};

// The joint of that description; nothing where no joint type has its freedoms, with the reason in `why`.
std::optional<JointKind> joint_kind(const Field& description, std::string& why);

}  // namespace lendulet
