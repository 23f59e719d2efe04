// Distance of two convex cores: start from the remembered simplex or cold, search, expand a polytope on overlap, and
// write witness points and the simplex to remember.
#include "collision/gjk.h"

#include "collision/box_distance.h"
#include "collision/epa.h"
#include "collision/gjk_newton.h"
#include "collision/gjk_search.h"
#include "collision/trace.h"

namespace lendulet {
namespace {

// Relative to S .
constexpr double certified_depth = 5e-6, certified_tangent = 1e-9;
// A first support point that lies this far beyond the origin tells that the cores overlap, but for few pairs that
// nearly touch.
constexpr double beyond_doubt = 0.03;
// Of S: boxes that are not farther apart begin with a face of their difference rather than with the last simplex.
constexpr double near = 0.03;
constexpr uint8_t all_points[4] = {0, 1, 2, 3};

// Where a search begins that remembers nothing: from the middle of the difference towards the origin.
Vec3d first_direction(const CoreDifference& difference) {
    const Vec3d centre = difference.centre();
    return largest_component(centre) > 0.0 ? -centre : Vec3d{0.0, -1.0, 0.0};
}

void remember(const Simplex& s, Vec3 direction, GjkCache& cache) {
    cache.count = static_cast<uint8_t>(s.count);
    cache.face = 0;
    cache.direction = direction;
    for (int i = 0; i < s.count; ++i) {
        cache.a[i] = s.a[i];
        cache.b[i] = s.b[i];
    }
}

ConvexDistance result_apart(const CoreDifference& difference, const Simplex& s, const Search& found) {
    ConvexDistance result;
    result.distance = static_cast<float>(found.distance);
    result.normal = to_float(found.direction);
    Vec3d on_a = difference.witness_on_a(s, all_points, s.weight, s.count);
    result.point_a = to_float(on_a);
    result.point_b = to_float(on_a + found.v);
    result.iterations = found.iterations;
    result.expansions = 0;
    result.converged = found.gap <= certified_distance * difference.size;
    return result;
}

ConvexDistance result_overlapping(const CoreDifference& difference, const Penetration& deep, int iterations) {
    ConvexDistance result;
    result.distance = static_cast<float>(-deep.depth);
    result.normal = to_float(-deep.outward);
    result.point_a = to_float(deep.point_a);
    result.point_b = to_float(deep.point_a + deep.y);
    result.iterations = iterations;
    result.expansions = deep.expansions;
    result.converged = deep.gap <= certified_depth * difference.size;
    return result;
}

bool are_both(const CoreDifference& difference, GeometryKind kind) {
    return difference.a.kind == kind && difference.b.kind == kind;
}

// The depth of two hulls by a polytope around the way d between their middles, whose support point is `top`, cold or
// warm: most of what proves it lies there rather than around the normal.
bool depth_of_hulls(const CoreDifference& difference, const DifferencePoint& top, Vec3d d, Simplex& s,
                    Penetration& deep) {
    return expand_below(difference, top, (1.0 / length(d)) * d, s, deep);
}
bool depth_of_hulls(const CoreDifference& difference, Simplex& s, Penetration& deep) {
    const Vec3d d = first_direction(difference);
    return depth_of_hulls(difference, difference.support(d), d, s, deep);
}

// Whether the first point of a query lies beyond the origin by this part of S: it was found along d, or left by the
// last query, whose normal was -d.
bool is_beyond(const CoreDifference& difference, Vec3d d, const Simplex& s, double share) {
    return signed_square(dot(d, s.y[0])) > signed_square(share * difference.size) * dot(d, d);
}

// Hulls that will overlap need no search. Where they do not after all, it begins with the same points.
LENDULET_FORCE_INLINE bool is_deep_at_once(const CoreDifference& difference, bool cold, Vec3d d, Simplex& s,
                                           Penetration& deep) {
    if (!are_both(difference, GeometryKind::hull) || !is_beyond(difference, d, s, beyond_doubt)) return false;
    return cold ? depth_of_hulls(difference, s.point(0), d, s, deep) : depth_of_hulls(difference, s, deep);
}

// The observer's calls go to the untemplated functions where it is silent.
Search search_as(SilentObserver&, const CoreDifference& d, Simplex& s, SimplexSolver method, double max_distance) {
    return search(d, s, method, max_distance);
}
Search search_as(Recorder& r, const CoreDifference& d, Simplex& s, SimplexSolver method, double max_distance) {
    return search(d, s, method, max_distance, r);
}
Penetration expand_as(SilentObserver&, const CoreDifference& d, bool cold, Simplex& s) {
    Penetration deep;
    if (cold && are_both(d, GeometryKind::hull) && depth_of_hulls(d, s, deep)) return deep;
    return expand_polytope(d, s, d.centre());
}
Penetration expand_as(Recorder& r, const CoreDifference& d, bool, Simplex& s) {
    return expand_polytope(d, s, d.centre(), r);
}

// Steps that are to be seen are taken one by one.
LENDULET_FORCE_INLINE bool is_deep_as(SilentObserver&, const CoreDifference& difference, bool cold, Vec3d d, Simplex& s,
                                      Penetration& deep) {
    return is_deep_at_once(difference, cold, d, s, deep);
}
bool is_deep_as(Recorder&, const CoreDifference&, bool, Vec3d, Simplex&, Penetration&) { return false; }
// Boxes that GJK found to overlap, or left in doubt.
bool are_settled_as(SilentObserver&, const CoreDifference& difference, float max_distance, GjkCache& cache,
                    ConvexDistance& result) {
    return are_both(difference, GeometryKind::box) &&
           closest_of_boxes(BoxDifference(difference), max_distance, cache, result);
}
bool are_settled_as(Recorder&, const CoreDifference&, float, GjkCache&, ConvexDistance&) { return false; }

// Where a flat or a side of a curved core gave the last normal it mostly gives the next one too: apart, its two points
// prove themselves; overlapping, a small polytope does.
bool is_as_before(const CoreDifference& difference, GjkCache& cache, ConvexDistance& result) {
    Tangency t;
    if (!difference.curved || cache.count == 0) return false;
    const Vec3d outward = -to_double(cache.direction);
    if (!find_tangency_of_features(difference, outward, t)) {
        if (!is_curved(difference.a) || !is_curved(difference.b)) return false;
        t = find_smooth_tangency(difference, outward);
        if (!(t.miss <= certified_tangent * difference.size)) return false;
    }
    Simplex s;
    if (t.height > 0.0) {
        Penetration deep;
        if (!expand_around(difference, t, s, deep)) return false;
        result = result_overlapping(difference, deep, 0);
        remember(s, result.normal, cache);
    } else {
        s.add(t.p);
        s.weight[0] = 1.0;
        result = result_apart(difference, s, {Outcome::apart, t.p.y, -t.direction, -t.height, 0.0, 0});
        cache.direction = result.normal;
    }
    return true;
}

// From the points remembered or, in a cold query, from one; returns their direction.
Vec3d start(const CoreDifference& difference, const GjkCache& cache, Simplex& s) {
    for (int i = 0; i < cache.count && i < 4; ++i) s.add(difference.point(cache.a[i], cache.b[i]));
    if (s.count > 0) return -to_double(cache.direction);
    const Vec3d d = first_direction(difference);
    s.add(difference.support(d));
    return d;
}

template <class Observer>
LENDULET_FORCE_INLINE ConvexDistance distance_of(const CoreDifference& difference, GjkCache& cache,
                                                 SimplexSolver method, float max_distance, Observer& observer) {
    ConvexDistance result;
    if (is_as_before(difference, cache, result)) return result;
    const bool cold = cache.count == 0;
    Simplex s;
    Penetration deep;
    const Vec3d d = start(difference, cache, s);
    const bool is_deep = is_deep_as(observer, difference, cold, d, s, deep);
    Search found = is_deep ? Search{Outcome::overlap, {}, {}, 0.0, 0.0, 0}
                           : search_as(observer, difference, s, method, max_distance);
    // Rounding in slivers of simplices can end the search early or take the origin for enclosed. Neither goes
    // unnoticed: the bounds of the distance stay apart, or the depth comes out negative. The polytope then settles the
    // one, and a new search from its separating direction the other.
    bool doubtful = found.outcome == Outcome::apart && !(found.gap <= certified_distance * difference.size);
    if (found.outcome == Outcome::overlap || doubtful) {
        if (!is_deep && are_settled_as(observer, difference, max_distance, cache, result)) return result;
        if (!is_deep) deep = expand_as(observer, difference, cold, s);
        result = result_overlapping(difference, deep, found.iterations);
        if (deep.depth < -certified_distance * difference.size) {
            s.count = 0;
            s.add(difference.support(deep.outward));
            int before = found.iterations;
            found = search_as(observer, difference, s, SimplexSolver::barycentric, max_distance);
            result = result_apart(difference, s, found);
            result.iterations += before;
            result.expansions = deep.expansions;
        }
    } else {
        result = result_apart(difference, s, found);
    }
    remember(s, result.normal, cache);
    if (are_both(difference, GeometryKind::box) && result.distance <= near * difference.size)
        cache.face = GjkCache::unknown_face;
    return result;
}

// Boxes that are near each other or overlap mostly need no search.
LENDULET_FORCE_INLINE bool are_near_boxes(const CoreDifference& difference, float max_distance, GjkCache& cache,
                                          ConvexDistance& result) {
    const bool cold = cache.count == 0;
    if (!are_both(difference, GeometryKind::box) || !(cold || cache.face != 0)) return false;
    const BoxDifference boxes(difference);
    const double limit = max_distance > 0.0f ? max_distance : 0.0;
    if (cold && boxes.are_farther(minimum(near * boxes.size, limit))) return false;
    return closest_of_boxes(boxes, max_distance, cache, result);
}

#ifdef LENDULET_CERTIFICATES
// Ends the program where an answer is not proven: apart, the gap between the supports along the normal bounds the
// distance from below, and the nearest points, which come from points of the cores, bound it from above; overlapping,
// the same gap is an upper bound of the depth. Nothing here depends on how the answer was found.
void check_certificate(const CoreDifference& difference, const ConvexDistance& r, double max_distance) {
    constexpr double distance_error = 2e-6, depth_error = 1e-5, witness_error = 4e-6;  // of S
    const Vec3d n = to_double(r.normal), a = to_double(r.point_a), b = to_double(r.point_b);
    const double size = difference.size, d = r.distance;
    const double separation = dot(n, difference.support(-n).y);
    bool proven = r.converged && absolute(length(n) - 1.0) <= 1e-6;
    if (d > max_distance) {  // only that it is beyond
        proven = proven && separation >= d - distance_error * size;
    } else {
        proven = proven && absolute(separation - d) <= (d >= 0.0 ? distance_error : depth_error) * size;
        proven = proven && absolute(length(b - a) - absolute(d)) <= witness_error * size;
        const double above_a = dot(n, a - support_point(difference.a, n));
        proven = proven && above_a <= witness_error * size;
    }
    if (!proven) __builtin_trap();
}
#endif

}  // namespace

ConvexDistance distance(const ConvexPair& pair, GjkCache& cache, SimplexSolver method, float max_distance) {
    SilentObserver silent;
    ConvexDistance result;
    const CoreDifference difference(pair);
    if (!are_near_boxes(difference, max_distance, cache, result))
        result = distance_of(difference, cache, method, max_distance, silent);
#ifdef LENDULET_CERTIFICATES
    check_certificate(difference, result, max_distance);
#endif
    return result;
}

ConvexDistance distance(const ConvexPair& pair, GjkCache& cache, SimplexSolver method, float max_distance,
                        Recorder& recorder) {
    return distance_of(CoreDifference(pair), cache, method, max_distance, recorder);
}

}  // namespace lendulet
