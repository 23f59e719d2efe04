// Contact polygons: one face cut by the sides of another, stretches of lines along each other, and the choice of four
// points. Faces are given in any common frame.
#pragma once

#include <cstdint>

#include "collision/manifold.h"
#include "geometry/geometry.h"
#include "lendulet/math.h"

namespace lendulet {

// A point over a reference plane: coordinates in the plane and separation along its normal.
struct FacePoint {
    float u, v, separation;
    uint32_t id;
};

// Moves at most four points to the front and returns their number: the deepest (or, within half a thousandth of the
// size of the set, the one farthest along a fixed direction, so that the choice is steady where all are equally deep),
// the one farthest from it, the one that makes the largest triangle and the one farthest outside that triangle. Points
// that add less than a thousandth of the size are left out. Those that carried a load before are rather chosen again.
int thin_points(FacePoint* points, int count, const CarriedPoints& carried = {});
// The same where there are more than four; up to four stay as they are.
int reduce_points(FacePoint* points, int count, const CarriedPoints& carried = {});

// Moves a face to another frame.
void transform_face(const Transform& t, Face& face);

// The part of the incident face over the reference face (three corners or more, counter-clockwise about its normal) not
// more than `limit` above it. Points on the rim count as over it.
inline constexpr int max_clipped_points = 2 * max_face_vertices + 2;
struct ClippedFace {
    Vec3 origin, u, v, normal;  // of the reference plane
    float size;                 // of the smaller of the two faces, m
    int count = 0;
    FacePoint points[max_clipped_points];
    Vec3 point(const FacePoint& p, float height) const { return origin + p.u * u + p.v * v + height * normal; }
};
void clip_face(const Face& reference, const Face& incident, bool reference_is_b, float limit, ClippedFace& out);

// The two ends of the stretch that two nearly parallel segments share, on either; returns 2, or 0 where there is none.
struct PointPair {
    Vec3 on_a, on_b;
};
int shared_stretch(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1, PointPair* out);

// Names of the two features that meet in a point; the same whichever side is the reference face.
inline constexpr uint32_t vertex_feature(uint32_t i) { return i & 0x3fffu; }
inline constexpr uint32_t edge_feature(uint32_t i, uint32_t j) {
    uint32_t lo = i < j ? i : j, hi = i < j ? j : i;
    return 0x4000u | ((lo * 127u + hi) & 0x3fffu);
}
inline constexpr uint32_t face_feature(uint32_t i) { return 0x8000u | (i & 0x3fffu); }
inline constexpr uint32_t point_id(uint32_t feature_a, uint32_t feature_b) { return feature_a << 16 | feature_b; }

}  // namespace lendulet
