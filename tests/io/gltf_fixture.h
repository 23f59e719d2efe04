// What the tests of the glTF loader share: our scene files, small files written in place, and bodies by name.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "io/gltf.h"

namespace lendulet::test {

// The tests run in the repository's root.
inline std::string scene_file(const std::string& name) { return "scenes/files/" + name; }

// A scene that must load; ends the test program with the error's sentence where it does not.
inline Scene load(const std::string& path) { return load_gltf(path).value(); }
inline Scene load_text(const std::string& json) { return load_gltf_bytes(json, "", "test.gltf").value(); }

// A file with the given nodes, all of them roots, and the given document extensions. Single quotes stand for double
// ones.
std::string gltf_text(const std::string& nodes, const std::string& shapes = "", const std::string& physics = "");

// The body of that name; null where there is none.
BodyId find_body(const World& world, std::string_view name);
inline const RigidBodyRef moving(const World& world, std::string_view name) {
    return world.get(find_body(world, name));
}
inline StaticBodyRef any_body(const World& world, std::string_view name) {
    return world.get_static(find_body(world, name));
}

// Whether a warning of the scene or its world contains `part`.
bool warns(const Scene& scene, std::string_view part);

void run(Scene& scene, int steps);

// |a - b| in metres, and the angle between two orientations in rad.
float distance(Vec3 a, Vec3 b);
float angle_between(Quat a, Quat b);

}  // namespace lendulet::test
