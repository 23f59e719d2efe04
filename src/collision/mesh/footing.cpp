#include "collision/mesh/footing.h"

#include <cstring>

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

void Footing::Linking::add(uint32_t name, uint8_t beyond, bool from_behind) {
    uint16_t& begin = first[name % lists];
    at[count] = {name, begin, beyond, from_behind};
    begin = static_cast<uint16_t>(++count);
}

const Footing::Linked* Footing::Linking::find(uint32_t name, bool from_behind) const {
    for (uint32_t i = first[name % lists]; i != 0; i = at[i - 1].next)
        if (at[i - 1].name == name && at[i - 1].from_behind == from_behind) return &at[i - 1];
    return nullptr;
}

void Footing::link(const MeshQuery& q) {
    linked_ = true;
    std::memset(triangles_.first, 0, sizeof triangles_.first);
    std::memset(settled_.first, 0, sizeof settled_.first);
    for (int i = 0; i < count_; ++i) {
        const Beside& n = noted_[i];
        triangles_.add(n.index, n.beyond, n.from_behind);
        for (int k = 0; k < 3; ++k)
            if (is_within(n.beyond, k)) settled_.add(q.surface.vertex(n.index, k), 0, n.from_behind);
    }
}

Footing::Beside Footing::look_up(const MeshQuery& q, uint32_t index, bool from_behind) const {
    const Linked* noted = triangles_.find(index, from_behind);
    if (noted != nullptr) return {index, noted->beyond, from_behind};
    const Triangle t = q.triangle(index);
    return {index, beyond_edges(q, t, TriangleSides(t), support_core(q.shape, -t.normal)), t.from_behind};
}

bool Footing::may_touch_rim(const MeshQuery& q, const Beside& t) {
    if (!linked_) link(q);
    const uint8_t touching = t.from_behind ? q.surface.concave_edges(t.index) : q.surface.convex_edges(t.index);
    uint8_t corners = 0;  // that may be touched: those of edges that the lowest point is beyond
    for (int i = 0; i < 3; ++i)
        if ((t.beyond >> i & 1) != 0) corners |= bit(i) | bit((i + 1) % 3);
    for (int i = 0; i < 3; ++i) {
        if ((t.beyond >> i & 1) == 0) continue;
        int32_t across = q.surface.neighbour(t.index, i);
        if (across < 0) return true;
        const Beside n = look_up(q, static_cast<uint32_t>(across), t.from_behind);
        if (n.from_behind != t.from_behind) return true;
        for (int k = 0; k < 3; ++k) {
            bool shared = q.surface.neighbour(n.index, k) == static_cast<int32_t>(t.index);
            if (shared && (n.beyond >> k & 1) != 0 && (touching >> i & 1) != 0) return true;
            for (int c : {i, (i + 1) % 3})
                if (is_within(n.beyond, k) && q.surface.vertex(n.index, k) == q.surface.vertex(t.index, c))
                    corners &= static_cast<uint8_t>(~bit(c));
        }
    }
    for (int c = 0; c < 3; ++c) {
        bool touches = (touching & (bit(c) | bit(before(c)))) != 0;
        if ((corners >> c & 1) != 0 && touches && !settled_.find(q.surface.vertex(t.index, c), t.from_behind))
            return true;
    }
    return false;
}

}  // namespace lendulet
