#include "collision/query/proximity.h"

#include "collision/gjk.h"
#include "collision/gjk_difference.h"
#include "collision/query/mesh_walk.h"

namespace lendulet {
namespace {

bool nearness_convex(const PlacedPair& p, double limit, Nearness& out) {
    Vec3 between = to_float(transpose_multiply(exact_rotation(p.rotation_a), p.offset));
    double radii = static_cast<double>(p.a->rounding) + p.b->rounding;
    GjkCache cold;
    auto far = static_cast<float>(minimum(limit + radii, 3e37) * 1.000001);  // rounded up
    ConvexDistance d =
        distance({p.a, p.b, {between, conjugate(p.rotation_a) * p.rotation_b}}, cold, SimplexSolver::half_space, far);
    out.distance = d.distance - radii;
    if (out.distance > limit) return false;
    Mat3d r = exact_rotation(p.rotation_a);
    out.normal = r * to_double(d.normal);
    out.point_a = r * to_double(d.point_a) + static_cast<double>(p.a->rounding) * out.normal;
    out.point_b = r * to_double(d.point_b) - static_cast<double>(p.b->rounding) * out.normal;
    return true;
}

bool nearness_plane(const PlacedPair& p, double limit, Nearness& out) {
    Mat3d r = exact_rotation(p.rotation_b);
    out.normal = exact_rotation(p.rotation_a) * to_double(p.a->size);
    Vec3d lowest = p.offset + r * support_point(*p.b, transpose_multiply(r, -out.normal));
    double height = dot(out.normal, lowest) - p.a->offset;
    out.distance = height - p.b->rounding;
    out.point_a = lowest - height * out.normal;
    out.point_b = lowest - static_cast<double>(p.b->rounding) * out.normal;
    return out.distance <= limit;
}

// The nearest triangle, or of several that overlap the one that is farthest from leaving.
bool nearness_triangles(const PlacedPair& p, double limit, Nearness& out) {
    Vec3d between = transpose_multiply(exact_rotation(p.rotation_a), p.offset);
    CentredBox box = bounds(*p.b, conjugate(p.rotation_a) * p.rotation_b);
    Vec3 centre = to_float(between) + box.centre;
    float slack = static_cast<float>(mesh_walk::margin) * (max_component(absolute(centre)) + max_component(box.half));
    Vec3 half = box.half + Vec3{slack, slack, slack};
    bool any = false;
    double now = limit;
    const TriangleSurface surface(*p.a);
    walk_outwards(surface, to_double(centre - half), to_double(centre + half), limit, [&](uint32_t index) {
        Vec3 corners[3];
        surface.corners(index, corners);
        Geometry core;
        core.kind = GeometryKind::triangle;
        core.triangle = corners;
        PlacedPair part = p;
        part.a = &core;
        Nearness found;
        if (!nearness_convex(part, now, found)) return now;
        auto original = static_cast<int32_t>(surface.original(index));
        if (any && !(found.distance < out.distance || (found.distance == out.distance && original < out.triangle)))
            return now;
        any = true;
        out = found;
        out.triangle = original;
        return now = maximum(found.distance, 0.0);
    });
    return any;
}

}  // namespace

bool nearness(const PlacedPair& pair, double limit, Nearness& out) {
    out = {};
    if (has_triangles(*pair.a)) return nearness_triangles(pair, limit, out);
    if (pair.a->kind == GeometryKind::plane) return nearness_plane(pair, limit, out);
    return nearness_convex(pair, limit, out);
}

bool touching(const PlacedPair& pair) {
    Nearness ignored;
    return nearness(pair, 0.0, ignored);
}

}  // namespace lendulet
