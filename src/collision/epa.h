// Expanding polytope: how deep two cores overlap (thesis 4.2; van den Bergen, "Proximity queries and penetration depth
// computation on 3D game objects", 2001). The depth is the distance from the origin to the surface of the Minkowski
// difference; a polytope inside the difference grows towards the surface where it is nearest to the origin.
#pragma once

#include "collision/gjk_difference.h"
#include "collision/gjk_newton.h"

namespace lendulet {

inline constexpr int max_expansions = 64;

struct Penetration {
    double depth;   // m; how far the cores must be moved apart along the normal. Slightly negative: they are apart
    Vec3d outward;  // unit; from the origin to the nearest point of the surface, so from B to A
    Vec3d y;        // that point of the difference, and
    Vec3d point_a;  // the point of A it belongs to, frame of A
    double gap;     // the depth is known to within this, m
    int expansions;
};

// `simplex` holds the origin, or touches it to within rounding; flat differences (two segments that cross, coplanar
// polygons) give depth 0 with a normal perpendicular to them. `hint` breaks the tie of the two sides. Where the nearest
// point lies in a face of the difference, its corners and a point opposite to it are left in `simplex`: near this pose
// they are a polytope that proves the depth with one more support point.
Penetration expand_polytope(const CoreDifference& difference, Simplex& simplex, Vec3d hint);
// The same with an observer of trace.h, which is told each polytope and the point that it takes next.
template <class Observer>
Penetration expand_polytope(const CoreDifference& difference, Simplex& simplex, Vec3d hint, Observer& observer);

// Where cores overlap so far that most directions meet the surface far from the origin: `top` is the support point
// along the unit `direction`. The polytope begins with it, points around it and the one opposite, whether or not these
// hold the origin; the depth comes out negative where nothing does. Not for curved differences. False where the points
// span no volume.
bool expand_below(const CoreDifference& difference, const DifferencePoint& top, Vec3d direction, Simplex& simplex,
                  Penetration& out);

// Where the nearest point is known but for the proof: the polytope begins with it and points around and opposite to it,
// which are left in `simplex`. False where these do not enclose the origin.
bool expand_around(const CoreDifference& difference, const Tangency& known, Simplex& simplex, Penetration& out);

}  // namespace lendulet
