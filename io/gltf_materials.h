// Physics materials and collision filters of KHR_physics_rigid_bodies.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/gltf_shapes.h"
#include "io/json_field.h"
#include "lendulet/body.h"

namespace lendulet {

// All materials of the file, in order.
std::vector<Material> read_materials(const Field& list, Warnings& warnings);

// All collision filters of the file, in order. Each name of a collision system gets a bit. A collider is in all systems
// it lists, and it meets those of whose systems it may meet at least one, both ways round. (The specification's formula
// asks that all systems be allowed; its other sentences, its sample files and the implementation of its authors take
// one, without which the floor of Filtering.glb would hold nothing.)
std::vector<CollisionFilter> read_filters(const Field& list, Warnings& warnings);

}  // namespace lendulet
