// The second simplex solver of the thesis (4.1): divides space by the planes of each part of the simplex and steps to
// the part on whose side the origin lies, until the planes of one part enclose it.
//
// The planes: two parts that differ by one point share the boundary of their Voronoi regions. Between a vertex and an
// edge it is the plane through the vertex at right angles to the edge; between an edge and a face the plane through the
// edge at right angles to the face; between a face and the inside the face itself. Each test is always computed from
// the points in rising order, so that both sides of a boundary see the same sign and the walk cannot swing between
// them. It starts at the whole simplex: the origin is inside, or beyond a face; beyond an edge of that face, or above
// it; and so on. Downward steps alone can miss the nearest part, hence edges also look up to their other face, and
// vertices to their other edges.
#include "collision/simplex.h"

namespace lendulet {
namespace {

// Squared sine of the angle below which a face counts as an edge: the signs of its tests are rounding.
constexpr double collinear = 1e-18;
// A walk visits each of the 15 parts once at most where signs are exact; more steps mean that rounding misleads it.
constexpr int max_steps = 16;

// Corners in rising order.
struct Part {
    int count;
    int index[3];
};
constexpr Part opposite_face[4] = {{3, {1, 2, 3}}, {3, {0, 2, 3}}, {3, {0, 1, 3}}, {3, {0, 1, 2}}};

struct Face {
    Vec3d ij, ik, n;
    bool flat;
};
LENDULET_FORCE_INLINE Face make_face(const Vec3d* y, Part p) {
    Vec3d ij = y[p.index[1]] - y[p.index[0]], ik = y[p.index[2]] - y[p.index[0]], n = cross(ij, ik);
    return {ij, ik, n, !(dot(n, n) > collinear * dot(ij, ij) * dot(ik, ik))};
}
// How far inside the edge opposite to corner m of the face the origin lies: a signed area times 2 |n|.
LENDULET_FORCE_INLINE double inside_edge(const Vec3d* y, Part p, const Face& face, int m) {
    if (m == 0) return dot(face.n, cross(y[p.index[1]], y[p.index[2]] - y[p.index[1]]));
    if (m == 1) return -dot(face.n, cross(y[p.index[2]], face.ik));
    return dot(face.n, cross(y[p.index[0]], face.ij));
}
// Signed distance (times the edge's length) by which the origin lies beyond the plane through i towards j.
LENDULET_FORCE_INLINE double towards(const Vec3d* y, int i, int j) { return dot(y[i], y[i] - y[j]); }

enum class Step : uint8_t { settled, moved, lost };

struct Walk {
    const Vec3d* y;
    int count;
    Part part;
    bool beyond[4];  // of a tetrahedron: the origin lies beyond the face opposite to the corner
    SubSimplex result;

    Step from_tetrahedron();
    Step from_face();
    Step from_edge();
    Step from_vertex();
    Step to_face_beyond();
};

// To the newest face the origin lies beyond; the newest point is the last.
LENDULET_FORCE_INLINE Step Walk::to_face_beyond() {
    for (int m = 0; m < 4; ++m)
        if (beyond[m]) {
            part = opposite_face[m];
            return Step::moved;
        }
    return Step::lost;
}

LENDULET_FORCE_INLINE Step Walk::from_tetrahedron() {
    Vec3d e1 = y[1] - y[0], e2 = y[2] - y[0], e3 = y[3] - y[0];
    Vec3d n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2), n0 = cross(y[2] - y[1], y[3] - y[1]);
    double volume = dot(n3, e3);
    if (is_flat(y, e1, e2, e3, volume)) return Step::lost;
    // Volumes that the origin makes with each face, positive on the inner side.
    double sign = volume < 0.0 ? -1.0 : 1.0;
    double u[4] = {sign * dot(n0, y[1]), -sign * dot(n1, y[0]), -sign * dot(n2, y[0]), -sign * dot(n3, y[0])};
    for (int m = 0; m < 4; ++m) beyond[m] = !(u[m] > 0.0);
    if (to_face_beyond() == Step::moved) return Step::moved;
    double scale = 1.0 / (u[0] + u[1] + u[2] + u[3]);
    result = {4, {0, 1, 2, 3}, {scale * u[0], scale * u[1], scale * u[2], scale * u[3]}, {}};
    return Step::settled;
}

LENDULET_FORCE_INLINE Step Walk::from_face() {
    const int i = part.index[0], j = part.index[1], k = part.index[2];
    // From below, the nearest part belongs to a face that the origin lies beyond.
    if (count == 4 && !beyond[6 - i - j - k]) return to_face_beyond();
    Face face = make_face(y, part);
    if (face.flat) return Step::lost;
    double area[3];
    for (int m = 0; m < 3; ++m) {
        area[m] = inside_edge(y, part, face, m);
        if (area[m] > 0.0) continue;
        part = m == 0 ? Part{2, {j, k, 0}} : m == 1 ? Part{2, {i, k, 0}} : Part{2, {i, j, 0}};
        return Step::moved;
    }
    result = face_part(y, i, j, k, face.n, area[0], area[1], area[2]);
    return Step::settled;
}

LENDULET_FORCE_INLINE Step Walk::from_edge() {
    const int i = part.index[0], j = part.index[1];
    double ti = towards(y, i, j), tj = towards(y, j, i);
    if (!(ti > 0.0) || !(tj > 0.0)) {
        part = {1, {ti > 0.0 ? j : i, 0, 0}};
        return Step::moved;
    }
    for (int k = count - 1; k >= 0; --k) {
        if (k == i || k == j) continue;
        int corner = k < i ? 0 : k < j ? 1 : 2;
        Part up = corner == 0 ? Part{3, {k, i, j}} : corner == 1 ? Part{3, {i, k, j}} : Part{3, {i, j, k}};
        Face face = make_face(y, up);
        if (!face.flat && inside_edge(y, up, face, corner) > 0.0) {
            part = up;
            return Step::moved;
        }
    }
    result = edge_part(y, i, j, ti, tj);
    return Step::settled;
}

LENDULET_FORCE_INLINE Step Walk::from_vertex() {
    const int i = part.index[0];
    for (int j = count - 1; j >= 0; --j)
        if (j != i && towards(y, i, j) > 0.0) {
            part = i < j ? Part{2, {i, j, 0}} : Part{2, {j, i, 0}};
            return Step::moved;
        }
    result = vertex_part(y, i);
    return Step::settled;
}

}  // namespace

SubSimplex closest_half_space(const Vec3d* y, int count) {
    Walk walk;
    walk.y = y;
    walk.count = count;
    walk.part = {count, {0, 1, 2}};
    for (int n = 0; n < max_steps; ++n) {
        Step step;
        switch (walk.part.count) {
            case 1:
                step = walk.from_vertex();
                break;
            case 2:
                step = walk.from_edge();
                break;
            case 3:
                step = walk.from_face();
                break;
            default:
                step = walk.from_tetrahedron();
        }
        if (step == Step::settled) return walk.result;
        if (step == Step::lost) break;
    }
    return closest_barycentric(y, count);  // compares all parts by distance, which rounding cannot mislead far
}

}  // namespace lendulet
