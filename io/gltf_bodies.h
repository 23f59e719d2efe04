// From nodes to bodies: nodes with `motion` become bodies that move, with all colliders below them; other nodes with a
// collider become static bodies, one each.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/gltf_container.h"
#include "io/gltf_nodes.h"
#include "io/gltf_shapes.h"
#include "lendulet/world.h"

namespace lendulet {

struct GltfBodies {
    std::vector<BodyId> of_node;  // the body that a node itself became; null for other nodes
    std::vector<std::pair<ColliderId, std::string>> collider_names;  // where they differ from their body's name
};

// Adds all bodies of the scene to `world`, in the order of the node tree. Throws LoadFailure.
GltfBodies add_bodies(World& world, const GltfContainer& container, const NodeTree& tree, Warnings& warnings);

// Adds all joints that one of the engine's joint types describes; others are named in a warning. Throws LoadFailure.
void add_joints(World& world, const GltfContainer& container, const NodeTree& tree, const GltfBodies& bodies,
                Warnings& warnings);

}  // namespace lendulet
