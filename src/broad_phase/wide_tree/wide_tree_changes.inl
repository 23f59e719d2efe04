// Part of wide_tree_kernels.inl: pairs that begin and end. Which do follows from the boxes of before and after alone,
// so no list of pairs is kept. While the changes are searched, the lane of a changed box holds the box around both.
//
// Changed boxes go through a tree many at a time, level by level: what is to be looked at next stands in a list, which
// is worked off from its front. A search of one box would be a handful of loops of one to three rounds, and a machine
// that guesses wrong at the end of each would wait for longer than it tests.

using Quad = Wide<float, 4>;

template <class F>
LENDULET_FORCE_INLINE Spread<F> spread(const BroadBox& box) {
    Spread<F> all;
    for (int d = 0; d < 3; ++d) {
        all.at[d] = repeat<F>(box.lower[d]);
        all.at[3 + d] = repeat<F>(box.upper[d]);
    }
    return all;
}

LENDULET_FORCE_INLINE bool meet(const BroadBox& a, const BroadBox& b) {
    auto quad = [](const float* p) { return load_wide<Quad>(p); };
    auto hit = (quad(a.lower) <= quad(b.upper)) & (quad(b.lower) <= quad(a.upper));
    return (mask_bits(hit) & 7) == 7;  // the fourth lane is no bound
}

// Up to 64 changes of the moving set and the tree they are searched in.
template <class F>
class ChangeSearch {
public:
    static constexpr int most_rows = 64;

    // `in_moving`: the tree is that of the moving set, with changed boxes of its own.
    ChangeSearch(const WideTreeView& tree, const WideTreeChanges& changes, bool in_moving, PairStream& out)
        : tree_(tree), changes_(changes), in_moving_(in_moving), out_(out) {}

    void search(int first, int count) {
        if (tree_.group_count == 0) return;
        first_ = first;
        for (int i = 0; i < count; ++i) {
            const WideTreeChange& change = changes_.rows[first + i];
            auto quad = [](const float* p) { return load_wide<Quad>(p); };
            store_wide(reach_[i].lower, minimum(quad(change.after.lower), quad(change.before.lower)));
            store_wide(reach_[i].upper, maximum(quad(change.after.upper), quad(change.before.upper)));
        }
        List& top = lists_[tree_.levels];
        for (int i = 0; i < count; ++i) top.at[i] = entry(i, 0);
        top.count = count;
        for (int level = tree_.levels; level > 0; --level) descend(level);
        look();
    }

private:
    // Of a change and a block, or a group, near it.
    static constexpr int node_bits = 25;
    static constexpr uint32_t entry(int row, int node) {
        return static_cast<uint32_t>(row) << node_bits | static_cast<uint32_t>(node);
    }
    static constexpr int row_of(uint32_t entry) { return static_cast<int>(entry >> node_bits); }
    static constexpr int node_of(uint32_t entry) { return static_cast<int>(entry & ((1u << node_bits) - 1)); }

    struct List {
        static constexpr int most = 192;  // and the children of one block more
        int count = 0;
        uint32_t at[most + block_lanes];
    };
    // What a change meets in a group: boxes that did not change and were or are met, not both; changed ones that have
    // to be looked at; all that are met now.
    struct Hits {
        uint64_t differ, changed, now;
        uint32_t entry;
    };

    // The children of the blocks in list `level`, which are those of level - 1, to the list below.
    void descend(int level) {
        List &from = lists_[level], &to = lists_[level - 1];
        const BoundsBlock* blocks = tree_.blocks + tree_.first_block[level - 1];
        for (int i = 0; i < from.count; ++i) {
            const int row = row_of(from.at[i]), node = node_of(from.at[i]);
            Spread<F> box = spread<F>(reach_[row]);
            for (int k = 0; k < block_lanes; k += lanes_of<F>) {
                uint32_t lanes = overlaps<F>(blocks[node].bounds[0] + k, block_lanes, box);
                store_numbers<F>(to.at + to.count, lanes, entry(row, node * block_lanes + k));
                to.count += __builtin_popcount(lanes);
            }
            if (to.count > List::most - block_lanes) level > 1 ? descend(level - 1) : look();
        }
        from.count = 0;
    }

    // The boxes of the groups in list 0.
    void look() {
        Hits hits[List::most];
        int n = 0;
        List& list = lists_[0];
        for (int i = 0; i < list.count; ++i) {
            const int row = row_of(list.at[i]) + first_, g = node_of(list.at[i]);
            const WideTreeChange& change = changes_.rows[row];
            const Spread<F> before = spread<F>(change.before), after = spread<F>(change.after);
            const BoxGroup& group = tree_.groups[g];
            uint64_t was = 0, is = 0;
            for (int k = 0; k < group_lanes; k += lanes_of<F>) {
                was |= uint64_t{overlaps<F>(group.bounds[0] + k, group_lanes, before)} << k;
                is |= uint64_t{overlaps<F>(group.bounds[0] + k, group_lanes, after)} << k;
            }
            uint64_t changed = in_moving_ ? changes_.changed[g] : 0;
            hits[n] = {(was ^ is) & ~changed, (was | is) & changed & later(row, g), is, list.at[i]};
            n += (hits[n].differ | hits[n].changed) != 0;
        }
        list.count = 0;
        for (int i = 0; i < n; ++i) write(hits[i]);
    }

    // Of two changed boxes the one in the earlier lane looks at the other.
    uint64_t later(int row, int g) const {
        const int lane = static_cast<int>(changes_.lanes[row]), own = lane / group_lanes;
        return g > own ? all_lanes : g < own ? 0 : all_lanes << lane % group_lanes << 1;
    }

    LENDULET_FORCE_INLINE void write(const Hits& hits) {
        if (out_.end - out_.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out_.full(out_);
        const int g = node_of(hits.entry);
        const BoxGroup& group = tree_.groups[g];
        const WideTreeChange& mine = changes_.rows[row_of(hits.entry) + first_];
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

    const WideTreeView& tree_;
    const WideTreeChanges& changes_;
    const bool in_moving_;
    PairStream& out_;
    int first_ = 0;
    BroadBox reach_[most_rows];  // around before and after
    List lists_[WideTreeView::max_levels + 1];
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
