// Numbers that look random and are the same on every machine.
#pragma once

#include <cstdint>

#include "lendulet/math.h"

namespace lendulet {

// A linear congruential generator (Knuth, Lewis; as in "Numerical Recipes"), of which the upper bits are used.
struct RandomNumbers {
    uint32_t state;
    float in(float low, float high) {
        state = state * 1664525u + 1013904223u;
        return low + (high - low) * static_cast<float>(state >> 8) / 16777216.0f;
    }
    Vec3 vector(float most) {
        const float x = in(-most, most), y = in(-most, most), z = in(-most, most);
        return {x, y, z};
    }
    Quat turn() {
        const float x = in(-1.0f, 1.0f), y = in(-1.0f, 1.0f), z = in(-1.0f, 1.0f), w = in(0.2f, 1.0f);
        return normalize(Quat{x, y, z, w});
    }
};

}  // namespace lendulet
