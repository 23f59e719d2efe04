#include "broad_phase/rtree/rtree.h"

#include "broad_phase/rtree/leaf.h"
#include "broad_phase/rtree/str.h"

namespace lendulet {

namespace {

constexpr int few_boxes = block_size * block_size;  // what one group holds is packed as it comes
// A tree that is changed box by box may end up with more overlap than one that is built, so it is built anew after this
// many changes for each box. Reinsertion keeps an R*-tree good by itself; what tiles do better than insertion is lost
// soonest.
constexpr int changes_before_rebuild(RtreePolicy policy) {
    return policy == RtreePolicy::star ? 8 : policy == RtreePolicy::quadratic ? 2 : 1;
}
constexpr uint32_t unbounded_bit = 1u << 31;
constexpr int reinserted_count = 3;  // of nine entries: 30 %, as Beckmann et al. found best

RtreeEntry entry_for(const BroadBox& box, uint32_t place) {
    return {{box.lower[0], box.lower[1], box.lower[2]}, {box.upper[0], box.upper[1], box.upper[2]}, place, box.index};
}

void enlarge_lane(BoxBlock& block, int lane, const RtreeEntry& entry) {
    for (int d = 0; d < 3; ++d) {
        block.lower[d][lane] = minimum(entry.lower[d], block.lower[d][lane]);
        block.upper[d][lane] = maximum(entry.upper[d], block.upper[d][lane]);
    }
}

bool lane_holds(const BoxBlock& block, int lane, const BroadBox& box) {
    bool yes = true;
    for (int d = 0; d < 3; ++d) {
        yes &= block.lower[d][lane] <= box.lower[d] && block.upper[d][lane] >= box.upper[d];
    }
    return yes;
}

}  // namespace

RTree::RTree(const Memory* memory, RtreePolicy policy)
    : policy_(policy),
      blocks_(memory),
      links_(memory),
      nodes_(memory),
      free_(memory),
      groups_(memory),
      leaf_(memory),
      unbounded_(memory),
      unbounded_place_(memory),
      entries_(memory),
      next_entries_(memory),
      centres_(memory),
      orphans_(memory),
      orphan_levels_(memory) {
    clear();
}

// ---------------------------------------------------------------------------------------------------------------------
// Nodes

RTree::Ref RTree::new_node(int level) {
    Ref node;
    if (free_.empty()) {
        node = static_cast<Ref>(nodes_.size());
        blocks_.resize_unset(node + 1);
        links_.resize_unset(node + 1);
        nodes_.resize_unset(node + 1);
    } else {
        node = free_.back();
        free_.pop_back();
    }
    clear_lanes(blocks_[node]);
    nodes_[node] = {no_box, static_cast<uint16_t>(level), 0};
    return node;
}

void RTree::clear() {
    blocks_.clear();
    links_.clear();
    nodes_.clear();
    free_.clear();
    groups_.clear();
    leaf_.clear();
    unbounded_.clear();
    unbounded_place_.clear();
    count_ = 0;
    root_ = new_node(1);
}

int RTree::lane_of(Ref parent, Ref node) const {
    int lane = 0;
    while (links_[parent].child[lane] != node) ++lane;
    return lane;
}

void RTree::put_at_end(Ref node, const RtreeEntry& entry) {
    int lane = nodes_[node].count++;
    set_lane(blocks_[node], lane, entry.lower, entry.upper);
    links_[node].child[lane] = entry.child;
    links_[node].index[lane] = entry.index;
    if (nodes_[node].level > 0) nodes_[entry.child].parent = node;
    else leaf_[entry.child] = node;
}

RtreeEntry RTree::entry_of(Ref node) const {
    RtreeEntry entry;
    block_bounds(blocks_[node], entry.lower, entry.upper);
    entry.child = node;
    entry.index = no_box;
    return entry;
}

RtreeEntry RTree::entry_at(Ref node, int lane) const {
    return entry_for(box_in(blocks_[node], lane, links_[node].index[lane]), links_[node].child[lane]);
}

// Recomputes the bounds of a node whose entries have become fewer or smaller, and of those above it.
void RTree::tighten(Ref node) {
    for (; node != root_; node = nodes_[node].parent) {
        Ref parent = nodes_[node].parent;
        int lane = lane_of(parent, node);
        float lower[3], upper[3];
        block_bounds(blocks_[node], lower, upper);
        bool same = true;
        for (int d = 0; d < 3; ++d) {
            same &= blocks_[parent].lower[d][lane] == lower[d] && blocks_[parent].upper[d][lane] == upper[d];
        }
        if (same) return;
        set_lane(blocks_[parent], lane, lower, upper);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Building

void RTree::build(const BroadBox* boxes, int count, TaskPool*) {
    clear();
    count_ = count;
    changed_ = 0;
    // Room for nodes that are as empty as may be, so that no later build of as many boxes needs more.
    size_t n = static_cast<size_t>(count), most_nodes = n / 2 + 8;
    blocks_.reserve(most_nodes);
    links_.reserve(most_nodes);
    nodes_.reserve(most_nodes);
    leaf_.resize_unset(n);
    packed_ = count <= few_boxes;
    if (packed_) {
        pack(boxes, count);
    } else if (policy_ == RtreePolicy::str) {
        pack_tiles(boxes, count);
    } else {
        for (int i = 0; i < count; ++i) insert_box(boxes[i], static_cast<uint32_t>(i));
    }
}

// A few boxes: leaves in the caller's order under the root.
void RTree::pack(const BroadBox* boxes, int count) {
    uint32_t places[few_boxes];  // of the bounded ones
    int bounded_count = 0;
    for (int i = 0; i < count; ++i) {
        const uint32_t place = static_cast<uint32_t>(i);
        if (bounded(boxes[i])) places[bounded_count++] = place;
        else insert_box(boxes[i], place);
    }
    for (int first = 0, lane = 0; first < bounded_count; first += block_size, ++lane) {
        const int left = bounded_count - first, n = left < block_size ? left : block_size;
        const Ref leaf = new_node(0);
        Links &links = links_[leaf], &above = links_[root_];
        for (int k = 0; k < block_size; ++k) links.child[k] = k < n ? places[first + k] : no_box;
        const LeafBounds bounds = fill_leaf(blocks_[leaf], links.index, boxes, links.child);
        for (int k = 0; k < n; ++k) leaf_[links.child[k]] = leaf;
        for (int d = 0; d < 3; ++d) {
            blocks_[root_].lower[d][lane] = bounds.lower[d];
            blocks_[root_].upper[d][lane] = bounds.upper[d];
        }
        above.child[lane] = leaf;
        above.index[lane] = no_box;
        nodes_[leaf] = {root_, 0, static_cast<uint16_t>(n)};
        nodes_[root_].count = static_cast<uint16_t>(lane + 1);
    }
}

void RTree::pack_tiles(const BroadBox* boxes, int count) {
    entries_.clear();
    for (int i = 0; i < count; ++i) {
        if (bounded(boxes[i])) entries_.push_back(entry_for(boxes[i], static_cast<uint32_t>(i)));
        else insert_box(boxes[i], static_cast<uint32_t>(i));
    }
    int level = 0;
    for (; level == 0 || entries_.count() > block_size; ++level) {
        centres_.resize_unset(entries_.size());
        for (size_t i = 0; i < entries_.size(); ++i) {
            const RtreeEntry& e = entries_[i];
            for (int d = 0; d < 3; ++d) centres_[i].at[d] = ordered(0.5f * e.lower[d] + 0.5f * e.upper[d]);
            centres_[i].slot = static_cast<uint32_t>(i);
        }
        str_tile(centres_.data(), centres_.count());
        next_entries_.clear();
        Ref node = no_box;
        for (int i = 0; i < centres_.count(); ++i) {
            if (i % block_size == 0) node = new_node(level);
            put_at_end(node, entries_[centres_[i].slot]);
            if (i % block_size == block_size - 1 || i == centres_.count() - 1) next_entries_.push_back(entry_of(node));
        }
        entries_.swap(next_entries_);
    }
    nodes_[root_].level = static_cast<uint16_t>(level);
    for (const RtreeEntry& e : entries_) put_at_end(root_, e);
}

// ---------------------------------------------------------------------------------------------------------------------
// Insertion

void RTree::insert_box(const BroadBox& box, uint32_t place) {
    if (!bounded(box)) {
        leaf_[place] = unbounded_bit | static_cast<uint32_t>(unbounded_.size());
        unbounded_.push_back(box);
        unbounded_place_.push_back(place);
        return;
    }
    reinserted_levels_ = 0;
    insert(entry_for(box, place), 0);
}

// Puts an entry into some node of a level.
void RTree::insert(const RtreeEntry& entry, int level) {
    Ref node = choose_node(entry, level);
    if (nodes_[node].count < block_size) put_at_end(node, entry);
    else overflow(node, entry);
}

// Goes down from the root, making room in the bounds on the way.
RTree::Ref RTree::choose_node(const RtreeEntry& entry, int level) {
    Ref node = root_;
    if (empty())
        put_at_end(node, {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, new_node(0), no_box});
    while (nodes_[node].level > level) {
        BoxBlock& block = blocks_[node];
        int count = nodes_[node].count;
        bool star = policy_ == RtreePolicy::star && nodes_[node].level == 1;
        int lane = star ? choose_least_overlap(block, count, entry.lower, entry.upper)
                        : choose_least_growth(block, count, entry.lower, entry.upper);
        enlarge_lane(block, lane, entry);
        node = links_[node].child[lane];
    }
    return node;
}

// One entry too many for a node.
void RTree::overflow(Ref node, const RtreeEntry& entry) {
    RtreeEntry entries[split_count];
    for (int k = 0; k < block_size; ++k) entries[k] = entry_at(node, k);
    entries[block_size] = entry;
    if (policy_ == RtreePolicy::star) {
        uint32_t level_bit = 1u << nodes_[node].level;
        if (node != root_ && !(reinserted_levels_ & level_bit)) {
            reinserted_levels_ |= level_bit;
            return reinsert_farthest(node, entries);
        }
    }
    split(node, entries);
}

void RTree::split(Ref node, const RtreeEntry entries[split_count]) {
    uint32_t in_second = policy_ == RtreePolicy::star ? split_star(entries) : split_quadratic(entries);
    int level = nodes_[node].level;
    Ref sibling = new_node(level);
    nodes_[node].count = 0;
    for (int k = 0; k < block_size; ++k) clear_lane(blocks_[node], k);
    for (int i = 0; i < split_count; ++i) put_at_end(in_second >> i & 1 ? sibling : node, entries[i]);
    if (node == root_) {
        root_ = new_node(level + 1);
        put_at_end(root_, entry_of(node));
        put_at_end(root_, entry_of(sibling));
        return;
    }
    Ref parent = nodes_[node].parent;
    const RtreeEntry kept = entry_of(node), split_off = entry_of(sibling);
    set_lane(blocks_[parent], lane_of(parent, node), kept.lower, kept.upper);
    if (nodes_[parent].count < block_size) put_at_end(parent, split_off);
    else overflow(parent, split_off);
}

// The entries whose centres are farthest from the centre of all are taken out and inserted anew, the nearest of them
// first ("close reinsert").
void RTree::reinsert_farthest(Ref node, RtreeEntry entries[split_count]) {
    float centre[3], distance[split_count];
    for (int d = 0; d < 3; ++d) {
        float lower = infinity, upper = -infinity;
        for (int i = 0; i < split_count; ++i) {
            lower = minimum(entries[i].lower[d], lower);
            upper = maximum(entries[i].upper[d], upper);
        }
        centre[d] = 0.5f * lower + 0.5f * upper;
    }
    RtreeEntry sorted[split_count];
    for (int i = 0; i < split_count; ++i) {
        float squared = 0;
        for (int d = 0; d < 3; ++d) {
            float gap = (0.5f * entries[i].lower[d] + 0.5f * entries[i].upper[d]) - centre[d];
            squared += gap * gap;
        }
        int at = i;
        for (; at > 0 && distance[at - 1] > squared; --at) distance[at] = distance[at - 1], sorted[at] = sorted[at - 1];
        distance[at] = squared;
        sorted[at] = entries[i];
    }
    nodes_[node].count = 0;
    for (int k = 0; k < block_size; ++k) clear_lane(blocks_[node], k);
    int level = nodes_[node].level, kept = split_count - reinserted_count;
    for (int i = 0; i < kept; ++i) put_at_end(node, sorted[i]);
    tighten(node);
    for (int i = kept; i < split_count; ++i) insert(sorted[i], level);
}

// ---------------------------------------------------------------------------------------------------------------------
// Removal and change

void RTree::remove_box(uint32_t place) {
    uint32_t leaf = leaf_[place];
    if (leaf & unbounded_bit) {
        uint32_t hole = leaf & ~unbounded_bit;
        unbounded_[hole] = unbounded_.back();
        unbounded_place_[hole] = unbounded_place_.back();
        leaf_[unbounded_place_[hole]] = leaf;
        unbounded_.pop_back();
        unbounded_place_.pop_back();
        return;
    }
    remove_lane(leaf, lane_of(leaf, place));
    condense(leaf);
}

void RTree::remove_lane(Ref node, int lane) {
    int last = --nodes_[node].count;
    const RtreeEntry moved = entry_at(node, last);
    set_lane(blocks_[node], lane, moved.lower, moved.upper);
    links_[node].child[lane] = moved.child;
    links_[node].index[lane] = moved.index;
    clear_lane(blocks_[node], last);
}

// Guttman's CondenseTree: nodes on the way up that hold too little are dissolved and what they held is inserted anew at
// its level; a root with one child gives way to it.
void RTree::condense(Ref node) {
    orphans_.clear();
    orphan_levels_.clear();
    while (node != root_ && nodes_[node].count < least_entries) {
        for (int k = 0; k < nodes_[node].count; ++k) {
            orphans_.push_back(entry_at(node, k));
            orphan_levels_.push_back(nodes_[node].level);
        }
        Ref parent = nodes_[node].parent;
        remove_lane(parent, lane_of(parent, node));
        nodes_[node].parent = no_box;
        free_.push_back(node);
        node = parent;
    }
    tighten(node);
    reinserted_levels_ = 0;
    for (size_t i = orphans_.size(); i-- > 0;) insert(orphans_[i], static_cast<int>(orphan_levels_[i]));
    while (nodes_[root_].level > 1 && nodes_[root_].count == 1) {
        free_.push_back(root_);
        root_ = links_[root_].child[0];
        nodes_[root_].parent = no_box;
    }
}

// A box that stays inside the bounds of its leaf stays there; the others leave and enter anew.
void RTree::change_box(const BroadBox& box, uint32_t place) {
    uint32_t leaf = leaf_[place];
    if (!(leaf & unbounded_bit)) {
        Ref parent = nodes_[leaf].parent;
        if (lane_holds(blocks_[parent], lane_of(parent, leaf), box)) {
            int lane = lane_of(leaf, place);
            set_lane(blocks_[leaf], lane, box.lower, box.upper);
            links_[leaf].index[lane] = box.index;
            return tighten(leaf);
        }
    }
    remove_box(place);
    insert_box(box, place);
}

void RTree::change(const BoxChanges& changes, TaskPool& tasks) {
    int common = count_ < changes.count ? count_ : changes.count, listed = changes.listed_below(common);
    int touched = listed + count_ - common + changes.count - common;
    changed_ += touched;
    if (common <= few_boxes || changed_ > changes_before_rebuild(policy_) * static_cast<int64_t>(common)) {
        return build(changes.boxes, changes.count, &tasks);
    }
    for (int place = count_ - 1; place >= common; --place) remove_box(static_cast<uint32_t>(place));
    leaf_.resize_unset(static_cast<size_t>(changes.count));
    count_ = changes.count;
    for (int i = 0; i < listed; ++i) change_box(changes.boxes[changes.changed[i]], changes.changed[i]);
    for (int place = common; place < count_; ++place) insert_box(changes.boxes[place], static_cast<uint32_t>(place));
}

// ---------------------------------------------------------------------------------------------------------------------

BroadBox RTree::box(int place) const {
    uint32_t leaf = leaf_[place];
    if (leaf & unbounded_bit) return unbounded_[leaf & ~unbounded_bit];
    int lane = lane_of(leaf, static_cast<uint32_t>(place));
    return box_in(blocks_[leaf], lane, links_[leaf].index[lane]);
}

WideBox RTree::bounds_of(Ref group) const {
    float lower[3], upper[3];
    block_bounds(blocks_[group], lower, upper);
    return spread(lower, upper);
}

ScannedBoxes RTree::leaves() const {
    if (empty()) return {nullptr, nullptr, 0};
    constexpr int step = sizeof(Links) / sizeof(uint32_t);
    const Ref first = links_[root_].child[0];
    return {&blocks_[first], links_[first].index, count_ - unbounded_.count(), step};
}

void RTree::list_groups() {
    groups_.clear();
    groups_.reserve(nodes_.size() / least_entries + 1);
    if (empty()) return;
    Ref stack[most_pending];
    stack[0] = root_;
    for (int top = 1; top > 0;) {
        Ref node = stack[--top];
        if (nodes_[node].level == 1) groups_.push_back(node);
        else
            for (int k = nodes_[node].count; k-- > 0;) stack[top++] = links_[node].child[k];
    }
}

size_t RTree::bytes() const {
    return blocks_.bytes() + links_.bytes() + nodes_.bytes() + free_.bytes() + groups_.bytes() + leaf_.bytes() +
           unbounded_.bytes() + unbounded_place_.bytes() + entries_.bytes() + next_entries_.bytes() + centres_.bytes() +
           orphans_.bytes() + orphan_levels_.bytes();
}

const char* RTree::check() const {
    size_t reached = 0;
    int held = unbounded_.count();
    Ref stack[most_pending];
    stack[0] = root_;
    for (int top = 1; top > 0;) {
        Ref node = stack[--top];
        ++reached;
        if (nodes_[node].count > block_size || (nodes_[node].count == 0 && node != root_)) return "a node is empty";
        for (int k = 0; k < block_size; ++k) {
            if (k >= nodes_[node].count) {
                if (!(blocks_[node].lower[0][k] > blocks_[node].upper[0][k])) return "a lane without an entry is set";
                continue;
            }
            uint32_t child = links_[node].child[k];
            if (nodes_[node].level == 0) {
                ++held;
                if (leaf_[child] != node) return "a box is not where it is looked up";
                continue;
            }
            if (nodes_[child].parent != node) return "a node does not know its parent";
            if (nodes_[child].level + 1 != nodes_[node].level) return "leaves are not all at the same depth";
            const RtreeEntry is = entry_of(child), was = entry_at(node, k);
            for (int d = 0; d < 3; ++d) {
                if (is.lower[d] != was.lower[d] || is.upper[d] != was.upper[d]) {
                    return "a node's bounds are not those of its entries";
                }
            }
            stack[top++] = child;
        }
    }
    if (held != count_) return "the tree does not hold all boxes";
    return reached + free_.size() == nodes_.size() ? "" : "nodes are lost";
}

}  // namespace lendulet
