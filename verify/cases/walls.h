// Thin obstacles: a box, a closed surface of triangles in its place, or a single sheet of them.
#pragma once

#include "verify/case.h"

namespace lendulet::verify {

enum class Wall { box, closed_mesh, sheet };
inline constexpr Wall walls[] = {Wall::box, Wall::closed_mesh, Wall::sheet};

// `half` extents; a sheet has no thickness and lies in x = 0. Meshes have 6 x 6 cells a side.
Shape wall_shape(Wall wall, Vec3 half);

// A ball of 5 cm at `speed` towards a wall across x = 0 of the frame, hitting it at an angle; `phase` (0 .. 1) moves
// the impact within its step. True where it never came to the other side.
struct Shot {
    Wall wall;
    float thickness, speed, phase;
    int solver_steps;
    float dt;
};
bool held_by_wall(const Frame& frame, const Shot& shot);

}  // namespace lendulet::verify
