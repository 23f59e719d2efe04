// The difference B - A of two boxes, seen from the frame of A: a body of fifteen pairs of faces, each spanned by two
// edges of the boxes (Gottschalk, Lin, Manocha 1996, call their normals the separating axes).
#pragma once

#include "collision/gjk_difference.h"
#include "math/wide/wide.h"

namespace lendulet {

// A vector in two registers; the last lane of z is 0.
struct Lanes {
    using Two = Wide<double, 2>;
    Two xy, z;
    LENDULET_FORCE_INLINE double operator[](int i) const { return i == 0 ? xy[0] : i == 1 ? xy[1] : z[0]; }
    LENDULET_FORCE_INLINE friend Lanes operator+(Lanes a, Lanes b) { return {a.xy + b.xy, a.z + b.z}; }
    LENDULET_FORCE_INLINE friend Lanes operator-(Lanes a, Lanes b) { return {a.xy - b.xy, a.z - b.z}; }
    LENDULET_FORCE_INLINE friend Lanes operator-(Lanes a) { return {-a.xy, -a.z}; }
    LENDULET_FORCE_INLINE friend Lanes operator*(Lanes a, Lanes b) { return {a.xy * b.xy, a.z * b.z}; }
    LENDULET_FORCE_INLINE friend Lanes operator*(double a, Lanes b) { return {a * b.xy, a * b.z}; }
};
LENDULET_FORCE_INLINE Lanes lanes(double x, double y, double z) { return {Lanes::Two{x, y}, Lanes::Two{z, 0.0}}; }
LENDULET_FORCE_INLINE Lanes lanes(Vec3d v) { return lanes(v.x, v.y, v.z); }
LENDULET_FORCE_INLINE Lanes lanes(Vec3 v) { return lanes(to_double(v)); }
LENDULET_FORCE_INLINE Vec3 to_float(Lanes a) { return to_float(Vec3d{a[0], a[1], a[2]}); }
LENDULET_FORCE_INLINE double sum(Lanes a) {
    const Lanes::Two s = a.xy + a.z;
    return s[0] + s[1];
}
LENDULET_FORCE_INLINE double dot(Lanes a, Lanes b) { return sum(a * b); }
LENDULET_FORCE_INLINE Lanes cross(Lanes a, Lanes b) {
    return lanes(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
LENDULET_FORCE_INLINE Lanes absolute(Lanes a) {
    auto of = [](Lanes::Two x) { return (Lanes::Two)((Wide<int64_t, 2>)x & INT64_MAX); };
    return {of(a.xy), of(a.z)};
}
// Of each of three numbers what towards_sign() is of one; sizes are not negative.
LENDULET_FORCE_INLINE Lanes towards_signs(Lanes size, Lanes a) {
    auto of = [](Lanes::Two s, Lanes::Two x) {
        return (Lanes::Two)((Wide<int64_t, 2>)s | ((Wide<int64_t, 2>)(x + 0.0) & INT64_MIN));
    };
    return {of(size.xy, a.xy), of(size.z, a.z)};
}

// The two edges that span a face: 0 to 2 of A, 3 to 5 of B; and which coordinates of a corner of A and of B they leave.
// Faces have the numbers of BestAxis.
struct Span {
    int first, second;
    Lanes kept_a, kept_b;
};
inline constexpr Lanes unit_x{{1.0, 0.0}, {0.0, 0.0}}, unit_y{{0.0, 1.0}, {0.0, 0.0}}, unit_z{{0.0, 0.0}, {1.0, 0.0}},
    all_three{{1.0, 1.0}, {1.0, 0.0}}, without_x{{0.0, 1.0}, {1.0, 0.0}}, without_y{{1.0, 0.0}, {1.0, 0.0}},
    without_z{{1.0, 1.0}, {0.0, 0.0}};
inline constexpr int face_count = 15;
inline constexpr Span spans[face_count] = {
    {1, 2, unit_x, all_three},    {2, 0, unit_y, all_three},    {0, 1, unit_z, all_three},
    {4, 5, all_three, unit_x},    {5, 3, all_three, unit_y},    {3, 4, all_three, unit_z},
    {0, 3, without_x, without_x}, {0, 4, without_x, without_y}, {0, 5, without_x, without_z},
    {1, 3, without_y, without_x}, {1, 4, without_y, without_y}, {1, 5, without_y, without_z},
    {2, 3, without_z, without_x}, {2, 4, without_z, without_y}, {2, 5, without_z, without_z}};
// How far a point of A moves, in its frame, with each of the edges.
inline constexpr Lanes along_edge_of_a[6] = {unit_x, unit_y, unit_z, {}, {}, {}};

struct BoxDifference {
    Lanes edge[6];  // directions of A's and of B's
    Lanes row[3];   // of B's axes in a matrix
    Lanes t, half_a, half_b;
    float half[6];
    double size;  // S

    LENDULET_FORCE_INLINE explicit BoxDifference(const CoreDifference& d)
        : edge{unit_x, unit_y, unit_z, lanes(d.rotation.x), lanes(d.rotation.y), lanes(d.rotation.z)},
          row{lanes(d.rotation.x.x, d.rotation.y.x, d.rotation.z.x),
              lanes(d.rotation.x.y, d.rotation.y.y, d.rotation.z.y),
              lanes(d.rotation.x.z, d.rotation.y.z, d.rotation.z.z)},
          t(lanes(d.translation)),
          half_a(lanes(d.a.size)),
          half_b(lanes(d.b.size)),
          half{d.a.size.x, d.a.size.y, d.a.size.z, d.b.size.x, d.b.size.y, d.b.size.z},
          size(d.size) {}

    LENDULET_FORCE_INLINE Lanes to_b(Lanes v) const { return v[0] * row[0] + (v[1] * row[1] + v[2] * row[2]); }
    LENDULET_FORCE_INLINE Lanes from_b(Lanes v) const { return v[0] * edge[3] + (v[1] * edge[4] + v[2] * edge[5]); }
    // How far both boxes reach along n, added.
    LENDULET_FORCE_INLINE double reach(Lanes n, Lanes n_in_b) const {
        return sum(absolute(n) * half_a + absolute(n_in_b) * half_b);
    }
    // Whether the line through the middles proves that the boxes are farther apart than this.
    LENDULET_FORCE_INLINE bool are_farther(double distance) const {
        const double square = dot(t, t), bound = square - reach(t, to_b(t));
        return bound > 0.0 && bound * bound > distance * distance * square;
    }
};

// The plane of a face.
struct FacePlane {
    Lanes n, n_in_b;  // from A to B, as long as the sine between the edges
    double separation_times_sine, cosine, sine_squared;
};
LENDULET_FORCE_INLINE FacePlane plane_of(const BoxDifference& boxes, int face) {
    const Lanes g = boxes.edge[spans[face].first], h = boxes.edge[spans[face].second];
    const Lanes n = cross(g, h), n_in_b = boxes.to_b(n);
    const double cosine = dot(g, h), along = dot(n, boxes.t), way = towards_sign(1.0, along);
    return {way * n, way * n_in_b, absolute(along) - boxes.reach(n, n_in_b), cosine, 1.0 - cosine * cosine};
}

}  // namespace lendulet
