// When two moving shapes first touch: linear casts and casts with rotation, for queries and for continuous collision.
//
// Both motions run from fraction 0 to 1 in a common frame. The answer is reached by conservative advancement (Mirtich,
// "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996): from a plane that separates the shapes and a bound
// of how fast they can approach along its normal follows a time until which they cannot touch. All steps taken are
// proven in this way; the shapes are apart at every fraction before the one reported.
#pragma once

#include <cstdint>

#include "collision/gjk_math.h"
#include "geometry/geometry.h"

namespace lendulet {

// A rigid motion: the pivot moves evenly along `translation` while the shape turns evenly about it.
struct Motion {
    Vec3d pivot{};        // where the pivot is at fraction 0
    Quat rotation{};      // from the shape's frame at fraction 0
    Vec3 local_pivot{};   // the pivot in the shape's frame
    Vec3d translation{};  // of the pivot from fraction 0 to 1
    Vec3 axis{};          // unit, of the turn from fraction 0 to 1 ...
    float angle = 0.0f;   // ... by this many rad; 0: no turn
};

struct CastHit {
    double fraction;
    Vec3d normal;  // unit, from A to B at that fraction
    Vec3d point;   // on A's surface
    int32_t triangle = -1;
    bool overlapping = false;  // they do so at fraction 0; the normal is that of the shortest way out
    int rounds = 0;            // distance queries that it took
};

// First fraction up to `max_fraction` at which the shapes touch; false where they do not. Both convex.
// At the reported fraction they are within 4e-6 of the smaller shape's size (5e-5 where one turns) plus 1e-6 of the
// larger one's.
bool cast_convex(const Geometry& a, const Motion& motion_a, const Geometry& b, const Motion& motion_b,
                 double max_fraction, CastHit& hit);
// The same for A of any kind: a plane, a mesh or height field (the first of its triangles, with its index), or convex.
// B is convex. `fresh_only`: what overlaps at fraction 0 is left out, triangle by triangle.
bool cast_shapes(const Geometry& a, const Motion& motion_a, const Geometry& b, const Motion& motion_b,
                 double max_fraction, CastHit& hit, bool fresh_only = false);

// From the shape's frame, `fraction` of the way.
Quat rotation_at(const Motion& motion, double fraction);
inline Vec3d pivot_at(const Motion& motion, double fraction) { return motion.pivot + fraction * motion.translation; }

}  // namespace lendulet
