// The table of cases, and running them on all cores: every case in every place is a task of its own.
#include <algorithm>
#include <atomic>
#include <thread>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

struct Case {
    CaseInfo info;
    CaseFunction function = nullptr;
};

constexpr Case table[] = {
    {{"A01", "free fall", ""}, free_fall},
    {{"A02", "order of convergence", ""}, convergence_order},
    {{"A03", "symmetric top", ""}, symmetric_top},
    {{"A04", "turning about the middle axis", ""}, dzhanibekov},
    {{"A06", "heavy top", ""}, heavy_top},
    {{"A07", "gas and burst without gravity", ""}, gas_and_burst},
    {{"A08", "heights of bounces", ""}, bounce_heights},
    {{"A09", "49 bouncing balls", ""}, bouncing_balls},
    {{"A10", "elastic cube of balls", ""}, elastic_cube_of_balls},
    {{"A11", "dead cube of balls", ""}, dead_cube_of_balls},
    {{"A12", "Newton's cradle", ""}, cradle},
    {{"A13", "oblique impact, sliding", ""}, oblique_sliding},
    {{"A14", "oblique impact, gripping", ""}, oblique_gripping},
    {{"A15", "superball", ""}, superball},
    {{"A17", "threshold of slipping", ""}, stick_slip_threshold},
    {{"A18", "sliding and stopping", ""}, sliding_and_stopping},
    {{"A19", "static and kinetic friction", ""}, static_and_kinetic},
    {{"A20", "isotropy of friction", ""}, isotropy},
    {{"A21", "sliding turns into rolling", ""}, slide_to_roll},
    {{"A22", "rolling down a slope", ""}, rolling_down},
    {{"A23", "balls on a pulled box", ""}, rolling_carrier},
    {{"A24", "threshold of tipping", ""}, tipping},
    {{"A26", "dominoes", ""}, dominoes},
    {{"A27", "hanging chain", ""}, hanging_chain},
    {{"A28", "chain with a heavy load", ""}, payload_chain},
    {{"A29", "stacks of unequal masses", ""}, mass_ratio_stacks},
    {{"A32", "tall stacks and a pyramid", ""}, tall_stacks},
    {{"A33", "recovery from overlap", ""}, penetration_recovery},
    {{"A34", "rolling friction and the angle of repose", ""}, angle_of_repose},
    {{"A35", "hourglass", "tens of thousands of balls for minutes, longer than this should take"}},
    {{"A36", "pendulum", ""}, pendulum},
    {{"A38", "closed loops", ""}, closed_loops},
    {{"A39", "spring, mass and damper", ""}, spring_mass_damper},
    {{"A40", "bullets against walls", ""}, bullets_against_walls},
    {{"A41", "spinning rods beside walls", ""}, spinning_rods},
};

const Case* find(std::string_view id) {
    for (const Case& entry : table)
        if (entry.info.id == id) return &entry;
    return nullptr;
}

// The cases that were asked for, in the order of the table.
Result<std::vector<const Case*>> chosen(const std::vector<std::string>& ids) {
    for (const std::string& id : ids) {
        if (find(id)) continue;
        std::string names;
        for (const Case& entry : table) names += (names.empty() ? "" : ", ") + std::string(entry.info.id);
        return Error{ErrorCode::unknown_name, "there is no case \"" + id + "\"; there are " + names};
    }
    std::vector<const Case*> cases;
    for (const Case& entry : table)
        if (ids.empty() || std::find(ids.begin(), ids.end(), entry.info.id) != ids.end()) cases.push_back(&entry);
    return cases;
}

// Runs task(i) for i in [0, count) on threads.
template <class Task>
void run_on_threads(int count, int workers, Task&& task) {
    if (workers <= 0) workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::atomic<int> next{0};
    auto work = [&] {
        for (int i = next++; i < count; i = next++) task(i);
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < std::min(workers, count); ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

void collect(const Case& entry, Quality quality, std::vector<Figures>& places, Report& report) {
    Figures& all = places.front();
    for (size_t i = 1; i < places.size(); ++i)
        for (const Quantity& quantity : places[i].quantities)
            for (Quantity& mine : all.quantities)
                if (mine.name() == quantity.name()) mine.merge(quantity);
    for (const Quantity& quantity : all.quantities) report.rows.push_back(quantity.row(entry.info.id, quality));
    for (Curve& curve : all.curves) {
        curve.case_id = entry.info.id;
        report.curves.push_back(std::move(curve));
    }
}

}  // namespace

std::string_view name_of(Quality quality) { return quality == Quality::hq ? "hq" : "d60"; }

Result<Quality> quality_from_name(std::string_view name) {
    for (Quality quality : {Quality::d60, Quality::hq})
        if (name == name_of(quality)) return quality;
    return Error{ErrorCode::unknown_name, "there is no quality \"" + std::string(name) + "\"; there are d60 and hq"};
}

int Report::failed() const {
    return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.pass; }));
}

std::vector<CaseInfo> all_cases() {
    std::vector<CaseInfo> cases;
    for (const Case& entry : table) cases.push_back(entry.info);
    return cases;
}

std::string_view title_of(std::string_view case_id) {
    const Case* entry = find(case_id);
    return entry ? entry->info.title : std::string_view();
}

Result<Report> run(const Options& options) {
    Result<std::vector<const Case*>> found = chosen(options.cases);
    if (!found.ok()) return found.error();
    Report report;
    std::vector<const Case*> cases;
    for (const Case* entry : found.value()) {
        if (entry->function) cases.push_back(entry);
        else
            report.missing.push_back(
                {std::string(entry->info.id), std::string(entry->info.title), std::string(entry->info.lacking)});
    }
    const int frames = std::clamp(options.frames, 1, 5);
    const std::array<Frame, 5> places = random_frames();
    std::vector<std::vector<Figures>> figures(cases.size());
    for (std::vector<Figures>& one : figures) one.resize(static_cast<size_t>(frames));
    run_on_threads(static_cast<int>(cases.size()) * frames, options.workers, [&](int i) {
        size_t which = static_cast<size_t>(i / frames), place = static_cast<size_t>(i % frames);
        Setting setting{options.quality, places[place], options.scale};
        cases[which]->function(setting, figures[which][place]);
    });
    for (size_t i = 0; i < cases.size(); ++i) collect(*cases[i], options.quality, figures[i], report);
    return report;
}

}  // namespace lendulet::verify
