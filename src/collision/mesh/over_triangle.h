// The part of a shape's face that lies over a triangle: the same polygon as clip_face() finds, from what a face keeps
// while one triangle after the other is looked at. All edges of the face go through the triangle's sides at once
// (Liang, Barsky 1984): where they enter and leave, and the triangle's corners that the face covers, are the polygon's
// corners.
#pragma once

#include <cstdint>

#include "collision/clip.h"
#include "collision/mesh/triangle.h"
#include "math/wide/wide.h"

namespace lendulet {

// A face of the core in the mesh's axes, its corners side by side.
struct ShapeFace {
    static constexpr int lanes = 4, blocks = 2;
    using F = Wide<float, lanes>;

    Face face;
    float size = 0.0f;  // of its longest edge, m
    Vec3T<F> corner[blocks], edge[blocks];

    // Takes over what `face` now is.
    void update();
    // Faces of more corners, and single points, are left to clip_face().
    bool is_wide() const { return face.count >= 2 && face.count <= lanes * blocks; }
};

// A triangle's sides: a point p is outside side i by dot(out[i], p) - offset[i].
struct TriangleSides {
    Vec3 out[3];  // unit
    float offset[3], length[3];

    explicit TriangleSides(const Triangle& t);
};

// Points of the face over the triangle, each by its foot on the triangle's plane and its height over that.
struct FaceOverTriangle {
    struct Point {  // without initial values, as MeshPoint
        float x, y, z, height;
        uint32_t id;
        Vec3 foot() const { return {x, y, z}; }
    };
    int count = 0;
    Point points[max_clipped_points];
};

// Points not more than `limit` above the triangle. A corner of the shape has the same name over every triangle, so that
// it keeps it while it slides.
void clip_over_triangle(const ShapeFace& face, const Triangle& t, const TriangleSides& sides,
                        const TriangleSurface& surface, float limit, FaceOverTriangle& out);

}  // namespace lendulet
