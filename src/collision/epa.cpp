// The expanding polytope: a first tetrahedron, expansion at the nearest face, and two finishes for round differences,
// whose surface no polytope reaches. In: a simplex of GJK that holds the origin. Out: depth, normal, witness points,
// and the simplex to begin with next time.
#include "collision/epa.h"

#include "collision/epa_minima.h"
#include "collision/epa_polytope.h"
#include "collision/simplex.h"
#include "collision/trace.h"

namespace lendulet {
namespace {

// Relative to S: a difference thinner than this is flat; faces nearer to coplanar are merged; the surface is reached
// when a support point rises less than this above the nearest face.
constexpr double flat = 1e-11, merge = 1e-14;
constexpr double surface = 1e-9, surface_curved = 1e-7;
// Only by rounding can a support point that the polytope already has rise above a face, and not by more than this.
constexpr double repeated = 1e-6;
// A smooth minimum counts when its support point misses the line from the origin by less than this, and is taken for
// the least of all when the polytope proves it to within the second.
constexpr double tangent = 1e-8, surface_smooth = 4e-6;

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

// Where the surface is smooth, Newton's method finds its nearest point long before the polytope has proven that no
// other is nearer. Tried whenever the bounds have come much closer since the last time.
struct SmoothMinimum {
    Tangency tangency;
    bool found = false;
    double try_below;

    // True where one is found that is less deep than the last.
    bool look(const CoreDifference& difference, Vec3d direction, double lower, double gap) {
        if (gap > try_below) return false;
        try_below = 0.1 * gap;
        Tangency t = find_tangency(difference, direction);
        bool valid = t.miss <= tangent * difference.size && t.height > lower - tangent * difference.size;
        if (!valid || (found && t.height >= tangency.height)) return false;
        found = true;
        tangency = t;
        return true;
    }
};

// The foot of the origin on the plane of face f. A face of the difference may be several coplanar triangles: the foot
// lies in one of them, which is returned.
int foot_on_face(const CoreDifference& difference, const Polytope& polytope, int f, double tolerance,
                 Penetration& result) {
    const Vec3d n = polytope.normal(f);
    const double distance = polytope.distance(f, n), sideways = 1e-7 * difference.size;
    double least = 1e300;
    int best = f;
    for (int g = f, next = 0; g < polytope.face_end(); g = next++) {
        if (!polytope.alive(g)) continue;
        const Vec3d m = polytope.normal(g);
        if (!(dot(m, n) > 1.0 - 1e-10) || !(polytope.distance(g, m) <= distance + tolerance)) continue;
        Simplex corners = polytope.triangle(g);
        SubSimplex part = closest_barycentric(corners.y, 3);
        if (!(length_squared(part.point) < least)) continue;
        least = length_squared(part.point);
        best = g;
        result.y = part.point;
        result.point_a = difference.witness_on_a(corners, part.index, part.weight, part.count);
        if (least - distance * distance <= sideways * sideways) break;
    }
    return best;
}

// The nearest point should lie as far from the origin as the depth says. Where the last face or round misses that, the
// farthest point along the normal, which has the right height, may lie nearer to the line.
void improve_point(const CoreDifference& difference, Penetration& result) {
    DifferencePoint p = difference.support(result.outward);
    if (!(absolute(length(p.y) - result.depth) < absolute(length(result.y) - result.depth))) return;
    result.y = p.y;
    result.point_a = snap_to_core(difference.a, to_double(p.a));
}

// The polytope grows until it proves the depth.
template <class Observer>
Penetration expand(const CoreDifference& difference, Polytope& polytope, SmoothMinimum& smooth, Simplex& simplex,
                   Observer& observer) {
    Penetration result;
    const double size = difference.size, tolerance = (difference.curved ? surface_curved : surface) * size;
    for (int expansions = 0;; ++expansions) {
        int f = polytope.nearest_face();
        DifferencePoint p = difference.support(polytope.direction(f));  // does not wait for the normal's square root
        const Vec3d n = polytope.normal(f);
        observer.polytope(polytope, f, p);
        double lower = polytope.distance(f, n), upper = dot(n, p.y), gap = upper - lower;
        const bool nearer = smooth.look(difference, n, lower, gap);
        bool proven = smooth.found && smooth.tangency.height - lower <= surface_smooth * size;
        // The faces around the nearest point itself are nearly as far away as it: far fewer are needed to prove it.
        if (nearer && !proven && expansions < max_expansions && dot(n, smooth.tangency.p.y) > lower + tolerance &&
            polytope.expand(f, smooth.tangency.p))
            continue;
        bool last = proven || !(gap > tolerance) || expansions == max_expansions ||
                    (gap < repeated * size && polytope.holds(p.y)) || !polytope.expand(f, p);
        if (!last) continue;
        const Tangency& t = smooth.tangency;
        const double depth = maximum(upper, lower);
        const bool is_smooth = smooth.found && t.height <= depth + tangent * size;
        if (!(proven && is_smooth) && gap > (difference.curved ? tolerance : repeated * size)) {
            result = search_minima(difference, polytope, is_smooth ? t.height : 1e300, expansions);
        } else {
            result = {depth, n, {}, {}, gap, expansions};
            if (!is_smooth) {
                simplex = polytope.triangle(foot_on_face(difference, polytope, f, tolerance, result));
                simplex.add(polytope.farthest(-n));
            }
        }
        if (smooth.found && t.height <= result.depth + tangent * size)
            result = {t.height, t.direction, t.p.y, snap_to_core(difference.a, to_double(t.p.a)), t.miss, expansions};
        else if (difference.curved) improve_point(difference, result);
        return result;
    }
}

// Support points around n that lean from it by `lean` (rad, small angles), and the one opposite to it.
void add_ring(const CoreDifference& difference, Vec3d n, double lean, Simplex& s) {
    Vec3d p, q;
    complete_frame(n, p, q);
    s.add(difference.support(n + lean * p));
    s.add(difference.support(n - (0.5 * lean) * p + (0.8660254 * lean) * q));
    s.add(difference.support(n - (0.5 * lean) * p - (0.8660254 * lean) * q));
    s.add(difference.support(-n));
}

// Takes a point that lies beyond one of the first four faces, most likely the one opposite to the last corner.
void take_beyond(Polytope& polytope, const DifferencePoint& p, double tolerance) {
    for (int f = 3; f >= 0; --f)
        if (polytope.height_above(f, p.y) > tolerance) {
            polytope.expand(f, p);
            return;
        }
}

}  // namespace

template <class Observer>
Penetration expand_polytope(const CoreDifference& difference, Simplex& simplex, Vec3d hint, Observer& observer) {
    Penetration result;
    Simplex s = simplex;
    if (!make_tetrahedron(difference, s, hint, result)) return result;
    Polytope polytope;
    polytope.start(s, merge * difference.size);
    SmoothMinimum smooth{{}, false, difference.curved ? 0.1 * difference.size : -1.0};
    return expand(difference, polytope, smooth, simplex, observer);
}

bool expand_around(const CoreDifference& difference, const Tangency& known, Simplex& simplex, Penetration& out) {
    // As far around as a surface that bends as much as the difference must at its nearest point may be left uncut: a
    // face that leans by half the angle there is nearer by the square of that.
    constexpr double widest = 0.5;  // rad
    const double size = difference.size;
    const double lean = minimum(widest, square_root(8.0 * 0.25 * surface_smooth * size / known.height));
    simplex.count = 0;
    add_ring(difference, known.direction, lean, simplex);
    if (!spans_well(simplex)) return false;
    Polytope polytope;
    polytope.start(simplex, merge * size);
    take_beyond(polytope, known.p, surface_curved * size);
    SmoothMinimum smooth{known, true, 0.0};
    SilentObserver silent;
    out = expand(difference, polytope, smooth, simplex, silent);
    return true;
}

bool expand_below(const CoreDifference& difference, const DifferencePoint& top, Vec3d direction, Simplex& simplex,
                  Penetration& out) {
    constexpr double lean = 0.55;  // rad
    Simplex s;
    add_ring(difference, direction, lean, s);
    if (!spans_well(s)) return false;
    Polytope polytope;
    polytope.start(s, merge * difference.size);
    take_beyond(polytope, top, surface * difference.size);
    SmoothMinimum smooth{{}, false, -1.0};
    SilentObserver silent;
    simplex = s;
    out = expand(difference, polytope, smooth, simplex, silent);
    return true;
}

template Penetration expand_polytope(const CoreDifference&, Simplex&, Vec3d, Recorder&);

Penetration expand_polytope(const CoreDifference& difference, Simplex& simplex, Vec3d hint) {
    SilentObserver silent;
    return expand_polytope(difference, simplex, hint, silent);
}

}  // namespace lendulet
