#include "broad_phase/rtree/split.h"

#include <utility>

namespace lendulet {

namespace {

constexpr int padded = 12;  // nine entries in three vectors of four

// Entries coordinate by coordinate; the lanes behind the ninth repeat it.
struct Columns {
    alignas(16) float lower[3][padded];
    alignas(16) float upper[3][padded];
    alignas(16) float volume[padded];

    explicit Columns(const RtreeEntry entries[split_count]) {
        for (int i = 0; i < padded; ++i) {
            const RtreeEntry& e = entries[i < split_count ? i : split_count - 1];
            for (int d = 0; d < 3; ++d) {
                lower[d][i] = e.lower[d];
                upper[d][i] = e.upper[d];
            }
            volume[i] = (e.upper[0] - e.lower[0]) * (e.upper[1] - e.lower[1]) * (e.upper[2] - e.lower[2]);
        }
    }
    // Volumes of the boxes around a box and each of four entries.
    Float4 joined_volume(const WideBox& box, int i) const {
        Float4 product = splat<Float4>(1.0f);
        for (int d = 0; d < 3; ++d) {
            Float4 low = minimum(load_wide<Float4>(lower[d] + i), box.lower[d]);
            Float4 high = maximum(load_wide<Float4>(upper[d] + i), box.upper[d]);
            product = product * (high - low);
        }
        return product;
    }
    WideBox box(int i) const {
        WideBox b;
        for (int d = 0; d < 3; ++d) {
            b.lower[d] = splat<Float4>(lower[d][i]);
            b.upper[d] = splat<Float4>(upper[d][i]);
        }
        return b;
    }
};

// The pair that would waste most volume in one node.
std::pair<int, int> pick_seeds(const Columns& c) {
    std::pair<int, int> best(0, 1);
    float worst = -infinity;
    for (int i = 0; i < split_count - 1; ++i) {
        WideBox box = c.box(i);
        alignas(16) float waste[padded];
        for (int j = (i + 1) & ~3; j < padded; j += 4) {
            store_wide(waste + j, c.joined_volume(box, j) - load_wide<Float4>(c.volume + j) - c.volume[i]);
        }
        for (int j = i + 1; j < split_count; ++j) {
            if (waste[j] > worst) worst = waste[j], best = {i, j};
        }
    }
    return best;
}

struct Group {
    WideBox box;
    float volume;
    int count = 1;

    void add(const Columns& c, int i) {
        WideBox more = c.box(i);
        Float4 product = splat<Float4>(1.0f);
        for (int d = 0; d < 3; ++d) {
            box.lower[d] = minimum(more.lower[d], box.lower[d]);
            box.upper[d] = maximum(more.upper[d], box.upper[d]);
            product = product * (box.upper[d] - box.lower[d]);
        }
        volume = product[0];
        ++count;
    }
};

// Growth of the two groups by each entry.
void growths(const Columns& c, const Group group[2], float growth[2][padded]) {
    for (int g = 0; g < 2; ++g) {
        for (int i = 0; i < padded; i += 4) {
            store_wide(growth[g] + i, c.joined_volume(group[g].box, i) - group[g].volume);
        }
    }
}

}  // namespace

uint32_t split_quadratic(const RtreeEntry entries[split_count]) {
    const Columns c(entries);
    auto [first, second] = pick_seeds(c);
    Group group[2] = {{c.box(first), c.volume[first]}, {c.box(second), c.volume[second]}};
    uint32_t left = ((1u << split_count) - 1) & ~(1u << first) & ~(1u << second), in_second = 1u << second;
    while (left) {
        int remaining = __builtin_popcount(left);
        if (group[0].count + remaining == least_entries) break;
        if (group[1].count + remaining == least_entries) return in_second | left;
        alignas(16) float growth[2][padded];
        growths(c, group, growth);
        int next = __builtin_ctz(left);
        float most = -1;
        for (uint32_t rest = left; rest;) {
            int i = take_bit(rest);
            float difference = absolute(growth[0][i] - growth[1][i]);
            if (difference > most) most = difference, next = i;
        }
        float by = growth[1][next] - growth[0][next];
        if (by == 0) by = group[1].volume - group[0].volume;
        if (by == 0) by = static_cast<float>(group[1].count - group[0].count);
        int g = by < 0 ? 1 : 0;
        group[g].add(c, next);
        left &= ~(1u << next);
        if (g == 1) in_second |= 1u << next;
    }
    return in_second;
}

// ---------------------------------------------------------------------------------------------------------------------
// R*

namespace {

struct GroupBounds {
    float lower[3] = {infinity, infinity, infinity}, upper[3] = {-infinity, -infinity, -infinity};
    void include(const RtreeEntry& e) {
        for (int d = 0; d < 3; ++d) {
            lower[d] = minimum(e.lower[d], lower[d]);
            upper[d] = maximum(e.upper[d], upper[d]);
        }
    }
    float margin() const { return (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]); }
    float volume() const { return (upper[0] - lower[0]) * (upper[1] - lower[1]) * (upper[2] - lower[2]); }
};

float overlap_volume(const GroupBounds& a, const GroupBounds& b) {
    float product = 1;
    for (int d = 0; d < 3; ++d) {
        float edge = minimum(a.upper[d], b.upper[d]) - maximum(a.lower[d], b.lower[d]);
        if (!(edge > 0)) return 0;
        product *= edge;
    }
    return product;
}

// The entries in the order of one side of one axis, ties in their own order; bounds of all heads and tails.
struct SortedEntries {
    int order[split_count];
    GroupBounds head[split_count + 1], tail[split_count + 1];  // of the first k, of those from k on

    SortedEntries(const RtreeEntry entries[split_count], int axis, bool by_upper) {
        float key[split_count];
        for (int i = 0; i < split_count; ++i) {
            float k = by_upper ? entries[i].upper[axis] : entries[i].lower[axis];
            int at = i;
            for (; at > 0 && key[at - 1] > k; --at) key[at] = key[at - 1], order[at] = order[at - 1];
            key[at] = k;
            order[at] = i;
        }
        for (int k = 0; k < split_count; ++k) {
            head[k + 1] = head[k];
            head[k + 1].include(entries[order[k]]);
        }
        for (int k = split_count - 1; k >= 0; --k) {
            tail[k] = tail[k + 1];
            tail[k].include(entries[order[k]]);
        }
    }
};

}  // namespace

uint32_t split_star(const RtreeEntry entries[split_count]) {
    float least_margin = infinity, least_overlap = infinity, least_volume = infinity;
    uint32_t best = 0b111;
    for (int axis = 0; axis < 3; ++axis) {
        const SortedEntries sorted[2] = {{entries, axis, false}, {entries, axis, true}};
        float margin = 0;
        for (const SortedEntries& s : sorted) {
            for (int k = least_entries; k <= split_count - least_entries; ++k) {
                margin += s.head[k].margin() + s.tail[k].margin();
            }
        }
        if (axis > 0 && !(margin < least_margin)) continue;
        least_margin = margin;
        least_overlap = least_volume = infinity;
        for (const SortedEntries& s : sorted) {
            uint32_t in_tail = (1u << split_count) - 1;
            for (int k = 0; k <= split_count - least_entries; in_tail &= ~(1u << s.order[k]), ++k) {
                if (k < least_entries) continue;
                float overlap = overlap_volume(s.head[k], s.tail[k]);
                float volume = s.head[k].volume() + s.tail[k].volume();
                if (overlap > least_overlap || (overlap == least_overlap && !(volume < least_volume))) continue;
                least_overlap = overlap;
                least_volume = volume;
                best = in_tail;
            }
        }
    }
    return best;
}

// ---------------------------------------------------------------------------------------------------------------------
// Choosing a child

namespace {

struct Growths {
    alignas(16) float growth[block_size];
    alignas(16) float volume[block_size];
    alignas(16) float edges[block_size];

    Growths(const BoxBlock& block, const WideBox& box) {
        for (int half = 0; half < block_size; half += 4) {
            Float4 joined = splat<Float4>(1.0f), own = splat<Float4>(1.0f), longer = splat<Float4>(0.0f);
            for (int d = 0; d < 3; ++d) {
                Float4 low = load_wide<Float4>(block.lower[d] + half), high = load_wide<Float4>(block.upper[d] + half);
                Float4 edge = high - low, joined_edge = maximum(high, box.upper[d]) - minimum(low, box.lower[d]);
                joined = joined * joined_edge;
                own = own * edge;
                longer = longer + (joined_edge - edge);
            }
            store_wide(growth + half, joined - own);
            store_wide(volume + half, own);
            store_wide(edges + half, longer);
        }
    }
    // Of two children with equal growth of what counts first.
    bool better(int k, int than) const {
        if (growth[k] != growth[than]) return growth[k] < growth[than];
        if (volume[k] != volume[than]) return volume[k] < volume[than];
        return edges[k] < edges[than];
    }
};

}  // namespace

int choose_least_growth(const BoxBlock& block, int count, const float lower[3], const float upper[3]) {
    const Growths g(block, spread(lower, upper));
    int best = 0;
    float least = g.growth[0];
    for (int k = 1; k < count; ++k) {
        if (g.growth[k] > least || (g.growth[k] == least && !g.better(k, best))) continue;
        best = k;
        least = g.growth[k];
    }
    return best;
}

namespace {

// Sum of the overlaps of a box with the children of a node other than `but`.
float overlap_with_siblings(const BoxBlock& block, const WideBox& box, int but) {
    alignas(16) float volumes[block_size];
    for (int half = 0; half < block_size; half += 4) {
        Float4 product = splat<Float4>(1.0f);
        for (int d = 0; d < 3; ++d) {
            Float4 edge = minimum(load_wide<Float4>(block.upper[d] + half), box.upper[d]) -
                          maximum(load_wide<Float4>(block.lower[d] + half), box.lower[d]);
            product = product * maximum(edge, splat<Float4>(0.0f));
        }
        store_wide(volumes + half, product);
    }
    volumes[but] = 0;
    return ((volumes[0] + volumes[1]) + (volumes[2] + volumes[3])) +
           ((volumes[4] + volumes[5]) + (volumes[6] + volumes[7]));
}

}  // namespace

int choose_least_overlap(const BoxBlock& block, int count, const float lower[3], const float upper[3]) {
    const WideBox box = spread(lower, upper);
    const Growths g(block, box);
    int best = choose_least_growth(block, count, lower, upper);
    if (g.growth[best] == 0 && g.edges[best] == 0) return best;  // it fits: no overlap grows
    float least = infinity;
    best = 0;
    for (int k = 0; k < count; ++k) {
        WideBox own = spread_lane(block, k), joined;
        for (int d = 0; d < 3; ++d) {
            joined.lower[d] = minimum(box.lower[d], own.lower[d]);
            joined.upper[d] = maximum(box.upper[d], own.upper[d]);
        }
        float growth = overlap_with_siblings(block, joined, k) - overlap_with_siblings(block, own, k);
        if (growth > least || (growth == least && !g.better(k, best))) continue;
        least = growth;
        best = k;
    }
    return best;
}

}  // namespace lendulet
