// Boxes of a QueryTree that come, go and move one by one.
#include "broad_phase/extent.h"
#include "broad_phase/query_tree.h"

namespace lendulet {
namespace {

// A tree whose nodes have grown to this multiple of their size after building, for as many boxes, is built anew.
constexpr float most_growth = 1.5f;
constexpr int most_fresh = 64;  // boxes more than twice those that it was built of

}  // namespace

bool QueryTree::is_worn() {
    if (worn_ || count_ > 2 * built_count_ + most_fresh) return true;
    if (changes_ < count_) return false;
    changes_ = 0;
    const float more = static_cast<float>(count_) / static_cast<float>(maximum(built_count_, 1));
    return worn_ = total_size() > most_growth * maximum(more, 1.0f) * built_size_;
}

// Enlarges or reduces what holds a node, up to the first that stays as it is.
void QueryTree::fit_parents(uint32_t node) {
    while (parents_[node] != no_parent) {
        const uint32_t parent = parents_[node] / block_size;
        Node& n = nodes_[parent];
        const auto lane = static_cast<int>(parents_[node] % block_size);
        if (!fit_lane(n, lane)) return;
        node = parent;
    }
}

// Down to the node with an empty lane, or to the leaf, that grows least: which then shares a new node with the box.
void QueryTree::place_leaf(const BroadBox& box) {
    if (nodes_.empty()) add_node(no_parent);
    uint32_t node = 0;
    for (int depth = 0;; ++depth) {
        Node& n = nodes_[node];
        int best = -1;
        float least = infinity;
        for (int k = 0; k < block_size; ++k) {
            if (is_empty(n.box, k)) {
                set(n, k, box.lower, box.upper, ~static_cast<int32_t>(box.index));
                put(node, k, box.index);
                return fit_parents(node);
            }
            const BroadBox old = box_in(n.box, k, 0);
            BroadBox both = old;
            include_extent(both.lower, both.upper, box.lower, box.upper);
            const float growth = half_area(both.lower, both.upper) - half_area(old.lower, old.upper);
            if (!(growth >= least)) best = k, least = growth;
        }
        if (best < 0) best = 0;  // sizes beyond what can be told apart
        const int32_t child = n.child[best];
        if (child >= 0) {
            node = static_cast<uint32_t>(child);
            continue;
        }
        if (depth + 2 >= max_depth) {  // deeper than searches have room for
            unbounded_.push_back(box.index);
            places_[box.index] = beside;
            worn_ = true;
            return;
        }
        const BroadBox old = box_in(n.box, best, 0);
        const uint32_t fresh = add_node(node * block_size + static_cast<uint32_t>(best));
        nodes_[node].child[best] = static_cast<int32_t>(fresh);
        set(nodes_[fresh], 0, old.lower, old.upper, child);
        put(fresh, 0, static_cast<uint32_t>(~child));
        node = fresh;
    }
}

void QueryTree::insert(const BroadBox& box) {
    if (places_.size() <= box.index) places_.resize(box.index + 1u, no_box);
    ++count_, ++changes_;
    if (bounded(box)) return place_leaf(box);
    unbounded_.push_back(box.index);
    places_[box.index] = beside;
}

void QueryTree::remove(uint32_t index) {
    const uint32_t place = places_[index];
    places_[index] = no_box;
    --count_, ++changes_;
    if (place == beside) {
        for (uint32_t& other : unbounded_)
            if (other == index) {
                other = unbounded_.back();
                return unbounded_.pop_back();
            }
    }
    const uint32_t node = place / block_size;
    const auto lane = static_cast<int>(place % block_size);
    clear_lane(nodes_[node].box, lane);
    nodes_[node].child[lane] = -1;
    fit_parents(node);
}

void QueryTree::move(const BroadBox& box) {
    const uint32_t place = places_[box.index];
    if (place == beside || !bounded(box)) {
        remove(box.index);
        return insert(box);
    }
    ++changes_;
    set_lane(nodes_[place / block_size].box, static_cast<int>(place % block_size), box.lower, box.upper);
    fit_parents(place / block_size);
}

}  // namespace lendulet
