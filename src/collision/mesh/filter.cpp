#include "collision/mesh/filter.h"

#include "collision/mesh/query.h"
#include "geometry/hull.h"
#include "math/wide/mask.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

#include "collision/mesh/filter.inl"

// Hulls of more corners are taken for their boxes here.
constexpr size_t most_corners = 32;

// Bounds in the shape's own axes; those of a hull are known.
CentredBox box_of(const Geometry& g) {
    if (g.kind != GeometryKind::hull) return bounds(g, {0.0f, 0.0f, 0.0f, 1.0f});
    const Vec3 half = 0.5f * (g.hull->upper - g.hull->lower), rounding{g.rounding, g.rounding, g.rounding};
    return {0.5f * (g.hull->lower + g.hull->upper), half + rounding};
}

}  // namespace

void filter_triangles(MeshFilterBatch& batch) { filter_triangles<4>(batch); }

MeshFilter::MeshFilter(const MeshQuery& q, float limit) : surface_(q.surface), filter_(q.settings.filter) {
    MeshFilterBatch& b = batch_;
    const Geometry& g = q.shape;
    b.shape = &g;
    b.hull = nullptr, b.hull_count = b.hull_faces = 0;
    b.position = q.position, b.lower = q.lower, b.upper = q.upper, b.centre = q.centre;
    b.to_shape = q.to_contact;
    b.slack = MeshQuery::level * q.size;
    b.limit = limit + b.slack;
    const CentredBox box = box_of(g);
    // A ball's core does not turn.
    reach_ = g.kind == GeometryKind::point ? 0.0f : length(absolute(box.centre) + box.half);
    const float reach = b.limit - g.rounding;
    const Vec3 half = box.half + Vec3{reach, reach, reach};
    b.box_lower = box.centre - half, b.box_upper = box.centre + half;
    if (g.kind != GeometryKind::hull) return;
    const HullData& hull = *g.hull;
    b.box_centre = box.centre, b.box_half = 0.5f * (hull.upper - hull.lower);
    if (hull.vertices.size() > most_corners) return;
    b.hull = hull.vertices.data(), b.hull_count = static_cast<int>(hull.vertices.size());
    b.hull_face = hull.faces.data(), b.hull_faces = static_cast<int>(hull.faces.size());
}

void MeshFilter::load(const uint32_t* triangles, int count) {
    MeshFilterBatch& b = batch_;
    b.count = count;
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 16; ++i) b.corner[0][c][count + i] = 0.0f;
        for (int i = 0; i < 16; ++i) b.corner[1][c][count + i] = 0.0f;
        for (int i = 0; i < 16; ++i) b.corner[2][c][count + i] = 0.0f;
        for (int i = 0; i < 16; ++i) b.front[c][count + i] = 0.0f;
    }
    for (int i = 0; i < 16; ++i) b.lean[count + i] = 0.0f;
    for (int i = 0; i < count; ++i) {
        const uint32_t index = triangles[i];
        Vec3 corners[3];
        surface_.corners(index, corners);
        const Vec3 front = surface_.normal(index);
        for (int k = 0; k < 3; ++k) {
            b.corner[k][0][i] = corners[k].x, b.corner[k][1][i] = corners[k].y, b.corner[k][2][i] = corners[k].z;
        }
        b.front[0][i] = front.x, b.front[1][i] = front.y, b.front[2][i] = front.z;
        b.lean[i] = surface_.sharp_edges(index) == 0 ? gentle_edge_sine : 1.0f;  // beyond it the neighbour is nearer
    }
}

void MeshFilter::test(const uint32_t* triangles, int count) {
    for (int i = 0; i < count; ++i) surface_.ask_for(triangles[i]);
    for (int i = 0; i < count; ++i) surface_.ask_for_corners(triangles[i]);
    load(triangles, count);
    filter_(batch_);
}

}  // namespace lendulet
