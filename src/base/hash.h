// 64-bit hash of words; the state hash of a world and keys of tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lendulet {

// Mixes one 64-bit word into a hash (the finaliser of splitmix64: Steele, Lea, Flood 2014).
inline uint64_t hash_combine(uint64_t hash, uint64_t word) {
    uint64_t z = hash * 0x9e3779b97f4a7c15ull + word + 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

// Mixes floats by their bits; -0 counts as 0, so that states that compare equal hash equal.
inline uint64_t hash_floats(uint64_t hash, const float* values, int count) {
    for (int i = 0; i < count; ++i) {
        float v = values[i] + 0.0f;
        uint32_t bits;
        std::memcpy(&bits, &v, sizeof bits);
        hash = hash_combine(hash, bits);
    }
    return hash;
}

}  // namespace lendulet
