#include "world/pairs.h"

#include <algorithm>
#include <bit>

namespace lendulet {
namespace {

template <class Pair>
bool precedes(const Pair& a, const Pair& b) {
    return a.a != b.a ? a.a < b.a : a.b < b.b;
}

constexpr int most_digit_bits = 13;  // counts that stay in the first-level cache

}  // namespace

// Least significant digit first: by b, then by a. Comparison sort below the size where counting pays.
void PairTable::sort(Array<BoxPair>& boxes) {
    if (boxes.size() < 512) {
        std::sort(boxes.begin(), boxes.end(), precedes<BoxPair>);  // order: total
        return;
    }
    uint32_t top = 0;
    for (const BoxPair& p : boxes) top |= p.a | p.b;
    const int bits = std::bit_width(top), digits = (bits + most_digit_bits - 1) / most_digit_bits;
    const int digit_bits = (bits + digits - 1) / digits;
    const uint32_t mask = (1u << digit_bits) - 1;
    scratch_.resize_unset(boxes.size());
    for (int pass = 0; pass < 2 * digits; ++pass) {
        int shift = pass % digits * digit_bits;
        bool by_b = pass < digits;
        counts_.assign(mask + 1, 0u);
        for (const BoxPair& p : boxes) ++counts_[((by_b ? p.b : p.a) >> shift) & mask];
        uint32_t sum = 0;
        for (uint32_t& c : counts_) {
            uint32_t n = c;
            c = sum;
            sum += n;
        }
        for (const BoxPair& p : boxes) scratch_[counts_[((by_b ? p.b : p.a) >> shift) & mask]++] = p;
        boxes.swap(scratch_);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Pairs that begin and end

void PairTable::hang(uint32_t collider, uint32_t link) {
    Links& all = first_[collider];
    links_[link] = {all.link, no_pair};
    if (all.link != no_pair) links_[all.link].previous = link;
    all.link = link;
    ++all.count;
}

void PairTable::unhang(uint32_t collider, uint32_t link) {
    const Link l = links_[link];
    if (l.next != no_pair) links_[l.next].previous = l.previous;
    if (l.previous != no_pair) links_[l.previous].next = l.next;
    else first_[collider].link = l.next;
    --first_[collider].count;
}

void PairTable::make_room(size_t more) {
    if (more <= free_.size()) return;
    const size_t needed = pairs.size() + (more - free_.size());
    pairs.reserve(needed), caches.reserve(needed), poses.reserve(needed);
    links_.reserve(2 * needed);
}

void PairTable::reserve(size_t n) {
    pairs.reserve(n), caches.reserve(n), poses.reserve(n);
    links_.reserve(2 * n);
    for (Array<uint32_t>* numbers : {&free_, &ended_, &free_single_}) numbers->reserve(n);
    for (Array<ListedPair>* list : {&listed, &coming_, &merged_}) list->reserve(n);
}

void PairTable::make_ready(size_t n) {
    pairs.make_ready(n), caches.make_ready(n), poses.make_ready(n);
    links_.make_ready(2 * n);
    for (Array<uint32_t>* numbers : {&free_, &ended_, &free_single_}) numbers->make_ready(n);
    for (Array<ListedPair>* list : {&listed, &coming_, &merged_}) list->make_ready(n);
    scratch_.make_ready(n);
}

uint32_t PairTable::begin(uint32_t a, uint32_t b, size_t colliders) {
    if (free_.empty()) {
        free_.push_back(static_cast<uint32_t>(pairs.size()));
        pairs.push_back({});
        caches.push_back(PairCache{});
        poses.push_back(KeptPose{});
        links_.resize_unset(2 * pairs.size());
        // Room for all, so that giving back takes no memory.
        for (Array<uint32_t>* numbers : {&free_, &ended_}) numbers->reserve(pairs.capacity());
        for (Array<ListedPair>* list : {&listed, &coming_, &merged_}) list->reserve(pairs.capacity());
    }
    uint32_t number = free_.back();
    free_.pop_back();
    ColliderPair p{};
    p.a = a, p.b = b;
    p.begun = true;
    pairs[number] = p;
    caches[number] = PairCache{};
    poses[number] = KeptPose{};
    poses[number].clearance = unkept;
    first_.resize(colliders);
    hang(a, 2 * number);
    hang(b, 2 * number + 1);
    list(number);
    return number;
}

void PairTable::place_records(ColliderPair& pair, bool mesh) {
    pair.capacity = mesh ? max_mesh_manifolds : 1;
    Array<uint32_t>& free = mesh ? free_mesh_ : free_single_;
    if (free.empty()) {
        pair.first_record = record_count_;
        record_count_ += pair.capacity;
        free.reserve(pairs.capacity());
    } else {
        pair.first_record = free.back();
        free.pop_back();
    }
    if (mesh) place_surface(pair);
}

void PairTable::place_surface(ColliderPair& pair) {
    if (free_surface_.empty()) {
        if (near_triangles.size() == near_triangles.capacity())
            near_triangles.reserve(std::min(first_.size(), most_expected));
        pair.surface = static_cast<uint32_t>(near_triangles.size());
        near_triangles.push_back(MeshCandidates{});
        free_surface_.reserve(pairs.capacity());
    } else {
        pair.surface = free_surface_.back();
        free_surface_.pop_back();
        near_triangles[pair.surface].count = -1;
    }
}

void PairTable::clear() {
    pairs.clear(), caches.clear(), poses.clear(), listed.clear();
    links_.clear(), first_.clear(), coming_.clear();
    free_.clear(), ended_.clear();
    free_single_.clear(), free_mesh_.clear();
    near_triangles.clear(), free_surface_.clear();
    record_count_ = 0;
}

void PairTable::end(uint32_t number) { end(number, pairs[number].listed ? ended_ : free_); }

void PairTable::take_off(uint32_t number) { end(number, free_); }

void PairTable::end(uint32_t number, Array<uint32_t>& numbers) {
    ColliderPair& p = pairs[number];
    unhang(p.a, 2 * number);
    unhang(p.b, 2 * number + 1);
    if (p.capacity == 1) free_single_.push_back(p.first_record);
    if (p.capacity > 1) free_mesh_.push_back(p.first_record), free_surface_.push_back(p.surface);
    numbers.push_back(number);
    p.a = no_pair;
    p.count = 0;
    p.hit = p.touches = false;
}

uint32_t PairTable::find(uint32_t a, uint32_t b) const {
    if (a >= first_.size() || b >= first_.size()) return no_pair;
    bool through_a = first_[a].count < first_[b].count;
    for (uint32_t link = first_[through_a ? a : b].link; link != no_pair; link = links_[link].next) {
        const ColliderPair& p = pairs[link / 2];
        if (p.a == a && p.b == b) return link / 2;
    }
    return no_pair;
}

void PairTable::give_back_ended() {
    free_.append(ended_.data(), ended_.size());
    ended_.clear();
}

// ---------------------------------------------------------------------------------------------------------------------
// The list

void PairTable::list(uint32_t number) {
    ColliderPair& p = pairs[number];
    p.listed = true;
    coming_.push_back({p.a, p.b, number});
}

void PairTable::merge() {
    // Where all pairs were sought they begin in order.
    if (!std::is_sorted(coming_.begin(), coming_.end(), precedes<ListedPair>))
        std::sort(coming_.begin(), coming_.end(), precedes<ListedPair>);  // order: total
    merged_.resize_unset(listed.size() + coming_.size());
    std::merge(listed.begin(), listed.end(), coming_.begin(), coming_.end(), merged_.begin(), precedes<ListedPair>);
    listed.swap(merged_);
    coming_.clear();
}

}  // namespace lendulet
