// Building and refitting. The heuristic with bins follows Wald, "On fast construction of SAH-based bounding volume
// hierarchies" (2007), splitting the largest part of a node until it has eight.
#include "broad_phase/query_tree.h"

#include <utility>

#include "broad_phase/extent.h"

namespace lendulet {
namespace {

constexpr int bins = 12;

}  // namespace

float QueryTree::Part::area() const { return half_area(lower, upper); }

void QueryTree::measure(Part& part) const {
    clear_extent(part.lower, part.upper);
    for (int i = 0; i < part.count; ++i) {
        const Item& item = items_[static_cast<size_t>(part.first + i)];
        include_extent(part.lower, part.upper, item.lower, item.upper);
    }
}

void QueryTree::set(Node& node, int lane, const float lower[3], const float upper[3], int32_t child) {
    set_lane(node.box, lane, lower, upper);
    node.child[lane] = child;
}

// Where to cut the part's items after they have been reordered: the number that go to the front. 0 where all centres
// coincide.
int QueryTree::split_place(const Part& part) {
    auto centre = [](const Item& item, int d) { return 0.5f * item.lower[d] + 0.5f * item.upper[d]; };
    float low[3], high[3];
    clear_extent(low, high);
    Item* items = items_.data() + part.first;
    for (int i = 0; i < part.count; ++i)
        for (int d = 0; d < 3; ++d) {
            float c = centre(items[i], d);
            low[d] = minimum(low[d], c), high[d] = maximum(high[d], c);
        }
    struct Bin {
        int count = 0;
        float lower[3], upper[3];
        Bin() { clear_extent(lower, upper); }
    };
    float best_cost = infinity, best_scale = 0.0f;
    int best_axis = -1, best_bin = 0;
    auto bin_of = [&](const Item& item, int axis, float scale) {
        int b = static_cast<int>((centre(item, axis) - low[axis]) * scale);
        return b < 0 ? 0 : b >= bins ? bins - 1 : b;
    };
    for (int axis = 0; axis < 3; ++axis) {
        float extent = high[axis] - low[axis], scale = static_cast<float>(bins) / extent;
        if (!(extent > 0.0f) || !(scale <= FLT_MAX)) continue;
        Bin bin[bins];
        for (int i = 0; i < part.count; ++i) {
            Bin& b = bin[bin_of(items[i], axis, scale)];
            ++b.count;
            include_extent(b.lower, b.upper, items[i].lower, items[i].upper);
        }
        float area_behind[bins];
        Bin sum;
        for (int i = bins - 1; i > 0; --i) {
            include_extent(sum.lower, sum.upper, bin[i].lower, bin[i].upper);
            sum.count += bin[i].count;
            area_behind[i] = sum.count ? half_area(sum.lower, sum.upper) * static_cast<float>(sum.count) : infinity;
        }
        Bin front;
        for (int i = 0; i + 1 < bins; ++i) {
            include_extent(front.lower, front.upper, bin[i].lower, bin[i].upper);
            front.count += bin[i].count;
            if (front.count == 0) continue;
            float cost = half_area(front.lower, front.upper) * static_cast<float>(front.count) + area_behind[i + 1];
            if (cost < best_cost) best_cost = cost, best_axis = axis, best_bin = i, best_scale = scale;
        }
    }
    if (best_axis < 0) return 0;
    int front = 0;
    for (int i = 0; i < part.count; ++i)
        if (bin_of(items[i], best_axis, best_scale) <= best_bin) std::swap(items[front++], items[i]);
    return front;
}

// Cuts a part in two and returns the second.
QueryTree::Part QueryTree::split(Part& part, bool by_heuristic) {
    int front = by_heuristic ? split_place(part) : 0;
    if (front == 0 || front == part.count) front = part.count / 2;
    Part second{part.first + front, part.count - front, {}, {}};
    part.count = front;
    measure(part);
    measure(second);
    return second;
}

void QueryTree::fill(int32_t node, const Part& part, int depth) {
    Part parts[block_size] = {part};
    int count = 1;
    while (count < block_size) {
        int largest = -1;
        float most = -1.0f;
        for (int i = 0; i < count; ++i) {
            if (parts[i].count == 1) continue;
            float size = parts[i].area() * static_cast<float>(parts[i].count);
            if (depth >= heuristic_depth) size = static_cast<float>(parts[i].count);
            if (!(size <= most)) most = size, largest = i;
        }
        if (largest < 0) break;
        parts[count] = split(parts[largest], depth < heuristic_depth);
        ++count;
    }
    for (int k = 0; k < block_size; ++k) {
        Node& n = nodes_[static_cast<size_t>(node)];
        if (k >= count) {
            clear_lane(n.box, k);
            n.child[k] = -1;
            continue;
        }
        const Part& p = parts[k];
        if (p.count == 1) {
            const Item& item = items_[static_cast<size_t>(p.first)];
            set(n, k, p.lower, p.upper, ~static_cast<int32_t>(item.index));
            put(static_cast<uint32_t>(node), k, item.index);
            continue;
        }
        const auto child = static_cast<int32_t>(add_node(static_cast<uint32_t>(node * block_size + k)));
        set(nodes_[static_cast<size_t>(node)], k, p.lower, p.upper, child);
        fill(child, p, depth + 1);
    }
}

uint32_t QueryTree::add_node(uint32_t parent) {
    const auto node = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({});
    parents_.push_back(parent);
    for (int k = 0; k < block_size; ++k) {
        clear_lane(nodes_[node].box, k);
        nodes_[node].child[k] = -1;
    }
    return node;
}

void QueryTree::build(const BroadBox* boxes, int count) {
    count_ = built_count_ = count;
    changes_ = 0;
    worn_ = false;
    built_size_ = 0.0f;
    nodes_.clear();
    parents_.clear();
    places_.clear();
    unbounded_.clear();
    items_.clear();
    for (int i = 0; i < count; ++i) {
        const BroadBox& b = boxes[i];
        if (places_.size() <= b.index) places_.resize(b.index + 1u, no_box);
        if (!bounded(b)) {
            unbounded_.push_back(b.index);
            places_[b.index] = beside;
            continue;
        }
        items_.push_back({{b.lower[0], b.lower[1], b.lower[2]}, {b.upper[0], b.upper[1], b.upper[2]}, b.index});
    }
    if (items_.empty()) return;
    Part all{0, items_.count(), {}, {}};
    measure(all);
    add_node(no_parent);
    fill(0, all, 0);
    built_size_ = total_size();
}

float QueryTree::total_size() const {
    float sum = 0.0f;
    for (const Node& n : nodes_) {
        float lower[3], upper[3];
        measure(n, lower, upper);
        if (lower[0] <= upper[0]) sum += (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]);
    }
    return sum;
}

void QueryTree::measure(const Node& node, float lower[3], float upper[3]) {
    clear_extent(lower, upper);
    for (int k = 0; k < block_size; ++k)
        for (int d = 0; d < 3; ++d) {
            lower[d] = minimum(lower[d], node.box.lower[d][k]);
            upper[d] = maximum(upper[d], node.box.upper[d][k]);
        }
}

bool QueryTree::fit_lane(Node& node, int lane) const {
    float lower[3], upper[3];
    measure(nodes_[static_cast<size_t>(node.child[lane])], lower, upper);
    const BroadBox before = box_in(node.box, lane, 0);
    set_lane(node.box, lane, lower, upper);
    bool same = true;
    for (int d = 0; d < 3; ++d) same &= before.lower[d] == lower[d] && before.upper[d] == upper[d];
    return !same;
}

bool QueryTree::refit(const BroadBox* boxes) {
    for (uint32_t index : unbounded_)
        if (bounded(boxes[index])) return false;
    for (size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
        Node& n = nodes_[i];
        for (int k = 0; k < block_size; ++k) {
            if (is_empty(n.box, k)) continue;
            if (n.child[k] < 0) {
                const BroadBox& b = boxes[~n.child[k]];
                if (!bounded(b)) return false;
                set_lane(n.box, k, b.lower, b.upper);
            } else {
                fit_lane(n, k);
            }
        }
    }
    changes_ += count_;
    return true;
}

void QueryTree::add_to(ManyCasts& casts) const {
    for (uint32_t index : unbounded_)
        for (int i = 0; i < casts.count; ++i) {
            const CastVisit visit{i, index};
            casts.visit(casts.context, &visit, 1);
        }
    if (!nodes_.empty()) casts.trees[casts.tree_count++] = nodes_.data();
}

size_t QueryTree::bytes() const {
    return nodes_.bytes() + parents_.bytes() + places_.bytes() + unbounded_.bytes() + items_.bytes();
}

}  // namespace lendulet
