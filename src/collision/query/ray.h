// Rays against single shapes, in the shape's own frame and in double: closed forms for balls, capsules, boxes,
// cylinders, cones, planes and small hulls, distance queries for what is rounded, the hierarchy for meshes and the
// pyramid of height fields.
//
// A solid is a closed set. A ray meets it at the smallest fraction at which its point lies in the solid; a ray that
// starts inside meets it at fraction 0 with a normal against the ray. Triangles are met from both sides unless they are
// one-sided, and have no inside.
#pragma once

#include <cstdint>

#include "collision/gjk_math.h"
#include "geometry/triangle_surface.h"

namespace lendulet {

// The points origin + t * translation, t in [0, max_fraction]; translation is not zero.
struct LocalRay {
    Vec3d origin, translation;
    double max_fraction;
};

struct LocalRayHit {
    double fraction;
    Vec3d normal;  // unit, out of the solid and against the ray
    int32_t triangle = -1;
    bool inside = false;  // the ray started inside
};

// Where the ray meets the shape first; false, with `hit` unset, where it does not.
bool cast_ray(const Geometry& g, const LocalRay& ray, LocalRayHit& hit);

// The part of a line inside a convex solid, by fraction, and the surface's normal where it enters.
struct Chord {
    double enter, leave;
    Vec3d normal;
};
// Each is false where the line misses the solid. The line is endless: max_fraction plays no part.
bool chord_of_ball(const LocalRay& line, Vec3d centre, double radius, Chord& chord);
bool chord_of_box(const LocalRay& line, Vec3d half, Chord& chord);
// Between y = bottom and y = top, of radius `bottom_radius` there and `top_radius` here.
bool chord_of_frustum(const LocalRay& line, double bottom, double top, double bottom_radius, double top_radius,
                      Chord& chord);
// The hull of two balls about y = -half_height and y = half_height.
bool chord_of_two_balls(const LocalRay& line, double half_height, double bottom_radius, double top_radius,
                        Chord& chord);
bool chord_of_hull(const LocalRay& line, const HullData& hull, Chord& chord);

bool cast_ray_triangles(const TriangleSurface& surface, const LocalRay& ray, LocalRayHit& hit);

}  // namespace lendulet
