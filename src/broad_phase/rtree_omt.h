// The broad phase of two R-trees, one for the boxes that move and one for those that do not (thesis 5.2, 5.3). The tree
// of the moving boxes keeps its shape while that stays good: then a step only recomputes bounds.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/box_tree.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

class RtreeOmt {
public:
    explicit RtreeOmt(const Memory* memory);

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const;
    uint32_t ray(const float origin[3], const float translation[3], float max_t, float& t) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;

    // Bulk loads of the moving set so far, for tests and statistics.
    int builds() const { return builds_; }

private:
    void pairs_of_unbounded(Array<BoxPair>& out) const;

    BoxTree fixed_, moving_;
    int refits_ = 0, builds_ = 0;
    PairChunks chunks_;
};

}  // namespace lendulet
