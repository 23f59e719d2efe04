// Part of wide_tree_kernels.inl: pairs that begin and end. Which do follows from the boxes of before and after alone,
// so no list of pairs is kept. While the changes are searched, the lane of a changed box holds the box around both.

LENDULET_FORCE_INLINE bool meet(const BroadBox& a, const BroadBox& b) {
    auto quad = [](const float* p) { return load_wide<Quad>(p); };
    auto hit = (quad(a.lower) <= quad(b.upper)) & (quad(b.lower) <= quad(a.upper));
    return (mask_bits(hit) & 7) == 7;  // the fourth lane is no bound
}

// Up to 64 changes of the moving set and the tree they are searched in.
template <class F>
class ChangeSearch : public BatchSearch<F, ChangeSearch<F>> {
    using Base = BatchSearch<F, ChangeSearch<F>>;
    using typename Base::List;

public:
    // `in_moving`: the tree is that of the moving set, with changed boxes of its own.
    ChangeSearch(const WideTreeView& tree, const WideTreeChanges& changes, bool in_moving, PairStream& out)
        : Base(tree), changes_(changes), in_moving_(in_moving), out_(out) {}

    void search(int first, int count) {
        first_ = first;
        for (int i = 0; i < count; ++i) {
            const WideTreeChange& change = changes_.rows[first + i];
            auto quad = [](const float* p) { return load_wide<Quad>(p); };
            this->set(i, minimum(quad(change.after.lower), quad(change.before.lower)),
                      maximum(quad(change.after.upper), quad(change.before.upper)));
        }
        this->run(count);
    }

private:
    friend Base;

    // What a change meets in a group: boxes that did not change and were or are met, not both; changed ones that have
    // to be looked at; all that are met now.
    struct Hits {
        uint64_t differ, changed, now;
        uint32_t entry;
    };

    void look(const List& list) {
        Hits hits[List::most];
        int n = 0;
        for (int i = 0; i < list.count; ++i) {
            const int row = Base::row_of(list.at[i]) + first_, g = Base::node_of(list.at[i]);
            const WideTreeChange& change = changes_.rows[row];
            const Spread<F> before = spread<F>(change.before), after = spread<F>(change.after);
            const BoxGroup& group = this->tree_.groups[g];
            uint64_t was = 0, is = 0;
            for (int k = 0; k < group_lanes; k += lanes_of<F>) {
                was |= uint64_t{overlaps<F>(group.bounds[0] + k, group_lanes, before)} << k;
                is |= uint64_t{overlaps<F>(group.bounds[0] + k, group_lanes, after)} << k;
            }
            uint64_t changed = in_moving_ ? changes_.changed[g] : 0;
            hits[n] = {(was ^ is) & ~changed, (was | is) & changed & later(row, g), is, list.at[i]};
            n += (hits[n].differ | hits[n].changed) != 0;
        }
        for (int i = 0; i < n; ++i) write(hits[i]);
    }

    // Of two changed boxes the one in the earlier lane looks at the other.
    uint64_t later(int row, int g) const {
        const int lane = static_cast<int>(changes_.lanes[row]), own = lane / group_lanes;
        return g > own ? all_lanes : g < own ? 0 : all_lanes << lane % group_lanes << 1;
    }

    LENDULET_FORCE_INLINE void write(const Hits& hits) {
        if (out_.end - out_.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out_.full(out_);
        const int g = Base::node_of(hits.entry);
        const BoxGroup& group = this->tree_.groups[g];
        const WideTreeChange& mine = changes_.rows[Base::row_of(hits.entry) + first_];
        BoxPair* next = out_.next;
        auto note = [&](uint32_t a, uint32_t b, bool begins) {
            bool in_order = (a < b) == begins;  // begun pairs ascend, ended ones descend
            return in_order ? BoxPair{a, b} : BoxPair{b, a};
        };
        for (uint64_t lanes = hits.differ; lanes;) {
            int i = take_lane(lanes);
            *next++ = note(mine.after.index, group.index[i], hits.now >> i & 1);
        }
        for (uint64_t lanes = hits.changed; lanes;) {
            int i = take_lane(lanes), earlier = __builtin_popcountll(changes_.changed[g] & ~(all_lanes << i));
            const WideTreeChange& other = changes_.rows[changes_.first[g] + static_cast<uint32_t>(earlier)];
            bool was = meet(mine.before, other.before), is = meet(mine.after, other.after);
            *next = note(mine.after.index, other.after.index, is);
            next += was != is;
        }
        out_.next = next;
    }

    const WideTreeChanges& changes_;
    const bool in_moving_;
    PairStream& out_;
    int first_ = 0;
};

template <class F>
void find_changes(const WideTreeView& moving, const WideTreeView& fixed, const WideTreeChanges& changes, int begin,
                  int end, PairStream& out) {
    constexpr int most = ChangeSearch<F>::most_rows;
    ChangeSearch<F> in_moving(moving, changes, true, out), in_fixed(fixed, changes, false, out);
    for (int i = begin; i < end; i += most) {
        int count = end - i < most ? end - i : most;
        in_moving.search(i, count);
        in_fixed.search(i, count);
    }
}
