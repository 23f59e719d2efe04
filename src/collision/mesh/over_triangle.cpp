#include "collision/mesh/over_triangle.h"

#include <bit>

namespace lendulet {
namespace {

using F = ShapeFace::F;
using V = Vec3T<F>;
constexpr int lanes = ShapeFace::lanes, blocks = ShapeFace::blocks, most = lanes * blocks;

// As clip.cpp has it: points this part of the smaller face's size outside still count as over it.
constexpr float overhang = 2e-4f;
// Sine of the angle of a face with the triangle's normal below which it is seen from the side and covers no corner.
constexpr float edge_on = 1e-3f;

int next_of(int i, int count) { return i + 1 < count ? i + 1 : 0; }

uint32_t edge_of(const Face& face, int i) { return edge_feature(face.ids[i], face.ids[next_of(i, face.count)]); }

void add(Vec3 foot, float height, uint32_t id, float limit, FaceOverTriangle& out) {
    if (height <= limit && out.count < max_clipped_points)
        out.points[out.count++] = {foot.x, foot.y, foot.z, height, id};
}

// A value of each corner, the first one again after the last.
struct Around {
    float value[most + lanes]{};
    void close(int count) { value[count] = value[0]; }
    F at(int block) const { return load_wide<F>(value + lanes * block); }
    F next(int block) const { return load_wide<F>(value + lanes * block + 1); }
};

// Stretches of the edges that lie inside all sides.
struct Stretches {
    Around inside[3], height;  // how far corners lie inside each side
    float first[most], last[most];
    int enters[most], leaves[most];  // through which side; -1: the end of the edge is inside
    uint32_t valid = 0;              // bit i: there is one of edge i
};

void find_stretches(int block, uint32_t used, Stretches& s) {
    const F zero{}, one = splat<F>(1.0f), none = splat<F>(-1.0f);
    F first = zero, last = one, enters = none, leaves = none;
    auto within = one > zero;
    for (int i = 0; i < 3; ++i) {
        const F a = s.inside[i].at(block), b = s.inside[i].next(block), side = splat<F>(static_cast<float>(i));
        auto a_out = a < zero, b_out = b < zero;
        within = within & ~(a_out & b_out);
        const F t = a / select(a_out ^ b_out, a - b, one);
        auto later = a_out & ~b_out & (t > first), sooner = b_out & ~a_out & (t < last);
        first = select(later, t, first), enters = select(later, side, enters);
        last = select(sooner, t, last), leaves = select(sooner, side, leaves);
    }
    within = within & (first <= last);
    store_wide(s.first + lanes * block, first), store_wide(s.last + lanes * block, last);
    for (int l = 0; l < lanes; ++l) {
        s.enters[lanes * block + l] = static_cast<int>(lane(enters, l));
        s.leaves[lanes * block + l] = static_cast<int>(lane(leaves, l));
    }
    s.valid |= (mask_bits(within) & used) << (lanes * block);
}

struct Ids {
    const Face& face;
    const TriangleSurface& surface;
    const Triangle& t;

    uint32_t corner(int i) const { return point_id(face_feature(0), vertex_feature(face.ids[i])); }
    uint32_t crossing(int edge, int side) const {
        const uint32_t a = surface.vertex(t.index, side) & 0xffffu,
                       b = surface.vertex(t.index, next_of(side, 3)) & 0xffffu;
        return point_id(edge_feature(a, b), edge_of(face, edge));
    }
    uint32_t covered(int corner) const {
        return point_id(vertex_feature(surface.vertex(t.index, corner)), face_feature(face.id));
    }
};

void add_stretches(const Stretches& s, const Ids& ids, float limit, FaceOverTriangle& out) {
    const Face& face = ids.face;
    auto at = [&](int i, float t, uint32_t id) {
        const int n = next_of(i, face.count);
        const float height = s.height.value[i] + t * (s.height.value[n] - s.height.value[i]);
        const Vec3 p = face.vertices[i] + t * (face.vertices[n] - face.vertices[i]);
        add(p - height * ids.t.normal, height, id, limit, out);
    };
    for (uint32_t left = s.valid; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (s.enters[i] < 0) at(i, 0.0f, ids.corner(i));
        else at(i, s.first[i], ids.crossing(i, s.enters[i]));
        if (s.leaves[i] >= 0) at(i, s.last[i], ids.crossing(i, s.leaves[i]));
        else if (face.count == 2) at(1, 0.0f, ids.corner(1));
    }
}

// Corners of the triangle that the face covers, seen along the triangle's normal.
void add_covered(const ShapeFace& f, int block_count, uint32_t used, const Ids& ids, float limit,
                 FaceOverTriangle& out) {
    const Triangle& t = ids.t;
    const float slope = dot(f.face.normal, t.normal);
    if (!(slope < -edge_on)) return;
    uint32_t covered = 7;
    const V normal = splat<F>(t.normal);
    for (int b = 0; b < block_count; ++b) {
        const V inwards = cross(f.edge[b], normal);
        const uint32_t here = used >> (lanes * b) & ((1u << lanes) - 1u);
        for (int c = 0; c < 3; ++c) {
            auto outside = dot(splat<F>(t.vertices[c]) - f.corner[b], inwards) < F{};
            if ((mask_bits(outside) & here) != 0) covered &= ~(1u << c);
        }
    }
    for (; covered != 0; covered &= covered - 1) {
        const int c = std::countr_zero(covered);
        const float height = dot(f.face.normal, f.face.vertices[0] - t.vertices[c]) / slope;
        add(t.vertices[c], height, ids.covered(c), limit, out);
    }
}

void clip_by_planes(const ShapeFace& f, const Triangle& t, const TriangleSides& sides, const TriangleSurface& surface,
                    float limit, FaceOverTriangle& out) {
    const int count = f.face.count, block_count = count <= lanes ? 1 : blocks;
    const uint32_t used = count == 2 ? 1u : (1u << count) - 1u, corners = (1u << count) - 1u;
    const float reach = maximum(maximum(sides.length[0], sides.length[1]), sides.length[2]);
    const float slack = overhang * minimum(reach, f.size);
    Stretches s;
    for (int i = 0; i < 3; ++i) {
        const V side = splat<F>(sides.out[i]);
        const F offset = splat<F>(sides.offset[i] + slack);
        uint32_t outside = 0;
        for (int b = 0; b < block_count; ++b) {
            const F inside = offset - dot(side, f.corner[b]);
            store_wide(s.inside[i].value + lanes * b, inside);
            outside |= mask_bits(inside < F{}) << (lanes * b);
        }
        if ((outside & corners) == corners) return;
        s.inside[i].close(count);
    }
    const V normal = splat<F>(t.normal);
    const F level = splat<F>(dot(t.normal, t.vertices[0]));
    for (int b = 0; b < block_count; ++b) store_wide(s.height.value + lanes * b, dot(normal, f.corner[b]) - level);
    for (int b = 0; b < block_count; ++b) find_stretches(b, used >> (lanes * b) & ((1u << lanes) - 1u), s);
    const Ids ids{f.face, surface, t};
    add_stretches(s, ids, limit, out);
    if (count > 2) add_covered(f, block_count, used, ids, limit, out);
}

}  // namespace

void ShapeFace::update() {
    if (!is_wide()) return;
    float at[3][lanes * blocks], along[3][lanes * blocks];
    size = 0.0f;
    for (int i = 0; i < lanes * blocks; ++i) {
        const int k = i < face.count ? i : face.count - 1;
        const Vec3 p = face.vertices[k], e = face.vertices[next_of(k, face.count)] - p;
        size = maximum(size, length(e));
        for (int c = 0; c < 3; ++c) at[c][i] = component(p, c), along[c][i] = component(e, c);
    }
    for (int b = 0; b < blocks; ++b) {
        const int i = lanes * b;
        corner[b] = {load_wide<F>(at[0] + i), load_wide<F>(at[1] + i), load_wide<F>(at[2] + i)};
        edge[b] = {load_wide<F>(along[0] + i), load_wide<F>(along[1] + i), load_wide<F>(along[2] + i)};
    }
}

TriangleSides::TriangleSides(const Triangle& t) {
    for (int i = 0; i < 3; ++i) {
        const Vec3 across = out_across(t, i);
        length[i] = lendulet::length(across);
        out[i] = (1.0f / length[i]) * across;
        offset[i] = dot(out[i], t.vertices[i]);
    }
}

void clip_over_triangle(const ShapeFace& face, const Triangle& t, const TriangleSides& sides,
                        const TriangleSurface& surface, float limit, FaceOverTriangle& out) {
    out.count = 0;
    if (face.is_wide()) return clip_by_planes(face, t, sides, surface, limit, out);
    ClippedFace clipped;
    clip_face(face_of(t, surface), face.face, false, limit, clipped);
    for (int i = 0; i < clipped.count; ++i) {
        const FacePoint& p = clipped.points[i];
        const bool corner = p.id >> 16 == face_feature(t.original);
        add(clipped.point(p, 0.0f), p.separation, corner ? point_id(face_feature(0), p.id & 0xffffu) : p.id, limit,
            out);
    }
}

}  // namespace lendulet
