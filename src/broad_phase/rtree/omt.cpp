#include "broad_phase/rtree/omt.h"

#include <algorithm>
#include <cfloat>
#include <cstring>

#include "math/wide/wide.h"

namespace lendulet {

namespace {

using Int4 = Wide<int32_t, 4>;

// Boxes are moved as whole vectors: one moved in pieces and read again as a whole at once stalls the processor.
LENDULET_FORCE_INLINE Int4 load(const BoxCentre* box) {
    static_assert(sizeof(BoxCentre) == sizeof(Int4));
    Int4 words;
    std::memcpy(&words, box, sizeof words);
    return words;
}
LENDULET_FORCE_INLINE void store(BoxCentre* box, Int4 words) { std::memcpy(box, &words, sizeof words); }

LENDULET_FORCE_INLINE int64_t key_of(const BoxCentre& box, int axis) {
    return static_cast<int64_t>(box.at[axis]) * (int64_t{1} << 32) + box.slot;
}

constexpr int rank_capacity = 32;
constexpr int few = 24;  // measured: partitioning more is faster than ranking them

// rank[i] = how many of the boxes come before box i, for a few boxes, by comparing each with each: no branch depends on
// the data, which beats any sort of so few.
template <class BoxAt>
void count_ranks(BoxAt&& box_at, int count, int axis, int32_t rank[rank_capacity]) {
    alignas(16) int32_t at[rank_capacity];
    alignas(16) int32_t slot[rank_capacity];
    for (int i = 0; i < count; ++i) {
        at[i] = box_at(i).at[axis];
        slot[i] = static_cast<int32_t>(box_at(i).slot);
    }
    for (int i = count; i % 4; ++i) at[i] = 0, slot[i] = 0;  // their ranks are not read
    for (int i = 0; i < count; i += 4) {
        Int4 my_at, my_slot, smaller{};
        std::memcpy(&my_at, at + i, sizeof my_at);
        std::memcpy(&my_slot, slot + i, sizeof my_slot);
        for (int j = 0; j < count; ++j) {
            Int4 other = Int4{} + at[j];
            smaller -= (other < my_at) | ((other == my_at) & (Int4{} + slot[j] < my_slot));  // true is -1
        }
        std::memcpy(rank + i, &smaller, sizeof smaller);
    }
}

void select_of_few(BoxCentre* boxes, int count, int wanted, int axis) {
    alignas(16) int32_t rank[rank_capacity];
    count_ranks([&](int i) -> const BoxCentre& { return boxes[i]; }, count, axis, rank);
    BoxCentre later[rank_capacity];
    int below = 0, above = 0;
    for (int i = 0; i < count; ++i) {
        Int4 box = load(boxes + i);
        bool first = rank[i] < wanted;
        store(later + above, box);
        store(boxes + below, box);  // below <= i, and box i is already read
        below += first;
        above += !first;
    }
    for (int i = 0; i < above; ++i) store(boxes + below + i, load(later + i));
}

// A pivot such that the `wanted` smallest end just inside the smaller side: a sample's element of that rank, moved
// outwards by about one standard deviation (the idea of SELECT, Floyd and Rivest 1975). The element is never the first
// or last of the sample, so both sides of the partition are smaller than the whole.
int64_t choose_pivot(const BoxCentre* boxes, int count, int wanted, int axis) {
    int size = count < 256 ? 12 : 28;
    int margin = count < 256 ? 1 : 2;
    int stride = count / size;
    auto place = [&](int i) { return i * stride + stride / 2; };
    alignas(16) int32_t rank[rank_capacity];
    count_ranks([&](int i) -> const BoxCentre& { return boxes[place(i)]; }, size, axis, rank);
    int target = static_cast<int>(static_cast<int64_t>(wanted) * size / count);
    target += 2 * wanted <= count ? margin : -margin;
    target = target < 1 ? 1 : target > size - 2 ? size - 2 : target;
    int chosen = 0;
    for (int i = 0; i < size; ++i) chosen = rank[i] == target ? i : chosen;
    return key_of(boxes[place(chosen)], axis);
}

// Moves the boxes before the pivot to the front and says how many they are. Lomuto's partition with the exchange made
// always and the border moved by the comparison: no branch to predict.
int partition(BoxCentre* boxes, int count, int64_t pivot, int axis) {
    int border = 0;
    for (int i = 0; i < count; ++i) {
        bool before = key_of(boxes[i], axis) < pivot;
        Int4 box = load(boxes + i);
        store(boxes + i, load(boxes + border));
        store(boxes + border, box);
        border += before;
    }
    return border;
}

// Axes of the three cuts of a node: each time the one along which the parts are then longest.
void choose_axes(const BoxCentre* boxes, int count, const int parts[4], int axes[3]) {
    Int4 low = Int4{} + INT32_MAX, high = Int4{} + INT32_MIN;
    for (int i = 0; i < count; ++i) {
        Int4 at = load(boxes + i);  // the fourth lane holds the slot and is not used
        low = at < low ? at : low;
        high = at > high ? at : high;
    }
    float extent[3];
    for (int d = 0; d < 3; ++d) extent[d] = 0.5f * from_ordered(high[d]) - 0.5f * from_ordered(low[d]);
    for (int cut = 0; cut < 3; ++cut) {
        int widest = extent[1] > extent[0] ? 1 : 0;
        widest = extent[2] > extent[widest] ? 2 : widest;
        axes[cut] = widest;
        extent[widest] *= static_cast<float>(parts[cut]) / static_cast<float>(parts[cut + 1]);
    }
}

}  // namespace

void select_smallest(BoxCentre* boxes, int count, int wanted, int axis) {
    // The border between the wanted and the others lies in [0, count]; each round narrows the range it can be in.
    for (int round = 0; wanted > 0 && wanted < count; ++round) {
        if (count <= few) return select_of_few(boxes, count, wanted, axis);
        constexpr int most_rounds = 40;  // a handful in practice; this bounds sets made to mislead the sample
        if (round == most_rounds) {
            auto before = [axis](const BoxCentre& a, const BoxCentre& b) { return key_of(a, axis) < key_of(b, axis); };
            return std::sort(boxes, boxes + count, before);  // a total order: slots differ
        }
        int before = partition(boxes, count, choose_pivot(boxes, count, wanted, axis), axis);
        if (wanted <= before) {
            count = before;
        } else {
            boxes += before;
            count -= before;
            wanted -= before;
        }
    }
}

// The sizes are computed from the parts up: the boxes are cut into `fan_out` parts, these are merged into
// round(fan_out^(2/3)) groups, and those into round(fan_out^(1/3)). The cuts are then made in the reverse order, each
// inside the groups of the one before. Lee and Lee take the dimensions in a fixed order; taking the longest one each
// time gives the same for a cube and spares flat scenes a cut across their thickness.
void omt_divide(BoxCentre* boxes, int count, int fan_out) {
    constexpr int two_thirds_power[9] = {0, 1, 2, 2, 3, 3, 3, 4, 4}, third_power[9] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
    const int parts[4] = {1, third_power[fan_out], two_thirds_power[fan_out], fan_out};
    if (fan_out == 1) return;
    int axes[3];
    choose_axes(boxes, count, parts, axes);
    // begin[k]: where group k of the current cut begins, counted in final parts.
    int begin[4][9] = {{0, fan_out}};
    for (int k = 0; k <= fan_out; ++k) begin[3][k] = k;
    for (int k = 0; k <= parts[2]; ++k) begin[2][k] = part_begin(fan_out, parts[2], k);
    for (int k = 0; k <= parts[1]; ++k) begin[1][k] = begin[2][part_begin(parts[2], parts[1], k)];
    for (int cut = 0; cut < 3; ++cut) {
        for (int group = 0, k = 0; group < parts[cut]; ++group) {
            int from = part_begin(count, fan_out, begin[cut][group]);
            int to = part_begin(count, fan_out, begin[cut][group + 1]);
            for (++k; begin[cut + 1][k] < begin[cut][group + 1]; ++k) {
                int border = part_begin(count, fan_out, begin[cut + 1][k]);
                select_smallest(boxes + from, to - from, border - from, axes[cut]);
                from = border;
            }
        }
    }
}

}  // namespace lendulet
