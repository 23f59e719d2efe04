// Rays against meshes and height fields.
#include "collision/query/mesh_walk.h"
#include "collision/query/ray.h"

namespace lendulet {
namespace {

// Fraction at which the ray passes through the triangle, from either side or from before it; infinity where it does
// not.
//
// The edge functions are the volumes of the ray's direction with two corners, corners taken from the ray's origin. An
// edge that two triangles share gives both the same number with opposite signs, to the last bit, and zero counts for
// either: no ray slips through between neighbours. (Woop, Benthin, Wald, "Watertight ray/triangle intersection", 2013)
double pass_through(const LocalRay& ray, const Vec3d (&p)[3], bool one_sided) {
    constexpr double never = 1e300;
    Vec3d a = p[0] - ray.origin, b = p[1] - ray.origin, c = p[2] - ray.origin;
    double u = dot(ray.translation, cross(b, c)), v = dot(ray.translation, cross(c, a));
    double w = dot(ray.translation, cross(a, b));
    bool outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
    Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    double along = dot(normal, ray.translation);
    if (outside || along == 0.0 || (one_sided && along > 0.0)) return never;
    double t = dot(normal, a) / along;
    return t >= 0.0 ? t : never;
}

}  // namespace

bool cast_ray_triangles(const TriangleSurface& surface, const LocalRay& ray, LocalRayHit& hit) {
    uint32_t best = ~0u;
    double limit = ray.max_fraction;
    walk_along(surface, {ray.origin, ray.translation, {}}, limit, [&](uint32_t index) {
        Vec3 corners[3];
        surface.corners(index, corners);
        const Vec3d p[3] = {to_double(corners[0]), to_double(corners[1]), to_double(corners[2])};
        double fraction = pass_through(ray, p, surface.one_sided());
        bool first = fraction < limit || (fraction <= limit && best == ~0u) ||
                     (fraction == limit && surface.original(index) < surface.original(best));
        if (first) limit = fraction, best = index;
        return limit;
    });
    if (best == ~0u) return false;
    Vec3d normal = to_double(surface.normal(best));
    hit = {limit, dot(normal, ray.translation) > 0.0 ? -normal : normal};
    hit.triangle = static_cast<int32_t>(surface.original(best));
    return true;
}

}  // namespace lendulet
