// A mesh or height field and the convex shape that is collided with it, as all steps of that see the two.
#pragma once

#include "collision/narrow_phase.h"
#include "geometry/hull.h"
#include "geometry/triangle_surface.h"

namespace lendulet {

struct MeshQuery {
    // Heights are equal within this part of the shape's size.
    static constexpr float level = 1e-4f;

    const CollidePair& pair;
    const CollideSettings& settings;
    TriangleSurface surface;
    const Geometry& shape;
    Quat turn;          // shape's frame to mesh axes
    Vec3 position;      // of the shape, mesh frame
    Vec3 lower, upper;  // bounds of shape and margin relative to its position, mesh axes
    Vec3 centre;        // of the shape, relative to its position, mesh axes
    float size;         // largest half extent, m

    // The pair's A is the surface, B the shape.
    MeshQuery(const CollidePair& p, const CollideSettings& s)
        : pair(p),
          settings(s),
          surface(*p.a),
          shape(*p.b),
          turn(conjugate(p.rotation_a) * p.rotation_b),
          position(rotate_inverse(p.rotation_a, p.offset)),
          centre(shape.kind == GeometryKind::hull ? rotate(turn, shape.hull->centroid) : Vec3{}) {
        CentredBox box = bounds(shape, turn);
        size = max_component(box.half);
        float reach = pair.margin + level * size;
        Vec3 half = box.half + Vec3{reach, reach, reach};
        lower = box.centre - half, upper = box.centre + half;
    }

    // The core's farthest point against a unit direction of the mesh's axes, relative to the shape's position.
    Vec3 lowest_along(Vec3 normal) const { return rotate(turn, support_core(shape, rotate_inverse(turn, -normal))); }
};

}  // namespace lendulet
