#include <cmath>
#include <nlohmann/json.hpp>

#include "verify/report.h"

namespace lendulet::verify {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string report_json(const Report& report, Quality quality) {
    Json rows = Json::array();
    for (const Row& row : report.rows)
        rows.push_back({{"case", row.case_id},
                        {"quality", name_of(row.quality)},
                        {"quantity", row.quantity},
                        {"measured", number(row.measured)},
                        {"exact", number(row.exact)},
                        {"error", number(row.error)},
                        {"tolerance", number(row.tolerance)},
                        {"pass", row.pass}});
    for (const Missing& missing : report.missing)
        rows.push_back({{"case", missing.case_id},
                        {"quality", name_of(quality)},
                        {"quantity", "not run, needs " + missing.reason},
                        {"measured", nullptr},
                        {"exact", nullptr},
                        {"error", nullptr},
                        {"tolerance", nullptr},
                        {"pass", nullptr}});
    return rows.dump(1) + '\n';
}

}  // namespace lendulet::verify
