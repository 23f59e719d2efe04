// Faces clipped over triangles: the same corners as clip_face() finds, one by one.
#include <gtest/gtest.h>

#include "collision/mesh/over_triangle.h"
#include "family.h"
#include "meshes.h"
#include "pairs.h"

using namespace pairs;

namespace {

// How far p is from the nearest of the points, height included.
template <class Points, class Place>
float distance_to(Vec3 p, float height, const Points& points, int count, Place&& place) {
    float nearest = 1e9f;
    for (int i = 0; i < count; ++i) {
        auto [q, h] = place(points[i]);
        nearest = minimum(nearest, length(p - q) + absolute(height - h));
    }
    return nearest;
}

TEST(OverTriangle, FindsTheCornersThatClippingFinds) {
    TriangleMesh ground = grid(6, 0.5f, [](float x, float z) { return 0.2f * x - 0.1f * z * z; });
    const Solid mesh{Shape{ground}};
    const TriangleSurface surface(mesh.geometry);
    Random random(7);
    int compared = 0, partly = 0;
    for (const Kind& kind : every_kind()) {
        const Solid shape(kind.shape);
        for (int n = 0; n < 1500; ++n) {
            const Quat turn = random.rotation();
            const Vec3 at{random.in(-1.0f, 1.0f), random.in(0.3f, 0.8f), random.in(-1.0f, 1.0f)};
            const auto index = static_cast<uint32_t>(n % 72);
            const Triangle t = make_triangle(surface, index, at, {});
            ShapeFace face;
            face.face = best_face(shape.geometry, rotate_inverse(turn, -t.normal));
            if (face.face.count == 0) continue;
            transform_face({{}, turn}, face.face);
            face.update();
            FaceOverTriangle over;
            clip_over_triangle(face, t, TriangleSides(t), surface, 10.0f, over);
            ClippedFace clipped;
            clip_face(face_of(t, surface), face.face, false, 10.0f, clipped);
            // What is cut off by the slack of the sides alone is nothing.
            const float near = 2e-3f;
            auto of_clipped = [&](const FacePoint& p) { return std::pair{clipped.point(p, 0.0f), p.separation}; };
            auto of_over = [&](const FaceOverTriangle::Point& p) { return std::pair{p.foot(), p.height}; };
            if (over.count == 0 || clipped.count == 0) {
                EXPECT_LE(over.count + clipped.count, 3) << kind.name << " " << n;
                continue;
            }
            ++compared;
            partly += over.count > face.face.count;
            for (int i = 0; i < over.count; ++i)
                EXPECT_LT(distance_to(over.points[i].foot(), over.points[i].height, clipped.points, clipped.count,
                                      of_clipped),
                          near)
                    << kind.name << " " << n;
            for (int i = 0; i < clipped.count; ++i)
                EXPECT_LT(distance_to(clipped.point(clipped.points[i], 0.0f), clipped.points[i].separation, over.points,
                                      over.count, of_over),
                          near)
                    << kind.name << " " << n;
        }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(partly, 50);
}

}  // namespace
