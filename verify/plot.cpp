#include "verify/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/markup.h"
#include "verify/report.h"

namespace lendulet::verify {
namespace {

constexpr int left = 66, right = 14, top = 34, bottom = 44;

struct Range {
    double low = 1e300, high = -1e300;
    void add(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double size() const { return high - low; }
};

// The step between ticks: 1, 2 or 5 times a power of ten, four to ten of them.
double tick_step(const Range& range) {
    double step = std::pow(10.0, std::floor(std::log10(range.size())));
    for (double part : {0.1, 0.2, 0.5, 1.0})
        if (range.size() / (part * step) <= 7.0) return part * step;
    return step;
}

std::string text(const char* format, double a, double b = 0.0, double c = 0.0, double d = 0.0) {
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, format, a, b, c, d);
    return buffer;
}

struct Chart {
    Range x, y;
    explicit Chart(const Curve& curve) {
        for (const Curve::Point& point : curve.points) {
            x.add(point.x);
            y.add(point.measured);
            y.add(point.exact);
        }
        // A constant is shown with a thousandth of itself around it: finer than that is agreement.
        double least = 1e-3 * std::max(std::fabs(y.low), std::fabs(y.high)) + 1e-12;
        double space = std::max(0.06 * y.size(), 0.5 * (least - y.size()));
        y.low -= space;
        y.high += space;
        if (!(x.size() > 0.0)) x.high = x.low + 1.0;
    }
    double px(double value) const { return left + (value - x.low) / x.size() * (plot_width - left - right); }
    double py(double value) const {
        return plot_height - bottom - (value - y.low) / y.size() * (plot_height - top - bottom);
    }

    std::string axes() const {
        std::string out;
        const double floor = plot_height - bottom;
        for (double step = tick_step(x), v = std::ceil(x.low / step) * step; v <= x.high + 1e-9 * step; v += step) {
            out += text("<path d='M%.1f %.1fv4' stroke='#555'/>", px(v), floor);
            out += text("<text x='%.1f' y='%.1f' text-anchor='middle'>%.4g</text>", px(v), floor + 17,
                        std::fabs(v) < 1e-9 * step ? 0.0 : v);
        }
        for (double step = tick_step(y), v = std::ceil(y.low / step) * step; v <= y.high; v += step) {
            out += text("<path d='M%.1f %.1fh%.1f' stroke='#e4e4e4'/>", left, py(v), plot_width - left - right);
            out += text("<text x='%.1f' y='%.1f' text-anchor='end'>%.6g</text>", left - 6, py(v) + 4,
                        std::fabs(v) < 1e-9 * step ? 0.0 : v);
        }
        out += text("<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' fill='none' stroke='#555'/>", left, top,
                    plot_width - left - right, plot_height - top - bottom);
        return out;
    }
};

}  // namespace

std::string plot_svg(const Curve& curve, int x, int y) {
    std::string out =
        text("<g transform='translate(%.0f %.0f)' font-family='sans-serif' font-size='11' fill='#222'>", x, y);
    out += text("<rect width='%.0f' height='%.0f' fill='white'/>", plot_width, plot_height);
    out +=
        text("<text x='%.0f' y='20' font-size='13'>", left) + escaped(curve.case_id + ": " + curve.title) + "</text>";
    if (!curve.points.empty()) {
        Chart chart(curve);
        out += chart.axes();
        out += "<polyline fill='none' stroke='#c05010' stroke-width='1.6' points='";
        for (const Curve::Point& point : curve.points)
            out += text("%.1f,%.1f ", chart.px(point.x), chart.py(point.exact));
        out += "'/>";
        for (const Curve::Point& point : curve.points)
            if (std::isfinite(point.measured))
                out += text("<circle cx='%.1f' cy='%.1f' r='2.6' fill='none' stroke='#1050a0' stroke-width='1.2'/>",
                            chart.px(point.x), chart.py(point.measured));
    }
    out += text("<text x='%.0f' y='%.0f' text-anchor='end'>", plot_width - right, plot_height - 10) +
           escaped(curve.x_label) + "</text>";
    out += text("<text x='%.0f' y='%.0f'>", left, plot_height - 10) + escaped(curve.y_label) +
           ": <tspan fill='#1050a0'>measured</tspan>, <tspan fill='#c05010'>exact</tspan></text></g>\n";
    return out;
}

std::string curves_svg(const Report& report) {
    constexpr int columns = 2, space = 8;
    const int count = static_cast<int>(report.curves.size()), rows = (count + columns - 1) / columns;
    const int width = columns * (plot_width + space), height = std::max(rows, 1) * (plot_height + space);
    std::string out =
        text("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' width='%.0f' height='%.0f'>\n", width,
             height, width, height);
    out += "<rect width='100%' height='100%' fill='white'/>\n";
    for (int i = 0; i < count; ++i)
        out += plot_svg(report.curves[static_cast<size_t>(i)], i % columns * (plot_width + space),
                        i / columns * (plot_height + space));
    return out + "</svg>\n";
}

}  // namespace lendulet::verify
