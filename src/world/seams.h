// The contacts with floors among which seams may be: those of colliders that touch several, and those with a mesh of
// which some manifolds silence others. Most bodies touch one floor at most and are passed over.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "world/pairs.h"

namespace lendulet {

class SeamList {
public:
    explicit SeamList(const Memory* memory) : first_(memory), floored_(memory), pairs_(memory) {}

    void clear();
    // Takes note of a pair, by its number. One that touches no floor is none of these.
    void add(uint32_t number, const ColliderPair& p);
    const Array<uint32_t>& pairs() const { return pairs_; }
    // Takes memory for so many of either.
    void reserve(size_t colliders, size_t pairs) {
        if (first_.size() < colliders) first_.resize(colliders, none);
        floored_.reserve(colliders);
        pairs_.reserve(pairs);
    }

private:
    static constexpr uint32_t none = 0xffffffffu, several = 0xfffffffeu;
    Array<uint32_t> first_;    // by collider: its first pair with a floor, or `several` once that is listed
    Array<uint32_t> floored_;  // colliders that have one
    Array<uint32_t> pairs_;
};

}  // namespace lendulet
