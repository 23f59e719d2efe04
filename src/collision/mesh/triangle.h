// A triangle of a mesh or height field while a convex shape is collided with it: relative to the position of the shape,
// and seen from the side on which the shape's centre is.
#pragma once

#include <cstdint>

#include "geometry/geometry.h"
#include "geometry/triangle_surface.h"

namespace lendulet {

struct Triangle {
    Vec3 vertices[3];   // in the order of the surface
    Vec3 normal;        // unit, towards the shape's centre
    uint32_t index;     // in the surface
    uint32_t original;  // in the user's list
    uint8_t touching;   // bit i: edge i can touch a shape on this side: the surface bends away, or ends
    uint8_t bent;       // bit i: edge i is not flat
    uint8_t sharp;      // bit i: edge i bends by more than the faces on both sides can stand for
    bool from_behind;   // the centre is behind the front face

    // What does not depend on places; after `from_behind`.
    void name(const TriangleSurface& surface, uint32_t i) {
        index = i;
        original = surface.original(i);
        const uint8_t convex = surface.convex_edges(i), concave = surface.concave_edges(i);
        touching = from_behind ? concave : convex;
        bent = convex | concave;
        sharp = surface.sharp_edges(i);
    }
};

// In the mesh's axes, as `position`, that of the shape, and `centre`, its centre relative to that.
inline Triangle make_triangle(const TriangleSurface& surface, uint32_t index, Vec3 position, Vec3 centre) {
    Triangle r;
    surface.corners(index, r.vertices);
    for (Vec3& v : r.vertices) v -= position;
    Vec3 front = surface.normal(index);
    r.from_behind = dot(front, centre - r.vertices[0]) < 0.0f;
    r.normal = r.from_behind ? -front : front;
    r.name(surface, index);
    return r;
}

// In the plane, at right angles to edge i = (vertex i, vertex i + 1), out of the triangle; as long as the edge.
inline Vec3 out_across(const Triangle& t, int i) {
    Vec3 along = t.vertices[(i + 1) % 3] - t.vertices[i];
    return t.from_behind ? cross(t.normal, along) : cross(along, t.normal);
}

// As a face to clip with: counter-clockwise about the normal.
inline Face face_of(const Triangle& t, const TriangleSurface& surface) {
    Face face;
    face.count = 3;
    for (int i = 0; i < 3; ++i) {
        int k = t.from_behind ? 2 - i : i;
        face.vertices[i] = t.vertices[k];
        face.ids[i] = static_cast<uint16_t>(surface.vertex(t.index, k));
    }
    face.normal = t.normal;
    face.id = static_cast<uint16_t>(t.original);
    return face;
}

// The point of a triangle nearest to p, and the edges it lies on (bit i: edge i): none inside, one on an edge, two at a
// vertex. (Ericson, Real-Time Collision Detection, 2005, 5.1.5: the Voronoi regions of the features, one by one.)
struct TrianglePoint {
    Vec3 point;
    uint8_t edges;
};
inline TrianglePoint nearest_on_triangle(const Vec3 (&t)[3], Vec3 p) {
    Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
    float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f) return {t[0], 0b101};
    if (d3 >= 0.0f && d4 <= d3) return {t[1], 0b011};
    if (d6 >= 0.0f && d5 <= d6) return {t[2], 0b110};
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return {t[0] + (d1 / (d1 - d3)) * ab, 0b001};
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return {t[0] + (d2 / (d2 - d6)) * ac, 0b100};
    if (va <= 0.0f && d4 >= d3 && d5 >= d6)
        return {t[1] + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]), 0b010};
    float inverse = 1.0f / (va + vb + vc);
    return {t[0] + (vb * inverse) * ab + (vc * inverse) * ac, 0};
}

}  // namespace lendulet
