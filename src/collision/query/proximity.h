// How far apart two placed shapes are, or how deep they overlap, and where.
#pragma once

#include <cstdint>

#include "collision/gjk_math.h"
#include "geometry/geometry.h"

namespace lendulet {

// B's place seen from A.
struct PlacedPair {
    const Geometry* a;  // of any kind
    const Geometry* b;  // convex
    Quat rotation_a, rotation_b;
    Vec3d offset;  // from A's origin to B's, common axes
};

struct Nearness {
    double distance;         // between the surfaces, m; negative: the shortest way out
    Vec3d normal;            // unit, from A to B, common axes
    Vec3d point_a, point_b;  // on the surfaces, from A's origin, common axes
    int32_t triangle = -1;   // of A, where it has any
};

// False where they are farther apart than `limit` (>= 0).
bool nearness(const PlacedPair& pair, double limit, Nearness& out);
// Whether the shapes have a point in common.
bool touching(const PlacedPair& pair);

}  // namespace lendulet
