// Small charts of measured points on exact curves, as SVG.
#pragma once

#include <string>

#include "verify/verify.h"

namespace lendulet::verify {

inline constexpr int plot_width = 420, plot_height = 270;  // pixels

// A group with one chart, its top left corner at (x, y). White ground and dark text, so that it can be read in dark
// pages.
std::string plot_svg(const Curve& curve, int x, int y);

}  // namespace lendulet::verify
