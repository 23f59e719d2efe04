// Closest point to the origin of a simplex of one to four points: the inner problem of GJK (thesis 4.1), in the two
// ways of the thesis. Both accept any points, degenerate simplices included, and agree to rounding.
#pragma once

#include <cstdint>

#include "collision/gjk_math.h"
#include "lendulet/options.h"

namespace lendulet {

// The smallest part of a simplex that holds its closest point to the origin.
struct SubSimplex {
    int count;         // points of the part; 4: the origin lies inside the tetrahedron
    uint8_t index[4];  // which points, in rising order
    double weight[4];  // barycentric coordinates of the closest point, positive, sum 1
    Vec3d point;       // the closest point; exactly zero for count 4
};

// By signed lengths, areas and volumes: a negative barycentric coordinate names a part that cannot hold the closest
// point; where several are negative, all remaining parts are tried and the nearest wins. Compare Montanari, Petrinic,
// Barbieri, "Improving the GJK algorithm for faster and more reliable distance queries", ACM TOG 36 (2017).
SubSimplex closest_barycentric(const Vec3d* y, int count);

// By half spaces: starting at the newest point, walks from part to neighbouring part across the planes that bound the
// Voronoi regions of vertices, edges and faces, until the origin lies on the inner side of all planes of one region.
// The generalisation to three dimensions of the walk in the plane; compare Mirtich, "V-Clip", ACM TOG 17 (1998).
SubSimplex closest_half_space(const Vec3d* y, int count);

LENDULET_FORCE_INLINE SubSimplex closest_sub_simplex(SimplexSolver method, const Vec3d* y, int count) {
    return method == SimplexSolver::barycentric ? closest_barycentric(y, count) : closest_half_space(y, count);
}

// Whether four points span so little volume, against the rounding of products of their coordinates, that the sides on
// which the origin lies of their faces are not known. e1, e2, e3 are the edges from y[0].
LENDULET_FORCE_INLINE bool is_flat(const Vec3d* y, Vec3d e1, Vec3d e2, Vec3d e3, double volume) {
    constexpr double rounding = 1e-14;
    double edge = maximum(dot(e1, e1), maximum(dot(e2, e2), dot(e3, e3)));
    double reach = maximum(maximum(dot(y[0], y[0]), dot(y[1], y[1])), maximum(dot(y[2], y[2]), dot(y[3], y[3])));
    return !(volume * volume > rounding * rounding * edge * edge * reach);
}

// -- Pieces that both share -------------------------------------------------------------------------------------------

LENDULET_FORCE_INLINE SubSimplex vertex_part(const Vec3d* y, int i) {
    return {1, {static_cast<uint8_t>(i)}, {1.0}, y[i]};
}
// The point between y[i] and y[j] whose signed distances from the end planes are ti (behind i) and tj (behind j). It is
// reached from the end that weighs more: the other may be farther by any factor, and so would be the rounding.
LENDULET_FORCE_INLINE SubSimplex edge_part(const Vec3d* y, int i, int j, double ti, double tj) {
    const double scale = 1.0 / (ti + tj), wi = scale * tj, wj = scale * ti;
    const int from = wi >= wj ? i : j;
    return {2,
            {static_cast<uint8_t>(i), static_cast<uint8_t>(j)},
            {wi, wj},
            y[from] + minimum(wi, wj) * (y[i + j - from] - y[from])};
}
// Inside the triangle i, j, k with normal n and twice the signed areas ai, aj, ak opposite to its corners. The closest
// point is taken along the normal, which keeps its direction exact however far the triangle reaches. Its length comes
// from the corner that weighs most, for the same reason.
LENDULET_FORCE_INLINE SubSimplex face_part(const Vec3d* y, int i, int j, int k, Vec3d n, double ai, double aj,
                                           double ak) {
    const double scale = 1.0 / (ai + aj + ak), most = maximum(ai, aj);
    const int nearest = ak > most ? k : aj > ai ? j : i;
    return {3,
            {static_cast<uint8_t>(i), static_cast<uint8_t>(j), static_cast<uint8_t>(k)},
            {scale * ai, scale * aj, scale * ak},
            (dot(n, y[nearest]) / dot(n, n)) * n};
}

}  // namespace lendulet
