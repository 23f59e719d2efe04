#include "explain/pair.h"

#include <cmath>
#include <cstdio>

namespace lendulet::explain {
namespace {

// Directions spread over a ball.
std::vector<Vec3d> directions() {
    std::vector<Vec3d> out;
    constexpr int count = 500;
    for (int i = 0; i < count; ++i) {
        float y = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / count;
        SinCos a = sin_cos(2.3999632f * static_cast<float>(i));
        float r = std::sqrt(1.0f - y * y);
        out.push_back(to_double(Vec3{r * a.cos, y, r * a.sin}));
    }
    return out;
}

bool has_corners(const Geometry& g) {
    return g.rounding == 0.0f && (g.kind == GeometryKind::box || g.kind == GeometryKind::hull);
}

// Points of a core that span it, swept by its rounding, in the frame given.
std::vector<Vec> points_of(const Geometry& g, const Transform& t) {
    std::vector<Vec> out;
    auto add = [&](Vec3d p) { out.push_back(to_double(t * to_float(p))); };
    if (has_corners(g) && g.kind == GeometryKind::box) {
        for (int i = 0; i < 8; ++i)
            add({i & 1 ? g.size.x : -g.size.x, i & 2 ? g.size.y : -g.size.y, i & 4 ? g.size.z : -g.size.z});
    } else if (has_corners(g)) {
        for (Vec3 v : g.hull->vertices) add(to_double(v));
    } else {
        for (const Vec3d& d : directions()) add(support_point(g, d) + static_cast<double>(g.rounding) * d);
    }
    return out;
}

// The Minkowski difference of the cores.
std::vector<Vec> difference_of(const Pair& p) {
    Geometry a = p.a, b = p.b;
    a.rounding = b.rounding = 0.0f;
    std::vector<Vec> out;
    if (is_curved(a) || is_curved(b)) {
        const CoreDifference difference({&a, &b, p.b_in_a});
        for (const Vec3d& d : directions()) out.push_back(difference.support(d).y);
        return out;
    }
    auto corners = [](const Geometry& g, const Transform& t) {
        if (g.kind == GeometryKind::point) return std::vector<Vec>{to_double(t.translation)};
        if (g.kind == GeometryKind::segment)
            return std::vector<Vec>{to_double(t * Vec3{0.0f, g.size.y, 0.0f}),
                                    to_double(t * Vec3{0.0f, -g.size.y, 0.0f})};
        return points_of(g, t);
    };
    for (const Vec& y : corners(b, p.b_in_a))
        for (const Vec& x : corners(a, {})) out.push_back(y - x);
    return out;
}

Solid hull_of(const std::vector<Vec>& points, bool curved) {
    std::vector<Vec3> narrow;
    for (const Vec& p : points) narrow.push_back(to_float(p));
    Result<ConvexHull> built = ConvexHull::from_points(narrow);
    if (!built) return {points, {}, curved};
    Solid out{{}, built.value().triangles(), curved};
    for (Vec3 v : built.value().vertices()) out.corners.push_back(wide(v));
    return out;
}

}  // namespace

std::string text(const char* format, double x, double y) {
    char out[96];
    std::snprintf(out, sizeof out, format, x, y);
    return out;
}

std::vector<Solid> solids_of(const Pair& p) {
    return {hull_of(points_of(p.a, {}), !has_corners(p.a)), hull_of(points_of(p.b, p.b_in_a), !has_corners(p.b)),
            hull_of(difference_of(p), is_curved(p.a) || is_curved(p.b))};
}

Step shapes_step(const ConvexDistance& d) {
    Step step{"the shapes", text("A, B and their nearest points, %.6g m apart", d.distance), {}};
    if (d.distance < 0.0f)
        step.note = text("A, B and the ends of the shortest way out, %.6g m", -static_cast<double>(d.distance));
    step.marks = {solid(0, Ink::a, 0.5), solid(1, Ink::b, 0.5),
                  path({wide(d.point_a), wide(d.point_b)}, Ink::found, 1.6), dot(wide(d.point_a), Ink::a, "A"),
                  dot(wide(d.point_b), Ink::b, "B")};
    return step;
}

Step difference_step(std::string title, std::string note) {
    return {std::move(title),
            std::move(note),
            {solid(difference_solid, Ink::difference, 0.6), dot(Vec{}, Ink::origin, "O")}};
}

}  // namespace lendulet::explain
