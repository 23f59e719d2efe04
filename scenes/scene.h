// A scene: a world with what drives it. Built-in scenes and loaded files alike; used by the command line program,
// tests, benchmarks and viewers under one name.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lendulet/lendulet.h"

namespace lendulet {

// Applied to a scene's settings before its world is built: command line options, test variations.
using Configure = std::function<void(WorldBuilder&)>;

struct Scene {
    World world;
    std::string name;
    float dt = 1.0f / 60.0f;                            // the step it is meant for, s
    int steps = 600;                                    // how long it is worth watching
    std::function<void(World&, int step)> before_step;  // may be empty: spawns, kinematic motion
    std::vector<std::string> warnings;                  // of loading
    // Names of colliders that differ from their body's: nodes of a file below a moving one.
    std::vector<std::pair<ColliderId, std::string>> collider_names{};
    std::vector<std::pair<int, BodyId>> nodes{};  // of a glTF file that became bodies, by their numbers in it
};

struct SceneInfo {
    std::string_view name;         // without size
    std::string_view description;  // one sentence
    int default_size;              // 0: the scene has no size
};

// All built-in scenes.
std::vector<SceneInfo> built_in_scenes();

// The built-in scene NAME, NAME:N or NAME_N (N: its size), or ErrorCode::unknown_name.
Result<Scene> build_scene(std::string_view name, const Configure& configure = {});

}  // namespace lendulet
