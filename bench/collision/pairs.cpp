// Random pairs, placed at a wanted distance, and their exact distance or depth.
//
// Apart, the truth is certified: the engine's own nearest points bound the distance from above, the gap between the
// supports along its normal bounds it from below, both computed here in double from the corners. Overlapping, it is the
// least overlap over all directions that can be the shortest way out: normals of faces, and of edges crossed.
#include "bench/collision/pairs.h"

#include <cmath>

#include "collision/gjk.h"
#include "scenes/random.h"

namespace lendulet::bench {
namespace {

using Vec = Vec3T<double>;
using scenes::Random;

Vec wide(Vec3 v) { return {v.x, v.y, v.z}; }
double norm(Vec v) { return std::sqrt(dot(v, v)); }

Vec turned(Quat q, Vec3 v) {
    const double x = q.x, y = q.y, z = q.z, w = q.w, s = 2.0 / (x * x + y * y + z * z + w * w);
    const Vec u{x, y, z}, p = wide(v), t = s * cross(u, p);
    return p + w * t + cross(u, t);
}

// Corners, and directions of faces and edges, in the frame of A.
struct Solid {
    std::vector<Vec> corners, normals, edges;
};

void add_direction(std::vector<Vec>& list, Vec d) {
    double size = norm(d);
    if (!(size > 1e-12)) return;
    d = (1.0 / size) * d;
    for (const Vec& known : list)
        if (std::abs(dot(known, d)) > 1.0 - 1e-14) return;
    list.push_back(d);
}

Solid solid_of(const Shape& shape, const Transform& t) {
    Solid s;
    auto place = [&](Vec3 p) { return turned(t.rotation, p) + wide(t.translation); };
    if (const auto* box = std::get_if<Box>(&shape)) {
        const Vec3 h = box->half_extents;
        for (int i = 0; i < 8; ++i)
            s.corners.push_back(place({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z}));
        for (Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) s.normals.push_back(turned(t.rotation, axis));
        s.edges = s.normals;
        return s;
    }
    const auto& hull = std::get<ConvexHull>(shape);
    for (Vec3 v : hull.vertices()) s.corners.push_back(place(v));
    const std::vector<uint32_t> triangles = hull.triangles();
    for (size_t i = 0; i < triangles.size(); i += 3) {
        const Vec a = s.corners[triangles[i]], b = s.corners[triangles[i + 1]], c = s.corners[triangles[i + 2]];
        s.normals.push_back(cross(b - a, c - a));
        for (Vec edge : {b - a, c - b, a - c}) add_direction(s.edges, edge);
    }
    return s;
}

double reach(const Solid& s, Vec d) {
    double most = -1e300;
    for (const Vec& p : s.corners) most = std::max(most, dot(p, d));
    return most;
}
// Separation of B from A along a direction.
double separation(const Solid& a, const Solid& b, Vec d) { return -reach(b, -d) - reach(a, d); }

double depth(const Solid& a, const Solid& b) {
    double best = -1e300;
    auto try_axis = [&](Vec d) {
        double size = norm(d);
        if (!(size > 1e-9)) return;
        d = (1.0 / size) * d;
        best = std::max(best, std::max(separation(a, b, d), separation(a, b, -d)));
    };
    for (const Solid* s : {&a, &b})
        for (const Vec& n : s->normals) try_axis(n);
    for (const Vec& e : a.edges)
        for (const Vec& f : b.edges) try_axis(cross(e, f));
    return best;
}

Geometry geometry_of(const Shape& shape) { return make_geometry(shape).value(); }

// Moves B along the normal until the shapes are `wanted` apart: that stays the separation along it, so apart it is the
// distance, and overlapping a bound of the depth.
Transform placed(const Shape& a, const Shape& b, Transform t, float wanted) {
    const Geometry ga = geometry_of(a), gb = geometry_of(b);
    GjkCache cold;
    ConvexDistance d = distance({&ga, &gb, t}, cold, SimplexSolver::barycentric, 1e30f);
    t.translation -= (d.distance - wanted) * d.normal;
    return t;
}

struct Regime {
    const char* name;
    float low, high;  // m
};
constexpr Regime regimes[] = {{"far", 0.1f, 2.0f},
                              {"near", 1e-4f, 1e-2f},
                              {"touch", 0.0f, 0.0f},
                              {"overlap", -0.05f, -1e-3f},
                              {"deep", -0.5f, -0.1f}};

Shape random_box(Random& random) {
    float x = random.range(0.25f, 1.0f), y = random.range(0.25f, 1.0f), z = random.range(0.25f, 1.0f);
    return Box{{x, y, z}};
}
Shape random_hull(Random& random) {
    std::vector<Vec3> points;
    while (points.size() < 32) {
        Vec3 v{random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f)};
        float square = dot(v, v);
        if (square > 0.01f && square < 1.0f) points.push_back(normalize(v));
    }
    return ConvexHull::from_points(points).value();
}

template <class Make>
PairSet make_set(const char* kind, const Regime& regime, int count, Make&& make) {
    PairSet set{std::string(kind) + " " + regime.name, regime.high < 0.0f, {}};
    Random random;
    for (int i = 0; i < count; ++i) {
        ConvexCase c{make(random), make(random), {}, {}, 0.0, 0.0};
        Vec3 away{random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f)};
        Transform t{8.0f * normalize(away + Vec3{1e-3f, 0.0f, 0.0f}), random.rotation()};
        float share = random.range(0.0f, 1.0f);
        float wanted = regime.low > 0.0f ? regime.low * std::pow(regime.high / regime.low, share)
                                         : regime.low + share * (regime.high - regime.low);
        c.b_in_a = placed(c.a, c.b, t, wanted);
        c.moved = c.b_in_a;
        c.moved.translation += 1e-3f * normalize(Vec3{random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f), 0.3f});
        c.moved.rotation =
            normalize(rotation_about({0.3f, 0.5f, -0.8f}, random.range(-1e-3f, 1e-3f)) * c.moved.rotation);
        c.truth = truth_of(c.a, c.b, c.b_in_a);
        c.truth_moved = truth_of(c.a, c.b, c.moved);
        set.cases.push_back(std::move(c));
    }
    return set;
}

}  // namespace

double truth_of(const Shape& a, const Shape& b, const Transform& t) {
    const Solid sa = solid_of(a, {}), sb = solid_of(b, t);
    const Geometry ga = geometry_of(a), gb = geometry_of(b);
    GjkCache cold;
    ConvexDistance d = distance({&ga, &gb, t}, cold, SimplexSolver::barycentric, 1e30f);
    if (d.distance <= 1e-6f) return depth(sa, sb);
    Vec n = wide(d.normal);
    return separation(sa, sb, (1.0 / norm(n)) * n);
}

std::vector<PairSet> make_pair_sets(int pairs) {
    std::vector<PairSet> sets;
    for (const Regime& regime : regimes) sets.push_back(make_set("box-box", regime, pairs, random_box));
    const int hulls = pairs / 5 > 16 ? pairs / 5 : 16;
    std::vector<Shape> stock;
    auto from_stock = [&](Random& random) {
        while (stock.size() < 64) stock.push_back(random_hull(random));
        return stock[random.next() % stock.size()];
    };
    for (int i : {0, 4}) sets.push_back(make_set("hull32", regimes[i], i == 0 ? hulls : (hulls + 3) / 4, from_stock));
    return sets;
}

}  // namespace lendulet::bench
