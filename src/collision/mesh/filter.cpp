#include "collision/mesh/filter.h"

#include "collision/mesh/footing.h"
#include "geometry/hull.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

using F = Wide<float, MeshFilter::lanes>;
using V = Vec3T<F>;

// Hulls of more corners are taken for their boxes here.
constexpr size_t most_corners = 32;
constexpr int directions = 4;  // the normal and three sides

F height_of_box(Vec3 centre, Vec3 half, V d) { return dot(splat<F>(centre), d) + dot(splat<F>(half), absolute(d)); }

// The farthest point along d[0] is `lowest`; false where it was not looked for.
bool heights_of_hull(const Geometry& g, const V (&d)[directions], F (&out)[directions], V& lowest) {
    const HullData& hull = *g.hull;
    if (hull.vertices.size() > most_corners) {
        Vec3 centre = 0.5f * (hull.lower + hull.upper), half = 0.5f * (hull.upper - hull.lower);
        for (int k = 0; k < directions; ++k) out[k] = height_of_box(centre, half, d[k]);
        return false;
    }
    for (int k = 0; k < directions; ++k) out[k] = splat<F>(-3e38f);
    for (Vec3 corner : hull.vertices) {
        const V p = splat<F>(corner);
        const F along = dot(p, d[0]);
        auto farther = along > out[0];
        out[0] = select(farther, along, out[0]);
        lowest = select(farther, p, lowest);
        for (int k = 1; k < directions; ++k) out[k] = maximum(dot(p, d[k]), out[k]);
    }
    return true;
}

// How far the core reaches along each direction (as support_core does, for directions of any length), or farther.
bool heights(const Geometry& g, const V (&d)[directions], F (&out)[directions], V& lowest) {
    F bottom = splat<F>(g.size.x), half = splat<F>(g.size.y), top = splat<F>(g.size.z);
    auto ends = [&](int k, F spread) {
        out[k] = maximum(bottom * spread - half * d[k].y, top * spread + half * d[k].y);
    };
    switch (g.kind) {
        case GeometryKind::segment:
            for (int k = 0; k < directions; ++k) out[k] = half * absolute(d[k].y);
            lowest.y = select(d[0].y >= F{}, half, -half);
            return true;
        case GeometryKind::box:
            for (int k = 0; k < directions; ++k) out[k] = height_of_box({}, g.size, d[k]);
            lowest = {select(d[0].x >= F{}, bottom, -bottom), select(d[0].y >= F{}, half, -half),
                      select(d[0].z >= F{}, top, -top)};
            return true;
        case GeometryKind::tapered_capsule:
            for (int k = 0; k < directions; ++k) ends(k, length(d[k]));
            return false;
        case GeometryKind::tapered_cylinder:
            for (int k = 0; k < directions; ++k) ends(k, square_root(d[k].x * d[k].x + d[k].z * d[k].z));
            return false;
        case GeometryKind::hull:
            return heights_of_hull(g, d, out, lowest);
        case GeometryKind::point:
        case GeometryKind::triangle:
        case GeometryKind::plane:
        case GeometryKind::mesh:
        case GeometryKind::height_field:
            break;
    }
    for (int k = 0; k < directions; ++k) out[k] = F{};
    return g.kind == GeometryKind::point;
}

// Vectors of up to four triangles side by side.
struct Rows {
    float x[MeshFilter::lanes], y[MeshFilter::lanes], z[MeshFilter::lanes];
    void set(int i, Vec3 v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
    V load() const { return {load_wide<F>(x), load_wide<F>(y), load_wide<F>(z)}; }
};

V times(const Mat3& m, V v) { return v.x * splat<F>(m.x) + v.y * splat<F>(m.y) + v.z * splat<F>(m.z); }

// The boxes of the triangles.
struct Boxes {
    V lower, upper;
    explicit Boxes(const V (&p)[3]) : lower(p[0]), upper(p[0]) {
        for (int k = 1; k < 3; ++k) {
            lower = {minimum(p[k].x, lower.x), minimum(p[k].y, lower.y), minimum(p[k].z, lower.z)};
            upper = {maximum(p[k].x, upper.x), maximum(p[k].y, upper.y), maximum(p[k].z, upper.z)};
        }
    }
};

// Where they meet one box.
auto meet(const Boxes& b, Vec3 box_lower, Vec3 box_upper) {
    V low = splat<F>(box_lower), high = splat<F>(box_upper);
    return (b.lower.x <= high.x) & (b.lower.y <= high.y) & (b.lower.z <= high.z) & (b.upper.x >= low.x) &
           (b.upper.y >= low.y) & (b.upper.z >= low.z);
}

}  // namespace

MeshFilter::MeshFilter(const TriangleSurface& surface, const Geometry& shape, Quat turn, Vec3 position, Vec3 lower,
                       Vec3 upper, Vec3 centre, float limit, float slack)
    : surface_(surface),
      shape_(shape),
      to_shape_(rotation_matrix(conjugate(turn))),
      position_(position),
      lower_(lower),
      upper_(upper),
      centre_(centre),
      limit_(limit + slack),
      slack_(slack) {
    CentredBox box = bounds(shape, {0.0f, 0.0f, 0.0f, 1.0f});
    float reach = limit_ - shape.rounding;
    Vec3 half = box.half + Vec3{reach, reach, reach};
    box_lower_ = box.centre - half;
    box_upper_ = box.centre + half;
}

void MeshFilter::test(const uint32_t* triangles, int count, Result& result) const {
    Rows corner[3], front;
    float lean[lanes];                 // most that the direction of the shortest distance leans across a side, as sine
    for (int i = 0; i < lanes; ++i) {  // lanes beyond the last repeat the first
        uint32_t index = triangles[i < count ? i : 0];
        Vec3 corners[3];
        surface_.corners(index, corners);
        for (int k = 0; k < 3; ++k) corner[k].set(i, corners[k]);
        front.set(i, surface_.normal(index));
        lean[i] = surface_.sharp_edges(index) == 0 ? gentle_edge_sine : 1.0f;  // beyond it the neighbour is nearer
    }
    V p[3];
    for (int k = 0; k < 3; ++k) p[k] = corner[k].load() - splat<F>(position_);
    auto near = meet(Boxes(p), lower_, upper_);
    uint32_t used = (1u << count) - 1u;
    result.live = result.apart = 0;
    if ((mask_bits(near) & used) == 0) return;

    V normal = front.load();
    auto behind = dot(normal, splat<F>(centre_) - p[0]) < F{};
    normal = times(to_shape_, normal);
    for (V& v : p) v = times(to_shape_, v);
    V away[directions] = {select(behind, normal, -normal)}, out[3];  // away: where to look for what is nearest
    F reach[directions], size[3];
    for (int k = 0; k < 3; ++k) {
        out[k] = cross(p[(k + 1) % 3] - p[k], normal);
        away[k + 1] = -out[k];
    }
    V lowest{};
    result.has_lowest = heights(shape_, away, reach, lowest);
    F height = dot(away[0], p[0]) - reach[0], limit = splat<F>(limit_);
    auto live = near & (height <= limit);
    const F beyond = load_wide<F>(lean) * limit;
    const F outside = splat<F>(10.0f * slack_), zero{};
    auto aside = zero > zero;
    for (int k = 0; k < 3; ++k) {
        size[k] = length(out[k]);
        const F separation = -reach[k + 1] - dot(out[k], p[k]);
        live = live & (separation <= beyond * size[k]);
        aside = aside | (separation > outside * size[k]);
    }
    auto within_limit = meet(Boxes(p), box_lower_, box_upper_);
    live = live & (within_limit | (height < zero));
    result.live = mask_bits(live) & used;
    if (result.live == 0) return;
    result.apart = ~mask_bits(within_limit) & used;
    result.behind = mask_bits(behind);
    result.beside = mask_bits(aside);
    if (!result.has_lowest) return;
    const F slack = splat<F>(slack_) + splat<F>(half_gentle_tangent) * maximum(zero, -height);
    for (int k = 0; k < 3; ++k)
        result.beyond[k] = ~mask_bits(dot(out[k], lowest - p[k]) < -slack * size[k]);
    store_wide(result.x, lowest.x), store_wide(result.y, lowest.y), store_wide(result.z, lowest.z);
}

}  // namespace lendulet
