// Integrals over a convex polyhedron.
#pragma once

#include "geometry/hull.h"

namespace lendulet {

// Sets volume, centroid and inertia from vertices, edges and faces.
void set_hull_mass(HullData& hull);

// Surface area (m^2) and integrated mean curvature (half the sum over edges of length times the angle between the
// normals of the two faces, m): what the volume of the rounded hull depends on.
struct HullSurface {
    double area, mean_curvature;
};
HullSurface hull_surface(const HullData& hull);

}  // namespace lendulet
