#include "geometry/hull_mass.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;

Vec3d vertex(const HullData& hull, uint32_t edge) {
    Vec3 v = hull.vertices[hull.edges[edge].origin];
    return {v.x, v.y, v.z};
}

// Calls visit(a, b, c) for the triangles of a fan in each face.
template <class Visit>
void for_each_fan_triangle(const HullData& hull, Visit visit) {
    for (const HullFace& face : hull.faces)
        for (uint32_t k = 2; k < face.edge_count; ++k)
            visit(vertex(hull, face.first_edge), vertex(hull, face.first_edge + k - 1),
                  vertex(hull, face.first_edge + k));
}

}  // namespace

// The surface cut into tetrahedra with a common corner at a vertex of the hull, taken as the origin. One with the other
// corners a, b, c and D = a.(b x c) has volume D/6, first moment D/24 s and second moments
// D/120 (a a^T + b b^T + c c^T + s s^T) with s = a + b + c.
void set_hull_mass(HullData& hull) {
    Vec3d origin = vertex(hull, 0), first{}, square{}, mixed{};
    double six_volumes = 0.0;
    for_each_fan_triangle(hull, [&](Vec3d a, Vec3d b, Vec3d c) {
        a = a - origin, b = b - origin, c = c - origin;
        double d = dot(a, cross(b, c));
        Vec3d s = a + b + c;
        six_volumes += d;
        first += d * s;
        square += d * (multiply(a, a) + multiply(b, b) + multiply(c, c) + multiply(s, s));
        auto turned = [](Vec3d v) { return Vec3d{v.x * v.y, v.x * v.z, v.y * v.z}; };
        mixed += d * (turned(a) + turned(b) + turned(c) + turned(s));
    });
    double volume = six_volumes / 6.0;
    Vec3d centre = (1.0 / (4.0 * six_volumes)) * first;
    square = (1.0 / 120.0) * square - volume * multiply(centre, centre);
    mixed = (1.0 / 120.0) * mixed - volume * Vec3d{centre.x * centre.y, centre.x * centre.z, centre.y * centre.z};
    Vec3d centroid = origin + centre;
    hull.volume = static_cast<float>(volume);
    hull.centroid = {static_cast<float>(centroid.x), static_cast<float>(centroid.y), static_cast<float>(centroid.z)};
    hull.unit_inertia = {static_cast<float>(square.y + square.z),
                         static_cast<float>(square.z + square.x),
                         static_cast<float>(square.x + square.y),
                         static_cast<float>(-mixed.x),
                         static_cast<float>(-mixed.y),
                         static_cast<float>(-mixed.z)};
}

HullSurface hull_surface(const HullData& hull) {
    HullSurface r{0.0, 0.0};
    for_each_fan_triangle(hull, [&](Vec3d a, Vec3d b, Vec3d c) {
        Vec3d n = cross(b - a, c - a);
        r.area += 0.5 * __builtin_sqrt(dot(n, n));
    });
    for (const HullFace& face : hull.faces)
        for (uint32_t k = 0; k < face.edge_count; ++k) {
            uint32_t e = face.first_edge + k, after = face.first_edge + (k + 1) % face.edge_count;
            Vec3d line = vertex(hull, after) - vertex(hull, e);
            Vec3 other = hull.faces[hull.edges[hull.edges[e].twin].face].normal;
            float angle = arc_tangent2(length(cross(face.normal, other)), dot(face.normal, other));
            r.mean_curvature += 0.25 * __builtin_sqrt(dot(line, line)) * angle;  // every edge comes twice
        }
    return r;
}

}  // namespace lendulet
