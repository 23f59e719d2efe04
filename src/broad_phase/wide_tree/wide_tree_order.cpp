#include "broad_phase/wide_tree/wide_tree_order.h"

#include <utility>

#include "broad_phase/block.h"
#include "broad_phase/wide_tree/wide_tree_kernels.h"

namespace lendulet {

namespace {

// Fewer boxes stay in the caller's order: testing their few groups against each other costs less than sorting.
constexpr int smallest_sorted = 3 * group_lanes;
// A box is large if its size is more than 2^3 times the (geometric) mean.
constexpr int large_exponents = 3;
constexpr int most_buckets = 1024;

// Which bucket a coordinate falls into. Halves, so that the range of finite numbers is finite.
struct Buckets {
    float lowest = 0, per_half = 0;
    int last = 0;

    // False where all coordinates are as good as one.
    bool set(float low, float high, int count) {
        last = (count < 256 ? 64 : count < 8192 ? 256 : most_buckets) - 1;
        lowest = 0.5f * low;
        per_half = (static_cast<float>(last) + 0.75f) / (0.5f * high - lowest);
        return per_half <= FLT_MAX;
    }
    int of(float x) const {
        float place = (0.5f * x - lowest) * per_half;  // from 0 on, but for rounding
        return place < static_cast<float>(last) ? place > 0.0f ? static_cast<int>(place) : 0 : last;
    }
};

template <class Item>
void range_along(const Item* items, int count, int axis, float& low, float& high) {
    Float4 lowest = load_wide<Float4>(items[0].at), highest = lowest;
    for (int i = 1; i < count; ++i) {
        Float4 at = load_wide<Float4>(items[i].at);
        lowest = minimum(at, lowest);
        highest = maximum(at, highest);
    }
    low = lowest[axis];
    high = highest[axis];
}

// The exponent of a size that is not negative, 0 .. 254 for finite ones.
int exponent_of(float size) {
    uint32_t bits;
    std::memcpy(&bits, &size, sizeof bits);
    return static_cast<int>(bits >> 23);
}

// Without the word behind the three: most integers are denormal floats, which some machines multiply slowly.
LENDULET_FORCE_INLINE Float4 load_bounds(const float bounds[3]) {
    using Int4 = Wide<int32_t, 4>;
    return (Float4)((Int4)load_wide<Float4>(bounds) & Int4{-1, -1, -1, 0});
}
Float4 extents(const BroadBox& box) { return load_bounds(box.upper) - load_bounds(box.lower); }
float largest(Float4 extent) { return maximum(maximum(extent[0], extent[1]), extent[2]); }

template <class Item>
LENDULET_FORCE_INLINE void copy_item(Item& to, const Item& from) {  // as a whole: a load in pieces would have to wait
    std::memcpy(&to, &from, sizeof to);
}

}  // namespace

WideTreeOrder::WideTreeOrder(const Memory* memory) : items_(memory), scratch_(memory) {}

void WideTreeOrder::sort(const BroadBox* boxes, int count, TaskPool* tasks, Array<uint32_t>& places,
                         Array<uint32_t>& unbounded) {
    int bounded = collect(boxes, count, unbounded);
    places.resize_unset(static_cast<size_t>(bounded));
    if (bounded < smallest_sorted) {
        for (int i = 0; i < bounded; ++i) places[i] = items_[i].place;
        return;
    }
    int usual = any_large_ ? part_large(boxes, bounded) : bounded;
    arrange(0, usual, tasks, places.data());
    arrange(usual, bounded - usual, tasks, places.data() + usual);
}

// The centres of the bounded boxes, their number, and the list of the others.
int WideTreeOrder::collect(const BroadBox* boxes, int count, Array<uint32_t>& unbounded) {
    unbounded.clear();
    items_.resize_unset(static_cast<size_t>(count));
    scratch_.resize_unset(static_cast<size_t>(count));
    int n = 0;
    int64_t exponents = 0;
    int top = 0;
    for (int i = 0; i < count; ++i) {
        // Halved before adding: the sum of two large floats may overflow.
        Float4 half = splat<Float4>(0.5f);
        Float4 lower = load_bounds(boxes[i].lower), upper = load_bounds(boxes[i].upper);
        const Float4 edges = upper - lower;
        if ((mask_bits(edges <= splat<Float4>(FLT_MAX)) & 7u) != 7u) {  // infinite, or NaN of two infinite sides
            unbounded.push_back(static_cast<uint32_t>(i));
            continue;
        }
        int exponent = exponent_of(largest(edges));
        exponents += exponent;
        top = exponent > top ? exponent : top;
        Float4 centre = lower * half + upper * half;
        float place;
        std::memcpy(&place, &i, sizeof place);
        centre[3] = place;
        store_wide(items_[n++].at, centre);
    }
    largest_usual_ = n ? static_cast<int>(exponents / n) + large_exponents : 0;
    any_large_ = top > largest_usual_;
    return n;
}

// Moves the large boxes behind the others; gives the number of the others.
int WideTreeOrder::part_large(const BroadBox* boxes, int count) {
    int usual = 0, large = 0;
    for (int i = 0; i < count; ++i) {
        Item item = items_[i];
        bool is_large = exponent_of(largest(extents(boxes[item.place]))) > largest_usual_;
        (is_large ? scratch_[large++] : items_[usual++]) = item;
    }
    for (int i = 0; i < large; ++i) items_[usual + i] = scratch_[i];
    return usual;
}

// How many slabs and strips make groups as long as they are wide. How far the boxes spread along an axis is judged by
// the mean deviation of a sample, three times over without what lies far out, so that a few strays do not count.
WideTreeOrder::Shape WideTreeOrder::choose_shape(const Item* items, int count) {
    constexpr int samples = 128;
    const int size = count < samples ? count : samples, stride = count / size;
    Float4 at[samples], spread = splat<Float4>(infinity), middle = splat<Float4>(0);
    for (int i = 0; i < size; ++i) {
        at[i] = load_wide<Float4>(items[i * stride].at) * splat<Float4>(1.0f / samples);
        at[i][3] = 0;
    }
    for (int pass = 0; pass < 4; ++pass) {
        Float4 sum = splat<Float4>(0), far = splat<Float4>(0), n = splat<Float4>(0);
        for (int i = 0; i < size; ++i) {
            auto near = absolute(at[i] - middle) <= spread * splat<Float4>(3.0f);
            n += select(near, splat<Float4>(1.0f), splat<Float4>(0.0f));
            sum += select(near, at[i], splat<Float4>(0.0f));
            far += select(near, absolute(at[i] - middle), splat<Float4>(0.0f));
        }
        n = maximum(n, splat<Float4>(1.0f));
        middle = sum / n;
        if (pass > 0) spread = far / n;
    }
    Shape shape{1, 1, {0, 1, 2}};
    auto swap_if = [&](int i, int j) {
        if (spread[shape.axis[i]] > spread[shape.axis[j]]) std::swap(shape.axis[i], shape.axis[j]);
    };
    swap_if(0, 1), swap_if(1, 2), swap_if(0, 1);  // the shortest first
    double a = spread[shape.axis[0]], b = spread[shape.axis[1]], c = spread[shape.axis[2]];
    double groups = static_cast<double>(count) / group_lanes;
    // A slab is as thick as a strip is wide and a group long: slabs^3 = groups a^2 / (b c), rounded.
    auto cubed = [](double x) { return x * x * x; };
    while (shape.slabs < most_parts && cubed(shape.slabs + 0.5) * b * c < groups * a * a) ++shape.slabs;
    double each = groups / shape.slabs;
    while (shape.strips < most_parts && (shape.strips + 0.5) * (shape.strips + 0.5) * c < each * b) ++shape.strips;
    return shape;
}

// Sorts along an axis by buckets; buckets that hold more than `most_together` are sorted by themselves, so a swarm that
// is tiny beside the whole is resolved as well.
void WideTreeOrder::sort_along(Item* items, Item* scratch, int count, int axis, int most_together) {
    if (count < 2) return;
    float low, high;
    range_along(items, count, axis, low, high);
    Buckets buckets;
    if (!buckets.set(low, high, count)) return;
    int at[most_buckets + 1] = {};
    for (int i = 0; i < count; ++i) ++at[buckets.of(items[i].at[axis])];
    int begin = 0;
    bool crowded = false;
    for (int b = 0; b <= buckets.last; ++b) {
        crowded |= at[b] > most_together;
        begin += std::exchange(at[b], begin);
    }
    for (int i = 0; i < count; ++i) copy_item(scratch[at[buckets.of(items[i].at[axis])]++], items[i]);
    std::memcpy(static_cast<void*>(items), scratch, static_cast<size_t>(count) * sizeof(Item));
    if (!crowded) return;
    for (int b = 0, from = 0; b <= buckets.last; from = at[b++]) {  // at[b] is now where bucket b ends
        int n = at[b] - from;
        if (n > most_together && n < count) sort_along(items + from, scratch + from, n, axis, most_together);
    }
}

// Parts of about equal size along an axis, from `items` to `scratch`.
void WideTreeOrder::cut(Item* items, Item* scratch, int count, int axis, int parts, Cuts& cuts) {
    cuts.begin[parts] = count;
    auto even = [&](int part) { return static_cast<int>(static_cast<int64_t>(count) * part / parts); };
    float low, high;
    range_along(items, count, axis, low, high);
    Buckets buckets;
    bool crowded = parts > 1 && !buckets.set(low, high, count);
    int at[most_buckets] = {};
    if (parts > 1 && !crowded) {
        for (int i = 0; i < count; ++i) ++at[buckets.of(items[i].at[axis])];
        for (int b = 0; b <= buckets.last; ++b) crowded |= static_cast<int64_t>(at[b]) * 2 * parts > count;
    }
    if (parts == 1 || crowded) {
        if (crowded) sort_along(items, scratch, count, axis, 1 + count / (4 * parts));
        for (int p = 0; p < parts; ++p) cuts.begin[p] = even(p);
        std::memcpy(static_cast<void*>(scratch), items, static_cast<size_t>(count) * sizeof(Item));
        return;
    }
    // Whole buckets go to parts: the part of a bucket is that of its middle box.
    uint8_t part_of[most_buckets];
    int part = -1, begin = 0;
    for (int b = 0; b <= buckets.last; ++b) {
        int own = static_cast<int>((begin + at[b] / 2) * static_cast<int64_t>(parts) / count);
        own = own < parts ? own : parts - 1;
        while (part < own) cuts.begin[++part] = begin;
        part_of[b] = static_cast<uint8_t>(own);
        begin += at[b];
    }
    while (part < parts - 1) cuts.begin[++part] = count;
    int next[most_parts];
    for (int p = 0; p < parts; ++p) next[p] = cuts.begin[p];
    for (int i = 0; i < count; ++i) copy_item(scratch[next[part_of[buckets.of(items[i].at[axis])]]++], items[i]);
}

void WideTreeOrder::arrange(int begin, int count, TaskPool* tasks, uint32_t* places) {
    if (count == 0) return;
    Item *items = items_.data() + begin, *scratch = scratch_.data() + begin;
    Shape shape = choose_shape(items, count);
    Cuts slabs;
    cut(items, scratch, count, shape.axis[0], shape.slabs, slabs);
    auto work = [&](int first, int last, int) {
        for (int s = first; s < last; ++s) {
            int from = slabs.begin[s], n = slabs.begin[s + 1] - from;
            if (n) arrange_slab(scratch + from, items + from, n, shape, s % 2 == 1, places + from);
        }
    };
    if (tasks) tasks->for_each(shape.slabs, 1, work);
    else work(0, shape.slabs, 0);
}

void WideTreeOrder::arrange_slab(Item* items, Item* scratch, int count, const Shape& shape, bool backwards,
                                 uint32_t* places) {
    Cuts strips;
    cut(items, scratch, count, shape.axis[1], shape.strips, strips);
    for (int k = 0; k < shape.strips; ++k) {
        int s = backwards ? shape.strips - 1 - k : k;
        int from = strips.begin[s], n = strips.begin[s + 1] - from;
        sort_along(scratch + from, items + from, n, shape.axis[2], group_lanes / 2);
        bool reverse = (s + backwards) % 2 == 1;
        for (int i = 0; i < n; ++i) places[i] = scratch[from + (reverse ? n - 1 - i : i)].place;
        places += n;
    }
}

}  // namespace lendulet
