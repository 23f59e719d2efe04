// Which function casts a ray at which kind of shape.
#include "collision/query/ray.h"

#include "collision/query/cast.h"
#include "geometry/hull.h"

namespace lendulet {
namespace {

// Hulls of more faces are cast at by distances, whose cost grows with the logarithm of the corners.
constexpr size_t clipped_faces = 256;

bool cast_ray_plane(const Geometry& g, const LocalRay& ray, LocalRayHit& hit) {
    Vec3d normal = to_double(g.size);
    double height = dot(normal, ray.origin) - g.offset, along = dot(normal, ray.translation);
    if (height < 0.0) return from_chord({-1.0, 0.0, normal}, ray, hit);
    if (height == 0.0) return from_chord({0.0, 0.0, normal}, ray, hit);
    if (!(along < 0.0)) return false;
    return from_chord({-height / along, ray.max_fraction, normal}, ray, hit);
}

// A point that moves towards a rounded core.
bool cast_ray_rounded(const Geometry& g, const LocalRay& ray, LocalRayHit& hit) {
    static constexpr Geometry point{};
    Motion still, moving;
    moving.pivot = ray.origin;
    moving.translation = ray.translation;
    CastHit found;
    if (!cast_convex(g, still, point, moving, ray.max_fraction, found)) return false;
    hit = {found.fraction, found.normal};
    hit.inside = found.overlapping;
    if (hit.inside) hit.normal = (-1.0 / length(ray.translation)) * ray.translation;
    return true;
}

}  // namespace

bool cast_ray(const Geometry& g, const LocalRay& ray, LocalRayHit& hit) {
    Chord chord;
    switch (g.kind) {
        case GeometryKind::point:
            return chord_of_ball(ray, {}, g.rounding, chord) && from_chord(chord, ray, hit);
        case GeometryKind::segment:
        case GeometryKind::tapered_capsule:
            return chord_of_two_balls(ray, g.size.y, static_cast<double>(g.size.x) + g.rounding,
                                      static_cast<double>(g.size.z) + g.rounding, chord) &&
                   from_chord(chord, ray, hit);
        case GeometryKind::box:
            if (g.rounding > 0.0f) return cast_ray_rounded(g, ray, hit);
            return chord_of_box(ray, to_double(g.size), chord) && from_chord(chord, ray, hit);
        case GeometryKind::tapered_cylinder:
            if (g.rounding > 0.0f) return cast_ray_rounded(g, ray, hit);
            return chord_of_frustum(ray, -g.size.y, g.size.y, g.size.x, g.size.z, chord) && from_chord(chord, ray, hit);
        case GeometryKind::hull:
            if (g.rounding > 0.0f || g.hull->faces.size() > clipped_faces) return cast_ray_rounded(g, ray, hit);
            return chord_of_hull(ray, *g.hull, chord) && from_chord(chord, ray, hit);
        case GeometryKind::triangle:
            return cast_ray_rounded(g, ray, hit);
        case GeometryKind::plane:
            return cast_ray_plane(g, ray, hit);
        case GeometryKind::mesh:
        case GeometryKind::height_field:
            return cast_ray_triangles(TriangleSurface(g), ray, hit);
    }
    return false;
}

}  // namespace lendulet
