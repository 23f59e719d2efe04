// The interface of all broad phases: boxes with an index go in; overlapping pairs and answers to box, ray, cast and
// nearest queries come out. Knows nothing of shapes and bodies.
//
// Two sets of boxes are kept apart: those that move and those that do not. Pairs are moving-moving and moving-fixed,
// never fixed-fixed. A box has a place in the caller's array and carries the caller's index, which no other box of
// either set has. Sides may be infinite. Boxes with a NaN or with lower > upper must not come here: the world refuses
// them at its door.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"
#include "broad_phase/structures.h"
#include "lendulet/options.h"

namespace lendulet {

class BroadPhase {
public:
    BroadPhase(BroadPhaseType type, const Memory* memory);

    // Takes over the boxes of one set in place of those it had; the caller may overwrite his array afterwards. A box
    // keeps its place in the array from call to call where it can: that is how a structure knows it again. `tasks`, if
    // given, share the work; they never change a result.
    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);

    // As set_moving, where most boxes are near where that of the same place was: a structure may then keep its order
    // instead of finding it anew. Nothing that is found depends on which of the two was called.
    void move_all(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);

    // Appends every overlapping pair of the moving set with itself and with the fixed set, each once; the order depends
    // on the boxes alone (those of now and, for structures that learn, those before), never on the number of workers.
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);

    // Brings the moving set from its last state to boxes[0, count). `changed` lists, in rising order, the places below
    // `count` whose box (bounds or index) differs from the last state; places from the old count on are new and need
    // not be listed, places from `count` on are gone. Appends the pairs that begin and those that end with that, each
    // list sorted by (a, b): what the difference of two find_pairs would give, so a pair whose boxes only changed
    // places is in neither. The fixed set must be what it was at the last find_pairs or update.
    void update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                Array<BoxPair>& begun, Array<BoxPair>& ended);

    // Queries take both sets; all intervals are closed, and of equal hits the smallest index wins. They only read, so
    // several threads may ask at once.

    // Appends the index of every box that overlaps [lower, upper], which may be infinite; in any order.
    void query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const;

    // First box along the segment origin + t * translation, t in [0, max_t]: gives its index and sets `t` to where the
    // segment enters it (0 where it starts inside); no_box, and `t` left alone, where there is none.
    uint32_t ray(const float origin[3], const float translation[3], float max_t, float& t) const;

    // First box met by the finite box [lower, upper] as it moves by t * translation, t in [0, max_t]; as for a ray.
    uint32_t cast_box(const float lower[3], const float upper[3], const float translation[3], float max_t,
                      float& t) const;

    // The box nearest to a point: gives its index and sets `distance` (0 inside); no_box where none is within
    // max_distance, which may be infinite. Nothing is found beyond 1.8e19 m.
    uint32_t nearest(const float point[3], float max_distance, float& distance) const;

    // Batches: the same answers, one for each query in their order, shared out to `tasks`. One batch at a time.
    // Box queries: the hits of query i are appended to `out` and stand in [offsets[i], offsets[i + 1]) of it; `offsets`
    // is replaced and gets count + 1 entries.
    void query_boxes(TaskPool& tasks, const BoxQuery* queries, int count, Array<uint32_t>& offsets,
                     Array<uint32_t>& out);
    void rays(TaskPool& tasks, const RayQuery* queries, int count, BroadPhaseHit* hits) const;
    void cast_boxes(TaskPool& tasks, const CastQuery* queries, int count, BroadPhaseHit* hits) const;
    void nearest_boxes(TaskPool& tasks, const NearestQuery* queries, int count, BroadPhaseHit* hits) const;

    // Appends the boxes of the structure itself with their depth, for pictures and debugging: those given (leaves), and
    // those of nodes where there are any.
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;
    // Verifies the structure's own invariants: empty if all hold, else a sentence about the first that does not.
    const char* check() const;

private:
    BroadPhaseStructure structure_;
    PairChunks query_chunks_;  // hits of a batch of box queries, as (query, index)
    Array<BoxPair> query_hits_;
};

}  // namespace lendulet
