// The broad phase of two R-trees, one for the boxes that move and one for those that do not (thesis 5.2, 5.3). Every
// member of the family is this with its kind of tree:
//   rtree-omt        BoxTree: bulk-loaded by Lee and Lee's cuts, refitted while that stays good
//   rtree-str        RTree: bulk-loaded by Leutenegger, Lopez and Edgington's tiles
//   rtree-quadratic  RTree: Guttman's insertion and quadratic split
//   rtree-star       RTree: the R*-tree of Beckmann, Kriegel, Schneider and Seeger
//
// Pairs are found by groups: the nodes above the leaves, of up to 64 boxes. A group is joined with itself, with the
// groups after it that its bounds overlap, and with those of the tree of fixed boxes. Where both trees are no more than
// a few leaves in the order the boxes came in, these are compared as by AllPairs.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/rtree/box_tree.h"
#include "broad_phase/rtree/rtree.h"
#include "broad_phase/rtree/search.h"

namespace lendulet {

template <class Tree>
class TwoTrees {
public:
    // `kind`: what else the trees want to know, the policy of an RTree.
    template <class... Kind>
    explicit TwoTrees(const Memory* memory, Kind... kind)
        : fixed_(memory, kind...), moving_(memory, kind...), chunks_(memory), changes_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
        lendulet::visit_overlapping(moving_, lower, upper, visit);
        lendulet::visit_overlapping(fixed_, lower, upper, visit);
    }
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const { return moving_.bytes() + fixed_.bytes() + chunks_.bytes() + changes_.bytes(); }
    const char* check() const;

    // What PairChanges asks for.
    int moving_count() const { return moving_.count(); }
    BroadBox moving_box(int place) const { return moving_.box(place); }
    void change_moving(const BoxChanges& changes, TaskPool& tasks) { moving_.change(changes, tasks); }

    // For tests and statistics.
    const Tree& moving() const { return moving_; }

private:
    void find_pairs_by_groups(TaskPool& tasks, Array<BoxPair>& out);
    void pairs_of_unbounded(Array<BoxPair>& out) const;

    Tree fixed_, moving_;
    PairChunks chunks_;
    PairChanges changes_;
};

using RtreeOmt = TwoTrees<BoxTree>;

}  // namespace lendulet
