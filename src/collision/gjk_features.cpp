// Directions that a flat or ruled feature of a core gives: the normal of a cap or of a box's face, and of a side the
// one in which it meets the other core. In: a direction near it. Out: the direction with its two points, if they lie
// within the cores; the supports along it then prove that nothing is nearer.
#include "collision/gjk_newton.h"

namespace lendulet {
namespace {

// A direction belongs to a flat within 2.5 degrees of its normal, and to a side within 1.7 degrees of being across it.
constexpr double flat_cosine = 0.999, side_sine = 0.03;
// Of S: how far the points may lie outside the cores, and beside the line along the direction.
constexpr double inside = 1e-9, beside = 1e-11;
// Squared sine of the angle below which two axes count as parallel.
constexpr double parallel = 1e-4;

// A core, and the other from its frame.
struct View {
    const Geometry& own;
    const Geometry& other;
    Mat3d rotation;  // frame of the other to that of the own core
    Vec3d translation;
    double size;

    Vec3d support_of_other(Vec3d d) const {
        return translation + rotation * support_point(other, transpose_multiply(rotation, d));
    }
};

// A unit normal of the own core, the point of the other that is farthest against it, and how far the cores are apart.
struct Meeting {
    Vec3d n, on_other;
    double separation;
};

double sign_of(double a) { return towards_sign(1.0, a); }

// The normals of a side have one component along the axis and lie on a circle about it.
struct Side {
    double sine, cosine;  // of the angle to the cross section
    double middle;        // radius half way up, m

    explicit Side(const Geometry& g) {
        const double taper = g.size.x - g.size.z, height = 2.0 * g.size.y;
        const double slant = 1.0 / square_root(height * height + taper * taper);
        sine = slant * taper;
        cosine = slant * height;
        middle = 0.5 * (g.size.x + g.size.z);
    }
    bool has(double along) const { return absolute(along - sine) <= side_sine; }
};

bool contains(const Geometry& g, Vec3d p, double slack) {
    if (!(absolute(p.y) <= g.size.y + slack)) return false;
    if (g.kind == GeometryKind::box) return absolute(p.x) <= g.size.x + slack && absolute(p.z) <= g.size.z + slack;
    const double middle = 0.5 * (g.size.x + g.size.z), slope = 0.5 * (g.size.z - g.size.x) / g.size.y;
    const double radius = middle + slope * p.y + slack;
    return p.x * p.x + p.z * p.z <= radius * radius;
}

// Turns the normal about the axis until the point of the other core lies straight above it (secants).
bool turn_towards(const View& view, const Side& side, Vec3d d, Meeting& m) {
    constexpr int max_rounds = 8;
    constexpr double longest = 0.3;  // rad, of a step
    const double across = 1.0 / square_root(d.x * d.x + d.z * d.z), ex = across * d.x, ez = across * d.z;
    double tangent = 0.0, before = 0.0, miss_before = 0.0;  // of the angle turned so far
    for (int round = 0; round < max_rounds; ++round) {
        const double scale = 1.0 / square_root(1.0 + tangent * tangent);
        const double x = scale * (ex - tangent * ez), z = scale * (ez + tangent * ex);
        m.n = {side.cosine * x, side.sine, side.cosine * z};
        m.on_other = view.support_of_other(-m.n);
        const double miss = x * m.on_other.z - z * m.on_other.x;
        if (absolute(miss) <= beside * view.size) return true;
        const double above = x * m.on_other.x + z * m.on_other.z;
        const double slope = round == 0 ? -above : (miss - miss_before) / (tangent - before);
        if (!(slope < 0.0) || !(absolute(miss) <= -longest * slope)) return false;
        before = tangent, miss_before = miss;
        tangent -= miss / slope;
    }
    return false;
}

// The side meets a side of the other core: the normal is one of both circles, and the points lie where the lines along
// the two sides cross, seen along it. q is the other's axis.
bool cross_sides(const View& view, const Side& side, Vec3d d, Meeting& m) {
    const Side other(view.other);
    const Vec3d q = view.rotation.y, y{0.0, 1.0, 0.0}, c = cross(y, q);
    const double k = q.y, cc = dot(c, c);
    if (!other.has(-dot(d, q)) || !(cc > parallel)) return false;
    const double beta = (-other.sine - k * side.sine) / cc, alpha = side.sine - k * beta;
    const Vec3d within = alpha * y + beta * q;
    const double left = 1.0 - dot(within, within);
    if (!(left > 0.0)) return false;
    m.n = within + (sign_of(dot(c, d)) * square_root(left / cc)) * c;
    const Vec3d own_line = y - side.sine * m.n, other_line = q + other.sine * m.n;
    const Vec3d own = (side.middle / side.cosine) * (m.n - side.sine * y);
    const Vec3d start = view.translation - (other.middle / other.cosine) * (m.n + other.sine * q);
    const Vec3d w = cross(m.n, own_line);
    const double along = dot(own - start, w) / dot(other_line, w);
    m.on_other = start + along * other_line;
    return absolute(dot(m.on_other - view.translation, q)) <= view.other.size.y + inside * view.size;
}

// d: from the own core to the other, unit.
bool meet(const View& view, Vec3d d, Meeting& m) {
    const Geometry& g = view.own;
    if (g.kind == GeometryKind::tapered_cylinder && absolute(d.y) < flat_cosine) {
        const Side side(g);
        if (!side.has(d.y)) return false;
        const bool crossed = view.other.kind == GeometryKind::tapered_cylinder && cross_sides(view, side, d, m);
        if (!crossed && !turn_towards(view, side, d, m)) return false;
    } else if (g.kind == GeometryKind::tapered_cylinder || g.kind == GeometryKind::box) {
        const double most = largest_component(d);
        if (!(most >= flat_cosine)) return false;
        auto axis = [&](double a) { return absolute(a) == most ? sign_of(a) : 0.0; };
        m.n = {axis(d.x), axis(d.y), axis(d.z)};
        m.on_other = view.support_of_other(-m.n);
    } else {
        return false;
    }
    m.separation = dot(m.n, m.on_other) - dot(m.n, support_point(g, m.n));
    return contains(g, m.on_other - m.separation * m.n, inside * view.size);
}

}  // namespace

bool find_tangency_of_features(const CoreDifference& difference, Vec3d direction, Tangency& out) {
    const Mat3d& r = difference.rotation;
    const Vec3d t = difference.translation;
    Meeting m;
    if (meet({difference.a, difference.b, r, t, difference.size}, -direction, m)) {
        const Vec3d on_a = m.on_other - m.separation * m.n;
        const Vec3d on_b = transpose_multiply(r, m.on_other - t);
        out = {-m.n, {m.separation * m.n, to_float(on_a), to_float(on_b)}, -m.separation, 0.0};
        return true;
    }
    const Mat3d back{{r.x.x, r.y.x, r.z.x}, {r.x.y, r.y.y, r.z.y}, {r.x.z, r.y.z, r.z.z}};
    if (!meet({difference.b, difference.a, back, -transpose_multiply(r, t), difference.size},
              transpose_multiply(r, direction), m))
        return false;
    const Vec3d on_a = t + r * m.on_other, n = -(r * m.n);
    out = {-n, {m.separation * n, to_float(on_a), to_float(m.on_other - m.separation * m.n)}, -m.separation, 0.0};
    return true;
}

}  // namespace lendulet
