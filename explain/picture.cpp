#include "explain/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/markup.h"
#include "lendulet/shapes.h"

namespace lendulet::explain {
namespace {

constexpr double panel = 250.0, gap = 10.0, head = 44.0, title_height = 40.0;  // px
constexpr double step_width = 2.0 * panel + 3.0 * gap, step_height = head + panel + gap;

struct Point {
    double x, y, depth;
};

// Along z, or from the right and above.
struct View {
    bool oblique;
    double scale = 1.0;
    Point centre{0.0, 0.0, 0.0};

    Point project(Vec p) const {
        if (!oblique) return {p.x, p.y, p.z};
        constexpr double ca = 0.838671, sa = 0.544639, cb = 0.906308, sb = 0.422618;  // 33 and 25 degrees
        double x = ca * p.x - sa * p.z, z = sa * p.x + ca * p.z;
        return {x, cb * p.y - sb * z, sb * p.y + cb * z};
    }
    Point at(Vec p) const {
        Point q = project(p);
        return {0.5 * panel + scale * (q.x - centre.x), 0.5 * panel - scale * (q.y - centre.y), q.depth};
    }
    void fit(const std::vector<Step>& steps) {
        double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
        for (const Step& step : steps)
            for (const Mark& mark : step.marks)
                for (const Vec& p : mark.points) {
                    Point q = project(p);
                    low[0] = std::min(low[0], q.x), high[0] = std::max(high[0], q.x);
                    low[1] = std::min(low[1], q.y), high[1] = std::max(high[1], q.y);
                }
        centre = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.0};
        scale = 0.86 * panel / std::max({high[0] - low[0], high[1] - low[1], 1e-9});
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

std::string polygon(const std::vector<Point>& points, const Mark& m, bool closed) {
    std::string out = closed ? "<polygon points='" : "<polyline points='";
    for (const Point& p : points) out += number(p.x) + "," + number(p.y) + " ";
    out += "'" + attribute("fill", m.fill.empty() ? "none" : m.fill) + attribute("fill-opacity", number(m.opacity));
    return out + attribute("stroke", m.stroke) + attribute("stroke-width", number(m.width)) +
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
std::string ridges(const Mark& m, const View& view) {
    std::vector<Vec3> points;
    for (const Vec& p : m.points)
        points.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    Result<ConvexHull> built = ConvexHull::from_points(points);
    if (!built) return {};
    const auto corners = built.value().vertices();
    const std::vector<uint32_t> t = built.value().triangles();
    struct Edge {
        uint32_t from, to;
        Vec3 normal;
        bool front;
    };
    std::vector<Edge> edges;
    for (size_t i = 0; i < t.size(); i += 3) {
        Vec3 n = normalize(cross(corners[t[i + 1]] - corners[t[i]], corners[t[i + 2]] - corners[t[i]]));
        bool front = view.project(wide(n)).depth > 0.0;
        for (size_t k = 0; k < 3; ++k) edges.push_back({t[i + k], t[i + (k + 1) % 3], n, front});
    }
    const float same = points.size() > 300 ? 0.8f : 0.99f;  // round ones are given by many points
    Mark thin = m;
    thin.fill.clear(), thin.width = 0.6;
    std::string out;
    for (const Edge& e : edges)
        for (const Edge& other : edges) {
            if (other.from != e.to || other.to != e.from || e.from > e.to || !(e.front || other.front)) continue;
            if (dot(e.normal, other.normal) > same) continue;
            out += polygon({view.at(wide(corners[e.from])), view.at(wide(corners[e.to]))}, thin, false);
        }
    return out;
}

std::string drawn(const Mark& m, const View& view) {
    std::vector<Point> points;
    for (const Vec& p : m.points) points.push_back(view.at(p));
    std::string out;
    switch (m.kind) {
        case Mark::Kind::solid:
            out = polygon(outline(points), m, true) + ridges(m, view);
            break;
        case Mark::Kind::face:
            out = polygon(points, m, true);
            break;
        case Mark::Kind::path:
            out = polygon(points, m, false);
            break;
        case Mark::Kind::dot:
            out = "<circle cx='" + number(points[0].x) + "' cy='" + number(points[0].y) + "' r='" + number(m.width) +
                  "' fill='" + m.fill + "'/>";
            break;
        case Mark::Kind::arrow: {
            out = polygon(points, m, false);
            double dx = points[1].x - points[0].x, dy = points[1].y - points[0].y, size = std::hypot(dx, dy);
            if (!(size > 4.0)) break;
            dx *= 7.0 / size, dy *= 7.0 / size;
            Mark tip = m;
            tip.fill = m.stroke;
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

std::vector<std::string> documents(const std::string& title, const std::vector<Step>& steps, bool frames) {
    View views[2] = {{false}, {true}};
    for (View& v : views) v.fit(steps);
    std::vector<std::string> out;
    if (!frames) return {document(title, steps, 0, steps.size(), views)};
    for (size_t i = 0; i < steps.size(); ++i) out.push_back(document(title, steps, i, 1, views));
    return out;
}

}  // namespace lendulet::explain
