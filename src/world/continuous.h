// Continuous collision: bodies that moved so far within a step that they may have passed through something are put back
// to where they met it first. See docs/queries.md.
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory.h"
#include "lendulet/math.h"

namespace lendulet {

struct ContinuousData {
    Array<uint32_t> suspects, bullets;  // slots, in the order of awake bodies
    // By place among the packed bodies: the pose at the start of the step, and the part of the step
    Array<Pose> start;
    Array<uint8_t> is_suspect;
    Array<float> fraction;              // after which a body was stopped, 1 where it was not
    std::vector<Array<uint32_t>> near;  // by worker: colliders near a suspect
    Array<uint32_t> obstacles;          // colliders that nothing can push, rising, where they are few ...
    bool few_obstacles = false;         // ... and suspects many: it is faster to go through them all

    ContinuousData(const Memory* memory, int workers)
        : suspects(memory), bullets(memory), start(memory), is_suspect(memory), fraction(memory), obstacles(memory) {
        for (int i = 0; i < workers; ++i) near.emplace_back(memory);
    }
};

}  // namespace lendulet
