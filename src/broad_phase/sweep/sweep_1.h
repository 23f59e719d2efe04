// Sort-and-sweep on one axis (thesis 5.1; Baraff 1992): boxes sorted by where they begin on the axis along which their
// centres scatter most; each is tested against those that begin before it ends. Fast for hundreds of boxes and for long
// scenes; time grows as N^(5/3) for boxes spread over a cube.
//
// Only beginnings are sorted: the list of the thesis, with ends among the beginnings, gives the same pairs but needs a
// set of open intervals that is walked for every beginning; here what would be in it is the next stretch of the sorted
// boxes, whose other coordinates stand side by side and are tested four at once. The order is kept between frames and
// repaired. Fixed boxes are a sorted list of their own; two lists are swept against each other from both sides, and in
// the same way changed boxes find their pairs alone. Queries go through the list in runs of 32 boxes, each with the
// farthest end of its boxes, so that runs that end too early are passed over.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/query.h"
#include "broad_phase/sweep/interval_order.h"

namespace lendulet {

// Boxes in the order in which they begin on an axis; coordinates in arrays of their own, the axis first.
struct SweepList {
    static constexpr int run = 32;
    Array<float> lower[3], upper[3];
    Array<float> reach;  // of each run: the farthest end on the axis
    Array<uint32_t> index;
    IntervalOrder order;
    int axis = 0;

    explicit SweepList(const Memory* memory);
    void assign(const BroadBox* boxes, int count, int along);
    int count() const { return index.count(); }
    int first_at_or_after(float x) const;
    int first_after(float x) const;
    // Column of coordinate d = 0, 1, 2 for x, y, z.
    int column(int d) const { return (d + 3 - axis) % 3; }
    template <class Visit>
    void visit_overlapping(const float low[3], const float high[3], Visit&& visit) const;
    template <class Query>
    void offer_to(Query& query) const;
    void append_boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;
};

class Sweep1 {
public:
    explicit Sweep1(const Memory* memory)
        : fixed_(memory),
          moving_(memory),
          asked_(memory),
          fixed_boxes_(memory),
          moving_boxes_(memory),
          chunks_(memory),
          changes_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
        moving_.visit_overlapping(lower, upper, visit);
        fixed_.visit_overlapping(lower, upper, visit);
    }
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    // What PairChanges asks for.
    int moving_count() const { return moving_boxes_.count(); }
    BroadBox moving_box(int place) const { return moving_boxes_[place]; }
    void find_pairs_of(TaskPool& tasks, const BroadBox* boxes, int count, Array<BoxPair>& out);

    // For tests.
    int axis() const { return axis_; }

private:
    void sweep_lists(TaskPool& tasks, const SweepList& a, const SweepList& b, Array<BoxPair>& out);

    SweepList fixed_, moving_, asked_;
    Array<BroadBox> fixed_boxes_, moving_boxes_;
    int axis_ = 0;
    PairChunks chunks_;
    PairChanges changes_;
};

template <class Visit>
void SweepList::visit_overlapping(const float low[3], const float high[3], Visit&& visit) const {
    const float mine_low[3] = {low[axis], low[(axis + 1) % 3], low[(axis + 2) % 3]};
    const float mine_high[3] = {high[axis], high[(axis + 1) % 3], high[(axis + 2) % 3]};
    const WideBox box = spread(mine_low, mine_high);
    int end = first_after(high[axis]);
    for (int begin = 0; begin < end; begin += run) {
        if (reach[begin / run] < low[axis]) continue;
        int stop = begin + run < end ? begin + run : end;
        for (int i = begin; i < stop; i += 4) {
            auto hit = load_wide<Float4>(upper[0].data() + i) >= box.lower[0];
            for (int d = 1; d < 3; ++d) {
                hit &= load_wide<Float4>(lower[d].data() + i) <= box.upper[d];
                hit &= load_wide<Float4>(upper[d].data() + i) >= box.lower[d];
            }
            uint32_t hits = mask_bits(hit);
            if (stop - i < 4) hits &= (1u << (stop - i)) - 1;
            while (hits) visit(index[i + take_bit(hits)]);
        }
    }
}

}  // namespace lendulet
