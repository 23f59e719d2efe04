// Collision shapes: plain values that describe a solid in its own local frame. Sizes are half extents and radii in
// metres, between 1e-4 and 1e4; the long axis of capsules, cylinders and cones is local y.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/result.h"

namespace lendulet {

// A ball about the local origin.
struct Sphere {
    float radius = 0.5f;
};

// A segment of half length `half_height` along y, swept by a sphere; total height 2 (half_height + radius).
struct Capsule {
    float half_height = 0.5f;
    float radius = 0.5f;
};

// The convex hull of two spheres centred at y = -half_height and y = +half_height; one of the radii may be 0.
struct TaperedCapsule {
    float half_height = 0.5f;
    float bottom_radius = 0.5f, top_radius = 0.25f;
};

// A box with the given half extents, grown by a sphere of radius `rounding` (0: sharp edges).
struct Box {
    Vec3 half_extents{0.5f, 0.5f, 0.5f};
    float rounding = 0.0f;
};

// A cylinder from y = -half_height to y = +half_height, grown by a sphere of radius `rounding`.
struct Cylinder {
    float half_height = 0.5f;
    float radius = 0.5f;
    float rounding = 0.0f;
};

// A truncated cone from y = -half_height to y = +half_height; one of the radii may be 0. Grown by `rounding`.
struct TaperedCylinder {
    float half_height = 0.5f;
    float bottom_radius = 0.5f, top_radius = 0.25f;
    float rounding = 0.0f;
};

// A cone with its base of radius `radius` at y = -half_height and its tip at y = +half_height, grown by `rounding`. Its
// centre of mass lies a quarter of its height above the base.
struct Cone {
    float half_height = 0.5f;
    float radius = 0.5f;
    float rounding = 0.0f;
};

struct HullData;
struct MeshData;

// The convex hull of points, built once and shared by any number of colliders.
class ConvexHull {
public:
    // Builds the hull of `points` (local frame, m). Interior and duplicate points are dropped. Fewer than four points,
    // or points in one plane or line (within 2e-6 of their size), give ErrorCode::degenerate_hull; more than
    // 65535 vertices left give too_many_vertices; non-finite coordinates give non_finite; coordinates beyond 1e5 m, a
    // size below 1e-4 m or a negative rounding give bad_extent. Every point lies in the hull within 1e-5 of their size;
    // faces that agree in one plane within that tolerance become one polygon. O(n log n).
    // Method: Barber, Dobkin, Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", ACM TOMS 22 (1996).
    static Result<ConvexHull> from_points(std::span<const Vec3> points, float rounding = 0.0f);

    std::span<const Vec3> vertices() const;  // corners of the hull, local frame, m
    int face_count() const;
    // Its surface, faces cut into fans: three indices into vertices() per triangle, counter-clockwise from outside.
    std::vector<uint32_t> triangles() const;
    float rounding() const { return rounding_; }        // radius of the sphere swept around the hull, m
    bool is_built() const { return data_ != nullptr; }  // false for a default-constructed one, which no body accepts
    const HullData& data() const { return *data_; }     // only where it is built

private:
    std::shared_ptr<const HullData> data_;
    float rounding_ = 0.0f;
};

// The half space below a plane: solid where dot(normal, p) <= offset. For static bodies only.
struct Plane {
    Vec3 normal{0.0f, 1.0f, 0.0f};
    float offset = 0.0f;
};

// Triangles with counter-clockwise front faces, shared by any number of colliders. On a static or kinematic body the
// triangles themselves collide (both sides); on a moving body their convex hull does, and the world reports a warning.
class TriangleMesh {
public:
    // `indices` holds three per triangle. An empty mesh, an index out of range or a non-finite vertex gives
    // ErrorCode::bad_mesh naming the index, and so do coordinates beyond 1e5 m; triangles without area are dropped.
    // O(n log n).
    static Result<TriangleMesh> from_triangles(std::span<const Vec3> vertices, std::span<const uint32_t> indices);

    int triangle_count() const;
    std::span<const Vec3> vertices() const;  // those in use, each position once, local frame, m
    // Three indices into vertices() per triangle, in the order in which they were given.
    std::vector<uint32_t> triangles() const;
    int dropped_triangles() const;                      // how many had no area
    bool is_built() const { return data_ != nullptr; }  // false for a default-constructed one, which no body accepts
    const MeshData& data() const { return *data_; }     // only where it is built

private:
    std::shared_ptr<const MeshData> data_;
};

// Any of the shapes above.
using Shape = std::variant<Sphere, Capsule, TaperedCapsule, Box, Cylinder, TaperedCylinder, Cone, ConvexHull, Plane,
                           TriangleMesh>;

// Mass, centre of mass and inertia of a solid.
struct MassProperties {
    float mass = 0.0f;  // kg
    Vec3 centre;        // centre of mass, local frame, m
    SymMat3 inertia;    // about the centre of mass, local axes, kg m^2
};

// Exact mass properties of a shape of uniform density (kg/m^3), roundings included. The one approximation: a rounded
// hull has its exact mass, but the centre of the sharp hull and the inertia of the sharp hull scaled to the rounded
// extents. A plane has none (mass 0); a mesh counts as its convex hull, a flat mesh has none; nor has a shape that no
// body accepts.
MassProperties mass_properties(const Shape& shape, float density);

}  // namespace lendulet
