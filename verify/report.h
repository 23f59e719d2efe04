// A report as text, JSON, a page and a picture.
#pragma once

#include <string>

#include "verify/verify.h"

namespace lendulet::verify {

// A table for the terminal, worst figures of each case, and a line with the sums.
std::string report_text(const Report& report);
// An array with one object for each row, see docs/json.md. Figures that are not finite are null; cases that are not run
// are listed with "pass": null.
std::string report_json(const Report& report, Quality quality);
// One self-contained page: the table, and the curves.
std::string report_html(const Report& report, Quality quality);
// All curves in one picture, two in a row, measured points on exact lines.
std::string curves_svg(const Report& report);

}  // namespace lendulet::verify
