// Part of wide_tree_kernels.inl: filling groups, bounds of groups and blocks, and the test all searches are made of.

// A box with each bound in all lanes.
template <class F>
struct Spread {
    F at[bound_count];
};
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
LENDULET_FORCE_INLINE Spread<F> spread(Quad lower, Quad upper) {
    Spread<F> box;
    for (int d = 0; d < 3; ++d) {
        box.at[d] = repeat<F>(lower[d]);
        box.at[3 + d] = repeat<F>(upper[d]);
    }
    return box;
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
// The steps of a box in the frame of a group, each four times: lower x, y, z, nothing, upper x, y, z, nothing.
struct Steps {
    alignas(16) uint32_t at[8];
};
LENDULET_FORCE_INLINE Steps spread_steps(Bytes16 bytes) {
    Steps steps;
    store_fourfold<8>(steps.at, bytes);
    asm("" : "+m"(steps));  // to be loaded into all lanes, which is free: from registers it takes shuffles
    return steps;
}

// The boxes of a group, from lane `first` to `end`, that may overlap: all that do, and some that come near. `first` is
// a multiple of the vector's width; lanes before it are 0.
template <class F>
LENDULET_FORCE_INLINE uint64_t may_overlap(const CoarseBoxes& group, int first, int end, const uint32_t* steps,
                                           int stride) {
    using B = BytesOf<F>;
    uint64_t lanes = 0;
    for (int i = first; i < end; i += bytes_of<B>) {
        AllAtMost<B> hit;
        for (int d = 0; d < 3; ++d) {
            hit.require(load_bytes<B>(group.bounds[d] + i), repeat_word<B>(steps[(4 + d) * stride]));
            hit.require(repeat_word<B>(steps[d * stride]), load_bytes<B>(group.bounds[3 + d] + i));
        }
        lanes |= hit.bits() << i;
    }
    return lanes;
}
template <class F>
LENDULET_FORCE_INLINE uint64_t may_overlap(const CoarseBoxes& group, Bytes16 steps) {
#if defined(__AVX512BW__)
    if constexpr (sizeof(F) == group_lanes) {  // in registers: through memory would take longer than the test
        using B = BytesOf<F>;
        const B all = repeat_eight(steps);
        AllAtMost<B> hit;
        for (int d = 0; d < 3; ++d) {
            hit.require(load_bytes<B>(group.bounds[d]), repeat_one(all, 4 + d));
            hit.require(repeat_one(all, d), load_bytes<B>(group.bounds[3 + d]));
        }
        return hit.bits();
    }
#endif
    return may_overlap<F>(group, 0, group_lanes, spread_steps(steps).at, 1);
}

// Exactly; intervals are closed.
LENDULET_FORCE_INLINE bool meet(const BroadBox& a, const BroadBox& b) {
    auto quad = [](const float* p) { return load_wide<Quad>(p); };
    return three_at_most(quad(a.lower), quad(b.upper), quad(b.lower), quad(a.upper));  // the fourth is no bound
}

// Whether a box that changes meets another before, and after.
struct MeetsTwice {
    bool was, is;
};
LENDULET_FORCE_INLINE MeetsTwice meet(const WideTreeChange& mine, const BroadBox& before, const BroadBox& after) {
#if defined(__AVX512DQ__)
    using Eight = Wide<float, 8>;
    using All = Wide<float, 16>;
    const All own = load_wide<All>(mine.before.lower);
    const All others = detail::join(load_wide<Eight>(before.lower), load_wide<Eight>(after.lower));
    const All turned =  // their upper sides beside the lower ones of the box
        __builtin_shufflevector(others, others, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11);
    const uint32_t lower = at_most<All>(0x0707, own, turned), upper = at_most<All>(0x7070, turned, own);
    return {((lower | upper) & 0xff) == 0x77, (lower | upper) >> 8 == 0x77};
#else
    return {meet(mine.before, before), meet(mine.after, after)};
#endif
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
void bounds_of_block(const BoundsBlock& block, Bounds6& out) {
    bounds_of_lanes<F>(block.bounds[0], block_lanes, out);
}

// The steps of sixteen numbers.
template <class F>
LENDULET_FORCE_INLINE void store_steps(int8_t* to, const float* x, F centre, F scale) {
    const F first = splat<F>(first_step), last = splat<F>(last_step);
    F steps[16 / lanes_of<F>];
    for (int i = 0; i < 16 / lanes_of<F>; ++i) {
        F side = load_wide<F>(x + i * lanes_of<F>);
        steps[i] = minimum(maximum((side - centre) * scale, first), last);
    }
    store_as_bytes(to, steps);
}

// By quads, as the boxes are written: wider loads of what has just been written in quads would have to wait for it.
template <class F>
void bounds_of_group(const BoxGroup& group, Bounds6& out) {
    Quad lower[2], upper[2];
    for (int i = 0; i < group_lanes; i += 2) {
        for (int k = 0; k < 2; ++k) {
            const Quad low = load_wide<Quad>(group.boxes[i + k].lower),
                       high = load_wide<Quad>(group.boxes[i + k].upper);
            lower[k] = i ? minimum(low, lower[k]) : low;
            upper[k] = i ? maximum(high, upper[k]) : high;
        }
    }
    const Quad low = minimum(lower[0], lower[1]), high = maximum(upper[0], upper[1]);
    for (int d = 0; d < 3; ++d) {
        out.at[d] = low[d];
        out.at[3 + d] = high[d];
    }
}

// Empties the lanes from `first` on.
template <class F>
LENDULET_FORCE_INLINE void clear_boxes(BoxGroup& group, int first) {
    constexpr int row = static_cast<int>(sizeof(BroadBox) / sizeof(float));
    constexpr int stored = lanes_of < F >> row ? lanes_of<F> : row;
    alignas(64) float empty[stored];
    for (int i = 0; i < stored; ++i) empty[i] = i % row < row / 2 ? infinity : -infinity;
    for (int i = first; i < group_lanes; ++i) {
        const bool whole = (i * row) % stored == 0;
        std::memcpy(static_cast<void*>(&group.boxes[i]), empty, whole ? sizeof empty : sizeof(BroadBox));
        if (whole) i += stored / row - 1;
    }
}

LENDULET_FORCE_INLINE void clear_steps_from(CoarseBoxes& coarse, int first) {
    const Bytes16 counts{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Bytes16 kept = counts < repeat_byte(first % 16);
    for (int k = 0; k < bound_count; ++k) {
        const Bytes16 empty = repeat_byte(k < 3 ? 127 : -128);
        for (int i = first & ~15; i < group_lanes; i += 16) {
            Bytes16 steps = empty;
            if (i < first) {
                std::memcpy(&steps, coarse.bounds[k] + i, sizeof steps);
                steps = (steps & kept) | (empty & ~kept);
            }
            std::memcpy(coarse.bounds[k] + i, &steps, sizeof steps);
        }
    }
}

// Copies boxes through their places, and turns rows to lanes for their steps.
template <class F>
void fill_group(BoxGroup& group, CoarseBoxes& coarse, const BroadBox* boxes, const uint32_t* place, int count,
                Bounds6& bounds) {
    constexpr int width = lanes_of<F>;
    constexpr int row = static_cast<int>(sizeof(BroadBox) / sizeof(float)), upper = row / 2;
    for (int i = 0; i < count; ++i) group.boxes[i] = boxes[place[i]];
    clear_boxes<F>(group, count);
    const int end = (count + 15) & ~15;
    alignas(64) float sides[bound_count][group_lanes];
    F all[bound_count];
    for (int k = 0; k < bound_count; ++k) all[k] = splat<F>(k < 3 ? infinity : -infinity);
    for (int i = 0; i < end; i += width) {
        F low[4], high[4];
        load4<width>(floats_of(group.boxes), i, row, 0, low);
        load4<width>(floats_of(group.boxes), i, row, upper, high);
        for (int d = 0; d < 3; ++d) {
            store_wide(sides[d] + i, low[d]);
            store_wide(sides[3 + d] + i, high[d]);
            all[d] = minimum(low[d], all[d]);
            all[3 + d] = maximum(high[d], all[3 + d]);
        }
    }
    for (int k = 0; k < bound_count; ++k) bounds.at[k] = k < 3 ? reduce(all[k], Lower{}) : reduce(all[k], Upper{});
    set_frame(coarse, bounds);
    for (int k = 0; k < bound_count; ++k) {
        const F centre = repeat<F>(coarse.centre[k % 3]), scale = repeat<F>(coarse.scale[k % 3]);
        for (int i = 0; i < end; i += 16) store_steps<F>(coarse.bounds[k] + i, sides[k] + i, centre, scale);
    }
    if (count < group_lanes) clear_steps_from(coarse, count);
}
