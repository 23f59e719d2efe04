// The sorted boxes of a sweep and the queries that go through them.
#include <algorithm>

#include "broad_phase/block_fill.h"
#include "broad_phase/sweep/sweep_1.h"

namespace lendulet {

namespace {

constexpr size_t padding = 4;  // a vector may be read past the last box; its lanes are masked

}  // namespace

SweepList::SweepList(const Memory* memory) : reach(memory), index(memory), order(memory) {
    for (int d = 0; d < 3; ++d) {
        lower[d].set_memory(memory);
        upper[d].set_memory(memory);
    }
}

int SweepList::first_at_or_after(float x) const {
    return static_cast<int>(std::lower_bound(lower[0].data(), lower[0].data() + count(), x) - lower[0].data());
}
int SweepList::first_after(float x) const {
    return static_cast<int>(std::upper_bound(lower[0].data(), lower[0].data() + count(), x) - lower[0].data());
}

void SweepList::assign(const BroadBox* boxes, int count, int along) {
    size_t n = static_cast<size_t>(count);
    axis = along;
    order.sort(count, [&](uint32_t place) { return boxes[place].lower[along]; });
    index.resize_unset(n + padding);
    float *low[3], *high[3];
    for (int d = 0; d < 3; ++d) {
        lower[d].resize_unset(n + padding);
        upper[d].resize_unset(n + padding);
        low[d] = lower[d].data();
        high[d] = upper[d].data();
    }
    for (int i = 0; i < count; i += 4) {
        Float4 four_low[4], four_high[4];
        for (int k = 0; k < 4; ++k) {
            const BroadBox& box = boxes[order.place(i + k < count ? i + k : count - 1)];
            four_low[k] = load_wide<Float4>(box.lower);
            four_high[k] = load_wide<Float4>(box.upper);
        }
        turn_quad(four_low, four_high);
        for (int d = 0; d < 3; ++d) {
            store_wide(low[column(d)] + i, four_low[d]);
            store_wide(high[column(d)] + i, four_high[d]);
        }
        std::memcpy(index.data() + i, &four_low[3], sizeof four_low[3]);  // the word behind `lower` is the index
    }
    index.resize_unset(n);
    for (int d = 0; d < 3; ++d) {
        for (size_t i = n; i < n + padding; ++i) low[d][i] = high[d][i] = 0;
    }
    reach.resize_unset((n + run - 1) / run);
    for (size_t r = 0; r < reach.size(); ++r) {
        const float* ends = high[0] + r * run;
        const size_t left = n - r * run < run ? n - r * run : run;
        Float4 four = splat<Float4>(-infinity);
        for (size_t i = 0; i + 4 <= left; i += 4) four = maximum(load_wide<Float4>(ends + i), four);
        float farthest = maximum(maximum(four[0], four[1]), maximum(four[2], four[3]));
        for (size_t i = left & ~size_t{3}; i < left; ++i) farthest = maximum(ends[i], farthest);
        reach[r] = farthest;
    }
}

// Runs that cannot better the best hit, by their extent on the axis alone, are passed over.
template <class Query>
void SweepList::offer_to(Query& query) const {
    float low[3] = {-infinity, -infinity, -infinity}, high[3] = {infinity, infinity, infinity};
    for (int begin = 0; begin < count(); begin += run) {
        low[axis] = lower[0][begin];
        high[axis] = reach[begin / run];
        if (measure(query, low, high) > limit(query)) continue;
        int stop = begin + run < count() ? begin + run : count();
        for (int i = begin; i < stop; i += 4) {
            Float4 four_low[3], four_high[3];
            for (int d = 0; d < 3; ++d) {
                four_low[d] = load_wide<Float4>(lower[column(d)].data() + i);
                four_high[d] = load_wide<Float4>(upper[column(d)].data() + i);
            }
            Float4 at = measure_wide(query, four_low, four_high);
            for (int k = 0; k < 4 && i + k < stop; ++k) query.offer(at[k], index[i + k]);
        }
    }
}
template void SweepList::offer_to(BoxCast&) const;
template void SweepList::offer_to(NearestBox&) const;

void SweepList::append_boxes(Array<BroadPhaseBox>& out) const {
    for (int i = 0; i < count(); ++i) {
        BroadPhaseBox box{{}, {}, 0, true, index[i]};
        for (int d = 0; d < 3; ++d) {
            box.lower[d] = lower[column(d)][i];
            box.upper[d] = upper[column(d)][i];
        }
        out.push_back(box);
    }
}

size_t SweepList::bytes() const {
    size_t sum = index.bytes() + reach.bytes() + order.bytes();
    for (int d = 0; d < 3; ++d) sum += lower[d].bytes() + upper[d].bytes();
    return sum;
}

const char* SweepList::check() const {
    if (!order.sorted()) return "the order of the boxes is not kept";
    for (int i = 0; i < count(); ++i) {
        if (i > 0 && lower[0][i] < lower[0][i - 1]) return "boxes are not sorted along the axis";
        if (upper[0][i] > reach[i / run]) return "a box ends behind its run";
    }
    return "";
}

}  // namespace lendulet
