// Triangle meshes for tests.
#pragma once

#include <vector>

#include "lendulet/shapes.h"

namespace pairs {

using namespace lendulet;

// Cells of `step` m about the origin, each of two triangles, at the height height(x, z); fronts up.
template <class Height>
TriangleMesh grid(int cells, float step, Height&& height) {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    float start = -0.5f * step * static_cast<float>(cells);
    for (int k = 0; k <= cells; ++k) {
        for (int i = 0; i <= cells; ++i) {
            float x = start + step * static_cast<float>(i), z = start + step * static_cast<float>(k);
            vertices.push_back({x, height(x, z), z});
        }
    }
    auto row = static_cast<uint32_t>(cells + 1);
    for (uint32_t z = 0; z + 1 < row; ++z) {
        for (uint32_t x = 0; x + 1 < row; ++x) {
            uint32_t a = z * row + x, b = a + 1, c = a + row, d = c + 1;
            for (uint32_t i : {a, c, b, b, c, d}) indices.push_back(i);
        }
    }
    return TriangleMesh::from_triangles(vertices, indices).value();
}
inline TriangleMesh flat_grid(int cells, float step) {
    return grid(cells, step, [](float, float) { return 0.0f; });
}

// A closed box, fronts outwards.
inline TriangleMesh box_mesh(Vec3 half) {
    std::vector<Vec3> vertices;
    for (int i = 0; i < 8; ++i) {
        vertices.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    }
    const std::vector<uint32_t> indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                           2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return TriangleMesh::from_triangles(vertices, indices).value();
}

}  // namespace pairs
