// Walks through a mesh's hierarchy or a height field's pyramid: along a ray or a swept box, nearest nodes first, and
// outwards from a box.
//
// The visitor is told a triangle and returns how far the walk still needs to go: a fraction of the translation, or a
// distance. Node tests are made with a margin for rounding, so that what they leave out could not have been met.
#pragma once

#include <cfloat>

#include "collision/gjk_math.h"
#include "geometry/triangle_surface.h"

namespace lendulet {

// A box of half extents `half` about origin + t * translation.
struct SweptBox {
    Vec3d origin, translation, half;
};

namespace mesh_walk {

inline constexpr double margin = 1e-6;  // relative

struct Entry {
    int32_t node;
    float key;
};
struct Stack {
    Entry entries[max_mesh_depth * 8];
    int top = 0;
    // Nearest last, so that it comes off first.
    void push(Entry e, int bottom) {
        int at = top++;
        for (; at > bottom && entries[at - 1].key < e.key; --at) entries[at] = entries[at - 1];
        entries[at] = e;
    }
};

// A node's box.
struct NodeBox {
    float lower[3], upper[3];
    bool empty() const { return !(lower[1] <= upper[1]); }
};
inline NodeBox box_of(const MeshNode& node, int k) {
    return {{node.lower[0][k], node.lower[1][k], node.lower[2][k]},
            {node.upper[0][k], node.upper[1][k], node.upper[2][k]}};
}

// Where the swept box first touches the node's box, or more than `limit` where it does not before that.
inline double entry_of(const SweptBox& s, const NodeBox& box, double limit) {
    double enter = 0.0, leave = limit;
    const double o[3] = {s.origin.x, s.origin.y, s.origin.z}, h[3] = {s.half.x, s.half.y, s.half.z};
    const double d[3] = {s.translation.x, s.translation.y, s.translation.z};
    for (int i = 0; i < 3; ++i) {
        double low = box.lower[i], high = box.upper[i];
        double grow = h[i] + margin * (absolute(low) + absolute(high) + h[i]);
        low -= grow, high += grow;
        if (d[i] == 0.0) {
            if (o[i] < low || o[i] > high) return 2.0 * limit + 1.0;
            continue;
        }
        double a = (low - o[i]) / d[i], b = (high - o[i]) / d[i];
        enter = maximum(enter, minimum(a, b));
        leave = minimum(leave, maximum(a, b));
    }
    return enter <= leave ? enter : 2.0 * limit + 1.0;
}

// Distance between the boxes, rounded down.
inline double distance_to(const NodeBox& box, Vec3d lower, Vec3d upper) {
    const double l[3] = {lower.x, lower.y, lower.z}, u[3] = {upper.x, upper.y, upper.z};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        double gap = maximum(0.0, maximum(box.lower[i] - u[i], l[i] - box.upper[i]));
        sum += gap * gap;
    }
    return square_root(sum) * (1.0 - margin);
}

// key_of(box, limit) orders and prunes; visit(triangle) gives the new limit.
template <class Key, class Visit>
void walk(const MeshData& mesh, double limit, Key&& key_of, Visit&& visit) {
    if (mesh.nodes.empty()) return;
    Stack stack;
    stack.push({0, 0.0f}, 0);
    while (stack.top > 0) {
        Entry e = stack.entries[--stack.top];
        if (e.key > limit) continue;
        if (e.node < 0) {
            int32_t lane = ~e.node & 7;
            const MeshNode& node = mesh.nodes[static_cast<uint32_t>(~e.node) >> 3];
            auto first = static_cast<uint32_t>(~node.child[lane]);
            for (uint32_t i = 0; i < node.count[lane]; ++i) limit = visit(first + i);
            continue;
        }
        const MeshNode& node = mesh.nodes[static_cast<uint32_t>(e.node)];
        int bottom = stack.top;
        for (int k = 0; k < 8; ++k) {
            const NodeBox box = box_of(node, k);
            if (box.empty()) continue;
            double key = key_of(box, limit);
            if (key > limit) continue;
            // Leaves wait their turn too: a nearer node may hold a nearer triangle.
            int32_t child = node.child[k] >= 0 ? node.child[k] : ~(e.node * 8 + k);
            stack.push({child, static_cast<float>(key * (1.0 - margin))}, bottom);
        }
    }
}

// The same down the pyramid of a height field. Blocks are told by level, column and row.
template <class Key, class Visit>
void walk(const HeightFieldData& field, double limit, Key&& key_of, Visit&& visit) {
    struct Block {
        int32_t level, i, k;
        float key;
    };
    Block stack[3 * 32 + 4];  // three wait on each level
    int top = 0;
    auto look_at = [&](int32_t level, int32_t i, int32_t k, int bottom) {
        NodeBox box;
        field.block_box(level, i, k, box.lower, box.upper);
        if (box.empty()) return;
        double key = key_of(box, limit);
        if (key > limit) return;
        Block b{level, i, k, static_cast<float>(key * (1.0 - margin))};
        int at = top++;
        for (; at > bottom && stack[at - 1].key < b.key; --at) stack[at] = stack[at - 1];
        stack[at] = b;
    };
    look_at(field.top(), 0, 0, 0);
    while (top > 0) {
        const Block b = stack[--top];
        if (b.key > limit) continue;
        if (b.level == 0) {
            uint32_t first = 2 * field.cell(b.i, b.k);
            limit = visit(first);
            limit = visit(first + 1);
            continue;
        }
        const int32_t level = b.level - 1, bottom = top;
        const int32_t width = (field.cells_x + (1 << level) - 1) >> level;
        const int32_t depth = (field.cells_z + (1 << level) - 1) >> level;
        for (int32_t k = 2 * b.k; k < 2 * b.k + 2 && k < depth; ++k)
            for (int32_t i = 2 * b.i; i < 2 * b.i + 2 && i < width; ++i) look_at(level, i, k, bottom);
    }
}

template <class Key, class Visit>
void walk(const TriangleSurface& surface, double limit, Key&& key_of, Visit&& visit) {
    if (surface.mesh()) walk(*surface.mesh(), limit, key_of, visit);
    else walk(surface.field(), limit, key_of, visit);
}

}  // namespace mesh_walk

template <class Visit>
void walk_along(const TriangleSurface& surface, const SweptBox& swept, double limit, Visit&& visit) {
    mesh_walk::walk(
        surface, limit, [&](const mesh_walk::NodeBox& box, double now) { return mesh_walk::entry_of(swept, box, now); },
        visit);
}

template <class Visit>
void walk_outwards(const TriangleSurface& surface, Vec3d lower, Vec3d upper, double limit, Visit&& visit) {
    mesh_walk::walk(
        surface, limit,
        [&](const mesh_walk::NodeBox& box, double) { return mesh_walk::distance_to(box, lower, upper); }, visit);
}

}  // namespace lendulet
