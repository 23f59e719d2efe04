// Graph colouring of constraints: those of one colour share no body that constraints move, so they are solved side by
// side, in lanes and on threads, with one result.
//
// Greedy in the order of the list, lowest free colour first (Welsh, Powell 1967, without sorting). Constraints with a
// static or kinematic body have colours of their own, solved last in every pass: what rests on the ground is then as
// exact as an iteration can leave it. Constraints that find no free colour (a body with very many neighbours) overflow
// and are solved one by one.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/contact.h"
#include "solver/kernels.h"

namespace lendulet {

// Blocks of `width` lanes that hold n constraints.
inline size_t block_count(uint32_t n, int width) {
    return (n + static_cast<uint32_t>(width) - 1) / static_cast<uint32_t>(width);
}

// Gives each constraint of a list a colour and sorts the list by colour and class, both stably.
class ColourSorter {
public:
    static constexpr int moving_colours = 32, fixed_colours = 16;
    static constexpr int overflow_colour = moving_colours + fixed_colours, colours = overflow_colour + 1;

    explicit ColourSorter(const Memory* memory)
        : used_moving_(memory), used_fixed_(memory), keys_(memory), counts_(memory) {}

    void begin(int bodies, int constraints, int classes);
    // The next constraint, between two bodies of which at least one is moved.
    void add(int32_t a, bool moved_a, int32_t b, bool moved_b, int constraint_class);
    void end();
    // See ColourSchedule.
    void make_room(const ColourSorter& other) {
        used_moving_.reserve(other.used_moving_.size());
        used_fixed_.reserve(other.used_fixed_.size());
        keys_.reserve(keys_.size() + other.keys_.size());
        counts_.reserve(other.counts_.size());
    }
    // Calls group(colour, class, begin, count) for every group that is not empty, by colour, then class: its
    // constraints are to be found in [begin, begin + count) of what fill() writes.
    template <class Group>
    void for_each_group(Group&& group) const {
        for (int key = 0; key < colours * classes_; ++key) {
            uint32_t first = counts_[static_cast<size_t>(key)], n = counts_[static_cast<size_t>(key) + 1] - first;
            if (n > 0) group(key / classes_, key % classes_, first, n);
        }
    }
    int overflow() const {
        return static_cast<int>(counts_.back() - counts_[static_cast<size_t>(overflow_colour * classes_)]);
    }
    // Calls put(place, i) for every constraint i in order of the list; last call.
    template <class Put>
    void fill(Put&& put) {
        for (size_t i = 0; i < keys_.size(); ++i) put(counts_[keys_[i]]++, static_cast<uint32_t>(i));
    }

private:
    Array<uint32_t> used_moving_, used_fixed_;  // a bit per colour and body
    Array<uint16_t> keys_;
    Array<uint32_t> counts_;
    int classes_ = 1;
};

struct ColourSchedule {
    Array<uint32_t> order;       // indices of records, by group
    Array<ContactGroup> groups;  // in the order in which they are solved
    Array<int> colour_ends;      // one past the last group of each colour: a barrier follows
    Array<std::byte> rows;
    int first_overflow_group = 0;  // groups from here on hold manifolds that share bodies: one lane, one thread
    int overflow = 0;

    explicit ColourSchedule(const Memory* memory)
        : order(memory), groups(memory), colour_ends(memory), rows(memory), sorter_(memory) {}

    // Colours the `count` records that `list` names. Where only one body of a record is moved, it is B. `extras`, by
    // record, may be null where no contact resists rolling.
    void build(const ContactRecord* records, ContactExtra* extras, const uint32_t* list, int count,
               const SolverBodies& bodies, const SolverKernels& kernels, const SolverKernels& scalar_kernels);
    int colour_count() const { return colour_ends.count(); }
    // So that it can hold what `other` holds as well without asking for memory; before build().
    void make_room(const ColourSchedule& other) {
        order.reserve(order.size() + other.order.size());
        groups.reserve(groups.size() + other.groups.size());
        colour_ends.reserve(colour_ends.size() + other.colour_ends.size());
        rows.reserve(rows.size() + other.rows.size());
        sorter_.make_room(other.sorter_);
    }

private:
    ColourSorter sorter_;
};

}  // namespace lendulet
