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
inline constexpr double infinite_fraction = 1e300;
// Whether the ray meets the solid of which the line has this part, and where.
LENDULET_FORCE_INLINE bool from_chord(const Chord& chord, const LocalRay& ray, LocalRayHit& hit) {
    if (chord.enter > ray.max_fraction || chord.leave < 0.0) return false;
    hit = {chord.enter, chord.normal};
    if (chord.enter < 0.0) {
        hit.fraction = 0.0;
        hit.normal = (-1.0 / length(ray.translation)) * ray.translation;
        hit.inside = true;
    }
    return true;
}
// Each is false where the line misses the solid. The line is endless: max_fraction plays no part.
bool chord_of_ball(const LocalRay& line, Vec3d centre, double radius, Chord& chord);
// Between y = bottom and y = top, of radius `bottom_radius` there and `top_radius` here.
bool chord_of_frustum(const LocalRay& line, double bottom, double top, double bottom_radius, double top_radius,
                      Chord& chord);
// The hull of two balls about y = -half_height and y = half_height.
bool chord_of_two_balls(const LocalRay& line, double half_height, double bottom_radius, double top_radius,
                        Chord& chord);
bool chord_of_hull(const LocalRay& line, const HullData& hull, Chord& chord);

// The slab test of Kay and Kajiya 1986, without branches: which faces a line passes first cannot be foreseen. Of faces
// through whose edge it enters the first axis counts.
LENDULET_FORCE_INLINE bool chord_of_box(const LocalRay& line, Vec3d half, Chord& chord) {
    const double origin[3] = {line.origin.x, line.origin.y, line.origin.z}, size[3] = {half.x, half.y, half.z};
    const double along[3] = {line.translation.x, line.translation.y, line.translation.z};
    double sign[3], enter = -infinite_fraction, leave = infinite_fraction;
    int axis = -1;
    bool beside = false;
    for (int k = 0; k < 3; ++k) {
        const double speed = absolute(along[k]);
        sign[k] = __builtin_copysign(1.0, along[k]);
        const double at = sign[k] * origin[k], in = -((size[k] + at) / speed), out = (size[k] - at) / speed;
        const bool moves = speed > 0.0, later = moves & (in > enter);
        beside |= !moves & (size[k] < absolute(origin[k]));
        enter = later ? in : enter;
        axis = later ? k : axis;
        leave = (moves & !(leave < out)) ? out : leave;
    }
    auto component = [&](int k) { return axis == k ? -sign[k] : 0.0; };
    chord = {enter, leave, {component(0), component(1), component(2)}};
    return !beside & (enter <= leave);
}

bool cast_ray_triangles(const TriangleSurface& surface, const LocalRay& ray, LocalRayHit& hit);

}  // namespace lendulet
