// Part of wide_tree_kernels.inl: filling groups, bounds of groups and blocks, and the test all searches are made of.

// A box with each bound in all lanes.
template <class F>
struct Spread {
    F at[bound_count];
};
// All lanes the same, bit by bit: splat() adds zero, which is an instruction more, for it makes +0 of -0.
template <class F>
LENDULET_FORCE_INLINE F repeat(const float& x) {
    using Integers = Wide<int32_t, lanes_of<F>>;
    int32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return (F)(Integers{} + bits);
}
template <class F>
LENDULET_FORCE_INLINE Spread<F> spread(const float* bounds, int stride) {
    Spread<F> box;
    for (int k = 0; k < bound_count; ++k) box.at[k] = repeat<F>(bounds[k * stride]);
    return box;
}
template <class F>
LENDULET_FORCE_INLINE Spread<F> spread(const Bounds6& bounds) {
    return spread<F>(bounds.at, 1);
}
template <class F>
LENDULET_FORCE_INLINE Spread<F> spread_lane(const BoxGroup& group, int lane) {
    return spread<F>(group.bounds[0] + lane, group_lanes);
}

// Which of the boxes at bounds, bounds + stride ... overlap; intervals are closed, so touching counts.
template <class F>
LENDULET_FORCE_INLINE uint32_t overlaps(const float* bounds, int stride, const Spread<F>& box) {
    LaneMask<F> hit = at_most(load_wide<F>(bounds), box.at[3]);
    hit = at_most<F>(hit, box.at[0], load_wide<F>(bounds + 3 * stride));
    for (int d = 1; d < 3; ++d) {
        hit = at_most<F>(hit, load_wide<F>(bounds + d * stride), box.at[3 + d]);
        hit = at_most<F>(hit, box.at[d], load_wide<F>(bounds + (3 + d) * stride));
    }
    return lane_bits<F>(hit);
}
template <class F>
LENDULET_FORCE_INLINE uint32_t overlaps(const BoundsBlock& block, const Spread<F>& box) {
    uint32_t lanes = 0;
    for (int i = 0; i < block_lanes; i += lanes_of<F>) lanes |= overlaps<F>(block.bounds[0] + i, block_lanes, box) << i;
    return lanes;
}
// From lane `first` on, which is a multiple of the vector's width; lanes below are 0.
template <class F>
LENDULET_FORCE_INLINE uint64_t overlaps(const BoxGroup& group, int first, int end, const Spread<F>& box) {
    uint64_t lanes = 0;
    for (int i = first; i < end; i += lanes_of<F>) {
        lanes |= uint64_t{overlaps<F>(group.bounds[0] + i, group_lanes, box)} << i;
    }
    return lanes;
}

// The smallest or largest lane of a vector.
template <class F, class Combine>
LENDULET_FORCE_INLINE float reduce(F value, Combine&& combine) {
    float lanes[lanes_of<F>];
    store_wide(lanes, value);
    Wide<float, 4> all = load_wide<Wide<float, 4>>(lanes);
    for (int i = 4; i < lanes_of<F>; i += 4) all = combine(all, load_wide<Wide<float, 4>>(lanes + i));
    all = combine(all, __builtin_shufflevector(all, all, 2, 3, 0, 1));
    all = combine(all, __builtin_shufflevector(all, all, 1, 0, 3, 2));
    return all[0];
}

struct Lower {
    template <class V>
    LENDULET_FORCE_INLINE V operator()(V a, V b) const {
        return minimum(a, b);
    }
};
struct Upper {
    template <class V>
    LENDULET_FORCE_INLINE V operator()(V a, V b) const {
        return maximum(a, b);
    }
};

template <class F>
LENDULET_FORCE_INLINE void bounds_of_lanes(const float* bounds, int stride, Bounds6& out) {
    for (int k = 0; k < bound_count; ++k) {
        const float* row = bounds + k * stride;
        F all = load_wide<F>(row);
        for (int i = lanes_of<F>; i < stride; i += lanes_of<F>) {
            F next = load_wide<F>(row + i);
            all = k < 3 ? minimum(next, all) : maximum(next, all);
        }
        out.at[k] = k < 3 ? reduce(all, Lower{}) : reduce(all, Upper{});
    }
}
template <class F>
void bounds_of_group(const BoxGroup& group, Bounds6& out) {
    bounds_of_lanes<F>(group.bounds[0], group_lanes, out);
}
template <class F>
void bounds_of_block(const BoundsBlock& block, Bounds6& out) {
    bounds_of_lanes<F>(block.bounds[0], block_lanes, out);
}

LENDULET_FORCE_INLINE void set_box(BoxGroup& group, int lane, const BroadBox& box) {
    for (int d = 0; d < 3; ++d) {
        group.bounds[d][lane] = box.lower[d];
        group.bounds[3 + d][lane] = box.upper[d];
    }
    group.index[lane] = box.index;
}

// Reads the boxes through their places and turns rows to lanes.
template <class F>
void fill_group(BoxGroup& group, const BroadBox* boxes, const uint32_t* place, int count, Bounds6& bounds) {
    constexpr int width = lanes_of<F>;
    constexpr int row = static_cast<int>(sizeof(BroadBox) / sizeof(float)), upper = row / 2;
    static_assert(row == 8);
    F all[bound_count];
    for (int k = 0; k < bound_count; ++k) all[k] = splat<F>(k < 3 ? infinity : -infinity);
    int i = 0;
    for (; i + width <= count; i += width) {
        F low[4], high[4];
        int32_t at[width];
        std::memcpy(at, place + i, sizeof at);
        gather4<width>(floats_of(boxes), at, row, 0, low);
        gather4<width>(floats_of(boxes), at, row, upper, high);
        for (int d = 0; d < 3; ++d) {
            store_wide(group.bounds[d] + i, low[d]);
            store_wide(group.bounds[3 + d] + i, high[d]);
            all[d] = minimum(low[d], all[d]);
            all[3 + d] = maximum(high[d], all[3 + d]);
        }
        std::memcpy(group.index + i, &low[3], sizeof low[3]);
    }
    if (i < count) {  // the last group of a tree
        for (int k = 0; k < bound_count; ++k) {
            for (int j = i; j < i + width; ++j) group.bounds[k][j] = k < 3 ? infinity : -infinity;
        }
        for (int j = i; j < count; ++j) set_box(group, j, boxes[place[j]]);
        for (int k = 0; k < bound_count; ++k) {
            F last = load_wide<F>(group.bounds[k] + i);
            all[k] = k < 3 ? minimum(last, all[k]) : maximum(last, all[k]);
        }
        i += width;
    }
    for (; i < group_lanes; ++i) {
        for (int k = 0; k < bound_count; ++k) group.bounds[k][i] = k < 3 ? infinity : -infinity;
    }
    for (int k = 0; k < bound_count; ++k) bounds.at[k] = k < 3 ? reduce(all[k], Lower{}) : reduce(all[k], Upper{});
}
