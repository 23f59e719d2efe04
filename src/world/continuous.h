// Continuous collision: bodies that moved so far within a step that they may have passed through something are put back
// to where they met it first. See docs/queries.md.
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory.h"
#include "broad_phase/block.h"
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
    Carrier carrier;
};

struct ContinuousData {
    Array<uint32_t> suspects, bullets;  // slots, in the order of awake bodies
    // By place among the packed bodies: the pose at the start of the step, and the part of the step
    Array<Pose> start;
    Array<uint8_t> is_suspect;
    Array<float> fraction;              // after which a body was stopped, 1 where it was not
    std::vector<Array<uint32_t>> near;  // by worker: colliders near a suspect
    Array<uint32_t> obstacle_slots;     // colliders that nothing can push, rising; empty where they are many
    bool colliders_changed = true;      // some came, went or have got a box since these were listed
    Array<Obstacle> obstacles;          // these, in a step with many suspects: it is faster to go through them all
    Array<BoxBlock> obstacle_boxes;     // theirs, in the same order

    ContinuousData(const Memory* memory, int workers)

        : suspects(memory),
          bullets(memory),
          start(memory),
          is_suspect(memory),
          fraction(memory),
          obstacle_slots(memory),
          obstacles(memory),
          obstacle_boxes(memory) {
        for (int i = 0; i < workers; ++i) near.emplace_back(memory);
    }
};

}  // namespace lendulet
