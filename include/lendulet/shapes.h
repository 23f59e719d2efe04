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
struct HeightFieldData;

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

// The half space below a plane: solid where dot(normal, p) <= offset, whatever the normal's length but 0. For static
// bodies only.
struct Plane {
    Vec3 normal{0.0f, 1.0f, 0.0f};
    float offset = 0.0f;  // in a world: its plane lies within 1e7 m of its body
};

// What triangles may have besides their corners.
struct TriangleOptions {
    // One for each triangle as given: a place in the table ColliderDef::materials. Empty: 0 for all. Where the collider
    // has no table, its one material is that of all triangles.
    std::span<const uint8_t> materials{};
    // Only what has its centre before a triangle's front touches it, and rays and casts meet it from there alone.
    // Distances, overlaps and nearest points know no sides.
    bool one_sided = false;
};

// Triangles with counter-clockwise front faces, shared by any number of colliders. On a static or kinematic body the
// triangles themselves collide (both sides, unless they are one-sided); on a moving body their convex hull does, with
// the collider's one material, and the world reports a warning.
class TriangleMesh {
public:
    // `indices` holds three per triangle. An empty mesh, an index out of range or a non-finite vertex gives
    // ErrorCode::bad_mesh naming the index, and so do coordinates beyond 1e5 m and a list of materials of another
    // length; triangles without area are dropped. O(n log n).
    static Result<TriangleMesh> from_triangles(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                                               const TriangleOptions& options = {});

    int triangle_count() const;
    std::span<const Vec3> vertices() const;  // those in use, each position once, local frame, m
    // Three indices into vertices() per triangle, in the order in which they were given.
    std::vector<uint32_t> triangles() const;
    int dropped_triangles() const;                      // how many had no area
    int material(int triangle) const;                   // by its number as given; 0 where none was given
    bool is_one_sided() const;                          // false for one that is not built
    bool is_built() const { return data_ != nullptr; }  // false for a default-constructed one, which no body accepts
    const MeshData& data() const { return *data_; }     // only where it is built

private:
    std::shared_ptr<const MeshData> data_;
};

// A grid of heights above the local x-z plane: row by row along z, each along x.
struct HeightFieldDef {
    int columns = 0, rows = 0;           // samples along x and along z, 2 .. 32769
    std::span<const float> heights{};    // m; columns * rows of them, the one of column i and row k at k * columns + i
    float cell_x = 1.0f, cell_z = 1.0f;  // distance of neighbouring samples, m
    Vec3 origin{};                       // where column 0 and row 0 have their sample, at height 0; local frame, m
    // One for each cell, (columns - 1) * (rows - 1) of them: not 0 where it is a hole. Empty: no holes.
    std::span<const uint8_t> holes{};
    // One for each cell, or one for each triangle (two a cell): see TriangleOptions. Empty: 0 for all.
    std::span<const uint8_t> materials{};
    bool one_sided = false;  // see TriangleOptions; fronts are above
};

// A surface over a grid, for terrain: what a mesh of the same triangles does, in a twentieth of its memory. On
// static and kinematic bodies. Each cell, with corners a, b along x and c, d along x in the next row, is the triangles
// (a, c, b) and (b, c, d), which have the numbers 2 n and 2 n + 1 for cell n, counted as the cells' lists are.
class HeightField {
public:
    // ErrorCode::bad_mesh, naming the place, for: fewer than 2 samples a side or more than 2^29 cells; lists of another
    // length; heights that are not finite or beyond 1e5 m; cells smaller than 1e-3 m or larger than 1e3 m, or one side
    // more than 100 times the other; coordinates beyond 1e5 m, or beyond 65536 cells, where single precision no longer
    // tells cells apart; neighbouring heights that differ by more than 1000 times the cell; nothing but holes. O(n).
    static Result<HeightField> from_heights(const HeightFieldDef& def);

    int columns() const;  // samples; 0 for one that is not built, as rows() and triangle_count()
    int rows() const;
    int triangle_count() const;               // without those of holes
    int material(int triangle) const;         // by its number
    bool is_hole(int column, int row) const;  // of a cell
    std::vector<Vec3> vertices() const;       // all samples, local frame, m
    std::vector<uint32_t> triangles() const;  // three indices into vertices() for each triangle that is not a hole's
    bool is_one_sided() const;
    bool is_built() const { return data_ != nullptr; }  // false for a default-constructed one, which no body accepts
    const HeightFieldData& data() const { return *data_; }  // only where it is built

private:
    std::shared_ptr<const HeightFieldData> data_;
};

// Any of the shapes above.
using Shape = std::variant<Sphere, Capsule, TaperedCapsule, Box, Cylinder, TaperedCylinder, Cone, ConvexHull, Plane,
                           TriangleMesh, HeightField>;

// Mass, centre of mass and inertia of a solid.
struct MassProperties {
    float mass = 0.0f;  // kg
    Vec3 centre;        // centre of mass, local frame, m
    SymMat3 inertia;    // about the centre of mass, local axes, kg m^2
};

// Exact mass properties of a shape of uniform density (kg/m^3), roundings included. The one approximation: a rounded
// hull has its exact mass, but the centre of the sharp hull and the inertia of the sharp hull scaled to the rounded
// extents. A plane or height field has none (mass 0); a mesh counts as its convex hull, a flat mesh has none; nor has a
// shape that no body accepts.
MassProperties mass_properties(const Shape& shape, float density);

}  // namespace lendulet
