// Part of wide_tree_kernels.inl: pairs that begin and end. Which do follows from the boxes of before and after alone, so
// no list of pairs is kept: a changed box is tested as it was and as it is against every box near either.

struct ChangedHits {
    uint64_t begun, ended;
    uint32_t index;
};

LENDULET_FORCE_INLINE void write_changes(PairStream& out, const ChangedHits& hits, const uint32_t* others) {
    constexpr auto most = static_cast<ptrdiff_t>(PairList::most_at_once);
    if (out.end - out.next < most) out.full(out);
    BoxPair* next = out.next;
    for (uint64_t lanes = hits.begun; lanes;) {  // a lane is in one of the two at most
        uint32_t other = others[take_lane(lanes)];
        *next++ = hits.index < other ? BoxPair{hits.index, other} : BoxPair{other, hits.index};
    }
    for (uint64_t lanes = hits.ended; lanes;) {
        uint32_t other = others[take_lane(lanes)];
        *next++ = hits.index > other ? BoxPair{hits.index, other} : BoxPair{other, hits.index};
    }
    out.next = next;
}

// Bits for `count` boxes, of at most 64, whose rows are apart.
template <class F>
LENDULET_FORCE_INLINE uint64_t overlaps_of_rows(const float* const rows[bound_count], uint32_t first, int count,
                                                const Spread<F>& box) {
    uint64_t lanes = 0;
    for (int i = 0; i < count; i += lanes_of<F>) {
        auto row = [&](int k) { return load_wide<F>(rows[k] + first + i); };
        LaneMask<F> hit = at_most(row(0), box.at[3]);
        hit = at_most<F>(hit, box.at[0], row(3));
        for (int d = 1; d < 3; ++d) {
            hit = at_most<F>(hit, row(d), box.at[3 + d]);
            hit = at_most<F>(hit, box.at[d], row(3 + d));
        }
        lanes |= uint64_t{lane_bits<F>(hit)} << i;
    }
    return count ? lanes & all_lanes >> (group_lanes - count) : 0;
}

template <class F>
LENDULET_FORCE_INLINE Spread<F> spread_row(const float* const rows[bound_count], uint32_t i) {
    Spread<F> box;
    for (int k = 0; k < bound_count; ++k) box.at[k] = splat<F>(rows[k][i]);
    return box;
}

// The changed boxes of a group.
template <class F>
struct ChangedGroup {
    const WideTreeChanges& changes;
    uint32_t first;
    int count;

    // Those that reach into the bounds before or after.
    LENDULET_FORCE_INLINE uint64_t near(const Spread<F>& bounds) const {
        return overlaps_of_rows<F>(changes.before, first, count, bounds) |
               overlaps_of_rows<F>(changes.after, first, count, bounds);
    }
    // What they begin and end with the boxes of a group that do not change.
    LENDULET_FORCE_INLINE void with_unchanged(uint64_t mine, const BoxGroup& group, uint64_t unchanged,
                                              PairStream& out) const {
        ChangedHits hits[group_lanes];
        int n = 0;
        while (mine) {
            uint32_t i = first + static_cast<uint32_t>(take_lane(mine));
            uint64_t before = overlaps<F>(group, 0, group_lanes, spread_row<F>(changes.before, i));
            uint64_t after = overlaps<F>(group, 0, group_lanes, spread_row<F>(changes.after, i));
            uint64_t differ = (before ^ after) & unchanged;
            hits[n] = {after & differ, before & differ, changes.index[i]};
            n += differ != 0;
        }
        for (int i = 0; i < n; ++i) write_changes(out, hits[i], group.index);
    }
    // The same with the changed boxes of a group; those of the same group count from the next on.
    LENDULET_FORCE_INLINE void with_changed(uint64_t mine, const ChangedGroup& other, PairStream& out) const {
        ChangedHits hits[group_lanes];
        int n = 0;
        while (mine) {
            int lane = take_lane(mine);
            uint32_t i = first + static_cast<uint32_t>(lane);
            uint64_t before =
                overlaps_of_rows<F>(changes.before, other.first, other.count, spread_row<F>(changes.before, i));
            uint64_t after =
                overlaps_of_rows<F>(changes.after, other.first, other.count, spread_row<F>(changes.after, i));
            uint64_t differ = before ^ after;
            if (first == other.first) differ &= all_lanes << lane << 1;
            hits[n] = {after & differ, before & differ, changes.index[i]};
            n += differ != 0;
        }
        for (int i = 0; i < n; ++i) write_changes(out, hits[i], changes.index + other.first);
    }
};

// Bounds of all boxes of a range of rows.
template <class F>
LENDULET_FORCE_INLINE Spread<F> bounds_of_changes(const WideTreeChanges& changes, uint32_t first, int count) {
    Bounds6 all{{infinity, infinity, infinity, -infinity, -infinity, -infinity}};
    for (uint32_t i = first; i < first + static_cast<uint32_t>(count); ++i) {
        for (int d = 0; d < 3; ++d) {
            all.at[d] = minimum(minimum(changes.before[d][i], changes.after[d][i]), all.at[d]);
            all.at[3 + d] = maximum(maximum(changes.before[3 + d][i], changes.after[3 + d][i]), all.at[3 + d]);
        }
    }
    return spread<F>(all);
}

template <class F>
void find_changes(const WideTreeView& moving, const WideTreeView& fixed, const WideTreeChanges& changes,
                  const uint32_t* groups, int begin, int end, PairStream& out) {
    auto changed_of = [&](uint32_t group) {
        return ChangedGroup<F>{changes, changes.first[group], __builtin_popcountll(changes.changed[group])};
    };
    for (int i = begin; i < end; ++i) {
        ChangedGroup<F> mine = changed_of(groups[i]);
        if (mine.count == 0) continue;
        Spread<F> reach = bounds_of_changes<F>(changes, mine.first, mine.count);
        visit_groups<F>(moving, reach, 0, [&](int other) {
            uint64_t near = mine.near(bounds_in_block<F>(moving, other));
            if (near == 0) return;
            uint64_t changed = changes.changed[other];
            mine.with_unchanged(near, moving.groups[other], ~changed, out);
            if (changed && static_cast<uint32_t>(other) >= groups[i]) {
                mine.with_changed(near, changed_of(static_cast<uint32_t>(other)), out);
            }
        });
        visit_groups<F>(fixed, reach, 0, [&](int other) {
            uint64_t near = mine.near(bounds_in_block<F>(fixed, other));
            if (near) mine.with_unchanged(near, fixed.groups[other], all_lanes, out);
        });
    }
}
