// The least overlap of the shadows of two boxes on fifteen axes is their depth (Gottschalk, Lin, Manocha 1996). Where
// that axis belongs to a face, the corner of the other box that lies deepest below it is one of the two points; where
// it belongs to two edges, they are the nearest points of their lines. Two boxes that overlap are proven so by the axes
// alone: unlike an expanding polytope these need no search. Boxes apart are proven to be by the same two points where
// these lie in the face or on the edges: no distance is below the separation along an axis.
#include "collision/box_depth.h"

#include <bit>

#include "collision/batch/frame.h"
#include "math/wide/gather.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

// Of S: a corner lies deepest by itself where no other is deeper but for this.
constexpr double alone = 1e-7;
// Of S: how far beyond the ends of a feature rounding may put a point.
constexpr double beyond = 1e-9;
// Cosine above which two edges count as parallel, as least_sine_squared has it.
constexpr double parallel_edges = 1.0 - 5.1e-6;

// Three numbers side by side, in two registers of two; the last lane repeats the third, so that it never has an
// exception of its own.
struct Lanes {
    using Two = Wide<double, 2>;
    Two low, high;
    Lanes(Two one, Two other) : low(one), high(other) {}
    Lanes(double x, double y, double z) : low{x, y}, high{z, z} {}
    explicit Lanes(Vec3d v) : Lanes(v.x, v.y, v.z) {}
    double operator[](int i) const { return i < 2 ? low[i] : high[0]; }

    friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
    friend Lanes operator*(double a, Lanes b) { return {a * b.low, a * b.high}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
    friend Lanes absolute(Lanes a) { return {without_sign(a.low), without_sign(a.high)}; }
    // b where a is above the limit.
    friend Lanes where_above(Lanes a, double limit, Lanes b, double otherwise) {
        const Two other{otherwise, otherwise};
        return {a.low > limit ? b.low : other, a.high > limit ? b.high : other};
    }

private:
    static Two without_sign(Two a) { return (Two)((Wide<int64_t, 2>)a & INT64_MAX); }
};
LENDULET_FORCE_INLINE double largest(Lanes a) { return maximum(maximum(a[0], a[1]), a[2]); }
// Each number's place is taken by the next one, and by the last one.
LENDULET_FORCE_INLINE Lanes of_next(Lanes a) { return {a[1], a[2], a[0]}; }
LENDULET_FORCE_INLINE Lanes of_last(Lanes a) { return {a[2], a[0], a[1]}; }
// Bit i is set where number i is x.
LENDULET_FORCE_INLINE uint32_t places_of(double x, Lanes a) {
    return (a[0] == x ? 1u : 0u) | (a[1] == x ? 2u : 0u) | (a[2] == x ? 4u : 0u);
}

#include "collision/batch/box_axes.inl"

constexpr int next(int i) { return (i + 1) % 3; }
constexpr int last(int i) { return (i + 2) % 3; }

// Of three coordinates by number, without branches on which.
struct Three {
    double of[3];
    explicit Three(Vec3d v) : of{v.x, v.y, v.z} {}
    operator Vec3d() const { return {of[0], of[1], of[2]}; }
    double& operator[](int i) { return of[i]; }
    double operator[](int i) const { return of[i]; }
};
Vec3d times(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec3d with_signs(Vec3d size, Vec3d d) {
    return {towards_sign(size.x, d.x), towards_sign(size.y, d.y), towards_sign(size.z, d.z)};
}

// No edge of the box with these half extents is level along d.
bool has_one_corner(Vec3d half, Vec3d d, double tolerance) {
    const Vec3d rise = times(d, half);
    return minimum(absolute(rise.x), minimum(absolute(rise.y), absolute(rise.z))) > tolerance;
}

// The boxes, and how B's axes lie in A's frame: m.
struct Boxes {
    const Mat3d& m;
    Vec3d t, half_a, half_b;
};

// The axis along which the boxes are farthest apart, or overlap least; numbers as in BestAxis.
struct Best {
    int axis;
    double separation;
};

// Edges are compared by the squares of their separations, which takes no root, and which axis it is is asked once the
// value is known: no branch depends on it. False where axes of the boxes are parallel.
LENDULET_FORCE_INLINE bool find_best(const Boxes& boxes, Best& best) {
    const Mat3d& m = boxes.m;
    const Vec3d t = boxes.t, ha = boxes.half_a, hb = boxes.half_b;
    const Lanes rows[3] = {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
    const Lanes ar[3] = {absolute(rows[0]), absolute(rows[1]), absolute(rows[2])};
    if (!(maximum(largest(ar[0]), maximum(largest(ar[1]), largest(ar[2]))) < parallel_edges)) return false;
    const Lanes columns[3] = {absolute(Lanes(m.x)), absolute(Lanes(m.y)), absolute(Lanes(m.z))};
    const double halves_a[3] = {ha.x, ha.y, ha.z}, halves_b[3] = {hb.x, hb.y, hb.z}, along[3] = {t.x, t.y, t.z};
    const Lanes b(hb), b_next = of_next(b), b_last = of_last(b);
    const Lanes of_a = face_separation(Lanes(t), Lanes(ha), halves_b, columns);
    const Lanes of_b = face_separation(Lanes(transpose_multiply(m, t)), b, halves_a, ar);
    auto of_edge = [&](int i, int i1, int i2) {
        const EdgePair<Lanes, double> e{along[i1], along[i2], halves_a[i1],   halves_a[i2],
                                        rows[i1],  rows[i2],  ar[i1],         ar[i2],
                                        b_next,    b_last,    of_next(ar[i]), of_last(ar[i])};
        const Lanes times_sine = e.separation_times_sine(), sine_squared = e.sine_squared();
        return where_above(sine_squared, least_sine_squared, times_sine * absolute(times_sine) / sine_squared, -1e300);
    };
    const Lanes edges[3] = {of_edge(0, 1, 2), of_edge(1, 2, 0), of_edge(2, 0, 1)};
    const double by_face = maximum(largest(of_a), largest(of_b));
    const double by_edge = maximum(largest(edges[0]), maximum(largest(edges[1]), largest(edges[2])));
    if (by_edge > signed_square(by_face)) {
        const uint32_t which =
            places_of(by_edge, edges[0]) | places_of(by_edge, edges[1]) << 3 | places_of(by_edge, edges[2]) << 6;
        best = {6 + std::countr_zero(which | 1u << 8), towards_sign(square_root(absolute(by_edge)), by_edge)};
    } else {
        const uint32_t which = places_of(by_face, of_a) | places_of(by_face, of_b) << 3;
        best = {std::countr_zero(which | 1u << 5), by_face};
    }
    return true;
}

// The corner of a face of the difference that is nearest to a point of its plane, along which axes of which box the
// corners beside it lie, and whether the point lies between it and these.
struct FaceCorner {
    Vec3d a, b;
    int first, second;
    bool first_of_b, second_of_b;
    bool within_first, within_second;
};

// Whether the point p of the plane lies in the box's face, and along which of its sides it does.
bool lies_within(Vec3d half, Vec3d p, double slack, FaceCorner& corner) {
    const Three h(half), q(p);
    corner.within_first = absolute(q[corner.first]) <= h[corner.first] + slack;
    corner.within_second = absolute(q[corner.second]) <= h[corner.second] + slack;
    return corner.within_first && corner.within_second;
}

// The corner, the two beside it, and the one of the difference that is opposite: by the local points alone, which is
// what a cache keeps.
void leave_corners(const FaceCorner& corner, int count, Simplex& simplex) {
    const Vec3 a = to_float(corner.a), b = to_float(corner.b);
    simplex.count = count;
    for (int k = 0; k < 3; ++k) simplex.a[k] = a, simplex.b[k] = b;
    auto mirror = [](Vec3& v, int axis) { set_component(v, axis, -component(v, axis)); };
    mirror(corner.first_of_b ? simplex.b[1] : simplex.a[1], corner.first);
    mirror(corner.second_of_b ? simplex.b[2] : simplex.a[2], corner.second);
    simplex.a[3] = -a, simplex.b[3] = -b;
}

// Those of the first three that a search begins with.
void leave_start(const CoreDifference& difference, const FaceCorner& corner, Simplex& simplex) {
    leave_corners(corner, 0, simplex);
    const bool taken[3] = {true, corner.within_first, corner.within_second};
    for (int k = 0; k < 3; ++k)
        if (taken[k]) simplex.add(difference.point(simplex.a[k], simplex.b[k]));
}

}  // namespace

bool closest_of_boxes(const CoreDifference& difference, Simplex& simplex, Penetration& out) {
    const Boxes boxes{difference.rotation, difference.translation, to_double(difference.a.size),
                      to_double(difference.b.size)};
    const Mat3d& m = boxes.m;
    const Vec3d t = boxes.t, half_a = boxes.half_a, half_b = boxes.half_b;
    Best best;
    if (!find_best(boxes, best)) return false;
    const int i = best.axis < 6 ? best.axis % 3 : (best.axis - 6) / 3, j = best.axis % 3;
    const Vec3d columns[3] = {m.x, m.y, m.z};
    const Vec3d own{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    Vec3d n = best.axis < 3 ? own : best.axis < 6 ? columns[i] : cross(own, columns[j]);
    if (best.axis >= 6) n = (1.0 / length(n)) * n;
    n = towards_sign(1.0, dot(n, t)) * n;  // from A to B
    const Vec3d n_in_b = transpose_multiply(m, n);
    const Vec3d corner_a = with_signs(half_a, n), corner_b = with_signs(half_b, -n_in_b);
    out = {-best.separation, -n, best.separation * n, corner_a, 0.0, 0};
    const double slack = beyond * difference.size, level = alone * difference.size;
    bool there;
    FaceCorner corner;
    if (best.axis < 3) {
        out.point_a = t + m * corner_b - out.y;
        corner = {with_signs(half_a, out.point_a), corner_b, next(i), last(i), false, false, false, false};
        there = has_one_corner(half_b, n_in_b, level) && lies_within(half_a, out.point_a, slack, corner);
    } else if (best.axis < 6) {
        const Vec3d on_b = transpose_multiply(m, corner_a + out.y - t);
        corner = {corner_a, with_signs(half_b, on_b), next(i), last(i), true, true, false, false};
        there = has_one_corner(half_a, n, level) && lies_within(half_b, on_b, slack, corner);
    } else {
        const Three ha(half_a), hb(half_b);
        Three on_a(corner_a), a_end(corner_a), b_end(corner_b), middle_b(corner_b);
        on_a[i] = middle_b[j] = 0.0;
        const Vec3d gap = t + m * Vec3d(middle_b) - Vec3d(on_a);
        const double cosine = Three(columns[j])[i], along_a = Three(gap)[i], along_b = dot(gap, columns[j]);
        const double inverse = 1.0 / (1.0 - cosine * cosine);
        const double u = (along_a - cosine * along_b) * inverse, v = (cosine * along_a - along_b) * inverse;
        const bool within_a = absolute(u) <= ha[i] + slack, within_b = absolute(v) <= hb[j] + slack;
        there = within_a && within_b;
        on_a[i] = u;
        out.point_a = on_a;
        a_end[i] = towards_sign(ha[i], u), b_end[j] = towards_sign(hb[j], v);
        corner = {a_end, b_end, i, j, false, true, within_a, within_b};
    }
    const bool apart = best.separation > 0.0;
    if (there) leave_corners(corner, apart ? 3 : 4, simplex);
    else if (apart) leave_start(difference, corner, simplex);
    return there;
}

}  // namespace lendulet
