// What a step does for each body by itself, W bodies at once: bounds of what it carries, packing for the solver and
// unpacking after it. As a table of functions, one table a SIMD width, as for the solver; bodies do not depend on each
// other here, so all widths give the same bits.
//
// Whoever calls fills a batch with what is rare or decided one by one: kinds, forces, damping. The kernels read the
// stores by slot. A batch is filled up to a whole block of the widest lanes with its last entry again, see filled():
// lanes of the same body do the same.
#pragma once

#include <cstdint>

#include "broad_phase/box.h"
#include "collision/batch/frame.h"
#include "dynamics/body_store.h"
#include "geometry/geometry.h"
#include "solver/bodies.h"

namespace lendulet {

inline constexpr int body_batch = 64;  // a multiple of 16

// Bodies by slot, as BodyStore holds them.
struct BodyColumns {
    Pose* pose;
    BodyMomenta* momenta;
    const BodyMass* mass;
    BodyChange* change;
};

LENDULET_FORCE_INLINE BodyColumns columns(BodyStore& bodies) {
    return {bodies.pose.data(), bodies.momenta.data(), bodies.mass.data(), bodies.change.data()};
}

// Colliders: their frames, and boxes around them through the step.
struct BoundBatch {
    BodyColumns bodies;
    const Transform* local;  // by collider, as the next two
    const Geometry* geometry;
    ShapeFrame* frames;     // out
    const BroadBox* boxes;  // by place: as they are
    float dt;
    float fall, most_fall;     // speed that gravity gives within the step, and the most that it may, m/s
    float most_foreseen_turn;  // rad
    int count = 0;
    int32_t collider[body_batch], body[body_batch];
    int32_t box[body_batch];                         // place
    float kinematic[body_batch], fixed[body_batch];  // 1 or 0
    float unboxed[body_batch];                       // 1: has no box yet
    float gravity_factor[body_batch], radius[body_batch];
    // 1 for shapes other than balls, capsules and boxes: the box relative to the collider is given.
    float given[body_batch], given_centre[3][body_batch], given_half[3][body_batch];
    // Out: whether the box has to be renewed, and to what.
    float renewed[body_batch], lower[3][body_batch], upper[3][body_batch];
};

// Awake bodies, into the solver's arrays.
struct PackBatch {
    BodyColumns bodies;
    SolverBodies* packed;
    int count = 0;
    int32_t body[body_batch], place[body_batch];
    float dynamic[body_batch];                                                  // 1 or 0
    float share[body_batch];                                                    // of its substep in one of the setting
    float free[body_batch], linear_loss[body_batch], angular_loss[body_batch];  // as in BodyMotion
    float acceleration[3][body_batch], torque[3][body_batch];
};

// And back.
struct UnpackBatch {
    BodyColumns bodies;
    const SolverBodies* packed;
    Pose* before;  // out, by place less the reserved ones: poses at the start of the step
    float most_speed, most_spin;
    int count = 0;
    int32_t body[body_batch], place[body_batch];
    float dynamic[body_batch];   // 1 or 0
    float substeps[body_batch];  // of its own in one of the setting
    // Of bodies that only gravity acts on: what it gives and damping takes in the whole step.
    float gain[3][body_batch], loss[body_batch];
    float doubtful[body_batch];  // out: 1 where a speed may be too large or a number not finite
};

// To how many entries a batch of `count` is filled.
LENDULET_FORCE_INLINE constexpr int filled(int count) { return (count + 15) / 16 * 16; }

// Calls run(first, count) for batches of what stands at [begin, end) of a list.
template <class Run>
LENDULET_FORCE_INLINE void for_each_batch(int begin, int end, Run&& run) {
    for (int first = begin; first < end; first += body_batch)
        run(first, end - first < body_batch ? end - first : body_batch);
}

struct BodyKernels {
    int width;
    void (*bound)(BoundBatch&);
    void (*pack)(PackBatch&);
    void (*unpack)(UnpackBatch&);
};

// The kernels for 1, 4, 8 or 16 lanes in the best instructions this machine has for that width.
const BodyKernels& body_kernels(int width);

}  // namespace lendulet
