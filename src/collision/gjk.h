// Distance between two convex cores (Gilbert, Johnson, Keerthi 1988) and, where they overlap, penetration depth by the
// expanding polytope (van den Bergen 2001). Works on shapes given by support functions in single precision, relative to
// each other, so distance from the world's origin costs no accuracy.
#pragma once

#include <cstdint>

#include "geometry/geometry.h"
#include "lendulet/math.h"
#include "lendulet/options.h"

namespace lendulet {

// Two cores, seen from the frame of A: B's local point p is at rotation * p + translation.
struct ConvexPair {
    const Geometry* a;
    const Geometry* b;
    Transform b_in_a;
};

// Support points remembered from the last query of the same pair; an empty one (count 0) is a cold start. The result
// depends on poses and cache alone.
struct GjkCache {
    uint8_t count = 0;
    // Of two boxes near each other: 1 + the face of their difference that the answer lay on (box_difference.h), or
    // unknown_face; 0: they are far apart, or other shapes.
    uint8_t face = 0;
    static constexpr uint8_t unknown_face = 16;
    Vec3 direction;   // last separating direction, frame of A
    Vec3 a[4], b[4];  // local points of A and of B
};

struct ConvexDistance {
    float distance;  // between the cores, m; negative: depth of the overlap of the cores
    Vec3 normal;     // unit, from A to B, frame of A; defined for every distance (a fixed choice where undecidable)
    Vec3 point_a, point_b;  // witness points on the cores, frame of A
    int iterations;         // of GJK
    int expansions;         // of EPA, 0 where the cores are apart
    bool converged;         // the certificate (support gap along the normal) holds
};

// Distance of the cores; stops early, with a lower bound as distance, once they are proven farther apart than
// `max_distance`.
ConvexDistance distance(const ConvexPair& pair, GjkCache& cache, SimplexSolver method, float max_distance);

}  // namespace lendulet
