// The summary of a run: its JSON is the documented one, and its numbers are the world's.
#include "io/summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/gltf_fixture.h"

namespace lendulet::test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
    std::vector<std::string> out;
    for (const auto& [key, value] : object.items()) out.push_back(key);
    return out;
}
using Keys = std::vector<std::string>;

class Summary : public testing::Test {
protected:
    Scene scene = load(scene_file("hierarchy.gltf"));
    RunSummary summary;

    Json run_and_read(int steps) {
        RunObserver observer(scene);
        for (int i = 0; i < steps; ++i) {
            run(scene, 1);
            observer.after_step(scene);
        }
        summary = observer.finish(scene, 1.0 / 60.0, 1.0);
        return Json::parse(summary_json(summary));
    }
};

TEST_F(Summary, HasTheDocumentedMembersInOrder) {
    Json json = run_and_read(10);
    EXPECT_EQ(keys(json), (Keys{"scene", "dt", "steps", "threads", "width", "broad_phase", "ms_per_step", "contacts",
                                "max_penetration", "energy", "momentum", "hash", "bodies", "triggers", "warnings"}));
    EXPECT_EQ(keys(json["ms_per_step"]), (Keys{"median", "p99", "stages"}));
    EXPECT_EQ(keys(json["energy"]), (Keys{"start", "end"}));
    EXPECT_EQ(keys(json["momentum"]), (Keys{"start", "end"}));
    EXPECT_EQ(keys(json["momentum"]["end"]), (Keys{"linear", "angular"}));
    EXPECT_EQ(keys(json["bodies"][0]),
              (Keys{"name", "type", "position", "orientation", "linear_velocity", "angular_velocity", "asleep"}));
    EXPECT_EQ(json["bodies"][0]["orientation"].size(), 4u);
    EXPECT_EQ(json["momentum"]["start"]["angular"].size(), 3u);
    EXPECT_EQ(json["steps"], 10);
    EXPECT_EQ(json["hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(std::stoull(json["hash"].get<std::string>(), nullptr, 16), scene.world.hash());
    EXPECT_EQ(json["ms_per_step"]["stages"].size(), static_cast<size_t>(Stage::count));
    EXPECT_GT(json["width"], 0);
}

TEST_F(Summary, BodiesAreTheWorldsInCreationOrder) {
    Json json = run_and_read(10);
    ASSERT_EQ(json["bodies"].size(), static_cast<size_t>(scene.world.body_count()));
    EXPECT_EQ(json["bodies"][0]["name"], "Body");
    EXPECT_EQ(json["bodies"][2]["type"], "static");
    EXPECT_EQ(json["bodies"][5]["name"], "body_5");
    EXPECT_EQ(json["bodies"][5]["type"], "dynamic");
    const RigidBodyRef last = scene.world.get(scene.world.body(5));
    EXPECT_EQ(json["bodies"][5]["position"][1].get<float>(), last.position().y);
    EXPECT_EQ(json["bodies"][5]["linear_velocity"][1].get<float>(), last.velocity().y);
    EXPECT_EQ(json["bodies"][5]["asleep"], false);
}

TEST_F(Summary, EnergyAndMomentumAreThoseOfStartAndEnd) {
    double before = scene.world.kinetic_energy() + scene.world.potential_energy();
    Json json = run_and_read(10);
    EXPECT_EQ(json["energy"]["start"].get<double>(), before);
    EXPECT_EQ(json["energy"]["end"].get<double>(), scene.world.kinetic_energy() + scene.world.potential_energy());
    EXPECT_EQ(json["momentum"]["end"]["linear"][1].get<double>(), scene.world.momentum().linear[1]);
    EXPECT_LT(json["momentum"]["end"]["linear"][1].get<double>(), -1.0);  // they fall
}

TEST_F(Summary, NoStepsGiveZeroTimes) {
    Json json = run_and_read(0);
    EXPECT_EQ(json["ms_per_step"]["median"], 0.0);
    EXPECT_EQ(json["ms_per_step"]["p99"], 0.0);
}

// Names are quoted, numbers that JSON cannot hold are replaced, and bytes that are no UTF-8 do no harm.
TEST(SummaryJson, IsAlwaysJson) {
    RunSummary summary;
    summary.scene = "a\"b\\c\n\xff";
    summary.energy_end = std::nan("");
    summary.max_penetration = INFINITY;
    summary.triggers.push_back({"t", "o", 0.5});
    summary.hash = 0xabc;
    Json json = Json::parse(summary_json(summary));
    EXPECT_EQ(json["energy"]["end"], 0.0);
    EXPECT_EQ(json["max_penetration"], 0.0);
    EXPECT_EQ(json["hash"], "0000000000000abc");
    EXPECT_EQ(keys(json["triggers"][0]), (Keys{"trigger", "other", "first_time"}));
    EXPECT_TRUE(json["bodies"].is_array());
    EXPECT_TRUE(json["warnings"].is_array());
}

TEST_F(Summary, TextNamesWhatMatters) {
    run_and_read(10);
    std::string text = summary_text(summary);
    for (const char* part : {"bodies", "contacts", "median", "p99", "real-time factor", "energy", "momentum",
                             "deepest overlap", "state hash"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part;
    }
}

}  // namespace
}  // namespace lendulet::test
