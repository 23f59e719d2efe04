// Part of wide_tree_kernels.inl: pairs that begin and end. Which do follows from the boxes of before and after alone,
// so no list of pairs is kept. While the changes are searched, the steps of a changed box are those of the box around
// both; its two states stand in its row. Of two changed boxes the one in the earlier lane looks.

// Up to 64 changes of the moving set and the tree they are searched in.
template <class F>
class ChangeSearch : public BatchSearch<F, ChangeSearch<F>> {
    using Base = BatchSearch<F, ChangeSearch<F>>;
    using typename Base::List;

public:
    // `in_moving`: the tree is that of the moving set, with changed boxes of its own.
    ChangeSearch(const WideTreeView& tree, const WideTreeChanges& changes, bool in_moving, PairStream& out)
        : Base(tree), changes_(changes), in_moving_(in_moving), out_(out), far_(tree.group_count > most_near) {}

    void search(int first, int count) {
        first_ = first;
        count_ = count;
        const WideTreeChange* rows = changes_.rows + first;
        const uint32_t* lanes = changes_.lanes + first;
        const uint32_t nowhere = in_moving_ ? 0 : no_box;
        for (int i = 0; i < count; ++i) {
            auto quad = [](const float* p) { return load_wide<Quad>(p); };
            this->set(i, minimum(quad(rows[i].after.lower), quad(rows[i].before.lower)),
                      maximum(quad(rows[i].after.upper), quad(rows[i].before.upper)));
            this->rows_[i].index = lanes[i] / group_lanes | nowhere;  // where the box itself is
            this->rows_[i].unused = lanes[i] % group_lanes;
        }
        if (in_moving_) look_in_own();
        this->run(count);
        compare();
    }

private:
    friend Base;
    static constexpr bool skips_own = true;

    // What may meet: an entry of a list, and below it a lane of that group.
    using Candidate = uint64_t;
    static constexpr int lane_bits = 6, most_candidates = 512;
    static_assert(group_lanes == 1 << lane_bits);

    // Groups beyond so many are likely not to be near, and are asked for so many entries ahead.
    static constexpr int most_near = 512, ahead = 8, compared_ahead = 16;

    // What of a group may meet a row; not nothing.
    struct Near {
        uint64_t lanes;
        uint32_t entry;
    };

    // Their own groups first, whose frames their steps are in already.
    void look_in_own() {
        Near near[Base::most_rows];
        const CoarseBoxes* groups = this->tree_.coarse;
        const uint64_t* changed = changes_.changed;
        const StepsOfTwo* own = changes_.steps + first_;
        size_t n = 0;
        for (int i = 0, count = count_; i < count; ++i) {
            const uint32_t g = this->rows_[i].index, lane = this->rows_[i].unused;
            const uint64_t steps = own[i].around;
            uint64_t lanes = may_overlap<F>(groups[g], (Bytes16)Wide<uint64_t, 2>{steps, steps});
            lanes &= ~(changed[g] & (all_lanes >> (group_lanes - 1 - lane)));
            near[n] = {lanes, Base::entry(i, static_cast<int>(g))};
            n += one_if(lanes != 0);
        }
        note(near, n);
    }

    void look(const List& list) {
        Near near[List::most + block_lanes];
        note(near, in_moving_ ? test<true>(list, near) : test<false>(list, near));
    }

    // Gives how many entries are near.
    template <bool InMoving>
    size_t test(const List& list, Near* near) {
        const CoarseBoxes* groups = this->tree_.coarse;
        const uint64_t* changed = changes_.changed;
        const bool far = far_;
        size_t n = 0;
        for (int i = 0, count = list.count; i < count; ++i) {
            const uint32_t entry = list.at[i];
            if (far && i + ahead < count)
                prefetch<sizeof(CoarseBoxes) / 64>(&groups[Base::node_of(list.at[i + ahead])]);
            const BroadBox& row = this->rows_[Base::row_of(entry)];
            const auto g = static_cast<uint32_t>(Base::node_of(entry));
            uint64_t lanes = may_overlap<F>(groups[g], steps_of(groups[g], row));
            if constexpr (InMoving) lanes &= ~(changed[g] & (uint64_t{0} - (g < row.index)));
            near[n] = {lanes, entry};
            n += one_if(lanes != 0);
        }
        return n;
    }

    // Mostly there are one or two lanes; a loop would end where the machine does not expect it. It notices late where
    // that depends on a test that has just begun, so all tests of a list come first.
    void note(const Near* near, size_t count) {
        Candidate* next = next_;
        for (size_t i = 0; i < count; ++i) {
            const Candidate base = uint64_t{near[i].entry} << lane_bits;
            uint64_t lanes = near[i].lanes;
            *next++ = base + lowest_lane(lanes);
            lanes &= lanes - 1;
            *next = base + lowest_lane(lanes);
            next += one_if(lanes != 0);
            for (lanes &= lanes - 1; lanes; lanes &= lanes - 1) *next++ = base + lowest_lane(lanes);
            if (next - found_ <= most_candidates) continue;
            next_ = next;
            compare();
            next = next_;
        }
        next_ = next;
    }

    void ask_for(Candidate candidate) const {
        const auto entry = static_cast<uint32_t>(candidate >> lane_bits);
        prefetch(&this->tree_.groups[Base::node_of(entry)].boxes[candidate % group_lanes]);
    }

    void compare() {
        const Candidate *found = found_, *end = next_;
        next_ = found_;
        const BoxGroup* groups = this->tree_.groups;
        const uint64_t* changed = changes_.changed;
        const WideTreeChange *rows = changes_.rows, *searched = rows + first_;
        const bool in_moving = in_moving_;
        for (int i = 0; i < compared_ahead && found + i < end; ++i) ask_for(found[i]);
        while (found < end) {
            if (out_.end - out_.next < static_cast<ptrdiff_t>(PairList::most_at_once)) out_.full(out_);
            const Candidate* stop = end - found < out_.end - out_.next ? end : found + (out_.end - out_.next);
            BoxPair* next = out_.next;
            for (; found < stop; ++found) {
                if (end - found > compared_ahead) ask_for(found[compared_ahead]);
                const auto entry = static_cast<uint32_t>(*found >> lane_bits);
                const uint32_t i = *found % group_lanes, g = static_cast<uint32_t>(Base::node_of(entry));
                const WideTreeChange& mine = searched[Base::row_of(entry)];
                const BroadBox *before = &groups[g].boxes[i], *after = before;
                if (in_moving && changed[g] >> i & 1) {
                    const int earlier = __builtin_popcountll(changed[g] & ~(all_lanes << i));
                    const WideTreeChange& other = rows[changes_.first[g] + static_cast<uint32_t>(earlier)];
                    before = &other.before;
                    after = &other.after;
                }
                const auto [was, is] = meet(mine, *before, *after);
                const uint32_t a = mine.after.index, b = after->index;
                // Begun pairs ascend, ended ones descend; which it is cannot be foreseen.
                const uint32_t swapped = (a ^ b) & (0u - static_cast<uint32_t>(one_if((a < b) != is)));
                *next = {a ^ swapped, b ^ swapped};
                next += one_if(was != is);
            }
            out_.next = next;
        }
    }

    const WideTreeChanges& changes_;
    const bool in_moving_;
    PairStream& out_;
    const bool far_;
    int first_ = 0, count_ = 0;
    Candidate* next_ = found_;
    Candidate found_[most_candidates + group_lanes + 2];
};

template <class F>
void take_over(BoxGroup* groups, CoarseBoxes* coarse, const WideTreeChange* rows, const uint32_t* lanes, int count,
               StepsOfTwo* steps) {
    for (int i = 0; i < count; ++i) {
        const uint32_t g = lanes[i] / group_lanes, lane = lanes[i] % group_lanes;
        steps[i] = steps_of_two(coarse[g], rows[i].before, rows[i].after);
        store_steps(coarse[g], lane, steps[i].around);
        groups[g].boxes[lane] = rows[i].after;
    }
}

template <class F>
void find_changes(const WideTreeView& moving, const WideTreeView& fixed, const WideTreeChanges& changes, int begin,
                  int end, PairStream& out) {
    constexpr int most = ChangeSearch<F>::most_rows;
    for (const WideTreeView* tree : {&moving, &fixed}) {
        if (tree->group_count == 0) continue;
        ChangeSearch<F> search(*tree, changes, tree == &moving, out);
        for (int i = begin; i < end; i += most) search.search(i, end - i < most ? end - i : most);
    }
}
