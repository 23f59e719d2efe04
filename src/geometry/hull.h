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
    uint32_t outline, outline_count;  // where there are too many corners to clip: which to take, see HullData::outlines
};

// Half edge e runs from `origin` to the origin of the next one of its face; `twin` is the same edge on the other face.
struct HullEdge {
    uint32_t origin, twin, face;
};

// Vectors component by component, padded to a multiple of 16 with copies of the last: for loops over many lanes.
struct HullLanes {
    std::vector<float> xs, ys, zs;
};

// Boxes around each 16 consecutive vertices, as centre and half extents; the half extents are large enough that bounds
// computed from them hold despite rounding. Only for hulls of more than `scanned_vertices` corners.
struct HullClusters {
    HullLanes centre, half;
    uint32_t count = 0;
};

struct HullData {
    std::vector<Vec3> vertices;  // in the order of the input; near each other in space where there are many
    std::vector<HullFace> faces;
    std::vector<HullEdge> edges;
    std::vector<uint32_t>
        vertex_edge;                // one half edge starting at each vertex: the entry for walking along the surface
    std::vector<float> xs, ys, zs;  // the vertices once more, padded to a multiple of 16 with copies of the last
    HullLanes normals;              // of the faces
    // Vertices of the faces with more than 32 corners that reach farthest into 32 directions around the face, in order;
    // the outline so reduced loses at most 1 - cos(pi / 32) = 0.5 % of its radius.
    std::vector<uint32_t> outlines;
    HullClusters clusters;
    Vec3 centroid;
    float volume = 0.0f;
    SymMat3 unit_inertia;  // of density 1 about the centroid, local axes
    Vec3 lower, upper;     // bounds
    float radius = 0.0f;   // largest distance of a vertex from the local origin
    int dropped_points = 0;
};

// Hulls of at most this many corners find support points by looking at every corner.
inline constexpr uint32_t scanned_vertices = 64;

// Index of the vertex with the largest dot(direction, vertex) as computed in single precision; of equal ones the first.
uint32_t support_vertex(const HullData& hull, Vec3 direction);
// Index of the face whose normal has the largest dot product with the direction; of equal ones the first.
uint32_t support_face(const HullData& hull, Vec3 direction);
// The smallest and the largest dot product of any vertex with each of three axes.
struct HullExtents {
    Vec3 lower, upper;
};
HullExtents extents_along(const HullData& hull, const Vec3 (&axes)[3]);

}  // namespace lendulet
