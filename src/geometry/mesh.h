// Triangles with adjacency and a bounding-volume hierarchy of 8-wide nodes over them.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/prefetch.h"
#include "lendulet/math.h"
#include "lendulet/shapes.h"
#include "math/wide/wide.h"

namespace lendulet {

struct MeshTriangle {
    uint32_t vertex[3];
    uint32_t original;     // index in the user's list
    int32_t neighbour[3];  // triangle across edge (vertex[i], vertex[(i + 1) % 3]), -1: none or not unique
    // Bit i: across edge i the surface bends away from the front (an edge that can touch what is in front), or there is
    // no unique neighbour with the same winding.
    uint8_t convex_edges;
    // Bit i: the same for what is behind the triangle. Neither bit is set where the neighbour continues the triangle
    // within `flat_edge_sine`.
    uint8_t concave_edges;
    // Bit i: edge i bends to either side by more than `gentle_edge_sine`, or there is no unique neighbour.
    uint8_t sharp_edges;
};

// Edges that bend by less than this (as sine of the angle, 0.57 degrees) do not touch on their own: the normals of the
// two faces stand for theirs. Larger: smoother sliding over fine terrain, but edges of that angle feel like a face.
inline constexpr float flat_edge_sine = 0.01f;
// What touches an edge that bends by less than this (12 degrees), and is not round, touches both faces nearly as deep:
// the two faces stand for the edge, and no closest points are sought. Rolling terrain has such edges only.
inline constexpr float gentle_edge_sine = 0.2f;

// Unit normal of a triangle, or the zero vector where it has no area.
Vec3 normal_of_triangle(Vec3 a, Vec3 b, Vec3 c);

// How a surface goes on across the edge from a to b of a triangle with the unit normal given, into a neighbour with the
// corner `far` opposite to that edge.
struct EdgeBend {
    bool touches_front, touches_back, sharp;  // see MeshTriangle
};
EdgeBend bend_across(Vec3 a, Vec3 b, Vec3 far, Vec3 normal, Vec3 neighbour_normal);

struct alignas(64) MeshNode {
    float lower[3][8], upper[3][8];
    int32_t child[8];  // >= 0: node; < 0: ~first triangle of a leaf; empty slots have inverted boxes
    uint8_t count[8];  // triangles in a leaf
};

// Bounds of a hierarchy: its depth never exceeds this, however the triangles lie.
inline constexpr int max_mesh_depth = 48;

struct MeshData {
    std::vector<Vec3> vertices;           // those in use, each position once
    std::vector<MeshTriangle> triangles;  // in the order of the hierarchy's leaves
    std::vector<Vec3> normals;            // unit, one a triangle
    std::vector<uint32_t> place;          // by number in the user's list: in `triangles`; of those without area: 0
    std::vector<MeshNode> nodes;          // [0] is the root
    Vec3 lower, upper;
    float radius = 0.0f;  // largest distance of a vertex from the local origin
    int dropped = 0;
    bool one_sided = false;
    uint8_t most_material = 0;
    std::vector<uint8_t> materials;        // by number in the user's list; empty: all 0
    std::shared_ptr<const HullData> hull;  // null where the vertices are flat
};

// Fills `nodes` for triangles with the given bounds and gives their order: leaf triangle i is order[i]. Deterministic.
struct TriangleBounds {
    Vec3 lower, upper;
};
std::vector<uint32_t> build_hierarchy(const std::vector<TriangleBounds>& bounds, std::vector<MeshNode>& nodes);

// Calls visit(triangle index) for every triangle of every leaf whose bounds touch the box [lower, upper] (local frame),
// in a fixed order. Leaves hold at most two triangles.
template <class Visit>
void for_each_triangle(const MeshData& mesh, Vec3 lower, Vec3 upper, Visit&& visit) {
    if (mesh.nodes.empty()) return;
    using F = Wide<float, 4>;
    const float box_lower[3] = {lower.x, lower.y, lower.z}, box_upper[3] = {upper.x, upper.y, upper.z};
    uint32_t stack[max_mesh_depth * 8];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const MeshNode& node = mesh.nodes[stack[--top]];
        uint32_t hits = 0xff;
        for (int axis = 0; axis < 3; ++axis) {
            F low = splat<F>(box_lower[axis]), high = splat<F>(box_upper[axis]);
            for (int half = 0; half < 8; half += 4) {
                uint32_t below = mask_bits(load_wide<F>(&node.lower[axis][half]) <= high);
                uint32_t above = mask_bits(load_wide<F>(&node.upper[axis][half]) >= low);
                hits &= ((below & above) << half) | (0xf0u >> half);
            }
        }
        for (; hits != 0; hits &= hits - 1) {
            int i = std::countr_zero(hits);
            if (node.child[i] >= 0) {
                stack[top++] = static_cast<uint32_t>(node.child[i]);
                prefetch<4>(&mesh.nodes[stack[top - 1]]);
            } else {
                auto first = static_cast<uint32_t>(~node.child[i]);
                prefetch(&mesh.triangles[first]);
                prefetch(&mesh.normals[first]);
                for (uint32_t k = 0; k < node.count[i]; ++k) visit(first + k);
            }
        }
    }
}

}  // namespace lendulet
