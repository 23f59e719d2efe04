// From the public Shape to the engine's Geometry: the one place where sizes of shapes are checked.
#include <string>

#include "base/text.h"
#include "geometry/geometry.h"
#include "geometry/hull.h"
#include "geometry/mesh.h"

namespace lendulet {

namespace {

constexpr float smallest_extent = 1e-4f, largest_extent = 1e4f;  // m

bool is_finite(float a) { return a - a == 0.0f; }

// The first error found, if any; later checks then do nothing.
class Checks {
public:
    explicit Checks(const char* shape) : shape_(shape) {}

    void extent(const char* name, float value) {
        if (!finite(name, value)) return;
        if (value < smallest_extent || value > largest_extent) {
            fail(ErrorCode::bad_extent, name, " must lie between 1e-4 and 1e4 m, but is ", value);
        }
    }
    void extent_or_zero(const char* name, float value) {
        if (value != 0.0f) extent(name, value);
    }
    void rounding(float value) {
        if (!finite("rounding", value)) return;
        if (value < 0.0f || value > largest_extent) {
            fail(ErrorCode::bad_extent, "rounding", " must lie between 0 and 1e4 m, but is ", value);
        }
    }
    void not_both_zero(float bottom, float top) {
        if (bottom == 0.0f && top == 0.0f)
            fail(ErrorCode::bad_extent, "bottom_radius and top_radius", " are both ", 0.0f);
    }
    bool finite(const char* name, float value) {
        if (!is_finite(value)) fail(ErrorCode::non_finite, name, " must be finite, but is ", value);
        return is_finite(value);
    }
    Result<Geometry> result(const Geometry& g) const {
        if (failed_) return Error{code_, message_};
        return g;
    }

private:
    void fail(ErrorCode code, const char* name, const char* problem, float value) {
        if (failed_) return;
        failed_ = true;
        code_ = code;
        message_ = std::string(shape_) + ": " + name + problem + text(value) + ".";
    }
    const char* shape_;
    bool failed_ = false;
    ErrorCode code_ = ErrorCode::bad_extent;
    std::string message_;
};

Result<Geometry> convert(const Sphere& s) {
    Checks checks("Sphere");
    checks.extent("radius", s.radius);
    return checks.result({.kind = GeometryKind::point, .rounding = s.radius});
}

Result<Geometry> convert(const Capsule& s) {
    Checks checks("Capsule");
    checks.extent("half_height", s.half_height);
    checks.extent("radius", s.radius);
    return checks.result({.kind = GeometryKind::segment, .rounding = s.radius, .size = {0.0f, s.half_height, 0.0f}});
}

// The smaller radius becomes the rounding, which leaves a core with a point at that end.
Result<Geometry> convert(const TaperedCapsule& s) {
    Checks checks("TaperedCapsule");
    checks.extent("half_height", s.half_height);
    checks.extent_or_zero("bottom_radius", s.bottom_radius);
    checks.extent_or_zero("top_radius", s.top_radius);
    checks.not_both_zero(s.bottom_radius, s.top_radius);
    float rounding = minimum(s.bottom_radius, s.top_radius);
    Geometry g{.kind = GeometryKind::tapered_capsule, .rounding = rounding};
    if (s.bottom_radius == s.top_radius) g.kind = GeometryKind::segment;
    g.size = {s.bottom_radius - rounding, s.half_height, s.top_radius - rounding};
    return checks.result(g);
}

Result<Geometry> convert(const Box& s) {
    Checks checks("Box");
    checks.extent("half_extents.x", s.half_extents.x);
    checks.extent("half_extents.y", s.half_extents.y);
    checks.extent("half_extents.z", s.half_extents.z);
    checks.rounding(s.rounding);
    return checks.result({.kind = GeometryKind::box, .rounding = s.rounding, .size = s.half_extents});
}

Result<Geometry> convert(const Cylinder& s) {
    Checks checks("Cylinder");
    checks.extent("half_height", s.half_height);
    checks.extent("radius", s.radius);
    checks.rounding(s.rounding);
    return checks.result(
        {.kind = GeometryKind::tapered_cylinder, .rounding = s.rounding, .size = {s.radius, s.half_height, s.radius}});
}

Result<Geometry> convert(const TaperedCylinder& s) {
    Checks checks("TaperedCylinder");
    checks.extent("half_height", s.half_height);
    checks.extent_or_zero("bottom_radius", s.bottom_radius);
    checks.extent_or_zero("top_radius", s.top_radius);
    checks.not_both_zero(s.bottom_radius, s.top_radius);
    checks.rounding(s.rounding);
    return checks.result({.kind = GeometryKind::tapered_cylinder,
                          .rounding = s.rounding,
                          .size = {s.bottom_radius, s.half_height, s.top_radius}});
}

Result<Geometry> convert(const Cone& s) {
    Checks checks("Cone");
    checks.extent("half_height", s.half_height);
    checks.extent("radius", s.radius);
    checks.rounding(s.rounding);
    return checks.result(
        {.kind = GeometryKind::tapered_cylinder, .rounding = s.rounding, .size = {s.radius, s.half_height, 0.0f}});
}

Result<Geometry> convert(const ConvexHull& s) {
    if (!s.is_built()) return Error{ErrorCode::degenerate_hull, "ConvexHull: it was not built by from_points."};
    Checks checks("ConvexHull");
    checks.rounding(s.rounding());
    return checks.result({.kind = GeometryKind::hull, .rounding = s.rounding(), .hull = &s.data()});
}

// A normal of any length is accepted; offset and normal are scaled together, so the plane stays where it is.
Result<Geometry> convert(const Plane& s) {
    Checks checks("Plane");
    checks.finite("normal.x", s.normal.x);
    checks.finite("normal.y", s.normal.y);
    checks.finite("normal.z", s.normal.z);
    checks.finite("offset", s.offset);
    Vec3T<double> n{s.normal.x, s.normal.y, s.normal.z};
    double norm = __builtin_sqrt(dot(n, n));
    if (norm == 0.0) return Error{ErrorCode::bad_extent, "Plane: normal must not be the zero vector."};
    double scale = 1.0 / norm;
    Geometry g{.kind = GeometryKind::plane};
    g.size = {static_cast<float>(scale * n.x), static_cast<float>(scale * n.y), static_cast<float>(scale * n.z)};
    g.offset = static_cast<float>(scale * s.offset);
    if (is_finite(s.offset)) checks.finite("offset / length of normal", g.offset);
    return checks.result(g);
}

Result<Geometry> convert(const TriangleMesh& s) {
    if (!s.is_built()) return Error{ErrorCode::bad_mesh, "TriangleMesh: it was not built by from_triangles."};
    return Geometry{.kind = GeometryKind::mesh, .hull = s.data().hull.get(), .mesh = &s.data()};
}

Result<Geometry> convert(const HeightField& s) {
    if (!s.is_built()) return Error{ErrorCode::bad_mesh, "HeightField: it was not built by from_heights."};
    return Geometry{.kind = GeometryKind::height_field, .field = &s.data()};
}

}  // namespace

Result<Geometry> make_geometry(const Shape& shape) {
    return std::visit([](const auto& s) { return convert(s); }, shape);
}

}  // namespace lendulet
