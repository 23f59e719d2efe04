// Boxes in space drawn as SVG: a parallel projection seen from above and one side.
#pragma once

#include <string>

#include "broad_phase/box.h"

namespace lendulet::bench {

struct Dot {
    double x, y;  // pixels, y down
};

struct Projection {
    double scale;                            // pixels a metre
    Dot origin;                              // where the world's origin stands
    double azimuth = 0.6, elevation = 0.42;  // rad

    Dot place(double x, double y, double z) const;
};

// The twelve edges; those hidden behind the box thinner, where the box is drawn as solid.
std::string wire_box(const Projection& view, const float lower[3], const float upper[3], const char* style);
// The three faces that are seen.
std::string solid_box(const Projection& view, const float lower[3], const float upper[3], const char* style);
std::string text_at(Dot at, const std::string& text, const char* style = "");
// `body` on a white ground of this size, in pixels.
std::string picture(double width, double height, const std::string& body);

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace lendulet::bench
