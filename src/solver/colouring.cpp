#include "solver/colouring.h"

#include <bit>

#include "base/prefetch.h"

namespace lendulet {
namespace {

// By room for points; those that resist rolling are classes of their own.
constexpr int size_classes = 3, contact_classes = 2 * size_classes;

// Lowest colour free at all given bodies, or -1.
int free_colour(uint32_t used, int colours) {
    int c = std::countr_one(used);
    return c < colours ? c : -1;
}

}  // namespace

void ColourSorter::begin(int bodies, int constraints, int classes) {
    classes_ = classes;
    used_moving_.assign(static_cast<size_t>(bodies), 0u);
    used_fixed_.assign(static_cast<size_t>(bodies), 0u);
    keys_.clear();
    keys_.reserve(static_cast<size_t>(constraints));
    counts_.assign(static_cast<size_t>(colours * classes) + 1, 0u);
}

void ColourSorter::add(int32_t a, bool moved_a, int32_t b, bool moved_b, int constraint_class) {
    size_t i = static_cast<size_t>(a), j = static_cast<size_t>(b);
    int colour;
    if (moved_a && moved_b) {
        colour = free_colour(used_moving_[i] | used_moving_[j], moving_colours);
        if (colour >= 0) used_moving_[i] |= 1u << colour, used_moving_[j] |= 1u << colour;
    } else {
        uint32_t& used = used_fixed_[moved_a ? i : j];
        colour = free_colour(used, fixed_colours);
        if (colour >= 0) used |= 1u << colour, colour += moving_colours;
    }
    if (colour < 0) colour = overflow_colour;
    keys_.push_back(static_cast<uint16_t>(colour * classes_ + constraint_class));
    ++counts_[keys_.back() + 1u];
}

void ColourSorter::end() {
    for (size_t k = 1; k < counts_.size(); ++k) counts_[k] += counts_[k - 1];
}

void ColourSchedule::build(const ContactRecord* records, ContactExtra* extras, const uint32_t* list, int count,
                           const SolverBodies& bodies, const SolverKernels& kernels,
                           const SolverKernels& scalar_kernels) {
    groups.clear();
    colour_ends.clear();
    first_overflow_group = overflow = 0;
    rows.resize_unset(0);
    if (count == 0) return;
    sorter_.begin(bodies.count, count, contact_classes);
    for (int i = 0; i < count; ++i) {
        if (i + prefetch_distance < count) prefetch(&records[list[i + prefetch_distance]]);
        const ContactRecord& r = records[list[i]];
        bool moved_a = bodies.state[static_cast<size_t>(r.body_a)].inverse_mass > 0.0f;
        sorter_.add(r.body_a, moved_a, r.body_b, true,
                    row_class(r.point_count) + ((r.flags & contact_rolls) != 0 ? size_classes : 0));
    }
    sorter_.end();

    // Groups in solving order with their place in `order`.
    order.resize_unset(static_cast<size_t>(count));
    size_t bytes = 0;
    int last_colour = -1;
    first_overflow_group = -1;
    sorter_.for_each_group([&](int colour, int c, uint32_t begin, uint32_t n) {
        bool alone = colour == ColourSorter::overflow_colour;
        if (alone && first_overflow_group < 0) first_overflow_group = groups.count();
        if (colour != last_colour && last_colour >= 0) colour_ends.push_back(groups.count());
        last_colour = colour;
        const SolverKernels& table = alone ? scalar_kernels : kernels;
        ContactGroup g;
        const bool rolls = c >= size_classes;
        const int size = c % size_classes;
        g.points = 1 << size;
        g.fixed_a = colour >= ColourSorter::moving_colours && !alone;
        g.filler = size;
        g.count = static_cast<int>(n);
        g.order = order.data() + begin;
        g.rows = reinterpret_cast<std::byte*>(bytes);  // an offset until the block is allocated below
        bytes += table.row_bytes[size] * block_count(n, table.width);
        g.rolling = nullptr;
        g.extras = nullptr;
        if (rolls) {
            g.rolling = reinterpret_cast<std::byte*>(bytes);
            g.extras = extras;
            bytes += table.rolling_bytes * block_count(n, table.width);
        }
        groups.push_back(g);
    });
    if (groups.count() > 0) colour_ends.push_back(groups.count());
    if (first_overflow_group < 0) first_overflow_group = groups.count();
    overflow = sorter_.overflow();
    rows.resize_unset(bytes);
    for (ContactGroup& g : groups) {
        g.rows = rows.data() + reinterpret_cast<size_t>(g.rows);
        if (g.extras) g.rolling = rows.data() + reinterpret_cast<size_t>(g.rolling);
    }
    sorter_.fill([&](uint32_t place, uint32_t i) { order[place] = list[i]; });
}

}  // namespace lendulet
