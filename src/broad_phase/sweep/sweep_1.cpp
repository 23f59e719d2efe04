#include "broad_phase/sweep/sweep_1.h"

namespace lendulet {

namespace {

struct Scatter {
    double count[3] = {}, sum[3] = {}, squares[3] = {};

    double variance(int d) const { return count[d] > 0 ? squares[d] - sum[d] / count[d] * sum[d] : 0; }
};

// Of the centres, in double, so that boxes as far out as floats go do not overflow. `some_infinite`: on each axis only
// of those that are finite there, neither infinite on a side nor NaN from both.
template <bool some_infinite>
Scatter scatter_of(const BroadBox* boxes, int count) {
    Scatter scatter;
    for (double& n : scatter.count) n = some_infinite ? 0 : count;
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < 3; ++d) {
            double centre = 0.5 * boxes[i].lower[d] + 0.5 * boxes[i].upper[d];
            if (some_infinite) {
                bool finite = centre - centre == 0;
                centre = finite ? centre : 0;
                scatter.count[d] += finite;
            }
            scatter.sum[d] += centre;
            scatter.squares[d] += centre * centre;
        }
    }
    return scatter;
}

// The axis along which the centres of the bounded boxes have the largest variance. Another axis replaces the current
// one only if clearly better: a change sorts both lists anew.
int axis_of_largest_variance(const BroadBox* boxes, int count, int current) {
    Scatter scatter = scatter_of<false>(boxes, count);
    double all = scatter.sum[0] + scatter.sum[1] + scatter.sum[2];
    if (!(all - all == 0)) scatter = scatter_of<true>(boxes, count);
    double variance[3];
    for (int d = 0; d < 3; ++d) variance[d] = scatter.variance(d);
    int best = current;
    for (int d = 0; d < 3; ++d) {
        if (variance[d] > 1.2 * variance[current] && variance[d] > variance[best]) best = d;
    }
    return best;
}

// Appends the pairs of box i of one list with the boxes of another, from place `first` on, that begin before it ends.
void sweep_from(const SweepList& from, int i, const SweepList& over, int first, PairList& out) {
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

constexpr int grain = 128;

}  // namespace

void Sweep1::set_fixed(const BroadBox* boxes, int count, TaskPool*) {
    fixed_boxes_.clear();
    fixed_boxes_.append(boxes, static_cast<size_t>(count));
    fixed_.assign(boxes, count, axis_);
    changes_.forget();
}

void Sweep1::set_moving(const BroadBox* boxes, int count, TaskPool*) {
    moving_boxes_.clear();
    moving_boxes_.append(boxes, static_cast<size_t>(count));
    constexpr int handful = 16;  // each of them meets a vector or two of others, whichever way they are sorted
    if (count > handful) axis_ = axis_of_largest_variance(boxes, count, axis_);
    moving_.assign(boxes, count, axis_);
    if (fixed_.axis != axis_) fixed_.assign(fixed_boxes_.data(), fixed_boxes_.count(), axis_);
    changes_.forget();
}

void Sweep1::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    chunks_.search(tasks, moving_.count(), grain, out, [&](int begin, int end, PairList& list) {
        for (int i = begin; i < end; ++i) sweep_from(moving_, i, moving_, i + 1, list);
    });
    sweep_lists(tasks, moving_, fixed_, out);
}

// Two boxes of different lists are found from the one that begins first; from that of list a if both begin together.
void Sweep1::sweep_lists(TaskPool& tasks, const SweepList& a, const SweepList& b, Array<BoxPair>& out) {
    if (a.count() == 0 || b.count() == 0) return;
    chunks_.search(tasks, a.count(), grain, out, [&](int begin, int end, PairList& list) {
        int place = b.first_at_or_after(a.lower[0][begin]);
        for (int i = begin; i < end; ++i) {
            while (place < b.count() && b.lower[0][place] < a.lower[0][i]) ++place;
            sweep_from(a, i, b, place, list);
        }
    });
    chunks_.search(tasks, b.count(), grain, out, [&](int begin, int end, PairList& list) {
        int place = a.first_after(b.lower[0][begin]);
        for (int i = begin; i < end; ++i) {
            while (place < a.count() && a.lower[0][place] <= b.lower[0][i]) ++place;
            sweep_from(b, i, a, place, list);
        }
    });
}

void Sweep1::find_pairs_of(TaskPool& tasks, const BroadBox* boxes, int count, Array<BoxPair>& out) {
    asked_.assign(boxes, count, axis_);
    sweep_lists(tasks, asked_, moving_, out);
    sweep_lists(tasks, asked_, fixed_, out);
}

void Sweep1::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                    Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 5;  // the changed boxes are swept twice, before and after, and from both sides
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

void Sweep1::cast(BoxCast& cast) const {
    moving_.offer_to(cast);
    fixed_.offer_to(cast);
}

void Sweep1::nearest(NearestBox& nearest) const {
    moving_.offer_to(nearest);
    fixed_.offer_to(nearest);
}

void Sweep1::boxes(Array<BroadPhaseBox>& out) const {
    moving_.append_boxes(out);
    fixed_.append_boxes(out);
}

size_t Sweep1::bytes() const {
    return fixed_.bytes() + moving_.bytes() + asked_.bytes() + fixed_boxes_.bytes() + moving_boxes_.bytes() +
           chunks_.bytes() + changes_.bytes();
}

const char* Sweep1::check() const {
    if (fixed_.axis != moving_.axis && fixed_.count() > 0) return "the lists are sorted along different axes";
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

}  // namespace lendulet
