// The first simplex solver of the thesis (4.1): barycentric coordinates of the origin with respect to the whole
// simplex; where one is negative, the part opposite to that point is tried instead, and the nearest of the tried parts
// wins.
#include "collision/simplex.h"

namespace lendulet {
namespace {

// Squared sine of the angle below which three points count as collinear: there the signs of areas are rounding, and all
// parts are compared by distance.
constexpr double collinear = 1e-18;

void keep_nearer(SubSimplex& best, const SubSimplex& candidate) {
    if (length_squared(candidate.point) < length_squared(best.point)) best = candidate;
}

SubSimplex closest_on_segment(const Vec3d* y, int i, int j) {
    double ti = dot(y[i], y[i] - y[j]), tj = dot(y[j], y[j] - y[i]);
    if (!(ti > 0.0)) return vertex_part(y, i);
    if (!(tj > 0.0)) return vertex_part(y, j);
    return edge_part(y, i, j, ti, tj);
}

SubSimplex closest_on_triangle(const Vec3d* y, int i, int j, int k) {
    Vec3d ij = y[j] - y[i], ik = y[k] - y[i], n = cross(ij, ik);
    // Areas of the triangles made by the projected origin and each edge, times |n|.
    double ai = dot(n, cross(y[j], y[k] - y[j]));
    double aj = -dot(n, cross(y[k], ik));
    double ak = dot(n, cross(y[i], ij));
    bool flat = !(dot(n, n) > collinear * dot(ij, ij) * dot(ik, ik));
    if (!flat && ai > 0.0 && aj > 0.0 && ak > 0.0) return face_part(y, i, j, k, n, ai, aj, ak);

    SubSimplex best = vertex_part(y, i);
    if (flat || ai <= 0.0) keep_nearer(best, closest_on_segment(y, j, k));
    if (flat || aj <= 0.0) keep_nearer(best, closest_on_segment(y, i, k));
    if (flat || ak <= 0.0) keep_nearer(best, closest_on_segment(y, i, j));
    return best;
}

SubSimplex closest_on_tetrahedron(const Vec3d* y) {
    Vec3d e1 = y[1] - y[0], e2 = y[2] - y[0], e3 = y[3] - y[0];
    Vec3d n3 = cross(e1, e2), n1 = cross(e2, e3), n2 = cross(e3, e1);
    double volume = dot(n3, e3);
    // Volumes of the tetrahedra made by the origin and each face; u[i] belongs to the face opposite to point i.
    double u[4];
    u[1] = -dot(n1, y[0]);
    u[2] = -dot(n2, y[0]);
    u[3] = -dot(n3, y[0]);
    u[0] = dot(cross(y[2] - y[1], y[3] - y[1]), y[1]);
    double sign = volume < 0.0 ? -1.0 : 1.0;
    bool flat = is_flat(y, e1, e2, e3, volume);
    bool inside = !flat;
    for (double& ui : u) {
        ui *= sign;
        inside = inside && ui > 0.0;
    }
    if (inside) {
        double scale = 1.0 / (u[0] + u[1] + u[2] + u[3]);
        return {4, {0, 1, 2, 3}, {scale * u[0], scale * u[1], scale * u[2], scale * u[3]}, {}};
    }
    SubSimplex best = vertex_part(y, 3);
    if (flat || u[0] <= 0.0) keep_nearer(best, closest_on_triangle(y, 1, 2, 3));
    if (flat || u[1] <= 0.0) keep_nearer(best, closest_on_triangle(y, 0, 2, 3));
    if (flat || u[2] <= 0.0) keep_nearer(best, closest_on_triangle(y, 0, 1, 3));
    if (flat || u[3] <= 0.0) keep_nearer(best, closest_on_triangle(y, 0, 1, 2));
    return best;
}

}  // namespace

SubSimplex closest_barycentric(const Vec3d* y, int count) {
    switch (count) {
        case 1:
            return vertex_part(y, 0);
        case 2:
            return closest_on_segment(y, 0, 1);
        case 3:
            return closest_on_triangle(y, 0, 1, 2);
        default:
            return closest_on_tetrahedron(y);
    }
}

}  // namespace lendulet
