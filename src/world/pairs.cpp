#include "world/pairs.h"

#include <algorithm>
#include <bit>

namespace lendulet {
namespace {

bool precedes(const BoxPair& a, const BoxPair& b) { return a.a != b.a ? a.a < b.a : a.b < b.b; }
uint64_t key(const ColliderPair& p) { return uint64_t{p.a} << 32 | p.b; }

constexpr int digit_bits = 11;
constexpr uint32_t radix = 1u << digit_bits;

}  // namespace

// Least significant digit first: by b, then by a. Comparison sort below the size where counting pays.
void PairTable::sort(Array<BoxPair>& boxes) {
    if (boxes.size() < 512) {
        std::sort(boxes.begin(), boxes.end(), precedes);  // order: total
        return;
    }
    uint32_t top = 0;
    for (const BoxPair& p : boxes) top |= p.a | p.b;
    int digits = (std::bit_width(top) + digit_bits - 1) / digit_bits;
    scratch_.resize_unset(boxes.size());
    for (int pass = 0; pass < 2 * digits; ++pass) {
        int shift = pass % digits * digit_bits;
        bool by_b = pass < digits;
        counts_.assign(radix, 0u);
        for (const BoxPair& p : boxes) ++counts_[((by_b ? p.b : p.a) >> shift) & (radix - 1)];
        uint32_t sum = 0;
        for (uint32_t& c : counts_) {
            uint32_t n = c;
            c = sum;
            sum += n;
        }
        for (const BoxPair& p : boxes) scratch_[counts_[((by_b ? p.b : p.a) >> shift) & (radix - 1)]++] = p;
        boxes.swap(scratch_);
    }
}

uint32_t PairTable::take_cache() {
    if (free_caches.empty()) {
        free_caches.push_back(static_cast<uint32_t>(caches.size()));
        caches.push_back(PairCache{});
        poses.push_back(KeptPose{});
        free_caches.reserve(caches.capacity());  // room for all, so that giving back takes no memory
    }
    uint32_t cache = free_caches.back();
    free_caches.pop_back();
    caches[cache] = PairCache{};
    poses[cache] = KeptPose{};
    poses[cache].clearance = unkept;
    return cache;
}

void PairTable::update(Array<BoxPair>& boxes) {
    sort(boxes);
    now.swap(before);
    now.resize_unset(boxes.size());
    // Two passes over the sorted lists: ended pairs first, so that new pairs can take over their places.
    size_t j = 0;
    for (ColliderPair& old : before) {
        while (j < boxes.size() && (uint64_t{boxes[j].a} << 32 | boxes[j].b) < key(old)) ++j;
        bool goes_on = j < boxes.size() && boxes[j].a == old.a && boxes[j].b == old.b && old.cache != no_cache;
        if (goes_on) continue;
        if (old.cache != no_cache) free_caches.push_back(old.cache), old.cache = no_cache;
        if (old.capacity == 1) free_single_.push_back(old.first_record);
        if (old.capacity > 1) free_mesh_.push_back(old.first_record);
    }
    j = 0;
    begun.clear();
    begun.reserve(now.capacity());
    for (size_t i = 0; i < boxes.size(); ++i) {
        ColliderPair p{};
        p.a = boxes[i].a, p.b = boxes[i].b;
        p.begun = true;
        while (j < before.size() && key(before[j]) < key(p)) ++j;
        if (j < before.size() && key(before[j]) == key(p) && before[j].cache != no_cache) {
            p = before[j];
        } else {
            p.cache = take_cache();
            begun.push_back(static_cast<uint32_t>(i));
        }
        now[i] = p;
    }
}

void PairTable::place_records(ColliderPair& pair, bool mesh) {
    pair.capacity = mesh ? max_mesh_manifolds : 1;
    Array<uint32_t>& free = mesh ? free_mesh_ : free_single_;
    if (free.empty()) {
        pair.first_record = record_count;
        record_count += pair.capacity;
        free.reserve(caches.capacity());
    } else {
        pair.first_record = free.back();
        free.pop_back();
    }
}

void PairTable::clear() {
    now.clear(), before.clear(), begun.clear();
    caches.clear(), poses.clear(), free_caches.clear();
    free_single_.clear(), free_mesh_.clear();
    record_count = 0;
}

ColliderPair& PairTable::add(uint32_t a, uint32_t b) {
    ColliderPair p{};
    p.a = a, p.b = b;
    p.cache = take_cache();
    return now.push_back(p);
}

void PairTable::remove_collider(uint32_t slot) {
    for (ColliderPair& p : now)
        if ((p.a == slot || p.b == slot) && p.cache != no_cache) free_caches.push_back(p.cache), p.cache = no_cache;
}

}  // namespace lendulet
