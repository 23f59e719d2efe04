// Continuous collision: bodies that moved so far within a step that they may have passed through something are put back
// to where they met it first. See docs/queries.md.
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory.h"
#include "broad_phase/box.h"
#include "lendulet/math.h"

namespace lendulet {

// How a body moved in the step, about its centre of mass.
struct BodyPath {
    Pose start, end;
    Vec3 axis{1.0f, 0.0f, 0.0f};
    float angle = 0.0f;
};

// One that others may go along with.
struct Carrier {
    BodyPath path;
    Quat turn;      // the rotation from its start to its end
    bool still;     // it did not move
    uint32_t body;  // slot
};

// A collider that nothing can push.
struct Obstacle {
    uint32_t collider;
    BroadBox box;
    Carrier carrier;
};

struct ContinuousData {
    Array<uint32_t> suspects, bullets;  // slots, in the order of awake bodies
    // By place among the packed bodies: the pose at the start of the step, and the part of the step
    Array<Pose> start;
    Array<uint8_t> is_suspect;
    Array<float> fraction;              // after which a body was stopped, 1 where it was not
    std::vector<Array<uint32_t>> near;  // by worker: colliders near a suspect
    Array<Obstacle> obstacles;          // rising, where they are few ...
    bool few_obstacles = false;         // ... and suspects many: it is faster to go through them all

    ContinuousData(const Memory* memory, int workers)
        : suspects(memory), bullets(memory), start(memory), is_suspect(memory), fraction(memory), obstacles(memory) {
        for (int i = 0; i < workers; ++i) near.emplace_back(memory);
    }
};

}  // namespace lendulet
