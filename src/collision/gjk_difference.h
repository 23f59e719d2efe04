// The Minkowski difference B - A of two cores, seen from the frame of A, through its support function
// s(d) = s_B(d) - s_A(-d) (thesis 4.1). It holds the origin where the cores overlap; otherwise its point nearest to the
// origin is the shortest vector from A to B.
#pragma once

#include "collision/gjk.h"
#include "collision/gjk_math.h"
#include "geometry/hull.h"

namespace lendulet {

// Farthest point of a core along d (any length), local frame. Curved cores are evaluated in double: in float the noise
// of their surface would show in the normals of near contacts. Corners are exact floats in any case.
Vec3d support_point(const Geometry& g, Vec3d d);

inline bool is_curved(const Geometry& g) {
    return g.kind == GeometryKind::tapered_capsule || g.kind == GeometryKind::tapered_cylinder;
}

// The point of the core's curved surface that p was before it was rounded to float: supports lie on the rim or at the
// centre of a cap, or on one of the two balls. Points of flats and sides stay as they are.
Vec3d snap_to_curved(const Geometry& g, Vec3d p);
inline Vec3d snap_to_core(const Geometry& g, Vec3d p) { return is_curved(g) ? snap_to_curved(g, p) : p; }

// Largest coordinate of the core's points, for tolerances.
inline double core_size(const Geometry& g) {
    switch (g.kind) {
        case GeometryKind::point:
            return 0.0;
        case GeometryKind::segment:
            return g.size.y;
        case GeometryKind::box:
            return max_component(g.size);
        case GeometryKind::tapered_capsule:
        case GeometryKind::tapered_cylinder:
            return g.size.y + maximum(g.size.x, g.size.z);
        case GeometryKind::triangle:
            return max_component(
                maximum(absolute(g.triangle[0]), maximum(absolute(g.triangle[1]), absolute(g.triangle[2]))));
        default:
            return max_component(maximum(absolute(g.hull->lower), absolute(g.hull->upper)));
    }
}

// A point of the middle of the core; the line between two of them starts a cold search.
inline Vec3d core_centre(const Geometry& g) {
    if (g.kind == GeometryKind::hull) return to_double(g.hull->centroid);
    if (g.kind == GeometryKind::triangle)
        return (1.0 / 3.0) * (to_double(g.triangle[0]) + to_double(g.triangle[1]) + to_double(g.triangle[2]));
    return {};
}

// A point of the difference with the local points of the cores it comes from.
struct DifferencePoint {
    Vec3d y;    // frame of A
    Vec3 a, b;  // each in its own frame
};

// Up to four points of the difference. The arrays start unset: clearing them would cost as much as a warm query.
struct Simplex {
    int count = 0;
    union {
        Vec3d y[4];
    };
    union {
        Vec3 a[4];
    };
    union {
        Vec3 b[4];
    };
    union {
        double weight[4];  // barycentric coordinates of the point nearest to the origin
    };

    Simplex() {}
    DifferencePoint point(int i) const { return {y[i], a[i], b[i]}; }
    void set(int i, const DifferencePoint& p) { y[i] = p.y, a[i] = p.a, b[i] = p.b; }
    void add(const DifferencePoint& p) { set(count++, p); }
};

struct CoreDifference {
    const Geometry& a;
    const Geometry& b;
    Mat3d rotation;  // frame of B to frame of A
    Vec3d translation;
    double size;  // S of the tolerances: extent of both cores and of their offset
    bool curved;

    explicit CoreDifference(const ConvexPair& pair)
        : a(*pair.a),
          b(*pair.b),
          rotation(exact_rotation(pair.b_in_a.rotation)),
          translation(to_double(pair.b_in_a.translation)),
          size(core_size(a) + core_size(b) + largest_component(translation)),
          curved(is_curved(a) || is_curved(b)) {}

    DifferencePoint support(Vec3d d) const;
    // The point that local points remembered from an earlier query make now.
    DifferencePoint point(Vec3 pa, Vec3 pb) const {
        return {translation + rotation * exact_point(b, pb) - exact_point(a, pa), pa, pb};
    }
    Vec3d exact_point(const Geometry& g, Vec3 p) const { return curved ? snap_to_core(g, to_double(p)) : to_double(p); }
    Vec3d centre() const { return translation + rotation * core_centre(b) - core_centre(a); }
    // The point on A, frame of A, that belongs to the given part of a simplex.
    Vec3d witness_on_a(const Simplex& s, const uint8_t* index, const double* weight, int count) const {
        Vec3d p{};
        for (int i = 0; i < count; ++i) p += weight[i] * exact_point(a, s.a[index[i]]);
        return p;
    }
};

}  // namespace lendulet
