// From joints to the solver's records, and impulses back.
#pragma once

#include "world/world_data.h"

namespace lendulet {

// Whether the joint is solved as one of those whose rows are data: distance and six-degree joints, and hinges and
// sliders that only a damper towards a velocity drives.
bool rows_are_data(const JointInfo& j);
JointAxesInfo rows_of(const JointDef& def);
// The definition of a six-degree joint with these rows.
SixDegrees coordinates_of(const JointAxesInfo& rows);
// The row of the coordinate that a hinge, slider or distance joint has.
int driven_row(JointType type);

// The rows for the solver, with their impulses times `scale`.
JointAxesRecord axes_record(const JointAxesInfo& given, float scale);

// Takes impulses from the records, which are to be made anew.
void drop_joint_records(WorldData& world);

}  // namespace lendulet
