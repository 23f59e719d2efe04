// Every case of `lendulet verify`, at fewer places and, where it is long, with fewer repetitions. What passes must
// pass; what is known to be out of its tolerance is listed, and must be taken off the list when it is mended.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <set>

#include "scale.h"
#include "verify/report.h"

namespace lendulet::verify {
namespace {

// Out of tolerance with these settings, see docs/accuracy.md. "Case: quantity".
const std::set<std::string> known_red = {};

struct Effort {
    const char* id;
    int frames, scale;
};
void PrintTo(const Effort& effort, std::ostream* out) { *out << effort.id; }

class Cases : public ::testing::TestWithParam<Effort> {};

TEST_P(Cases, AreWithinTheirTolerances) {
    const Effort& effort = GetParam();
    const bool reduced = scaled(2) < 2;  // a slow build
    Options options{.cases = {effort.id},
                    .frames = reduced ? 1 : effort.frames,
                    .workers = 2,
                    .scale = reduced ? 20 : effort.scale};
    Report report = run(options).value();
    std::cout << report_text(report);
    ASSERT_FALSE(report.rows.empty());
    for (const Row& row : report.rows) {
        std::string name = row.case_id + ": " + row.quantity;
        if (!known_red.count(name)) {
            EXPECT_TRUE(row.pass) << name << " is " << row.measured << ", exact " << row.exact;
        } else if (!reduced) {
            EXPECT_FALSE(row.pass) << name << " passes now: take it off the list";
        }
        RecordProperty(row.quantity, std::to_string(row.measured));
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Cases,
    ::testing::Values(Effort{"A01", 5, 1}, Effort{"A02", 3, 1}, Effort{"A03", 3, 1}, Effort{"A04", 2, 1},
                      Effort{"A06", 2, 1}, Effort{"A07", 2, 1}, Effort{"A08", 5, 1}, Effort{"A09", 1, 10},
                      Effort{"A10", 1, 20}, Effort{"A11", 1, 20}, Effort{"A12", 5, 1}, Effort{"A13", 5, 1},
                      Effort{"A14", 5, 1}, Effort{"A15", 5, 1}, Effort{"A17", 2, 5}, Effort{"A18", 5, 1},
                      Effort{"A19", 2, 1}, Effort{"A20", 3, 1}, Effort{"A21", 5, 1}, Effort{"A22", 2, 1},
                      Effort{"A23", 1, 4}, Effort{"A24", 5, 1}, Effort{"A26", 1, 1}, Effort{"A27", 2, 1},
                      Effort{"A28", 2, 1}, Effort{"A29", 5, 1}, Effort{"A32", 1, 12}, Effort{"A33", 5, 1},
                      Effort{"A34", 1, 1}, Effort{"A36", 2, 1}, Effort{"A38", 1, 1}, Effort{"A39", 3, 1},
                      Effort{"A40", 1, 1}, Effort{"A41", 4, 2}),
    [](const auto& info) { return std::string(info.param.id); });

// Short steps are not worse than long ones: 100 m out friction gave way a tenth early in steps of 1/240 s, as long as
// gaps of contacts were differences of rounded positions.
TEST(ShortSteps, FrictionBreaksAwayWhereItShould) {
    Report report =
        run({.cases = {"A19"}, .quality = Quality::hq, .frames = scaled(2) < 2 ? 1 : 5, .workers = 2}).value();
    ASSERT_FALSE(report.rows.empty());
    for (const Row& row : report.rows) EXPECT_TRUE(row.pass) << row.quantity << " is " << row.measured;
}

// No case is left out here.
TEST(CaseTable, IsTestedAsAWhole) {
    std::set<std::string_view> run_ids;
    for (const CaseInfo& info : all_cases())
        if (info.lacking.empty()) run_ids.insert(info.id);
    EXPECT_EQ(run_ids.size(), 34u);
    Report lacking = run({.cases = {"A35"}}).value();
    EXPECT_TRUE(lacking.rows.empty());
    EXPECT_EQ(lacking.missing.size(), 1u);
}

// Threads change nothing, and unknown cases are refused.
TEST(CaseTable, ThreadsAndNames) {
    Options options{.cases = {"A12", "A08"}, .frames = 3, .workers = 1};
    std::string one = report_json(run(options).value(), Quality::d60);
    options.workers = 5;
    EXPECT_EQ(report_json(run(options).value(), Quality::d60), one);
    EXPECT_LT(one.find("\"A08\""), one.find("\"A12\""));
    EXPECT_FALSE(run({.cases = {"A08", "B99"}}).ok());
    EXPECT_FALSE(quality_from_name("best").ok());
}

}  // namespace
}  // namespace lendulet::verify
