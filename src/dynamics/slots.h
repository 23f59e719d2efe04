// Stable slots with generations: the bookkeeping behind every kind of handle. A slot keeps its index for life and is
// used again after removal with a higher generation, so that old handles are recognised.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace lendulet {

class Slots {
public:
    explicit Slots(const Memory* memory) : generation_(memory), free_(memory), order_(memory), place_(memory) {}

    // A slot for a new object; its data arrays must then be resized to capacity().
    uint32_t add() {
        uint32_t slot;
        if (free_.empty()) {
            slot = static_cast<uint32_t>(generation_.size());
            generation_.push_back(1u);
            place_.push_back(0u);
        } else {
            slot = free_.back();
            free_.pop_back();
        }
        place_[slot] = static_cast<uint32_t>(order_.size());
        order_.push_back(slot);
        return slot;
    }
    // Frees a slot; cost is that of moving the younger entries of the creation order down by one.
    void remove(uint32_t slot) {
        size_t at = place_[slot];
        for (size_t i = at + 1; i < order_.size(); ++i) {
            order_[i - 1] = order_[i];
            place_[order_[i - 1]] = static_cast<uint32_t>(i - 1);
        }
        order_.pop_back();
        generation_[slot] = generation_[slot] + 1 == 0 ? 1 : generation_[slot] + 1;
        free_.push_back(slot);
        place_[slot] = ~0u;
    }
    bool alive(uint32_t slot, uint32_t generation) const {
        return slot < generation_.size() && generation_[slot] == generation && place_[slot] != ~0u;
    }
    uint32_t generation(uint32_t slot) const { return generation_[slot]; }
    size_t capacity() const { return generation_.size(); }
    int count() const { return order_.count(); }
    uint32_t in_order(int index) const { return order_[static_cast<size_t>(index)]; }  // slots by creation
    const Array<uint32_t>& order() const { return order_; }

private:
    Array<uint32_t> generation_, free_, order_, place_;
};

}  // namespace lendulet
