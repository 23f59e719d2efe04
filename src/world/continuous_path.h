// How bodies moved within a step, as continuous collision sees it: evenly, while they turned evenly about one axis.
#pragma once

#include "collision/query/cast.h"
#include "world/world_data.h"

namespace lendulet {

// Whether the body is not among the packed ones of this step.
bool is_still(const WorldData& world, uint32_t body);
// Where the arrays of ContinuousData hold a packed body.
size_t place_of(const WorldData& world, uint32_t body);

BodyPath path_of(const WorldData& world, uint32_t body, float dt);
// The pose of a body along its path, t from 0 to 1.
Pose pose_at(const BodyPath& path, double t);
// The path of one of the body's shapes, relative to `origin`.
Motion motion_of(const WorldData& world, uint32_t collider, const BodyPath& path, Position origin);

// How far any point of the body moved, at most, m.
float reach_of(const BodyPath& path, float radius);
// What reach_of() is at most, in a fraction of the time.
float most_reach_of(const WorldData& world, uint32_t body, float dt);

Carrier carrier_of(const WorldData& world, uint32_t body, const BodyPath& path);
// How far any point of `body` moved at most as another one saw it, m: a body that goes along with a great drum hardly
// moves against its wall, however fast both are.
float most_reach_against(const WorldData& world, uint32_t body, const Carrier& carrier, float dt);

}  // namespace lendulet
