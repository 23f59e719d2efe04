#include "math/decay.h"

namespace lendulet {
namespace {

// exp(-y) for 0 <= y: halved until the Taylor series converges at once, then squared back.
double exponential_of_minus(double y) {
    if (y > 100.0) return 0.0;
    int halvings = 0;
    while (y > 0.125) y *= 0.5, ++halvings;
    double sum = 1.0, term = 1.0;
    for (int n = 1; n <= 12; ++n) {
        term *= -y / n;
        sum += term;
    }
    while (halvings-- > 0) sum *= sum;
    return sum;
}

}  // namespace

Decay decay(float rate, float h) {
    double y = static_cast<double>(rate) * h;
    if (!(y > 0.0)) return {0.0f, 1.0f};
    double factor = exponential_of_minus(y);
    double mean = y < 1e-3 ? 1.0 - y * (0.5 - y * (1.0 / 6.0 - y / 24.0)) : (1.0 - factor) / y;
    return {static_cast<float>(mean * y), static_cast<float>(mean)};
}

}  // namespace lendulet
