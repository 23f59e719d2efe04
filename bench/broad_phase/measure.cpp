#include "bench/broad_phase/measure.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lendulet::bench {
namespace {

constexpr double longest_frame_s = 10.0;
// A subject gives samples until all have been taken or it has cost this much, but at least three; slow ones give one.
constexpr double budget_s = 1.0, slow_s = 1.0;
constexpr double longest_untimed_ns = 2e8;
constexpr double longest_cold_ns = 1e6;  // of a first frame that may tell little of the others

double now_s() { return 1e-9 * thread_ns(); }

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string seconds_text(double s) {
    char text[32];
    std::snprintf(text, sizeof text, s < 100.0 ? "%.2g s" : "%.0f s", s);
    return text;
}

}  // namespace

// Compares what subjects find with what the first of a round found.
class Bench::Agreement {
public:
    Agreement(const Cell& cell, std::vector<std::string>& different) : cell_(cell), different_(different) {}
    void begin() { first_.reset(); }
    void compare(const std::string& name, const Frames::Found& found) {
        if (!first_) {
            first_ = found;
            first_name_ = name;
        } else if (!(found == *first_)) {
            std::string other = found.count == first_->count ? " other ones, " : " ";
            different_.push_back(name_of(cell_) + ": " + name + " finds" + other + std::to_string(found.count) +
                                 ", where " + first_name_ + " finds " + std::to_string(first_->count));
        }
    }

private:
    const Cell& cell_;
    std::vector<std::string>& different_;
    std::optional<Frames::Found> first_;
    std::string first_name_;
};

struct Bench::Entrant {
    const SubjectType* type;
    std::unique_ptr<Subject> subject;
    int frames = 1;
    double frame_ns = 0.0;  // about
    std::vector<double> samples;
    double cost_s = 0.0;
    bool done = false;
};

void Bench::remember(const SubjectType& type, const Cell& cell, double seconds) {
    seconds_[{type.name, {cell.distribution, cell.mode}}][cell.n] = seconds;
}

// Along the power of N that the last two counts show, at least linear, or quadratic where there is one alone.
double Bench::expected_seconds(const SubjectType& type, const Cell& cell) {
    if (cell.n <= 1000) return 0.0;
    Cell smaller{cell.distribution, cell.n / 10, cell.mode};
    std::map<int, double>& known = seconds_[{type.name, {cell.distribution, cell.mode}}];
    if (!known.contains(smaller.n)) {
        double expected = expected_seconds(type, smaller);
        if (expected > longest_frame_s) return 100.0 * expected;
        Frames frames(smaller);
        std::unique_ptr<Subject> subject = type.make();
        double start = now_s();
        frames.prepare(*subject);
        double prepared = now_s() - start;
        remember(type, smaller, prepared + 1e-9 * frames.run(*subject, 1));
    }
    auto last = known.find(smaller.n);
    double power = 2.0, times = static_cast<double>(cell.n) / last->first;
    if (last != known.begin()) {
        auto before = std::prev(last);
        power = std::log(last->second / before->second) / std::log(static_cast<double>(last->first) / before->first);
    }
    return last->second * std::pow(times, std::clamp(power, 1.0, 2.2));
}

CellResult Bench::measure(const Cell& cell) {
    CellResult result{cell, {}, {}, {}};
    std::vector<Entrant> entrants = enter(cell, result);
    if (entrants.empty()) return result;
    Frames frames(cell);
    Agreement agreement(cell, result.different);
    warm_up(entrants, frames, agreement, result);
    for (int round = 0; round < repeats_ && result.different.empty(); ++round) {
        frames.next_sample();
        agreement.begin();
        for (Entrant& e : entrants) {
            if (e.done) continue;
            double start = now_s();
            e.samples.push_back(frames.run(*e.subject, e.frames, e.frame_ns < longest_untimed_ns));
            e.cost_s += now_s() - start;
            if (e.cost_s > budget_s && e.samples.size() >= 3) e.done = true;
            agreement.compare(e.type->name, frames.found());
        }
    }
    for (size_t i = 0; i < entrants.size(); ++i) {
        if (!entrants[i].samples.empty()) result.rows[i].median_ns = median(entrants[i].samples);
    }
    return result;
}

// All subjects but those whose frames would take too long.
std::vector<Bench::Entrant> Bench::enter(const Cell& cell, CellResult& result) {
    std::vector<Entrant> entrants;
    for (const SubjectType& type : types_) {
        double expected = expected_seconds(type, cell);
        if (expected > longest_frame_s) {
            // What is so far beyond was not told from smaller counts but guessed.
            std::string time = expected > 100.0 * longest_frame_s ? "far more than " + seconds_text(longest_frame_s)
                                                                  : "about " + seconds_text(expected);
            result.skipped.push_back(type.name + " is left out: it would take " + time);
        } else {
            entrants.push_back({&type, type.make(), 1, 0.0, {}, 0.0, false});
        }
    }
    return entrants;
}

// The first frame of every subject is compared and says how many frames make a sample; of the slow it is the sample.
void Bench::warm_up(std::vector<Entrant>& entrants, Frames& frames, Agreement& agreement, CellResult& result) {
    agreement.begin();
    for (Entrant& e : entrants) {
        double start = now_s();
        frames.prepare(*e.subject);
        double prepared = now_s() - start, frame_ns = frames.run(*e.subject, 1);
        remember(*e.type, result.cell, prepared + 1e-9 * frame_ns);
        Frames::Found found = frames.found();
        agreement.compare(e.type->name, found);
        result.rows.push_back({e.type->name, result.cell, frame_ns, std::lround(found.per_frame)});
        e.done = frame_ns > 1e9 * slow_s;
        // A first frame finds nothing in the caches: of ten boxes it takes twenty times as long as those after it. What
        // moves from frame to frame cannot be had twice, and has always as many.
        const bool repeatable = result.cell.mode != Mode::refit;
        if (repeatable && frame_ns < longest_cold_ns) frame_ns = frames.run(*e.subject, frames.frames_for(frame_ns));
        e.frames = frames.frames_for(frame_ns);
        e.frame_ns = frame_ns;
        if (e.done) e.samples.push_back(frame_ns);
    }
}

}  // namespace lendulet::bench
