// The R-tree of Guttman 1984 with eight entries to a node, whose boxes come and go one by one. One node store, one
// insertion and one removal serve three policies:
//   quadratic  child of least volume growth, quadratic split (Guttman)
//   star       child of least overlap growth above the leaves, split by margins, forced reinsertion (Beckmann et al.)
//   str        bulk-loaded by tiles (Leutenegger et al.); what comes afterwards is inserted as by `quadratic`
//
// A node is one BoxBlock (the bounds of its entries, all tested at once) and its links. Level 0 are the leaves; the
// root is at level 1 at least, so that every leaf has a group above it. Bounds are exact: those of a node in its parent
// are the union of its entries at all times. Nodes that are freed are used again.
//
// Up to 64 boxes, which one group holds, are packed into leaves in their order: comparing them all takes less time than
// any choice of leaves.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/all_pairs_scan.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/rtree/omt.h"
#include "broad_phase/rtree/search.h"
#include "broad_phase/rtree/split.h"

namespace lendulet {

enum class RtreePolicy { quadratic, star, str };

class RTree {
public:
    RTree(const Memory* memory, RtreePolicy policy);

    void build(const BroadBox* boxes, int count, TaskPool* tasks);
    void set(const BroadBox* boxes, int count, TaskPool* tasks) { build(boxes, count, tasks); }
    void change(const BoxChanges& changes, TaskPool& tasks);

    int count() const { return count_; }
    BroadBox box(int place) const;
    void prepare_look_up() {}

    // The tree as search.h sees it.
    using Ref = uint32_t;
    static constexpr int max_levels = 32;  // at least three entries to a node: 3^21 > 2^31 boxes
    static constexpr int most_pending = max_levels * block_size;
    bool empty() const { return nodes_[root_].count == 0; }
    Ref root() const { return root_; }
    bool is_leaf(Ref node) const { return nodes_[node].level == 0; }
    const BoxBlock& block(Ref node) const { return blocks_[node]; }
    Ref child(Ref node, int k) const { return links_[node].child[k]; }
    uint32_t lanes(Ref node) const { return (1u << nodes_[node].count) - 1; }
    const uint32_t* indices(Ref node) const { return links_[node].index; }
    const Array<BroadBox>& unbounded() const { return unbounded_; }

    // The groups (nodes of level 1), in the order of the tree.
    void list_groups();
    int group_count() const { return groups_.count(); }
    Ref group(int i) const { return groups_[i]; }
    WideBox bounds_of(Ref group) const;
    // visit(group) for every group (after the one given) whose bounds overlap the finite box.
    template <class Visit>
    void visit_groups(const WideBox& box, Visit&& visit) const {
        if (!empty()) visit_groups_below(root_, box, visit);
    }
    template <class Visit>
    void visit_later_groups(Ref group, const WideBox& box, Visit&& visit) const;

    // The boxes of a tree that is only a few leaves side by side, of which no more is known than of any set; of no
    // boxes where it is not.
    ScannedBoxes leaves() const;
    bool is_few() const { return packed_ || empty(); }

    size_t bytes() const;
    const char* check() const;  // as BroadPhase::check
    int levels() const { return nodes_[root_].level + 1; }

private:
    struct alignas(64) Links {
        uint32_t child[block_size];  // nodes; in a leaf places in the caller's array
        uint32_t index[block_size];  // in a leaf: the caller's
    };
    struct Node {
        uint32_t parent;  // no_box: the root, or free
        uint16_t level, count;
    };

    template <class Visit>
    void visit_groups_below(Ref node, const WideBox& box, Visit&& visit) const;
    int lane_of(Ref parent, Ref node) const;

    Ref new_node(int level);
    void clear();
    void pack(const BroadBox* boxes, int count);
    void pack_tiles(const BroadBox* boxes, int count);
    void put_at_end(Ref node, const RtreeEntry& entry);
    RtreeEntry entry_of(Ref node) const;
    RtreeEntry entry_at(Ref node, int lane) const;

    void insert_box(const BroadBox& box, uint32_t place);
    void insert(const RtreeEntry& entry, int level);
    Ref choose_node(const RtreeEntry& entry, int level);
    void overflow(Ref node, const RtreeEntry& entry);
    void split(Ref node, const RtreeEntry entries[split_count]);
    void reinsert_farthest(Ref node, RtreeEntry entries[split_count]);
    void tighten(Ref node);

    void remove_box(uint32_t place);
    void remove_lane(Ref node, int lane);
    void condense(Ref node);
    void change_box(const BroadBox& box, uint32_t place);

    RtreePolicy policy_;
    int count_ = 0;
    bool packed_ = false;  // its leaves follow the root and are full but for the last
    int64_t changed_ = 0;  // boxes since the tree was built
    Ref root_ = 0;
    uint32_t reinserted_levels_ = 0;  // a bit for each level that reinserted during the present insertion
    Array<BoxBlock> blocks_;
    Array<Links> links_;
    Array<Node> nodes_;
    Array<uint32_t> free_, groups_;
    Array<uint32_t> leaf_;  // of each place; of an unbounded box its place in that list, with the highest bit set
    Array<BroadBox> unbounded_;
    Array<uint32_t> unbounded_place_;
    Array<RtreeEntry> entries_;       // while bulk loading: those of a level
    Array<RtreeEntry> next_entries_;  // and of the next
    Array<BoxCentre> centres_;
    Array<RtreeEntry> orphans_;      // entries of nodes dissolved by a removal
    Array<uint32_t> orphan_levels_;  // and where they belong
};

template <class Visit>
void RTree::visit_groups_below(Ref node, const WideBox& box, Visit&& visit) const {
    Ref stack[most_pending];
    stack[0] = node;
    for (int top = 1; top > 0;) {
        Ref next = stack[--top];
        if (nodes_[next].level == 1) {
            visit(next);
            continue;
        }
        uint32_t hits = overlaps(blocks_[next], box);
        while (hits) stack[top++] = links_[next].child[take_bit(hits)];
    }
}

template <class Visit>
void RTree::visit_later_groups(Ref group, const WideBox& box, Visit&& visit) const {
    for (Ref node = group; node != root_; node = nodes_[node].parent) {
        Ref parent = nodes_[node].parent;
        uint32_t hits = overlaps(blocks_[parent], box) & (~0u << (lane_of(parent, node) + 1));
        while (hits) visit_groups_below(links_[parent].child[take_bit(hits)], box, visit);
    }
}

}  // namespace lendulet
