// From a surface of triangles to few clean polygons: the steps between quickhull and HullData.
//
// Points of a flat face are rarely coplanar to the last bit; a cube's face given by a grid of rounded points has
// corners in the middle of its faces and edges that stand out by 1e-7. First such corners are found and left out (and
// the hull taken again), then triangles are joined to convex polygons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/quickhull.h"

namespace lendulet {

// Corners of the surface that are worth keeping: not those inside a region of triangles that is flat within `tolerance`
// (lattice units), nor every second one of those between two such regions and on a line with their neighbours. Indices
// of points, ascending.
std::vector<uint32_t> essential_corners(std::span<const LatticePoint> points, const TriangleSurface& surface,
                                        double tolerance);

// Faces as loops of half edges: those of face f are [first[f], first[f + 1]), counter-clockwise seen from outside; each
// starts at the point `origin` and has its opposite in `twin`. `normal` is the unit normal of face f.
struct PolygonSurface {
    std::vector<uint32_t> first, origin, twin;
    std::vector<Vec3T<double>> normal;
    uint32_t face_count() const { return static_cast<uint32_t>(normal.size()); }
};

// Joins neighbouring triangles that lie in one plane within `tolerance` (lattice units) to convex polygons.
PolygonSurface join_coplanar(std::span<const LatticePoint> points, const TriangleSurface& surface, double tolerance);

// Unit normal and twice the area of a triangle of the surface.
struct TriangleNormal {
    Vec3T<double> unit;
    double twice_area;
};
TriangleNormal triangle_normal(std::span<const LatticePoint> points, const TriangleSurface& surface, uint32_t triangle);
// Triangles from the largest to the smallest; equal ones by index.
std::vector<uint32_t> triangles_by_area(const std::vector<TriangleNormal>& normals);

inline Vec3T<double> to_double(LatticePoint p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

// Cosine of the angle between normals up to which triangles can belong to one face; two sides of a thin plate, and the
// narrow strip between them, must not.
inline constexpr double same_face_cosine = 0.5;

}  // namespace lendulet
