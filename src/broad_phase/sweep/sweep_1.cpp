#include "broad_phase/sweep/sweep_1.h"

#include <algorithm>

#include "broad_phase/sort.h"

namespace lendulet {

namespace {

// The axis along which the centres of the bounded boxes have the largest variance, in double, so that boxes as far out
// as floats go do not overflow. Another axis replaces the current one only if clearly better: a change sorts the fixed
// boxes anew.
int axis_of_largest_variance(const BroadBox* boxes, int count, int current) {
    double variance[3];
    for (int d = 0; d < 3; ++d) {
        double sum = 0, squares = 0;
        int bounded = 0;
        for (int i = 0; i < count; ++i) {
            double centre = 0.5 * boxes[i].lower[d] + 0.5 * boxes[i].upper[d];
            if (!(centre - centre == 0)) continue;  // infinite on a side, or NaN from both
            sum += centre;
            squares += centre * centre;
            ++bounded;
        }
        variance[d] = bounded ? squares - sum / bounded * sum : 0;
    }
    int best = current;
    for (int d = 0; d < 3; ++d) {
        if (variance[d] > 1.2 * variance[current] && variance[d] > variance[best]) best = d;
    }
    return best;
}

constexpr size_t padding = 4;  // a vector may be read past the last box; its lanes are masked

}  // namespace

Sweep1::Sorted::Sorted(const Memory* memory) : index(memory) {
    for (int d = 0; d < 3; ++d) {
        lower[d].set_memory(memory);
        upper[d].set_memory(memory);
    }
}

void Sweep1::Sorted::coordinates(int i, float box_lower[3], float box_upper[3]) const {
    for (int d = 0; d < 3; ++d) {
        box_lower[(axis + d) % 3] = lower[d][i];
        box_upper[(axis + d) % 3] = upper[d][i];
    }
}

int Sweep1::Sorted::first_at_or_after(float x) const {
    return static_cast<int>(std::lower_bound(lower[0].data(), lower[0].data() + count(), x) - lower[0].data());
}
int Sweep1::Sorted::first_after(float x) const {
    return static_cast<int>(std::upper_bound(lower[0].data(), lower[0].data() + count(), x) - lower[0].data());
}

size_t Sweep1::Sorted::bytes() const {
    size_t sum = index.bytes();
    for (int d = 0; d < 3; ++d) sum += lower[d].bytes() + upper[d].bytes();
    return sum;
}

void Sweep1::sort_into(Sorted& set, const BroadBox* boxes, int count) {
    size_t n = static_cast<size_t>(count);
    keys_.resize_unset(n);
    for (size_t i = 0; i < n; ++i) keys_[i] = uint64_t{ordered_bits(boxes[i].lower[axis_])} << 32 | i;
    sort_keys(keys_, keys_swap_, 32);
    set.axis = axis_;
    set.index.resize_unset(n);
    for (int d = 0; d < 3; ++d) {
        set.lower[d].resize_unset(n + padding);
        set.upper[d].resize_unset(n + padding);
        for (size_t i = n; i < n + padding; ++i) set.lower[d][i] = set.upper[d][i] = 0;
    }
    for (size_t i = 0; i < n; ++i) {
        const BroadBox& box = boxes[static_cast<uint32_t>(keys_[i])];
        set.index[i] = box.index;
        for (int d = 0; d < 3; ++d) {
            set.lower[d][i] = box.lower[(axis_ + d) % 3];
            set.upper[d][i] = box.upper[(axis_ + d) % 3];
        }
    }
}

void Sweep1::set_fixed(const BroadBox* boxes, int count, TaskPool*) {
    fixed_boxes_.clear();
    fixed_boxes_.append(boxes, static_cast<size_t>(count));
    sort_into(fixed_, boxes, count);
    changes_.forget();
}

void Sweep1::set_moving(const BroadBox* boxes, int count, TaskPool*) {
    moving_boxes_.clear();
    moving_boxes_.append(boxes, static_cast<size_t>(count));
    axis_ = axis_of_largest_variance(boxes, count, axis_);
    sort_into(moving_, boxes, count);
    if (fixed_.axis != axis_) sort_into(fixed_, fixed_boxes_.data(), fixed_boxes_.count());
    changes_.forget();
}

// Appends the pairs of box i of one list with the boxes of another, from place `first` on, that begin before it ends.
void Sweep1::sweep_from(const Sorted& from, int i, const Sorted& over, int first, PairList& out) {
    const float* starts = over.lower[0].data();
    float end = from.upper[0][i];
    int count = over.count();
    if (first >= count || starts[first] > end) return;
    const float lower[3] = {from.lower[0][i], from.lower[1][i], from.lower[2][i]};
    const float upper[3] = {end, from.upper[1][i], from.upper[2][i]};
    const WideBox box = spread(lower, upper);
    uint32_t index = from.index[i];
    for (int j = first; j < count && starts[j] <= end; j += 4) {
        auto hit = load_wide<Float4>(starts + j) <= box.upper[0];
        for (int d = 1; d < 3; ++d) {
            hit &= load_wide<Float4>(over.lower[d].data() + j) <= box.upper[d];
            hit &= load_wide<Float4>(over.upper[d].data() + j) >= box.lower[d];
        }
        uint32_t hits = mask_bits(hit);
        if (hits == 0) continue;
        if (count - j < 4) hits &= (1u << (count - j)) - 1;
        PairWriter writer(out, 4);
        while (hits) writer.write(index, over.index[j + take_bit(hits)]);
    }
}

void Sweep1::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    constexpr int grain = 128;
    // A moving and a fixed box are found from the one that begins first; from the moving one if both begin together.
    chunks_.search(tasks, moving_.count(), grain, out, [&](int begin, int end, PairList& list) {
        int place = fixed_.first_at_or_after(moving_.lower[0][begin]);
        for (int i = begin; i < end; ++i) {
            sweep_from(moving_, i, moving_, i + 1, list);
            while (place < fixed_.count() && fixed_.lower[0][place] < moving_.lower[0][i]) ++place;
            sweep_from(moving_, i, fixed_, place, list);
        }
    });
    chunks_.search(tasks, fixed_.count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int j = begin; j < end; ++j) sweep_from(fixed_, j, moving_, moving_.first_after(fixed_.lower[0][j]), list);
    });
}

void Sweep1::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                    Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 16;
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

template <class Query>
void Sweep1::offer_all(Query& query) const {
    for (const Sorted* set : {&moving_, &fixed_}) {
        for (int i = 0; i < set->count(); ++i) {
            float lower[3], upper[3];
            set->coordinates(i, lower, upper);
            query.offer(measure(query, lower, upper), set->index[i]);
        }
    }
}

void Sweep1::cast(BoxCast& cast) const { offer_all(cast); }
void Sweep1::nearest(NearestBox& nearest) const { offer_all(nearest); }

void Sweep1::boxes(Array<BroadPhaseBox>& out) const {
    for (const Sorted* set : {&moving_, &fixed_}) {
        for (int i = 0; i < set->count(); ++i) {
            BroadPhaseBox box{{}, {}, 0, true, set->index[i]};
            set->coordinates(i, box.lower, box.upper);
            out.push_back(box);
        }
    }
}

size_t Sweep1::bytes() const {
    return fixed_.bytes() + moving_.bytes() + fixed_boxes_.bytes() + moving_boxes_.bytes() + keys_.bytes() +
           keys_swap_.bytes() + chunks_.bytes() + changes_.bytes();
}

const char* Sweep1::check() const {
    for (const Sorted* set : {&moving_, &fixed_}) {
        for (int i = 1; i < set->count(); ++i) {
            if (set->lower[0][i] < set->lower[0][i - 1]) return "boxes are not sorted along the axis";
        }
    }
    return "";
}

}  // namespace lendulet
