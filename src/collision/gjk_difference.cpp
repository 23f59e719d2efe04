// Farthest points of cores and of their difference.
#include "collision/gjk_difference.h"

namespace lendulet {
namespace {

// Farthest corner of a hull along d, local frame.
LENDULET_FORCE_INLINE Vec3 support_corner(const Geometry& g, Vec3 d) {
    Vec3 corner = g.hull->vertices[support_vertex(*g.hull, d)];
    return g.size.x == 0.0f ? corner : corner - g.size.x * (corner - g.hull->centroid);
}

// Out of the range of float products (near contact v can be 1e-30 m long) only the direction is kept.
LENDULET_FORCE_INLINE Vec3d within_range(Vec3d d) {
    const double m = largest_component(d);
    if (m >= 1e-12 && m <= 1e12) return d;
    return (m > 0.0 ? 1.0 / m : 0.0) * d;
}

LENDULET_FORCE_INLINE Vec3d farthest(const Geometry& g, Vec3d d) {
    switch (g.kind) {
        case GeometryKind::point:
            return {};
        case GeometryKind::segment:
            return {0.0, towards_sign(g.size.y, d.y), 0.0};
        case GeometryKind::box:
            return {towards_sign(g.size.x, d.x), towards_sign(g.size.y, d.y), towards_sign(g.size.z, d.z)};
        case GeometryKind::tapered_capsule: {
            double r = length(d), bottom = g.size.x * r - g.size.y * d.y, top = g.size.z * r + g.size.y * d.y;
            double end = top >= bottom ? 1.0 : -1.0, s = (top >= bottom ? g.size.z : g.size.x) / r;
            if (!(r > 0.0)) return {0.0, end * g.size.y, 0.0};
            return {s * d.x, end * g.size.y + s * d.y, s * d.z};
        }
        case GeometryKind::tapered_cylinder: {
            double r = square_root(d.x * d.x + d.z * d.z);
            double bottom = g.size.x * r - g.size.y * d.y, top = g.size.z * r + g.size.y * d.y;
            double end = top >= bottom ? 1.0 : -1.0, s = r > 0.0 ? (top >= bottom ? g.size.z : g.size.x) / r : 0.0;
            return {s * d.x, end * g.size.y, s * d.z};
        }
        case GeometryKind::triangle: {
            Vec3d p = to_double(g.triangle[0]), q = to_double(g.triangle[1]), r = to_double(g.triangle[2]);
            double at_p = dot(d, p), at_q = dot(d, q), at_r = dot(d, r);
            return at_p >= at_q && at_p >= at_r ? p : at_q >= at_r ? q : r;
        }
        case GeometryKind::hull:
            return to_double(support_corner(g, to_float(within_range(d))));
        default:
            return {};
    }
}

}  // namespace

Vec3d support_point(const Geometry& g, Vec3d d) { return farthest(g, d); }

Vec3d snap_to_curved(const Geometry& g, Vec3d p) {
    Vec3d bottom{p.x, p.y + g.size.y, p.z}, top{p.x, p.y - g.size.y, p.z};
    bool at_top = absolute(top.y) < absolute(bottom.y);
    if (g.kind == GeometryKind::tapered_cylinder) bottom.y = top.y = 0.0;
    double rb = length(bottom), rt = length(top);
    if (g.kind == GeometryKind::tapered_capsule) at_top = absolute(rt - g.size.z) < absolute(rb - g.size.x);
    Vec3d q = at_top ? top : bottom;
    double r = at_top ? rt : rb, radius = at_top ? g.size.z : g.size.x;
    Vec3d centre{0.0, at_top ? g.size.y : -g.size.y, 0.0};
    const Vec3d snapped = r > 0.5 * radius ? centre + (radius / r) * q : centre;
    constexpr double rounding = 2e-7;  // of the size
    return largest_component(snapped - p) <= rounding * (g.size.y + radius) ? snapped : p;
}

DifferencePoint CoreDifference::support(Vec3d d) const {
    if (a.kind == GeometryKind::hull && b.kind == GeometryKind::hull) {
        d = within_range(d);
        const Vec3 pa = support_corner(a, to_float(-d));
        const Vec3 pb = support_corner(b, to_float(transpose_multiply(rotation, d)));
        return {translation + rotation * to_double(pb) - to_double(pa), pa, pb};
    }
    const Vec3d pa = farthest(a, -d), pb = farthest(b, transpose_multiply(rotation, d));
    return {translation + rotation * pb - pa, to_float(pa), to_float(pb)};
}

}  // namespace lendulet
