#include "bench/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "io/markup.h"

namespace lendulet::bench {
namespace {

constexpr double panel_width = 620, panel_height = 470, left = 64, right = 150, top = 44, bottom = 44;
constexpr double label_height = 13.0;
// Dark enough for white ground and apart for most eyes; names beyond the list begin again.
constexpr const char* colours[] = {"#1f4e9c", "#c0392b", "#1e8449", "#8e44ad", "#b9770e", "#117a8b", "#d81b60",
                                   "#5d4037", "#455a64", "#7cb342", "#f4511e", "#3949ab", "#00897b", "#6d4c41"};

std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

// From values to places on a logarithmic axis; whole powers of ten at both ends.
struct Axis {
    int first = 0, last = 1;  // powers of ten
    double from = 0.0, to = 1.0;

    double place(double value) const { return from + (to - from) * (std::log10(value) - first) / (last - first); }
    void take_in(double value, bool& any) {
        int low = static_cast<int>(std::floor(std::log10(value) + 1e-9));
        int high = static_cast<int>(std::ceil(std::log10(value) - 1e-9));
        first = any ? std::min(first, low) : low;
        last = any ? std::max(last, high) : high;
        any = true;
    }
};

std::string dash_of(Stroke stroke) {
    if (stroke == Stroke::dashed) return " stroke-dasharray=\"7 4\"";
    return stroke == Stroke::dotted ? " stroke-dasharray=\"2 4\"" : "";
}

std::string grid(const Axis& x, const Axis& y) {
    std::string svg;
    for (int p = x.first; p <= x.last; ++p) {
        double at = x.place(std::pow(10.0, p));
        svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"grid\"/>\n", at, y.from, at, y.to);
        svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", at, y.from + 17,
                      count_text(std::lround(std::pow(10.0, p))).c_str());
    }
    for (int p = y.first; p <= y.last; ++p) {
        double at = y.place(std::pow(10.0, p));
        svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"grid\"/>\n", x.from, at, x.to, at);
        svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", x.from - 7, at + 4,
                      time_text(std::pow(10.0, p)).c_str());
    }
    return svg;
}

struct Label {
    const Curve* curve;
    double x, y;  // the curve's end
    double text_y;
};

// Labels in order of height, pushed apart where they would cover each other, kept within [top, low].
void spread_labels(std::vector<Label>& labels, double low) {
    std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
    double next = top;
    for (Label& label : labels) {
        label.text_y = std::max(label.y, next);
        next = label.text_y + label_height;
    }
    for (size_t i = labels.size(); i-- > 0;) {
        labels[i].text_y = std::min(labels[i].text_y, low);
        low = labels[i].text_y - label_height;
    }
}

std::string panel_svg(const Panel& panel, const std::vector<std::string>& names) {
    Axis x, y;
    bool any_x = false, any_y = false;
    for (const Curve& curve : panel.curves) {
        for (auto [px, py] : curve.points) {
            x.take_in(px, any_x);
            y.take_in(py, any_y);
        }
    }
    if (x.last == x.first) ++x.last;
    if (y.last == y.first) ++y.last;
    x.from = left, x.to = panel_width - right, y.from = panel_height - bottom, y.to = top;
    std::string svg = grid(x, y);
    svg += format("<text x=\"%.1f\" y=\"26\" class=\"title\">%s</text>\n", left, escaped(panel.title).c_str());
    std::vector<Label> labels;
    auto colour = [&](const Curve& curve) {
        size_t i = static_cast<size_t>(std::find(names.begin(), names.end(), curve.name) - names.begin());
        return curve.stroke == Stroke::dotted ? "#888888" : colours[i % std::size(colours)];
    };
    for (const Curve& curve : panel.curves) {
        if (curve.points.empty()) continue;
        std::string points;
        for (auto [px, py] : curve.points) {
            points += format("%.1f,%.1f ", x.place(px), y.place(py));
            svg += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.6\" fill=\"%s\"/>\n", x.place(px), y.place(py),
                          colour(curve));
        }
        svg += format("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\"%s points=\"", colour(curve),
                      dash_of(curve.stroke).c_str()) +
               points + "\"/>\n";
        labels.push_back({&curve, x.place(curve.points.back().first), y.place(curve.points.back().second), 0.0});
    }
    spread_labels(labels, y.from);
    for (const Label& label : labels) {
        svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"0.6\"/>\n",
                      label.x + 4, label.y, x.to + 12, label.text_y, colour(*label.curve));
        svg += format("<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", x.to + 15, label.text_y + 4,
                      colour(*label.curve), escaped(label.curve->name).c_str());
    }
    return svg;
}

}  // namespace

std::string time_text(double ns) {
    const char* unit = "ns";
    double value = ns;
    if (ns >= 1e9) value = ns / 1e9, unit = "s";
    else if (ns >= 1e6) value = ns / 1e6, unit = "ms";
    else if (ns >= 1e3) value = ns / 1e3, unit = "µs";
    return format(value >= 99.95 ? "%.0f %s" : "%.3g %s", value, unit);
}

std::string count_text(long n) {
    std::string digits = std::to_string(n), out;
    if (digits.size() < 5) return digits;
    for (size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) out += ' ';
        out += digits[i];
    }
    return out;
}

std::string chart_svg(const std::string& title, const std::vector<Panel>& panels) {
    std::vector<std::string> names;
    for (const Panel& panel : panels) {
        for (const Curve& curve : panel.curves) {
            if (std::find(names.begin(), names.end(), curve.name) == names.end()) names.push_back(curve.name);
        }
    }
    size_t columns = panels.size() > 1 ? 2 : 1, rows = (panels.size() + columns - 1) / columns;
    double width = panel_width * static_cast<double>(columns), height = 40 + panel_height * static_cast<double>(rows);
    std::string svg = format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
        "height=\"%.0f\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"12\">\n",
        width, height, width, height);
    svg += "<style>.grid{stroke:#dddddd;stroke-width:1}.title{font-size:14px;font-weight:bold}</style>\n";
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    svg += "<text x=\"64\" y=\"28\" font-size=\"16\" font-weight=\"bold\">" + escaped(title) + "</text>\n";
    for (size_t i = 0; i < panels.size(); ++i) {
        svg += format("<g transform=\"translate(%.0f %.0f)\">\n", panel_width * static_cast<double>(i % columns),
                      40 + panel_height * static_cast<double>(i / columns));
        svg += panel_svg(panels[i], names) + "</g>\n";
    }
    return svg + "</svg>\n";
}

}  // namespace lendulet::bench
