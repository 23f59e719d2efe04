#include <cstdio>

#include "verify/report.h"

namespace lendulet::verify {

std::string report_text(const Report& report) {
    std::string out, last;
    char line[240];
    for (const Row& row : report.rows) {
        if (row.case_id != last) out += row.case_id + "  " + std::string(title_of(row.case_id)) + '\n';
        last = row.case_id;
        std::snprintf(line, sizeof line, "  %-4s %-64s %12.6g  exact %-11.6g error %-9.3g of %.3g%s\n",
                      row.pass ? "ok" : "FAIL", row.quantity.c_str(), row.measured, row.exact, row.error, row.tolerance,
                      row.relative ? " (relative)" : "");
        out += line;
    }
    for (const Missing& missing : report.missing)
        out += missing.case_id + "  " + missing.title + "\n  not run, needs " + missing.reason + '\n';
    std::snprintf(line, sizeof line, "%zu figures, %d outside their tolerance; %zu cases not run\n", report.rows.size(),
                  report.failed(), report.missing.size());
    return out + line;
}

}  // namespace lendulet::verify
