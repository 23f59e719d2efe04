#include "collision/gjk_newton.h"

namespace lendulet {
namespace {

// How the support point of a core moves along t1 and t2 as the direction d turns towards them; all unit, local frame,
// t1 and t2 at right angles to d. Corners stay; on a ball of radius R it moves by R, on a rim along the rim alone.
struct Bend {
    double j11 = 0.0, j12 = 0.0, j22 = 0.0;

    void add(const Geometry& g, Vec3d d, Vec3d t1, Vec3d t2) {
        if (!is_curved(g)) return;
        const bool ball = g.kind == GeometryKind::tapered_capsule;
        const double r = ball ? 1.0 : square_root(d.x * d.x + d.z * d.z);
        const double radius = g.size.z * r + g.size.y * d.y >= g.size.x * r - g.size.y * d.y ? g.size.z : g.size.x;
        if (ball) {
            j11 += radius, j22 += radius;
        } else if (r > 0.0) {
            const double u1 = d.x * t1.z - d.z * t1.x, u2 = d.x * t2.z - d.z * t2.x, scale = radius / (r * r * r);
            j11 += scale * u1 * u1, j12 += scale * u1 * u2, j22 += scale * u2 * u2;
        }
    }
};

}  // namespace

// Looks for the direction d whose support point y lies on the line through the origin along d. The tangential part of
// y(d) - h(d) d vanishes there; its derivative along t is y'(t) - h t.
Tangency find_smooth_tangency(const CoreDifference& difference, Vec3d direction) {
    constexpr int max_rounds = 6;
    constexpr double accepted = 1e-12;  // of S
    const Mat3d& r = difference.rotation;
    Tangency now{direction, {}, 0.0, 0.0};
    for (int round = 0;; ++round) {
        Vec3d d = now.direction, t1, t2;
        complete_frame(d, t1, t2);
        now.p = difference.support(d);
        now.height = dot(d, now.p.y);
        double f1 = dot(t1, now.p.y), f2 = dot(t2, now.p.y);
        now.miss = square_root(f1 * f1 + f2 * f2);
        if (round == max_rounds || now.miss <= accepted * difference.size) return now;
        Bend bend;
        bend.add(difference.a, -d, t1, t2);
        bend.add(difference.b, transpose_multiply(r, d), transpose_multiply(r, t1), transpose_multiply(r, t2));
        const double j11 = bend.j11 - now.height, j22 = bend.j22 - now.height, j12 = bend.j12;
        double determinant = j11 * j22 - j12 * j12;
        if (!(determinant > 0.0) || !(j11 > 0.0)) return now;  // not towards a minimum
        double a1 = (f2 * j12 - f1 * j22) / determinant, a2 = (f1 * j12 - f2 * j11) / determinant;
        double length_a = square_root(a1 * a1 + a2 * a2), limit = length_a > 0.5 ? 0.5 / length_a : 1.0;
        Vec3d next = d + (limit * a1) * t1 + (limit * a2) * t2;
        now.direction = (1.0 / length(next)) * next;
    }
}

}  // namespace lendulet
