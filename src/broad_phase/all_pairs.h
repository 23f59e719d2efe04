// The broad phase that tests every box against every other: the reference for all others, and the fastest for a handful
// of boxes. Time grows with the square of the count.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/box_set.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

class AllPairs {
public:
    explicit AllPairs(const Memory* memory) : fixed_(memory), moving_(memory), chunks_(memory), changes_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const;
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    int moving_count() const { return moving_.count(); }
    BroadBox moving_box(int place) const { return moving_.box(place); }

private:
    BoxSet fixed_, moving_;
    PairChunks chunks_;
    PairChanges changes_;
};

template <class Visit>
void AllPairs::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    const WideBox box = spread(lower, upper);
    moving_.visit_overlapping(box, visit);
    fixed_.visit_overlapping(box, visit);
}

}  // namespace lendulet
