// Shapes as the engine sees them: a tagged plain value per collider. Built from the public Shape once, when a collider
// is made; everything that depends on the kind of shape switches on it in one place.
//
// A convex shape is a core swept by a sphere of radius `rounding`: a ball's core is a point, a capsule's a segment, a
// rounded box's a box. Collision works on cores and adds the radii, so curved shapes are exact.
#pragma once

#include <cstdint>

#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

enum class GeometryKind : uint8_t {
    point,    // sphere: rounding = radius
    segment,  // capsule: size.y = half height, rounding = radius
    box,      // size = half extents
    // size = {bottom radius, half height, top radius}. Of a tapered capsule the smaller radius is in `rounding`, hence
    // one of these is 0; a cylinder has equal radii here, a cone top radius 0.
    tapered_capsule,
    tapered_cylinder,
    hull,      // size.x: by which part its corners are drawn to the centroid, 0 but for inner cores
    triangle,  // flat core of the three points at `triangle`; made for a moment while a mesh is collided
    plane,     // size = unit normal, rounding = 0, offset
    mesh,
    height_field,
};

struct Geometry {
    GeometryKind kind = GeometryKind::point;
    float rounding = 0.0f;           // radius swept around the core, m
    Vec3 size{};                     // by kind, see above
    float offset = 0.0f;             // plane: dot(normal, p) <= offset is solid
    const HullData* hull = nullptr;  // hull; for a mesh: its convex hull (null where it is flat)
    const MeshData* mesh = nullptr;
    const HeightFieldData* field = nullptr;
    const Vec3* triangle = nullptr;
};

// Whether it is a surface of triangles.
inline bool has_triangles(const Geometry& g) {
    return g.kind == GeometryKind::mesh || g.kind == GeometryKind::height_field;
}

// Checks sizes and gives the geometry, or bad_extent / non_finite / degenerate_hull / bad_mesh with a sentence. The
// geometry points into the hull, mesh or height field of `shape`, which must outlive it.
Result<Geometry> make_geometry(const Shape& shape);

// Farthest point of the core along `direction` (any length; ties to the first in a fixed order), local frame. Not for
// planes and surfaces of triangles (these give the origin).
Vec3 support_core(const Geometry& g, Vec3 direction);

// Box of the whole shape (rounding included) relative to the position of a body whose orientation is `rotation`, as
// centre and half extents along world axes. Planes give an infinite half extent.
struct CentredBox {
    Vec3 centre, half;
};
CentredBox bounds(const Geometry& g, Quat rotation);

// Radius of the smallest sphere about the local origin that holds the shape; for speed bounds. Infinite for planes.
float bounding_radius(const Geometry& g);

// The inner core of a convex shape: a smaller shape inside it, all of whose surface lies `depth` or more below the
// outer one (about, where the shape is tapered). What moves less than that within a step cannot carry its inner core
// across a surface that it did not touch before. Planes and surfaces of triangles have none (depth 0,
// the geometry itself).
struct InnerCore {
    Geometry geometry;
    float depth;  // m
};
InnerCore inner_core(const Geometry& g);

// A face of the core that the direction looks at best: up to `max_face_vertices` points on the core's surface in order
// around it, counter-clockwise seen from outside, local frame. Curved faces are given by points on them: the cap of a
// cylinder by 16 points of its rim, its side by the two ends of the line nearest to the direction. Rounded ends, rims
// and tips give one point, segments and sides two. Planes and surfaces of triangles give none. (thesis 4.3.1)
inline constexpr int max_face_vertices = 32;
// Sine of the angle to the normal of a capsule's side up to which that gives its two points (8.6 degrees).
inline constexpr float segment_side_sine = 0.15f;
struct Face {
    int count = 0;
    union {
        Vec3 vertices[max_face_vertices];  // unset from `count` on: clearing them takes as long as finding the face
    };
    uint16_t ids[max_face_vertices];  // stable names of the vertices on this shape, for warm starting
    Vec3 normal;                      // unit, outward; where count < 3 the unit direction asked for
    uint16_t id = 0;                  // stable name of the face
    // Not 0: the points lie on a cylinder or ball of this radius that belongs to the core (the side of a cylinder, the
    // ends of a tapered capsule). They are on the surface already, so separations must not subtract it; but as the body
    // rolls, a contact there stays beneath the axis instead of turning with the body.
    float extra_radius = 0.0f;

    Face() {}
};
Face best_face(const Geometry& g, Vec3 direction);

}  // namespace lendulet
