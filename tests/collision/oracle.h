// Reference answers for distance queries, in long double and by brute force. Shares no code with the engine: shapes
// come in as plain numbers, and every candidate feature pair or separating direction is tried.
#pragma once

#include <functional>
#include <vector>

namespace oracle {

using Real = long double;

struct Vec {
    Real x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Real norm(Vec a);

// Rotation (normalised here) and translation.
struct Pose {
    Vec columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Vec translation;
};
Pose make_pose(Real qx, Real qy, Real qz, Real qw, Vec translation);
Vec apply(const Pose& pose, Vec p);

// Corners, edges and outward unit face normals with the triangles of the faces. Points, segments and flat polygons are
// bodies too: a flat one has its plane twice, once for each side.
struct Body {
    struct Triangle {
        int corner[3];
        Vec normal;
    };
    std::vector<Vec> corners;
    std::vector<std::pair<int, int>> edges;
    std::vector<Triangle> triangles;
};
Body make_box(Vec half);
Body make_points(const std::vector<Vec>& corners);  // one or two points, or three of a triangle
Body make_hull(const std::vector<Vec>& points);     // brute force over all triples; needs a volume
Body moved(const Body& body, const Pose& pose);

struct Answer {
    Real distance;   // negative: depth
    Vec normal;      // from A to B
    Real runner_up;  // separation along the best direction that differs from the normal by more than 1 degree
};
// Exact for polytopes: overlap over all face normals and edge-edge directions, distance over all feature pairs.
Answer distance(const Body& a, const Body& b);
// Distance of a point to the solid, 0 inside.
Real outside(const Body& body, Vec p);

// -- Curved cores: two discs or two balls about (0, -h, 0) and (0, h, 0) and their convex hull
// -------------------------
struct Tapered {
    bool balls;
    Real bottom_radius, half_height, top_radius;
};
// Signed distance of a point: negative inside.
Real signed_distance(const Tapered& shape, Vec p);
// Largest dot(n, p) over the shape.
Real support(const Tapered& shape, Vec n);
Real support(const Body& body, Vec n);

// Distance of two segments p + s u and q + t v, s and t in [-1, 1].
Real segment_distance(Vec p, Vec u, Vec q, Vec v);

}  // namespace oracle
