#include "broad_phase/sweep/sweep_3.h"

namespace lendulet {

Sweep3::Set::Set(const Memory* memory)
    : boxes(memory),
      begins{IntervalOrder(memory), IntervalOrder(memory), IntervalOrder(memory)},
      ends{IntervalOrder(memory), IntervalOrder(memory), IntervalOrder(memory)} {}

void Sweep3::Set::assign(const BroadBox* from, int count) {
    boxes.assign(from, count);
    for (int d = 0; d < 3; ++d) {
        begins[d].sort(count, [&](uint32_t place) { return from[place].lower[d]; });
        ends[d].sort(count, [&](uint32_t place) { return from[place].upper[d]; });
    }
}

size_t Sweep3::Set::bytes() const {
    size_t sum = boxes.bytes();
    for (int d = 0; d < 3; ++d) sum += begins[d].bytes() + ends[d].bytes();
    return sum;
}

const char* Sweep3::Set::check() const {
    for (int d = 0; d < 3; ++d) {
        if (!begins[d].sorted() || !ends[d].sorted()) return "the order of the boxes is not kept";
    }
    return boxes.check();
}

Sweep3::Sweep3(const Memory* memory)
    : fixed_(memory), moving_(memory), rows_(memory), filled_(memory), changes_(memory) {
    for (Array<Side>& sides : sides_) sides.set_memory(memory);
}

void Sweep3::set_fixed(const BroadBox* boxes, int count, TaskPool*) {
    fixed_.assign(boxes, count);
    changes_.forget();
}

void Sweep3::set_moving(const BroadBox* boxes, int count, TaskPool*) {
    moving_.assign(boxes, count);
    changes_.forget();
}

void Sweep3::find_pairs(TaskPool&, Array<BoxPair>& out) {
    if (moving_.boxes.count() == 0) return;
    rows_.resize_unset(static_cast<size_t>(moving_.boxes.count()));
    pairs_with(moving_, out);
    pairs_with(fixed_, out);
}

// Deals the sides of an order out to the tiles of their boxes; each tile gets its own in order.
void Sweep3::sort_into_tiles(const IntervalOrder& order, Array<Side>& sides, Array<uint32_t>& filled) {
    sides.resize_unset(static_cast<size_t>(order.count()));
    if (order.count() <= tile) {
        for (int i = 0; i < order.count(); ++i) sides[i] = {order.bits(i), order.place(i)};
        return;
    }
    filled.assign(static_cast<size_t>((order.count() + tile - 1) / tile), 0);
    for (int i = 0; i < order.count(); ++i) {
        uint32_t place = order.place(i), t = place / tile;
        sides[t * tile + filled[t]++] = {order.bits(i), place % tile};
    }
}

// The moving boxes against the columns of a set, tile by tile.
void Sweep3::pairs_with(const Set& columns, Array<BoxPair>& out) {
    for (int d = 0; d < 3; ++d) {
        sort_into_tiles(columns.begins[d], sides_[2 * d], filled_);
        sort_into_tiles(columns.ends[d], sides_[2 * d + 1], filled_);
    }
    for (int first = 0; first < columns.boxes.count(); first += tile) {
        int count = columns.boxes.count() - first < tile ? columns.boxes.count() - first : tile;
        int words = (count + 63) / 64 > 2 ? tile / 64 : 2;  // vectors of two words
        for (int d = 0; d < 3; ++d) {
            const Side *begins = sides_[2 * d].data() + first, *ends = sides_[2 * d + 1].data() + first;
            if (words == 2) keep_overlapping<2>(d, begins, ends, count);
            else keep_overlapping<tile / 64>(d, begins, ends, count);
        }
        write_pairs(columns, first, words, out);
    }
}

// Leaves those bits in the rows whose boxes overlap on axis d too; on the first axis sets them.
template <int words>
void Sweep3::keep_overlapping(int d, const Side* begins, const Side* ends, int count) {
    using Words = Wide<uint64_t, 2>;
    constexpr int vectors = words / 2;
    auto set_bit = [](Row& row, uint32_t column) { row.bits[column / 64] |= uint64_t{1} << column % 64; };
    Row passed{};
    // What has begun where the box of the row ends. Closed intervals: at the same place counts.
    const IntervalOrder& row_ends = moving_.ends[d];
    for (int i = 0, next = 0; i < row_ends.count(); ++i) {
        while (next < count && begins[next].at <= row_ends.bits(i)) set_bit(passed, begins[next++].column);
        Row& row = rows_[row_ends.place(i)];
        for (int v = 0; v < vectors; ++v) {
            Words mine, begun;
            std::memcpy(&begun, passed.bits + 2 * v, sizeof begun);
            if (d > 0) {
                std::memcpy(&mine, row.bits + 2 * v, sizeof mine);
                begun &= mine;
            }
            std::memcpy(row.bits + 2 * v, &begun, sizeof begun);
        }
    }
    // And has not ended where it begins.
    passed = {};
    const IntervalOrder& row_begins = moving_.begins[d];
    for (int i = 0, next = 0; i < row_begins.count(); ++i) {
        while (next < count && ends[next].at < row_begins.bits(i)) set_bit(passed, ends[next++].column);
        Row& row = rows_[row_begins.place(i)];
        for (int v = 0; v < vectors; ++v) {
            Words mine, ended;
            std::memcpy(&mine, row.bits + 2 * v, sizeof mine);
            std::memcpy(&ended, passed.bits + 2 * v, sizeof ended);
            mine &= ~ended;
            std::memcpy(row.bits + 2 * v, &mine, sizeof mine);
        }
    }
}

// Row after row. In the rows' own set a pair is written from the one that comes first.
void Sweep3::write_pairs(const Set& columns, int first, int words, Array<BoxPair>& out) const {
    const bool own = &columns == &moving_;
    const uint32_t *row_index = moving_.boxes.index.data(), *column_index = columns.boxes.index.data() + first;
    int rows = own && first + tile < rows_.count() ? first + tile : rows_.count();  // those after it come first
    for (int i = 0; i < rows; ++i) {
        const uint64_t* bits = rows_[i].bits;
        uint64_t any = 0;
        for (int w = 0; w < words; ++w) any |= bits[w];
        if (any == 0) continue;
        for (int w = 0; w < words; ++w) {
            int behind = i - first - 64 * w + 1;  // columns of this word up to the row's own box
            uint64_t left = bits[w];
            if (own && behind > 0) left = behind < 64 ? left >> behind << behind : 0;
            for (; left; left &= left - 1) {
                uint32_t a = row_index[i], b = column_index[64 * w + __builtin_ctzll(left)];
                out.push_back(a < b ? BoxPair{a, b} : BoxPair{b, a});
            }
        }
    }
}

void Sweep3::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                    Array<BoxPair>& begun, Array<BoxPair>& ended) {
    constexpr int share = 32;  // a box alone is compared with all others, which costs as much as the rows of many
    changes_.update(*this, tasks, {boxes, count, changed, changed_count}, share, begun, ended);
}

void Sweep3::cast(BoxCast& cast) const {
    moving_.boxes.offer_to(cast);
    fixed_.boxes.offer_to(cast);
}

void Sweep3::nearest(NearestBox& nearest) const {
    moving_.boxes.offer_to(nearest);
    fixed_.boxes.offer_to(nearest);
}

void Sweep3::boxes(Array<BroadPhaseBox>& out) const {
    moving_.boxes.append_boxes(out);
    fixed_.boxes.append_boxes(out);
}

size_t Sweep3::bytes() const {
    size_t sum = fixed_.bytes() + moving_.bytes() + rows_.bytes() + filled_.bytes() + changes_.bytes();
    for (const Array<Side>& sides : sides_) sum += sides.bytes();
    return sum;
}

const char* Sweep3::check() const {
    const char* wrong = moving_.check();
    return *wrong ? wrong : fixed_.check();
}

}  // namespace lendulet
