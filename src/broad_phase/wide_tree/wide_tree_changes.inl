// Part of wide_tree_kernels.inl: pairs that begin and end. Which do follows from the boxes of before and after alone,
// so no list of pairs is kept. While the changes are searched, the lane of a changed box holds the box around both;
// what meets it there is a candidate, which is then looked at as it was and as it is.

using Quad = Wide<float, 4>;

template <class F>
LENDULET_FORCE_INLINE Spread<F> spread(Quad lower, Quad upper) {
    Spread<F> box;
    for (int d = 0; d < 3; ++d) {
        box.at[d] = splat<F>(lower[d]);
        box.at[3 + d] = splat<F>(upper[d]);
    }
    return box;
}

// A box around a change.
struct Reach {
    Quad lower, upper;
    LENDULET_FORCE_INLINE explicit Reach(const WideTreeChange& change)
        : lower(minimum(load_wide<Quad>(change.after.lower), load_wide<Quad>(change.before.lower))),
          upper(maximum(load_wide<Quad>(change.after.upper), load_wide<Quad>(change.before.upper))) {}
};

// Groups near the changes of one, and their bounds side by side.
template <class F>
struct NearGroups {
    static constexpr int most = 64, stride = most + lanes_of<F>;
    alignas(64) float bounds[bound_count][stride];
    int group[most];
    int count = 0;

    LENDULET_FORCE_INLINE void add(const BoundsBlock& block, uint32_t lanes, int first_group) {
        for (int i = 0; i < block_lanes; i += lanes_of<F>) {
            uint32_t bits = lanes >> i & ((1u << lanes_of<F>)-1);
            for (int k = 0; k < bound_count; ++k) {
                store_packed<F>(bounds[k] + count, bits, load_wide<F>(block.bounds[k] + i));
            }
            for (; bits; bits &= bits - 1) group[count++] = first_group + i + __builtin_ctz(bits);
        }
    }
    LENDULET_FORCE_INLINE uint64_t overlapping(const Spread<F>& box) const {
        uint64_t near = 0;
        for (int i = 0; i < count; i += lanes_of<F>) near |= uint64_t{overlaps<F>(bounds[0] + i, stride, box)} << i;
        return near & all_lanes >> (most - count);
    }
};

// A change and the boxes of a group that it may begin or end a pair with.
struct Candidates {
    uint64_t lanes;
    const WideTreeChange* change;
    int group;
};

LENDULET_FORCE_INLINE bool meet(Quad lower_a, Quad upper_a, Quad lower_b, Quad upper_b) {
    return (mask_bits((lower_a <= upper_b) & (lower_b <= upper_a)) & 7) == 7;  // the fourth lane is no bound
}

// `changed` has the changed lanes of the groups; null for a tree without.
LENDULET_FORCE_INLINE void write_changes(const Candidates& some, const WideTreeView& tree,
                                         const WideTreeChanges& changes, const uint64_t* changed, PairStream& out) {
    if (out.end - out.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out.full(out);
    const BoxGroup& group = tree.groups[some.group];
    const WideTreeChange& mine = *some.change;
    uint64_t others_changed = changed ? changed[some.group] : 0;
    auto quad = [](const float* p) { return load_wide<Quad>(p); };
    BoxPair* next = out.next;
    for (uint64_t lanes = some.lanes; lanes;) {
        int i = take_lane(lanes);
        Quad lower{group.bounds[0][i], group.bounds[1][i], group.bounds[2][i], 0}, lower_before = lower;
        Quad upper{group.bounds[3][i], group.bounds[4][i], group.bounds[5][i], 0}, upper_before = upper;
        if (others_changed >> i & 1) {
            int earlier = __builtin_popcountll(others_changed & ~(all_lanes << i));
            const WideTreeChange& other = changes.rows[changes.first[some.group] + static_cast<uint32_t>(earlier)];
            lower_before = quad(other.before.lower), upper_before = quad(other.before.upper);
            lower = quad(other.after.lower), upper = quad(other.after.upper);
        }
        bool was = meet(quad(mine.before.lower), quad(mine.before.upper), lower_before, upper_before);
        bool is = meet(quad(mine.after.lower), quad(mine.after.upper), lower, upper);
        uint32_t a = mine.after.index, b = group.index[i];
        bool in_order = (a < b) == is;  // begun pairs ascend, ended ones descend
        *next = {in_order ? a : b, in_order ? b : a};
        next += was != is;
    }
    out.next = next;
}

// The changes of one group against groups near; of two changed boxes the one in the earlier lane looks at the other.
template <class F>
LENDULET_FORCE_INLINE void search_near(const NearGroups<F>& near, const WideTreeView& tree,
                                       const WideTreeChanges& changes, const uint64_t* changed, int group,
                                       PairStream& out) {
    Candidates found[NearGroups<F>::most];
    const WideTreeChange* change = changes.rows + changes.first[group];
    for (uint64_t mine = changes.changed[group]; mine; ++change) {
        int lane = take_lane(mine);
        Reach reach(*change);
        Spread<F> box = spread<F>(reach.lower, reach.upper);
        int n = 0;
        for (uint64_t groups = near.overlapping(box); groups;) {
            int other = near.group[take_lane(groups)];
            uint64_t lanes = overlaps<F>(tree.groups[other], 0, group_lanes, box);
            if (changed) {
                uint64_t later = other > group ? all_lanes : other < group ? 0 : all_lanes << lane << 1;
                lanes &= ~changed[other] | later;
            }
            found[n] = {lanes, change, other};
            n += lanes != 0;
        }
        for (int i = 0; i < n; ++i) write_changes(found[i], tree, changes, changed, out);
    }
}

template <class F>
void find_changes(const WideTreeView& moving, const WideTreeView& fixed, const WideTreeChanges& changes,
                  const uint32_t* groups, int begin, int end, PairStream& out) {
    for (int i = begin; i < end; ++i) {
        int group = static_cast<int>(groups[i]);
        if (changes.changed[group] == 0) continue;
        const WideTreeChange* change = changes.rows + changes.first[group];
        Reach all(*change);
        for (uint64_t left = changes.changed[group]; left; left &= left - 1, ++change) {
            Reach one(*change);
            all.lower = minimum(one.lower, all.lower);
            all.upper = maximum(one.upper, all.upper);
        }
        Spread<F> reach = spread<F>(all.lower, all.upper);
        auto with = [&](const WideTreeView& tree, const uint64_t* changed) {
            NearGroups<F> near;
            visit_blocks<F>(tree, reach, 0, [&](int block, uint32_t lanes) {
                near.add(tree.blocks[tree.first_block[0] + block], lanes, block * block_lanes);
                if (near.count <= NearGroups<F>::most - block_lanes) return;
                search_near(near, tree, changes, changed, group, out);
                near.count = 0;
            });
            if (near.count) search_near(near, tree, changes, changed, group, out);
        };
        with(moving, changes.changed);
        with(fixed, nullptr);
    }
}
