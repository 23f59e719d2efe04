// A grid of heights, whose triangles are made when they are looked at: a sample takes 4 bytes, a cell 4 more for how
// its edges bend and 3 for the pyramid of bounds above it.
//
// A cell has the corners a, b along x and c, d along x in the next row, and the triangles (a, c, b) and (b, c, d).
// Triangle 2 n + 0 or 1 is of cell n. Its neighbours, corners and bounds follow from its number.
#pragma once

#include <cstdint>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

struct HeightRange {
    float lower, upper;  // inverted where all is holes
};

struct HeightFieldData {
    int32_t columns = 0, rows = 0;     // samples
    int32_t cells_x = 0, cells_z = 0;  // one less
    float cell_x = 1.0f, cell_z = 1.0f;
    Vec3 origin;
    std::vector<float> heights;  // origin.y included
    // Two a cell, one for each triangle: bits 0 to 2 are MeshTriangle::convex_edges, 3 to 5 concave_edges, 6 to 8
    // sharp_edges; 9: no triangle.
    std::vector<uint16_t> edges;
    std::vector<uint8_t> materials;  // by triangle; empty: all 0
    uint8_t most_material = 0;
    bool one_sided = false;
    int32_t triangles = 0;  // without those of holes
    // Level k, from 1 on, has the range of heights of blocks of 2^k x 2^k cells; the last level is one block.
    struct Level {
        int32_t width = 0, depth = 0;
        std::vector<HeightRange> ranges;
    };
    std::vector<Level> levels;  // [0] is level 1
    Vec3 lower, upper;
    float radius = 0.0f;  // largest distance of a sample from the local origin

    float x_at(int32_t column) const { return origin.x + cell_x * static_cast<float>(column); }
    float z_at(int32_t row) const { return origin.z + cell_z * static_cast<float>(row); }
    uint32_t sample(int32_t column, int32_t row) const { return static_cast<uint32_t>(row * columns + column); }
    Vec3 vertex(int32_t column, int32_t row) const { return {x_at(column), heights[sample(column, row)], z_at(row)}; }
    uint32_t cell(int32_t i, int32_t k) const { return static_cast<uint32_t>(k * cells_x + i); }
    bool is_hole(int32_t i, int32_t k) const { return (edges[2 * cell(i, k)] & no_triangle) != 0; }
    static constexpr uint16_t no_triangle = 0x200;

    // A triangle by its number.
    struct Corner {
        int32_t column, row;
    };
    Corner corner(uint32_t triangle, int k) const {
        static constexpr int8_t column[2][3] = {{0, 0, 1}, {1, 0, 1}}, row[2][3] = {{0, 1, 0}, {0, 1, 1}};
        auto i = static_cast<int32_t>(triangle / 2) % cells_x, j = static_cast<int32_t>(triangle / 2) / cells_x;
        return {i + column[triangle & 1][k], j + row[triangle & 1][k]};
    }
    void corners(uint32_t triangle, Vec3 (&out)[3]) const {
        for (int k = 0; k < 3; ++k) out[k] = vertex(corner(triangle, k).column, corner(triangle, k).row);
    }
    // Across edge k from corner k to the next; -1: none.
    int32_t neighbour(uint32_t triangle, int k) const;

    // The range of heights of a block; level 0 are cells. Inverted where all is holes.
    HeightRange range(int level, int32_t i, int32_t k) const;
    int top() const { return static_cast<int>(levels.size()); }
    // The box of a block.
    void block_box(int level, int32_t i, int32_t k, float (&lower_out)[3], float (&upper_out)[3]) const {
        HeightRange r = range(level, i, k);
        auto end = [&](int32_t first, int32_t cells) {
            int32_t last = (first + 1) << level;
            return last < cells ? last : cells;
        };
        lower_out[0] = x_at(i << level), lower_out[1] = r.lower, lower_out[2] = z_at(k << level);
        upper_out[0] = x_at(end(i, cells_x)), upper_out[1] = r.upper, upper_out[2] = z_at(end(k, cells_z));
    }
};

// visit(triangle) for every triangle of every cell whose box touches [lower, upper] (local frame), in a fixed order:
// blocks of 8 x 8 cells row by row, and so the cells in them.
template <class Visit>
void for_each_triangle(const HeightFieldData& f, Vec3 lower, Vec3 upper, Visit&& visit) {
    // Coordinates of samples are rounded by less than a hundredth of a cell.
    struct Span {
        int32_t first, last;
    };
    auto span = [](float low, float high, float origin, float cell, int32_t cells) {
        double from = (static_cast<double>(low) - origin) / cell - 0.01,
               to = (static_cast<double>(high) - origin) / cell + 0.01;
        double most = cells - 1;
        if (!(to >= 0.0) || !(from <= most + 1.0)) return Span{0, -1};
        return Span{from > 0.0 ? static_cast<int32_t>(from < most ? from : most) : 0,
                    static_cast<int32_t>(to < most ? to : most)};
    };
    constexpr int block = 3;
    const Span x = span(lower.x, upper.x, f.origin.x, f.cell_x, f.cells_x);
    const Span z = span(lower.z, upper.z, f.origin.z, f.cell_z, f.cells_z);
    if (x.last < x.first || z.last < z.first) return;
    auto misses = [&](HeightRange r) { return r.lower > upper.y || r.upper < lower.y; };
    const int level = block < f.top() ? block : f.top();
    for (int32_t kb = z.first >> level; kb <= z.last >> level; ++kb)
        for (int32_t ib = x.first >> level; ib <= x.last >> level; ++ib) {
            if (level > 0 && misses(f.range(level, ib, kb))) continue;
            auto from = [&](int32_t b, Span s) { return b << level > s.first ? b << level : s.first; };
            auto to = [&](int32_t b, Span s) {
                int32_t last = ((b + 1) << level) - 1;
                return last < s.last ? last : s.last;
            };
            for (int32_t k = from(kb, z); k <= to(kb, z); ++k)
                for (int32_t i = from(ib, x); i <= to(ib, x); ++i) {
                    if (misses(f.range(0, i, k))) continue;
                    visit(2 * f.cell(i, k));
                    visit(2 * f.cell(i, k) + 1);
                }
        }
}

}  // namespace lendulet
