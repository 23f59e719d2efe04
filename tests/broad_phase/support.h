// Sets of boxes of every awkward kind and the answers by brute force, in plain scalar code of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "broad_phase/broad_phase.h"

namespace lendulet::broad_phase_test {

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline constexpr BroadPhaseType all_types[] = {
    BroadPhaseType::all_pairs,  BroadPhaseType::sweep_1,   BroadPhaseType::sweep_3,   BroadPhaseType::rtree_quadratic,
    BroadPhaseType::rtree_star, BroadPhaseType::rtree_str, BroadPhaseType::rtree_omt, BroadPhaseType::wide_tree};

using Boxes = std::vector<BroadBox>;
using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

// Numbers that are the same with every standard library, unlike its distributions.
class Random {
public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float uniform(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8) * (1.0f / 16777216.0f);
    }
    int below(int n) { return static_cast<int>(engine_() % static_cast<uint32_t>(n)); }
    float bell() { return uniform(-1, 1) + uniform(-1, 1) + uniform(-1, 1); }

private:
    std::mt19937 engine_;
};

inline BroadBox make_box(std::array<float, 3> lower, std::array<float, 3> upper, uint32_t index) {
    return {{lower[0], lower[1], lower[2]}, index, {upper[0], upper[1], upper[2]}, 0};
}

inline BroadBox box_around(std::array<float, 3> c, std::array<float, 3> h, uint32_t index) {
    return make_box({c[0] - h[0], c[1] - h[1], c[2] - h[2]}, {c[0] + h[0], c[1] + h[1], c[2] + h[2]}, index);
}

inline const std::vector<std::string> distributions = {"uniform",   "clustered", "line x", "line y", "line z",
                                                       "one point", "nested",    "ground", "sizes",  "plane"};

// `n` boxes with indices from `first_index` on.
inline Boxes make_boxes(const std::string& kind, int n, uint32_t seed, uint32_t first_index = 0) {
    Random random(seed);
    Boxes boxes;
    float side = 1;
    while (side * side * side < 3.4f * static_cast<float>(n)) side *= 1.1f;  // about half a pair per box
    float cluster[8][3];
    for (auto& centre : cluster) {
        for (float& x : centre) x = random.uniform(0, 4 * side);
    }
    for (int i = 0; i < n; ++i) {
        std::array<float, 3> c, h;
        for (int d = 0; d < 3; ++d) {
            size_t k = static_cast<size_t>(d);
            c[k] = random.uniform(0, side);
            h[k] = random.uniform(0.25f, 0.5f);
            if (kind == "clustered") c[k] = cluster[i % 8][d] + 0.3f * side * random.bell();
            if (kind.starts_with("line")) c[k] = kind[5] - 'x' == d ? 0.7f * static_cast<float>(i) : 0;
            if (kind == "one point") c[k] = 7, h[k] = random.below(2) ? 0 : h[k];
            if (kind == "nested") c[k] = 5, h[k] = 0.01f * static_cast<float>(i + 1);
            if (kind == "ground" && i == n / 2) c[k] = d == 1 ? -1 : 0, h[k] = d == 1 ? 1 : 1e5f;
            if (kind == "sizes") h[k] *= random.below(20) ? 1 : random.below(2) ? 1e-3f : random.uniform(1, 1e3f);
            if (kind == "plane" && d == 1) c[k] = 3;
        }
        boxes.push_back(box_around(c, h, first_index + static_cast<uint32_t>(i)));
    }
    return boxes;
}

inline bool overlapping(const BroadBox& a, const BroadBox& b) {
    for (int d = 0; d < 3; ++d) {
        if (a.lower[d] > b.upper[d] || b.lower[d] > a.upper[d]) return false;
    }
    return true;
}

inline Pairs expected_pairs(const Boxes& fixed, const Boxes& moving) {
    Pairs pairs;
    for (size_t i = 0; i < moving.size(); ++i) {
        for (size_t j = i + 1; j < moving.size(); ++j) {
            if (overlapping(moving[i], moving[j])) pairs.push_back(std::minmax({moving[i].index, moving[j].index}));
        }
        for (const BroadBox& box : fixed) {
            if (overlapping(moving[i], box)) pairs.push_back(std::minmax({moving[i].index, box.index}));
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// The same by a sweep along an axis, for more boxes than can be compared each with each.
inline Pairs pairs_by_sweep(Boxes boxes, int axis) {
    std::stable_sort(boxes.begin(), boxes.end(),
                     [axis](const BroadBox& a, const BroadBox& b) { return a.lower[axis] < b.lower[axis]; });
    Pairs pairs;
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (size_t j = i + 1; j < boxes.size() && boxes[j].lower[axis] <= boxes[i].upper[axis]; ++j) {
            if (overlapping(boxes[i], boxes[j])) pairs.push_back(std::minmax({boxes[i].index, boxes[j].index}));
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

inline Pairs as_written(const Array<BoxPair>& list) {
    Pairs pairs;
    for (const BoxPair& pair : list) pairs.push_back({pair.a, pair.b});
    return pairs;
}

// Sorted; a pair found twice stays twice, so that comparing sets finds it.
inline Pairs found_pairs(BroadPhase& broad_phase, TaskPool& tasks) {
    Array<BoxPair> list;
    broad_phase.find_pairs(tasks, list);
    Pairs pairs = as_written(list);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

inline void set_fixed(BroadPhase& b, const Boxes& boxes) { b.set_fixed(boxes.data(), static_cast<int>(boxes.size())); }
inline void set_moving(BroadPhase& b, const Boxes& boxes) {
    b.set_moving(boxes.data(), static_cast<int>(boxes.size()));
}

}  // namespace lendulet::broad_phase_test
