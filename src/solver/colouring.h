// Graph colouring of constraints: those of one colour share no body that constraints move, so they are solved side by
// side, in lanes and on threads, with one result.
//
// Greedy in the order of the list, lowest free colour first (Welsh, Powell 1967, without sorting). Constraints with a
// static or kinematic body have colours of their own, solved last in every pass: what rests on the ground is then as
// exact as an iteration can leave it. Constraints that find no free colour (a body with very many neighbours) overflow,
// of either kind for themselves: what cannot be moved is never stored to. Contacts that do are solved with stand-ins
// for the bodies that they share (stand_ins.h), joints one by one.
//
// Many bodies are cut into tiles that fit into the second-level cache with their constraints. Constraints inside a tile
// are coloured for the tile alone, which one thread solves from end to end; those between two tiles are coloured
// together, with a barrier after each colour.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/contact.h"
#include "solver/kernels.h"
#include "solver/tiles.h"

namespace lendulet {

// Blocks of `width` lanes that hold n constraints.
inline size_t block_count(uint32_t n, int width) {
    return (n + static_cast<uint32_t>(width) - 1) / static_cast<uint32_t>(width);
}

// Gives each constraint of a list a colour and sorts the list by tile, colour and class, all stably.
class ColourSorter {
public:
    static constexpr int moving_colours = 32, fixed_colours = 16;
    static constexpr int moving_overflow = moving_colours + fixed_colours, fixed_overflow = moving_overflow + 1;
    static constexpr int colours = fixed_overflow + 1;
    static constexpr bool overflows(int colour) { return colour >= moving_overflow; }
    // Whether the constraints of a colour move only one of their bodies.
    static constexpr bool is_fixed(int colour) { return colour >= moving_colours && colour != moving_overflow; }

    explicit ColourSorter(const Memory* memory)
        : used_inside_(memory), used_between_(memory), used_fixed_(memory), keys_(memory), counts_(memory) {}

    // `order`: how many places in a group there are to ask for.
    void begin(int bodies, int constraints, int classes, Tiles tiles = {}, int order = 1);
    // The next constraint, between two bodies of which at least one is moved. In its group it comes after those with a
    // smaller `place` and before those with a larger one; one that overflows only after those added before.
    void add(int32_t a, bool moved_a, int32_t b, bool moved_b, int constraint_class, int place = 0);
    void end();
    // Takes memory for so many; before begin().
    void make_ready(size_t bodies, size_t constraints) {
        used_inside_.make_ready(bodies), used_between_.make_ready(bodies), used_fixed_.make_ready(bodies);
        keys_.make_ready(constraints);
    }
    // Calls group(tile, colour, class, begin, count) for every group that is not empty, by tile, then colour, then
    // class: its constraints are to be found in [begin, begin + count) of what fill() writes. Tile `count` is what lies
    // between tiles, and all where there is but one.
    template <class Group>
    void for_each_group(Group&& group) const {
        const int per_tile = colours * classes_;
        for (int key = 0; key < (tiles_.count + 1) * per_tile; ++key) {
            const uint32_t first = counts_[static_cast<size_t>(key * order_)];
            const uint32_t n = counts_[static_cast<size_t>((key + 1) * order_)] - first;
            if (n > 0) group(key / per_tile, key % per_tile / classes_, key % classes_, first, n);
        }
    }
    // Calls put(place, i) for every constraint i in order of the list; last call.
    template <class Put>
    void fill(Put&& put) {
        for (size_t i = 0; i < keys_.size(); ++i) put(counts_[keys_[i]]++, static_cast<uint32_t>(i));
    }

private:
    // A bit per colour and body, of constraints in its tile, with another one's body and with what is not moved.
    Array<uint32_t> used_inside_, used_between_, used_fixed_;
    Array<uint32_t> keys_;
    Array<uint32_t> counts_;
    int classes_ = 1, order_ = 1;
    Tiles tiles_;
};

// Memory that the schedules of a step share, however its contacts are divided among them.
struct ScheduleRoom {
    ColourSorter sorter;    // of one after the other
    Array<std::byte> rows;  // a part of it each

    explicit ScheduleRoom(const Memory* memory) : sorter(memory), rows(memory) {}
    // Takes memory for so many; before build(). `row_bytes`: of one contact.
    void make_ready(size_t bodies, size_t contacts, size_t row_bytes) {
        rows.make_ready((contacts + contacts / 8) * row_bytes);  // with empty lanes
        sorter.make_ready(bodies, contacts);
    }
};

// ContactEnds::kind of a contact: by room for points, the largest first, and whether it resists rolling.
uint8_t contact_kind(const ContactRecord& record);
// Whether nearly all contacts lie within tiles. Others are solved faster in long loops, since the rows of a tile by
// colour and class often end with empty lanes.
bool lie_within(const Tiles& tiles, const ContactEnds* ends, int count);

// How the contacts of a class of substeps are divided.
struct ContactCut {
    Tiles tiles;
    // Bodies in one tile by whose places contacts of a colour are sorted, so that a worker's part of every colour has
    // to do with his part of the bodies; empty where they need not be. Results do not tell.
    BodyRange near{0, 0};
};

struct ColourSchedule {
    Array<uint32_t> order;       // indices of records, by group
    Array<ContactGroup> groups;  // those of each tile in the order in which they are solved, then those between tiles
    Array<int> tile_ends;        // one past the last group of each tile
    Array<int> colour_ends;      // one past the last group of each colour between tiles: a barrier follows
    Tiles tiles;
    size_t row_bytes = 0;  // of all groups
    int colours = 0;       // numbers of colours given, see ContactGroup
    int overflow = 0;      // manifolds that share bodies: see stand_ins.h

    explicit ColourSchedule(const Memory* memory)
        : order(memory), groups(memory), tile_ends(memory), colour_ends(memory) {}

    // Colours `count` contacts of bodies in these tiles; `list` names their records. Where only one body of a contact
    // is moved, it is B. `extras`, by record, may be null where no contact resists rolling.
    void build(ColourSorter& sorter, const ContactEnds* ends, ContactExtra* extras, const uint32_t* list, int count,
               const SolverBodies& bodies, const ContactCut& cut, const SolverKernels& kernels);
    // Gives the groups their rows, `row_bytes` of memory aligned to Memory::alignment; after build(), once.
    void place_rows(std::byte* rows, const ContactRecord* records, float impulse_unit);
    // Groups of a tile; of all that lies between tiles where `tile` is their count.
    int first_group(int tile) const { return tile == 0 ? 0 : tile_ends[static_cast<size_t>(tile) - 1]; }
    int last_group(int tile) const {
        return tile < tiles.count ? tile_ends[static_cast<size_t>(tile)] : groups.count();
    }
    // So that it can hold what `other` holds as well without asking for memory; before build().
    void make_room(const ColourSchedule& other) {
        order.reserve(order.size() + other.order.size());
        groups.reserve(groups.size() + other.groups.size());
        tile_ends.reserve(tile_ends.size() + other.tile_ends.size());
        colour_ends.reserve(colour_ends.size() + other.colour_ends.size());
    }

private:
    void colour(ColourSorter& sorter, const ContactEnds* ends, int count, const SolverBodies& bodies,
                const ContactCut& cut) const;
    void make_groups(const ColourSorter& sorter, ContactExtra* extras);
    void measure_rows(const SolverKernels& kernels);
};

}  // namespace lendulet
