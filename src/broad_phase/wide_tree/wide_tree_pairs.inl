// Part of wide_tree_kernels.inl: all pairs. Groups are tested against groups in two steps. The first has no branch that
// depends on a hit: it tests, and notes the hits of each box as the bits of a word. The second turns words into pairs.

// What one box of a group may hit in another.
struct Hits {
    uint64_t lanes;
    int own;
};

LENDULET_FORCE_INLINE void write_pairs(PairStream& out, const BroadBox& own, const BoxGroup& others, uint64_t lanes) {
    if (out.end - out.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out.full(out);
    BoxPair* next = out.next;
    do {
        const BroadBox& other = others.boxes[take_lane(lanes)];
        const uint32_t swapped =
            (own.index ^ other.index) & (0u - static_cast<uint32_t>(one_if(other.index < own.index)));
        *next = {own.index ^ swapped, other.index ^ swapped};
        next += one_if(meet(own, other));
    } while (lanes);
    out.next = next;
}

// Pairs within a group of which `used` lanes are in use.
template <class F>
LENDULET_FORCE_INLINE void pairs_within(const BoxGroup& group, const CoarseBoxes& coarse, int used, PairStream& out) {
    constexpr int width = bytes_of<BytesOf<F>>;
    alignas(64) uint32_t steps[8][group_lanes];  // each step four times; as in Steps
    for (int k = 0; k < bound_count; ++k) {
        uint32_t* row = steps[k < 3 ? k : k + 1];
        for (int i = 0; i < used; i += 16) store_fourfold<16>(row + i, load_bytes<Bytes16>(coarse.bounds[k] + i));
    }
    Hits hits[group_lanes];
    int n = 0;
    for (int first = 0; first < used; first += width) {
        int last = used - first < width ? used : first + width;
        for (int i = first; i < last; ++i) {
            uint64_t lanes = may_overlap<F>(coarse, first, used, steps[0] + i, group_lanes);
            lanes &= all_lanes << i << 1;
            hits[n] = {lanes, i};
            n += static_cast<int>(one_if(lanes != 0));
        }
    }
    for (int i = 0; i < n; ++i) write_pairs(out, group.boxes[hits[i].own], group, hits[i].lanes);
}

// A group with its bounds in the block above.
struct BoundedGroup {
    const BoxGroup& boxes;
    const CoarseBoxes& coarse;
    Quad lower, upper;
};
LENDULET_FORCE_INLINE BoundedGroup bounded_group(const WideTreeView& tree, int group) {
    const BoundsBlock& block = tree.blocks[tree.first_block[0] + group / block_lanes];
    auto bound = [&](int k) { return block.bounds[k][group % block_lanes]; };
    return {tree.groups[group], tree.coarse[group], Quad{bound(0), bound(1), bound(2), 0},
            Quad{bound(3), bound(4), bound(5), 0}};
}

// Pairs between two groups.
template <class F>
LENDULET_FORCE_INLINE void pairs_between(const BoundedGroup& a, const BoundedGroup& b, PairStream& out) {
    uint64_t of_a = may_overlap<F>(a.coarse, steps_of(a.coarse, b.lower, b.upper));
    if (of_a == 0) return;
    uint64_t of_b = may_overlap<F>(b.coarse, steps_of(b.coarse, a.lower, a.upper));
    if (of_b == 0) return;
    const bool swap = __builtin_popcountll(of_b) < __builtin_popcountll(of_a);  // the fewer are tested one by one
    const BoundedGroup &mine = swap ? b : a, &theirs = swap ? a : b;
    uint64_t left = swap ? of_b : of_a, valid = swap ? of_a : of_b;
    Hits hits[group_lanes];
    int n = 0;
    while (left) {
        int i = take_lane(left);
        uint64_t lanes = may_overlap<F>(theirs.coarse, steps_of(theirs.coarse, mine.boxes.boxes[i])) & valid;
        hits[n] = {lanes, i};
        n += static_cast<int>(one_if(lanes != 0));
    }
    for (int i = 0; i < n; ++i) write_pairs(out, mine.boxes.boxes[hits[i].own], theirs.boxes, hits[i].lanes);
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
void find_pairs(const WideTreeView& moving, const WideTreeView& fixed, int begin, int end, PairStream& out) {
    for (int i = begin; i < end; ++i) {
        const BoundedGroup group = bounded_group(moving, i);
        int left = moving.lanes - i * group_lanes;
        pairs_within<F>(group.boxes, group.coarse, left < group_lanes ? left : group_lanes, out);
        const Spread<F> bounds = spread<F>(group.lower, group.upper);
        auto with = [&](const WideTreeView& tree, int first) {
            visit_groups<F>(tree, bounds, first,
                            [&](int other) { pairs_between<F>(group, bounded_group(tree, other), out); });
        };
        with(moving, i + 1);
        with(fixed, 0);
    }
}
