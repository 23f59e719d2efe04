// The second simplex solver of the thesis (4.1): divides space by the planes of each part of the simplex and steps to
// the part on whose side the origin lies, until the planes of one part enclose it.
//
// The planes: two parts that differ by one point share the boundary of their Voronoi regions. Between a vertex and an
// edge it is the plane through the vertex at right angles to the edge; between an edge and a face the plane through the
// edge at right angles to the face; between a face and the inside the face itself. Each test is always computed from
// the points in rising order, so that both sides of a boundary see the same sign and the walk cannot swing between
// them.
#include "collision/simplex.h"

namespace lendulet {
namespace {

// Squared sine of the angle below which a face counts as an edge: the signs of its tests are rounding.
constexpr double collinear = 1e-18;
// A walk visits each of the 15 parts once at most where signs are exact; more steps mean that rounding misleads it.
constexpr int max_steps = 16;

struct Face {
    Vec3d n;
    double area[3];  // signed, times 2 |n|: how far inside each edge the origin lies; area[m] is opposite to corner m
    bool flat;
};

Face make_face(const Vec3d* y, int i, int j, int k) {
    Vec3d ij = y[j] - y[i], ik = y[k] - y[i], n = cross(ij, ik);
    bool flat = !(dot(n, n) > collinear * dot(ij, ij) * dot(ik, ik));
    return {n, {dot(n, cross(y[j], y[k] - y[j])), -dot(n, cross(y[k], ik)), dot(n, cross(y[i], ij))}, flat};
}

struct Part {
    int count;
    int index[3];
};
// The three corners in rising order.
Part sorted_face(int i, int j, int k) {  // i < j
    if (k < i) return {3, {k, i, j}};
    if (k < j) return {3, {i, k, j}};
    return {3, {i, j, k}};
}
Part sorted_edge(int i, int j) { return i < j ? Part{2, {i, j, 0}} : Part{2, {j, i, 0}}; }

// Signed distance (times the edge's length) by which the origin lies beyond the plane through i towards j.
double towards(const Vec3d* y, int i, int j) { return dot(y[i], y[i] - y[j]); }

enum class Step { settled, moved, inside, lost };

Step walk_from_vertex(const Vec3d* y, int count, Part& part) {
    int i = part.index[0];
    for (int j = count - 1; j >= 0; --j)
        if (j != i && towards(y, i, j) > 0.0) {
            part = sorted_edge(i, j);
            return Step::moved;
        }
    return Step::settled;
}

Step walk_from_edge(const Vec3d* y, int count, Part& part, SubSimplex& result) {
    int i = part.index[0], j = part.index[1];
    double ti = towards(y, i, j), tj = towards(y, j, i);
    if (!(ti > 0.0) || !(tj > 0.0)) {
        part = {1, {ti > 0.0 ? j : i, 0, 0}};
        return Step::moved;
    }
    for (int k = count - 1; k >= 0; --k) {
        if (k == i || k == j) continue;
        Part next = sorted_face(i, j, k);
        Face face = make_face(y, next.index[0], next.index[1], next.index[2]);
        int corner = k < i ? 0 : k < j ? 1 : 2;
        if (!face.flat && face.area[corner] > 0.0) {
            part = next;
            return Step::moved;
        }
    }
    result = edge_part(y, i, j, ti, tj);
    return Step::settled;
}

// Whether the origin lies beyond the face opposite to corner m, seen from that corner.
bool beyond_face(const Vec3d* y, int m) {
    int i = m == 0 ? 1 : 0, j = m <= 1 ? 2 : 1, k = m <= 2 ? 3 : 2;
    Vec3d n = cross(y[j] - y[i], y[k] - y[i]);
    double origin = -dot(n, y[i]), corner = dot(n, y[m] - y[i]);
    return corner > 0.0 ? origin <= 0.0 : origin >= 0.0;
}

// Behind a face the origin lies inside the tetrahedron or beyond another face.
Step walk_through_face(const Vec3d* y, Part& part, int opposite) {
    Vec3d e1 = y[1] - y[0], e2 = y[2] - y[0], e3 = y[3] - y[0];
    if (is_flat(y, e1, e2, e3, dot(cross(e1, e2), e3))) return Step::lost;
    for (int m = 3; m >= 0; --m)
        if (m != opposite && beyond_face(y, m)) {
            part = {3, {m == 0 ? 1 : 0, m <= 1 ? 2 : 1, m <= 2 ? 3 : 2}};
            return Step::moved;
        }
    return Step::inside;
}

Step walk_from_face(const Vec3d* y, int count, Part& part, SubSimplex& result) {
    int i = part.index[0], j = part.index[1], k = part.index[2];
    Face face = make_face(y, i, j, k);
    if (face.flat) return Step::lost;
    for (int m = 0; m < 3; ++m)
        if (!(face.area[m] > 0.0)) {
            part = m == 0 ? Part{2, {j, k, 0}} : m == 1 ? Part{2, {i, k, 0}} : Part{2, {i, j, 0}};
            return Step::moved;
        }
    if (count == 4) {
        int opposite = 6 - i - j - k;
        if (!beyond_face(y, opposite)) return walk_through_face(y, part, opposite);
    }
    result = face_part(y, i, j, k, face.n, face.area[0], face.area[1], face.area[2]);
    return Step::settled;
}

SubSimplex inside_part(const Vec3d* y) {
    double volume[4], sum = 0.0;
    for (int m = 0; m < 4; ++m) {
        int i = m == 0 ? 1 : 0, j = m <= 1 ? 2 : 1, k = m <= 2 ? 3 : 2;
        volume[m] = absolute(dot(y[i], cross(y[j] - y[i], y[k] - y[i])));
        sum += volume[m];
    }
    return {4, {0, 1, 2, 3}, {volume[0] / sum, volume[1] / sum, volume[2] / sum, volume[3] / sum}, {}};
}

}  // namespace

SubSimplex closest_half_space(const Vec3d* y, int count) {
    Part part{1, {count - 1, 0, 0}};
    SubSimplex result;
    for (int n = 0; n < max_steps; ++n) {
        Step step;
        if (part.count == 1) step = walk_from_vertex(y, count, part);
        else if (part.count == 2) step = walk_from_edge(y, count, part, result);
        else step = walk_from_face(y, count, part, result);
        if (step == Step::settled) return part.count == 1 ? vertex_part(y, part.index[0]) : result;
        if (step == Step::inside) return inside_part(y);
        if (step == Step::lost) break;
    }
    return closest_barycentric(y, count);  // compares all parts by distance, which rounding cannot mislead far
}

}  // namespace lendulet
