#include <cstdarg>
#include <cstdio>

#include "io/file.h"
#include "io/summary.h"

namespace lendulet {

namespace {

class Page {
public:
    [[gnu::format(printf, 2, 3)]] void line(const char* format, ...) {
        char buffer[512];
        va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(buffer, sizeof buffer, format, arguments);
        va_end(arguments);
        text += buffer;
        text += '\n';
    }
    std::string text;
};

void count_bodies(const RunSummary& s, int& fixed, int& kinematic, int& dynamic, int& asleep) {
    for (const SummaryBody& body : s.bodies) {
        if (body.type == BodyType::fixed) ++fixed;
        else if (body.type == BodyType::kinematic) ++kinematic;
        else ++dynamic;
        asleep += body.asleep;
    }
}

void add_momentum(Page& page, const char* label, const double (&a)[3], const double (&b)[3], const char* unit) {
    page.line("  %-17s (%.6g, %.6g, %.6g) -> (%.6g, %.6g, %.6g) %s", label, a[0], a[1], a[2], b[0], b[1], b[2], unit);
}

}  // namespace

std::string summary_text(const RunSummary& s) {
    int fixed = 0, kinematic = 0, dynamic = 0, asleep = 0;
    count_bodies(s, fixed, kinematic, dynamic, asleep);
    Page page;
    page.line("%s: %lld steps of %.6g s, %d thread%s, width %d, %s", printable(s.scene).c_str(),
              static_cast<long long>(s.steps), s.dt, s.threads, s.threads == 1 ? "" : "s", s.width,
              s.broad_phase.c_str());
    page.line("  bodies            %d static, %d kinematic, %d dynamic (%d asleep)", fixed, kinematic, dynamic, asleep);
    page.line("  contacts          %d points between %d pairs", s.contacts, s.colliding_pairs);
    double simulated = static_cast<double>(s.steps) * s.dt;
    page.line("  ms per step       median %.4f, p99 %.4f", s.times.median, s.times.p99);
    for (const auto& [name, median] : s.times.stage_medians) page.line("    %-15s %.4f", name.c_str(), median);
    if (s.wall_seconds > 0.0) page.line("  real-time factor  %.4g", simulated / s.wall_seconds);
    page.line("  energy            %.6g -> %.6g J", s.energy_start, s.energy_end);
    add_momentum(page, "momentum", s.momentum_start.linear, s.momentum_end.linear, "kg m/s");
    add_momentum(page, "angular momentum", s.momentum_start.angular, s.momentum_end.angular, "kg m^2/s");
    page.line("  deepest overlap   %.4g m", s.max_penetration);
    for (const TriggerEvent& e : s.triggers) {
        page.line("  trigger           %s met %s at %.4g s", printable(e.trigger).c_str(), printable(e.other).c_str(),
                  e.first_time);
    }
    page.line("  state hash        %016llx", static_cast<unsigned long long>(s.hash));
    return page.text;
}

}  // namespace lendulet
