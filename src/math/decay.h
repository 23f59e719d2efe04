// Exponential decay over a time step, from IEEE-exact operations only.
#pragma once

namespace lendulet {

struct Decay {
    float factor;  // exp(-rate h): what is left of a velocity
    float mean;    // (1 - exp(-rate h)) / (rate h): share of a constant acceleration that arrives, 1 without damping
};

// rate >= 0 in 1/s, h >= 0 in s. The exact solution of v' = a - rate v is v h-later = factor v + mean h a.
Decay decay(float rate, float h);

}  // namespace lendulet
