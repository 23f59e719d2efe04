// Double-precision algebra of node transforms.
#include <cmath>

#include "io/gltf_nodes.h"

namespace lendulet {

Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3d operator*(double s, Vec3d a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d cross(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec3d operator*(const Mat3d& m, Vec3d v) { return v.x * m.x + v.y * m.y + v.z * m.z; }
Mat3d operator*(const Mat3d& a, const Mat3d& b) { return {a * b.x, a * b.y, a * b.z}; }
Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, a.linear * b.translation + a.translation};
}
Mat3d transpose(const Mat3d& m) { return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}}; }
double determinant(const Mat3d& m) { return dot(m.x, cross(m.y, m.z)); }

Quatd operator*(Quatd a, Quatd b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Mat3d matrix_of(Quatd q) {
    double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{1.0 - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy)},
            {2.0 * (xy - wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + wx)},
            {2.0 * (xz + wy), 2.0 * (yz - wx), 1.0 - 2.0 * (xx + yy)}};
}

// Takes the root of whichever of 4x^2, 4y^2, 4z^2, 4w^2 is largest, which is at least 1, so that nothing cancels.
Quatd quaternion_of(const Mat3d& m) {
    double xx = m.x.x, yy = m.y.y, zz = m.z.z;
    Quatd q;
    if (xx + yy + zz > 0.0) q = {m.y.z - m.z.y, m.z.x - m.x.z, m.x.y - m.y.x, 1.0 + xx + yy + zz};
    else if (xx > yy && xx > zz) q = {1.0 + xx - yy - zz, m.x.y + m.y.x, m.x.z + m.z.x, m.y.z - m.z.y};
    else if (yy > zz) q = {m.x.y + m.y.x, 1.0 - xx + yy - zz, m.y.z + m.z.y, m.z.x - m.x.z};
    else q = {m.x.z + m.z.x, m.y.z + m.z.y, 1.0 - xx - yy + zz, m.x.y - m.y.x};
    double s = 1.0 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

Vec3 to_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Quat to_float(Quatd q) {
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

}  // namespace lendulet
