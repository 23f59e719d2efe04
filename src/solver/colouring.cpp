#include "solver/colouring.h"

#include <bit>

namespace lendulet {
namespace {

constexpr int moving_colours = 32, fixed_colours = 16, classes = 3;
constexpr int overflow_colour = moving_colours + fixed_colours;
constexpr int key_count = (overflow_colour + 1) * classes;

// Lowest colour free at all given bodies, or -1.
int free_colour(uint32_t used, int colours) {
    int c = std::countr_one(used);
    return c < colours ? c : -1;
}

}  // namespace

void ColourSchedule::build(const ContactRecord* records, const uint32_t* list, int count, const SolverBodies& bodies,
                           const SolverKernels& kernels, const SolverKernels& scalar_kernels) {
    used_moving.assign(static_cast<size_t>(bodies.count), 0u);
    used_fixed.assign(static_cast<size_t>(bodies.count), 0u);
    keys.resize_unset(static_cast<size_t>(count));
    counts.assign(key_count + 1, 0u);
    for (int i = 0; i < count; ++i) {
        const ContactRecord& r = records[list[i]];
        size_t a = static_cast<size_t>(r.body_a), b = static_cast<size_t>(r.body_b);
        int colour;
        if (bodies.state[a].inverse_mass > 0.0f) {
            colour = free_colour(used_moving[a] | used_moving[b], moving_colours);
            if (colour >= 0) used_moving[a] |= 1u << colour, used_moving[b] |= 1u << colour;
        } else {
            colour = free_colour(used_fixed[b], fixed_colours);
            if (colour >= 0) used_fixed[b] |= 1u << colour, colour += moving_colours;
        }
        if (colour < 0) colour = overflow_colour;
        keys[i] = static_cast<uint8_t>(colour * classes + row_class(r.point_count));
        ++counts[keys[i] + 1];
    }
    for (int k = 0; k < key_count; ++k) counts[k + 1] += counts[k];

    // Groups in solving order with their place in `order`; then a stable counting sort fills it.
    order.resize_unset(static_cast<size_t>(count));
    groups.clear();
    colour_ends.clear();
    size_t bytes = 0;
    for (int colour = 0; colour <= overflow_colour; ++colour) {
        if (colour == overflow_colour) first_overflow_group = groups.count();
        for (int c = 0; c < classes; ++c) {
            uint32_t begin = counts[colour * classes + c], n = counts[colour * classes + c + 1] - begin;
            if (n == 0) continue;
            bool alone = colour == overflow_colour;
            const SolverKernels& table = alone ? scalar_kernels : kernels;
            ContactGroup g;
            g.points = 1 << c;
            g.fixed_a = colour >= moving_colours && !alone;
            g.filler = c;
            g.count = static_cast<int>(n);
            g.order = order.data() + begin;
            g.rows = reinterpret_cast<std::byte*>(bytes);  // an offset until the block is allocated below
            bytes += table.row_bytes[c] * ((n + static_cast<uint32_t>(table.width) - 1) / static_cast<uint32_t>(table.width));
            groups.push_back(g);
        }
        if (groups.count() > (colour_ends.empty() ? 0 : colour_ends.back())) colour_ends.push_back(groups.count());
    }
    overflow = static_cast<int>(counts[key_count] - counts[overflow_colour * classes]);
    rows.resize_unset(bytes);
    for (ContactGroup& g : groups) g.rows = rows.data() + reinterpret_cast<size_t>(g.rows);
    for (int i = 0; i < count; ++i) order[counts[keys[i]]++] = list[i];
}

}  // namespace lendulet
