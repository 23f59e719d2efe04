// Searches over the vertices and faces of a hull: support points, best faces and extents, four lanes at a time,
// or eight where the machine has them.
//
// The result is that of a plain loop over all of them in order, to the bit: lanes compute the same products and sums,
// the largest value is exact, and of equal ones the first is taken.
#include <bit>
#include <cstdint>
#include <limits>

#include "geometry/hull.h"
#include "math/wide/instruction_sets.h"
#include "math/wide/wide.h"

namespace lendulet {

// Eight lanes at a time, in hull_scan_avx2.cpp.
uint32_t farthest_avx2(const float* xs, const float* ys, const float* zs, uint32_t count, Vec3 d);

namespace {

#include "geometry/hull_scan.inl"

using F = Wide<float, 4>;

Vec3T<F> load(const std::vector<float>& xs, const std::vector<float>& ys, const std::vector<float>& zs, uint32_t i) {
    return {load_wide<F>(&xs[i]), load_wide<F>(&ys[i]), load_wide<F>(&zs[i])};
}

float smallest_lane(F a) { return minimum(minimum(a[0], a[1]), minimum(a[2], a[3])); }

Found scan(const std::vector<float>& xs, const std::vector<float>& ys, const std::vector<float>& zs, uint32_t first,
           uint32_t last, Vec3 d) {
    return scan<F>(&xs[first], &ys[first], &zs[first], first, last, d);
}

// Upper bounds of the dot products within four clusters.
LENDULET_FORCE_INLINE F cluster_bounds(const HullClusters& c, uint32_t i, Vec3T<F> d, Vec3T<F> size) {
    return dot(load(c.centre.xs, c.centre.ys, c.centre.zs, i), d) + dot(load(c.half.xs, c.half.ys, c.half.zs, i), size);
}

// Looks into the most promising cluster first, then only into those whose bound reaches what was found.
Found scan_clusters(const HullData& hull, Vec3 direction) {
    const HullClusters& c = hull.clusters;
    const Vec3T<F> d = splat<F>(direction);
    Vec3T<F> size = absolute(d);
    F top = splat<F>(-infinity);
    Wide<int32_t, 4> where{}, lanes = {0, 1, 2, 3};
    for (uint32_t i = 0; i < c.count; i += 4) {
        F bound = cluster_bounds(c, i, d, size);
        auto better = bound > top;
        top = better ? bound : top;
        where = better ? lanes + static_cast<int32_t>(i) : where;
    }
    int lane = 0;
    for (int k = 1; k < 4; ++k)
        if (top[k] > top[lane]) lane = k;
    auto start = static_cast<uint32_t>(where[lane]);
    if (start >= c.count) start = 0;
    Found best = scan(hull.xs, hull.ys, hull.zs, 16 * start, 16 * start + 16, direction);
    for (uint32_t i = 0; i < c.count; i += 4) {
        uint32_t open = mask_bits(cluster_bounds(c, i, d, size) >= splat<F>(best.value));
        for (; open != 0; open &= open - 1) {
            uint32_t k = i + static_cast<uint32_t>(std::countr_zero(open));
            if (k == start || k >= c.count) continue;
            Found found = scan(hull.xs, hull.ys, hull.zs, 16 * k, 16 * k + 16, direction);
            if (found.value > best.value || (found.value == best.value && found.index < best.index)) best = found;
        }
    }
    return best;
}

}  // namespace

uint32_t support_vertex(const HullData& hull, Vec3 direction) {
    if (hull.clusters.count != 0) return scan_clusters(hull, direction).index;
    const auto count = static_cast<uint32_t>(hull.xs.size());
#if defined(__x86_64__) && !defined(LENDULET_FOUR_LANES)
    if (cpu_has_avx2()) return farthest_avx2(hull.xs.data(), hull.ys.data(), hull.zs.data(), count, direction);
#endif
    return scan(hull.xs, hull.ys, hull.zs, 0, count, direction).index;
}

uint32_t support_face(const HullData& hull, Vec3 direction) {
    const HullLanes& n = hull.normals;
    return scan(n.xs, n.ys, n.zs, 0, static_cast<uint32_t>(n.xs.size()), direction).index;
}

HullExtents extents_along(const HullData& hull, const Vec3 (&axes)[3]) {
    HullExtents r;
    if (hull.clusters.count != 0) {
        for (int k = 0; k < 3; ++k) {
            set_component(r.upper, k, scan_clusters(hull, axes[k]).value);
            set_component(r.lower, k, -scan_clusters(hull, -axes[k]).value);
        }
        return r;
    }
    F low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = splat<F>(infinity), high[k] = splat<F>(-infinity);
    Vec3T<F> a[3] = {splat<F>(axes[0]), splat<F>(axes[1]), splat<F>(axes[2])};
    for (uint32_t i = 0; i < hull.xs.size(); i += 4) {
        Vec3T<F> p = load(hull.xs, hull.ys, hull.zs, i);
        for (int k = 0; k < 3; ++k) {
            F value = dot(p, a[k]);
            low[k] = minimum(value, low[k]);
            high[k] = maximum(value, high[k]);
        }
    }
    for (int k = 0; k < 3; ++k) {
        set_component(r.lower, k, smallest_lane(low[k]));
        set_component(r.upper, k, largest_lane(high[k]));
    }
    return r;
}

}  // namespace lendulet
