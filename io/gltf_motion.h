// `motion` of KHR_physics_rigid_bodies: mass, centre, inertia, velocities.
#pragma once

#include "io/gltf_nodes.h"
#include "io/gltf_shapes.h"
#include "lendulet/body.h"

namespace lendulet {

// Fills in everything of a moving body but its colliders and its name. Velocities are given along the node's axes; the
// centre of mass is a point in the node's space, so the node's scale moves it. A mass or moment of 0 means infinity.
void read_motion(const Field& motion, const NodeFrame& frame, const std::string& where, RigidBodyDef& def,
                 Warnings& warnings);

}  // namespace lendulet
