// Stable slots with generations: the bookkeeping behind every kind of handle. A slot keeps its index for life and is
// used again after removal with a higher generation, so that old handles are recognised. The upper eight bits of a
// generation are the number of the world, so that handles of another world are recognised too.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace lendulet {

class Slots {
public:
    // `world`: 1 to 255.
    Slots(const Memory* memory, uint32_t world)
        : first_generation_(world << world_shift), generation_(memory), free_(memory), order_(memory), place_(memory) {}

    // A slot for a new object; its data arrays must then be resized to capacity().
    uint32_t add() {
        uint32_t slot;
        if (free_.empty()) {
            slot = static_cast<uint32_t>(generation_.size());
            generation_.push_back(first_generation_);
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
        generation_[slot] = first_generation_ | ((generation_[slot] + 1) & count_mask);
        free_.push_back(slot);
        place_[slot] = ~0u;
    }
    bool alive(uint32_t slot, uint32_t generation) const {
        return slot < generation_.size() && generation_[slot] == generation && place_[slot] != ~0u;
    }
    // Whether a handle of this (non-zero) generation is from another world.
    bool foreign(uint32_t generation) const {
        return generation != 0 && generation >> world_shift != first_generation_ >> world_shift;
    }
    uint32_t generation(uint32_t slot) const { return generation_[slot]; }
    size_t capacity() const { return generation_.size(); }
    int count() const { return order_.count(); }
    // Rises with the time of creation; valid until the next removal.
    uint32_t place(uint32_t slot) const { return place_[slot]; }
    uint32_t in_order(int index) const { return order_[static_cast<size_t>(index)]; }  // slots by creation
    const Array<uint32_t>& order() const { return order_; }

private:
    static constexpr int world_shift = 24;
    static constexpr uint32_t count_mask = (1u << world_shift) - 1;
    uint32_t first_generation_;
    Array<uint32_t> generation_, free_, order_, place_;
};

}  // namespace lendulet
