#include "collision/mesh/over_triangle.h"

#include <bit>
#include <cstring>

#include "math/wide/wide.h"

namespace lendulet {
namespace {

#include "collision/mesh/over_triangle.inl"

int next_of(int i, int count) { return i + 1 < count ? i + 1 : 0; }

// Names of a polygon's corners.
struct Ids {
    const Face& face;
    const TriangleSurface& surface;
    const Triangle& t;

    uint32_t corner(int i) const { return point_id(face_feature(0), vertex_feature(face.ids[i])); }
    uint32_t crossing(int edge, int side) const {
        const uint32_t a = surface.vertex(t.index, side) & 0xffffu,
                       b = surface.vertex(t.index, next_of(side, 3)) & 0xffffu;
        return point_id(edge_feature(a, b), edge_feature(face.ids[edge], face.ids[next_of(edge, face.count)]));
    }
    uint32_t covered(int corner) const {
        return point_id(vertex_feature(surface.vertex(t.index, corner)), face_feature(face.id));
    }
};

void clip_one(const Triangle& t, const Face& face, const TriangleSurface& surface, float limit, FaceOverTriangle& out) {
    ClippedFace clipped;
    clip_face(face_of(t, surface), face, false, limit, clipped);
    for (int i = 0; i < clipped.count; ++i) {
        const FacePoint& p = clipped.points[i];
        if (!(p.separation <= limit)) continue;
        const bool corner = p.id >> 16 == face_feature(t.original);
        const Vec3 foot = clipped.point(p, 0.0f);
        out.points[out.count++] = {foot.x, foot.y, foot.z, p.separation,
                                   corner ? point_id(face_feature(0), p.id & 0xffffu) : p.id};
    }
}

bool is_wide(const Face& face) { return face.count >= 2 && face.count <= OverTriangleBatch::most_corners; }

}  // namespace

ShapeFace::ShapeFace(const Geometry& shape, Vec3 direction) : face(best_face(shape, direction)), size(0.0f) {
    for (int k = 0; is_wide(face) && k < face.count; ++k)
        size = maximum(size, length(face.vertices[next_of(k, face.count)] - face.vertices[k]));
}

TriangleSides::TriangleSides(const Triangle& t) {
    for (int i = 0; i < 3; ++i) {
        const Vec3 across = out_across(t, i);
        length[i] = lendulet::length(across);
        out[i] = (1.0f / length[i]) * across;
        offset[i] = dot(out[i], t.vertices[i]);
    }
}

void OverTriangleBatch::begin(const MeshFilterBatch& left, int from) {
    triangles = &left, first = from, corners = 0;
    count = left.live - from < capacity ? left.live - from : capacity;
    for (float& n : corner_count) n = 0.0f;
}

void OverTriangleBatch::set_face(int i, const ShapeFace& f) {
    const Face& face = f.face;
    if (!is_wide(face)) return;
    const int n = face.count;
    if (n > corners) corners = n;
    corner_count[i] = static_cast<float>(n);
    face_size[i] = f.size;
    face_normal[0][i] = face.normal.x, face_normal[1][i] = face.normal.y, face_normal[2][i] = face.normal.z;
    for (int k = 0; k <= n; ++k) {
        const Vec3 p = face.vertices[k < n ? k : 0];
        corner[k][0][i] = p.x, corner[k][1][i] = p.y, corner[k][2][i] = p.z;
    }
}

void OverTriangleBatch::read(int i, const Triangle& t, const Face& face, const TriangleSurface& surface,
                             FaceOverTriangle& out) const {
    out.count = 0;
    if (!is_wide(face)) return clip_one(t, face, surface, limit, out);
    const Ids ids{face, surface, t};
    constexpr uint32_t every_point = (1u << points) - 1u;
    for (uint32_t left = static_cast<uint32_t>(bits[i]) & every_point; left != 0; left &= left - 1) {
        const int k = std::countr_zero(left), edge = k / 2;
        uint32_t id;
        if (k >= first_covered) id = ids.covered(k - first_covered);
        else if (side[k][i] >= 0.0f) id = ids.crossing(edge, static_cast<int>(side[k][i]));
        else id = ids.corner(k & 1 ? next_of(edge, face.count) : edge);
        out.points[out.count++] = {point[k][0][i], point[k][1][i], point[k][2][i], height[k][i], id};
    }
}

void clip_over_triangles(OverTriangleBatch& batch) { clip_over_triangles<4>(batch); }

}  // namespace lendulet
