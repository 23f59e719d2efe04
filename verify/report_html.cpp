#include <cmath>
#include <cstdio>

#include "io/markup.h"
#include "verify/plot.h"
#include "verify/report.h"

namespace lendulet::verify {
namespace {

constexpr const char* style = R"(<style>
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 66em; padding: 0 1em; color: #222; background: white; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: .25em .6em; text-align: left; border-bottom: 1px solid #ddd; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr.fail td { background: #fbe3e0; }
td.pass { color: #18702c; } td.fail { color: #a8200d; font-weight: bold; }
</style>
)";

std::string number_text(double value) {
    if (!std::isfinite(value)) return "not finite";
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string cell(double value) { return "<td class=\"n\">" + number_text(value) + "</td>"; }

std::string table_of(const Report& report) {
    std::string
        out =
            "<table>\n<tr><th>case</th><th>quantity</th><th>measured</th><th>exact</th><th>error</th><th>tolerance</th>"
            "<th></th></tr>\n",
        last;
    for (const Row& row : report.rows) {
        std::string name = row.case_id == last ? "" : row.case_id + " " + std::string(title_of(row.case_id));
        last = row.case_id;
        out += row.pass ? "<tr>" : "<tr class=\"fail\">";
        out += "<td>" + escaped(name) + "</td><td>" + escaped(row.quantity) + "</td>" + cell(row.measured) +
               cell(row.exact) + cell(row.error) + "<td class=\"n\">" + number_text(row.tolerance) +
               (row.relative ? " of it" : "") + "</td>";
        out += row.pass ? "<td class=\"pass\">passes</td></tr>\n" : "<td class=\"fail\">fails</td></tr>\n";
    }
    return out + "</table>\n";
}

}  // namespace

std::string report_html(const Report& report, Quality quality) {
    std::string out =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>Lendület: accuracy</title>\n";
    out += std::string(style) + "</head>\n<body>\n<h1>Lendület: measured against exact</h1>\n<p>";
    out += quality == Quality::hq ? "Quality hq: steps of 1/240 s with the shipping defaults. "
                                  : "Quality d60: steps of 1/60 s with the shipping defaults. ";
    out += "Of every figure the worst of several random places. " + std::to_string(report.rows.size()) + " figures, " +
           std::to_string(report.failed()) + " of them outside their tolerance.</p>\n";
    out += table_of(report);
    if (!report.missing.empty()) {
        out += "<h2>Not run</h2>\n<ul>\n";
        for (const Missing& missing : report.missing)
            out += "<li>" + escaped(missing.case_id + " " + missing.title + ": needs " + missing.reason) + "</li>\n";
        out += "</ul>\n";
    }
    if (!report.curves.empty()) out += "<h2>Curves</h2>\n" + curves_svg(report);
    return out + "</body>\n</html>\n";
}

}  // namespace lendulet::verify
