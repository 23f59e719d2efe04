// Part of wide_tree_kernels.inl: many boxes on their way through a tree.
//
// They go together, level by level: what is to be looked at next stands in a list, which is worked off from its front.
// A search of one box alone is a handful of loops of one to three rounds, and a machine that guesses wrong at the end
// of each waits for longer than it tests; nor can it fetch a group while it waits for another.

template <class F>
LENDULET_FORCE_INLINE Spread<F> spread(const BroadBox& box) {
    Spread<F> all;
    for (int d = 0; d < 3; ++d) {
        all.at[d] = repeat<F>(box.lower[d]);
        all.at[3 + d] = repeat<F>(box.upper[d]);
    }
    return all;
}

// Up to 64 boxes, the rows, and the tree they are searched in. Search::look(list) is given the groups near them; what
// it sees of one row comes in the order of groups, wherever lists end.
//
// A row may have a group of its own, rows_[i].index, which is not looked at with the others; no_box: none.
template <class F, class Search>
class BatchSearch {
public:
    static constexpr int most_rows = 64;

protected:
    // Of a row and a block, or a group, near it.
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

    explicit BatchSearch(const WideTreeView& tree) : tree_(tree) {}

    LENDULET_FORCE_INLINE void set(int row, Quad lower, Quad upper) {
        store_wide(rows_[row].lower, lower);
        store_wide(rows_[row].upper, upper);
    }

    void run(int count) {
        if (tree_.group_count == 0) return;
        int highest = 1;
        for (int begin = 0; begin < count; begin += rows_together) {
            const int end = count - begin < rows_together ? count : begin + rows_together;
            int level = tree_.levels;
            const int top = common_node(begin, end, level);
            List& list = lists_[level];
            for (int i = begin; i < end; ++i) list.at[list.count++] = entry(i, top);
            highest = level > highest ? level : highest;
        }
        for (int level = highest; level > 0; --level) descend(level);
        look();
    }

    const WideTreeView& tree_;
    BroadBox rows_[most_rows];

private:
    // The lowest block that holds all that the rows [begin, end) may be near, and its level: rows that lie together
    // share the way to there.
    static constexpr int rows_together = 8;
    int common_node(int begin, int end, int& level) const {
        if (level == 1) return 0;
        Quad lower = load_wide<Quad>(rows_[begin].lower), upper = load_wide<Quad>(rows_[begin].upper);
        for (int i = begin + 1; i < end; ++i) {
            lower = minimum(load_wide<Quad>(rows_[i].lower), lower);
            upper = maximum(load_wide<Quad>(rows_[i].upper), upper);
        }
        const Spread<F> all = spread<F>(lower, upper);
        int node = 0;
        for (; level > 1; --level) {
            const uint32_t lanes = overlaps<F>(tree_.blocks[tree_.first_block[level - 1] + node], all);
            if (lanes == 0 || (lanes & (lanes - 1)) != 0) break;
            node = node * block_lanes + __builtin_ctz(lanes);
        }
        return node;
    }
    // The children of the blocks in list `level`, which are those of level - 1, to the list below.
    [[gnu::noinline]] void descend(int level) {
        List &from = lists_[level], &to = lists_[level - 1];
        for (int i = 0; i < from.count;) {
            i = test(level, i);
            if (to.count > List::most - block_lanes) level > 1 ? descend(level - 1) : look();
        }
        from.count = 0;
    }
    // From entry i on, until the list below is full; gives the entry to go on with.
    int test(int level, int i) {
        const List& from = lists_[level];
        List& to = lists_[level - 1];
        const BoundsBlock* blocks = tree_.blocks + tree_.first_block[level - 1];
        const uint32_t own_lanes = level == 1 && Search::skips_own ? static_cast<uint32_t>(lanes_of<F>) : 0;
        uint32_t* next = to.at + to.count;  // in a register: each entry waits for the one before
        const uint32_t* const full = to.at + (List::most - block_lanes);
        for (const int entries = from.count; i < entries && next <= full; ++i) {
            const int row = row_of(from.at[i]), node = node_of(from.at[i]);
            Spread<F> box = spread<F>(rows_[row]);
            for (int k = 0; k < block_lanes; k += lanes_of<F>) {
                uint32_t lanes = overlaps<F>(blocks[node].bounds[0] + k, block_lanes, box);
                if constexpr (Search::skips_own) {
                    const uint32_t own = rows_[row].index - static_cast<uint32_t>(node * block_lanes + k);
                    lanes &= ~(uint32_t{own < own_lanes} << own % 32);
                }
                store_numbers<F>(next, lanes, entry(row, node * block_lanes + k));
                next += __builtin_popcount(lanes);
            }
        }
        to.count = static_cast<int>(next - to.at);
        return i;
    }
    void look() {
        static_cast<Search&>(*this).look(lists_[0]);
        lists_[0].count = 0;
    }

    List lists_[WideTreeView::max_levels + 1];
};
