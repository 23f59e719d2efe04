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

// As number 5 of several, the others of which are turned the other way and lie elsewhere.
void cut(const ShapeFace& face, const Triangle& t, const TriangleSurface& surface, FaceOverTriangle& out) {
    MeshFilterBatch left{};
    OverTriangleBatch batch;
    left.live = 11;
    for (int i = 0; i < left.live; ++i) {
        const bool same = i == 5;
        const Vec3 aside{same ? 0.0f : 0.1f * static_cast<float>(i), 0.0f, 0.0f};
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = t.vertices[same ? k : 2 - k] + aside;
            left.p[k][0][i] = p.x, left.p[k][1][i] = p.y, left.p[k][2][i] = p.z;
        }
        left.normal[0][i] = t.normal.x, left.normal[1][i] = t.normal.y, left.normal[2][i] = t.normal.z;
        left.flags[i] = t.from_behind == same ? static_cast<float>(MeshFilterBatch::behind) : 0.0f;
    }
    batch.limit = 10.0f, batch.level = 1e-4f;
    batch.begin(left, 0);
    for (int i = 0; i < batch.count; ++i) batch.set_face(i, face);
    clip_over_triangles(batch);
    batch.read(5, t, face.face, surface, out);
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
            Triangle t = make_triangle(surface, index, at, {});
            for (Vec3& v : t.vertices) v = rotate_inverse(turn, v);
            t.normal = rotate_inverse(turn, t.normal);
            const ShapeFace face(shape.geometry, -t.normal);
            if (face.face.count == 0) continue;
            FaceOverTriangle over;
            cut(face, t, surface, over);
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
