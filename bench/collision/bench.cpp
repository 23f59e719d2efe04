#include "bench/collision/bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/collision/pairs.h"
#include "bench/lists.h"
#include "io/file.h"

namespace lendulet::bench {
namespace {

Status check(const CollisionOptions& o) {
    auto in = [](int value, int least, int most) { return value >= least && value <= most; };
    auto bad = [](const char* sentence) { return Error{ErrorCode::bad_config, sentence}; };
    if (!in(o.pairs, 16, 1'000'000)) return bad("--pairs must be 16 to 1000000");
    if (!in(o.rays, 1, 10'000'000)) return bad("--rays must be 1 to 10000000");
    if (!in(o.bodies, 1, 100'000)) return bad("--bodies must be 1 to 100000");
    if (!in(o.repeats, 1, 1000)) return bad("--repeats must be 1 to 1000");
    return check_writable(o.csv);
}

bool is_ours(const PairSubject& s) { return s.routine().rfind("lendulet", 0) == 0; }

CollisionRow judge(const PairSubject& subject, const PairSet& set, const std::vector<double>& answers,
                   const std::vector<double>& times) {
    CollisionRow row{subject.routine(), set.name, median_of(times), 0.0, 0, is_ours(subject)};
    for (size_t i = 0; i < answers.size(); ++i) {
        const double truth = subject.moved() ? set.cases[i].truth_moved : set.cases[i].truth;
        const double error = std::abs(answers[i] - truth);
        if (!(error <= subject.allowed())) ++row.failures;
        else row.worst_error = std::max(row.worst_error, error);
    }
    return row;
}

// All that take the set, by turns.
void measure(const PairSet& set, const PairSubjects& subjects, int repeats, CollisionRows& rows) {
    std::vector<PairSubject*> taking;
    for (const auto& subject : subjects)
        if (subject->takes(set)) subject->load(set), taking.push_back(subject.get());
    std::vector<std::vector<double>> times(taking.size());
    std::vector<std::vector<double>> answers(taking.size(), std::vector<double>(set.cases.size()));
    for (int round = 0; round < repeats; ++round)
        for (size_t s = 0; s < taking.size(); ++s) {
            taking[s]->rewind();
            const double start = computing_time();
            taking[s]->run(answers[s]);
            times[s].push_back((computing_time() - start) / static_cast<double>(set.cases.size()));
        }
    for (size_t s = 0; s < taking.size(); ++s) rows.push_back(judge(*taking[s], set, answers[s], times[s]));
}

std::string error_text(const CollisionRow& row) {
    char text[32];
    if (row.worst_error < 0.0) return "";
    std::snprintf(text, sizeof text, "%.1e", row.worst_error);
    return text;
}

void print(const CollisionRows& rows, size_t from) {
    for (size_t i = from; i < rows.size(); ++i) {
        const CollisionRow& r = rows[i];
        std::printf("%-24s %-36s %10.1f %9s %9ld\n", r.name.c_str(), r.routine.c_str(), r.median_ns,
                    error_text(r).c_str(), r.failures);
    }
    std::fflush(stdout);
}

std::string csv_of(const CollisionRows& rows) {
    std::string out = "routine,case,median_ns,worst_error,failures\n";
    for (const CollisionRow& r : rows) {
        std::string routine = r.routine, name = r.name;
        for (std::string* text : {&routine, &name}) std::replace(text->begin(), text->end(), ',', ';');
        char numbers[64];
        std::snprintf(numbers, sizeof numbers, "%.2f,%s,%ld\n", r.median_ns, error_text(r).c_str(), r.failures);
        out += routine + "," + name + "," + numbers;
    }
    return out;
}

}  // namespace

double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

Result<int> bench_collision(const CollisionOptions& options) {
    if (Status s = check(options); !s) return s.error();
    if (!missing_collision_peers().empty())
        std::printf("Measured without %s, which the build did not find.\n", joined(missing_collision_peers()).c_str());
    std::printf("%-24s %-36s %10s %9s %9s\n", "case", "routine", "ns", "error, m", "failures");
    PairSubjects subjects;
    add_own_subjects(subjects);
    add_bullet_subjects(subjects);
    add_ccd_subjects(subjects);
    add_fcl_subjects(subjects);
    CollisionRows rows;
    std::vector<PairSet> sets = make_pair_sets(options.pairs);
    sets.push_back(make_pile_set(std::max(options.pairs / 5, 16)));
    for (const PairSet& set : sets) {
        size_t from = rows.size();
        measure(set, subjects, options.repeats, rows);
        print(rows, from);
    }
    size_t from = rows.size();
    measure_kinds(options.pairs, options.repeats, rows);
    print(rows, from);
    from = rows.size();
    measure_rays(options.rays, options.bodies, options.repeats, rows);
    print(rows, from);
    if (!options.csv.empty())
        if (Status s = write_file(options.csv, csv_of(rows)); !s) return s.error();
    int exit_code = 0;
    for (const CollisionRow& row : rows)
        if (row.ours && row.failures > 0) exit_code = 1;
    return exit_code;
}

}  // namespace lendulet::bench
