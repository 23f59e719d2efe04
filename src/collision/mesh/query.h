// A mesh or height field and the convex shape that is collided with it, as all steps of that see the two.
#pragma once

#include "collision/mesh/triangle.h"
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
    Mat3 to_contact;    // rows: the axes in which contacts are found, those of the shape, or of the mesh for a ball
    Vec3 position;      // of the shape, mesh frame
    Vec3 lower, upper;  // bounds of shape and margin relative to its position, mesh axes
    Vec3 centre;        // of the shape, relative to its position, mesh axes
    Vec3 heart;         // the same in the axes of contacts
    float size;         // largest half extent, m

    // The pair's A is the surface, B the shape.
    MeshQuery(const CollidePair& p, const CollideSettings& s)
        : pair(p),
          settings(s),
          surface(*p.a),
          shape(*p.b),
          turn(conjugate(p.rotation_a) * p.rotation_b),
          to_contact(shape.kind == GeometryKind::point
                         ? Mat3{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}
                         : rotation_matrix(conjugate(turn))),
          position(rotate_inverse(p.rotation_a, p.offset)),
          centre(shape.kind == GeometryKind::hull ? rotate(turn, shape.hull->centroid) : Vec3{}),
          heart(shape.kind == GeometryKind::hull ? shape.hull->centroid : Vec3{}) {
        CentredBox box = bounds(shape, turn);
        size = max_component(box.half);
        float reach = pair.margin + level * size;
        Vec3 half = box.half + Vec3{reach, reach, reach};
        lower = box.centre - half, upper = box.centre + half;
    }

    // From the axes of contacts to those of the world.
    Quat contact_rotation() const { return shape.kind == GeometryKind::point ? pair.rotation_a : pair.rotation_b; }

    // Relative to the position of the shape, in the axes of contacts.
    Triangle triangle(uint32_t index) const {
        Triangle t = make_triangle(surface, index, position, centre);
        if (shape.kind == GeometryKind::point) return t;
        for (Vec3& v : t.vertices) v = to_contact * v;
        t.normal = to_contact * t.normal;
        return t;
    }
};

}  // namespace lendulet
