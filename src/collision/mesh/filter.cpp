#include "collision/mesh/filter.h"

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

void heights_of_hull(const Geometry& g, const V (&d)[directions], F (&out)[directions]) {
    const HullData& hull = *g.hull;
    if (hull.vertices.size() > most_corners) {
        Vec3 centre = 0.5f * (hull.lower + hull.upper), half = 0.5f * (hull.upper - hull.lower);
        for (int k = 0; k < directions; ++k) out[k] = height_of_box(centre, half, d[k]);
        return;
    }
    for (int k = 0; k < directions; ++k) out[k] = splat<F>(-3e38f);
    for (Vec3 corner : hull.vertices) {
        V p = splat<F>(corner);
        for (int k = 0; k < directions; ++k) out[k] = maximum(dot(p, d[k]), out[k]);
    }
}

// How far the core reaches along each direction (as support_core does, for directions of any length), or farther.
void heights(const Geometry& g, const V (&d)[directions], F (&out)[directions]) {
    F bottom = splat<F>(g.size.x), half = splat<F>(g.size.y), top = splat<F>(g.size.z);
    auto ends = [&](int k, F spread) {
        out[k] = maximum(bottom * spread - half * d[k].y, top * spread + half * d[k].y);
    };
    switch (g.kind) {
        case GeometryKind::segment:
            for (int k = 0; k < directions; ++k) out[k] = half * absolute(d[k].y);
            return;
        case GeometryKind::box:
            for (int k = 0; k < directions; ++k) out[k] = height_of_box({}, g.size, d[k]);
            return;
        case GeometryKind::tapered_capsule:
            for (int k = 0; k < directions; ++k) ends(k, length(d[k]));
            return;
        case GeometryKind::tapered_cylinder:
            for (int k = 0; k < directions; ++k) ends(k, square_root(d[k].x * d[k].x + d[k].z * d[k].z));
            return;
        case GeometryKind::hull:
            return heights_of_hull(g, d, out);
        case GeometryKind::point:
        case GeometryKind::triangle:
        case GeometryKind::plane:
        case GeometryKind::mesh:
        case GeometryKind::height_field:
            break;
    }
    for (int k = 0; k < directions; ++k) out[k] = F{};
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
      limit_(limit + slack) {
    CentredBox box = bounds(shape, {0.0f, 0.0f, 0.0f, 1.0f});
    float reach = limit_ - shape.rounding;
    Vec3 half = box.half + Vec3{reach, reach, reach};
    box_lower_ = box.centre - half;
    box_upper_ = box.centre + half;
}

MeshFilter::Result MeshFilter::test(const uint32_t* triangles, int count) const {
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
    if ((mask_bits(near) & used) == 0) return {};

    V normal = front.load();
    auto behind = dot(normal, splat<F>(centre_) - p[0]) < F{};
    normal = times(to_shape_, normal);
    for (V& v : p) v = times(to_shape_, v);
    V away[directions] = {select(behind, normal, -normal)}, out[3];  // away: where to look for what is nearest
    F reach[directions];
    for (int k = 0; k < 3; ++k) {
        out[k] = cross(p[(k + 1) % 3] - p[k], normal);
        away[k + 1] = -out[k];
    }
    heights(shape_, away, reach);
    F height = dot(away[0], p[0]) - reach[0], limit = splat<F>(limit_);
    auto live = near & (height <= limit);
    const F beyond = load_wide<F>(lean) * limit;
    for (int k = 0; k < 3; ++k) live = live & (-reach[k + 1] - dot(out[k], p[k]) <= beyond * length(out[k]));
    auto beside = meet(Boxes(p), box_lower_, box_upper_);
    live = live & (beside | (height < F{}));
    return {mask_bits(live) & used, ~mask_bits(beside) & used};
}

}  // namespace lendulet
