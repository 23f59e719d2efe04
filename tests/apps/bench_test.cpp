// `lendulet bench …`: small runs, what they write, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "program.h"

namespace lendulet::test {
namespace {

void expect_bench_refuses(std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), "bench");
    expect_refused(arguments, part);
}

TEST(Bench, BroadPhaseWritesTableCsvAndChart) {
    std::string csv = scratch("broad_phase.csv"), svg = scratch("broad_phase.svg");
    Outcome outcome = lendulet({"bench", "broad-phase", "--sizes", "10,50", "--distributions", "uniform,one-huge",
                                "--modes", "rebuild,refit", "--structures", "all-pairs,sweep-1,rtree-omt", "--repeats",
                                "2", "--csv", csv, "--svg", svg});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("one-huge, 50 boxes, refit"), std::string::npos) << outcome.out;
    std::string text = content(csv);
    EXPECT_EQ(text.rfind("structure,distribution,n,mode,median_ns,pairs\n", 0), 0u) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 2 * 2 * 2 * 3) << text;
    EXPECT_NE(text.find("\nsweep-1,uniform,50,rebuild,"), std::string::npos) << text;
    EXPECT_EQ(content(svg).rfind("<svg ", 0), 0u);
    EXPECT_NE(content(svg).find("</svg>"), std::string::npos);
}

TEST(Bench, BadOptionsAreOneSentence) {
    expect_bench_refuses({}, "name of a benchmark");
    expect_bench_refuses({"everything"}, "");
    for (const char* bad : {"0", "-5", "x", "", "10,", ",10", "10,,20", "1e3", "10000001", "99999999999999999999"})
        expect_bench_refuses({"broad-phase", std::string("--sizes=") + bad}, "--sizes");
    expect_bench_refuses({"broad-phase", "--modes", "rebuild,jump"},
                         "\"jump\"; there are rebuild, split, refit, query");
    expect_bench_refuses({"broad-phase", "--distributions", "round"}, "uniform, clustered, ground, one-huge");
    expect_bench_refuses({"broad-phase", "--structures", "rtree-best"}, "all-pairs");
    expect_bench_refuses({"broad-phase", "--structures", "all-pairs,"}, "there is no \"\"");
    expect_bench_refuses({"broad-phase", "--repeats", "0"}, "--repeats must be 1 to 1000");
    expect_bench_refuses({"broad-phase", "--repeats", "many"}, "--repeats");
    expect_bench_refuses({"broad-phase", "--csv", "/no/such/directory/x"}, "/no/such/directory/x");
    expect_bench_refuses({"broad-phase", "--svg", "/no/such/directory/x"}, "/no/such/directory/x");
    expect_bench_refuses({"broad-phase", "extra"}, "extra");
}

TEST(Bench, ScenesWriteTableAndCsv) {
    std::string csv = scratch("scenes.csv");
    Outcome outcome = lendulet({"bench", "scenes", "--scenes", "stack_3,two_boxes", "--threads", "1,2", "--steps", "5",
                                "--repeats", "1", "--against", "none", "--csv", csv});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::string text = content(csv);
    EXPECT_EQ(
        text.rfind("engine,scene,threads,bodies,median_ms,p99_ms,first_ms,mean_ms,contacts,pen_mean_mm,pen_p99_mm,"
                   "pen_max_mm,joint_error_mean_mm,joint_error_max_mm,top_error_mm,drift_mm,stands,hash\n",
                   0),
        0u);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), ','), 5 * 17) << text;
    EXPECT_NE(text.find("\nlendulet,stack_3,2,3,"), std::string::npos) << text;
    EXPECT_NE(text.find(",true,"), std::string::npos) << text;
}

TEST(Bench, BadSceneOptionsAreOneSentence) {
    expect_bench_refuses({"scenes", "--scenes", "stack_3,no_such_scene"}, "no_such_scene");
    expect_bench_refuses({"scenes", "--scenes="}, "--scenes");
    expect_bench_refuses({"scenes", "--threads", "0"}, "--threads must be whole numbers from 1 to 64");
    expect_bench_refuses({"scenes", "--threads", "1,65"}, "--threads");
    expect_bench_refuses({"scenes", "--steps", "0"}, "--steps: Value 0 not in range 1 to 100000");
    expect_bench_refuses({"scenes", "--repeats", "101"}, "--repeats must be 1 to 100");
    expect_bench_refuses({"scenes", "--against", "everyone"}, "there are bullet, none");
    expect_bench_refuses({"scenes", "--csv", "/no/such/directory/x"}, "/no/such/directory/x");
}

TEST(Bench, CollisionWritesTableAndCsv) {
    std::string csv = scratch("collision.csv");
    Outcome outcome = lendulet(
        {"bench", "collision", "--pairs", "40", "--rays", "200", "--bodies", "30", "--repeats", "1", "--csv", csv});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    std::string text = content(csv);
    EXPECT_EQ(text.rfind("routine,case,median_ns,worst_error,failures\n", 0), 0u) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), ','), 4 * std::count(text.begin(), text.end(), '\n')) << text;
    for (const char* row :
         {"lendulet distance; half-space,box-box near,", "lendulet distance; barycentric,hull32 deep,",
          "lendulet distance; half-space; warm,box-box far,", "lendulet manifold; width 8,box-box deep,",
          "lendulet manifold; single,capsule-capsule,", "lendulet manifold; single,box-height_field,",
          "lendulet cast_rays,ray; pile of 30,"})
        EXPECT_NE(text.find(std::string("\n") + row), std::string::npos) << row << text;
}

TEST(Bench, BadCollisionOptionsAreOneSentence) {
    expect_bench_refuses({"collision", "--pairs", "3"}, "--pairs must be 16 to 1000000");
    expect_bench_refuses({"collision", "--rays", "0"}, "--rays must be 1 to 10000000");
    expect_bench_refuses({"collision", "--bodies", "-1"}, "--bodies must be 1 to 100000");
    expect_bench_refuses({"collision", "--repeats", "0"}, "--repeats must be 1 to 1000");
    expect_bench_refuses({"collision", "--csv", "/no/such/directory/x"}, "/no/such/directory/x");
}

// A wrong name of the second file must not have emptied the first.
TEST(Bench, NothingIsWrittenWhereAnOptionIsRefused) {
    std::string csv = scratch("kept.csv");
    std::ofstream(csv) << "kept";
    expect_bench_refuses({"broad-phase", "--csv", csv, "--modes", "jump"}, "jump");
    EXPECT_EQ(content(csv), "kept");
}

}  // namespace
}  // namespace lendulet::test
