// Double-precision vectors of the distance queries.
//
// Shapes are single precision, but differences of their points lose up to all of their digits near contact. Products of
// two floats are exact in double, so closest points and plane distances computed in double keep about 1e-15 of the
// shapes' size, at the same speed as floats in scalar code.
#pragma once

#include "lendulet/math.h"

namespace lendulet {

using Vec3d = Vec3T<double>;

LENDULET_FORCE_INLINE constexpr Vec3d to_double(Vec3 a) { return {a.x, a.y, a.z}; }
LENDULET_FORCE_INLINE constexpr Vec3 to_float(Vec3d a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
LENDULET_FORCE_INLINE double square_root(double a) { return __builtin_sqrt(a); }
LENDULET_FORCE_INLINE constexpr double absolute(double a) { return __builtin_fabs(a); }
// `size` where a is positive or zero, else -size. Without a branch: directions are as often of one sign as of the
// other, and a wrong guess takes as long as ten operations.
LENDULET_FORCE_INLINE double towards_sign(double size, double a) { return __builtin_copysign(size, a + 0.0); }
// Ordered as a is.
LENDULET_FORCE_INLINE constexpr double signed_square(double a) { return a * absolute(a); }
LENDULET_FORCE_INLINE constexpr double maximum(double a, double b) { return a > b ? a : b; }
LENDULET_FORCE_INLINE constexpr double minimum(double a, double b) { return a < b ? a : b; }
LENDULET_FORCE_INLINE constexpr double length_squared(Vec3d a) { return dot(a, a); }
LENDULET_FORCE_INLINE double length(Vec3d a) { return square_root(dot(a, a)); }
LENDULET_FORCE_INLINE constexpr double largest_component(Vec3d a) {
    return maximum(absolute(a.x), maximum(absolute(a.y), absolute(a.z)));
}

// Columns of a rotation.
struct Mat3d {
    Vec3d x, y, z;
};
LENDULET_FORCE_INLINE constexpr Vec3d operator*(const Mat3d& m, Vec3d v) { return v.x * m.x + v.y * m.y + v.z * m.z; }
// The transpose of m times v.
LENDULET_FORCE_INLINE constexpr Vec3d transpose_multiply(const Mat3d& m, Vec3d v) {
    return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
// The rotation of q exactly, also where rounding has left q slightly longer or shorter than 1.
LENDULET_FORCE_INLINE constexpr Mat3d exact_rotation(Quat q) {
    double x = q.x, y = q.y, z = q.z, w = q.w;
    double s = 2.0 / (x * x + y * y + z * z + w * w);
    double sx = s * x, sy = s * y, sz = s * z;
    return {{1.0 - (sy * y + sz * z), sx * y + sz * w, sx * z - sy * w},
            {sx * y - sz * w, 1.0 - (sx * x + sz * z), sy * z + sx * w},
            {sx * z + sy * w, sy * z - sx * w, 1.0 - (sx * x + sy * y)}};
}

}  // namespace lendulet
