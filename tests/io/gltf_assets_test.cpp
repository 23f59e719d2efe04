// The sample files of the glTF physics extensions, where they lie beside the repository: they load, run, and do what
// their names say. Skipped where they are absent; the files are not ours to distribute.
#include <cmath>
#include <filesystem>

#include "io/file.h"
#include "io/gltf_fixture.h"
#include "io/summary.h"
#include "tests/scale.h"

namespace lendulet::test {
namespace {

class GltfAssets : public testing::Test {
protected:
    const std::string folder = "../shared/assets/gltf_physics/";
    void SetUp() override {
        if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
    }
    Scene sample(const std::string& name) { return load(folder + name + ".glb"); }
};

TEST_F(GltfAssets, Filtering) {
    Scene scene = sample("Filtering");
    run(scene, 240);
    auto height = [&](const char* name) { return moving(scene.world, name).position().y; };
    EXPECT_NEAR(height("DynamicBlue"), 0.65f, 0.05f);       // through the green box, to the ground
    EXPECT_GT(height("DynamicGreen"), 2.5f);                // on the green box
    EXPECT_NEAR(height("DynamicGreen.001"), 0.65f, 0.05f);  // through the blue box
    EXPECT_LT(height("DynamicCompound"), 4.9f);
    EXPECT_GT(height("DynamicCompound"), 1.0f);  // its blue part passes, its green part rests
}

TEST_F(GltfAssets, JointTypes) {
    Scene scene = sample("JointTypes");
    EXPECT_EQ(scene.world.joint_count(), 11);
    EXPECT_FALSE(warns(scene, ""));
    Position first = moving(scene.world, "Cube.011").position();
    run(scene, 300);
    EXPECT_LT(length(moving(scene.world, "Cube.011").position() - first), 0.02f);  // the fixed joint
    for (int i = 0; i < scene.world.joint_count(); ++i) {
        EXPECT_LT(length(scene.world.joint(scene.world.joint_id(i)).linear_error), 0.02f) << i;
    }
    EXPECT_NEAR(moving(scene.world, "Cube.017").angular_velocity().z, -1.57f, 0.1f);  // the velocity target
    // Three bounded axes keep the point at which it hangs within a cube of 0.25 m.
    const RigidBodyRef hung = moving(scene.world, "Cube.009");
    EXPECT_LT(max_component(absolute(rotate_inverse(
                  hung.orientation(), hung.position() + rotate(hung.orientation(), Vec3{0.0f, 0.0f, 1.0f}) -
                                          Position{-0.75f, 3.0f, 0.0f}))),
              0.25f + 5e-3f);
}

TEST_F(GltfAssets, MaterialsFriction) {
    Scene scene = sample("Materials_Friction");
    Position honey = moving(scene.world, "HoneyCombWalls").position(),
             soap = moving(scene.world, "Soap2.001").position();
    run(scene, 150);
    float honey_way = length(moving(scene.world, "HoneyCombWalls").position() - honey);
    float soap_way = length(moving(scene.world, "Soap2.001").position() - soap);
    EXPECT_GT(soap_way, honey_way + 1.0f);  // soap slides away, honey lags behind
}

TEST_F(GltfAssets, MaterialsRestitution) {
    Scene scene = sample("Materials_Restitution");
    float highest_basketball = 0.0f, highest_bowling = 0.0f;
    bool basketball_up = false, bowling_up = false;
    for (int i = 0; i < 90; ++i) {
        run(scene, 1);
        const RigidBodyRef basketball = moving(scene.world, "Basketball"), bowling = moving(scene.world, "Bowlingball");
        basketball_up |= basketball.velocity().y > 0.5f;
        bowling_up |= bowling.velocity().y > 0.05f;
        if (basketball_up) highest_basketball = std::max(highest_basketball, basketball.position().y);
        if (bowling_up) highest_bowling = std::max(highest_bowling, bowling.position().y);
    }
    EXPECT_GT(highest_basketball, 1.3f);  // from 1.5 m with restitution 0.95
    EXPECT_LT(highest_bowling, 0.35f);
}

TEST_F(GltfAssets, MotionProperties) {
    Scene scene = sample("MotionProperties");
    Position wheel = moving(scene.world, "Wheel_InfiniteMassFiniteInertia").position();
    Quat box = moving(scene.world, "InfInertiaBox").orientation();
    run(scene, scaled(300, 60));
    const World& world = scene.world;
    EXPECT_GT(moving(world, "Balloon_GravityFactor").position().y, 1.0f);
    EXPECT_GT(moving(world, "Balloon_GravityFactor.001").position().y, 1.0f);
    EXPECT_LT(length(moving(world, "Wheel_InfiniteMassFiniteInertia").position() - wheel), 1e-3f);
    EXPECT_LT(angle_between(moving(world, "InfInertiaBox").orientation(), box), 1e-3f);
}

// A toy with its centre of mass low stands up whichever way it is dropped.
TEST_F(GltfAssets, WobblyToyStandsUp) {
    Scene scene = load_gltf(folder + "MotionProperties.glb", [](WorldBuilder& b) { b.sleep(false); }).value();
    run(scene, 900);
    EXPECT_GT(rotate(moving(scene.world, "WobbyToy_ModifiedCOM").orientation(), Vec3{0.0f, 1.0f, 0.0f}).y, 0.7f);
}

TEST_F(GltfAssets, ShapeTypes) {
    Scene scene = sample("ShapeTypes");
    EXPECT_TRUE(std::holds_alternative<TaperedCapsule>(any_body(scene.world, "DynamicTaperedCapsule").shape()));
    EXPECT_TRUE(std::holds_alternative<TaperedCylinder>(any_body(scene.world, "DynamicCone").shape()));
    EXPECT_TRUE(std::holds_alternative<ConvexHull>(any_body(scene.world, "DynamicConvex").shape()));
    EXPECT_TRUE(std::holds_alternative<TriangleMesh>(any_body(scene.world, "StaticMesh").shape()));
    EXPECT_EQ(any_body(scene.world, "DynamicCompound").collider_count(), 7);
    float lowest = any_body(scene.world, "StaticMesh").aabb().lower.y;
    run(scene, 60);
    for (const char* name : {"DynamicBox", "DynamicCapsule", "DynamicSphere", "DynamicCylinder", "DynamicMesh"}) {
        EXPECT_GT(moving(scene.world, name).position().y, lowest) << name;  // none falls through the slope
    }
}

TEST_F(GltfAssets, Triggers) {
    Scene scene = sample("Triggers");
    RunObserver observer(scene);
    for (int i = 0; i < 120; ++i) {
        run(scene, 1);
        observer.after_step(scene);
    }
    std::vector<std::string> met;
    for (const TriggerEvent& e : observer.finish(scene, 1.0 / 60.0, 0.0).triggers) {
        if (e.other == "Cube") met.push_back(e.trigger);
    }
    std::sort(met.begin(), met.end());
    EXPECT_EQ(met, (std::vector<std::string>{"ChildA", "ChildB", "Standalone"}));
}

TEST_F(GltfAssets, TruncatedOrChangedNeverCrash) {
    uint64_t random = 99;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::string original = read_file(entry.path().string()).value();
        for (int i = 0; i < scaled(10, 3); ++i) {
            std::string cut = original.substr(0, original.size() * static_cast<size_t>(i) / 10);
            EXPECT_FALSE(load_gltf_bytes(cut, "", "cut").ok());
            std::string changed = original;
            for (int k = 0; k < 5; ++k) {
                random = random * 6364136223846793005ull + 1442695040888963407ull;
                changed[(random >> 33) % 20000] ^= static_cast<char>(1 << (i % 8));  // mostly in the JSON chunk
            }
            Result<Scene> loaded = load_gltf_bytes(changed, "", "changed");
            EXPECT_TRUE(loaded.ok() || !loaded.error().message.empty());
        }
    }
}

}  // namespace
}  // namespace lendulet::test
