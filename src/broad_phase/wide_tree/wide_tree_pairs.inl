// Part of wide_tree_kernels.inl: all pairs. Groups are tested against groups in two steps. The first has no branch that
// depends on a hit: it tests, and notes the hits of each box as the bits of a word. The second turns words into pairs.

// Boxes of a group that matter to another, side by side, with room for one vector more.
template <class F>
struct Selection {
    alignas(64) float bounds[bound_count][group_lanes + lanes_of<F>];
    uint32_t index[group_lanes];
    int count;
    static constexpr int stride = group_lanes + lanes_of<F>;
};

// What one box hits.
struct Hits {
    uint64_t lanes;
    uint32_t index;
};

LENDULET_FORCE_INLINE void write_pairs(PairStream& out, const Hits& hits, const uint32_t* others) {
    if (out.end - out.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out.full(out);
    BoxPair* next = out.next;
    uint64_t lanes = hits.lanes;
    do {
        uint32_t other = others[take_lane(lanes)];
        *next++ = hits.index < other ? BoxPair{hits.index, other} : BoxPair{other, hits.index};
    } while (lanes);
    out.next = next;
}

// Pairs within a group of which `used` lanes are in use.
template <class F>
LENDULET_FORCE_INLINE void pairs_within(const BoxGroup& group, int used, PairStream& out) {
    Hits hits[group_lanes];
    int n = 0;
    for (int first = 0; first < used; first += lanes_of<F>) {
        int last = used - first < lanes_of<F> ? used : first + lanes_of<F>;
        for (int i = first; i < last; ++i) {
            uint64_t lanes = overlaps<F>(group, first, used, spread_lane<F>(group, i));
            lanes &= all_lanes << i << 1;
            hits[n] = {lanes, group.index[i]};
            n += lanes != 0;
        }
    }
    for (int i = 0; i < n; ++i) write_pairs(out, hits[i], group.index);
}

template <class F>
LENDULET_FORCE_INLINE void select_boxes(const BoxGroup& group, const Spread<F>& near, Selection<F>& out) {
    int n = 0;
    for (int i = 0; i < group_lanes; i += lanes_of<F>) {
        uint32_t bits = overlaps<F>(group.bounds[0] + i, group_lanes, near);
        for (int k = 0; k < bound_count; ++k) {
            store_packed<F>(out.bounds[k] + n, bits, load_wide<F>(group.bounds[k] + i));
        }
        for (; bits; bits &= bits - 1) out.index[n++] = group.index[i + __builtin_ctz(bits)];
    }
    out.count = n;
}

// Pairs between two groups with the bounds given.
template <class F>
LENDULET_FORCE_INLINE void pairs_between(const BoxGroup& a, const Spread<F>& bounds_a, const BoxGroup& b,
                                         const Spread<F>& bounds_b, PairStream& out) {
    uint64_t mine = overlaps<F>(a, 0, group_lanes, bounds_b);
    if (mine == 0) return;
    Selection<F> theirs;
    select_boxes<F>(b, bounds_a, theirs);
    if (theirs.count == 0) return;
    Hits hits[group_lanes];
    int n = 0;
    uint64_t valid = all_lanes >> (group_lanes - theirs.count);
    while (mine) {
        int i = take_lane(mine);
        Spread<F> box = spread_lane<F>(a, i);
        uint64_t lanes = 0;
        for (int j = 0; j < theirs.count; j += lanes_of<F>) {
            lanes |= uint64_t{overlaps<F>(theirs.bounds[0] + j, Selection<F>::stride, box)} << j;
        }
        lanes &= valid;
        hits[n] = {lanes, a.index[i]};
        n += lanes != 0;
    }
    for (int i = 0; i < n; ++i) write_pairs(out, hits[i], theirs.index);
}

// visit(block, lanes) for every block of level 0 with groups from `first` on whose bounds overlap the box, in order.
template <class F, class Visit>
LENDULET_FORCE_INLINE void visit_blocks(const WideTreeView& tree, const Spread<F>& box, int first, Visit&& visit) {
    if (first >= tree.group_count) return;
    struct Entry {
        int level, block;
    };
    Entry stack[WideTreeView::max_levels * block_lanes];
    stack[0] = {tree.levels - 1, 0};
    for (int top = 1; top > 0;) {
        auto [level, block] = stack[--top];
        uint32_t lanes = overlaps<F>(tree.blocks[tree.first_block[level] + block], box);
        int skip = (first >> 4 * level) - block * block_lanes;  // children that end before the first group
        if (skip > 0) lanes &= ~0u << skip;
        if (level == 0) {
            if (lanes) visit(block, lanes);
            continue;
        }
        while (lanes) {  // the last child first, so that the first comes off the stack first
            int k = 31 - __builtin_clz(lanes);
            lanes ^= 1u << k;
            stack[top++] = {level - 1, block * block_lanes + k};
        }
    }
}

// visit(group) for each of those groups.
template <class F, class Visit>
LENDULET_FORCE_INLINE void visit_groups(const WideTreeView& tree, const Spread<F>& box, int first, Visit&& visit) {
    visit_blocks<F>(tree, box, first, [&](int block, uint32_t lanes) {
        for (; lanes; lanes &= lanes - 1) visit(block * block_lanes + __builtin_ctz(lanes));
    });
}

template <class F>
LENDULET_FORCE_INLINE Spread<F> bounds_in_block(const WideTreeView& tree, int group) {
    const BoundsBlock& block = tree.blocks[tree.first_block[0] + group / block_lanes];
    return spread<F>(block.bounds[0] + group % block_lanes, block_lanes);
}

template <class F>
void find_pairs(const WideTreeView& moving, const WideTreeView& fixed, int begin, int end, PairStream& out) {
    for (int i = begin; i < end; ++i) {
        const BoxGroup& group = moving.groups[i];
        int left = moving.lanes - i * group_lanes;
        pairs_within<F>(group, left < group_lanes ? left : group_lanes, out);
        Spread<F> bounds = bounds_in_block<F>(moving, i);
        auto with = [&](const WideTreeView& tree, int first) {
            visit_groups<F>(tree, bounds, first, [&](int other) {
                pairs_between<F>(group, bounds, tree.groups[other], bounds_in_block<F>(tree, other), out);
            });
        };
        with(moving, i + 1);
        with(fixed, 0);
    }
}
