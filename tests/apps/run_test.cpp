// `lendulet run` over good input: options, outputs, interruption.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "tests/scale.h"

namespace lendulet::test {
namespace {

using Json = nlohmann::json;

// Runs with --json - and reads the JSON.
Json run_json(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--json", "-", "--quiet"});
    Outcome outcome = lendulet(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return Json::parse(outcome.out);
}

TEST(Run, BuiltInSceneWithEveryOption) {
    Json json = run_json({"stack:3", "--seconds", "0.5", "--dt", "1/120", "--threads", "2", "--solver-steps", "6",
                          "--broad-phase", "sweep-1", "--simplex", "barycentric", "--integrator", "symplectic-euler",
                          "--width", "4", "--no-sleep"});
    EXPECT_EQ(json["steps"], 60);
    EXPECT_NEAR(json["dt"].get<double>(), 1.0 / 120.0, 1e-12);
    EXPECT_EQ(json["threads"], 2);
    EXPECT_EQ(json["width"], 4);
    EXPECT_EQ(json["broad_phase"], "sweep-1");
    EXPECT_GT(json["contacts"], 0);
    EXPECT_GE(json["bodies"].size(), 4u);
}

TEST(Run, StepsAreSecondsOverDtRounded) {
    EXPECT_EQ(run_json({"stack:1", "--seconds", "0.05"})["steps"], 3);
    EXPECT_EQ(run_json({"stack:1", "--seconds", "0.1", "--dt", "0.03"})["steps"], 3);
    EXPECT_EQ(run_json({"stack:1", "--seconds", "0"})["steps"], 0);
    EXPECT_EQ(run_json({"stack:1", "--seconds", "1/2"})["steps"], 30);
}

TEST(Run, SameHashForThreadsWidthsAndBroadPhases) {
    std::vector<std::string> run{"scenes/files/playground.gltf", "--seconds", "1"};
    auto hash = [&](std::vector<std::string> options) {
        options.insert(options.begin(), run.begin(), run.end());
        return run_json(options)["hash"].get<std::string>();
    };
    std::string expected = hash({});
    EXPECT_EQ(hash({"--threads", "3", "--width", "1"}), expected);
    EXPECT_EQ(hash({"--broad-phase", "all-pairs", "--width", "4"}), expected);
}

TEST(Run, JsonToFileBesideTheText) {
    std::string file = scratch("summary.json");
    Outcome outcome = lendulet({"run", "stack:2", "--seconds", "0.2", "--json", file});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("state hash"), std::string::npos);
    std::ifstream in(file);
    EXPECT_EQ(Json::parse(in)["steps"], 12);
}

TEST(Run, QuietPrintsNothing) {
    Outcome outcome = lendulet({"run", "scenes/files/shapes.gltf", "--seconds", "0.1", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
    outcome = lendulet({"run", "scenes/files/shapes.gltf", "--seconds", "0.1"});
    EXPECT_NE(outcome.err.find("warning: nodes["), std::string::npos);
}

TEST(Run, RecordingIsDescribedByInfo) {
    std::string file = scratch("recording");
    Json json = run_json({"scenes/files/playground.gltf", "--seconds", "0.5", "--record", file});
    Outcome info = lendulet({"info", file});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("30 of 0.0166667 s"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find(json["hash"].get<std::string>()), std::string::npos) << info.out;
}

TEST(Run, PlaygroundDoesItsTricks) {
    Json json = run_json({"scenes/files/playground.gltf", "--seconds", "8"});
    auto body = [&](const std::string& name) {
        for (const Json& b : json["bodies"]) {
            if (b["name"] == name) return b;
        }
        ADD_FAILURE() << "no " << name;
        return Json();
    };
    auto upright = [&](const std::string& name) {  // the y component of the body's y axis
        auto q = body(name)["orientation"].get<std::vector<double>>();
        return 1.0 - 2.0 * (q[0] * q[0] + q[2] * q[2]);
    };
    EXPECT_LT(upright("Domino_1"), 0.8);
    EXPECT_LT(upright("Domino_12"), 0.8);
    EXPECT_NEAR(body("Crate")["position"][1].get<double>(), 2.35, 0.05);  // on the net
    EXPECT_NEAR(body("Ghost")["position"][1].get<double>(), 0.3, 0.05);   // through it
    EXPECT_LT(std::abs(body("Brick_5_2")["position"][1].get<double>()), 1.7);
    bool goal = false;
    for (const Json& t : json["triggers"]) goal |= t["trigger"] == "Goal" && t["other"] == "Thrown";
    EXPECT_TRUE(goal) << json["triggers"];
    EXPECT_EQ(json["warnings"].size(), 0u) << json["warnings"];
}

TEST(Run, WithoutPhysicsIsAnEmptyWorldWithAWarning) {
    std::string file = scratch("plain.gltf");
    std::ofstream(file) << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"name":"a"}]})";
    Json json = run_json({file, "--seconds", "0.1"});
    EXPECT_EQ(json["bodies"].size(), 0u);
    ASSERT_EQ(json["warnings"].size(), 1u);
    EXPECT_EQ(json["scene"], file);
}

TEST(Run, InterruptEndsWithTheSummary) {
    Outcome outcome = lendulet({"run", "stack:5", "--seconds", "100000", "--json", "-"}, 400);
    EXPECT_EQ(outcome.exit_code, 0);
    Json json = Json::parse(outcome.out);
    EXPECT_GT(json["steps"], 0);
    EXPECT_LT(json["steps"], 6000000);
}

// Also where it comes before the first step, and of the run of a repro file, whose bits are then not compared.
TEST(Run, InterruptEndsEveryRunWithTheSummary) {
    Outcome early = lendulet({"run", "box_pile:200000", "--seconds", "1000", "--quiet"}, 400);
    EXPECT_EQ(early.exit_code, 0) << early.err;
    const std::string file = scratch("long.json");
    std::ofstream(file) << R"({"lendulet": "repro", "version": 1, "scene": "stack:5", "steps": 100000000,
                               "hash": "0000000000000000", "deeds": []})";
    Outcome replay = lendulet({"run", file, "--json", "-"}, 400);
    EXPECT_EQ(replay.exit_code, 2);
    EXPECT_NE(replay.err.find("ended early"), std::string::npos) << replay.err;
    EXPECT_LT(Json::parse(replay.out)["steps"], 100000000);
}

#if defined(__has_feature)
#define LENDULET_HAS_FEATURE(x) __has_feature(x)
#else
#define LENDULET_HAS_FEATURE(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || LENDULET_HAS_FEATURE(address_sanitizer) || \
    LENDULET_HAS_FEATURE(thread_sanitizer)
constexpr bool takes_address_space = true;
#else
constexpr bool takes_address_space = false;
#endif

// Of memory for the scene, and of what the core asks for within a step.
TEST(Run, WithoutMemoryEndsWithASentence) {
    if (takes_address_space) GTEST_SKIP() << "sanitizers take more of it than a limit could leave";
    for (size_t megabytes : {60, 100}) {
        Outcome outcome = lendulet({"run", "box_pile:100000", "--seconds", "1", "--quiet"}, -1, megabytes << 20);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
        EXPECT_EQ(outcome.err.rfind("lendulet: out of memory", 0), 0u) << outcome.err;
    }
}

TEST(Program, HelpVersionAndScenes) {
    Outcome help = lendulet({"run", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* option : {"--seconds", "--dt", "--threads", "--solver-steps", "--broad-phase", "--simplex",
                               "--integrator", "--width", "--no-sleep", "--json", "--record", "--quiet"}) {
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
    }
    EXPECT_EQ(lendulet({"--version"}).out.rfind("lendulet ", 0), 0u);
    Outcome scenes = lendulet({"scenes"});
    EXPECT_EQ(scenes.exit_code, 0);
    EXPECT_NE(scenes.out.find("box_pile:"), std::string::npos);
}

// The viewer's page writes such files; web/test checks that it gives the same bits as the program.
TEST(Run, ReproFileHasTheBitsThatWereSaved) {
    const std::string file = scratch("repro.json");
    Json repro{
        {"lendulet", "repro"},
        {"version", 1},
        {"scene", "stack:3"},
        {"steps", 90},
        {"hash", "0000000000000000"},
        {"deeds",
         {{{"step", 0}, {"command", {{"do", "set"}, {"friction", 0.25}, {"broadPhase", 3}}}},
          {{"step", 10},
           {"command",
            {{"do", "sphere"}, {"radius", 0.3}, {"at", {-4, 2, 0}}, {"velocity", {12, 0, 0}}, {"density", 600}}}},
          {{"step", 30}, {"command", {{"do", "grab"}, {"body", 3}, {"point", {0, 2.5, 0}}}}},
          {{"step", 31}, {"command", {{"do", "drag"}, {"target", {0, 5, 0}}}}},
          {{"step", 60}, {"command", {{"do", "release"}}}},
          {{"step", 90},
           {"command",
            {{"do", "shape"},
             {"type", 6},
             {"size", {0.4, 0.3}},
             {"rounding", 0},
             {"at", {0, 6, 0}},
             {"velocity", {0, 0, 0}},
             {"density", 300}}}}}}};
    auto write = [&] { std::ofstream(file) << repro.dump(); };
    write();
    Outcome other = lendulet({"run", file, "--quiet", "--json", "-"});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_NE(other.err.find("not the bits that were saved"), std::string::npos) << other.err;
    const Json summary = Json::parse(other.out);
    EXPECT_EQ(summary["steps"], 90);
    EXPECT_EQ(summary["bodies"].size(), 6u);
    repro["hash"] = summary["hash"];
    write();
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{}, {"--threads", "3", "--width", "1"}, {"--broad-phase", "sweep-1"}}) {
        std::vector<std::string> arguments{"run", file};
        arguments.insert(arguments.end(), options.begin(), options.end());
        Outcome same = lendulet(arguments);
        EXPECT_EQ(same.exit_code, 0) << same.err;
        EXPECT_NE(same.err.find("The same bits"), std::string::npos) << same.err;
    }
    // What is none, and deeds that cannot be done.
    const Json whole = repro;
    auto refused = [&](const char* part) {
        write();
        expect_refused({"run", file}, part);
        repro = whole;
    };
    repro["lendulet"] = "recording", refused("no repro file");
    repro["version"] = 2, refused("version");
    repro["steps"] = -1, refused("steps");
    repro["scene"] = "no_such_scene", refused("no_such_scene");
    repro["gltf"] = "AAAA", refused("glTF");
    repro["deeds"][1]["step"] = 70, refused("not in order");
    repro["deeds"][0]["command"]["do"] = "explode", refused("explode");
    repro["deeds"] = 3, refused("deeds");
    repro["steps"] = 89, refused("after its last step");
    repro["scene"] = "other.json", refused("its scene is a repro file itself");
    write();
    expect_refused({"run", file, "--record", scratch("no.rec")}, "--record");
    expect_refused({"run", file, "--seconds", "1"}, "--seconds");
    expect_refused({"run", file, "--dt", "1/60"}, "--dt");
    expect_refused({"run", file, "--json", file}, "over the scene that is read");
    std::ofstream(file) << "{";
    expect_refused({"run", file}, "not JSON");
}

}  // namespace
}  // namespace lendulet::test
