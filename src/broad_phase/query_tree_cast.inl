// The one source of the walk in query_tree_cast.h. Included by a unit for each instruction set, which defines
// LENDULET_KERNEL_SPACE.
#include "base/prefetch.h"
#include "broad_phase/query_tree_cast.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

// All lanes the same, bit by bit.
template <class F>
LENDULET_FORCE_INLINE F copies(float x) {
    return (F)(Wide<int32_t, lanes_of<F>>{} + __builtin_bit_cast(int32_t, x));
}

// The slab test of Kay and Kajiya 1986 with a reciprocal. Where the box does not move along an axis a huge number
// stands for it: what is outside is then entered far beyond any limit.
struct alignas(64) CastSlabs {
    float from_near[3], from_far[3], inverse[3];
    int32_t near[3], far[3];  // places of the sides that are entered and left, in floats from the start of a block

    // Without branches: which way a cast goes cannot be foreseen.
    LENDULET_FORCE_INLINE void set(const SweptBox& s) {
        for (int d = 0; d < 3; ++d) {
            constexpr int32_t upper = 3 * block_size;
            const float grown = s.half[d] + query_tree::margin * (absolute(s.origin[d]) + s.half[d]);
            const float towards = __builtin_copysignf(grown, s.translation[d]);
            from_near[d] = s.origin[d] + towards, from_far[d] = s.origin[d] - towards;
            inverse[d] = 1.0f / __builtin_copysignf(maximum(absolute(s.translation[d]), 1e-25f), s.translation[d]);
            const int32_t backwards = __builtin_bit_cast(int32_t, s.translation[d]) >> 31;  // all bits or none
            near[d] = d * block_size + (upper & backwards), far[d] = d * block_size + (upper & ~backwards);
        }
    }
    // Where each box of a block is entered; infinity where it is not met up to `limit`.
    template <class F>
    LENDULET_FORCE_INLINE void enter(const BoxBlock& box, float limit, float enters[block_size]) const {
        const float* sides = box.lower[0];
        for (int lanes = 0; lanes < block_size; lanes += lanes_of<F>) {
            F enter = splat<F>(0.0f), leave = copies<F>(limit);
            for (int d = 0; d < 3; ++d) {
                const F scale = copies<F>(inverse[d]);
                enter = maximum((load_wide<F>(sides + near[d] + lanes) - copies<F>(from_near[d])) * scale, enter);
                leave = minimum((load_wide<F>(sides + far[d] + lanes) - copies<F>(from_far[d])) * scale, leave);
            }
            enter = enter * splat<F>(1.0f - query_tree::margin);
            store_wide(enters + lanes, select(enter <= leave, enter, splat<F>(infinity)));
        }
    }
};

LENDULET_FORCE_INLINE Wide<float, 4> lesser_half(Wide<float, 8> x) {
    return minimum(Wide<float, 4>{x[0], x[1], x[2], x[3]}, Wide<float, 4>{x[4], x[5], x[6], x[7]});
}
LENDULET_FORCE_INLINE float least_lane(Wide<float, 4> x) {
    const Wide<float, 4> y = minimum(x, Wide<float, 4>{x[2], x[3], x[2], x[3]});
    return minimum(y[0], y[1]);
}

// Eight numbers as as many vectors as they fill.
template <class F>
struct Eight {
    static constexpr int parts = block_size / lanes_of<F>;
    F part[parts];

    explicit Eight(const float* x) {
        for (int i = 0; i < parts; ++i) part[i] = load_wide<F>(x + i * lanes_of<F>);
    }
    // The lanes in which a condition holds.
    template <class Condition>
    LENDULET_FORCE_INLINE uint32_t where(Condition&& condition) const {
        uint32_t bits = 0;
        for (int i = 0; i < parts; ++i) bits |= mask_bits(condition(part[i])) << i * lanes_of<F>;
        return bits;
    }
    LENDULET_FORCE_INLINE float least() const {
        if constexpr (parts == 1) return least_lane(lesser_half(part[0]));
        else return least_lane(minimum(part[0], part[1]));
    }
};

// What one cast has still to look at: a frame for each node on its way, with where its children are entered; infinity
// where that is never, or has been.
struct CastFrames {
    alignas(32) float enters[query_tree::max_depth][block_size];
    int32_t node[query_tree::max_depth];
    int top;

    // Tests the children of a node, which are taken next.
    template <class F>
    LENDULET_FORCE_INLINE void add(const QueryNode* nodes, int32_t at, const CastSlabs& slabs, float limit) {
        node[top] = at;
        slabs.template enter<F>(nodes[at].box, limit, enters[top++]);
    }
    // The nearest child of the last node that has one up to `limit`; false where there is none. Which child that is,
    // and whether it is the last one, cannot be foreseen: there is no branch on either.
    template <class F>
    LENDULET_FORCE_INLINE bool take(const QueryNode* nodes, float limit, int32_t& child) {
        while (top > 0) {
            float* frame = enters[top - 1];
            const Eight<F> at(frame);
            const F most = copies<F>(limit);
            const uint32_t left = at.where([&](F x) { return x <= most; });
            if (left == 0) {
                --top;
                continue;
            }
            const F least = copies<F>(at.least());
            const int k = __builtin_ctz(at.where([&](F x) { return x == least; }));
            frame[k] = infinity;
            child = nodes[node[top - 1]].child[k];
            top -= (left & (left - 1u)) == 0;
            return true;
        }
        return false;
    }
};

// A child with where it is entered: never negative, so that its bits order as it does, and those of the child below
// them decide nothing but the order of equals.
using CastEntry = uint64_t;
LENDULET_FORCE_INLINE CastEntry cast_entry_of(float enter, int32_t child) {
    return static_cast<uint64_t>(__builtin_bit_cast(uint32_t, enter)) << 32 | static_cast<uint32_t>(child);
}
LENDULET_FORCE_INLINE float enter_of(CastEntry e) { return __builtin_bit_cast(float, static_cast<uint32_t>(e >> 32)); }
LENDULET_FORCE_INLINE int32_t child_of(CastEntry e) { return static_cast<int32_t>(static_cast<uint32_t>(e)); }

// One cast by itself waits less for a wrong guess than for the least of eight numbers: the children that are met go
// onto a stack, nearest last. Most nodes have up to two, which are told apart without a branch.
template <class F>
void cast_one(const QueryNode* nodes, const SweptBox& swept, float limit, CastVisitor visitor) {
    CastSlabs slabs;
    slabs.set(swept);
    CastEntry stack[query_tree::max_depth * block_size], next = 0;
    alignas(32) float enters[block_size];
    int top = 0;
    while (true) {
        uint32_t met = 0;
        if (child_of(next) < 0) {
            limit = visitor.visit(visitor.context, static_cast<uint32_t>(~child_of(next)));
        } else {
            const QueryNode& node = nodes[child_of(next)];
            slabs.template enter<F>(node.box, limit, enters);
            const F most = copies<F>(limit);
            met = Eight<F>(enters).where([&](F x) { return x <= most; });
            const int bottom = top;
            if (met) {
                const int first = take_bit(met);
                next = cast_entry_of(enters[first], node.child[first]);
                while (met) {
                    const int k = take_bit(met);
                    const CastEntry e = cast_entry_of(enters[k], node.child[k]), later = e < next ? next : e;
                    next = e < next ? e : next;
                    int at = top++;
                    for (; at > bottom && stack[at - 1] < later; --at) stack[at] = stack[at - 1];
                    stack[at] = later;
                }
                continue;
            }
        }
        do {
            if (top == 0) return;
            next = stack[--top];
        } while (!(enter_of(next) <= limit));
    }
}

// Where one cast goes next is known only when a chain of operations has ended, each of which waits for the one before.
// So some casts go by turns, and as good as without branches: their chains run side by side, and the memory of what
// comes next is on its way while the others have their turns.
struct alignas(64) CastPlace {
    CastSlabs slabs;
    float limit;
    int32_t cast, tree;
    int32_t next;  // the child it is at
    const QueryNode* nodes;
    CastFrames frames;
};

template <class F>
struct CastTurns {
    static constexpr int turns = most_visits;
    const ManyCasts& casts;
    int begun = 0, node_count = 0, box_count = 0;
    CastPlace *at_nodes[turns], *at_boxes[turns];  // of the next turn
    CastPlace places[turns];

    explicit CastTurns(const ManyCasts& c) : casts(c) {
        for (CastPlace& place : places) begin(place);
    }
    // The next cast, if there is one left.
    __attribute__((noinline)) void begin(CastPlace& place) {
        if (begun == casts.count) return;
        place.cast = begun++;
        place.limit = casts.limit[place.cast];
        place.slabs.set(casts.swept[place.cast]);
        place.tree = -1;
        begin_tree(place);
    }
    void begin_tree(CastPlace& place) {
        if (++place.tree == casts.tree_count) return begin(place);
        place.nodes = casts.trees[place.tree];
        place.frames.top = 0;
        put(place, 0);
    }
    LENDULET_FORCE_INLINE void put(CastPlace& place, int32_t child) {
        place.next = child;
        at_nodes[node_count] = at_boxes[box_count] = &place;
        node_count += child >= 0, box_count += child < 0;
        const uintptr_t node =
            reinterpret_cast<uintptr_t>(place.nodes) + static_cast<uint32_t>(child) * sizeof(QueryNode);
        const uintptr_t item =
            reinterpret_cast<uintptr_t>(casts.items) + static_cast<uint32_t>(~child) * casts.item_size;
        prefetch<4>(reinterpret_cast<const void*>(child < 0 ? item : node));
    }
    // Each place one step farther.
    void take_turn() {
        CastPlace* now[turns];
        CastVisit visits[turns];
        const int count = node_count + box_count;
        for (int i = 0; i < node_count; ++i) {
            CastPlace& place = *(now[i] = at_nodes[i]);
            place.frames.template add<F>(place.nodes, place.next, place.slabs, place.limit);
        }
        for (int i = 0; i < box_count; ++i) {
            const CastPlace& place = *(now[node_count + i] = at_boxes[i]);
            visits[i] = {place.cast, static_cast<uint32_t>(~place.next)};
        }
        if (box_count > 0) casts.visit(casts.context, visits, box_count);
        for (int i = node_count; i < count; ++i) now[i]->limit = casts.limit[now[i]->cast];
        node_count = box_count = 0;
        for (int i = 0; i < count; ++i) {
            CastPlace& place = *now[i];
            int32_t child;
            if (place.frames.template take<F>(place.nodes, place.limit, child)) put(place, child);
            else begin_tree(place);
        }
    }
};

template <class F>
void cast_many(const ManyCasts& casts) {
    CastTurns<F> t(casts);
    while (t.node_count + t.box_count > 0) t.take_turn();
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
