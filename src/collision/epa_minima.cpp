// Descents on the sphere of directions, from where a full polytope finds the depths least. In: the polytope. Out:
// depth, normal, witness points.
#include "collision/epa_minima.h"

#include "collision/gjk_search.h"

namespace lendulet {
namespace {

constexpr double unknown = 1e300;
// Of S. Depths nearer to each other are the same.
constexpr double settled = 1e-8;

double depth_along(const CoreDifference& difference, Vec3d n) { return dot(n, difference.support(n).y); }

// By depth and by how far the nearest point misses it: a round that came from afar may end at the right normal with a
// point elsewhere on the face.
bool is_better(const Penetration& a, const Penetration& b) { return a.depth + a.gap < b.depth + b.gap; }

// The nearest point of the difference to a point o a little beyond its surface along `from`, with the normal there.
Penetration nearest_from_outside(const CoreDifference& difference, Vec3d from, int expansions) {
    constexpr uint8_t all_points[4] = {0, 1, 2, 3};
    const double clearance = 0.01 * difference.size;
    DifferencePoint p = difference.support(from);
    Vec3d o = (dot(from, p.y) + clearance) * from;
    CoreDifference seen = difference;
    seen.translation -= o;
    Simplex s;
    s.add({p.y - o, p.a, p.b});
    Search found = search(seen, s, SimplexSolver::barycentric, 1e300);
    Vec3d n = -found.direction, y = o + found.v;
    double depth = depth_along(difference, n);
    return {depth,     n, y, difference.witness_on_a(s, all_points, s.weight, s.count), absolute(length(y) - depth),
            expansions};
}

// Seen from outside, a little beyond the surface along the normal, the nearest point of the difference has a normal
// that needs no more depth. With o = (h(n) + clearance) n and n' the normal there, h(n') <= |o| - clearance = h(n).
// Along valleys these steps are short, so each round starts twice as far on as the last one came, while that pays.
// About the middle of a ball they are too short to be told from rounding: before the search ends it leaps ahead once.
Penetration descend(const CoreDifference& difference, Vec3d n, int expansions) {
    constexpr int max_rounds = 64;
    constexpr double leap = 0.1, least_step = 1e-7;  // rad
    Penetration lowest{depth_along(difference, n), n, {}, {}, unknown, expansions}, best = lowest;
    Vec3d ahead{};
    bool has_leapt = false;
    for (int round = 0; round < max_rounds; ++round) {
        const Vec3d from = lowest.outward + ahead;
        const Penetration next = nearest_from_outside(difference, (1.0 / length(from)) * from, expansions);
        const bool lower = next.depth < lowest.depth - settled * difference.size, plain = length_squared(ahead) == 0.0;
        const Vec3d step = next.outward - lowest.outward;
        if (next.depth < lowest.depth) lowest = next;
        if (is_better(next, best)) best = next;
        if (lower) {
            ahead = 2.0 * step;
            has_leapt = false;
        } else if (!plain) {
            ahead = {};
        } else {
            const double far = length(step);
            if (has_leapt || !(far > least_step)) break;
            has_leapt = true;
            ahead = (leap / far) * step;
        }
    }
    return best;
}

// Depths along the normals of the faces, and for each vertex the least of its faces, and of their distances.
struct Landscape {
    double depth[Polytope::max_faces];
    double least_around[Polytope::max_vertices], nearest_around[Polytope::max_vertices];

    Landscape(const CoreDifference& difference, const Polytope& polytope) {
        for (int v = 0; v < Polytope::max_vertices; ++v) least_around[v] = nearest_around[v] = unknown;
        for (int f = 0; f < polytope.face_end(); ++f) {
            if (!polytope.alive(f)) continue;
            const Vec3d n = polytope.normal(f);
            depth[f] = depth_along(difference, n);
            for (int i = 0; i < 3; ++i) {
                const int v = polytope.corners(f)[i];
                least_around[v] = minimum(least_around[v], depth[f]);
                nearest_around[v] = minimum(nearest_around[v], polytope.distance(f, n));
            }
        }
    }
    // No face that shares a corner needs less depth.
    bool is_minimum(const Polytope& polytope, int f) const {
        return depth[f] <= least_at(polytope.corners(f), least_around);
    }
    // Nothing beyond this face or one that shares a corner with it, to which the least depth may belong, is less deep.
    double bound(const Polytope& polytope, int f) const { return least_at(polytope.corners(f), nearest_around); }

private:
    static double least_at(const uint8_t* v, const double* values) {
        return minimum(values[v[0]], minimum(values[v[1]], values[v[2]]));
    }
};

}  // namespace

Penetration search_minima(const CoreDifference& difference, const Polytope& polytope, double known, int expansions) {
    constexpr int max_starts = 16;
    const double size = difference.size;
    const Landscape landscape(difference, polytope);
    Penetration best{unknown, {}, {}, {}, unknown, expansions};
    bool tried[Polytope::max_faces] = {};
    for (int starts = 0; starts < max_starts; ++starts) {
        int f = -1;
        for (int g = 0; g < polytope.face_end(); ++g) {
            if (!polytope.alive(g) || tried[g] || !landscape.is_minimum(polytope, g)) continue;
            if (!(landscape.bound(polytope, g) < known - certified_distance * size)) continue;
            if (f < 0 || landscape.depth[g] < landscape.depth[f]) f = g;
        }
        if (f < 0) break;
        tried[f] = true;
        Penetration found = descend(difference, polytope.normal(f), expansions);
        if (is_better(found, best)) best = found;
        known = minimum(known, best.depth);
    }
    return best;
}

}  // namespace lendulet
