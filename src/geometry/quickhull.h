// The convex hull of lattice points as triangles, exact in every decision.
//
// Quickhull (Barber, Dobkin, Huhdanpaa, ACM TOMS 22, 1996) fails in floating point where points are nearly coplanar: a
// point sees a face and not its neighbour by rounding alone, and the horizon is no loop. Here points have whole
// coordinates of at most 40 bits, so that "does this point see that face" is a determinant of 125 bits, computed
// without error. The horizon is then always one loop, and the result a closed, weakly convex surface, whatever the
// input. Tolerances only decide which points are worth becoming corners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lendulet/math.h"

namespace lendulet {

// Fine enough that even the plane of a strip a millionth of the size wide is that of the points themselves.
inline constexpr int lattice_bits = 40;
using LatticePoint = Vec3T<int64_t>;  // each coordinate in [0, 2^40]

// Half edge 3 t + i runs from corner[3 t + i] to the next corner of triangle t; `twin` is the same edge on the
// neighbouring triangle. Triangles are counter-clockwise seen from outside.
struct TriangleSurface {
    std::vector<uint32_t> corner, twin;
    uint32_t triangle_count() const { return static_cast<uint32_t>(corner.size() / 3); }
};

// How many dimensions the points span beyond `flat` lattice units.
enum class Rank : uint8_t { point, line, plane, space };

// The hull of `points`. Point i becomes a corner only where it lies more than slack[i] outside of the hull of corners
// found so far (lattice units, >= 1); hence in the end no point lies more than its slack outside of the plane of any
// triangle. Points with the least slack of all go first, the others follow where they still stand out. Anything but
// Rank::space leaves `surface` empty. Depends on values and order of the points alone.
Rank quickhull(std::span<const LatticePoint> points, std::span<const double> slack, double flat,
               TriangleSurface& surface);

// Whether d lies strictly in front of the triangle a, b, c, counter-clockwise from the front: 1, 0 (coplanar) or -1.
int side_of(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d);

}  // namespace lendulet
