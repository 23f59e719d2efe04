// Checks of joints' definitions at the door.
#pragma once

#include <string>

#include "lendulet/joint.h"
#include "world/world_data.h"

namespace lendulet {

// The message of a refusal, with the call in front.
Error refused_joint(ErrorCode code, const char* call, std::string what);
// Both alive, not the same, and at least one of them dynamic.
Status check_bodies(const WorldData& world, BodyId a, BodyId b, const char* call);
// Finite, no farther than a world is wide, with a rotation, which is normalised.
Result<Transform> check_frame(const Transform& frame, const char* name, const char* call);
Status check_motor(const Motor& motor, const char* call);
// `turns`: of an angle, else of a length.
Status check_spring(const Spring& spring, bool turns, const char* call);
Status check_joint_friction(float friction, const char* call);
// The limits, motors and springs that joints of that type read.
Status check_rows(const JointDef& def, const char* call);

}  // namespace lendulet
