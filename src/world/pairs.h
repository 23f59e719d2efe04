// Pairs of colliders whose boxes overlap, and what is kept of each from step to step.
//
// A pair has a number while it lasts, and everything of it stands at that number. From each collider leads a list of
// its pairs, so that what a body has to do with is found without looking at others. A step goes through the pairs that
// are listed, those with a body that may move; all others rest and cost it nothing. The list is sorted by colliders,
// which makes everything downstream independent of the broad phase's own order and of how the pairs came about.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "base/prefetch.h"
#include "broad_phase/box.h"
#include "collision/mesh/candidates.h"
#include "collision/narrow_phase.h"
#include "world/narrow/kernels.h"

namespace lendulet {

inline constexpr uint32_t no_pair = ~0u;
// Colliders for whose contacts room is taken before there are any, at most.
inline constexpr size_t most_expected = 1 << 15;

// Which way a pair is collided.
enum class PairKind : uint8_t {
    boxes,     // two sharp boxes: in batches, unless they have barely moved
    segments,  // balls and capsules: in batches, always, as cheap as finding out whether the bodies have moved
    box_ball,
    ball_box,  // the same of a box and a ball, by which of them is the manifolds' A
    plain,     // any other closed form: always
    general,
    trigger,  // whether they overlap is all that is asked
};

struct ColliderPair {
    uint32_t a, b;            // collider slots, a < b; a is no_pair once the pair has ended
    uint32_t body_a, body_b;  // the bodies of the manifolds' A and B
    uint32_t first_record;    // of this pair's own stretch of records; of a trigger: see RestingContacts::hits
    uint32_t surface;         // with a mesh: of PairTable::near_triangles
    uint8_t capacity, count;  // manifolds: room, and those found
    uint8_t prepared;         // records whose lasting parts are filled in
    PairKind kind;
    bool flipped;  // B's body is not moved by constraints: the manifolds' A is B
    bool fixed_a;  // that of A is not
    bool hit;      // of a trigger: overlaps
    bool begun;    // not yet collided
    bool covered;  // some of its manifolds are: see mark_covered()
    bool listed;   // a step looks at it
    bool bounces;  // of two sharp boxes: with a restitution
    bool touches;  // as events have reported, or would have: only kept up where a collider asks for events
    float rest_h;  // of a pair that rests: the substep that its impulses belong to, s
};

// Whether the pair's manifolds are kept while its bodies barely move.
inline bool may_be_kept(const ColliderPair& p) { return p.kind == PairKind::general || p.kind == PairKind::boxes; }
// Whether the separations of its manifolds as they were found are known; floors have seams, see seams.cpp.
inline bool has_found_separations(const ColliderPair& p) { return may_be_kept(p) || p.fixed_a; }

struct ListedPair {
    uint32_t a, b, pair;
};

class PairTable {
public:
    explicit PairTable(const Memory* memory)
        : pairs(memory),
          caches(memory),
          poses(memory),
          near_triangles(memory),
          listed(memory),
          links_(memory),
          first_(memory),
          free_(memory),
          ended_(memory),
          free_single_(memory),
          free_mesh_(memory),
          free_surface_(memory),
          coming_(memory),
          merged_(memory),
          scratch_(memory),
          counts_(memory) {}

    Array<ColliderPair> pairs;  // by number, as the two that follow
    Array<PairCache> caches;
    Array<KeptPose> poses;
    Array<MeshCandidates> near_triangles;  // of pairs with a mesh or height field
    Array<ListedPair> listed;              // sorted by (a, b); brought up to date by merge() and sweep()

    int count() const { return pairs.count() - free_.count() - ended_.count(); }
    // All stretches of records, those given back included.
    uint32_t record_count() const { return record_count_; }

    // So that `more` pairs may begin at the cost of one enlargement.
    void make_room(size_t more);
    // Room for so many pairs in all, not written to.
    void reserve(size_t pairs);
    // For so many pairs, each with one manifold, written to.
    void make_ready(size_t pairs);
    // A new pair of colliders a < b, which is listed; its number. Colliders from `colliders` on are unknown.
    uint32_t begin(uint32_t a, uint32_t b, size_t colliders);
    // Gives a pair its stretch of records, for one manifold or for those of a mesh.
    void place_records(ColliderPair& pair, bool mesh);
    // The number may be taken by another pair after the next sweep().
    void end(uint32_t number);
    // Ends a pair whose place on the list the caller gives away.
    void take_off(uint32_t number);
    // Forgets all pairs, for a snapshot's.
    void clear();
    // no_pair where there is none. Cost: the pairs of the collider that has fewer.
    uint32_t find(uint32_t a, uint32_t b) const;
    // visit(number) for all pairs of a collider; it may end that pair.
    template <class Visit>
    void for_each_of(uint32_t collider, Visit&& visit) const {
        if (collider >= first_.size()) return;
        for (uint32_t link = first_[collider].link; link != no_pair;) {
            uint32_t number = link / 2;
            link = links_[link].next;
            visit(number);
        }
    }

    // The list. A pair that rested comes on it with the next merge().
    void list(uint32_t number);
    bool to_be_merged() const { return !coming_.empty(); }
    void merge();
    bool to_be_swept() const { return !ended_.empty(); }
    // Takes those that have ended off the list, and those for which rests(pair) holds; these are then told
    // rest(number).
    template <class Rests, class Rest>
    void sweep(Rests&& rests, Rest&& rest);

    // Sorts by (a, b).
    void sort(Array<BoxPair>& boxes);

private:
    // A pair hangs on both of its colliders by a link each: 2 * number for a, 2 * number + 1 for b.
    struct Link {
        uint32_t next, previous;
    };
    struct Links {
        uint32_t link = no_pair, count = 0;
    };
    void end(uint32_t number, Array<uint32_t>& numbers);
    void hang(uint32_t collider, uint32_t link);
    void unhang(uint32_t collider, uint32_t link);
    void place_surface(ColliderPair& pair);
    void give_back_ended();

    uint32_t record_count_ = 0;
    Array<Link> links_;
    Array<Links> first_;                       // by collider
    Array<uint32_t> free_;                     // numbers
    Array<uint32_t> ended_;                    // numbers that may still be on the list
    Array<uint32_t> free_single_, free_mesh_;  // first records of stretches given back
    Array<uint32_t> free_surface_;             // of near_triangles
    Array<ListedPair> coming_, merged_;
    Array<BoxPair> scratch_;
    Array<uint32_t> counts_;
};

template <class Rests, class Rest>
void PairTable::sweep(Rests&& rests, Rest&& rest) {
    size_t kept = 0;
    for (size_t i = 0; i < listed.size(); ++i) {
        const ListedPair entry = listed[i];
        if (i + prefetch_distance < listed.size()) prefetch(&pairs[listed[i + prefetch_distance].pair]);
        ColliderPair& pair = pairs[entry.pair];
        if (pair.a == no_pair) continue;
        if (rests(pair)) {
            pair.listed = false;
            rest(entry.pair);
        } else {
            listed[kept++] = entry;
        }
    }
    listed.resize_unset(kept);
    give_back_ended();
}

}  // namespace lendulet
