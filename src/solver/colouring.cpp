#include "solver/colouring.h"

#include <bit>

#include "solver/stand_ins.h"

namespace lendulet {
namespace {

constexpr int four_points = 0, two_points = 1, size_classes = 3, contact_classes = 2 * size_classes;
constexpr int near_places = 16;  // parts of the bodies that contacts of a colour are sorted by

// Lowest colour free at all given bodies, or -1.
int free_colour(uint32_t used, int colours) {
    int c = std::countr_one(used);
    return c < colours ? c : -1;
}

size_t rounded_up(size_t bytes) { return (bytes + Memory::alignment - 1) / Memory::alignment * Memory::alignment; }

}  // namespace

uint8_t contact_kind(const ContactRecord& r) {
    const int rolls = (r.flags & contact_rolls) != 0 ? size_classes : 0;
    return static_cast<uint8_t>(size_classes - 1 - row_class(r.point_count) + rolls);
}

// A sample is enough, as it is but a question of speed.
bool lie_within(const Tiles& tiles, const ContactEnds* ends, int count) {
    constexpr int every = 8, most_between = 12;  // contacts; % of the sample
    if (tiles.count == 1) return true;
    int between = 0;
    for (int i = 0; i < count; i += every) between += tiles.of(ends[i].a, ends[i].b) == tiles.count;
    return 100 * between <= most_between * (count / every);
}

void ColourSorter::begin(int bodies, int constraints, int classes, Tiles tiles, int order) {
    classes_ = classes;
    order_ = order;
    tiles_ = tiles;
    used_inside_.assign(tiles.count > 1 ? static_cast<size_t>(bodies) : 0, 0u);
    used_between_.assign(static_cast<size_t>(bodies), 0u);
    used_fixed_.assign(static_cast<size_t>(bodies), 0u);
    keys_.clear();
    keys_.reserve(static_cast<size_t>(constraints));
    counts_.assign(static_cast<size_t>((tiles.count + 1) * colours * classes * order) + 1, 0u);
}

void ColourSorter::add(int32_t a, bool moved_a, int32_t b, bool moved_b, int constraint_class, int place) {
    const size_t i = static_cast<size_t>(a), j = static_cast<size_t>(b);
    const int tile = tiles_.of(a, b);
    int colour;
    if (moved_a && moved_b) {
        Array<uint32_t>& used = tile < tiles_.count ? used_inside_ : used_between_;
        colour = free_colour(used[i] | used[j], moving_colours);
        if (colour >= 0) used[i] |= 1u << colour, used[j] |= 1u << colour;
    } else {
        uint32_t& used = used_fixed_[moved_a ? i : j];
        colour = free_colour(used, fixed_colours);
        if (colour >= 0) used |= 1u << colour, colour += moving_colours;
    }
    if (colour < 0) colour = moved_a && moved_b ? moving_overflow : fixed_overflow, place = 0;
    keys_.push_back(static_cast<uint32_t>(((tile * colours + colour) * classes_ + constraint_class) * order_ + place));
    ++counts_[keys_.back() + 1u];
}

void ColourSorter::end() {
    for (size_t k = 1; k < counts_.size(); ++k) counts_[k] += counts_[k - 1];
}

void ColourSchedule::colour(ColourSorter& sorter, const ContactEnds* ends, int count, const SolverBodies& bodies,
                            const ContactCut& cut) const {
    const bool near = cut.near.begin < cut.near.end;
    const int part = (cut.near.end - cut.near.begin + near_places - 1) / near_places;
    sorter.begin(bodies.count, count, contact_classes, tiles, near ? 2 * near_places : 2);
    for (int i = 0; i < count; ++i) {
        const ContactEnds& e = ends[i];
        const int place = near ? (e.b - cut.near.begin) / part : 0;
        sorter.add(e.a, !e.fixed_a, e.b, true, e.kind, 2 * place + e.idle);
    }
    sorter.end();
}

// Groups in solving order with their place in `order`. Room for four points that the last rows of a colour have left is
// filled with manifolds of two: with points that are not there a row gives the same bits. How many must not depend on
// the width.
void ColourSchedule::make_groups(const ColourSorter& sorter, ContactExtra* extras) {
    constexpr int whole = 16;
    int numbers[2][ColourSorter::colours], last_between = -1;
    for (auto& list : numbers)
        for (int& n : list) n = -1;
    int open_tile = -1;  // that of the last group, where that has room for more
    sorter.for_each_group([&](int tile, int colour, int c, uint32_t begin, uint32_t n) {
        const bool outside = tile == tiles.count;
        while (tile_ends.count() < tile) tile_ends.push_back(groups.count());
        if (outside && last_between >= 0 && colour != last_between) colour_ends.push_back(groups.count());
        if (outside) last_between = colour;
        int& number = numbers[outside][colour];
        if (number < 0) number = colours++;
        int count = static_cast<int>(n);
        if (open_tile == tile && groups.back().colour == number && c == two_points) {
            int& fours = groups.back().count;
            const int spare = (whole - fours % whole) % whole, taken = spare < count ? spare : count;
            fours += taken;
            begin += static_cast<uint32_t>(taken), count -= taken;
        }
        open_tile = -1;
        if (count == 0) return;
        ContactGroup g{};
        g.points = 4 >> (c % size_classes);
        g.shares = ColourSorter::overflows(colour);
        g.fixed_a = ColourSorter::is_fixed(colour);
        g.filler = outside ? c : tiles.filler(tile);
        g.colour = number;
        g.count = count;
        g.order = order.data() + begin;
        g.extras = c >= size_classes ? extras : nullptr;
        groups.push_back(g);
        overflow += g.shares ? count : 0;
        if (c == four_points && !g.shares) open_tile = tile;
    });
    if (last_between >= 0) colour_ends.push_back(groups.count());
}

void ColourSchedule::measure_rows(const SolverKernels& table) {
    size_t bytes = 0;
    auto place = [&](size_t size) {  // an offset until there is memory
        auto* at = reinterpret_cast<std::byte*>(bytes);
        bytes += size;
        return at;
    };
    for (ContactGroup& g : groups) {
        const size_t blocks = block_count(static_cast<uint32_t>(g.count), table.width);
        g.rows = place(table.row_bytes[row_class(g.points)] * blocks);
        g.rolling = place(g.extras ? table.rolling_bytes * blocks : 0);
        const size_t ends = g.shares ? static_cast<size_t>(g.count) * sizeof(SharedEnds) : 0;
        g.ends = reinterpret_cast<SharedEnds*>(place(rounded_up(ends)));
    }
    row_bytes = rounded_up(bytes);
}

void ColourSchedule::place_rows(std::byte* rows, const ContactRecord* records, float impulse_unit) {
    for (ContactGroup& g : groups) {
        g.records = records;
        g.impulse_unit = impulse_unit;
        g.rows = rows + reinterpret_cast<size_t>(g.rows);
        g.rolling = g.extras ? rows + reinterpret_cast<size_t>(g.rolling) : nullptr;
        g.ends = g.shares ? reinterpret_cast<SharedEnds*>(rows + reinterpret_cast<size_t>(g.ends)) : nullptr;
    }
}

void ColourSchedule::build(ColourSorter& sorter, const ContactEnds* ends, ContactExtra* extras, const uint32_t* list,
                           int count, const SolverBodies& bodies, const ContactCut& cut, const SolverKernels& kernels) {
    groups.clear();
    tile_ends.clear();
    colour_ends.clear();
    colours = overflow = 0;
    tiles = cut.tiles;
    order.resize_unset(static_cast<size_t>(count));
    if (count > 0) colour(sorter, ends, count, bodies, cut);
    if (count > 0) make_groups(sorter, extras);
    while (tile_ends.count() < tiles.count) tile_ends.push_back(groups.count());
    measure_rows(kernels);
    if (count > 0) sorter.fill([&](uint32_t place, uint32_t i) { order[place] = list[i]; });
}

}  // namespace lendulet
