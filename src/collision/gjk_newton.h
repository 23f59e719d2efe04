// Newton's method on the direction of the shortest or least deep translation, for curved cores. Plain GJK and EPA halve
// the error of the direction with each support point; where both surfaces are smooth, a few rounds of this make it
// exact to rounding. At edges the support point jumps and the method fails, which the callers notice by the bound.
#pragma once

#include "collision/gjk_difference.h"

namespace lendulet {

// Two unit vectors that complete the unit vector u to a right-handed frame (Duff et al. 2017).
inline void complete_frame(Vec3d u, Vec3d& p, Vec3d& q) {
    double sign = u.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (sign + u.z), b = u.x * u.y * a;
    p = {1.0 + sign * u.x * u.x * a, sign * b, -sign * u.x};
    q = {b, sign + u.y * u.y * a, -u.y};
}

struct Tangency {
    Vec3d direction;    // unit
    DifferencePoint p;  // support point in that direction
    double height;      // dot(direction, p.y)
    double miss;        // how far p.y lies from the line along the direction
};

// Looks near a unit direction for one whose support point lies on the line through the origin along it, by Newton's
// method.
Tangency find_smooth_tangency(const CoreDifference& difference, Vec3d direction);

// The same where a cap, the side of a cylinder or cone or the face of a box meets the other core: there the support
// point jumps, but the feature tells the direction. Tried where `direction` is within a few degrees of such a normal;
// false where none is, or what it faces lies beside the feature.
bool find_tangency_of_features(const CoreDifference& difference, Vec3d direction, Tangency& out);

// The one or the other.
inline Tangency find_tangency(const CoreDifference& difference, Vec3d direction) {
    Tangency t;
    return find_tangency_of_features(difference, direction, t) ? t : find_smooth_tangency(difference, direction);
}

}  // namespace lendulet
