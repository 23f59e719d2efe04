// What is done to a world by hand, as the viewer says it over a stream and in repro files: an object with a member
// "do".
//
//   {"do": "sphere", radius, at, velocity, density}
//   {"do": "box", half, at, velocity, density}
//   {"do": "shape", type, size, rounding, at, velocity, density}: LENDULET_CAPSULE and following, without a mesh
//   {"do": "grab", body, point}, {"do": "drag", target}, {"do": "release"}
//   {"do": "set", settings that change, by the names of the page's Settings}
//
// Lengths in m, velocities in m/s, densities in kg/m^3; bodies by their index.
#pragma once

#include "apps/lendulet/view/request.h"

namespace lendulet::cli {

// Throws Asked::Refused, with nothing changed.
void change(lendulet_world& world, const Asked& command);

// The body of an index, 0 where there is none.
lendulet_body body_at(lendulet_world& world, int index);

}  // namespace lendulet::cli
