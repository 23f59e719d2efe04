// The order in which the wide tree takes its boxes, so that every 64 in a row lie close together: slabs along one axis,
// strips along another in each slab, runs along the third in each strip (Leutenegger, Lopez and Edgington 1997), with
// counting sorts in place of exact ones: what shares a bucket of a few thousandths of the range stays as it came.
// Slabs and strips are run through to and fro, so that a group that reaches from one into the next is no longer than
// others.
//
// Boxes far larger than the others come last, so that they widen few groups. Boxes with infinite sides are listed
// apart.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"

namespace lendulet {

class WideTreeOrder {
public:
    explicit WideTreeOrder(const Memory* memory);

    // Sets `places` to the places of the bounded boxes in their order and `unbounded` to those of the others. `tasks`
    // may be null; it never changes the result.
    void sort(const BroadBox* boxes, int count, TaskPool* tasks, Array<uint32_t>& places, Array<uint32_t>& unbounded);
    size_t bytes() const { return items_.bytes() + scratch_.bytes(); }

private:
    struct alignas(16) Item {
        float at[3];  // the centre
        uint32_t place;
    };
    // Positions of the first item of each slab, or strip of a slab.
    static constexpr int most_parts = 128;
    struct Cuts {
        int begin[most_parts + 1];
    };
    struct Shape {
        int slabs, strips;  // strips of each slab
        int axis[3];        // of slabs, strips, runs
    };

    int collect(const BroadBox* boxes, int count, Array<uint32_t>& unbounded);
    int part_large(const BroadBox* boxes, int count);
    void arrange(int begin, int count, TaskPool* tasks, uint32_t* places);
    void arrange_slab(Item* items, Item* scratch, int count, const Shape& shape, bool backwards, uint32_t* places);
    static Shape choose_shape(const Item* items, int count);
    static void cut(Item* items, Item* scratch, int count, int axis, int parts, Cuts& cuts);
    static void sort_along(Item* items, Item* scratch, int count, int axis, int most_together);

    int largest_usual_ = 0;  // exponent of the size above which a box is large
    bool any_large_ = false;
    Array<Item> items_, scratch_;
};

}  // namespace lendulet
