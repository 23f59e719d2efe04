// Cases with closed forms: what the engine computes beside what mechanics says. `lendulet verify` prints them,
// docs/accuracy.md holds a run of them, tests/physics asserts them; every case is written once, in cases/.
//
// A case is written in axes of its own (y up) and run in worlds that are turned and moved at random, since a result
// that holds along the axes only is no result. The worst of them counts. Tolerances are part of the cases.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lendulet/result.h"

namespace lendulet::verify {

// The shipping defaults at dt = 1/60 s (d60) and at 1/240 s (hq). Cases that name their own step are run at that step.
// More substeps at 1/240 s would lose to rounding: positions 100 m out resolve 8e-6 m.
enum class Quality { d60, hq };
std::string_view name_of(Quality);
Result<Quality> quality_from_name(std::string_view name);  // error: unknown_name

// One measured quantity of a case, from the world in which its error was largest.
struct Row {
    std::string case_id;
    Quality quality;
    std::string quantity;     // with its unit
    double measured, exact;   // not finite where the simulation was not
    double error, tolerance;  // in the quantity's unit, or relative where `relative`
    bool relative;
    bool pass;  // error <= tolerance, and measured at least once
};

// Measured points beside the exact curve, from the first of the worlds.
struct Curve {
    struct Point {
        double x, measured, exact;
    };
    std::string case_id, title, x_label, y_label;
    std::vector<Point> points;
    void add(double x, double measured, double exact) { points.push_back({x, measured, exact}); }
};

// A case that is not run, and why.
struct Missing {
    std::string case_id, title, reason;
};

struct Report {
    std::vector<Row> rows;
    std::vector<Curve> curves;
    std::vector<Missing> missing;
    int failed() const;  // number of rows that do not pass
};

struct CaseInfo {
    std::string_view id, title;
    std::string_view lacking;  // what it needs and is not there; empty for cases that run
};
std::vector<CaseInfo> all_cases();
std::string_view title_of(std::string_view case_id);  // empty for unknown ones

struct Options {
    std::vector<std::string> cases;  // ids, in any order; empty: all
    Quality quality = Quality::d60;
    int frames = 5;   // random places, 1 .. 5
    int workers = 0;  // threads, each with a world of its own; 0: as many as the machine has. Never changes results
    int scale = 1;    // divides the numbers of repetitions inside cases, for quick tests
};
// Rows in the order of the table of cases. Error: unknown_name naming the cases there are.
Result<Report> run(const Options& options);

}  // namespace lendulet::verify
