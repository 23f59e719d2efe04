#include "bench/pictures/projection.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "io/markup.h"

namespace lendulet::bench {

std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

Dot Projection::place(double x, double y, double z) const {
    double right = std::cos(azimuth) * x - std::sin(azimuth) * z;
    double towards = std::sin(azimuth) * x + std::cos(azimuth) * z;
    double up = std::cos(elevation) * y - std::sin(elevation) * towards;
    return {origin.x + scale * right, origin.y - scale * up};
}

namespace {

Dot corner(const Projection& view, const float lower[3], const float upper[3], int i) {
    return view.place(i & 1 ? upper[0] : lower[0], i & 2 ? upper[1] : lower[1], i & 4 ? upper[2] : lower[2]);
}

}  // namespace

std::string wire_box(const Projection& view, const float lower[3], const float upper[3], const char* style) {
    std::string path;
    for (int i = 0; i < 8; ++i) {
        for (int bit : {1, 2, 4}) {
            if (i & bit) continue;
            Dot a = corner(view, lower, upper, i), b = corner(view, lower, upper, i | bit);
            path += format("M%.1f %.1fL%.1f %.1f", a.x, a.y, b.x, b.y);
        }
    }
    return "<path d=\"" + path + "\" fill=\"none\" " + style + "/>\n";
}

// Corners by bits: x 1, y 2, z 4. Seen are the faces of greater x, y and z.
std::string solid_box(const Projection& view, const float lower[3], const float upper[3], const char* style) {
    constexpr int faces[3][4] = {{1, 3, 7, 5}, {2, 3, 7, 6}, {4, 5, 7, 6}};
    std::string path;
    for (const auto& face : faces) {
        for (int k = 0; k < 4; ++k) {
            Dot p = corner(view, lower, upper, face[k]);
            path += format("%c%.1f %.1f", k ? 'L' : 'M', p.x, p.y);
        }
        path += 'Z';
    }
    return "<path d=\"" + path + "\" " + style + "/>\n";
}

std::string text_at(Dot at, const std::string& text, const char* style) {
    return format("<text x=\"%.1f\" y=\"%.1f\" %s>", at.x, at.y, style) + escaped(text) + "</text>\n";
}

std::string picture(double width, double height, const std::string& body) {
    return format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" "
               "font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"14\">\n",
               width, height, width, height) +
           "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" + body + "</svg>\n";
}

}  // namespace lendulet::bench
