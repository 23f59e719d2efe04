// The iteration of GJK (thesis 4.1): a simplex of points of the Minkowski difference moves towards the origin.
#pragma once

#include "collision/gjk_difference.h"
#include "lendulet/options.h"

namespace lendulet {

// What a distance must be certified to, relative to S: a quarter of what may be off relative to the extents of both
// cores, since S counts up to twice the extent of a curved core and as much again for the offset.
inline constexpr double certified_distance = 5e-7;

enum class Outcome : uint8_t {
    apart,    // the distance is found
    beyond,   // farther apart than the caller cares; the distance is a lower bound
    overlap,  // the simplex holds the origin, or touches it
};

struct Search {
    Outcome outcome;
    Vec3d v;          // point of the difference nearest to the origin; the weights of the simplex belong to it
    Vec3d direction;  // from A to B, unit: along v but for rounding; unset for overlap
    double distance;
    double gap;      // between the distance and the lower bound proven for it
    int iterations;  // support points taken into the simplex
};

// Starts from the points in `s` (at least one) and leaves there those that the nearest point lies between.
Search search(const CoreDifference& difference, Simplex& s, SimplexSolver method, double max_distance);
// The same with an observer of trace.h, which is told each simplex and each support point.
template <class Observer>
Search search(const CoreDifference& difference, Simplex& s, SimplexSolver method, double max_distance,
              Observer& observer);

}  // namespace lendulet
