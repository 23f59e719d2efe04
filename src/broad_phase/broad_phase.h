// The interface of all broad phases: boxes with an index go in; overlapping pairs and answers to box and ray queries
// come out. Knows nothing of shapes and bodies.
//
// Two sets of boxes are kept apart: those that move (rebuilt or refitted every step) and those that do not (built when
// their set changes). Pairs are moving-moving and moving-fixed, never fixed-fixed.
#pragma once

#include <cstdint>
#include <variant>

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/all_pairs.h"
#include "broad_phase/box.h"
#include "broad_phase/rtree_omt.h"
#include "broad_phase/sweep.h"
#include "lendulet/options.h"

namespace lendulet {

class BroadPhase {
public:
    BroadPhase(BroadPhaseType type, const Memory* memory);

    // Takes over the boxes of one set; they stay where they are and must stay valid until the next call for that set.
    // A box keeps its place in the array from call to call where it can: that is how a tree knows it again. `tasks`, if
    // given, share the work; they never change the result.
    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);

    // Appends every overlapping pair of the moving set with itself and with the fixed set, each once; the order depends
    // on the boxes alone, never on the number of workers.
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);

    // Appends the index of every box that overlaps [lower, upper], in any order.
    void query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const;

    // First box along the segment origin + t * translation, t in [0, max_t]: gives its index and sets `t` to where the
    // segment enters it (0 where it starts inside), ties to the smallest index; no_box where there is none.
    uint32_t ray(const float origin[3], const float translation[3], float max_t, float& t) const;

    // Appends the boxes of the structure itself with their depth, for pictures and debugging.
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;

private:
    std::variant<AllPairs, Sweep, RtreeOmt> structure_;
};

}  // namespace lendulet
