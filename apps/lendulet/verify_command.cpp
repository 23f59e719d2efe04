// `lendulet verify`: the physics cases, measured against what mechanics says.
#include <cstdio>

#include "apps/lendulet/commands.h"
#include "bench/lists.h"
#include "io/file.h"
#include "verify/report.h"

namespace lendulet::cli {

int verify(const VerifyOptions& options) {
    for (const std::string* file : {&options.json, &options.html, &options.svg}) {
        if (file->empty() || *file == "-") continue;
        Status writable = check_writable(*file);
        if (!writable.ok()) return fail(writable.error().message);
    }
    Result<verify::Report> measured = verify::run(options.run);
    if (!measured.ok()) return fail(printable(measured.error().message));
    const verify::Report& report = measured.value();
    const verify::Quality quality = options.run.quality;
    std::string out = options.json == "-" ? verify::report_json(report, quality) : verify::report_text(report);
    Status written;
    if (!options.json.empty() && options.json != "-")
        written = write_file(options.json, verify::report_json(report, quality));
    if (written.ok() && !options.html.empty()) written = write_file(options.html, verify::report_html(report, quality));
    if (written.ok() && !options.svg.empty()) written = write_file(options.svg, verify::curves_svg(report));
    if (!written.ok()) return fail(written.error().message);
    std::fwrite(out.data(), 1, out.size(), stdout);
    if (std::fflush(stdout) != 0) return fail("standard output: cannot be written");
    return report.failed() ? 1 : 0;
}

}  // namespace lendulet::cli
