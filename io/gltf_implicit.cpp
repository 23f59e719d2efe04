// KHR_implicit_shapes under a node's scale.
#include <algorithm>
#include <cmath>

#include "io/file.h"
#include "io/gltf_shapes.h"

namespace lendulet {

namespace {

constexpr double smallest = 1e-4;      // m; the engine's shapes are no smaller
constexpr double infinite_half = 1e3;  // m; half size of a mesh that stands for an unbounded plane

// What a shape is made of before scale: two discs or spheres on the y axis, or a box.
struct Ends {
    double height, bottom, top;
};

Ends read_ends(const Field& shape) {
    Ends e{shape["height"].number_or(0.5), shape["radiusBottom"].number_or(0.25), shape["radiusTop"].number_or(0.25)};
    if (!(e.height > 0.0)) shape["height"].refuse("must be greater than 0");
    if (!(e.bottom >= 0.0)) shape["radiusBottom"].refuse("must not be negative");
    if (!(e.top >= 0.0)) shape["radiusTop"].refuse("must not be negative");
    if (e.bottom == 0.0 && e.top == 0.0) shape.refuse("has two radii of 0");
    return e;
}

bool close(double a, double b) { return std::abs(a - b) <= 1e-4 * std::max(std::abs(a), std::abs(b)); }

// Points on a sphere about `centre`: rings of 20 at every 18 degrees of latitude, and the poles.
void add_sphere(std::vector<Vec3d>& points, Vec3d centre, double radius) {
    constexpr int rings = 10, around = 20;
    points.push_back(centre + Vec3d{0.0, radius, 0.0});
    points.push_back(centre - Vec3d{0.0, radius, 0.0});
    for (int i = 1; i < rings; ++i) {
        SinCos latitude = sin_cos(pi * static_cast<float>(i) / rings);
        for (int j = 0; j < around; ++j) {
            SinCos turn = sin_cos(2.0f * pi * static_cast<float>(j) / around);
            points.push_back(centre + radius * Vec3d{latitude.sin * turn.cos, latitude.cos, latitude.sin * turn.sin});
        }
    }
}

void add_disc(std::vector<Vec3d>& points, double y, double radius) {
    constexpr int around = 32;
    if (radius == 0.0) return points.push_back({0.0, y, 0.0});
    for (int j = 0; j < around; ++j) {
        SinCos turn = sin_cos(2.0f * pi * static_cast<float>(j) / around);
        points.push_back({radius * turn.cos, y, radius * turn.sin});
    }
}

std::vector<Vec3d> surface_points(const std::string& type, const Field& data) {
    std::vector<Vec3d> points;
    if (type == "sphere") {
        add_sphere(points, {}, data["radius"].number_or(0.5));
    } else if (type == "box") {
        Vec3 size = data["size"].vector_or({1.0f, 1.0f, 1.0f});
        for (int i = 0; i < 8; ++i) {
            points.push_back(
                {(i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y, (i & 4 ? 0.5 : -0.5) * size.z});
        }
    } else {
        Ends e = read_ends(data);
        if (type == "capsule") {
            add_sphere(points, {0.0, -0.5 * e.height, 0.0}, e.bottom);
            add_sphere(points, {0.0, 0.5 * e.height, 0.0}, e.top);
        } else {
            add_disc(points, -0.5 * e.height, e.bottom);
            add_disc(points, 0.5 * e.height, e.top);
        }
    }
    return points;
}

std::optional<PlacedShape> as_hull(const std::string& type, const Field& data, const NodeFrame& frame,
                                   const std::string& where, Warnings& warnings) {
    std::vector<Vec3> points;
    for (Vec3d p : surface_points(type, data)) points.push_back(to_float(frame.stretch * p));
    bool was_flat = false;
    std::optional<ConvexHull> hull = hull_or_slab(points, where, was_flat);
    if (!hull) refuse(where, "is scaled to nothing", ErrorCode::bad_extent);
    warnings.add(where, "its " + type + " is stretched unevenly and collides as a convex hull");
    return PlacedShape{*hull, {}};
}

// The hull of two spheres; where one holds the other, that one alone.
PlacedShape capsule(const Ends& e) {
    float half = static_cast<float>(0.5 * e.height);
    float bottom = static_cast<float>(std::max(e.bottom, smallest)),
          top = static_cast<float>(std::max(e.top, smallest));
    if (e.bottom == e.top) return {Capsule{half, bottom}, {}};
    if (absolute(bottom - top) >= 2.0f * half) {
        return {Sphere{maximum(bottom, top)}, {{0.0f, bottom > top ? -half : half, 0.0f}, {}}};
    }
    return {TaperedCapsule{half, bottom, top}, {}};
}

Shape cylinder(const Ends& e) {
    float half = static_cast<float>(0.5 * e.height);
    float bottom = static_cast<float>(e.bottom), top = static_cast<float>(e.top);
    if (bottom == top) return Cylinder{half, bottom, 0.0f};
    if (top == 0.0f) return Cone{half, bottom, 0.0f};
    return TaperedCylinder{half, bottom, top, 0.0f};
}

// Unbounded one-sided planes of static bodies are half spaces; others are a rectangle of two triangles or a thin box.
std::optional<PlacedShape> plane(const Field& data, const NodeFrame& frame, BodyType type, const std::string& where,
                                 Warnings& warnings) {
    Field x = data["sizeX"], z = data["sizeZ"];
    if (x && !(x.number() > 0.0)) x.refuse("must be greater than 0");
    if (z && !(z.number() > 0.0)) z.refuse("must be greater than 0");
    bool bounded = x && z, both_sides = data["doubleSided"].boolean_or(false);
    if (!x && !z && !both_sides && type == BodyType::fixed) return PlacedShape{Plane{}, {}};
    if (type == BodyType::dynamic && !bounded) {
        warnings.add(where, "a moving body cannot have an unbounded plane; the collider is left out");
        return std::nullopt;
    }
    Vec3d scale = frame.scale();
    double hx = x ? 0.5 * x.number() * scale.x : infinite_half, hz = z ? 0.5 * z.number() * scale.z : infinite_half;
    if (type == BodyType::dynamic) {
        double thickness = std::max(0.005 * std::max(hx, hz), smallest);
        warnings.add(where, "a moving plane collides as a thin box");
        Vec3 half = to_float(Vec3d{hx, thickness, hz});
        return PlacedShape{Box{half, 0.0f}, {{0.0f, -half.y, 0.0f}, {}}};
    }
    if (!x || !z) warnings.add(where, "its unbounded plane ends 1000 m from its centre");
    float fx = static_cast<float>(hx), fz = static_cast<float>(hz);
    std::vector<Vec3> corners{{-fx, 0.0f, -fz}, {-fx, 0.0f, fz}, {fx, 0.0f, fz}, {fx, 0.0f, -fz}};
    std::vector<uint32_t> triangles{0, 1, 2, 0, 2, 3};
    Result<TriangleMesh> mesh = TriangleMesh::from_triangles(corners, triangles);
    if (!mesh.ok()) refuse(where, mesh.error().message, mesh.error().code);
    return PlacedShape{std::move(mesh).value(), {}};
}

}  // namespace

std::optional<PlacedShape> implicit_shape(const Field& shape, const NodeFrame& frame, BodyType body,
                                          const std::string& where, Warnings& warnings) {
    const std::string& type = shape["type"].text();
    bool known = type == "sphere" || type == "box" || type == "capsule" || type == "cylinder" || type == "plane";
    if (!known) {
        warnings.add(where, "shapes of type \"" + printable(type) + "\" are not known; the collider is left out");
        return std::nullopt;
    }
    Field data = shape[type.c_str()];
    if (type == "plane") return plane(data, frame, body, where, warnings);
    Vec3d s = frame.scale();
    bool even_across = close(s.x, s.z), even = even_across && close(s.x, s.y);
    if (type == "box") {
        Vec3 size = data["size"].vector_or({1.0f, 1.0f, 1.0f});
        if (!(min_component(size) > 0.0f)) data["size"].refuse("must be greater than 0 along every axis");
        if (frame.sheared()) return as_hull(type, data, frame, where, warnings);
        return PlacedShape{Box{to_float(Vec3d{0.5 * s.x * size.x, 0.5 * s.y * size.y, 0.5 * s.z * size.z}), 0.0f}, {}};
    }
    if (type == "sphere") {
        double radius = data["radius"].number_or(0.5);
        if (!(radius > 0.0)) data["radius"].refuse("must be greater than 0");
        if (frame.sheared() || !even) return as_hull(type, data, frame, where, warnings);
        return PlacedShape{Sphere{static_cast<float>(s.x * radius)}, {}};
    }
    Ends ends = read_ends(data);
    bool exact = !frame.sheared() && (type == "capsule" ? even : even_across);
    if (!exact) return as_hull(type, data, frame, where, warnings);
    // A node mirrored along y turns the shape over only in principle: the specification takes the scale's absolute
    // value.
    ends = {s.y * ends.height, s.x * ends.bottom, s.x * ends.top};
    return type == "capsule" ? capsule(ends) : PlacedShape{cylinder(ends), {}};
}

}  // namespace lendulet
