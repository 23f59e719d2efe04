// The wide kernels of joints as a table of functions, one table a SIMD width; as solver/kernels.h, in units of their
// own.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/bodies.h"
#include "solver/joints/joint.h"

namespace lendulet {

// What differs between the passes over joints of a step.
struct JointConstants {
    float h;  // substep, s
    float inverse_h;
    // Split groups only:
    float scale;  // impulses were multiplied by this since the last pass, with the bodies' repeated changes
    float share;  // share of h that this pass stands for: half a substep at both ends of the step
    bool first;   // of the step: the end of the step before gave no force of springs to go on with
};

// Joints of one colour, one class, the same moved sides and the same mode.
struct JointGroup {
    JointClass type;
    bool moved_a, moved_b;  // the other side is static or kinematic: not stored
    bool split;
    int32_t filler;  // reserved body for the empty lanes of the last block
    int count;
    const uint32_t* order;  // indices of the records
    std::byte* rows;        // what passes read
    std::byte* frames;      // what only the start of a step reads
    JointAxesRecord* axes;  // that JointRecord::axes of six-degree joints names
};

// Joints of one class: blocks [begin, end) of a group.
struct JointKernels {
    using Pass = void (*)(const JointGroup&, SolverBodies&, const JointConstants&, int begin, int end);
    size_t row_bytes, frame_bytes;  // of one block
    // Reads records into rows, with or without their impulses.
    void (*load)(const JointGroup&, const JointRecord*, bool with_impulses, int begin, int end);
    // Start of a step: places and velocities of the bodies; impulses times `scale`.
    void (*prepare)(const JointGroup&, const SolverBodies&, float scale, int begin, int end);
    Pass warm_start;  // applies the impulses as prepared, at the start of the first substep
    Pass biased;      // before the drift
    Pass relax;       // after it
    void (*store)(const JointGroup&, JointRecord*, int begin, int end);
};

struct JointTable {
    int width;
    JointKernels of[joint_classes];
};

// The kernels for 1, 4, 8 or 16 lanes in the best instructions this machine has for that width.
const JointTable& joint_table(int width);

}  // namespace lendulet
