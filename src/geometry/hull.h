// A convex polyhedron with its topology: corners, faces as vertex loops, half edges.
#pragma once

#include <cstdint>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

struct HullFace {
    Vec3 normal;          // unit, outward
    float offset;         // dot(normal, p) = offset on the face's plane
    uint32_t first_edge;  // its half edges are consecutive, counter-clockwise seen from outside
    uint32_t edge_count;
};

// Half edge e runs from `origin` to the origin of the next one of its face; `twin` is the same edge on the other face.
struct HullEdge {
    uint32_t origin, twin, face;
};

struct HullData {
    std::vector<Vec3> vertices;
    std::vector<HullFace> faces;
    std::vector<HullEdge> edges;
    std::vector<uint32_t> vertex_edge;  // one half edge starting at each vertex: the entry for walking along the surface
    // The vertices once more, component by component and padded to a multiple of 16 with copies of the last: for support
    // functions over many lanes.
    std::vector<float> xs, ys, zs;
    Vec3 centroid;
    float volume = 0.0f;
    SymMat3 unit_inertia;  // of density 1 about the centroid, local axes
    Vec3 lower, upper;     // bounds
    int dropped_points = 0;
};

}  // namespace lendulet
