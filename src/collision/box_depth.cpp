// The least overlap of the shadows of two boxes on fifteen axes is their depth (Gottschalk, Lin, Manocha 1996). Where
// that axis belongs to a face, the corner of the other box that lies deepest below it is one of the two points; where
// it belongs to two edges, they are the nearest points of their lines. Two boxes that overlap are proven so by the axes
// alone: unlike an expanding polytope these need no search.
#include "collision/box_depth.h"

#include "collision/batch/frame.h"
#include "math/wide/gather.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

// The formulas of batches, with one lane of double.
double select(bool mask, double a, double b) { return mask ? a : b; }

#include "collision/batch/box_axes.inl"

// Of S: a corner lies deepest by itself where no other is deeper but for this.
constexpr double alone = 1e-7;
// Of S: how far beyond the ends of a feature rounding may put a point.
constexpr double beyond = 1e-9;
// Cosine above which two edges count as parallel, as sine_squared in separations() has it.
constexpr double parallel_edges = 1.0 - 5.1e-6;

double& at(Vec3d& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
double at(const Vec3d& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
Vec3d column(const Mat3d& m, int i) { return i == 0 ? m.x : i == 1 ? m.y : m.z; }
Vec3d times(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec3d signs_of(Vec3d d) { return {towards_sign(1.0, d.x), towards_sign(1.0, d.y), towards_sign(1.0, d.z)}; }

// No edge of the box with these half extents is level along d.
bool has_one_corner(Vec3d half, Vec3d d, double tolerance) {
    return absolute(d.x) * half.x > tolerance && absolute(d.y) * half.y > tolerance &&
           absolute(d.z) * half.z > tolerance;
}
bool reaches(Vec3d half, Vec3d p, double slack) {
    return absolute(p.x) <= half.x + slack && absolute(p.y) <= half.y + slack && absolute(p.z) <= half.z + slack;
}

constexpr int next(int i) { return (i + 1) % 3; }
constexpr int last(int i) { return (i + 2) % 3; }

// The corner of a face of the difference that is nearest to a point in it, and along which axes of which box the
// corners beside it lie.
struct FaceCorner {
    Vec3d a, b;
    int first, second;
    bool first_of_b, second_of_b;
};

// Three corners of that face, between which the point lies, and the one of the difference that is opposite.
void leave_corners(const CoreDifference& difference, const FaceCorner& corner, Simplex& simplex) {
    auto beside = [&](int axis, bool of_b) {
        Vec3d a = corner.a, b = corner.b;
        double& x = at(of_b ? b : a, axis);
        x = -x;
        return difference.point(to_float(a), to_float(b));
    };
    simplex.count = 0;
    simplex.add(difference.point(to_float(corner.a), to_float(corner.b)));
    simplex.add(beside(corner.first, corner.first_of_b));
    simplex.add(beside(corner.second, corner.second_of_b));
    simplex.add(difference.point(to_float(-corner.a), to_float(-corner.b)));
}

}  // namespace

bool depth_of_boxes(const CoreDifference& difference, Simplex& simplex, Penetration& out) {
    const Mat3d& r = difference.rotation;
    const Vec3d t = difference.translation, ha = to_double(difference.a.size), hb = to_double(difference.b.size);
    const double size = difference.size;
    const WideBox<double> a{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {}, {ha.x, ha.y, ha.z}, {}};
    const WideBox<double> b{{r.x, r.y, r.z}, t, {}, {hb.x, hb.y, hb.z}, {}};
    double s[15], aligned[6];
    separations(a, b, s, aligned);
    int best = 0;
    for (int k = 1; k < 15; ++k)
        if (s[k] > s[best]) best = k;
    if (!(s[best] < 0.0)) return false;
    for (double cosine : aligned)
        if (!(cosine < parallel_edges)) return false;

    const int i = best < 6 ? best % 3 : (best - 6) / 3, j = (best - 6) % 3;
    const Vec3d own{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    Vec3d n = best < 3 ? own : best < 6 ? column(r, i) : cross(own, column(r, j));
    if (best >= 6) n = (1.0 / length(n)) * n;
    n = towards_sign(1.0, dot(n, t)) * n;  // from A to B
    const Vec3d in_b = transpose_multiply(r, n);
    const Vec3d corner_a = times(signs_of(n), ha), corner_b = times(signs_of(-in_b), hb);
    out = {-s[best], -n, s[best] * n, corner_a, 0.0, 0};
    const double slack = beyond * size;
    if (best < 3) {
        out.point_a = t + r * corner_b - out.y;
        if (!has_one_corner(hb, in_b, alone * size) || !reaches(ha, out.point_a, slack)) return false;
        leave_corners(difference, {times(signs_of(out.point_a), ha), corner_b, next(i), last(i), false, false},
                      simplex);
    } else if (best < 6) {
        const Vec3d on_b = transpose_multiply(r, corner_a + out.y - t);
        if (!has_one_corner(ha, n, alone * size) || !reaches(hb, on_b, slack)) return false;
        leave_corners(difference, {corner_a, times(signs_of(on_b), hb), next(i), last(i), true, true}, simplex);
    } else {
        Vec3d a_end = corner_a, b_end = corner_b, middle_b = corner_b;
        at(out.point_a, i) = at(middle_b, j) = 0.0;
        const Vec3d other = column(r, j), gap = t + r * middle_b - out.point_a;
        const double cosine = at(other, i), along_a = at(gap, i), along_b = dot(gap, other);
        const double inverse = 1.0 / (1.0 - cosine * cosine);
        const double u = (along_a - cosine * along_b) * inverse, v = (cosine * along_a - along_b) * inverse;
        if (!(absolute(u) <= at(ha, i) + slack) || !(absolute(v) <= at(hb, j) + slack)) return false;
        at(out.point_a, i) = u;
        at(a_end, i) = towards_sign(at(ha, i), u), at(b_end, j) = towards_sign(at(hb, j), v);
        leave_corners(difference, {a_end, b_end, i, j, false, true}, simplex);
    }
    return true;
}

}  // namespace lendulet
