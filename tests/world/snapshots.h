// What tests of snapshots share: steps of built-in scenes with their drivers, the hashes after each, and checksums.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/hash.h"
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

// Like the engine's own: of all bytes but the last eight, which hold it.
inline void seal(std::vector<uint8_t>& bytes) {
    const size_t size = bytes.size() - 8;
    uint64_t sum = size;
    for (size_t i = 0; i < size; i += 8) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, std::min<size_t>(8, size - i));
        sum = hash_combine(sum, word);
    }
    std::memcpy(bytes.data() + size, &sum, 8);
}

}  // namespace lendulet::test
