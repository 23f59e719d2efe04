// Names of built-in scenes and what they build.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scenes/description.h"

namespace lendulet {
namespace {

TEST(Registry, ListsEverySceneOnceWithASentence) {
    const char* expected[] = {"large_pyramid",
                              "many_pyramids",
                              "box_pile",
                              "sphere_pile",
                              "capsule_pile",
                              "convex_pile",
                              "mixed_pile",
                              "joint_grid",
                              "ragdolls",
                              "tumbler",
                              "mesh_terrain",
                              "height_field",
                              "large_world_sleep",
                              "stack",
                              "mass_ratio",
                              "chain_heavy",
                              "wall_ball",
                              "many_things",
                              "two_spheres",
                              "sphere_and_box",
                              "two_boxes",
                              "wrecking_ball",
                              "carpet_bomb",
                              "spinning_ball",
                              "rotating_board",
                              "newtons_cradle",
                              "dzhanibekov",
                              "dominoes",
                              "domino_spiral",
                              "brick_tower",
                              "arch",
                              "card_house",
                              "ragdoll_avalanche",
                              "bridge",
                              "car",
                              "gear_train",
                              "walker",
                              "hourglass",
                              "marble_machine",
                              "t_handle",
                              "ten_thousand_boxes"};
    std::vector<SceneInfo> scenes = built_in_scenes();
    EXPECT_EQ(scenes.size(), std::size(expected));
    for (const char* name : expected) {
        int count = 0;
        for (const SceneInfo& info : scenes) count += info.name == name;
        EXPECT_EQ(count, 1) << name;
    }
    for (const SceneInfo& info : scenes) EXPECT_EQ(info.description.back(), '.') << info.name;
}

TEST(Registry, BothSpellingsOfASizeAreTheSameScene) {
    for (const char* name : {"stack:7", "stack_7"}) {
        Result<Scene> scene = build_scene(name);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(scene.value().name, "stack:7");
        EXPECT_EQ(scene.value().world.body_count(), 8);
    }
    EXPECT_EQ(build_scene("large_pyramid_50").value().world.body_count(), 1 + 50 * 51 / 2);
    EXPECT_EQ(build_scene("stack").value().world.body_count(), 21);
}

TEST(Registry, UnknownNamesAreRefusedWithNearOnes) {
    for (const char* name :
         {"box_piel", "pile", "", ":", ":5", "_5", "stackk:5", "box_pile_", "box_pile_5x", "no\nscene"}) {
        Result<Scene> scene = build_scene(name);
        ASSERT_FALSE(scene.ok()) << name;
        EXPECT_EQ(scene.error().code, ErrorCode::unknown_name) << name;
        EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
    }
    EXPECT_NE(build_scene("box_piel").error().message.find("box_pile"), std::string::npos);
    EXPECT_NE(build_scene("ragdoll").error().message.find("ragdolls"), std::string::npos);
    EXPECT_LT(build_scene(std::string(100000, 'x')).error().message.size(), 1000u);
}

TEST(Registry, SizesOutOfRangeAreRefused) {
    for (const char* name : {"stack:0", "stack:", "stack:-1", "stack:1001", "stack:99999999999999999999", "stack:5x",
                             "stack: 5", "stack:1e2", "box_pile:1000001", "dzhanibekov:3", "two_boxes_2"}) {
        Result<Scene> scene = build_scene(name);
        ASSERT_FALSE(scene.ok()) << name;
        EXPECT_EQ(scene.error().code, ErrorCode::bad_config) << name;
    }
}

TEST(Registry, ConfigureComesLast) {
    Scene scene = build_scene("stack:1", [](WorldBuilder& builder) { builder.no_gravity().friction(0.25f); }).value();
    EXPECT_EQ(scene.world.config().gravity, Vec3{});
    EXPECT_EQ(scene.world.config().friction, 0.25f);
    EXPECT_FALSE(build_scene("stack:1", [](WorldBuilder& builder) { builder.solver_steps(0); }).ok());
}

struct Count {
    const char* name;
    int bodies, joints;
};

void PrintTo(const Count& count, std::ostream* out) { *out << count.name; }

class EveryScene : public testing::TestWithParam<Count> {};

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST_P(EveryScene, BuildsAndSteps) {
    Result<Scene> built = build_scene(GetParam().name);
    ASSERT_TRUE(built.ok()) << built.error().message;
    Scene& scene = built.value();
    EXPECT_EQ(scene.world.body_count(), GetParam().bodies);
    EXPECT_EQ(scene.world.joint_count(), GetParam().joints);
    EXPECT_GT(scene.steps, 0);
    for (int step = 0; step < 5; ++step) {
        if (scene.before_step) scene.before_step(scene.world, step);
        scene.world.update(scene.dt).value();
    }
    EXPECT_EQ(scene.world.statistics().contained_bodies, 0);
    EXPECT_EQ(scene.world.check(), "");
    int moved = 0;
    for (int i = 0; i < scene.world.body_count(); ++i) {
        BodyId id = scene.world.body(i);
        EXPECT_TRUE(finite(from_origin(scene.world.get_static(id).position()))) << i;
        if (scene.world.get_static(id).type() == BodyType::fixed) continue;
        const RigidBodyRef body = scene.world.get(id);
        moved += body.kinetic_energy() > 0.0f || length(body.velocity()) + length(body.angular_velocity()) > 0.0f;
    }
    EXPECT_GT(moved, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EveryScene,
    testing::Values(Count{"large_pyramid:4", 11, 0}, Count{"many_pyramids:2", 221, 0}, Count{"many_pyramids:1", 56, 0},
                    Count{"box_pile:30", 35, 0}, Count{"sphere_pile:30", 35, 0}, Count{"capsule_pile:30", 35, 0},
                    Count{"convex_pile:30", 35, 0}, Count{"mixed_pile:30", 35, 0}, Count{"joint_grid:5", 25, 36},
                    Count{"ragdolls:2", 23, 20}, Count{"tumbler:3", 29, 0}, Count{"mesh_terrain:20", 21, 0},
                    Count{"height_field:20", 21, 0}, Count{"large_world_sleep:10", 215, 0}, Count{"stack:3", 4, 0},
                    Count{"mass_ratio", 7, 0}, Count{"chain_heavy", 22, 21}, Count{"wall_ball:3", 95, 0},
                    Count{"many_things:3", 28, 0}, Count{"two_spheres", 2, 0}, Count{"sphere_and_box", 2, 0},
                    Count{"two_boxes", 2, 0}, Count{"wrecking_ball:3", 46, 0}, Count{"carpet_bomb:7", 98, 0},
                    Count{"spinning_ball:3", 10, 0}, Count{"rotating_board:3", 10, 0}, Count{"newtons_cradle", 6, 5},
                    Count{"dzhanibekov", 1, 0}, Count{"dominoes:5", 6, 0}, Count{"domino_spiral:9", 10, 0},
                    Count{"brick_tower:3", 45, 1}, Count{"arch:7", 11, 0}, Count{"card_house:3", 16, 0},
                    Count{"ragdoll_avalanche:2", 35, 20}, Count{"bridge:10", 27, 28}, Count{"car", 10, 8},
                    Count{"gear_train:3", 8, 3}, Count{"walker", 75, 109}, Count{"hourglass:50", 53, 0},
                    Count{"marble_machine:9", 15, 0}, Count{"t_handle", 3, 0}, Count{"ten_thousand_boxes", 10005, 0}),
    [](const testing::TestParamInfo<Count>& info) {
        std::string name = info.param.name;
        for (char& c : name)
            if (c == ':') c = '_';
        return name;
    });

// Default sizes, as descriptions only: bodies without counting what a world would do with them.
TEST(Registry, DefaultSizes) {
    const std::pair<const char*, size_t> expected[] = {
        {"large_pyramid", 5051}, {"many_pyramids", 10781},     {"box_pile", 1005},     {"sphere_pile", 4005},
        {"convex_pile", 4005},   {"mixed_pile", 4005},         {"joint_grid", 10000},  {"ragdolls", 1101},
        {"tumbler", 8002},       {"large_world_sleep", 20205}, {"wall_ball", 622},     {"many_things", 3376},
        {"wrecking_ball", 1126}, {"carpet_bomb", 10250},       {"spinning_ball", 122}, {"dominoes", 61}};
    for (auto [name, bodies] : expected) EXPECT_EQ(scenes::describe_scene(name).value().bodies.size(), bodies) << name;
}

}  // namespace
}  // namespace lendulet
