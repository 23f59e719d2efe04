// Inner cores, for continuous collision.
#include "geometry/geometry.h"
#include "geometry/hull.h"

namespace lendulet {
namespace {

constexpr float part = 0.5f;  // of the way from the surface to the middle

// Depth of the centroid below the nearest face.
float inner_radius(const HullData& hull) {
    float least = 3e38f;
    for (const HullFace& face : hull.faces) least = minimum(least, face.offset - dot(face.normal, hull.centroid));
    return maximum(least, 0.0f);
}

}  // namespace

InnerCore inner_core(const Geometry& g) {
    InnerCore core{g, 0.0f};
    Geometry& inner = core.geometry;
    switch (g.kind) {
        case GeometryKind::point:
        case GeometryKind::segment:
            core.depth = part * g.rounding;
            inner.rounding -= core.depth;
            break;
        case GeometryKind::box: {
            core.depth = part * (min_component(g.size) + g.rounding);
            float from_edges = minimum(core.depth, g.rounding), from_faces = core.depth - from_edges;
            inner.rounding -= from_edges;
            inner.size = g.size - Vec3{from_faces, from_faces, from_faces};
            break;
        }
        case GeometryKind::tapered_capsule:  // two balls inside the two
            core.depth = part * (maximum(g.size.x, g.size.z) + g.rounding);
            inner.rounding *= part;
            inner.size.x *= part, inner.size.z *= part;
            break;
        case GeometryKind::tapered_cylinder: {
            core.depth = part * (minimum(g.size.y, maximum(g.size.x, g.size.z)) + g.rounding);
            float shorter = minimum(core.depth, part * g.size.y);
            float slope = 0.5f * (g.size.z - g.size.x) / g.size.y;
            inner.rounding *= part;
            inner.size = {part * (g.size.x + slope * shorter), g.size.y - shorter, part * (g.size.z - slope * shorter)};
            break;
        }
        case GeometryKind::hull:
            core.depth = part * (inner_radius(*g.hull) + g.rounding);
            inner.rounding *= part;
            inner.size.x = part;
            break;
        default:
            break;
    }
    return core;
}

}  // namespace lendulet
