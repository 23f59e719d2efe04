#include "collision/mesh/footing.h"

#include "collision/mesh/filter.h"

namespace lendulet {
namespace {

uint8_t bit(int i) { return static_cast<uint8_t>(1u << i); }
int before(int i) { return i == 0 ? 2 : i - 1; }

// Whether the lowest point is within both sides that meet at a corner.
bool is_within(uint8_t beyond, int corner) { return (beyond & (bit(corner) | bit(before(corner)))) == 0; }

}  // namespace

uint8_t beyond_edges(const MeshQuery& q, const Triangle& t, const TriangleSides& sides, Vec3 lowest) {
    float depth = maximum(0.0f, -dot(t.normal, lowest - t.vertices[0]));
    float slack = MeshQuery::level * q.size + half_gentle_tangent * depth;
    uint8_t beyond = 0;
    for (int i = 0; i < 3; ++i) {
        const bool within = dot(sides.out[i], lowest) - sides.offset[i] < -slack;
        if (!within) beyond |= bit(i);
    }
    return beyond;
}

void Footing::note(const MeshQuery& q, uint32_t triangle, bool from_behind, uint8_t beyond) {
    if (count_ == capacity) return;
    Noted& n = noted_[count_++];
    n.index = triangle;
    for (int k = 0; k < 3; ++k) n.vertex[k] = q.surface.vertex(triangle, k);
    n.beyond = beyond;
    n.from_behind = from_behind;
}

Footing::Noted Footing::look_up(const MeshQuery& q, uint32_t index) const {
    for (int i = 0; i < count_; ++i)
        if (noted_[i].index == index) return noted_[i];
    const Triangle t = q.triangle(index);
    return {index,
            {q.surface.vertex(index, 0), q.surface.vertex(index, 1), q.surface.vertex(index, 2)},
            beyond_edges(q, t, TriangleSides(t), support_core(q.shape, -t.normal)),
            t.from_behind};
}

bool Footing::is_settled(uint32_t vertex, bool from_behind) const {
    for (int i = 0; i < count_; ++i) {
        const Noted& n = noted_[i];
        for (int k = 0; k < 3; ++k)
            if (n.vertex[k] == vertex && n.from_behind == from_behind && is_within(n.beyond, k)) return true;
    }
    return false;
}

bool Footing::may_touch_rim(const MeshQuery& q, const Beside& t) const {
    const uint8_t touching = t.from_behind ? q.surface.concave_edges(t.index) : q.surface.convex_edges(t.index);
    uint8_t corners = 0;  // that may be touched: those of edges that the lowest point is beyond
    for (int i = 0; i < 3; ++i)
        if ((t.beyond >> i & 1) != 0) corners |= bit(i) | bit((i + 1) % 3);
    for (int i = 0; i < 3; ++i) {
        if ((t.beyond >> i & 1) == 0) continue;
        int32_t across = q.surface.neighbour(t.index, i);
        if (across < 0) return true;
        Noted n = look_up(q, static_cast<uint32_t>(across));
        if (n.from_behind != t.from_behind) return true;
        for (int k = 0; k < 3; ++k) {
            bool shared = q.surface.neighbour(n.index, k) == static_cast<int32_t>(t.index);
            if (shared && (n.beyond >> k & 1) != 0 && (touching >> i & 1) != 0) return true;
            for (int c : {i, (i + 1) % 3})
                if (n.vertex[k] == q.surface.vertex(t.index, c) && is_within(n.beyond, k))
                    corners &= static_cast<uint8_t>(~bit(c));
        }
    }
    for (int c = 0; c < 3; ++c) {
        bool touches = (touching & (bit(c) | bit(before(c)))) != 0;
        if ((corners >> c & 1) != 0 && touches && !is_settled(q.surface.vertex(t.index, c), t.from_behind)) return true;
    }
    return false;
}

}  // namespace lendulet
