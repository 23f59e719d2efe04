// The walk of a ray or a swept box through a QueryTree, compiled once per instruction set. Which boxes are visited may
// depend on the width of the vectors by no more than their order: what decides is the exact test behind.
#pragma once

#include <cstddef>

#include "broad_phase/block.h"

namespace lendulet {

// child >= 0: node; < 0: ~index of a box. Empty lanes have inverted boxes.
struct alignas(64) QueryNode {
    BoxBlock box;
    int32_t child[block_size];
};

namespace query_tree {
inline constexpr int heuristic_depth = 20;  // below it parts are halved by number
inline constexpr int max_depth = heuristic_depth + 12;
inline constexpr float margin = 2e-6f;  // relative; some roundings of a float
}  // namespace query_tree

// A box of half extents `half` about origin + t * translation.
struct SweptBox {
    float origin[3], translation[3], half[3];
};

// Told of the boxes that may be met; gives how far the search still goes.
struct CastVisitor {
    float (*visit)(void* context, uint32_t index);
    void* context;
};

// A box that a cast may meet.
struct CastVisit {
    int32_t cast;
    uint32_t index;
};
inline constexpr int most_visits = 12;  // at once

// Many casts, each with how far it goes, through some trees: their first nodes.
struct ManyCasts {
    const QueryNode* trees[2];
    int tree_count;
    const SweptBox* swept;
    float* limit;  // of each; `visit` may reduce it
    int count;
    void* context;
    void (*visit)(void* context, const CastVisit* visits, int count);  // of different casts
    // What is read when a box is visited: items + index * item_size. Asked for some time before.
    const char* items;
    size_t item_size;
};

// Visits the boxes below nodes[0] that may be met at t in [0, limit], roughly by t.
using QueryTreeCast = void (*)(const QueryNode* nodes, const SweptBox& swept, float limit, CastVisitor visitor);
// The same for each of many, by turns.
using QueryTreeCasts = void (*)(const ManyCasts& casts);

// In vectors of 4 or 8 lanes; of 4 where this machine has no instructions for 8. 0: the widest. A call for each, so
// that a program that asks for one does not carry the other.
QueryTreeCast query_tree_cast(int width = 0);
QueryTreeCasts query_tree_casts(int width = 0);

}  // namespace lendulet
