// Charts of measured times as SVG, both axes logarithmic.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lendulet::bench {

enum class Stroke { solid, dashed, dotted };

struct Curve {
    std::string name;
    Stroke stroke = Stroke::solid;
    std::vector<std::pair<double, double>> points;  // both coordinates > 0, x ascending
};

struct Panel {
    std::string title;
    std::vector<Curve> curves;  // a name has the same colour in every panel
};

// Panels side by side, two in a row, each with the names at the ends of its curves and ticks at powers of ten: counts
// along x, times in ns along y. Always on a white ground, so that it can be read in dark pages too.
std::string chart_svg(const std::string& title, const std::vector<Panel>& panels);

// "12 ns", "3.4 µs", "56 ms", "7.8 s": three digits.
std::string time_text(double ns);
// "10", "1000", "10 000".
std::string count_text(long n);

}  // namespace lendulet::bench
