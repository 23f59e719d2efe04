// Exponential decay over a time step, from IEEE-exact operations only.
#pragma once

namespace lendulet {

struct Decay {
    float loss;  // 1 - exp(-rate h): share of a velocity that is lost, to full precision where it is small
    float mean;  // (1 - exp(-rate h)) / (rate h): share of a constant acceleration that arrives, 1 without damping
};

// rate >= 0 in 1/s, h >= 0 in s. The exact solution of v' = a - rate v is after h = v - loss v + mean h a.
Decay decay(float rate, float h);

}  // namespace lendulet
