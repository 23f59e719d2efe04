// Trigonometric functions and rotations of lendulet/math.h.
//
// Everything is computed in double precision from additions, multiplications, divisions and square roots alone, which
// IEEE 754 defines to the bit, and rounded to single precision once at the end. Errors are therefore close to half an
// ulp, and the results are the same on every machine, which those of a C library are not.
#include "lendulet/math.h"

#include <bit>

namespace lendulet {

namespace {

constexpr double pi_double = 3.14159265358979323846;

double absolute_value(double a) { return a < 0.0 ? -a : a; }

// An angle less than or equal to pi/4 in size, and how many quarter turns were taken away (modulo 4).
struct Reduced {
    double angle;
    uint32_t quadrant;
};

// Cody and Waite (1980): pi/2 as a sum of a part of 33 bits, whose product with the number of quarter turns is exact,
// and the rest. Good for less than 2^20 quarter turns.
Reduced reduce_moderate(double x) {
    constexpr double two_over_pi = 0.6366197723675814;
    constexpr double half_pi_high = 1.5707963267341256, half_pi_low = 6.077100506506192e-11;
    constexpr double to_integer = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to the nearest whole number
    double turns = (x * two_over_pi + to_integer) - to_integer;
    double angle = (x - turns * half_pi_high) - turns * half_pi_low;
    return {angle, static_cast<uint32_t>(static_cast<int32_t>(turns)) & 3u};
}

// Payne and Hanek (1983) for large arguments x = m 2^e with a whole number m of 24 bits: only those binary digits of
// 1/(2 pi) matter that do not give whole turns. The fraction of a turn is kept to 64 bits.
Reduced reduce_large(float x) {
    // 32 zero bits, then the first binary digits of 1/(2 pi).
    static constexpr uint32_t digits[9] = {0x00000000, 0x28be60db, 0x9391054a, 0x7f09d5f4, 0x7d4d3770,
                                           0x36d8a566, 0x4f10e410, 0x7f9458ea, 0xf7aef158};
    uint32_t bits = std::bit_cast<uint32_t>(x);
    uint64_t m = (bits & 0x7fffffu) | 0x800000u;
    uint32_t first = ((bits >> 23) & 0xffu) - 150u + 32u;  // position in `digits` of the first digit worth < 1 turn
    uint32_t word = first >> 5, shift = first & 31u;
    auto digits_at = [&](uint32_t i) {
        uint64_t pair = (static_cast<uint64_t>(digits[word + i]) << 32) | digits[word + i + 1];
        return (pair >> (32u - shift)) & 0xffffffffu;
    };
    // m times 96 digits, modulo one turn.
    uint64_t low = m * digits_at(2);
    uint64_t turn = m * digits_at(1) + (low >> 32) + ((m * digits_at(0)) << 32);
    uint64_t quadrant = (turn + (uint64_t{1} << 61)) >> 62;
    auto rest = static_cast<int64_t>(turn - (quadrant << 62));
    constexpr double radians_per_unit = 3.4061215800865545e-19;  // 2 pi / 2^64
    double angle = static_cast<double>(rest) * radians_per_unit;
    auto q = static_cast<uint32_t>(quadrant) & 3u;
    return x < 0.0f ? Reduced{-angle, (4u - q) & 3u} : Reduced{angle, q};
}

// Taylor series, cut off where the next term is below 2e-11 (sine) and 2e-10 (cosine) for |a| <= pi/4.
double sine_series(double a) {
    double s = a * a;
    double p = -1.0 / 39916800.0;
    p = 1.0 / 362880.0 + s * p;
    p = -1.0 / 5040.0 + s * p;
    p = 1.0 / 120.0 + s * p;
    p = -1.0 / 6.0 + s * p;
    return a + a * (s * p);
}
double cosine_series(double a) {
    double s = a * a;
    double p = 1.0 / 479001600.0;
    p = -1.0 / 3628800.0 + s * p;
    p = 1.0 / 40320.0 + s * p;
    p = -1.0 / 720.0 + s * p;
    p = 1.0 / 24.0 + s * p;
    p = -0.5 + s * p;
    return 1.0 + s * p;
}

// Arc tangent of t in [0, 1]: the nearest k/4 is taken off by the addition theorem, which leaves |u| <= 1/8, where six
// terms of the series suffice for 1e-12.
double arc_tangent_unit(double t) {
    static constexpr double quarters[5] = {0.0, 0.24497866312686414, 0.4636476090008061, 0.6435011087932844,
                                           0.7853981633974483};
    int k = static_cast<int>(4.0 * t + 0.5);
    double c = 0.25 * k;
    double u = (t - c) / (1.0 + t * c);
    double s = u * u;
    double p = -1.0 / 11.0;
    p = 1.0 / 9.0 + s * p;
    p = -1.0 / 7.0 + s * p;
    p = 1.0 / 5.0 + s * p;
    p = -1.0 / 3.0 + s * p;
    return quarters[k] + (u + u * (s * p));
}

double arc_tangent(double y, double x) {
    double ax = absolute_value(x), ay = absolute_value(y);
    double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    if (large == 0.0) return 0.0;
    double angle = arc_tangent_unit(small == large ? 1.0 : small / large);  // equal: also where both are infinite
    if (ay > ax) angle = 0.5 * pi_double - angle;
    if (x < 0.0) angle = pi_double - angle;
    return y < 0.0 ? -angle : angle;
}

using Vec3d = Vec3T<double>;
Vec3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) { return (1.0 / __builtin_sqrt(dot(v, v))) * v; }

Quat unit_quat(Vec3d v, double w) {
    double s = 1.0 / __builtin_sqrt(dot(v, v) + w * w);
    return {static_cast<float>(s * v.x), static_cast<float>(s * v.y), static_cast<float>(s * v.z),
            static_cast<float>(s * w)};
}

}  // namespace

SinCos sin_cos(float angle_rad) {
    float not_finite = angle_rad - angle_rad;  // 0, or NaN for an infinity or NaN
    if (not_finite != 0.0f) return {not_finite, not_finite};
    Reduced r = absolute(angle_rad) < 1e6f ? reduce_moderate(angle_rad) : reduce_large(angle_rad);
    auto s = static_cast<float>(sine_series(r.angle)), c = static_cast<float>(cosine_series(r.angle));
    switch (r.quadrant) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

float arc_tangent2(float y, float x) {
    if (x != x || y != y) return x + y;
    return static_cast<float>(arc_tangent(y, x));
}

float arc_cosine(float x) {
    double c = clamp(x, -1.0f, 1.0f);
    return static_cast<float>(arc_tangent(__builtin_sqrt((1.0 - c) * (1.0 + c)), c));
}

Quat rotation_about(Vec3 axis, float angle_rad) {
    SinCos half = sin_cos(0.5f * angle_rad);
    Vec3d a = to_double(normalize(axis));
    return unit_quat(static_cast<double>(half.sin) * a, half.cos);
}

// With the angle t between a and b, a x b = sin t n = 2 sin(t/2) cos(t/2) n and |a + b| = 2 cos(t/2): hence
// (a x b, |a + b|^2 / 2) = 2 cos(t/2) (sin(t/2) n, cos(t/2)), without the cancellation of 1 + a.b near half a turn.
Quat rotation_between(Vec3 a, Vec3 b) {
    Vec3d from = unit(to_double(a)), to = unit(to_double(b));
    Vec3d sum = from + to;
    double twice_cosine_squared = 0.5 * dot(sum, sum);
    if (twice_cosine_squared < 1e-20) {  // opposite: half a turn about any axis at right angles
        Vec3 axis = perpendicular(normalize(a));
        return unit_quat(to_double(axis), 0.0);
    }
    return unit_quat(cross(from, to), twice_cosine_squared);
}

Quat interpolate(Quat a, Quat b, float t) {
    Quat turn = conjugate(a) * b;
    const float sign = turn.w < 0.0f ? -1.0f : 1.0f;
    const Vec3 axis{turn.x, turn.y, turn.z};
    const float sine = length(axis);  // of half the turn
    if (!(sine > 0.0f)) return a;
    return normalize(a * rotation_about(sign * axis, 2.0f * t * arc_tangent2(sine, sign * turn.w)));
}

}  // namespace lendulet
