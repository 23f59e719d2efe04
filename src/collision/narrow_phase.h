// Manifolds between two colliders of any kind. Pure functions of geometry, relative pose and a cache that the caller
// keeps with the pair: no bodies, ids or worlds here.
#pragma once

#include <cstdint>

#include "collision/gjk.h"
#include "collision/manifold.h"
#include "geometry/geometry.h"

namespace lendulet {

struct MeshCandidates;
struct MeshFilterBatch;
struct OverTriangleBatch;
// See mesh/filter.h and mesh/over_triangle.h; four triangles at a time.
void filter_triangles(MeshFilterBatch& batch);
void clip_over_triangles(OverTriangleBatch& batch);

struct CollidePair {
    const Geometry* a;
    const Geometry* b;
    Quat rotation_a, rotation_b;  // shape frames to world
    Vec3 offset;                  // position of B's shape minus position of A's, world axes
    float margin;                 // surfaces farther apart than this give no points, m
    CarriedPoints carried{};      // of the pair's last manifold
    Vec3 ahead{};                 // how far B moves against A until the middle of the step, world axes
};

struct CollideSettings {
    SimplexSolver simplex = SimplexSolver::half_space;
    // Or wider ones with the same results.
    void (*filter)(MeshFilterBatch&) = filter_triangles;
    void (*clip)(OverTriangleBatch&) = clip_over_triangles;
};

// What is kept from step to step with the pair: the axis or reference face of the last contact, as hysteresis, and the
// start of the next distance query. Results depend on poses and cache alone.
struct PairCache {
    uint32_t feature = 0;
    // Out, where no manifolds were found: the surfaces are at least this far apart, m.
    float clearance = 0.0f;
    GjkCache gjk;
};

// Writes manifolds for the pair to `out` (room for `capacity`), returns how many there are. Convex pairs give at most
// one; a convex shape against a mesh or height field gives at most max_mesh_manifolds, the deepest first where there
// would be more. Pairs of which neither is convex give none. Order of a and b is the caller's: normals point from a to
// b.
inline constexpr int max_mesh_manifolds = 16;
// `near`, of pairs with a mesh or height field: where the triangles found are kept, for as long as the pair's
// geometries are these; results are the same without it.
int collide(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold* out, int capacity,
            MeshCandidates* near = nullptr);

bool is_sharp_box(const Geometry& g);
// Whether the pair is collided by a closed form: balls and capsules with each other, with boxes and planes.
bool has_closed_form(const Geometry& a, const Geometry& b);

// Whether the two shapes overlap or touch; for triggers.
bool overlap(const CollidePair& pair, PairCache& cache, const CollideSettings& settings);

}  // namespace lendulet
