// Sort-and-sweep on one axis (thesis 5.1; Baraff 1992): boxes sorted by where they begin on the axis along which their
// centres scatter most; each is tested against those that begin before it ends. Fast for hundreds of boxes and for long
// scenes; time grows as N^(5/3) for boxes spread over a cube.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"

namespace lendulet {

class Sweep1 {
public:
    explicit Sweep1(const Memory* memory)
        : fixed_(memory),
          moving_(memory),
          fixed_boxes_(memory),
          moving_boxes_(memory),
          keys_(memory),
          keys_swap_(memory),
          chunks_(memory),
          changes_(memory) {}

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

    int moving_count() const { return moving_boxes_.count(); }
    BroadBox moving_box(int place) const { return moving_boxes_[place]; }

private:
    // Boxes in the order in which they begin on the axis; coordinates in arrays of their own, the sweep's axis first.
    struct Sorted {
        Array<float> lower[3], upper[3];
        Array<uint32_t> index;
        int axis = 0;
        explicit Sorted(const Memory* memory);
        int count() const { return index.count(); }
        void coordinates(int i, float box_lower[3], float box_upper[3]) const;  // in the order x, y, z
        int first_at_or_after(float x) const;
        int first_after(float x) const;
        size_t bytes() const;
    };
    void sort_into(Sorted& set, const BroadBox* boxes, int count);
    template <class Query>
    void offer_all(Query& query) const;
    static void sweep_from(const Sorted& from, int i, const Sorted& over, int first, PairList& out);

    Sorted fixed_, moving_;
    Array<BroadBox> fixed_boxes_, moving_boxes_;
    int axis_ = 0;
    Array<uint64_t> keys_, keys_swap_;
    PairChunks chunks_;
    PairChanges changes_;
};

template <class Visit>
void Sweep1::visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
    for (const Sorted* set : {&moving_, &fixed_}) {
        int end = set->first_after(upper[set->axis]);
        for (int i = 0; i < end; ++i) {
            BroadBox box;
            set->coordinates(i, box.lower, box.upper);
            if (overlap(box, lower, upper)) visit(set->index[i]);
        }
    }
}

}  // namespace lendulet
