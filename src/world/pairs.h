// Pairs of colliders whose boxes overlap, sorted, with what is kept for each from step to step.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "broad_phase/box.h"
#include "collision/narrow_phase.h"
#include "world/narrow/kernels.h"

namespace lendulet {

inline constexpr uint32_t no_cache = ~0u;

// Which way a pair is collided.
enum class PairKind : uint8_t {
    unsorted,  // not yet looked at
    boxes,     // two sharp boxes: in batches
    round,     // a closed form, as cheap as finding out whether the bodies have moved
    general,
    trigger,  // whether they overlap is all that is asked
};

struct ColliderPair {
    uint32_t a, b;            // collider slots, a < b
    uint32_t cache;           // index into PairTable::caches; no_cache: a collider was removed since the step
    uint32_t first_record;    // of this pair's own stretch of records, which stays the same while the pair lasts
    uint8_t capacity, count;  // manifolds: room, and those found
    uint8_t prepared;         // records whose lasting parts are filled in
    PairKind kind;
    bool flipped;  // B's body is not moved by constraints: the manifolds' A is B
    bool fixed_a;  // that of A is not
    bool hit;      // of a trigger: overlaps
    bool begun;    // not yet collided
};

// The sorted list makes everything downstream independent of the broad phase's own order.
struct PairTable {
    Array<ColliderPair> now, before;
    Array<uint32_t> begun;  // of `now`: pairs that were not there before; without records until place_records()
    Array<PairCache> caches;
    Array<KeptPose> poses;  // by cache
    Array<uint32_t> free_caches;
    uint32_t record_count = 0;  // all stretches of records, those given back included

    explicit PairTable(const Memory* memory)
        : now(memory),
          before(memory),
          begun(memory),
          caches(memory),
          poses(memory),
          free_caches(memory),
          free_single_(memory),
          free_mesh_(memory),
          scratch_(memory),
          counts_(memory) {}

    // Replaces `now` by `boxes` (which it sorts) and carries what is kept of pairs that go on over from the list
    // before, which moves to `before`.
    void update(Array<BoxPair>& boxes);
    // Gives a pair its stretch of records, for one manifold or for those of a mesh.
    void place_records(ColliderPair& pair, bool mesh);
    // Marks pairs with a collider that is removed, so that the next owner of its slot does not inherit them.
    void remove_collider(uint32_t slot);
    // Forgets all pairs; then a snapshot's are added again, in their order, each with a cache of its own.
    void clear();
    ColliderPair& add(uint32_t a, uint32_t b);

private:
    void sort(Array<BoxPair>& boxes);
    uint32_t take_cache();
    Array<uint32_t> free_single_, free_mesh_;  // first records of stretches given back
    Array<BoxPair> scratch_;
    Array<uint32_t> counts_;
};

}  // namespace lendulet
