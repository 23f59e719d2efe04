// Boxes in the order of one of their coordinates, kept from one time to the next: where few have passed each other the
// order is repaired by insertion, otherwise it is sorted anew. The result depends on the coordinates alone: ties are
// in the order of the places.
#pragma once

#include "broad_phase/sort.h"

namespace lendulet {

class IntervalOrder {
public:
    explicit IntervalOrder(const Memory* memory) : keys_(memory), swap_(memory) {}

    // Orders `count` boxes by coordinate(place).
    template <class Coordinate>
    void sort(int count, Coordinate&& coordinate) {
        uint32_t n = static_cast<uint32_t>(count), old = static_cast<uint32_t>(keys_.size());
        if (n <= handful) {
            keys_.resize_unset(n);
            for (uint32_t place = 0; place < n; ++place) keys_[place] = key_of(coordinate(place), place);
            return sort_handful();
        }
        size_t kept = 0;
        for (uint64_t key : keys_) {  // in the order of the last time
            uint32_t place = static_cast<uint32_t>(key);
            if (place < n) keys_[kept++] = key_of(coordinate(place), place);
        }
        keys_.resize_unset(n);
        for (uint32_t place = old; place < n; ++place) keys_[kept++] = key_of(coordinate(place), place);
        repair_or_sort();
    }

    int count() const { return keys_.count(); }
    uint32_t place(int i) const { return static_cast<uint32_t>(keys_[i]); }
    // The coordinate as an integer of the same order.
    uint32_t bits(int i) const { return static_cast<uint32_t>(keys_[i] >> 32); }
    size_t bytes() const { return keys_.bytes() + swap_.bytes(); }
    bool sorted() const;

private:
    static uint64_t key_of(float x, uint32_t place) { return uint64_t{ordered_bits(x)} << 32 | place; }
    static constexpr uint32_t handful = 16;  // so few are sorted anew faster than their order is kept
    void sort_handful();                     // of keys in the order of their places
    template <size_t vectors>
    void sort_fours();  // of at most four times as many
    void repair_or_sort();

    Array<uint64_t> keys_, swap_;  // coordinate << 32 | place
};

}  // namespace lendulet
