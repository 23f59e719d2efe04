// Sort-and-sweep on all three axes (thesis 5.1): every axis is swept, and the pairs whose intervals overlap on all
// three are kept.
//
// Done literally, each axis lists its pairs (N^(5/3) of them for boxes spread over a cube) and the lists are
// intersected; almost all of that time goes to pairs that another axis refutes. Here the set of boxes whose interval
// overlaps that of a given one is a row of bits. Walking an axis, the boxes begun so far and those ended so far are two
// such rows: what overlaps box i has begun where i ends, and has not ended where i begins. So an axis costs two "and"s
// per row, of as many words as there are boxes by 64, and a pair costs nothing until it is known to be one. Bits are
// kept for 512 boxes at a time (columns), so that the rows of ten thousand boxes stay in the nearest caches.
//
// Time grows with the square of the number of boxes, at about a hundredth of what comparing all pairs takes; the six
// orders are kept between frames and repaired. One thread does it all: this is a structure to compare with.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/box_set.h"
#include "broad_phase/pair_changes.h"
#include "broad_phase/sweep/interval_order.h"

namespace lendulet {

class Sweep3 {
public:
    explicit Sweep3(const Memory* memory);

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);
    template <class Visit>
    void visit_overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
        const WideBox box = spread(lower, upper);
        moving_.boxes.visit_overlapping(box, visit);
        fixed_.boxes.visit_overlapping(box, visit);
    }
    void cast(BoxCast& cast) const;
    void nearest(NearestBox& nearest) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    const char* check() const;

    // What PairChanges asks for.
    int moving_count() const { return moving_.boxes.count(); }
    BroadBox moving_box(int place) const { return moving_.boxes.box(place); }

private:
    static constexpr int tile = 512;
    // The bits of one row in a tile of columns.
    struct alignas(64) Row {
        uint64_t bits[tile / 64];
    };
    // A side of a box on an axis, as an integer of the same order, and the column of the box in its tile.
    struct Side {
        uint32_t at, column;
    };
    struct Set {
        BoxSet boxes;
        IntervalOrder begins[3], ends[3];
        explicit Set(const Memory* memory);
        void assign(const BroadBox* from, int count);
        size_t bytes() const;
        const char* check() const;
    };

    void pairs_with(const Set& columns, Array<BoxPair>& out);
    static void sort_into_tiles(const IntervalOrder& order, Array<Side>& sides, Array<uint32_t>& filled);
    template <int words>
    void keep_overlapping(int d, const Side* begins, const Side* ends, int count);
    void write_pairs(const Set& columns, int first, int words, Array<BoxPair>& out) const;

    Set fixed_, moving_;
    Array<Row> rows_;         // of the moving boxes by place
    Array<Side> sides_[6];    // begins and ends of the columns on each axis, tile by tile, in order inside a tile
    Array<uint32_t> filled_;  // sides dealt to each tile
    PairChanges changes_;
};

}  // namespace lendulet
