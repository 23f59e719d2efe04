// Part of wide_tree_kernels.inl: queries.

template <class F>
void find_overlapping(const WideTreeView& tree, const Bounds6& bounds, IndexStream& out) {
    const Quad lower{bounds.at[0], bounds.at[1], bounds.at[2], 0}, upper{bounds.at[3], bounds.at[4], bounds.at[5], 0};
    BroadBox box;
    store_wide(box.lower, lower);
    store_wide(box.upper, upper);
    visit_groups<F>(tree, spread<F>(bounds), 0, [&](int g) {
        const BoxGroup& group = tree.groups[g];
        uint64_t lanes = may_overlap<F>(tree.coarse[g], steps_of(tree.coarse[g], lower, upper));
        if (out.end - out.next < group_lanes) out.full(out);
        uint32_t* next = out.next;
        while (lanes) {
            const BroadBox& found = group.boxes[take_lane(lanes)];
            *next = found.index;
            next += one_if(meet(box, found));
        }
        out.next = next;
    });
}

template <class F>
class QuerySearch : public BatchSearch<F, QuerySearch<F>> {
    using Base = BatchSearch<F, QuerySearch<F>>;
    using typename Base::List;

public:
    QuerySearch(const WideTreeView& tree, PairStream& out) : Base(tree), out_(out) {}

    // An infinite side reaches as far as the largest float, and no empty lane.
    void search(const BoxQuery* queries, int first, int count) {
        first_ = static_cast<uint32_t>(first);
        const Quad most = splat<Quad>(FLT_MAX);
        for (int i = 0; i < count; ++i) {
            const BoxQuery& q = queries[first + i];
            this->set(i, maximum(Quad{q.lower[0], q.lower[1], q.lower[2], 0}, -most),
                      minimum(Quad{q.upper[0], q.upper[1], q.upper[2], 0}, most));
        }
        this->run(count);
    }

private:
    friend Base;
    static constexpr bool skips_own = false;
    struct Hits {
        uint64_t lanes;
        uint32_t entry;
    };

    void look(const List& list) {
        Hits hits[List::most];
        int n = 0;
        for (int i = 0; i < list.count; ++i) {
            const CoarseBoxes& coarse = this->tree_.coarse[Base::node_of(list.at[i])];
            uint64_t lanes = may_overlap<F>(coarse, steps_of(coarse, this->rows_[Base::row_of(list.at[i])]));
            hits[n] = {lanes, list.at[i]};
            n += static_cast<int>(one_if(lanes != 0));
        }
        for (int i = 0; i < n; ++i) {
            if (out_.end - out_.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out_.full(out_);
            const int row = Base::row_of(hits[i].entry);
            const uint32_t query = first_ + static_cast<uint32_t>(row);
            const BoxGroup& group = this->tree_.groups[Base::node_of(hits[i].entry)];
            BoxPair* next = out_.next;
            for (uint64_t lanes = hits[i].lanes; lanes;) {
                const BroadBox& found = group.boxes[take_lane(lanes)];
                *next = {query, found.index};
                next += one_if(meet(this->rows_[row], found));
            }
            out_.next = next;
        }
    }

    PairStream& out_;
    uint32_t first_ = 0;
};

template <class F>
void find_hits(const WideTreeView& tree, const BoxQuery* queries, int begin, int end, PairStream& out) {
    constexpr int most = QuerySearch<F>::most_rows;
    QuerySearch<F> search(tree, out);
    for (int i = begin; i < end; i += most) search.search(queries, i, end - i < most ? end - i : most);
}

// The measure of a query for boxes side by side: when a cast enters them, how far off they are.
template <class F, class Query>
LENDULET_FORCE_INLINE F measure_lanes(const Query& query, const F lower[3], const F upper[3]) {
    if constexpr (std::is_same_v<Query, BoxCast>) return cast_entry<F>(query, lower, upper);
    else return squared_distance<F>(query, lower, upper);
}

template <class F, class Query>
LENDULET_FORCE_INLINE void offer_group(Query& query, const BoxGroup& group) {
    constexpr int row = static_cast<int>(sizeof(BroadBox) / sizeof(float));
    for (int i = 0; i < group_lanes; i += lanes_of<F>) {
        F lower[4], upper[4];
        load4<lanes_of<F>>(floats_of(group.boxes), i, row, 0, lower);
        load4<lanes_of<F>>(floats_of(group.boxes), i, row, row / 2, upper);
        F at = measure_lanes<F>(query, lower, upper);
        uint32_t lanes = lane_bits<F>(at_most(at, splat<F>(limit(query))));
        if (lanes == 0) continue;
        float each[lanes_of<F>];
        store_wide(each, at);
        for (; lanes; lanes &= lanes - 1) {
            int lane = __builtin_ctz(lanes);
            query.offer(each[lane], group.boxes[i + lane].index);
        }
    }
}

// The children of a block that may hold something better are pushed with their measures, the best last.
template <class F, class Query>
void find_best(const WideTreeView& tree, Query& query) {
    struct Entry {
        float at;
        int level, child;
    };
    if (tree.group_count == 0) return;
    Entry stack[WideTreeView::max_levels * block_lanes];
    stack[0] = {0, tree.levels, 0};
    for (int top = 1; top > 0;) {
        Entry entry = stack[--top];
        if (entry.at > limit(query)) continue;  // at equal measure there may be a smaller index
        if (entry.level == 0) {
            offer_group<F>(query, tree.groups[entry.child]);
            continue;
        }
        int level = entry.level - 1, bottom = top;
        const BoundsBlock& block = tree.blocks[tree.first_block[level] + entry.child];
        float each[block_lanes];
        uint32_t lanes = 0;
        for (int i = 0; i < block_lanes; i += lanes_of<F>) {
            F lower[3], upper[3];
            for (int d = 0; d < 3; ++d) {
                lower[d] = load_wide<F>(block.bounds[d] + i);
                upper[d] = load_wide<F>(block.bounds[3 + d] + i);
            }
            F at = measure_lanes<F>(query, lower, upper);
            store_wide(each + i, at);
            lanes |= lane_bits<F>(at_most(at, splat<F>(limit(query)))) << i;
        }
        for (; lanes; lanes &= lanes - 1) {
            int k = __builtin_ctz(lanes), place = top++;
            for (; place > bottom && stack[place - 1].at < each[k]; --place) stack[place] = stack[place - 1];
            stack[place] = {each[k], level, entry.child * block_lanes + k};
        }
    }
}
