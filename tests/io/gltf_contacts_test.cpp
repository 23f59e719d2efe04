// Materials, collision filters and triggers of glTF files, seen in what the scenes do.
#include <algorithm>
#include <map>

#include "io/gltf_fixture.h"
#include "io/gltf_materials.h"
#include "io/summary.h"

namespace lendulet::test {
namespace {

TEST(GltfMaterials, ValuesAndRules) {
    Json json = Json::parse(R"([{}, {"staticFriction":0.3,"dynamicFriction":0.2,"restitution":1.5,
        "frictionCombine":"minimum","restitutionCombine":"multiply"}])");
    Warnings warnings;
    std::vector<Material> m = read_materials({&json, "m"}, warnings);
    ASSERT_EQ(m.size(), 2u);
    EXPECT_FLOAT_EQ(*m[0].static_friction, 0.6f);  // the schema's defaults
    EXPECT_FLOAT_EQ(*m[0].dynamic_friction, 0.6f);
    EXPECT_FLOAT_EQ(*m[0].restitution, 0.0f);
    EXPECT_FLOAT_EQ(*m[1].static_friction, 0.3f);
    EXPECT_FLOAT_EQ(*m[1].dynamic_friction, 0.2f);
    EXPECT_FLOAT_EQ(*m[1].restitution, 1.0f);
    EXPECT_EQ(m[1].friction_combine, CombineRule::minimum);
    EXPECT_EQ(m[1].restitution_combine, CombineRule::multiply);
    EXPECT_EQ(warnings.take(), (std::vector<std::string>{"m[1].restitution: is more than 1; 1 is used"}));
}

// Balls of restitution 0.9 dropped by 2 m on a floor of 0.5 that multiplies: they rise by 2 m times the square of the
// combined restitution.
TEST(GltfMaterials, CombineRulesDecideHowHighABallBounces) {
    Scene scene = load(scene_file("materials.gltf"));
    std::map<std::string, float> expected{{"Ball_average", 0.7f},
                                          {"Ball_minimum", 0.5f},
                                          {"Ball_maximum", 0.9f},
                                          {"Ball_multiply", 0.45f},
                                          {"Plain", 0.0f}};
    std::map<std::string, float> highest;
    for (int i = 0; i < 120; ++i) {
        run(scene, 1);
        for (auto& [name, restitution] : expected) {
            const RigidBodyRef ball = moving(scene.world, name);
            bool has_bounced = highest.count(name) > 0;
            if (ball.velocity().y > 0.0f || has_bounced) {
                highest[name] = std::max(has_bounced ? highest[name] : 0.0f, ball.position().y - 0.5f);
            }
        }
    }
    // Plain has restitution 0 and the unset rule, maximum, which comes before multiply: 0.5 wins.
    expected["Plain"] = 0.5f;
    for (auto& [name, e] : expected) EXPECT_NEAR(highest[name], 2.0f * e * e, 0.06f) << name;
}

TEST(GltfFilters, SystemsBecomeBits) {
    Json json = Json::parse(R"([{"collisionSystems":["a"],"collideWithSystems":["b"]},
        {"collisionSystems":["b"],"notCollideWithSystems":["b"]}, {}, {"collideWithSystems":[]}])");
    Warnings warnings;
    std::vector<CollisionFilter> f = read_filters({&json, "f"}, warnings);
    auto meet = [&](size_t i, size_t j) { return (f[i].category & f[j].mask) && (f[j].category & f[i].mask); };
    EXPECT_TRUE(meet(0, 1));
    EXPECT_FALSE(meet(0, 0));
    EXPECT_FALSE(meet(1, 1));
    EXPECT_TRUE(meet(1, 2));   // 1 shuns b alone, and 2 is in no system
    EXPECT_FALSE(meet(0, 2));  // 0 meets b alone
    EXPECT_TRUE(meet(2, 2));
    EXPECT_FALSE(meet(3, 0));
    EXPECT_FALSE(meet(3, 2));
    EXPECT_TRUE(warnings.take().empty());
}

TEST(GltfFilters, MoreThan63SystemsGiveAWarning) {
    Json json = Json::array({Json::object()});
    for (int i = 0; i < 70; ++i) json[0]["collisionSystems"].push_back("s" + std::to_string(i));
    Warnings warnings;
    EXPECT_EQ(read_filters({&json, "f"}, warnings)[0].category, ~uint64_t{1});
    EXPECT_EQ(warnings.take().size(), 7u);
}

TEST(GltfFilters, ShelfOfOneSystemHoldsItsOwn) {
    Scene scene = load(scene_file("filters.gltf"));
    run(scene, 150);
    auto height = [&](const char* name) { return moving(scene.world, name).position().y; };
    constexpr float on_shelf = 3.75f, on_floor = 0.5f;
    EXPECT_NEAR(height("Red"), on_shelf, 0.05f);
    EXPECT_NEAR(height("Both"), on_shelf, 0.05f);
    EXPECT_NEAR(height("Blue"), on_floor, 0.05f);
    EXPECT_LT(height("NotRed"), -5.0f);  // is in no system, and the floor names the systems it meets
    EXPECT_LT(height("Nothing"), -5.0f);
    EXPECT_LT(height("Unfiltered"), -5.0f);  // likewise
}

TEST(GltfTriggers, ReportWhatFallsThrough) {
    Scene scene = load(scene_file("triggers.gltf"));
    RunObserver observer(scene);
    for (int i = 0; i < 120; ++i) {
        run(scene, 1);
        observer.after_step(scene);
    }
    RunSummary summary = observer.finish(scene, 1.0 / 60.0, 0.0);
    std::map<std::pair<std::string, std::string>, double> first;
    for (const TriggerEvent& e : summary.triggers) {
        EXPECT_TRUE(first.emplace(std::pair(e.trigger, e.other), e.first_time).second) << e.trigger << ' ' << e.other;
    }
    // From 6 m, the ball's lowest point reaches the trigger's top at 3.5 m after sqrt(2 * 2 / 9.81) s.
    ASSERT_TRUE(first.count({"Gate", "Falling"}));
    EXPECT_NEAR((first[{"Gate", "Falling"}]), 0.6386, 0.02);
    EXPECT_TRUE(first.count({"Compound", "FallingThere"}));  // once, under the name of the whole
    EXPECT_FALSE(first.count({"Left", "FallingThere"}));
    EXPECT_TRUE(first.count({"Chosen", "Seen"}));
    EXPECT_FALSE(first.count({"Chosen", "Unseen"}));
    EXPECT_TRUE(first.count({"Bumper", "Obstacle"}));
    for (const TriggerEvent& e : summary.triggers) EXPECT_NE(e.other, e.trigger);
    EXPECT_NEAR(moving(scene.world, "Falling").position().y, 0.5f, 0.1f);  // unhindered
}

}  // namespace
}  // namespace lendulet::test
