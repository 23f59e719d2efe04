#include "collision/epa_polytope.h"

namespace lendulet {
namespace {

// Squared sine below which the corners of a face count as collinear: its normal would be rounding.
constexpr double collinear = 1e-18;
constexpr uint8_t none = 255;

constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }

}  // namespace

void Polytope::set_face(int f, int i, int j, int k) {
    Face& face = faces_[f];
    face.vertex[0] = static_cast<uint8_t>(i);
    face.vertex[1] = static_cast<uint8_t>(j);
    face.vertex[2] = static_cast<uint8_t>(k);
    is_visible_[f] = false;
    Vec3d e1 = y_[j] - y_[i], e2 = y_[k] - y_[i], n = cross(e1, e2);
    double nn = dot(n, n);
    if (nn > collinear * dot(e1, e1) * dot(e2, e2)) {
        face.n = (1.0 / square_root(nn)) * n;
        distance_[f] = dot(face.n, y_[i]);
    } else {
        face.n = {};
        distance_[f] = far;
    }
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
    for (int i = 0; i < 4; ++i) {
        add_vertex(s.point(i));
        edge_from_[i] = none;
    }
    // Face m is the one opposite to vertex m, wound so that m lies below it.
    bool positive = dot(cross(s.y[1] - s.y[0], s.y[2] - s.y[0]), s.y[3] - s.y[0]) > 0.0;
    static constexpr uint8_t corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int m = 0; m < 4; ++m) {
        int i = corners[m][0], j = corners[m][positive ? 1 : 2], k = corners[m][positive ? 2 : 1];
        set_face(m, i, j, k);
        // The neighbour across an edge is the face opposite to the remaining corner.
        faces_[m].neighbour[0] = static_cast<uint8_t>(k);
        faces_[m].neighbour[1] = static_cast<uint8_t>(i);
        faces_[m].neighbour[2] = static_cast<uint8_t>(j);
    }
}

int Polytope::nearest_face() const {
    int best = 0;
    for (int f = 1; f < face_end_; ++f)
        if (distance_[f] < distance_[best]) best = f;
    return best;
}

bool Polytope::holds(Vec3d y) const {
    for (int i = 0; i < vertex_count_; ++i)
        if (y_[i].x == y.x && y_[i].y == y.y && y_[i].z == y.z) return true;
    return false;
}

// The faces that y lies above, connected to f; faces coplanar with y go too, so that none without area arise.
int Polytope::collect_visible(int f, Vec3d y) {
    int count = 0;
    visible_[count++] = static_cast<uint8_t>(f);
    is_visible_[f] = true;
    for (int i = 0; i < count; ++i)
        for (uint8_t g : faces_[visible_[i]].neighbour) {
            if (is_visible_[g]) continue;
            const Vec3d& n = faces_[g].n;
            // A retired face keeps its normal but not its distance; any of its corners gives the height above it.
            if (dot(n, y - y_[faces_[g].vertex[0]]) < -tolerance_) continue;
            is_visible_[g] = true;
            visible_[count++] = g;
        }
    return count;
}

int Polytope::collect_outline(int visible_count) {
    int count = 0;
    for (int i = 0; i < visible_count; ++i) {
        const Face& face = faces_[visible_[i]];
        for (int e = 0; e < 3; ++e)
            if (!is_visible_[face.neighbour[e]])
                outline_[count++] = {face.vertex[e], face.vertex[next_corner(e)], face.neighbour[e]};
    }
    return count;
}

bool Polytope::is_one_loop(int edge_count) {
    bool simple = edge_count >= 3;
    for (int e = 0; e < edge_count; ++e) {
        simple = simple && edge_from_[outline_[e].from] == none;
        edge_from_[outline_[e].from] = static_cast<uint8_t>(e);
    }
    int length = 0;
    if (simple)
        for (int e = 0; e != none && length <= edge_count;) {
            e = edge_from_[outline_[e].to];
            ++length;
            if (e == 0) break;
        }
    for (int e = 0; e < edge_count; ++e) edge_from_[outline_[e].from] = none;
    return simple && length == edge_count;
}

bool Polytope::expand(int f, const DifferencePoint& p) {
    int visible_count = collect_visible(f, p.y);
    int edge_count = collect_outline(visible_count);
    if (!is_one_loop(edge_count) || vertex_count_ == max_vertices) {
        for (int i = 0; i < visible_count; ++i) is_visible_[visible_[i]] = false;
        return false;
    }
    for (int i = 0; i < visible_count; ++i) {
        distance_[visible_[i]] = far;
        free_[free_count_++] = visible_[i];
    }
    int apex = add_vertex(p);
    edge_from_[apex] = none;
    uint8_t face_from[max_vertices], face_to[max_vertices];
    for (int e = 0; e < edge_count; ++e) {
        const Edge& edge = outline_[e];
        int g = free_count_ > 0 ? free_[--free_count_] : face_end_++;
        set_face(g, edge.from, edge.to, apex);
        faces_[g].neighbour[0] = edge.outer;
        Face& outer = faces_[edge.outer];
        for (int i = 0; i < 3; ++i)
            if (outer.vertex[i] == edge.to) outer.neighbour[i] = static_cast<uint8_t>(g);
        face_from[edge.from] = face_to[edge.to] = static_cast<uint8_t>(g);
    }
    for (int e = 0; e < edge_count; ++e) {
        Face& face = faces_[face_from[outline_[e].from]];
        face.neighbour[1] = face_from[outline_[e].to];
        face.neighbour[2] = face_to[outline_[e].from];
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
