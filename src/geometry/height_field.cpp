// HeightField::from_heights: checks, the pyramid of bounds, and how the surface bends at each edge.
#include "geometry/height_field.h"

#include <limits>
#include <string>

#include "geometry/mesh.h"

namespace lendulet {

namespace {

constexpr int64_t most_cells = int64_t{1} << 29;
constexpr float smallest_cell = 1e-3f, largest_cell = 1e3f, largest_coordinate = 1e5f;  // m
constexpr float longest_cell = 100.0f;                                                  // times the other side
constexpr float steepest = 1000.0f;                                                     // rise by run
constexpr float farthest_cell = 65536.0f;  // in cells from the local origin: a coordinate is rounded by 1/128 of a cell
constexpr float infinity = std::numeric_limits<float>::infinity();

Error error(const std::string& text) { return {ErrorCode::bad_mesh, "HeightField: " + text}; }
bool is_finite(float x) { return x - x == 0.0f; }
std::string place(size_t i, int columns) {
    auto n = static_cast<size_t>(columns);
    return "the height of column " + std::to_string(i % n) + ", row " + std::to_string(i / n);
}

std::string check_list(const char* what, size_t size, size_t expected) {
    return std::string("there are ") + std::to_string(size) + ' ' + what + ", but there must be " +
           std::to_string(expected) + '.';
}

// Along one axis: the size of its cells, and how far they reach.
std::string check_axis(const char* axis, float cell, float origin, int samples) {
    auto bad = [&](const char* problem) { return std::string(axis) + problem; };
    if (!(cell >= smallest_cell && cell <= largest_cell)) return bad(": cells must be 1e-3 to 1e3 m long.");
    if (!is_finite(origin)) return bad(": the origin must be finite.");
    float end = origin + cell * static_cast<float>(samples - 1);
    float far = maximum(absolute(origin), absolute(end));
    if (!(far <= largest_coordinate)) return bad(": the field reaches beyond 1e5 m.");
    if (far > farthest_cell * cell) return bad(": the field reaches farther than 65536 cells from its local origin.");
    return {};
}

std::string check_sizes(const HeightFieldDef& d) {
    if (d.columns < 2 || d.rows < 2) return "there must be at least two columns and two rows of heights.";
    int64_t cells = int64_t{d.columns - 1} * (d.rows - 1);
    if (cells > most_cells) return "there are more than 2^29 cells.";
    auto samples = static_cast<size_t>(d.columns) * static_cast<size_t>(d.rows), n = static_cast<size_t>(cells);
    if (d.heights.size() != samples) return check_list("heights", d.heights.size(), samples);
    if (!d.holes.empty() && d.holes.size() != n) return check_list("holes", d.holes.size(), n);
    if (!d.materials.empty() && d.materials.size() != n && d.materials.size() != 2 * n)
        return check_list("materials", d.materials.size(), n) + " Or twice as many, one for each triangle.";
    if (std::string bad = check_axis("x", d.cell_x, d.origin.x, d.columns); !bad.empty()) return bad;
    if (std::string bad = check_axis("z", d.cell_z, d.origin.z, d.rows); !bad.empty()) return bad;
    if (maximum(d.cell_x, d.cell_z) > longest_cell * minimum(d.cell_x, d.cell_z))
        return "cells must not be more than 100 times as long as wide.";
    return {};
}

std::string check_heights(const HeightFieldDef& d) {
    if (!is_finite(d.origin.y)) return "the origin must be finite.";
    for (size_t i = 0; i < d.heights.size(); ++i) {
        float h = d.heights[i] + d.origin.y;
        if (!is_finite(h)) return place(i, d.columns) + " is not finite.";
        if (absolute(h) > largest_coordinate) return place(i, d.columns) + " is beyond 1e5 m.";
        bool along_x = i % static_cast<size_t>(d.columns) != 0, along_z = i >= static_cast<size_t>(d.columns);
        float rise_x = along_x ? absolute(d.heights[i] - d.heights[i - 1]) : 0.0f;
        float rise_z = along_z ? absolute(d.heights[i] - d.heights[i - static_cast<size_t>(d.columns)]) : 0.0f;
        if (rise_x > steepest * d.cell_x || rise_z > steepest * d.cell_z)
            return place(i, d.columns) + " differs from the one before it by more than 1000 times the cell.";
    }
    return {};
}

void grow(HeightRange& r, HeightRange by) {
    r.lower = minimum(r.lower, by.lower);
    r.upper = maximum(r.upper, by.upper);
}

void build_levels(HeightFieldData& f) {
    int32_t width = f.cells_x, depth = f.cells_z;
    for (int level = 0; width > 1 || depth > 1; ++level) {
        HeightFieldData::Level next;
        next.width = (width + 1) / 2, next.depth = (depth + 1) / 2;
        next.ranges.assign(static_cast<size_t>(next.width) * static_cast<size_t>(next.depth), {infinity, -infinity});
        for (int32_t k = 0; k < depth; ++k)
            for (int32_t i = 0; i < width; ++i)
                grow(next.ranges[static_cast<size_t>(k / 2) * static_cast<size_t>(next.width) +
                                 static_cast<size_t>(i / 2)],
                     f.range(level, i, k));
        width = next.width, depth = next.depth;
        f.levels.push_back(std::move(next));
    }
}

Vec3 normal_of(const HeightFieldData& f, uint32_t triangle) {
    Vec3 p[3];
    f.corners(triangle, p);
    return normal_of_triangle(p[0], p[1], p[2]);
}

uint16_t edges_of(const HeightFieldData& f, uint32_t triangle) {
    Vec3 p[3];
    f.corners(triangle, p);
    Vec3 normal = normal_of_triangle(p[0], p[1], p[2]);
    uint32_t bits = 0;
    for (int k = 0; k < 3; ++k) {
        int32_t n = f.neighbour(triangle, k);
        if (n < 0) {
            bits |= 0b1001001u << k;
            continue;
        }
        // The neighbour's corner that is on neither end of the edge.
        auto neighbour = static_cast<uint32_t>(n);
        int back = 0;
        while (f.neighbour(neighbour, back) != static_cast<int32_t>(triangle)) ++back;
        HeightFieldData::Corner far = f.corner(neighbour, (back + 2) % 3);
        EdgeBend bend =
            bend_across(p[k], p[(k + 1) % 3], f.vertex(far.column, far.row), normal, normal_of(f, neighbour));
        bits |= (bend.touches_front ? 1u : 0u) << k | (bend.touches_back ? 8u : 0u) << k | (bend.sharp ? 64u : 0u) << k;
    }
    return static_cast<uint16_t>(bits);
}

void set_extent(HeightFieldData& f) {
    HeightRange all = f.range(f.top(), 0, 0);
    f.lower = {f.x_at(0), all.lower, f.z_at(0)};
    f.upper = {f.x_at(f.cells_x), all.upper, f.z_at(f.cells_z)};
    for (int32_t k = 0; k < f.rows; ++k)
        for (int32_t i = 0; i < f.columns; ++i) f.radius = maximum(f.radius, length(f.vertex(i, k)));
}

void copy_materials(HeightFieldData& f, std::span<const uint8_t> given) {
    if (given.empty()) return;
    f.materials.resize(f.edges.size());
    bool by_triangle = given.size() == f.edges.size();
    for (size_t t = 0; t < f.edges.size(); ++t) {
        f.materials[t] = given[by_triangle ? t : t / 2];
        if (f.materials[t] > f.most_material) f.most_material = f.materials[t];
    }
}

}  // namespace

int32_t HeightFieldData::neighbour(uint32_t triangle, int k) const {
    auto n = static_cast<int32_t>(triangle / 2), i = n % cells_x, j = n / cells_x;
    int32_t first = triangle & 1 ? 0 : 1;  // of the two in a cell the other one, in every case
    if (triangle & 1) {
        if (k == 1) ++j;
        else if (k == 2) ++i;
    } else {
        if (k == 0) --i;
        else if (k == 2) --j;
    }
    if (i < 0 || j < 0 || i >= cells_x || j >= cells_z || is_hole(i, j)) return -1;
    return 2 * (j * cells_x + i) + first;
}

HeightRange HeightFieldData::range(int level, int32_t i, int32_t k) const {
    if (level > 0) {
        const Level& l = levels[static_cast<size_t>(level - 1)];
        return l.ranges[static_cast<size_t>(k) * static_cast<size_t>(l.width) + static_cast<size_t>(i)];
    }
    if (is_hole(i, k)) return {infinity, -infinity};
    float a = heights[sample(i, k)], b = heights[sample(i + 1, k)];
    float c = heights[sample(i, k + 1)], d = heights[sample(i + 1, k + 1)];
    return {minimum(minimum(a, b), minimum(c, d)), maximum(maximum(a, b), maximum(c, d))};
}

Result<HeightField> HeightField::from_heights(const HeightFieldDef& def) {
    std::string refused = check_sizes(def);
    if (refused.empty()) refused = check_heights(def);
    if (!refused.empty()) return error(refused);
    auto data = std::make_shared<HeightFieldData>();
    HeightFieldData& f = *data;
    f.columns = def.columns, f.rows = def.rows;
    f.cells_x = def.columns - 1, f.cells_z = def.rows - 1;
    f.cell_x = def.cell_x, f.cell_z = def.cell_z;
    f.origin = def.origin;
    f.one_sided = def.one_sided;
    f.heights.reserve(def.heights.size());
    for (float h : def.heights) f.heights.push_back(h + def.origin.y);
    const size_t cells = static_cast<size_t>(f.cells_x) * static_cast<size_t>(f.cells_z);
    f.edges.assign(2 * cells, 0);
    for (size_t n = 0; n < def.holes.size(); ++n)
        if (def.holes[n] != 0) f.edges[2 * n] = f.edges[2 * n + 1] = HeightFieldData::no_triangle;
    for (uint16_t& e : f.edges) f.triangles += e == 0;
    if (f.triangles == 0) return error("there is nothing but holes.");
    for (uint32_t t = 0; t < f.edges.size(); ++t)
        if (f.edges[t] != HeightFieldData::no_triangle) f.edges[t] = edges_of(f, t);
    copy_materials(f, def.materials);
    build_levels(f);
    set_extent(f);
    HeightField field;
    field.data_ = std::move(data);
    return field;
}

int HeightField::columns() const { return data_ ? data_->columns : 0; }
int HeightField::rows() const { return data_ ? data_->rows : 0; }
int HeightField::triangle_count() const { return data_ ? data_->triangles : 0; }
bool HeightField::is_one_sided() const { return data_ && data_->one_sided; }

int HeightField::material(int triangle) const {
    auto i = static_cast<size_t>(triangle);
    return data_ && triangle >= 0 && i < data_->materials.size() ? data_->materials[i] : 0;
}

bool HeightField::is_hole(int column, int row) const {
    bool inside = data_ && column >= 0 && row >= 0 && column < data_->cells_x && row < data_->cells_z;
    return inside && data_->is_hole(column, row);
}

std::vector<Vec3> HeightField::vertices() const {
    std::vector<Vec3> out;
    if (!data_) return out;
    out.reserve(data_->heights.size());
    for (int32_t k = 0; k < data_->rows; ++k)
        for (int32_t i = 0; i < data_->columns; ++i) out.push_back(data_->vertex(i, k));
    return out;
}

std::vector<uint32_t> HeightField::triangles() const {
    std::vector<uint32_t> out;
    if (!data_) return out;
    out.reserve(3 * static_cast<size_t>(data_->triangles));
    for (uint32_t t = 0; t < data_->edges.size(); ++t) {
        if (data_->edges[t] & HeightFieldData::no_triangle) continue;
        for (int k = 0; k < 3; ++k) {
            HeightFieldData::Corner c = data_->corner(t, k);
            out.push_back(data_->sample(c.column, c.row));
        }
    }
    return out;
}

}  // namespace lendulet
