// Gilbert, Johnson, Keerthi, "A fast procedure for computing the distance between complex objects in three-dimensional
// space", IEEE J. Robotics and Automation 4 (1988); the bounds that end the iteration follow van den Bergen, "A fast
// and robust GJK implementation for collision detection of convex objects", J. Graphics Tools 4 (1999).
#include "collision/gjk_search.h"

#include "collision/gjk_newton.h"
#include "collision/simplex.h"
#include "collision/trace.h"

namespace lendulet {
namespace {

constexpr int max_iterations = 64;
// Nearer than this times S the direction of v is rounding: the polytope decides.
constexpr double touching = 1e-12;
// The search ends when a support point lowers the distance by less than these: relative to the distance, which bounds
// the error of the normal at every distance, and relative to S. Polytopes end exactly, at a vertex they already have.
constexpr double relative_gap = 1e-9, relative_gap_curved = 1e-7;
constexpr double absolute_gap = 1e-14, absolute_gap_curved = 1e-8;
// Of S. Where |v| has grown by no more than this it may have shrunk: it is only known to rounding. Along curved edges
// the direction of v still improves then. Polytopes have too few points for that to last.
constexpr double rounding_curved = 2e-15;
// Curved cores: Newton's method is tried when the distance is known to this times S, and again 100 times nearer. Its
// result counts where the support point misses the line along the direction by less than `tangent` times S.
constexpr double newton_gap = 0.02, tangent = 1e-9;

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

// Ends the search at a smooth contact that Newton's method finds from the direction of v, if it comes much nearer to
// the solution than `gap`, the distance between the bounds so far.
bool end_at_tangency(const CoreDifference& difference, Simplex& s, double gap, Search& result) {
    const double size = difference.size;
    Tangency t = find_tangency(difference, (-1.0 / length(result.v)) * result.v);
    double upper = length(t.p.y), lower = -t.height;
    if (!(t.miss <= tangent * size) || !(upper - lower < 1e-3 * gap)) return false;
    if (lower < -certified_distance * size) return false;  // the cores overlap
    s.count = 0;
    s.add(t.p);
    s.weight[0] = 1.0;
    result.outcome = Outcome::apart;
    result.v = t.p.y;
    result.direction = -t.direction;
    result.distance = lower > 0.0 ? upper : lower;
    result.gap = result.distance - lower;
    return true;
}

Search end_at(const Search& found, Outcome outcome, double lower) {
    double length_v = length(found.v);
    lower /= length_v;
    bool beyond = outcome == Outcome::beyond;
    return {outcome,
            found.v,
            (1.0 / length_v) * found.v,
            beyond ? lower : length_v,
            beyond ? 0.0 : length_v - lower,
            found.iterations};
}

}  // namespace

template <class Observer>
Search search(const CoreDifference& difference, Simplex& s, SimplexSolver method, double max_distance,
              Observer& observer) {
    const double size = difference.size;
    const double near_zero = touching * touching * size * size;
    const double relative = difference.curved ? relative_gap_curved : relative_gap;
    const double least_gap = (difference.curved ? absolute_gap_curved : absolute_gap) * size;
    const double limit = max_distance > 0.0 ? max_distance * max_distance : 0.0;
    double newton_below = difference.curved ? newton_gap * size : 0.0;
    const double noise = difference.curved ? rounding_curved * size : 0.0;
    double previous = 1e300;
    Search result{Outcome::overlap, {}, {}, 0.0, 0.0, 0};
    for (;; ++result.iterations) {
        SubSimplex part = closest_sub_simplex(method, s.y, s.count);
        keep_part(s, part);
        const Vec3d v = result.v = part.point;
        const double vv = dot(v, v);
        observer.simplex(s, v);
        if (s.count == 4 || vv <= near_zero) return result;

        DifferencePoint p = difference.support(-v);
        observer.support(p);
        const double vy = dot(v, p.y), gap = vv - vy;  // lower bound of the distance, and what is left, times |v|
        if (vy > 0.0 && vy * vy > limit * vv) return end_at(result, Outcome::beyond, vy);
        bool settled = !(gap > relative * vv) || gap * gap <= least_gap * least_gap * vv;
        bool stuck = vv >= previous && vv >= previous + noise * square_root(vv);
        if (settled || stuck || holds(s, p.y) || result.iterations == max_iterations)
            return end_at(result, Outcome::apart, vy);
        if (gap * gap < newton_below * newton_below * vv) {
            if (end_at_tangency(difference, s, gap / square_root(vv), result)) return result;
            newton_below *= 0.01;
        }
        previous = vv;
        s.add(p);
    }
}

template Search search(const CoreDifference&, Simplex&, SimplexSolver, double, Recorder&);

Search search(const CoreDifference& difference, Simplex& s, SimplexSolver method, double max_distance) {
    SilentObserver silent;
    return search(difference, s, method, max_distance, silent);
}

}  // namespace lendulet
