#include "bench/scenes/report.h"

#include <cstdio>
#include <string_view>

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
        std::printf("\n");
    }
    std::fflush(stdout);
}

void print_stages(const RunResult& result) {
    double sum = 0.0;
    for (double ms : result.stage_ms) sum += ms;
    std::printf("  stages of %s, %d thread(s), medians:\n", result.scene.c_str(), result.threads);
    for (int s = 0; s < static_cast<int>(Stage::count); ++s) {
        std::string stage(name_of(static_cast<Stage>(s)));
        double share = sum > 0.0 ? 100.0 * result.stage_ms[s] / sum : 0.0;
        std::printf("    %-14s %9.4f ms %5.1f %%\n", stage.c_str(), result.stage_ms[s], share);
    }
    std::fflush(stdout);
}

bool write_csv(const std::string& path, const std::vector<RunResult>& results) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) {
        std::fprintf(stderr, "%s cannot be written.\n", path.c_str());
        return false;
    }
    std::fprintf(
        file,
        "engine,scene,threads,bodies,median_ms,p99_ms,first_ms,mean_ms,contacts,pen_mean_mm,pen_p99_mm,pen_max_mm,"
        "pen_pairs,joint_mean_mm,joint_max_mm,sideways_mm,top_sinks_mm,mean_speed,not_finite,build_ms\n");
    for (const RunResult& r : results)
        std::fprintf(file, "%s,%s,%d,%d,%.5f,%.5f,%.5f,%.5f,%d,%.4f,%.4f,%.4f,%d,%.4f,%.4f,%.4f,%.4f,%.6g,%d,%.3f\n",
                     r.engine.c_str(), r.scene.c_str(), r.threads, r.bodies, r.median_ms, r.p99_ms, r.first_ms,
                     r.mean_ms, r.contacts, mm * r.penetration.mean, mm * r.penetration.p99, mm * r.penetration.max,
                     r.penetration.pairs, mm * r.joints.mean, mm * r.joints.max, mm * r.drift.sideways,
                     mm * r.drift.last_sinks, r.drift.mean_speed, r.drift.not_finite, r.build_ms);
    return std::fclose(file) == 0;
}

}  // namespace lendulet::bench
