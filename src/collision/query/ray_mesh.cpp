// Rays against triangle meshes.
#include "collision/query/mesh_walk.h"
#include "collision/query/ray.h"

namespace lendulet {
namespace {

// Fraction at which the ray passes through the triangle, from either side; infinity where it does not.
//
// The edge functions are the volumes of the ray's direction with two corners, corners taken from the ray's origin. An
// edge that two triangles share gives both the same number with opposite signs, to the last bit, and zero counts for
// either: no ray slips through between neighbours. (Woop, Benthin, Wald, "Watertight ray/triangle intersection", 2013)
double pass_through(const LocalRay& ray, const Vec3d (&p)[3]) {
    constexpr double never = 1e300;
    Vec3d a = p[0] - ray.origin, b = p[1] - ray.origin, c = p[2] - ray.origin;
    double u = dot(ray.translation, cross(b, c)), v = dot(ray.translation, cross(c, a));
    double w = dot(ray.translation, cross(a, b));
    bool outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
    Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    double along = dot(normal, ray.translation);
    if (outside || along == 0.0) return never;
    double t = dot(normal, a) / along;
    return t >= 0.0 ? t : never;
}

}  // namespace

bool cast_ray_mesh(const MeshData& mesh, const LocalRay& ray, LocalRayHit& hit) {
    uint32_t best = ~0u;
    double limit = ray.max_fraction;
    walk_along(mesh, {ray.origin, ray.translation, {}}, limit, [&](uint32_t index) {
        const MeshTriangle& t = mesh.triangles[index];
        Vec3d p[3];
        for (int i = 0; i < 3; ++i) p[i] = to_double(mesh.vertices[t.vertex[i]]);
        double fraction = pass_through(ray, p);
        bool first = fraction < limit || (fraction <= limit && best == ~0u) ||
                     (fraction == limit && t.original < mesh.triangles[best].original);
        if (first) limit = fraction, best = index;
        return limit;
    });
    if (best == ~0u) return false;
    Vec3d normal = to_double(mesh.normals[best]);
    hit = {limit, dot(normal, ray.translation) > 0.0 ? -normal : normal};
    hit.triangle = static_cast<int32_t>(mesh.triangles[best].original);
    return true;
}

}  // namespace lendulet
