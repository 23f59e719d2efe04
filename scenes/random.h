// Random numbers of scenes: the same on every machine and compiler. Draw each number in a statement of its own, since
// the order in which arguments are evaluated differs between compilers.
//
// Method: O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number
// Generation", HMC-CS-2014-0905 (2014): 64-bit linear congruential state, output by xor-shift and random rotation.
#pragma once

#include <cstdint>

#include "lendulet/math.h"

namespace lendulet::scenes {

class Random {
public:
    explicit Random(uint64_t seed = 0x853c49e6748fea9bull) : state_(seed) {}

    uint32_t next() {
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        uint32_t mixed = static_cast<uint32_t>(((state_ >> 18) ^ state_) >> 27);
        uint32_t turn = static_cast<uint32_t>(state_ >> 59);
        return (mixed >> turn) | (mixed << ((32 - turn) & 31));
    }
    // In [0, 1), in steps of 2^-24, so that every value is exact.
    float unit() { return static_cast<float>(next() >> 8) * (1.0f / 16777216.0f); }
    float range(float lower, float upper) { return lower + (upper - lower) * unit(); }

    // A unit vector, evenly spread: height and longitude of a point of the sphere are independent (Archimedes).
    Vec3 direction() {
        float z = range(-1.0f, 1.0f);
        SinCos longitude = sin_cos(range(0.0f, 2.0f * pi));
        float r = square_root(1.0f - z * z);
        return {r * longitude.cos, r * longitude.sin, z};
    }
    // A rotation, evenly spread: Shoemake, "Uniform random rotations", Graphics Gems III (1992).
    Quat rotation() {
        float u = unit();
        SinCos a = sin_cos(2.0f * pi * unit());
        SinCos b = sin_cos(2.0f * pi * unit());
        float s = square_root(1.0f - u), t = square_root(u);
        return {s * a.sin, s * a.cos, t * b.sin, t * b.cos};
    }

private:
    uint64_t state_;
};

}  // namespace lendulet::scenes
