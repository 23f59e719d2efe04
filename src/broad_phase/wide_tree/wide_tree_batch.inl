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
// it sees of one row comes in the order of groups, wherever lists end, and that of earlier rows before that of later
// ones.
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
        List& top = lists_[tree_.levels];
        for (int i = 0; i < count; ++i) top.at[i] = entry(i, 0);
        top.count = count;
        for (int level = tree_.levels; level > 0; --level) descend(level);
        look();
    }

    const WideTreeView& tree_;
    BroadBox rows_[most_rows];

private:
    // The children of the blocks in list `level`, which are those of level - 1, to the list below.
    void descend(int level) {
        List &from = lists_[level], &to = lists_[level - 1];
        const BoundsBlock* blocks = tree_.blocks + tree_.first_block[level - 1];
        for (int i = 0; i < from.count; ++i) {
            const int row = row_of(from.at[i]), node = node_of(from.at[i]);
            Spread<F> box = spread<F>(rows_[row]);
            for (int k = 0; k < block_lanes; k += lanes_of<F>) {
                uint32_t lanes = overlaps<F>(blocks[node].bounds[0] + k, block_lanes, box);
                store_numbers<F>(to.at + to.count, lanes, entry(row, node * block_lanes + k));
                to.count += __builtin_popcount(lanes);
            }
            if (to.count > List::most - block_lanes) level > 1 ? descend(level - 1) : look();
        }
        from.count = 0;
    }
    void look() {
        static_cast<Search&>(*this).look(lists_[0]);
        lists_[0].count = 0;
    }

    List lists_[WideTreeView::max_levels + 1];
};
