// Shapes as the engine sees them: a tagged plain value per collider. Built from the public Shape once, when a collider is
// made; everything that depends on the kind of shape switches on it in one place.
//
// A convex shape is a core swept by a sphere of radius `rounding`: a ball's core is a point, a capsule's a segment, a
// rounded box's a box. Collision works on cores and adds the radii, so curved shapes are exact.
#pragma once

#include <cstdint>

#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

enum class GeometryKind : uint8_t {
    point,             // sphere: rounding = radius
    segment,           // capsule: size.y = half height, rounding = radius
    box,               // size = half extents
    tapered_capsule,   // size = {bottom radius, half height, top radius}
    tapered_cylinder,  // size = {bottom radius, half height, top radius}; cylinders have equal radii, cones top radius 0
    hull,
    triangle,          // flat core of the three points at `triangle`; made for a moment while a mesh is collided
    plane,             // size = unit normal, rounding = 0, offset
    mesh,
};

struct Geometry {
    GeometryKind kind = GeometryKind::point;
    float rounding = 0.0f;   // radius swept around the core, m
    Vec3 size;               // by kind, see above
    float offset = 0.0f;     // plane: dot(normal, p) <= offset is solid
    const HullData* hull = nullptr;  // hull; for a mesh: its convex hull (null where it is flat)
    const MeshData* mesh = nullptr;
    const Vec3* triangle = nullptr;
};

// Checks sizes and gives the geometry, or bad_extent / non_finite / bad_mesh with a sentence.
Result<Geometry> make_geometry(const Shape& shape);

// Farthest point of the core along `direction` (any length; ties to the first in a fixed order), local frame. Not for
// planes and meshes.
Vec3 support_core(const Geometry& g, Vec3 direction);

// Box of the whole shape (rounding included) relative to the position of a body whose orientation is `rotation`, as
// centre and half extents along world axes. Planes give an infinite half extent.
struct CentredBox {
    Vec3 centre, half;
};
CentredBox bounds(const Geometry& g, Quat rotation);

// Radius of the smallest sphere about the local origin that holds the shape; for speed bounds.
float bounding_radius(const Geometry& g);

// A face of the core that the direction looks at best: up to `max_face_vertices` points in order around it, local frame.
// Curved faces (caps, sides of cylinders and cones) are given by points on them. One point or two for rounded ends and
// edges. (thesis 4.3.1)
inline constexpr int max_face_vertices = 32;
struct Face {
    int count = 0;
    Vec3 vertices[max_face_vertices];
    uint16_t ids[max_face_vertices];  // stable names of the vertices on this shape, for warm starting
    Vec3 normal;                      // unit, outward; undefined for count < 3
    uint16_t id = 0;                  // stable name of the face
    float extra_radius = 0.0f;        // sweep radius of a face that lies inside the core: the side of a cylinder as its
                                      // axis segment has the cylinder's radius here
};
Face best_face(const Geometry& g, Vec3 direction);

}  // namespace lendulet
