// Scenes from glTF 2.0 files (.gltf, .glb) with KHR_implicit_shapes and KHR_physics_rigid_bodies.
//
// Nodes with `motion` become bodies with all colliders below them, other colliders static bodies of their own, in the
// order in which the scene's tree lists them; a body bears its node's name, and its pose is the node's world transform.
// Scale is worked into shapes. Gravity is 9.81 m/s^2 along -y. What a scene asks for and the engine does not do is
// named in Scene::warnings: animations, skins, joints without a joint type of their own, stretched spheres.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace lendulet {

// The scene in the file `path`. Errors: io (not readable, larger than 256 MB, buffers missing), parse (not glTF 2.0, or
// anything in it malformed or out of range), and those of World::add_*; the sentence names file and place.
Result<Scene> load_gltf(const std::string& path, const Configure& configure = {});

// The same from the bytes of a file; `directory` is where buffers beside it are looked for, `name` the scene's name.
Result<Scene> load_gltf_bytes(std::string bytes, const std::string& directory, const std::string& name,
                              const Configure& configure = {});

// The files beside the glTF file `path` to which it refers, buffers and pictures: as it names them, and their paths.
// What is embedded, absolute or outside of its directory is left out, and so is everything of a file that is none.
std::vector<std::pair<std::string, std::string>> files_of_gltf(const std::string& path);

}  // namespace lendulet
