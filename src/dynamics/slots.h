// Stable slots with generations: the bookkeeping behind every kind of handle. A slot keeps its index for life and is
// used again after removal with a higher generation, so that old handles are recognised. The upper eight bits of a
// generation are the number of the world, so that handles of another world are recognised too.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/memory.h"

namespace lendulet {

template <class T>
void copy_array(const Array<T>& from, Array<T>& to) {
    to.clear();
    to.append(from.data(), from.size());
}

// Names an object of one kind for good: its slot, and how many had given that back before.
struct SlotUse {
    uint32_t slot = ~0u, uses = 0;
    friend bool operator==(const SlotUse&, const SlotUse&) = default;
};

class Slots {
public:
    // `world`: 1 to 255.
    Slots(const Memory* memory, uint32_t world)
        : first_generation_(world << world_shift),
          generation_(memory),
          latest_(memory),
          free_(memory),
          alive_(memory),
          order_(memory),
          place_(memory) {}

    // A slot for a new object; its data arrays must then be resized to capacity().
    uint32_t add() {
        uint32_t slot;
        if (free_.empty()) {
            slot = static_cast<uint32_t>(generation_.size());
            generation_.push_back(first_generation_);
            latest_.push_back(0u);
            place_.push_back(0u);
            alive_.push_back(0u);
        } else {
            slot = free_.back();
            free_.pop_back();
        }
        if (holes_.load(std::memory_order_relaxed) > count_) close_holes();
        place_[slot] = static_cast<uint32_t>(order_.size());
        order_.push_back(slot);
        alive_[slot] = 1;
        ++count_;
        return slot;
    }
    // Frees a slot. Leaves a hole in the order, which the next reader of it closes.
    void remove(uint32_t slot) {
        uint32_t at = place_[slot];
        order_[at] = hole;
        if (at < first_hole_) first_hole_ = at;
        holes_.store(holes_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        generation_[slot] = generation_after(++latest_[slot]);
        free_.push_back(slot);
        alive_[slot] = 0;
        --count_;
    }
    bool alive(uint32_t slot, uint32_t generation) const {
        return slot < generation_.size() && generation_[slot] == generation && alive_[slot];
    }
    // Whether a handle of this (non-zero) generation is from another world.
    bool foreign(uint32_t generation) const {
        return generation != 0 && generation >> world_shift != first_generation_ >> world_shift;
    }
    uint32_t generation(uint32_t slot) const { return generation_[slot]; }
    size_t capacity() const { return generation_.size(); }
    int count() const { return count_; }
    // Rises with the time of creation; valid until something is added or the order is read. For writing calls.
    uint32_t place(uint32_t slot) const { return place_[slot]; }
    // The first of them, where there are any.
    uint32_t oldest() {
        while (order_[first_] == hole) ++first_;
        return order_[first_];
    }
    // Slots by creation. After removals the first call moves the younger ones down; several threads may call at once.
    const Array<uint32_t>& order() const {
        if (holes_.load(std::memory_order_acquire) > 0) close_holes();
        return order_;
    }
    uint32_t in_order(int index) const { return order()[static_cast<size_t>(index)]; }
    // How often the slot was given back: its generation without the number of the world.
    uint32_t uses(uint32_t slot) const { return generation_[slot] & count_mask; }
    SlotUse use(uint32_t slot) const { return {slot, uses(slot)}; }
    // Whether that object is alive.
    bool holds(SlotUse use) const {
        return use.slot < generation_.size() && alive_[use.slot] && uses(use.slot) == use.uses;
    }

    // The generation of a slot that was given back so often.
    uint32_t generation_after(uint32_t uses) const { return first_generation_ | (uses & count_mask); }
    static uint32_t uses_of(uint32_t generation) { return generation & count_mask; }

    // Which slots are handed out next, the last of them first. For snapshots.
    const Array<uint32_t>& free_list() const { return free_; }
    // The free slot is that of an object again which had been removed, and is about to be among those alive. When this
    // one goes, the next gets a generation that none had before.
    void give_back(SlotUse use) { generation_[use.slot] = generation_after(use.uses); }
    // Makes these alive, in this order, others having been removed before, and brings the list of free ones back to
    // what it was when there were `capacity` slots: new objects then get the slots that they would have got at that
    // time. Slots made since come in their order after those of the list.
    void set_alive(const Array<uint32_t>& order, const Array<uint32_t>& free_list, size_t capacity) {
        copy_array(order, order_);
        alive_.assign(generation_.size(), 0);
        for (size_t i = 0; i < order.size(); ++i) alive_[order[i]] = 1, place_[order[i]] = static_cast<uint32_t>(i);
        count_ = order.count();
        first_ = 0;
        first_hole_ = hole;
        holes_.store(0, std::memory_order_relaxed);
        free_.clear();
        for (size_t slot = generation_.size(); slot > capacity; --slot)
            free_.push_back(static_cast<uint32_t>(slot - 1));
        free_.append(free_list.data(), free_list.size());
    }

    // Becomes a copy of another world's slots, which knows its handles.
    void copy(const Slots& o) {
        first_generation_ = o.first_generation_;
        count_ = o.count_;
        copy_array(o.order(), order_);
        copy_array(o.generation_, generation_);
        copy_array(o.latest_, latest_);
        copy_array(o.free_, free_);
        copy_array(o.alive_, alive_);
        copy_array(o.place_, place_);
        first_ = 0;
        first_hole_ = hole;
        holes_.store(0, std::memory_order_relaxed);
    }

private:
    static constexpr uint32_t hole = ~0u;
    void close_holes() const {
        while (busy_.exchange(true, std::memory_order_acquire)) {}
        if (holes_.load(std::memory_order_relaxed) > 0) {
            size_t kept = first_hole_;
            for (size_t i = kept; i < order_.size(); ++i) {
                if (order_[i] == hole) continue;
                place_[order_[i]] = static_cast<uint32_t>(kept);
                order_[kept++] = order_[i];
            }
            order_.resize_unset(kept);
            first_ = 0;
            first_hole_ = hole;
            holes_.store(0, std::memory_order_release);
        }
        busy_.store(false, std::memory_order_release);
    }

    static constexpr int world_shift = 24;
    static constexpr uint32_t count_mask = (1u << world_shift) - 1;
    uint32_t first_generation_;
    int count_ = 0;
    Array<uint32_t> generation_;
    Array<uint32_t> latest_;  // uses of the slot; more than its generation tells where an object came back
    Array<uint32_t> free_;
    Array<uint8_t> alive_;
    // What the next reader of the order may have to close holes in.
    mutable Array<uint32_t> order_, place_;  // place_: in order_, or hole
    mutable uint32_t first_hole_ = hole;
    mutable uint32_t first_ = 0;  // before it are only holes
    mutable std::atomic<int> holes_{0};
    mutable std::atomic<bool> busy_{false};
};

}  // namespace lendulet
