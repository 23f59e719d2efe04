// The test of MeshFilter, W triangles side by side. Included by units that define a namespace of their own for it.

namespace mesh_filter {

constexpr int directions = 4;  // the normal and three sides

template <class F>
LENDULET_FORCE_INLINE F height_of_box(Vec3 centre, Vec3 half, Vec3T<F> d) {
    return dot(splat<F>(centre), d) + dot(splat<F>(half), absolute(d));
}

// The farthest point along d[0] is `lowest`; false where it was not looked for.
template <class F>
LENDULET_FORCE_INLINE bool heights_of_hull(const MeshFilterBatch& b, const Vec3T<F> (&d)[directions],
                                           F (&out)[directions], Vec3T<F>& lowest) {
    if (b.hull_count == 0) {
        for (int k = 0; k < directions; ++k) out[k] = height_of_box(b.box_centre, b.box_half, d[k]);
        return false;
    }
    for (int k = 0; k < directions; ++k) out[k] = splat<F>(-3e38f);
    for (int i = 0; i < b.hull_count; ++i) {
        const Vec3T<F> p = splat<F>(b.hull[i]);
        const F along = dot(p, d[0]);
        auto farther = along > out[0];
        out[0] = select(farther, along, out[0]);
        lowest = select(farther, p, lowest);
        for (int k = 1; k < directions; ++k) out[k] = maximum(dot(p, d[k]), out[k]);
    }
    return true;
}

// How far the core reaches along each direction (as support_core does, for directions of any length), or farther.
template <class F>
LENDULET_FORCE_INLINE bool heights(const MeshFilterBatch& b, const Vec3T<F> (&d)[directions], F (&out)[directions],
                                   Vec3T<F>& lowest) {
    const Vec3 size = b.shape->size;
    const F bottom = splat<F>(size.x), half = splat<F>(size.y), top = splat<F>(size.z), zero{};
    const GeometryKind kind = b.shape->kind;
    if (kind == GeometryKind::segment) {
        for (int k = 0; k < directions; ++k) out[k] = half * absolute(d[k].y);
        lowest.y = select(d[0].y >= zero, half, -half);
        return true;
    }
    if (kind == GeometryKind::box) {
        for (int k = 0; k < directions; ++k) out[k] = dot(splat<F>(size), absolute(d[k]));
        lowest = {select(d[0].x >= zero, bottom, -bottom), select(d[0].y >= zero, half, -half),
                  select(d[0].z >= zero, top, -top)};
        return true;
    }
    if (kind == GeometryKind::hull) return heights_of_hull(b, d, out, lowest);
    if (kind == GeometryKind::tapered_capsule || kind == GeometryKind::tapered_cylinder) {
        for (int k = 0; k < directions; ++k) {
            const F across = d[k].x * d[k].x + d[k].z * d[k].z;
            const F spread = square_root(kind == GeometryKind::tapered_cylinder ? across : across + d[k].y * d[k].y);
            out[k] = maximum(bottom * spread - half * d[k].y, top * spread + half * d[k].y);
        }
        return false;
    }
    for (int k = 0; k < directions; ++k) out[k] = zero;
    return kind == GeometryKind::point;
}

template <class F>
LENDULET_FORCE_INLINE Vec3T<F> times(const Mat3& m, Vec3T<F> v) {
    return v.x * splat<F>(m.x) + v.y * splat<F>(m.y) + v.z * splat<F>(m.z);
}

// The boxes of the triangles.
template <class F>
struct Boxes {
    Vec3T<F> lower, upper;
};
template <class F>
LENDULET_FORCE_INLINE Boxes<F> boxes_of(const Vec3T<F> (&p)[3]) {
    Boxes<F> b{p[0], p[0]};
    for (int k = 1; k < 3; ++k) {
        b.lower = {minimum(p[k].x, b.lower.x), minimum(p[k].y, b.lower.y), minimum(p[k].z, b.lower.z)};
        b.upper = {maximum(p[k].x, b.upper.x), maximum(p[k].y, b.upper.y), maximum(p[k].z, b.upper.z)};
    }
    return b;
}

// How far they are from one box along the axis that separates best.
template <class F>
LENDULET_FORCE_INLINE F gap(const Boxes<F>& b, Vec3 box_lower, Vec3 box_upper) {
    const Vec3T<F> below = b.lower - splat<F>(box_upper), above = splat<F>(box_lower) - b.upper;
    return maximum(maximum(maximum(below.x, above.x), maximum(below.y, above.y)), maximum(below.z, above.z));
}

// Where they meet one box.
template <class F>
LENDULET_FORCE_INLINE auto meet(const Boxes<F>& b, Vec3 box_lower, Vec3 box_upper) {
    const Vec3T<F> low = splat<F>(box_lower), high = splat<F>(box_upper);
    return (b.lower.x <= high.x) & (b.lower.y <= high.y) & (b.lower.z <= high.z) & (b.upper.x >= low.x) &
           (b.upper.y >= low.y) & (b.upper.z >= low.z);
}

template <class F>
LENDULET_FORCE_INLINE Vec3T<F> load(const float (&rows)[3][MeshFilterBatch::room], int first) {
    return {load_wide<F>(rows[0] + first), load_wide<F>(rows[1] + first), load_wide<F>(rows[2] + first)};
}

// The number of the face that looks along a unit direction, of which best_face() gives all such directions the same;
// -1: of other shapes.
template <class F>
LENDULET_FORCE_INLINE F facing(const MeshFilterBatch& b, Vec3T<F> d) {
    const F zero{}, one = splat<F>(1.0f), two = splat<F>(2.0f);
    if (b.shape->kind == GeometryKind::box) {
        const F x = absolute(d.x), y = absolute(d.y), z = absolute(d.z);
        auto by_x = (x >= y) & (x >= z), by_y = y >= z;
        const F along = select(by_x, d.x, select(by_y, d.y, d.z));
        return select(by_x, zero, select(by_y, two, two + two)) + select(along >= zero, one, zero);
    }
    if (b.shape->kind == GeometryKind::segment) {
        const F end = select(d.y > zero, one, zero);
        return select(absolute(d.y) <= splat<F>(segment_side_sine), two, end);
    }
    return splat<F>(-1.0f);
}

// The same of a hull of few corners, which the triangles are tested against on the way.
template <class F, class M>
LENDULET_FORCE_INLINE F facing_hull(const MeshFilterBatch& b, Vec3T<F> d, const Vec3T<F> (&p)[3], M& within_limit) {
    F number = splat<F>(-1.0f), best = splat<F>(-3e38f);
    for (int i = 0; i < b.hull_faces; ++i) {
        const Vec3T<F> normal = splat<F>(b.hull_face[i].normal);
        const F along = dot(normal, d),
                nearest = minimum(minimum(dot(normal, p[0]), dot(normal, p[1])), dot(normal, p[2]));
        auto better = along > best;
        best = select(better, along, best), number = select(better, splat<F>(static_cast<float>(i)), number);
        within_limit = within_limit & (nearest <= splat<F>(b.hull_face[i].offset + b.limit));
    }
    return number;
}

template <class F>
LENDULET_FORCE_INLINE void pack(float (&rows)[3][MeshFilterBatch::room], int first, uint32_t bits, Vec3T<F> v) {
    store_packed(rows[0] + first, bits, v.x);
    store_packed(rows[1] + first, bits, v.y);
    store_packed(rows[2] + first, bits, v.z);
}

template <int W>
LENDULET_FORCE_INLINE void test_block(MeshFilterBatch& b, int first, uint32_t used) {
    using F = Wide<float, W>;
    using V = Vec3T<F>;
    const F zero{};
    V p[3];
    for (int k = 0; k < 3; ++k) p[k] = load<F>(b.corner[k], first) - splat<F>(b.position);
    F away_from = gap(boxes_of(p), b.lower, b.upper);
    auto near = away_from <= zero;
    if ((mask_bits(near) & used) == 0) return store_wide(b.away + first, away_from);

    V normal = load<F>(b.front, first);
    auto behind = dot(normal, splat<F>(b.centre) - p[0]) < zero;
    normal = times(b.to_shape, normal);
    for (V& v : p) v = times(b.to_shape, v);
    V away[directions] = {select(behind, normal, -normal)}, out[3];  // away: where to look for what is nearest
    for (int k = 0; k < 3; ++k) {
        out[k] = cross(p[(k + 1) % 3] - p[k], normal);
        away[k + 1] = -out[k];
    }
    F reach[directions], size[3];
    V lowest{zero, zero, zero};
    b.has_lowest = heights(b, away, reach, lowest);
    const F height = dot(away[0], p[0]) - reach[0], limit = splat<F>(b.limit);
    auto live = near & (height <= limit);
    const F beyond = load_wide<F>(b.lean + first) * limit, outside = splat<F>(10.0f * b.slack);
    auto beside = zero > zero;
    F across = splat<F>(-3e38f), longest = zero;
    for (int k = 0; k < 3; ++k) {
        size[k] = length(out[k]);
        longest = maximum(size[k], longest);
        const F separation = -reach[k + 1] - dot(out[k], p[k]);
        across = maximum(separation - beyond * size[k], across);
        live = live & (separation <= beyond * size[k]);
        beside = beside | (separation > outside * size[k]);
    }
    away_from = maximum(maximum(height - limit, across / longest), away_from);
    store_wide(b.away + first, away_from);
    auto within_limit = meet(boxes_of(p), b.box_lower, b.box_upper);
    live = live & (within_limit | (height < zero));
    if ((mask_bits(live) & used) == 0) return;
    F face;
    if (b.hull_faces == 0) face = facing(b, away[0]);
    else face = facing_hull(b, away[0], p, within_limit);
    live = live & (within_limit | (height < zero));
    if (b.shape->kind != GeometryKind::point) {
        auto far = live & ~within_limit & beside;
        const uint32_t far_bits = mask_bits(far) & used;
        store_numbers<F>(b.far_number + b.far, far_bits, static_cast<uint32_t>(first));
        store_packed(b.far_behind + b.far, far_bits, select(behind, splat<F>(1.0f), zero));
        b.far += __builtin_popcount(far_bits);
        live = live & ~far;
    }
    const uint32_t bits = mask_bits(live) & used;

    auto flag = [&](auto mask, int value) { return select(mask, splat<F>(static_cast<float>(value)), zero); };
    F flags = flag(~within_limit, MeshFilterBatch::apart) + flag(behind, MeshFilterBatch::behind) +
              flag(beside, MeshFilterBatch::beside);
    if (b.has_lowest) {
        const F slack = splat<F>(b.slack) + splat<F>(half_gentle_tangent) * maximum(zero, -height);
        for (int k = 0; k < 3; ++k) {
            auto within = dot(out[k], lowest - p[k]) < -slack * size[k];
            flags += flag(~within, 1 << (MeshFilterBatch::first_beyond + k));
        }
        pack(b.lowest, b.live, bits, lowest);
    }
    store_numbers<F>(b.number + b.live, bits, static_cast<uint32_t>(first));
    for (int k = 0; k < 3; ++k) pack(b.p[k], b.live, bits, p[k]);
    pack(b.normal, b.live, bits, -away[0]);
    store_packed(b.flags + b.live, bits, flags);
    store_packed(b.face + b.live, bits, face);
    b.live += __builtin_popcount(bits);
}

}  // namespace mesh_filter

template <int W>
void filter_triangles(MeshFilterBatch& batch) {
    batch.live = batch.far = 0;
    batch.has_lowest = false;
    for (int first = 0; first < batch.count; first += W) {
        const int left = batch.count - first;
        mesh_filter::test_block<W>(batch, first, left < W ? (1u << left) - 1u : ~0u >> (32 - W));
    }
}
