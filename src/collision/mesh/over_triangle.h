// The parts of a shape's faces that lie over triangles: the same polygons as clip_face() finds, W triangles at a time.
// All edges of a face go through its triangle's sides (Liang, Barsky 1984): where they enter and leave, and the
// triangle's corners that the face covers, are the polygon's corners.
#pragma once

#include <cstdint>

#include "collision/clip.h"
#include "collision/mesh/filter.h"
#include "collision/mesh/triangle.h"

namespace lendulet {

// A face of the core.
struct ShapeFace {
    Face face;
    float size;  // of its longest edge, m; of faces that are cut W at a time

    ShapeFace(const Geometry& shape, Vec3 direction);
};

// A triangle's sides: a point p is outside side i by dot(out[i], p) - offset[i].
struct TriangleSides {
    Vec3 out[3];  // unit
    float offset[3], length[3];

    explicit TriangleSides(const Triangle& t);
};

// Points of a face over a triangle, each by its foot on the triangle's plane and its height over that.
struct FaceOverTriangle {
    struct Point {  // without initial values, as MeshPoint
        float x, y, z, height;
        uint32_t id;
        Vec3 foot() const { return {x, y, z}; }
    };
    int count = 0;
    Point points[max_clipped_points];
};

// Triangles side by side, each with the face that looks at it; in the axes of contacts, relative to the shape's
// position.
struct OverTriangleBatch {
    static constexpr int capacity = 16;  // whole blocks of the widest lanes
    static constexpr int most_corners = 8;
    // Of bits: the point where edge k of the face enters is number 2 k, where it leaves 2 k + 1, then the triangle's
    // corners, and at last what is told of the lowest point.
    static constexpr int first_covered = 2 * most_corners, points = first_covered + 3, lowest_is_over = points,
                         first_beyond = points + 1;

    const MeshFilterBatch* triangles;
    int first, count;  // of those left there
    int corners;       // the most that a face has; faces of more are left to clip_face()
    float limit;       // points higher than that over the triangle are none
    float level;       // lowest points that far within a side are within it
    // The face: as many corners as there are, and then the first again. No corners, no points.
    float corner_count[capacity], face_size[capacity], face_normal[3][capacity];
    float corner[most_corners + 1][3][capacity];

    // Out.
    int32_t bits[capacity];  // which points there are; whether the lowest is over the triangle, and not surely within
                             // each of its sides
    float lowest_height[capacity];
    float point[points][3][capacity], height[points][capacity];  // feet and heights, where there are points
    float side[first_covered][capacity];                         // which the edge crosses there, or -1: its own end

    // For up to `capacity` triangles from number `from` of those left on.
    void begin(const MeshFilterBatch& left, int from);
    void set_face(int i, const ShapeFace& face);
    bool lowest_over(int i) const { return (bits[i] >> lowest_is_over & 1) != 0; }
    // Whether a face that was cut has no point over the triangle, and neither has the core its lowest.
    bool is_bare(int i) const { return corner_count[i] > 0.0f && (bits[i] & ((1 << (lowest_is_over + 1)) - 1)) == 0; }
    uint8_t beyond(int i) const { return static_cast<uint8_t>(bits[i] >> first_beyond & 7); }
    // What it found of number i, which is `t`. A corner of the shape has the same name over every triangle, so that it
    // keeps it while it slides.
    void read(int i, const Triangle& t, const Face& face, const TriangleSurface& surface, FaceOverTriangle& out) const;
};

using ClipOverTriangles = void (*)(OverTriangleBatch&);
// Four at a time.
void clip_over_triangles(OverTriangleBatch& batch);

}  // namespace lendulet
