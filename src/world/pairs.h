// Pairs of colliders whose boxes overlap, sorted, with what is kept for each from step to step.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "broad_phase/box.h"
#include "collision/narrow_phase.h"

namespace lendulet {

inline constexpr uint32_t no_cache = ~0u;

struct ColliderPair {
    uint32_t a, b;             // collider slots, a < b
    uint32_t cache;            // index into PairTable::caches; no_cache: a collider was removed since the step
    uint32_t first_record;     // of this pair in the step's records; room for `capacity`
    uint16_t capacity, count;  // manifolds: room, and those found
};

// The sorted list makes everything downstream independent of the broad phase's own order.
struct PairTable {
    Array<ColliderPair> now, before;
    Array<PairCache> caches;
    Array<uint32_t> free_caches;

    explicit PairTable(const Memory* memory)
        : now(memory), before(memory), caches(memory), free_caches(memory), scratch_(memory), counts_(memory) {}

    // Replaces `now` by `boxes` (which it sorts) and carries caches and records of pairs that go on over from the list
    // before, which moves to `before`.
    void update(Array<BoxPair>& boxes);
    // Marks pairs with a collider that is removed, so that the next owner of its slot does not inherit them.
    void remove_collider(uint32_t slot);

private:
    void sort(Array<BoxPair>& boxes);
    Array<BoxPair> scratch_;
    Array<uint32_t> counts_;
};

}  // namespace lendulet
