// The wide kernels of the narrow phase as a table of functions, one table a SIMD width, as for the solver. Pairs do not
// depend on each other, so how they are packed into lanes cannot matter: all widths give the same bits.
#pragma once

#include <cstdint>

#include "collision/batch/boxes.h"
#include "collision/batch/frame.h"
#include "collision/batch/round.h"
#include "collision/mesh/filter.h"
#include "collision/mesh/over_triangle.h"
#include "solver/contact.h"

namespace lendulet {

// How two shapes lay when the manifolds of their pair were made, or when they were found apart; see docs/collision.md.
struct alignas(64) KeptPose {
    float rotation_a[4], rotation_b[4];
    float offset[3];  // between the centres of mass, B minus A
    // The pair is kept while no point of either surface can have moved by more than the lesser of these two relative to
    // the other body, the second after the margin of the step is taken off. `clearance` is unkept where nothing is.
    float tolerance;
    float clearance;
    float feature;  // of a pair of boxes, see BoxBatch
    float unused[2];
};
static_assert(sizeof(KeptPose) == 64);
inline constexpr float unkept = -1e30f;
inline constexpr float any_motion = 1e30f;  // tolerance of a pair without points: its clearance alone counts

// Separations of a record's points when they were found.
struct alignas(16) FoundSeparations {
    float s[4];
};

struct MotionBatch {
    static constexpr int room = batch_capacity + 16;
    const ShapeFrame* frames;
    const KeptPose* poses;
    float dt, fall;  // fall: what gravity moves a body by within the step, m
    int count = 0;
    int32_t a[room], b[room], pose[room];
    float margin[room];  // out: surfaces closer than this may touch within the step, m
    float kept[room];    // out: above 0 where what was found last still stands
};

struct RefreshBatch {
    static constexpr int room = batch_capacity + 16;
    const ShapeFrame* frames;
    const KeptPose* poses;
    const FoundSeparations* found;
    ContactRecord* records;
    int count = 0;
    int32_t a[room], b[room], pose[room], record[room];
};

struct NarrowKernels {
    int width;
    void (*test_motion)(MotionBatch&);
    void (*refresh)(RefreshBatch&);
    void (*collide_boxes)(BoxBatch&);
    void (*collide_segments)(RoundBatch&, BatchManifold*);
    void (*collide_box_balls)(RoundBatch&, BatchManifold*);
    FilterTriangles filter_triangles;
    ClipOverTriangles clip_over_triangles;
};

// The kernels for 1, 4, 8 or 16 lanes in the best instructions this machine has for that width.
const NarrowKernels& narrow_kernels(int width);

}  // namespace lendulet
