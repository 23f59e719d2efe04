// The four sequences.
#include "explain/explain.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "collision/narrow_phase.h"
#include "collision/trace.h"
#include "explain/picture.h"
#include "io/file.h"

namespace lendulet::explain {
namespace {

constexpr const char *grey = "#8a8a8a", *blue = "#2060c0", *orange = "#d07000", *red = "#c02020", *green = "#208040";

struct Pair {
    Geometry a, b;
    Transform b_in_a;
};

std::string text(const char* format, double x, double y = 0.0) {
    char out[96];
    std::snprintf(out, sizeof out, format, x, y);
    return out;
}

// Directions spread over a ball, with those along the axes.
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

// Points of a core that span it, swept by its rounding, in the frame given.
std::vector<Vec> points_of(const Geometry& g, const Transform& t) {
    std::vector<Vec> out;
    auto add = [&](Vec3d p) { out.push_back(to_double(t * to_float(p))); };
    if (g.kind == GeometryKind::box && g.rounding == 0.0f) {
        for (int i = 0; i < 8; ++i)
            add({i & 1 ? g.size.x : -g.size.x, i & 2 ? g.size.y : -g.size.y, i & 4 ? g.size.z : -g.size.z});
    } else if (g.kind == GeometryKind::hull && g.rounding == 0.0f) {
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

Step shapes_step(const Pair& p, const ConvexDistance& d) {
    Step step{"the shapes", "A, B and their nearest points", {}};
    if (d.distance < 0.0f) step.note = "A, B and the ends of the shortest way out";
    step.marks = {solid(points_of(p.a, {}), blue, "#9db8e8", 0.5),
                  solid(points_of(p.b, p.b_in_a), green, "#a8d8b0", 0.5),
                  path({wide(d.point_a), wide(d.point_b)}, red, 1.6), dot(wide(d.point_a), blue, "A"),
                  dot(wide(d.point_b), green, "B")};
    return step;
}

Step difference_step(const Pair& p, std::string title, std::string note) {
    return {
        std::move(title), std::move(note), {solid(difference_of(p), grey, "#e4e4e4", 0.6), dot(Vec{}, "#000", "O")}};
}

std::vector<Step> gjk_steps(const Pair& p, const ConvexDistance& d, const Recorder& r) {
    std::vector<Step> steps{shapes_step(p, d)};
    int number = 0;
    for (const Recorder::SimplexStep& s : r.simplices) {
        Step step = difference_step(p, "simplex " + std::to_string(++number),
                                    std::to_string(s.points.size()) + (s.points.size() == 1 ? " point" : " points") +
                                        text("; O is %.6g m from them", length(s.nearest)));
        if (s.points.size() == 4 || length(s.nearest) < 1e-12)
            step.note = std::to_string(s.points.size()) + " points hold O: the cores overlap";
        for (size_t i = 0; i < s.points.size(); ++i)
            for (size_t k = 0; k < i; ++k) step.marks.push_back(path({s.points[k], s.points[i]}, orange, 1.4));
        if (s.points.size() == 3)
            step.marks.push_back(face({s.points[0], s.points[1], s.points[2]}, orange, "#f0b050", 0.5));
        for (const Vec& y : s.points) step.marks.push_back(dot(y, orange));
        if (s.points.size() < 4) step.marks.push_back(arrow({}, s.nearest, blue, "v"));
        if (s.has_support) step.marks.push_back(dot(s.support, red, "next"));
        steps.push_back(std::move(step));
    }
    return steps;
}

std::vector<Step> epa_steps(const Pair& p, const ConvexDistance& d, const Recorder& r) {
    std::vector<Step> steps{shapes_step(p, d)};
    int number = 0;
    for (const Recorder::PolytopeStep& s : r.polytopes) {
        const auto& near = s.faces[static_cast<size_t>(s.nearest)];
        Vec3d n = cross(near[1] - near[0], near[2] - near[0]);
        n = (1.0 / length(n)) * n;
        const double least = dot(n, near[0]), most = dot(n, s.support);
        Step step = difference_step(
            p, "polytope " + std::to_string(++number) + ": " + std::to_string(s.faces.size()) + " faces",
            text("the depth is between %.6g and %.6g m", least, most));
        for (const auto& f : s.faces) step.marks.push_back(path({f[0], f[1], f[2], f[0]}, orange, 0.9));
        step.marks.push_back(face({near[0], near[1], near[2]}, orange, "#f0b050", 0.6, 1.6));
        step.marks.push_back(arrow({}, least * n, blue));
        step.marks.push_back(dot(s.support, red, "next"));
        steps.push_back(std::move(step));
    }
    return steps;
}

// Which shape's face is the reference, and the clipping of the other's.
Result<std::vector<Step>> clip_steps(const Pair& p, const ConvexDistance& d) {
    Face a = best_face(p.a, d.normal), b = best_face(p.b, rotate_inverse(p.b_in_a.rotation, -d.normal));
    transform_face(p.b_in_a, b);
    const bool from_b = b.count >= 3 && (a.count < 3 || -dot(b.normal, d.normal) > dot(a.normal, d.normal));
    const Face &reference = from_b ? b : a, &incident = from_b ? a : b;
    if (reference.count < 3 || incident.count < 2)
        return Error{ErrorCode::bad_query, "explain clip: the shapes do not meet with a face and a face or an edge"};
    Recorder recorder;
    ClippedFace clipped;
    clip_face(reference, incident, from_b, 1e9f, clipped, recorder);
    if (recorder.clips.empty())
        return Error{ErrorCode::bad_query, "explain clip: the faces that look at each other do not overlap"};
    auto lifted = [&](const std::vector<Vec3>& polygon) {
        std::vector<Vec> out;
        for (Vec3 c : polygon)
            out.push_back(wide(clipped.origin + c.x * clipped.u + c.y * clipped.v + c.z * clipped.normal));
        return out;
    };
    std::vector<Step> steps{shapes_step(p, d)};
    const std::vector<Vec> frame = lifted(recorder.reference);
    for (const Recorder::ClipStep& c : recorder.clips) {
        Step step{c.side < 0 ? "the faces" : "side " + std::to_string(c.side + 1),
                  std::to_string(c.polygon.size()) + " corners of the incident face",
                  {}};
        step.marks = {solid(points_of(p.a, {}), "#b8c8e8", "#e8eef8", 0.4),
                      solid(points_of(p.b, p.b_in_a), "#b8d8c0", "#e8f6ea", 0.4), face(frame, blue, "#9db8e8", 0.4),
                      face(lifted(c.polygon), orange, "#f0b050", 0.6, 1.6)};
        if (c.side >= 0) {
            auto k = static_cast<size_t>(c.side);
            step.marks.push_back(path({frame[k], frame[(k + 1) % frame.size()]}, red, 2.6));
        }
        for (const Vec& corner : lifted(c.polygon)) step.marks.push_back(dot(corner, orange));
        steps.push_back(std::move(step));
    }
    FacePoint kept[max_clipped_points];
    for (int i = 0; i < clipped.count; ++i) kept[i] = clipped.points[i];
    const int count = reduce_points(kept, clipped.count);
    Step last = steps.back();
    last.title = "the manifold";
    last.note = std::to_string(count) + " points are kept";
    for (int i = 0; i < count; ++i)
        last.marks.push_back(dot(wide(clipped.point(kept[i], kept[i].separation)), red, std::to_string(i + 1)));
    steps.push_back(std::move(last));
    // Seen from above the reference face: its axes are the picture's.
    for (Step& step : steps)
        for (Mark& mark : step.marks)
            for (Vec& q : mark.points) {
                const Vec from = q - wide(clipped.origin);
                q = {dot(from, wide(clipped.u)), dot(from, wide(clipped.v)), dot(from, wide(clipped.normal))};
            }
    return steps;
}

// Both shapes' shadows on an axis through the origin of A.
Step sat_step(const Pair& p, const std::string& name, Vec3 axis, float separation, bool chosen) {
    Step step{name + (chosen ? ": the axis of the contact" : ""), text("separation %.6g m", separation), {}};
    step.marks = {solid(points_of(p.a, {}), blue, "#9db8e8", 0.4),
                  solid(points_of(p.b, p.b_in_a), green, "#a8d8b0", 0.4)};
    const Vec n = wide(axis);
    auto shadow = [&](const std::vector<Vec>& points, double beside, const char* colour) {
        double low = 1e300, high = -1e300;
        for (const Vec& q : points) low = std::min(low, dot(n, q)), high = std::max(high, dot(n, q));
        const Vec off = beside * wide(perpendicular(axis));
        step.marks.push_back(path({low * n + off, high * n + off}, colour, chosen ? 4.5 : 3.0));
    };
    shadow(points_of(p.a, {}), 0.03, blue);
    shadow(points_of(p.b, p.b_in_a), -0.03, green);
    return step;
}

Result<std::vector<Step>> sat_steps(const Pair& p, const ConvexDistance& d) {
    if (!is_sharp_box(p.a) || !is_sharp_box(p.b))
        return Error{ErrorCode::bad_query, "explain sat: both shapes must be boxes"};
    const Vec3 units[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    struct Axis {
        std::string name;
        Vec3 n;
    };
    std::vector<Axis> axes;
    const char* letters[3] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) axes.push_back({std::string("face ") + letters[i] + " of A", units[i]});
    for (int k = 0; k < 3; ++k)
        axes.push_back({std::string("face ") + letters[k] + " of B", rotate(p.b_in_a.rotation, units[k])});
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            Vec3 n = cross(units[i], rotate(p.b_in_a.rotation, units[k]));
            if (length(n) > 1e-3f)
                axes.push_back({std::string("edge ") + letters[i] + " of A, " + letters[k] + " of B", normalize(n)});
        }
    PairCache cache;
    Manifold m;
    const int found = collide({&p.a, &p.b, {}, p.b_in_a.rotation, p.b_in_a.translation, 1e3f}, cache, {}, &m, 1);
    std::vector<Step> steps{shapes_step(p, d)};
    for (const Axis& axis : axes) {
        const Vec3 n = dot(axis.n, p.b_in_a.translation) < 0.0f ? -axis.n : axis.n;
        const Vec3 in_b = rotate_inverse(p.b_in_a.rotation, -n);
        float separation =
            dot(n, p.b_in_a.translation) - dot(in_b, support_core(p.b, in_b)) - dot(n, support_core(p.a, n));
        steps.push_back(sat_step(p, axis.name, n, separation, found == 1 && absolute(dot(n, m.normal)) > 0.99999f));
    }
    return steps;
}

}  // namespace

Result<std::vector<std::string>> draw(const Options& o) {
    Result<Placed> a = read_shape(o.a), b = read_shape(o.b);
    if (!a) return a.error();
    if (!b) return b.error();
    Result<SimplexSolver> solver = simplex_from_name(o.simplex);
    if (!solver) return solver.error();
    Result<Geometry> ga = make_geometry(a.value().shape), gb = make_geometry(b.value().shape);
    if (!ga) return ga.error();
    if (!gb) return gb.error();
    const Pair pair{ga.value(), gb.value(), inverse(a.value().place) * b.value().place};
    Recorder recorder;
    GjkCache cold;
    const ConvexDistance d = distance({&pair.a, &pair.b, pair.b_in_a}, cold, solver.value(), 1e30f, recorder);
    std::vector<Step> steps;
    if (o.what == "gjk") {
        steps = gjk_steps(pair, d, recorder);
    } else if (o.what == "epa") {
        if (recorder.polytopes.empty())
            return Error{ErrorCode::bad_query, "explain epa: the cores of the shapes do not overlap"};
        steps = epa_steps(pair, d, recorder);
    } else if (o.what == "clip" || o.what == "sat") {
        Result<std::vector<Step>> made = o.what == "clip" ? clip_steps(pair, d) : sat_steps(pair, d);
        if (!made) return made.error();
        steps = std::move(made).value();
    } else {
        return Error{ErrorCode::unknown_name,
                     "explain: there is no \"" + printable(o.what) + "\"; there are gjk, epa, clip, sat"};
    }
    return documents(o.what + ": " + o.a + " and " + o.b, steps, o.frames);
}

Result<int> explain(const Options& o) {
    Result<std::vector<std::string>> drawn = draw(o);
    if (!drawn) return drawn.error();
    const std::string name = o.svg.empty() ? "explain-" + o.what + ".svg" : o.svg;
    const size_t dot = name.rfind(".svg");
    const std::string stem = dot == std::string::npos ? name : name.substr(0, dot);
    for (size_t i = 0; i < drawn.value().size(); ++i) {
        const std::string file = o.frames ? stem + "-" + std::to_string(i + 1) + ".svg" : name;
        if (Status written = write_file(file, drawn.value()[i]); !written) return written.error();
        std::printf("%s\n", file.c_str());
    }
    return 0;
}

}  // namespace lendulet::explain
