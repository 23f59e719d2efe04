#include "geometry/mass.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
using SymMat3d = SymMat3T<double>;

Vec3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3 to_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
SymMat3d to_double(const SymMat3& m) { return {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}; }
SymMat3 to_float(const SymMat3d& m) {
    return {static_cast<float>(m.xx), static_cast<float>(m.yy), static_cast<float>(m.zz),
            static_cast<float>(m.xy), static_cast<float>(m.xz), static_cast<float>(m.yz)};
}

// Inertia of a point mass at d.
SymMat3d point_inertia(double mass, Vec3d d) {
    Vec3d q = mass * multiply(d, d);
    return {q.y + q.z, q.z + q.x, q.x + q.y, -mass * d.x * d.y, -mass * d.x * d.z, -mass * d.y * d.z};
}

// R M R^T: the columns of M R^T are M times the rows of R.
SymMat3d turned(const SymMat3d& m, const Mat3T<double>& r) {
    Vec3d row[3] = {{r.x.x, r.y.x, r.z.x}, {r.x.y, r.y.y, r.z.y}, {r.x.z, r.y.z, r.z.z}};
    Vec3d x = m * row[0], y = m * row[1], z = m * row[2];
    return {dot(row[0], x), dot(row[1], y), dot(row[2], z), dot(row[0], y), dot(row[0], z), dot(row[1], z)};
}

}  // namespace

MassProperties placed(const MassProperties& solid, const Transform& placement) {
    Quat q = placement.rotation;
    double n = 1.0 / __builtin_sqrt(double{q.x} * q.x + double{q.y} * q.y + double{q.z} * q.z + double{q.w} * q.w);
    QuatT<double> unit{n * q.x, n * q.y, n * q.z, n * q.w};
    MassProperties r;
    r.mass = solid.mass;
    r.centre = to_float(to_double(placement.translation) + rotate(unit, to_double(solid.centre)));
    r.inertia = to_float(turned(to_double(solid.inertia), rotation_matrix(unit, 1.0)));
    return r;
}

MassProperties combined(std::span<const MassProperties> parts) {
    double mass = 0.0;
    Vec3d first{};
    for (const MassProperties& p : parts) {
        mass += p.mass;
        first += double{p.mass} * to_double(p.centre);
    }
    if (!(mass > 0.0)) return {};
    Vec3d centre = (1.0 / mass) * first;
    SymMat3d inertia{};
    for (const MassProperties& p : parts)
        inertia = inertia + to_double(p.inertia) + point_inertia(p.mass, to_double(p.centre) - centre);
    return {static_cast<float>(mass), to_float(centre), to_float(inertia)};
}

MassProperties with_mass(const MassProperties& solid, float mass) {
    if (!(solid.mass > 0.0f)) return {mass, solid.centre, {}};
    double s = double{mass} / solid.mass;
    const SymMat3& i = solid.inertia;
    SymMat3d scaled{s * i.xx, s * i.yy, s * i.zz, s * i.xy, s * i.xz, s * i.yz};
    return {mass, solid.centre, to_float(scaled)};
}

namespace {

// One Jacobi rotation (Golub, van Loan, "Matrix Computations", 8.5.2) that makes the entry `pq` vanish. p, q, r are in
// cyclic order, and the rotation is one about axis r by an angle of at most 45 degrees.
struct Sweep {
    double diagonal[3];  // of the tensor, by axis
    double off[3];       // entry opposite to an axis: off[2] = xy
    QuatT<double> rotation{0.0, 0.0, 0.0, 1.0};

    void rotate_about(int r) {
        int p = (r + 1) % 3, q = (r + 2) % 3;
        if (off[r] == 0.0) return;
        double theta = (diagonal[q] - diagonal[p]) / (2.0 * off[r]);
        double size = theta < 0.0 ? -theta : theta;
        double t = 1.0 / (size + __builtin_sqrt(theta * theta + 1.0));
        if (theta < 0.0) t = -t;
        double c = 1.0 / __builtin_sqrt(t * t + 1.0), s = t * c;
        diagonal[p] -= t * off[r];
        diagonal[q] += t * off[r];
        double rp = off[q], rq = off[p];
        off[q] = c * rp - s * rq;
        off[p] = s * rp + c * rq;
        off[r] = 0.0;
        // The columns of the rotation are c e_p - s e_q and s e_p + c e_q: a turn about r by minus the angle.
        double half_cosine = __builtin_sqrt(0.5 * (1.0 + c)), half_sine = -0.5 * s / half_cosine;
        rotation = multiply(
            rotation, {r == 0 ? half_sine : 0.0, r == 1 ? half_sine : 0.0, r == 2 ? half_sine : 0.0, half_cosine});
    }
    double off_size() const { return off[0] * off[0] + off[1] * off[1] + off[2] * off[2]; }
};

}  // namespace

PrincipalInertia principal_axes(const SymMat3& tensor) {
    SymMat3d m = to_double(tensor);
    double largest = m.xx > m.yy ? m.xx : m.yy;
    if (m.zz > largest) largest = m.zz;
    Sweep sweep{{m.xx, m.yy, m.zz}, {m.yz, m.xz, m.xy}};
    constexpr double rounding = 2e-7, exact = 1e-16;  // of the largest moment
    if (sweep.off_size() <= rounding * rounding * largest * largest) {
        return {{tensor.xx, tensor.yy, tensor.zz}, {}};
    }
    // Converges quadratically: five sweeps are more than any tensor needs.
    for (int i = 0; i < 12 && sweep.off_size() > exact * exact * largest * largest; ++i) {
        sweep.rotate_about(2);
        sweep.rotate_about(1);
        sweep.rotate_about(0);
    }
    const QuatT<double>& q = sweep.rotation;
    double n = 1.0 / __builtin_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    PrincipalInertia r;
    r.inertia = to_float(Vec3d{sweep.diagonal[0], sweep.diagonal[1], sweep.diagonal[2]});
    r.rotation = {static_cast<float>(n * q.x), static_cast<float>(n * q.y), static_cast<float>(n * q.z),
                  static_cast<float>(n * q.w)};
    return r;
}

}  // namespace lendulet
