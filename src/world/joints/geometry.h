// Where a joint's two frames are, and the coordinates that follow: what the solver computes for its rows, in the words
// of the world.
#pragma once

#include "world/world_data.h"

namespace lendulet {

struct JointPose {
    Pose a, b;  // the joint frame on each body, in the world
};
inline JointPose joint_pose(const WorldData& world, const JointInfo& j) {
    return {world.bodies.pose[j.body_a] * j.frame_a, world.bodies.pose[j.body_b] * j.frame_b};
}

// Rotation from frame A to frame B as the shorter turn.
inline Quat relative_rotation(const JointPose& p) {
    Quat q = conjugate(p.a.orientation) * p.b.orientation;
    return q.w < 0.0f ? Quat{-q.x, -q.y, -q.z, -q.w} : q;
}

// All coordinates of a joint whose rows are data, and their rates; see SixDegrees and solver/joints/six_degrees.inl.
struct JointCoordinates {
    float value[joint_coordinates]{}, rate[joint_coordinates]{};
};
JointCoordinates joint_coordinates_of(const WorldData& world, const JointInfo& j, const JointAxesInfo& axes);

// Velocity of a body at a point of the world.
Vec3 velocity_at(const WorldData& world, uint32_t body, Position point);

}  // namespace lendulet
