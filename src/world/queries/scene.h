// What queries search: every collider where it is now, in two trees, one for what is fixed and one for what moves.
//
// The broad phase's boxes reach through a whole step, and end before the bodies that were thrown aside in it. Queries
// therefore keep trees of their own. They cost nothing until somebody asks: writing calls and steps only note what
// changed, and the first query after a change brings the trees up to date, at a cost that goes with what has moved,
// come or gone.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/memory.h"
#include "broad_phase/query_tree.h"
#include "dynamics/body_store.h"
#include "dynamics/collider_store.h"
#include "lendulet/query.h"

namespace lendulet {

struct WorldData;

// A collider as queries see it. A sharp box is all here; what else a ray has to know of a shape is its geometry.
struct alignas(32) QueryTarget {
    Vec3 position;  // of the shape
    uint32_t body = no_slot;
    Quat rotation;
    Vec3 half;            // extents of a box, where it is one without rounding
    float radius = 0.0f;  // of a sphere about the position that holds the shape
    uint64_t category = 0, mask = 0;
    uint32_t group = 0;
    uint8_t type = 0;  // BodyType
    bool is_trigger = false, is_box = false;
    bool moved = false, changed = false, moves = false;  // is on the list of those
};

class QueryScene {
public:
    explicit QueryScene(const Memory* memory)
        : fixed_tree_(memory),
          moving_tree_(memory),
          boxes_(memory),
          fresh_(memory),
          targets_(memory),
          moving_(memory),
          moved_(memory),
          changed_(memory) {}

    // For writing calls: all moving bodies may be elsewhere; those with these colliders; a collider came, went or was
    // moved.
    void all_moved();
    void moved(const Array<uint32_t>& colliders);
    void changed(uint32_t collider);

    // Brings everything up to date where needed. Safe to call from several threads at once.
    void refresh(const WorldData& world);

    const QueryTarget& target(uint32_t collider) const { return targets_[collider]; }

    // As the walks of QueryTree, over all colliders: visit(collider) for what may be met. Each once.
    template <class Visit>
    void cast(const SweptBox& swept, float limit, Visit&& visit) const {
        auto from_tree = [&](uint32_t c) { return limit = visit(c); };
        moving_tree_.cast(swept, limit, from_tree);
        fixed_tree_.cast(swept, limit, from_tree);
    }
    // The same for many; of `casts` the trees and the items are set here.
    void cast_many(ManyCasts casts) const {
        casts.items = reinterpret_cast<const char*>(targets_.data()), casts.item_size = sizeof(QueryTarget);
        moving_tree_.add_to(casts);
        fixed_tree_.add_to(casts);
        if (casts.tree_count > 0) query_tree_casts()(casts);
    }
    template <class Visit>
    void nearest(const float lower[3], const float upper[3], float limit, Visit&& visit) const {
        auto from_tree = [&](uint32_t c) { return limit = visit(c); };
        moving_tree_.nearest(lower, upper, limit, from_tree);
        fixed_tree_.nearest(lower, upper, limit, from_tree);
    }
    template <class Visit>
    void overlapping(const float lower[3], const float upper[3], Visit&& visit) const {
        moving_tree_.overlapping(lower, upper, visit);
        fixed_tree_.overlapping(lower, upper, visit);
    }

private:
    void update(const WorldData& world);
    void build(const WorldData& world);
    void build_tree(const WorldData& world, QueryTree& tree, bool moves);
    void move_all(const WorldData& world);
    void move_some(const WorldData& world);
    void change_some(const WorldData& world);
    void place(const WorldData& world, uint32_t collider);
    BroadBox box_of(const WorldData& world, uint32_t collider) const;

    std::atomic<bool> ready_{false}, busy_{false};
    bool built_ = false, all_moved_ = false;
    QueryTree fixed_tree_, moving_tree_;
    Array<BroadBox> boxes_;            // by collider
    Array<BroadBox> fresh_;            // room to build a tree
    Array<QueryTarget> targets_;       // by collider
    Array<uint32_t> moving_;           // colliders of the moving tree, and some that have left it
    Array<uint32_t> moved_, changed_;  // since the trees were up to date, each once
};

}  // namespace lendulet
