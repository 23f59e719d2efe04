#include "explain/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/markup.h"

namespace lendulet::explain {
namespace {

constexpr double panel = 250.0, gap = 10.0, head = 44.0, title_height = 40.0;  // px
constexpr double step_width = 2.0 * panel + 3.0 * gap, step_height = head + panel + gap;

struct Point {
    double x, y, depth;
};

// Along the third of the sequence's axes, or from the right and above.
struct View {
    const Sequence& sequence;
    bool oblique;
    double scale = 1.0;
    Point centre{0.0, 0.0, 0.0};

    Point turned(Vec p) const {
        if (!oblique) return {p.x, p.y, p.z};
        constexpr double ca = 0.838671, sa = 0.544639, cb = 0.906308, sb = 0.422618;  // 33 and 25 degrees
        double x = ca * p.x - sa * p.z, z = sa * p.x + ca * p.z;
        return {x, cb * p.y - sb * z, sb * p.y + cb * z};
    }
    Point project(Vec p, const Vec& from) const {
        const auto& axes = sequence.axes;
        p = p - from;
        return turned({dot(p, axes[1]), dot(p, axes[2]), dot(p, axes[3])});
    }
    double depth(Vec direction) const { return project(direction, {}).depth; }
    Point at(Vec p) const {
        Point q = project(p, sequence.axes[0]);
        return {0.5 * panel + scale * (q.x - centre.x), 0.5 * panel - scale * (q.y - centre.y), q.depth};
    }
    std::vector<Point> all(const std::vector<Vec>& points) const {
        std::vector<Point> out;
        for (const Vec& p : points) out.push_back(at(p));
        return out;
    }
    void fit() {
        double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
        auto take = [&](const std::vector<Vec>& points) {
            for (const Vec& p : points) {
                Point q = project(p, sequence.axes[0]);
                low[0] = std::min(low[0], q.x), high[0] = std::max(high[0], q.x);
                low[1] = std::min(low[1], q.y), high[1] = std::max(high[1], q.y);
            }
        };
        for (const Step& step : sequence.steps)
            for (const Mark& mark : step.marks)
                take(mark.solid < 0 ? mark.points : sequence.solids[static_cast<size_t>(mark.solid)].corners);
        centre = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.0};
        scale = 0.86 * panel / std::max({high[0] - low[0], high[1] - low[1], 1e-9});
    }
};

// Of each ink.
struct Colours {
    const char *line, *fill, *faint_line, *faint_fill;
};
constexpr Colours colours[] = {
    {"#000", "#000", "#000", "#000"},              // origin
    {"#8a8a8a", "#e4e4e4", "#8a8a8a", "#e4e4e4"},  // difference
    {"#2060c0", "#9db8e8", "#b8c8e8", "#e8eef8"},  // a
    {"#208040", "#a8d8b0", "#b8d8c0", "#e8f6ea"},  // b
    {"#d07000", "#f0b050", "#d07000", "#f0b050"},  // step
    {"#c02020", "#c02020", "#c02020", "#c02020"},  // found
};

struct Style {
    std::string line, fill;
    double width, opacity;

    explicit Style(const Mark& m) : width(m.width), opacity(m.opacity) {
        const Colours& c = colours[static_cast<size_t>(m.ink)];
        line = m.faint ? c.faint_line : c.line;
        if (m.kind == Mark::Kind::solid || m.kind == Mark::Kind::face) fill = m.faint ? c.faint_fill : c.fill;
    }
};

std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", x);
    return text;
}
std::string attribute(const char* name, const std::string& value) {
    return value.empty() ? std::string() : std::string(" ") + name + "='" + value + "'";
}

std::string polygon(const std::vector<Point>& points, const Style& m, bool closed) {
    std::string out = closed ? "<polygon points='" : "<polyline points='";
    for (const Point& p : points) out += number(p.x) + "," + number(p.y) + " ";
    out += "'" + attribute("fill", m.fill.empty() ? "none" : m.fill) + attribute("fill-opacity", number(m.opacity));
    return out + attribute("stroke", m.line) + attribute("stroke-width", number(m.width)) +
           " stroke-linejoin='round'/>";
}

// Corners of the outline of points in the plane, counter-clockwise (Andrew's monotone chain).
std::vector<Point> outline(std::vector<Point> points) {
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Point> hull;
    auto turn = [](const Point& a, const Point& b, const Point& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    for (int pass = 0; pass < 2; ++pass) {
        size_t base = hull.size();
        for (const Point& p : points) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

// Edges in front between faces of different slope, over the outline.
std::string ridges(const Solid& solid, Style thin, const View& view) {
    const std::vector<Vec>& corners = solid.corners;
    const std::vector<uint32_t>& t = solid.triangles;
    struct Edge {
        uint32_t from, to;
        Vec normal;
        bool front;
    };
    std::vector<Edge> edges;
    for (size_t i = 0; i < t.size(); i += 3) {
        Vec n = cross(corners[t[i + 1]] - corners[t[i]], corners[t[i + 2]] - corners[t[i]]);
        n = (1.0 / std::max(std::sqrt(dot(n, n)), 1e-300)) * n;
        bool front = view.depth(n) > 0.0;
        for (size_t k = 0; k < 3; ++k) edges.push_back({t[i + k], t[i + (k + 1) % 3], n, front});
    }
    const double same = solid.curved ? 0.8 : 0.99;
    thin.fill.clear(), thin.width = 0.6;
    std::string out;
    for (const Edge& e : edges)
        for (const Edge& other : edges) {
            if (other.from != e.to || other.to != e.from || e.from > e.to || !(e.front || other.front)) continue;
            if (dot(e.normal, other.normal) > same) continue;
            out += polygon({view.at(corners[e.from]), view.at(corners[e.to])}, thin, false);
        }
    return out;
}

std::string drawn(const Mark& m, const View& view) {
    const Style style(m);
    const std::vector<Point> points = view.all(m.points);
    std::string out;
    switch (m.kind) {
        case Mark::Kind::solid: {
            const Solid& solid = view.sequence.solids[static_cast<size_t>(m.solid)];
            return polygon(outline(view.all(solid.corners)), style, true) + ridges(solid, style, view);
        }
        case Mark::Kind::face:
            out = polygon(points, style, true);
            break;
        case Mark::Kind::path:
            out = polygon(points, style, false);
            break;
        case Mark::Kind::dot:
            out = "<circle cx='" + number(points[0].x) + "' cy='" + number(points[0].y) + "' r='" + number(m.width) +
                  "' fill='" + style.line + "'/>";
            break;
        case Mark::Kind::arrow: {
            out = polygon(points, style, false);
            double dx = points[1].x - points[0].x, dy = points[1].y - points[0].y, size = std::hypot(dx, dy);
            if (!(size > 4.0)) break;
            dx *= 7.0 / size, dy *= 7.0 / size;
            Style tip = style;
            tip.fill = tip.line;
            const Point& end = points[1];
            out += polygon({end,
                            {end.x - dx - 0.4 * dy, end.y - dy + 0.4 * dx, 0.0},
                            {end.x - dx + 0.4 * dy, end.y - dy - 0.4 * dx, 0.0}},
                           tip, true);
            break;
        }
    }
    if (!m.label.empty())
        out += "<text x='" + number(points.back().x + 6.0) + "' y='" + number(points.back().y - 5.0) + "'>" +
               escaped(m.label) + "</text>";
    return out;
}

std::string drawn(const Step& step, const View (&views)[2], double x, double y) {
    std::string out = "<g transform='translate(" + number(x) + " " + number(y) + ")'>\n";
    out += "<text x='" + number(gap) + "' y='16' font-weight='bold'>" + escaped(step.title) + "</text>";
    out += "<text x='" + number(gap) + "' y='33'>" + escaped(step.note) + "</text>\n";
    for (int v = 0; v < 2; ++v) {
        out += "<svg x='" + number(gap + v * (panel + gap)) + "' y='" + number(head) + "' width='" + number(panel) +
               "' height='" + number(panel) + "'><rect width='100%' height='100%' fill='#fbfbfb' stroke='#ccc'/>";
        for (const Mark& m : step.marks) out += drawn(m, views[v]);
        out += "</svg>\n";
    }
    return out + "</g>\n";
}

std::string document(const std::string& title, const std::vector<Step>& steps, size_t first, size_t count,
                     const View (&views)[2]) {
    const size_t columns = count > 1 ? 2 : 1, rows = (count + columns - 1) / columns;
    const double width = static_cast<double>(columns) * step_width,
                 height = title_height + static_cast<double>(rows) * step_height;
    std::string out = "<svg xmlns='http://www.w3.org/2000/svg' width='" + number(width) + "' height='" +
                      number(height) + "' viewBox='0 0 " + number(width) + " " + number(height) +
                      "' font-family='sans-serif' font-size='12' fill='#222'>\n<rect width='100%' height='100%' "
                      "fill='white'/>\n<text x='10' y='26' font-size='16'>" +
                      escaped(title) + "</text>\n";
    for (size_t i = 0; i < count; ++i)
        out += drawn(steps[first + i], views, static_cast<double>(i % columns) * step_width,
                     title_height + static_cast<double>(i / columns) * step_height);
    return out + "</svg>\n";
}

}  // namespace

std::vector<std::string> documents(const std::string& title, const Sequence& sequence, bool frames) {
    View views[2] = {{sequence, false}, {sequence, true}};
    for (View& v : views) v.fit();
    std::vector<std::string> out;
    const std::vector<Step>& steps = sequence.steps;
    if (!frames) return {document(title, steps, 0, steps.size(), views)};
    for (size_t i = 0; i < steps.size(); ++i) out.push_back(document(title, steps, i, 1, views));
    return out;
}

}  // namespace lendulet::explain
