// The hierarchy of a mesh: nodes of eight boxes, built from above by the surface area heuristic with bins
// (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007), splitting the largest part of a node
// until it has eight.
#include <algorithm>
#include <limits>

#include "geometry/mesh.h"

namespace lendulet {

namespace {

constexpr int bins = 16;
constexpr uint32_t leaf_size = 2;
// Below this depth parts are split into halves by number. A node then has at most 8^-1 of its parent's triangles
// (rounded up to a power of two), so 2^30 triangles need no more than 11 further levels.
constexpr int heuristic_depth = max_mesh_depth - 12;
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Bounds {
    Vec3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
    void grow(Vec3 l, Vec3 u) {
        lower = minimum(lower, l);
        upper = maximum(upper, u);
    }
    float area() const {  // half the surface
        Vec3 d = upper - lower;
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

// A run of `order_` with its box.
struct Part {
    uint32_t first, count;
    Bounds box;
};

class HierarchyBuilder {
public:
    HierarchyBuilder(const std::vector<TriangleBounds>& bounds, std::vector<MeshNode>& nodes)
        : bounds_(bounds), nodes_(nodes), order_(bounds.size()) {
        for (uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    }

    std::vector<uint32_t> run() {
        nodes_.clear();
        Part all{0, static_cast<uint32_t>(order_.size()), {}};
        measure(all);
        nodes_.emplace_back();
        fill(0, all, 0);
        return std::move(order_);
    }

private:
    const TriangleBounds& at(uint32_t i) const { return bounds_[order_[i]]; }
    // Twice the centre: exact enough to sort by.
    static Vec3 centre(const TriangleBounds& b) { return b.lower + b.upper; }

    void measure(Part& part) const {
        part.box = {};
        for (uint32_t i = part.first; i < part.first + part.count; ++i) part.box.grow(at(i).lower, at(i).upper);
    }

    // Makes node `index` of the part; its depth is bounded, so is the recursion.
    void fill(uint32_t index, const Part& whole, int depth) {
        Part parts[8] = {whole};
        int count = 1;
        while (count < 8) {
            int widest = choose(parts, count, depth);
            if (widest < 0) break;
            Part upper = split(parts[widest], depth);
            for (int i = count; i > widest + 1; --i) parts[i] = parts[i - 1];  // in the order of their triangles
            parts[widest + 1] = upper;
            ++count;
        }
        MeshNode node;
        for (int i = 0; i < 8; ++i) {
            const Bounds box = i < count ? parts[i].box : Bounds{};
            for (int axis = 0; axis < 3; ++axis) {
                node.lower[axis][i] = component(box.lower, axis);
                node.upper[axis][i] = component(box.upper, axis);
            }
            node.child[i] = -1;
            node.count[i] = 0;
            if (i >= count) continue;
            if (parts[i].count <= leaf_size) {
                node.child[i] = ~static_cast<int32_t>(parts[i].first);
                node.count[i] = static_cast<uint8_t>(parts[i].count);
            } else {
                node.child[i] = static_cast<int32_t>(nodes_.size());
                nodes_.emplace_back();
            }
        }
        nodes_[index] = node;
        for (int i = 0; i < count; ++i)
            if (parts[i].count > leaf_size) fill(static_cast<uint32_t>(node.child[i]), parts[i], depth + 1);
    }

    // The part to split next: that with the largest surface (of equal ones the fullest); deep down that with the most
    // triangles. -1: all are leaves.
    static int choose(const Part* parts, int count, int depth) {
        int best = -1;
        float measure = -1.0f;
        for (int i = 0; i < count; ++i) {
            if (parts[i].count <= leaf_size) continue;
            float m = depth < heuristic_depth ? parts[i].box.area() : static_cast<float>(parts[i].count);
            if (m > measure || (m == measure && parts[i].count > parts[best].count)) measure = m, best = i;
        }
        return best;
    }

    // Leaves the lower half in `part` and returns the upper one.
    Part split(Part& part, int depth) {
        Bounds centres;
        for (uint32_t i = part.first; i < part.first + part.count; ++i) centres.grow(centre(at(i)), centre(at(i)));
        Vec3 size = centres.upper - centres.lower;
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        float lower = component(centres.lower, axis), extent = component(size, axis);
        uint32_t half = 0;
        if (depth < heuristic_depth && extent > 0.0f && part.count > 4) half = split_by_area(part, axis, lower, extent);
        if (half == 0) half = split_by_number(part, axis);
        Part upper{part.first + half, part.count - half, {}};
        part.count = half;
        measure(part);
        measure(upper);
        return upper;
    }

    uint32_t split_by_number(const Part& part, int axis) {
        uint32_t half = part.count / 2;
        auto first = order_.begin() + part.first;
        // order: total, ties by index
        std::nth_element(first, first + half, first + part.count, [&](uint32_t a, uint32_t b) {
            float ca = component(centre(bounds_[a]), axis), cb = component(centre(bounds_[b]), axis);
            return ca != cb ? ca < cb : a < b;
        });
        // nth_element leaves either side in the library's own order: sorted by index it is the same everywhere.
        std::sort(first, first + half);               // order: total
        std::sort(first + half, first + part.count);  // order: total
        return half;
    }

    // Puts triangles into bins by centre and takes the border between bins with the least sum of area times number on
    // either side. Keeps the order of the triangles within both halves.
    uint32_t split_by_area(const Part& part, int axis, float lower, float extent) {
        Bounds box[bins];
        uint32_t number[bins] = {};
        float scale = static_cast<float>(bins) / extent;
        auto bin_of = [&](uint32_t triangle) {
            float position = scale * (component(centre(bounds_[triangle]), axis) - lower);
            return position < static_cast<float>(bins - 1) ? static_cast<int>(position) : bins - 1;
        };
        for (uint32_t i = part.first; i < part.first + part.count; ++i) {
            int bin = bin_of(order_[i]);
            box[bin].grow(at(i).lower, at(i).upper);
            ++number[bin];
        }
        int border = best_border(box, number);
        if (border == 0) return 0;
        upper_.clear();
        uint32_t kept = part.first;
        for (uint32_t i = part.first; i < part.first + part.count; ++i) {
            uint32_t triangle = order_[i];
            if (bin_of(triangle) < border) order_[kept++] = triangle;
            else upper_.push_back(triangle);
        }
        std::copy(upper_.begin(), upper_.end(), order_.begin() + kept);
        return kept - part.first;
    }

    // Bins below the border go to the lower half. 0: no border has triangles on both sides.
    static int best_border(const Bounds (&box)[bins], const uint32_t (&number)[bins]) {
        float above_cost[bins] = {};
        Bounds sum;
        uint32_t count = 0;
        for (int b = bins - 1; b > 0; --b) {
            sum.grow(box[b].lower, box[b].upper);
            count += number[b];
            above_cost[b] = count > 0 ? sum.area() * static_cast<float>(count) : -1.0f;
        }
        sum = {};
        count = 0;
        int best = 0;
        float least = infinity;
        for (int b = 1; b < bins; ++b) {
            sum.grow(box[b - 1].lower, box[b - 1].upper);
            count += number[b - 1];
            if (count == 0 || above_cost[b] < 0.0f) continue;
            float cost = sum.area() * static_cast<float>(count) + above_cost[b];
            if (cost < least) least = cost, best = b;
        }
        return best;
    }

    const std::vector<TriangleBounds>& bounds_;
    std::vector<MeshNode>& nodes_;
    std::vector<uint32_t> order_, upper_;
};

}  // namespace

std::vector<uint32_t> build_hierarchy(const std::vector<TriangleBounds>& bounds, std::vector<MeshNode>& nodes) {
    return HierarchyBuilder(bounds, nodes).run();
}

}  // namespace lendulet
