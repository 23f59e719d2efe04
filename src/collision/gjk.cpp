// Distance of two convex cores: start from the remembered simplex or cold, iterate GJK, expand a polytope on overlap,
// and write witness points and the simplex to remember. Thesis 4.1; Gilbert, Johnson, Keerthi, "A fast procedure for
// computing the distance between complex objects in three-dimensional space" (1988); van den Bergen, "A fast and robust
// GJK implementation for collision detection of convex objects" (1999) for the bounds that end the iteration.
#include "collision/gjk.h"

#include "collision/epa.h"
#include "collision/gjk_difference.h"
#include "collision/simplex.h"

namespace lendulet {
namespace {

constexpr int max_iterations = 64;
// Nearer than this times S the direction of v is rounding: the polytope decides.
constexpr double touching = 1e-12;
// The search ends when a support point lowers the distance by less than these: relative to the distance, which bounds
// the error of the normal at every distance, and relative to S. Polytopes end exactly, at a vertex they already have.
constexpr double relative_gap = 1e-9, relative_gap_curved = 1e-7;
constexpr double absolute_gap = 1e-14, absolute_gap_curved = 1e-10;
// What the result must certify to count as converged, relative to S (PHYSICS: distance 2e-6, depth 1e-5).
constexpr double certified_distance = 1e-6, certified_depth = 5e-6;

constexpr uint8_t all_points[4] = {0, 1, 2, 3};

enum class Outcome { apart, beyond, overlap };

struct Search {
    Outcome outcome;
    Vec3d v;         // point of the simplex nearest to the origin
    double lower;    // proven lower bound of the distance where apart or beyond
    int iterations;  // support points taken into the simplex
};

void keep_part(Simplex& s, const SubSimplex& part) {
    s.count = part.count;
    for (int i = 0; i < part.count; ++i) {
        if (part.index[i] != i) s.set(i, s.point(part.index[i]));  // indices rise, so no point is overwritten unread
        s.weight[i] = part.weight[i];
    }
}

bool holds(const Simplex& s, Vec3d y) {
    for (int i = 0; i < s.count; ++i)
        if (s.y[i].x == y.x && s.y[i].y == y.y && s.y[i].z == y.z) return true;
    return false;
}

void start(const CoreDifference& difference, const GjkCache& cache, Simplex& s) {
    for (int i = 0; i < cache.count && i < 4; ++i) s.add(difference.point(cache.a[i], cache.b[i]));
    if (s.count > 0) return;
    Vec3d centre = difference.centre();
    if (!(largest_component(centre) > 0.0)) centre = {0.0, 1.0, 0.0};
    s.add(difference.support(-centre));
}

Search search(const CoreDifference& difference, Simplex& s, SimplexSolver method, double max_distance) {
    const double size = difference.size;
    const double near_zero = touching * touching * size * size;
    const double relative = difference.curved ? relative_gap_curved : relative_gap;
    const double absolute_part = (difference.curved ? absolute_gap_curved : absolute_gap) * size;
    const double limit = max_distance > 0.0 ? max_distance * max_distance : 0.0;
    Search result{Outcome::apart, {}, 0.0, 0};
    double previous = 1e300;
    for (;;) {
        SubSimplex part = closest_sub_simplex(method, s.y, s.count);
        keep_part(s, part);
        Vec3d v = result.v = part.point;
        double vv = dot(v, v);
        if (s.count == 4 || vv <= near_zero) {
            result.outcome = Outcome::overlap;
            return result;
        }
        DifferencePoint p = difference.support(-v);
        double vy = dot(v, p.y), gap = vv - vy;
        result.lower = vy;
        if (vy > 0.0 && vy * vy > limit * vv) {
            result.outcome = Outcome::beyond;
            break;
        }
        if (!(gap > relative * vv) || gap * gap <= absolute_part * absolute_part * vv) break;
        if (holds(s, p.y) || vv >= previous || result.iterations == max_iterations) break;
        previous = vv;
        s.add(p);
        ++result.iterations;
    }
    result.lower /= length(result.v);
    return result;
}

void remember(const Simplex& s, Vec3 direction, GjkCache& cache) {
    cache.count = static_cast<uint8_t>(s.count);
    cache.direction = direction;
    for (int i = 0; i < s.count; ++i) {
        cache.a[i] = s.a[i];
        cache.b[i] = s.b[i];
    }
}

}  // namespace

ConvexDistance distance(const ConvexPair& pair, GjkCache& cache, SimplexSolver method, float max_distance) {
    const CoreDifference difference(pair);
    Simplex s;
    start(difference, cache, s);
    Search found = search(difference, s, method, max_distance);

    ConvexDistance result;
    result.iterations = found.iterations;
    result.expansions = 0;
    Vec3d on_a, v = found.v;
    if (found.outcome == Outcome::overlap) {
        Penetration deep = expand_polytope(difference, s, difference.centre());
        result.distance = static_cast<float>(-deep.depth);
        result.normal = to_float(-deep.outward);
        result.expansions = deep.expansions;
        result.converged = deep.gap <= certified_depth * difference.size;
        on_a = deep.point_a;
        v = deep.y;
    } else {
        double length_v = length(v);
        result.distance = static_cast<float>(found.outcome == Outcome::beyond ? found.lower : length_v);
        result.normal = to_float((1.0 / length_v) * v);
        result.converged =
            found.outcome == Outcome::beyond || length_v - found.lower <= certified_distance * difference.size;
        on_a = difference.witness_on_a(s, all_points, s.weight, s.count);
    }
    result.point_a = to_float(on_a);
    result.point_b = to_float(on_a + v);
    remember(s, result.normal, cache);
    return result;
}

}  // namespace lendulet
