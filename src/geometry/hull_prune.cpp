#include <algorithm>

#include "geometry/hull_polygons.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
constexpr uint32_t none = ~0u;

double absolute_value(double a) { return a < 0.0 ? -a : a; }

uint32_t next_edge(uint32_t e) { return e % 3 == 2 ? e - 2 : e + 1; }

// Every triangle gets the number of a region. A region grows from the largest free triangle over all neighbours whose
// corners lie in its plane within the tolerance.
std::vector<uint32_t> flat_regions(std::span<const LatticePoint> points, const TriangleSurface& surface,
                                   double tolerance) {
    uint32_t count = surface.triangle_count();
    std::vector<TriangleNormal> normals(count);
    for (uint32_t t = 0; t < count; ++t) normals[t] = triangle_normal(points, surface, t);
    std::vector<uint32_t> region(count, none), front;
    for (uint32_t seed : triangles_by_area(normals)) {
        if (region[seed] != none) continue;
        region[seed] = seed;
        Vec3d normal = normals[seed].unit, origin = to_double(points[surface.corner[3 * seed]]);
        front.assign(1, seed);
        for (size_t i = 0; i < front.size(); ++i) {
            for (uint32_t k = 0; k < 3; ++k) {
                uint32_t twin = surface.twin[3 * front[i] + k], other = twin / 3;
                if (region[other] != none || dot(normals[other].unit, normal) < same_face_cosine) continue;
                uint32_t opposite = surface.corner[next_edge(next_edge(twin))];
                if (absolute_value(dot(normal, to_double(points[opposite]) - origin)) > tolerance) continue;
                region[other] = seed;
                front.push_back(other);
            }
        }
    }
    return region;
}

// Distance of p from the line through a and b.
double distance_to_line(Vec3d p, Vec3d a, Vec3d b) {
    Vec3d c = cross(p - a, b - a), line = b - a;
    double squared = dot(line, line);
    return squared > 0.0 ? __builtin_sqrt(dot(c, c) / squared) : 0.0;
}

}  // namespace

TriangleNormal triangle_normal(std::span<const LatticePoint> points, const TriangleSurface& surface,
                               uint32_t triangle) {
    const uint32_t* corner = &surface.corner[3 * size_t{triangle}];
    Vec3d a = to_double(points[corner[0]]);
    Vec3d n = cross(to_double(points[corner[1]]) - a, to_double(points[corner[2]]) - a);
    double norm = __builtin_sqrt(dot(n, n));
    return {(1.0 / norm) * n, norm};
}

std::vector<uint32_t> triangles_by_area(const std::vector<TriangleNormal>& normals) {
    std::vector<uint32_t> order(normals.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    // order: total, ties by index
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return normals[a].twice_area != normals[b].twice_area ? normals[a].twice_area > normals[b].twice_area : a < b;
    });
    return order;
}

std::vector<uint32_t> essential_corners(std::span<const LatticePoint> points, const TriangleSurface& surface,
                                        double tolerance) {
    std::vector<uint32_t> region = flat_regions(points, surface, tolerance);
    std::vector<uint32_t> edge_at(points.size(), none);
    for (uint32_t e = 0; e < surface.corner.size(); ++e)
        if (edge_at[surface.corner[e]] == none) edge_at[surface.corner[e]] = e;

    std::vector<uint32_t> kept;
    std::vector<bool> straightened(points.size(), false);
    for (uint32_t v = 0; v < points.size(); ++v) {
        if (edge_at[v] == none) continue;
        // The borders between regions that meet here, by the corner at their other end.
        uint32_t borders = 0, ends[2] = {v, v};
        uint32_t e = edge_at[v];
        do {
            if (region[e / 3] != region[surface.twin[e] / 3]) {
                if (borders < 2) ends[borders] = surface.corner[next_edge(e)];
                ++borders;
            }
            e = next_edge(surface.twin[e]);  // the next half edge that starts at v
        } while (e != edge_at[v]);
        bool keep = borders != 0;
        if (borders == 2 && !straightened[ends[0]] && !straightened[ends[1]]) {
            Vec3d p = to_double(points[v]), a = to_double(points[ends[0]]), b = to_double(points[ends[1]]);
            keep = dot(p - a, p - b) > 0.0 || distance_to_line(p, a, b) > tolerance;
            straightened[v] = !keep;
        }
        if (keep) kept.push_back(v);
    }
    return kept;
}

}  // namespace lendulet
