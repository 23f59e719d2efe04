// Support points of the cores, and boxes and spheres around whole shapes.
#include <limits>

#include "geometry/geometry.h"
#include "geometry/height_field.h"
#include "geometry/hull.h"
#include "geometry/mesh.h"

namespace lendulet {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// The same direction at a length whose square neither overflows nor vanishes; zero stays zero.
Vec3 at_safe_length(Vec3 d) {
    float squared = length_squared(d);
    if (squared > 1e-20f && squared < 1e20f) return d;
    float m = max_component(absolute(d));
    return m > 1e-37f && m < infinity ? (1.0f / m) * d : Vec3{};
}

// The larger of two balls' supports; the upper one where equal.
Vec3 support_tapered_capsule(Vec3 size, Vec3 direction) {
    Vec3 d = at_safe_length(direction);
    float norm = length(d);
    float bottom = size.x * norm - size.y * d.y, top = size.z * norm + size.y * d.y;
    float scale = norm > 0.0f ? 1.0f / norm : 0.0f;
    if (top >= bottom) return Vec3{0.0f, size.y, 0.0f} + (size.z * scale) * d;
    return Vec3{0.0f, -size.y, 0.0f} + (size.x * scale) * d;
}

// The larger of two discs' supports. Straight along the axis every point of the rim is one: that at +x is taken.
Vec3 support_tapered_cylinder(Vec3 size, Vec3 direction) {
    Vec3 d = at_safe_length(direction);
    float radial = square_root(d.x * d.x + d.z * d.z);
    float bottom = size.x * radial - size.y * d.y, top = size.z * radial + size.y * d.y;
    float radius = top >= bottom ? size.z : size.x, y = top >= bottom ? size.y : -size.y;
    if (!(radial > 0.0f)) return {radius, y, 0.0f};
    float scale = radius / radial;
    return {scale * d.x, y, scale * d.z};
}

// The first of three points where equal.
Vec3 support_triangle(const Vec3* p, Vec3 d) {
    float a = dot(p[0], d), b = dot(p[1], d), c = dot(p[2], d);
    if (a >= b && a >= c) return p[0];
    return b >= c ? p[1] : p[2];
}

// A corner, drawn towards the centroid where the hull is an inner core.
Vec3 support_hull(const Geometry& g, Vec3 d) {
    Vec3 corner = g.hull->vertices[support_vertex(*g.hull, d)];
    return g.size.x == 0.0f ? corner : corner - g.size.x * (corner - g.hull->centroid);
}

// |R| half: half extents of a turned box.
Vec3 turned_half(const Mat3& r, Vec3 half) {
    return half.x * absolute(r.x) + half.y * absolute(r.y) + half.z * absolute(r.z);
}

CentredBox from_limits(Vec3 lower, Vec3 upper) { return {0.5f * (lower + upper), 0.5f * (upper - lower)}; }

// Two discs (or balls) about -h and +h along the turned y axis; `spread` is the half extent per unit of radius.
CentredBox two_ends(Vec3 axis, Vec3 size, Vec3 spread) {
    Vec3 middle = size.y * axis;
    return from_limits(minimum(middle - size.z * spread, -middle - size.x * spread),
                       maximum(middle + size.z * spread, -middle + size.x * spread));
}

// Half extents of a disc of radius 1 with unit normal n: sqrt(1 - n_i^2).
Vec3 disc_spread(Vec3 n) {
    auto spread = [](float a, float b) { return square_root(a * a + b * b); };
    return {spread(n.y, n.z), spread(n.z, n.x), spread(n.x, n.y)};
}

CentredBox core_bounds(const Geometry& g, Quat rotation) {
    Mat3 r = rotation_matrix(rotation);
    switch (g.kind) {
        case GeometryKind::point:
            return {};
        case GeometryKind::segment:
            return {{}, g.size.y * absolute(r.y)};
        case GeometryKind::box:
            return {{}, turned_half(r, g.size)};
        case GeometryKind::tapered_capsule:
            return two_ends(r.y, g.size, {1.0f, 1.0f, 1.0f});
        case GeometryKind::tapered_cylinder:
            return two_ends(r.y, g.size, disc_spread(r.y));
        case GeometryKind::hull: {
            Mat3 t = transpose(r);  // its columns are the world's axes seen from the shape
            HullExtents e = extents_along(*g.hull, {t.x, t.y, t.z});
            return from_limits(e.lower, e.upper);
        }
        case GeometryKind::triangle: {
            Vec3 a = r * g.triangle[0], b = r * g.triangle[1], c = r * g.triangle[2];
            return from_limits(minimum(minimum(a, b), c), maximum(maximum(a, b), c));
        }
        case GeometryKind::plane:
            return {{}, {infinity, infinity, infinity}};
        case GeometryKind::mesh: {
            CentredBox box = from_limits(g.mesh->lower, g.mesh->upper);
            return {r * box.centre, turned_half(r, box.half)};
        }
        case GeometryKind::height_field: {
            CentredBox box = from_limits(g.field->lower, g.field->upper);
            return {r * box.centre, turned_half(r, box.half)};
        }
    }
    return {};
}

}  // namespace

Vec3 support_core(const Geometry& g, Vec3 d) {
    switch (g.kind) {
        case GeometryKind::segment:
            return {0.0f, d.y >= 0.0f ? g.size.y : -g.size.y, 0.0f};
        case GeometryKind::box:
            return {d.x >= 0.0f ? g.size.x : -g.size.x, d.y >= 0.0f ? g.size.y : -g.size.y,
                    d.z >= 0.0f ? g.size.z : -g.size.z};
        case GeometryKind::tapered_capsule:
            return support_tapered_capsule(g.size, d);
        case GeometryKind::tapered_cylinder:
            return support_tapered_cylinder(g.size, d);
        case GeometryKind::hull:
            return support_hull(g, d);
        case GeometryKind::triangle:
            return support_triangle(g.triangle, d);
        case GeometryKind::point:
        case GeometryKind::plane:
        case GeometryKind::mesh:
        case GeometryKind::height_field:
            break;
    }
    return {};
}

CentredBox bounds(const Geometry& g, Quat rotation) {
    CentredBox box = core_bounds(g, rotation);
    box.half += {g.rounding, g.rounding, g.rounding};
    return box;
}

float bounding_radius(const Geometry& g) {
    auto end = [&](float radius) { return square_root(g.size.y * g.size.y + radius * radius); };
    switch (g.kind) {
        case GeometryKind::point:
            return g.rounding;
        case GeometryKind::segment:
            return g.size.y + g.rounding;
        case GeometryKind::box:
            return length(g.size) + g.rounding;
        case GeometryKind::tapered_capsule:
            return g.size.y + maximum(g.size.x, g.size.z) + g.rounding;
        case GeometryKind::tapered_cylinder:
            return maximum(end(g.size.x), end(g.size.z)) + g.rounding;
        case GeometryKind::hull:
            return g.hull->radius + g.rounding;
        case GeometryKind::triangle:
            return maximum(length(g.triangle[0]), maximum(length(g.triangle[1]), length(g.triangle[2]))) + g.rounding;
        case GeometryKind::plane:
            return infinity;
        case GeometryKind::mesh:
            return g.mesh->radius;
        case GeometryKind::height_field:
            return g.field->radius;
    }
    return infinity;
}

}  // namespace lendulet
