// Steps of built-in scenes, with their drivers, and the hashes after each.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace lendulet::test {

inline void step(Scene& scene, int count) {
    for (int i = 0; i < count; ++i) {
        if (scene.before_step) scene.before_step(scene.world, static_cast<int>(scene.world.step_count()));
        scene.world.update(scene.dt).value();
    }
}

inline std::vector<uint64_t> hashes(Scene& scene, int count) {
    std::vector<uint64_t> list;
    for (int i = 0; i < count; ++i) step(scene, 1), list.push_back(scene.world.hash());
    return list;
}

}  // namespace lendulet::test
