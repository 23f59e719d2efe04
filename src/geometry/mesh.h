// Triangles with adjacency and a bounding-volume hierarchy of 8-wide nodes over them.
#pragma once

#include <cstdint>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

struct MeshTriangle {
    uint32_t vertex[3];
    uint32_t original;      // index in the user's list
    int32_t neighbour[3];   // triangle across edge (vertex[i], vertex[(i + 1) % 3]), -1: none or not unique
    uint8_t convex_edges;   // bit i: across edge i the surface bends away (an edge that can touch), or has no neighbour
};

struct alignas(64) MeshNode {
    float lower[3][8], upper[3][8];
    int32_t child[8];  // >= 0: node; < 0: ~first triangle of a leaf; empty slots have inverted boxes
    uint8_t count[8];  // triangles in a leaf
};

struct MeshData {
    std::vector<Vec3> vertices;
    std::vector<MeshTriangle> triangles;  // in the order of the hierarchy's leaves
    std::vector<Vec3> normals;            // unit, one a triangle
    std::vector<MeshNode> nodes;          // [0] is the root
    Vec3 lower, upper;
    int dropped = 0;
    std::shared_ptr<const HullData> hull;  // null where the vertices are flat
};

// Calls visit(triangle index) for every triangle whose bounds touch the box [lower, upper] (local frame), in a fixed
// order.
template <class Visit>
void for_each_triangle(const MeshData& mesh, Vec3 lower, Vec3 upper, Visit&& visit) {
    if (mesh.nodes.empty()) return;
    uint32_t stack[64 * 8];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const MeshNode& node = mesh.nodes[stack[--top]];
        for (int i = 7; i >= 0; --i) {
            bool hit = node.lower[0][i] <= upper.x && node.lower[1][i] <= upper.y && node.lower[2][i] <= upper.z &&
                       node.upper[0][i] >= lower.x && node.upper[1][i] >= lower.y && node.upper[2][i] >= lower.z;
            if (!hit) continue;
            if (node.child[i] >= 0) stack[top++] = static_cast<uint32_t>(node.child[i]);
            else
                for (int k = 0; k < node.count[i]; ++k) visit(static_cast<uint32_t>(~node.child[i]) + static_cast<uint32_t>(k));
        }
    }
}

}  // namespace lendulet
