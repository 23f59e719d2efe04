#include "collision/epa_polytope.h"

namespace lendulet {
namespace {

// Squared sine below which the corners of a face count as collinear: its normal would be rounding.
constexpr double collinear = 1e-18;

constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }

using Two = Wide<double, 2>;

LENDULET_FORCE_INLINE Vec3T<Two> side_by_side(Vec3d a, Vec3d b) {
    return {Two{a.x, b.x}, Two{a.y, b.y}, Two{a.z, b.z}};
}

}  // namespace

inline void Polytope::set_corners(int f, int i, int j, int k) {
    Face& face = faces_[f];
    face.vertex[0] = static_cast<uint8_t>(i);
    face.vertex[1] = static_cast<uint8_t>(j);
    face.vertex[2] = static_cast<uint8_t>(k);
    is_visible_[f] = false;
}

// Planes of two faces with corners i, j, k.
LENDULET_FORCE_INLINE void Polytope::set_planes(const int* faces, Vec3T<Two> i, Vec3T<Two> j, Vec3T<Two> k) {
    const Vec3T<Two> e1 = j - i, e2 = k - i, n = cross(e1, e2);
    const Two nn = dot(n, n), h = dot(n, i), size = h < Two{} ? -h : h;
    const auto plain = nn > collinear * dot(e1, e1) * dot(e2, e2);
    const Two key = plain ? h * size / nn : Two{far, far};
    for (int lane = 0; lane < 2; ++lane) {
        Face& face = faces_[faces[lane]];
        key_[faces[lane]] = key[lane];
        face.n = {n.x[lane], n.y[lane], n.z[lane]};
        face.nn = nn[lane];
        if (!(key_[faces[lane]] < far)) face.n = {};
    }
}

int Polytope::add_vertex(const DifferencePoint& p) {
    y_[vertex_count_] = p.y;
    a_[vertex_count_] = p.a;
    b_[vertex_count_] = p.b;
    last_seen_[vertex_count_] = 0;
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
        int i = corners[m][0], j = corners[m][positive ? 1 : 2], k = corners[m][positive ? 2 : 1];
        set_corners(m, i, j, k);
        // The neighbour across an edge is the face opposite to the remaining corner.
        faces_[m].neighbour[0] = static_cast<uint8_t>(k);
        faces_[m].neighbour[1] = static_cast<uint8_t>(i);
        faces_[m].neighbour[2] = static_cast<uint8_t>(j);
    }
    for (int m = 0; m < 4; m += 2) {
        const uint8_t *one = faces_[m].vertex, *two = faces_[m + 1].vertex;
        const int faces[2] = {m, m + 1};
        set_planes(faces, side_by_side(y_[one[0]], y_[two[0]]), side_by_side(y_[one[1]], y_[two[1]]),
                   side_by_side(y_[one[2]], y_[two[2]]));
    }
}

int Polytope::nearest_face() const {
    int best = 0;
    double least = key_[0];
    for (int f = 1; f < face_end_; ++f)
        if (key_[f] < least) least = key_[f], best = f;
    return best;
}

bool Polytope::holds(Vec3d y) const {
    for (int i = 0; i < vertex_count_; ++i)
        if (y_[i].x == y.x && y_[i].y == y.y && y_[i].z == y.z) return true;
    return false;
}

DifferencePoint Polytope::farthest(Vec3d d) const {
    int best = 0;
    double most = dot(y_[0], d);
    for (int i = 1; i < vertex_count_; ++i) {
        const double m = dot(y_[i], d);
        if (m > most) most = m, best = i;
    }
    return {y_[best], a_[best], b_[best]};
}

// Coplanar counts as above, so that no faces without area arise.
inline bool Polytope::lies_above(Vec3d y, const Face& face) const {
    double h = dot(face.n, y - y_[face.vertex[0]]);
    return h > 0.0 || h * h <= tolerance_ * tolerance_ * face.nn;
}

// Marks f and all faces above which y lies and that are connected to it. Goes round each face counter-clockwise from
// the edge by which it was entered, so the edges of the outline come out in order (Barber, Dobkin, Huhdanpaa 1996).
void Polytope::collect_visible(int f, int entered, Vec3d y) {
    is_visible_[f] = true;
    visible_[visible_count_++] = static_cast<uint8_t>(f);
    int e = entered;
    do {
        const Face& face = faces_[f];
        int g = face.neighbour[e];
        int to = next_corner(e);
        if (!is_visible_[g]) {
            const Face& other = faces_[g];
            int back = other.vertex[0] == face.vertex[to] ? 0 : other.vertex[1] == face.vertex[to] ? 1 : 2;
            if (lies_above(y, other)) collect_visible(g, back, y);
            else
                outline_[edge_count_++] = {face.vertex[e], face.vertex[to], static_cast<uint8_t>(g),
                                           static_cast<uint8_t>(back)};
        }
        e = to;
    } while (e != entered);
}

// A single loop without repeated corners: anything else would tear the surface.
bool Polytope::outline_is_simple() {
    bool simple = edge_count_ >= 3;
    uint8_t end = outline_[edge_count_ - 1].to, stamp = static_cast<uint8_t>(vertex_count_);  // new for each expansion
    for (int i = 0; i < edge_count_; ++i) {
        const Edge& edge = outline_[i];
        simple = simple && edge.from == end && last_seen_[edge.from] != stamp;
        last_seen_[edge.from] = stamp;
        end = edge.to;
    }
    return simple;
}

bool Polytope::expand(int f, const DifferencePoint& p) {
    visible_count_ = edge_count_ = 0;
    collect_visible(f, 0, p.y);
    if (edge_count_ == 0 || !outline_is_simple() || vertex_count_ == max_vertices) {
        for (int i = 0; i < visible_count_; ++i) is_visible_[visible_[i]] = false;
        return false;
    }
    int fresh[max_faces + 1];
    for (int i = 0; i < edge_count_; ++i)
        fresh[i] = i < visible_count_ ? visible_[i] : free_count_ > 0 ? free_[--free_count_] : face_end_++;
    for (int i = edge_count_; i < visible_count_; ++i) {
        key_[visible_[i]] = far;
        free_[free_count_++] = visible_[i];
    }
    int apex = add_vertex(p);
    // Two planes at a time; the last one goes with a repetition that nobody reads where their number is odd.
    fresh[edge_count_] = max_faces;
    outline_[edge_count_] = outline_[0];
    const Vec3T<Two> top = side_by_side(p.y, p.y);
    for (int i = 0; i < edge_count_; i += 2) {
        const Edge &one = outline_[i], &two = outline_[i + 1];
        set_planes(&fresh[i], side_by_side(y_[one.from], y_[two.from]), side_by_side(y_[one.to], y_[two.to]), top);
    }
    for (int i = 0; i < edge_count_; ++i) {
        const Edge& edge = outline_[i];
        set_corners(fresh[i], edge.from, edge.to, apex);
        Face& face = faces_[fresh[i]];
        face.neighbour[0] = edge.outer;
        face.neighbour[1] = static_cast<uint8_t>(fresh[i + 1 < edge_count_ ? i + 1 : 0]);
        face.neighbour[2] = static_cast<uint8_t>(fresh[i > 0 ? i - 1 : edge_count_ - 1]);
        faces_[edge.outer].neighbour[edge.outer_edge] = static_cast<uint8_t>(fresh[i]);
    }
    return true;
}

Simplex Polytope::triangle(int f) const {
    Simplex s;
    s.count = 3;
    for (int i = 0; i < 3; ++i) {
        int v = faces_[f].vertex[i];
        s.set(i, {y_[v], a_[v], b_[v]});
    }
    return s;
}

}  // namespace lendulet
