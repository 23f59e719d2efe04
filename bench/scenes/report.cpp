#include "bench/scenes/report.h"

#include <cstdio>

namespace lendulet::bench {
namespace {

constexpr double mm = 1e3;  // metres to millimetres

}  // namespace

void print_table_head() {
    std::printf("%-24s %-9s %2s %6s | %9s %9s %9s %7s | %8s | %s\n", "scene", "engine", "T", "bodies", "median ms",
                "p99 ms", "first ms", "ratio", "contacts",
                "overlap mean/p99/max mm; joint gap mean/max mm; sideways, top sinks mm; speed m/s");
}

void print_table_rows(const std::vector<RunResult>& results) {
    for (const RunResult& r : results) {
        double ratio = results.front().median_ms > 0.0 ? r.median_ms / results.front().median_ms : 0.0;
        std::printf("%-24s %-9s %2d %6d | %9.4f %9.4f %9.4f %7.2f | %8d | %.2f/%.1f/%.1f; %.2f/%.1f; %.1f, %.1f; %.3g",
                    r.scene.c_str(), r.engine.c_str(), r.threads, r.bodies, r.median_ms, r.p99_ms, r.first_ms, ratio,
                    r.contacts, mm * r.penetration.mean, mm * r.penetration.p99, mm * r.penetration.max,
                    mm * r.joints.mean, mm * r.joints.max, mm * r.drift.sideways, mm * r.drift.last_sinks,
                    r.drift.mean_speed);
        if (r.drift.not_finite > 0) std::printf("; %d bodies not finite", r.drift.not_finite);
        std::printf(r.stands ? "\n" : "; does not stand\n");
    }
    std::fflush(stdout);
}

std::string scenes_csv(const std::vector<RunResult>& results) {
    std::string out =
        "engine,scene,threads,bodies,median_ms,p99_ms,first_ms,mean_ms,contacts,pen_mean_mm,pen_p99_mm,pen_max_mm,"
        "joint_error_mean_mm,joint_error_max_mm,top_error_mm,drift_mm,stands,hash\n";
    for (const RunResult& r : results) {
        char line[512];
        std::snprintf(line, sizeof line,
                      "%s,%s,%d,%d,%.5f,%.5f,%.5f,%.5f,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%s,%016llx\n",
                      r.engine.c_str(), r.scene.c_str(), r.threads, r.bodies, r.median_ms, r.p99_ms, r.first_ms,
                      r.mean_ms, r.contacts, mm * r.penetration.mean, mm * r.penetration.p99, mm * r.penetration.max,
                      mm * r.joints.mean, mm * r.joints.max, mm * r.drift.last_sinks, mm * r.drift.sideways,
                      r.stands ? "true" : "false", static_cast<unsigned long long>(r.hash));
        out += line;
    }
    return out;
}

}  // namespace lendulet::bench
