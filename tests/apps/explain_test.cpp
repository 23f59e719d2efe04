// `lendulet explain …`: pictures of every sequence, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "program.h"

namespace lendulet::test {
namespace {

long count_of(const std::string& text, const std::string& part) {
    long count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(Explain, EverySequenceIsDrawn) {
    struct Case {
        const char *what, *a, *b, *expected;
    };
    const Case cases[] = {
        {"gjk", "box:0.5,0.4,0.3", "capsule:0.4,0.2@1.3,0.6,0.2@0,0,40", "simplex 2"},
        {"gjk", "cylinder:0.4,0.3", "box:0.4,0.3,0.5@0.21,0.33,0.12@10,20,30", "the cores overlap"},
        {"epa", "hull:20,0.6", "box:0.4,0.4,0.4@0.5,0.3,0.2@30,20,10", "polytope 2"},
        {"distance", "cone:0.4,0.3", "box:0.4,0.3,0.3@0.3,0.3,0.2", "polytope 1"},
        {"clip", "box:0.6,0.3,0.5", "box:0.4,0.3,0.4@0.4,0.59,0.2@0,30,0", "the manifold"},
        {"sat", "box:0.6,0.3,0.5", "box:0.4,0.3,0.4@0.4,0.59,0.2@0,30,10", "the axis of the contact"},
    };
    for (const Case& c : cases) {
        std::string svg = scratch("explain.svg");
        Outcome outcome = lendulet({"explain", c.what, c.a, c.b, "--svg", svg});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        std::string text = content(svg);
        EXPECT_EQ(text.rfind("<svg ", 0), 0u);
        EXPECT_NE(text.find(c.expected), std::string::npos) << c.what;
        EXPECT_EQ(count_of(text, "<svg "), count_of(text, "</svg>"));
        EXPECT_EQ(text.find("nan"), std::string::npos) << c.what;
    }
}

// Both solvers come to the same end; with --frames each step has a file.
TEST(Explain, FramesAreTheSteps) {
    std::string svg = scratch("steps.svg");
    for (const char* solver : {"half-space", "barycentric"}) {
        Outcome outcome = lendulet({"explain", "gjk", "box:0.5,0.4,0.3", "box:0.5,0.4,0.3@2,0.6,0.2@0,0,40", "--frames",
                                    "--simplex", solver, "--svg", svg});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        long files = std::count(outcome.out.begin(), outcome.out.end(), '\n');
        EXPECT_GE(files, 3);
        std::string last = svg.substr(0, svg.size() - 4) + "-" + std::to_string(files) + ".svg";
        EXPECT_NE(content(last).find("O is 0.8"), std::string::npos) << content(last).substr(0, 600);
    }
}

void expect_explain_refuses(std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), "explain");
    expect_refused(arguments, part);
}

TEST(Explain, BadInputIsOneSentence) {
    const char *box = "box:1,1,1", *away = "box:1,1,1@5,0,0";
    expect_explain_refuses({"gjk", box}, "");
    expect_explain_refuses({"magic", box, away}, "there are gjk, epa, distance, clip, sat");
    expect_explain_refuses({"gjk", "box", away}, "KIND:NUMBERS");
    expect_explain_refuses({"gjk", "box:1,1", away}, "there must be 3 numbers, not 2");
    expect_explain_refuses({"gjk", "box:1,1,x", away}, "\"x\" is no number");
    expect_explain_refuses({"gjk", "box:1,1,nan", away}, "is no number");
    expect_explain_refuses({"gjk", "box:1,1,1e9", away}, "half_extents.z");
    expect_explain_refuses({"gjk", "ball:1", away}, "there are box, sphere");
    expect_explain_refuses({"gjk", "hull:1e9,1", away}, "4 to 64 points");
    expect_explain_refuses({"gjk", "box:1,1,1@0,0,0@0,0,0@0", away}, "KIND:NUMBERS");
    expect_explain_refuses({"epa", box, away}, "do not overlap");
    expect_explain_refuses({"sat", box, "sphere:1"}, "both shapes must be boxes");
    expect_explain_refuses({"clip", "sphere:1", "sphere:1@3,0,0"}, "do not meet with a face");
    expect_explain_refuses({"gjk", box, away, "--simplex", "fast"}, "there are barycentric, half-space");
    expect_explain_refuses({"gjk", box, away, "--svg", "/no/such/directory/x.svg"}, "/no/such/directory/x.svg");
}

}  // namespace
}  // namespace lendulet::test
