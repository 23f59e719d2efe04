#include "collision/epa_polytope.h"

#include "math/wide/wide.h"

namespace lendulet {
namespace {

// Squared sine below which the corners of a face count as collinear: its normal would be rounding.
constexpr double collinear = 1e-18;

using Two = Wide<double, 2>;

constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }

LENDULET_FORCE_INLINE double either(bool mask, double a, double b) { return mask ? a : b; }
template <class M>
LENDULET_FORCE_INLINE Two either(M mask, Two a, Two b) {
    return mask ? a : b;
}
LENDULET_FORCE_INLINE double root(double a) { return square_root(a); }
LENDULET_FORCE_INLINE Two root(Two a) { return Two{square_root(a[0]), square_root(a[1])}; }
LENDULET_FORCE_INLINE Two load_two(const double* p) {
    Two r;
    std::memcpy(&r, p, sizeof r);
    return r;
}
LENDULET_FORCE_INLINE void scatter(double* to, const int* places, double a) { to[places[0]] = a; }
LENDULET_FORCE_INLINE void scatter(double* to, const int* places, Two a) {
    to[places[0]] = a[0];
    to[places[1]] = a[1];
}

}  // namespace

// Planes of the faces with corners `from`, `to` (both seen from the apex) and apex: one for each lane of F.
template <class F>
LENDULET_FORCE_INLINE void Polytope::set_planes(const int* faces, Vec3T<F> from, Vec3T<F> to, Vec3d apex) {
    const Vec3T<F> n = cross(from, to);
    const F nn = dot(n, n);
    const auto plain = nn > collinear * dot(from, from) * dot(to, to);
    const F scale = either(plain, 1.0 / root(nn), F{});
    const Vec3T<F> unit = either(plain, scale, F{}) * n;
    const F offset = unit.x * apex.x + unit.y * apex.y + unit.z * apex.z;
    scatter(normal_x_, faces, unit.x);
    scatter(normal_y_, faces, unit.y);
    scatter(normal_z_, faces, unit.z);
    scatter(offset_, faces, offset);
    scatter(distance_, faces, either(plain, offset, F{} + far));
}

int Polytope::add_vertex(const DifferencePoint& p) {
    y_[vertex_count_] = p.y;
    a_[vertex_count_] = p.a;
    b_[vertex_count_] = p.b;
    return vertex_count_++;
}

void Polytope::start(const Simplex& s, double tolerance) {
    tolerance_ = tolerance;
    vertex_count_ = 0;
    free_count_ = 0;
    face_end_ = 4;
    for (int i = 0; i < 4; ++i) add_vertex(s.point(i));
    // Face m is the one opposite to vertex m, wound so that m lies below it.
    bool positive = dot(cross(s.y[1] - s.y[0], s.y[2] - s.y[0]), s.y[3] - s.y[0]) > 0.0;
    static constexpr uint8_t corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int m = 0; m < 4; ++m) {
        const int i = corners[m][0], j = corners[m][positive ? 1 : 2], k = corners[m][positive ? 2 : 1];
        set_planes<double>(&m, y_[i] - y_[k], y_[j] - y_[k], y_[k]);
        const int corner[3] = {i, j, k};
        for (int e = 0; e < 3; ++e) corner_[4 * m + e] = static_cast<uint8_t>(corner[e]);
    }
    // The twin of a half edge belongs to the face opposite to the remaining corner, and starts where this one ends.
    for (int m = 0; m < 4; ++m)
        for (int e = 0; e < 3; ++e) {
            const int other = 4 * corner_[4 * m + next_corner(next_corner(e))], to = corner_[4 * m + next_corner(e)];
            const int at = corner_[other] == to ? 0 : corner_[other + 1] == to ? 1 : 2;
            twin_[4 * m + e] = static_cast<uint16_t>(other + at);
        }
}

int Polytope::nearest_face() const {
    int best = 0;
    double least = distance_[0];
    for (int f = 1; f < face_end_; ++f) {
        const bool nearer = distance_[f] < least;
        least = nearer ? distance_[f] : least;
        best = nearer ? f : best;
    }
    return best;
}

bool Polytope::holds(Vec3d y) const {
    for (int i = 0; i < vertex_count_; ++i)
        if (y_[i].x == y.x && y_[i].y == y.y && y_[i].z == y.z) return true;
    return false;
}

// Lists f and the faces above which y lies. Coplanar counts as above, so that no faces without area arise.
inline void Polytope::find_visible(int f, Vec3d y) {
    for (int g = 0; g < face_end_; g += 2) {
        const Two h = load_two(&normal_x_[g]) * y.x + load_two(&normal_y_[g]) * y.y + load_two(&normal_z_[g]) * y.z -
                      load_two(&offset_[g]);
        std::memcpy(&height_[g], &h, sizeof h);
    }
    height_[f] = far;
    list_visible();
}

inline void Polytope::list_visible() {
    visible_count_ = 0;
    for (int g = 0; g < face_end_; ++g) {
        visible_[visible_count_] = static_cast<uint8_t>(g);
        visible_count_ += height_[g] >= -tolerance_ ? 1 : 0;
    }
}

// The edges between the listed faces and the others. False where they are not one loop that passes each corner once:
// anything else would tear the surface. One loop has the listed faces on one side, so these are connected.
inline bool Polytope::find_outline() {
    int count = 0;
    for (int i = 0; i < visible_count_; ++i) {
        const uint8_t* corner = &corner_[4 * visible_[i]];
        const uint16_t* twin = &twin_[4 * visible_[i]];
        for (int e = 0; e < 3; ++e) {
            outline_[count] = Edge(corner[e], corner[next_corner(e)], twin[e]);
            count += height_[twin[e] / 4] >= -tolerance_ ? 0 : 1;
        }
    }
    edge_count_ = count;
    if (count < 3) return false;
    for (int i = 0; i < count; ++i) edge_from_[outline_[i].from()] = static_cast<uint8_t>(i);
    int at = 0, length = 0;
    do at = edge_from_[outline_[at].to()];
    while (++length < count && at != 0);
    return length == count && at == 0;
}

// Leaves of the listed faces those that are connected to f; false where all are.
bool Polytope::keep_connected(int f) {
    bool reached[max_faces] = {};
    uint8_t list[max_faces] = {static_cast<uint8_t>(f)};
    int count = 1;
    reached[f] = true;
    for (int i = 0; i < count; ++i)
        for (int e = 0; e < 3; ++e) {
            const int g = twin_[4 * list[i] + e] / 4;
            if (reached[g] || !(height_[g] >= -tolerance_)) continue;
            reached[g] = true;
            list[count++] = static_cast<uint8_t>(g);
        }
    if (count == visible_count_) return false;
    for (int i = 0; i < visible_count_; ++i)
        if (!reached[visible_[i]]) height_[visible_[i]] = -far;
    list_visible();
    return true;
}

// Replaces the listed faces by a fan of new ones from the outline to p.
inline void Polytope::join_outline(const DifferencePoint& p) {
    int fresh[max_faces + 1];
    for (int i = 0; i < edge_count_; ++i)
        fresh[i] = i < visible_count_ ? visible_[i] : free_count_ > 0 ? free_[--free_count_] : face_end_++;
    for (int i = edge_count_; i < visible_count_; ++i) {
        distance_[visible_[i]] = offset_[visible_[i]] = far;
        free_[free_count_++] = visible_[i];
    }
    // Two faces at a time; the last one goes with a repetition that nobody reads where their number is odd.
    fresh[edge_count_] = spare;
    outline_[edge_count_] = outline_[0];
    for (int i = 0; i < edge_count_; i += 2) {
        const Edge one = outline_[i], two = outline_[i + 1];
        const Vec3d u = y_[one.from()], v = y_[two.from()], s = y_[one.to()], t = y_[two.to()];
        const Vec3T<Two> from{Two{u.x, v.x} - p.y.x, Two{u.y, v.y} - p.y.y, Two{u.z, v.z} - p.y.z};
        const Vec3T<Two> to{Two{s.x, t.x} - p.y.x, Two{s.y, t.y} - p.y.y, Two{s.z, t.z} - p.y.z};
        set_planes<Two>(&fresh[i], from, to, p.y);
    }
    const auto apex = static_cast<uint8_t>(add_vertex(p));
    for (int i = 0; i < edge_count_; ++i) {
        const Edge edge = outline_[i];
        const int base = 4 * fresh[i], next = 4 * fresh[edge_from_[edge.to()]];
        corner_[base] = static_cast<uint8_t>(edge.from());
        corner_[base + 1] = static_cast<uint8_t>(edge.to());
        corner_[base + 2] = apex;
        twin_[base] = static_cast<uint16_t>(edge.twin());
        twin_[edge.twin()] = static_cast<uint16_t>(base);
        twin_[base + 1] = static_cast<uint16_t>(next + 2);
        twin_[next + 2] = static_cast<uint16_t>(base + 1);
    }
}

bool Polytope::expand(int f, const DifferencePoint& p) {
    if (vertex_count_ == max_vertices) return false;
    find_visible(f, p.y);
    // Rounding can let p lie above faces elsewhere.
    if (!find_outline() && !(keep_connected(f) && find_outline())) return false;
    join_outline(p);
    return true;
}

Simplex Polytope::triangle(int f) const {
    Simplex s;
    s.count = 3;
    for (int i = 0; i < 3; ++i) {
        int v = corner_[4 * f + i];
        s.set(i, {y_[v], a_[v], b_[v]});
    }
    return s;
}

}  // namespace lendulet
