// Vectors, quaternions and matrices of the public interface and of every kernel.
//
// All types are plain aggregates over a scalar F: float for users, a SIMD vector of floats inside the kernels, so each
// formula exists once. SI units, radians, right-handed axes, column vectors, quaternions stored x y z w.
// Only IEEE-exact operations are used, so results do not depend on compiler, machine or SIMD width.
#pragma once

#include <cstdint>

#if defined(LENDULET_FORCE_INLINE)
// Set by who builds for one instruction set alone and wants small code.
#elif defined(_MSC_VER) && !defined(__clang__)
#define LENDULET_FORCE_INLINE __forceinline
#else
// Forced: units compiled for different instruction sets include these functions, and an out-of-line copy from one unit
// must never be picked by the linker for another.
#define LENDULET_FORCE_INLINE [[gnu::always_inline]] inline
#endif

namespace lendulet {

inline constexpr float pi = 3.14159265358979f;

// ---------------------------------------------------------------------------------------------------------------------
// Vectors

// A vector with components along x, y and z: direction, displacement, velocity, force or half extents.
template <class F>
struct Vec3T {
    F x{}, y{}, z{};
};
using Vec3 = Vec3T<float>;

template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator+(Vec3T<F> a, Vec3T<F> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator-(Vec3T<F> a, Vec3T<F> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator-(Vec3T<F> a) {
    return {-a.x, -a.y, -a.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator*(F s, Vec3T<F> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator*(Vec3T<F> a, F s) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F>& operator+=(Vec3T<F>& a, Vec3T<F> b) {
    return a = a + b;
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F>& operator-=(Vec3T<F>& a, Vec3T<F> b) {
    return a = a - b;
}
LENDULET_FORCE_INLINE constexpr Vec3& operator*=(Vec3& a, float s) { return a = s * a; }
LENDULET_FORCE_INLINE constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
LENDULET_FORCE_INLINE constexpr Vec3& operator/=(Vec3& a, float s) { return a = a / s; }
constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

template <class F>
LENDULET_FORCE_INLINE constexpr F dot(Vec3T<F> a, Vec3T<F> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> cross(Vec3T<F> a, Vec3T<F> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Component by component.
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> multiply(Vec3T<F> a, Vec3T<F> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

LENDULET_FORCE_INLINE float square_root(float a) { return __builtin_sqrtf(a); }
LENDULET_FORCE_INLINE constexpr float absolute(float a) { return __builtin_fabsf(a); }  // clears the sign of -0 too
LENDULET_FORCE_INLINE constexpr float maximum(float a, float b) { return a > b ? a : b; }
LENDULET_FORCE_INLINE constexpr float minimum(float a, float b) { return a < b ? a : b; }
LENDULET_FORCE_INLINE constexpr float clamp(float a, float lo, float hi) { return minimum(maximum(a, lo), hi); }
LENDULET_FORCE_INLINE float length(Vec3 a) { return square_root(dot(a, a)); }
LENDULET_FORCE_INLINE constexpr float length_squared(Vec3 a) { return dot(a, a); }
LENDULET_FORCE_INLINE constexpr Vec3 absolute(Vec3 a) { return {absolute(a.x), absolute(a.y), absolute(a.z)}; }
LENDULET_FORCE_INLINE constexpr Vec3 minimum(Vec3 a, Vec3 b) {
    return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
LENDULET_FORCE_INLINE constexpr Vec3 maximum(Vec3 a, Vec3 b) {
    return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}
LENDULET_FORCE_INLINE constexpr float max_component(Vec3 a) { return maximum(a.x, maximum(a.y, a.z)); }
LENDULET_FORCE_INLINE constexpr float min_component(Vec3 a) { return minimum(a.x, minimum(a.y, a.z)); }
// Component i of 0, 1, 2.
LENDULET_FORCE_INLINE constexpr float component(Vec3 a, int i) { return i == 0 ? a.x : i == 1 ? a.y : a.z; }
LENDULET_FORCE_INLINE constexpr void set_component(Vec3& a, int i, float v) { (i == 0 ? a.x : i == 1 ? a.y : a.z) = v; }
// The vector of length 1 along a, or `fallback` where a is too short to have a direction.
LENDULET_FORCE_INLINE Vec3 normalize(Vec3 a, Vec3 fallback = {1.0f, 0.0f, 0.0f}) {
    float m = max_component(absolute(a));
    if (!(m > 1e-37f)) return fallback;
    a = (1.0f / m) * a;  // first to unit size, so that neither tiny nor huge vectors under- or overflow when squared
    return (1.0f / length(a)) * a;
}
// A unit vector at right angles to the unit vector n.
LENDULET_FORCE_INLINE Vec3 perpendicular(Vec3 n) {
    Vec3 p = absolute(n.x) > 0.5f ? Vec3{n.y, -n.x, 0.0f} : Vec3{0.0f, n.z, -n.y};
    return (1.0f / square_root(dot(p, p))) * p;
}

// A point in the world, in metres. Its own type, so that differences of positions are exact concepts and a world with
// double-precision positions stays possible.
struct Position {
    float x{}, y{}, z{};
};
LENDULET_FORCE_INLINE constexpr Vec3 operator-(Position a, Position b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LENDULET_FORCE_INLINE constexpr Position operator+(Position a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
LENDULET_FORCE_INLINE constexpr Position operator-(Position a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LENDULET_FORCE_INLINE constexpr Position& operator+=(Position& a, Vec3 b) { return a = a + b; }
LENDULET_FORCE_INLINE constexpr Position& operator-=(Position& a, Vec3 b) { return a = a - b; }
constexpr bool operator==(Position a, Position b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
// The vector from the world's origin to p.
LENDULET_FORCE_INLINE constexpr Vec3 from_origin(Position p) { return {p.x, p.y, p.z}; }
// The point at v from the world's origin.
LENDULET_FORCE_INLINE constexpr Position at(Vec3 v) { return {v.x, v.y, v.z}; }

// ---------------------------------------------------------------------------------------------------------------------
// Rotations

// A rotation as a unit quaternion; the default is no rotation.
template <class F>
struct QuatT {
    F x{}, y{}, z{}, w{};
};
struct Quat {
    float x = 0.0f, y = 0.0f, z = 0.0f, w = 1.0f;
    constexpr operator QuatT<float>() const { return {x, y, z, w}; }
};
constexpr bool operator==(Quat a, Quat b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

// Rotation b followed by rotation a.
template <class F>
LENDULET_FORCE_INLINE constexpr QuatT<F> multiply(QuatT<F> a, QuatT<F> b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr QuatT<F> conjugate(QuatT<F> q) {
    return {-q.x, -q.y, -q.z, q.w};
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> rotate(QuatT<F> q, Vec3T<F> v) {
    Vec3T<F> u{q.x, q.y, q.z};
    Vec3T<F> t = cross(u, v) + q.w * v;
    Vec3T<F> c = cross(u, t);
    return v + (c + c);
}
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> rotate_inverse(QuatT<F> q, Vec3T<F> v) {
    return rotate(conjugate(q), v);
}
LENDULET_FORCE_INLINE constexpr Quat to_quat(QuatT<float> q) { return {q.x, q.y, q.z, q.w}; }
LENDULET_FORCE_INLINE constexpr Quat operator*(Quat a, Quat b) {
    return to_quat(multiply<float>(QuatT<float>(a), QuatT<float>(b)));
}
LENDULET_FORCE_INLINE constexpr Quat conjugate(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
LENDULET_FORCE_INLINE constexpr Vec3 rotate(Quat q, Vec3 v) { return rotate<float>(QuatT<float>(q), v); }
LENDULET_FORCE_INLINE constexpr Vec3 rotate_inverse(Quat q, Vec3 v) {
    return rotate<float>(QuatT<float>(conjugate(q)), v);
}
LENDULET_FORCE_INLINE constexpr float dot(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
LENDULET_FORCE_INLINE Quat normalize(Quat q) {
    float s = 1.0f / square_root(dot(q, q));
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

// Sine and cosine in single precision (error below 2 ulp for |angle| <= 1e4 rad), the same bits on every machine:
// no call of the C library, whose results differ between platforms.
struct SinCos {
    float sin, cos;
};
SinCos sin_cos(float angle_rad);
// Angle of the point (x, y) from the x axis, in (-pi, pi]; atan2(0, 0) = 0.
float arc_tangent2(float y, float x);
// In [0, pi]; the argument is clamped to [-1, 1].
float arc_cosine(float x);

// Rotation by `angle_rad` about `axis` (any length but zero).
Quat rotation_about(Vec3 axis, float angle_rad);
// The shortest rotation that takes unit vector a onto unit vector b.
Quat rotation_between(Vec3 a, Vec3 b);
// The share t (0: a, 1: b) of the even turn from a to b by the shorter way. (Shoemake, SIGGRAPH 1985)
Quat interpolate(Quat a, Quat b, float t);

// ---------------------------------------------------------------------------------------------------------------------
// Matrices

// A 3 x 3 matrix by columns.
struct Mat3 {
    Vec3 x{1.0f, 0.0f, 0.0f}, y{0.0f, 1.0f, 0.0f}, z{0.0f, 0.0f, 1.0f};
};
LENDULET_FORCE_INLINE constexpr Vec3 operator*(const Mat3& m, Vec3 v) { return v.x * m.x + v.y * m.y + v.z * m.z; }
LENDULET_FORCE_INLINE constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.x, a * b.y, a * b.z}; }
LENDULET_FORCE_INLINE constexpr Mat3 transpose(const Mat3& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
LENDULET_FORCE_INLINE constexpr float determinant(const Mat3& m) { return dot(m.x, cross(m.y, m.z)); }

// A symmetric 3 x 3 matrix: inertia and its inverse.
template <class F>
struct SymMat3T {
    F xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
};
using SymMat3 = SymMat3T<float>;
template <class F>
LENDULET_FORCE_INLINE constexpr Vec3T<F> operator*(const SymMat3T<F>& m, Vec3T<F> a) {
    return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
            m.xz * a.x + m.yz * a.y + m.zz * a.z};
}
template <class F>
LENDULET_FORCE_INLINE constexpr SymMat3T<F> operator+(const SymMat3T<F>& a, const SymMat3T<F>& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

// The rotation matrix of a unit quaternion; its columns are the rotated axes.
template <class F>
struct Mat3T {
    Vec3T<F> x, y, z;
};
template <class F>
LENDULET_FORCE_INLINE constexpr Mat3T<F> rotation_matrix(QuatT<F> q, F one) {
    F x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    F xx = x2 * q.x, yy = y2 * q.y, zz = z2 * q.z, xy = x2 * q.y, xz = x2 * q.z, yz = y2 * q.z;
    F wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
    return {
        {one - (yy + zz), xy + wz, xz - wy}, {xy - wz, one - (xx + zz), yz + wx}, {xz + wy, yz - wx, one - (xx + yy)}};
}
LENDULET_FORCE_INLINE constexpr Mat3 rotation_matrix(Quat q) {
    Mat3T<float> m = rotation_matrix<float>(QuatT<float>(q), 1.0f);
    return {m.x, m.y, m.z};
}
// R diag(d) R^T: a tensor given along its principal axes, turned into the frame that R leads to.
template <class F>
LENDULET_FORCE_INLINE constexpr SymMat3T<F> rotate_diagonal(const Mat3T<F>& r, Vec3T<F> d) {
    Vec3T<F> x = d.x * r.x, y = d.y * r.y, z = d.z * r.z;
    return {x.x * r.x.x + y.x * r.y.x + z.x * r.z.x, x.y * r.x.y + y.y * r.y.y + z.y * r.z.y,
            x.z * r.x.z + y.z * r.y.z + z.z * r.z.z, x.x * r.x.y + y.x * r.y.y + z.x * r.z.y,
            x.x * r.x.z + y.x * r.y.z + z.x * r.z.z, x.y * r.x.z + y.y * r.y.z + z.y * r.z.z};
}

// A rigid placement relative to some frame: rotate, then move.
struct Transform {
    Vec3 translation;
    Quat rotation;
};
LENDULET_FORCE_INLINE constexpr Vec3 operator*(const Transform& t, Vec3 p) {
    return t.translation + rotate(t.rotation, p);
}
LENDULET_FORCE_INLINE constexpr Transform operator*(const Transform& a, const Transform& b) {
    return {a * b.translation, a.rotation * b.rotation};
}
LENDULET_FORCE_INLINE constexpr Transform inverse(const Transform& t) {
    Quat q = conjugate(t.rotation);
    return {-rotate(q, t.translation), q};
}

// Where something is in the world.
struct Pose {
    Position position;
    Quat orientation;
};
LENDULET_FORCE_INLINE constexpr Position operator*(const Pose& a, Vec3 p) {
    return a.position + rotate(a.orientation, p);
}
LENDULET_FORCE_INLINE constexpr Pose operator*(const Pose& a, const Transform& b) {
    return {a * b.translation, a.orientation * b.rotation};
}
// The share t (0: a, 1: b) of the even motion from a to b: for what is drawn between two steps.
inline Pose interpolate(const Pose& a, const Pose& b, float t) {
    return {a.position + t * (b.position - a.position), interpolate(a.orientation, b.orientation, t)};
}
// The point p of the world, seen from the frame `a`.
LENDULET_FORCE_INLINE constexpr Vec3 to_local(const Pose& a, Position p) {
    return rotate_inverse(a.orientation, p - a.position);
}

// ---------------------------------------------------------------------------------------------------------------------
// Boxes

// An axis-aligned bounding box in the world.
struct Aabb {
    Position lower, upper;
};
LENDULET_FORCE_INLINE constexpr bool overlaps(const Aabb& a, const Aabb& b) {  // closed: touching counts
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

}  // namespace lendulet
