#include "collision/epa.h"

#include "collision/epa_polytope.h"
#include "collision/simplex.h"

namespace lendulet {
namespace {

// Relative to S: a difference thinner than this is flat; faces nearer to coplanar are merged; the surface is reached
// when a support point rises less than this above the nearest face.
constexpr double flat = 1e-11, merge = 1e-14;
constexpr double surface = 1e-9, surface_curved = 1e-7;

// Sets point i of the simplex to the support point among `directions` that measure() likes best.
template <class Measure>
double add_best(const CoreDifference& difference, Simplex& s, const Vec3d* directions, int count, Measure measure) {
    double best = -1.0;
    for (int i = 0; i < count; ++i) {
        DifferencePoint p = difference.support(directions[i]);
        double m = measure(p.y);
        if (m <= best) continue;
        best = m;
        s.set(s.count, p);
    }
    ++s.count;
    return best;
}

double height_above_line(const Simplex& s, Vec3d y) {
    Vec3d u = s.y[1] - s.y[0];
    return length(cross(u, y - s.y[0])) / length(u);
}
Vec3d plane_normal(const Simplex& s) {
    Vec3d n = cross(s.y[1] - s.y[0], s.y[2] - s.y[0]);
    return (1.0 / length(n)) * n;
}

// Orders the points so that the first span as much as they can, and drops those that add no dimension.
void drop_dependent_points(Simplex& s, double thickness) {
    int count = s.count;
    s.count = 1;
    for (int dimension = 1; dimension < count; ++dimension) {
        int best = 0;
        double most = thickness;
        for (int i = dimension; i < count; ++i) {
            double m = dimension == 1   ? length(s.y[i] - s.y[0])
                       : dimension == 2 ? height_above_line(s, s.y[i])
                                        : absolute(dot(plane_normal(s), s.y[i] - s.y[0]));
            if (m > most) most = m, best = i;
        }
        if (best == 0) return;
        DifferencePoint chosen = s.point(best);
        s.set(best, s.point(dimension));
        s.set(dimension, chosen);
        ++s.count;
    }
}

// Whether four points are far from flat, so that they can be used as they are.
bool spans_well(const Simplex& s) {
    if (s.count < 4) return false;
    Vec3d e1 = s.y[1] - s.y[0], e2 = s.y[2] - s.y[0], e3 = s.y[3] - s.y[0];
    double volume = dot(cross(e1, e2), e3);
    return volume * volume > 1e-8 * dot(e1, e1) * dot(e2, e2) * dot(e3, e3);
}

// Two unit vectors that complete the unit vector u to a right-handed frame (Frisvad 2012).
void complete_frame(Vec3d u, Vec3d& p, Vec3d& q) {
    double sign = u.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (sign + u.z), b = u.x * u.y * a;
    p = {1.0 + sign * u.x * u.x * a, sign * b, -sign * u.x};
    q = {b, sign + u.y * u.y * a, -u.y};
}

Penetration flat_result(const CoreDifference& difference, const Simplex& s, Vec3d normal, Vec3d hint) {
    Penetration result{0.0, normal, {}, {}, 0.0, 0};
    double side = dot(normal, hint);
    // Outward is from B to A: against the hint, which leads from A to B; without a hint, down along the first axis it
    // has.
    if (side == 0.0) side = normal.y != 0.0 ? normal.y : normal.x != 0.0 ? normal.x : normal.z;
    if (side > 0.0) result.outward = -normal;
    SubSimplex part = closest_barycentric(s.y, s.count);
    result.point_a = difference.witness_on_a(s, part.index, part.weight, part.count);
    return result;
}

// Completes the simplex to a tetrahedron; false, with a result, where the difference has no volume.
bool make_tetrahedron(const CoreDifference& difference, Simplex& s, Vec3d hint, Penetration& result) {
    const double thickness = flat * difference.size;
    const Simplex given = s;
    if (!spans_well(s)) drop_dependent_points(s, thickness);
    if (s.count == 1) {
        static constexpr Vec3d axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        if (!(add_best(difference, s, axes, 6, [&](Vec3d y) { return length(y - s.y[0]); }) > thickness)) {
            result = flat_result(difference, given, {0.0, 1.0, 0.0}, {});  // two points: no direction is better
            return false;
        }
    }
    if (s.count == 2) {
        Vec3d u = s.y[1] - s.y[0], p, q;
        complete_frame((1.0 / length(u)) * u, p, q);
        const Vec3d around[4] = {p, -p, q, -q};
        if (!(add_best(difference, s, around, 4, [&](Vec3d y) { return height_above_line(s, y); }) > thickness)) {
            result = flat_result(difference, given, absolute(q.y) > absolute(p.y) ? q : p, hint);
            return false;
        }
    }
    if (s.count == 3) {
        Vec3d n = plane_normal(s);
        const Vec3d sides[2] = {n, -n};
        if (!(add_best(difference, s, sides, 2, [&](Vec3d y) { return absolute(dot(n, y - s.y[0])); }) > thickness)) {
            result = flat_result(difference, given, n, hint);
            return false;
        }
    }
    return true;
}

}  // namespace

Penetration expand_polytope(const CoreDifference& difference, const Simplex& simplex, Vec3d hint) {
    Penetration result;
    Simplex s = simplex;
    if (!make_tetrahedron(difference, s, hint, result)) return result;

    Polytope polytope;
    polytope.start(s, merge * difference.size);
    const double tolerance = (difference.curved ? surface_curved : surface) * difference.size;
    double upper = 1e300;
    int f = 0, expansions = 0;
    for (;;) {
        f = polytope.nearest_face();
        DifferencePoint p = difference.support(polytope.normal(f));
        upper = dot(polytope.normal(f), p.y);
        if (!(upper - polytope.distance(f) > tolerance) || expansions == max_expansions || polytope.holds(p.y)) break;
        if (!polytope.expand(f, p)) break;
        ++expansions;
    }

    result = {maximum(upper, polytope.distance(f)), polytope.normal(f), {}, {},
              upper - polytope.distance(f),         expansions};
    Simplex face = polytope.triangle(f);
    SubSimplex part = closest_barycentric(face.y, 3);
    result.y = part.point;
    result.point_a = difference.witness_on_a(face, part.index, part.weight, part.count);
    return result;
}

}  // namespace lendulet
