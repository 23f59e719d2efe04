// Walks through a mesh's hierarchy: along a ray or a swept box, nearest nodes first, and outwards from a box.
//
// The visitor is told a triangle and returns how far the walk still needs to go: a fraction of the translation, or a
// distance. Node tests are made with a margin for rounding, so that what they leave out could not have been met.
#pragma once

#include <cfloat>

#include "collision/gjk_math.h"
#include "geometry/mesh.h"

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

// Where the swept box first touches the node's box k, or more than `limit` where it does not before that.
inline double entry_of(const SweptBox& s, const MeshNode& node, int k, double limit) {
    double enter = 0.0, leave = limit;
    const double o[3] = {s.origin.x, s.origin.y, s.origin.z}, h[3] = {s.half.x, s.half.y, s.half.z};
    const double d[3] = {s.translation.x, s.translation.y, s.translation.z};
    for (int i = 0; i < 3; ++i) {
        double low = node.lower[i][k], high = node.upper[i][k];
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

// Squared distance between the boxes, rounded down.
inline double distance_to(const MeshNode& node, int k, Vec3d lower, Vec3d upper) {
    const double l[3] = {lower.x, lower.y, lower.z}, u[3] = {upper.x, upper.y, upper.z};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        double gap = maximum(0.0, maximum(node.lower[i][k] - u[i], l[i] - node.upper[i][k]));
        sum += gap * gap;
    }
    return square_root(sum) * (1.0 - margin);
}

// key_of(node, lane) orders and prunes; visit(triangle) gives the new limit.
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
            if (!(node.lower[0][k] <= node.upper[0][k])) continue;
            double key = key_of(node, k, limit);
            if (key > limit) continue;
            // Leaves wait their turn too: a nearer node may hold a nearer triangle.
            int32_t child = node.child[k] >= 0 ? node.child[k] : ~(e.node * 8 + k);
            stack.push({child, static_cast<float>(key * (1.0 - margin))}, bottom);
        }
    }
}

}  // namespace mesh_walk

template <class Visit>
void walk_along(const MeshData& mesh, const SweptBox& box, double limit, Visit&& visit) {
    mesh_walk::walk(
        mesh, limit, [&](const MeshNode& node, int k, double now) { return mesh_walk::entry_of(box, node, k, now); },
        visit);
}

template <class Visit>
void walk_outwards(const MeshData& mesh, Vec3d lower, Vec3d upper, double limit, Visit&& visit) {
    mesh_walk::walk(
        mesh, limit, [&](const MeshNode& node, int k, double) { return mesh_walk::distance_to(node, k, lower, upper); },
        visit);
}

}  // namespace lendulet
