// Forks: a second world with the same future, until something is done to one of the two.
#include <gtest/gtest.h>

#include <string>

#include "scenes/scene.h"

namespace lendulet {
namespace {

void step(World& world, const Scene& scene, int count) {
    for (int i = 0; i < count; ++i) {
        if (scene.before_step) scene.before_step(world, static_cast<int>(world.step_count()));
        world.update(scene.dt).value();
    }
}

class Forks : public testing::TestWithParam<const char*> {};

TEST_P(Forks, HaveTheSameFuture) {
    Scene scene = build_scene(GetParam()).value();
    for (int before : {0, 7, 60}) {
        step(scene.world, scene, before);
        World fork = scene.world.fork().value();
        EXPECT_EQ(fork.hash(), scene.world.hash());
        EXPECT_EQ(fork.snapshot(), scene.world.snapshot());
        EXPECT_EQ(fork.check(), "");
        step(fork, scene, 50);
        step(scene.world, scene, 50);
        EXPECT_EQ(fork.hash(), scene.world.hash()) << GetParam() << " forked after " << before;
        EXPECT_EQ(fork.check(), "");
        EXPECT_EQ(fork.contact_count(), scene.world.contact_count());
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Forks,
                         testing::Values("box_pile:60", "mixed_pile:60", "ragdolls:2", "mesh_terrain:30", "tumbler:3",
                                         "newtons_cradle", "stack:12", "large_world_sleep:40", "bridge:8"),
                         [](const testing::TestParamInfo<const char*>& info) {
                             std::string name = info.param;
                             for (char& c : name)
                                 if (c == ':') c = '_';
                             return name;
                         });

TEST(Fork, KnowsTheHandlesAndGoesItsOwnWay) {
    Scene scene = build_scene("stack:5").value();
    step(scene.world, scene, 10);
    BodyId top = scene.world.body(5);
    World fork = scene.world.fork().value();
    ASSERT_TRUE(fork.alive(top));
    fork.get(top).set_velocity({3.0f, 2.0f, 0.0f}).value();
    step(fork, scene, 30);
    const Position there = fork.get(top).position();
    const uint64_t alone = [&] {
        World other = scene.world.fork().value();
        step(other, scene, 30);
        return other.hash();
    }();
    step(scene.world, scene, 30);
    EXPECT_EQ(scene.world.hash(), alone);
    EXPECT_GT(there.x - scene.world.get(top).position().x, 0.5f);
    // What is added to one of them is not in the other.
    BodyId late = fork.add_rigid_body({.position = {4.0f, 4.0f, 0.0f}}).value();
    EXPECT_FALSE(scene.world.alive(late));
    fork.remove_body(top).value();
    EXPECT_TRUE(scene.world.alive(top));
    EXPECT_EQ(fork.check(), "");
}

TEST(Fork, OutlivesTheWorld) {
    Scene scene = build_scene("convex_pile:20").value();
    step(scene.world, scene, 20);
    World fork = scene.world.fork().value();
    step(scene.world, scene, 20);
    const uint64_t expected = scene.world.hash();
    scene.world = WorldBuilder{}.build().value();
    Scene plain = build_scene("stack:1").value();
    step(fork, plain, 20);
    EXPECT_EQ(fork.hash(), expected);
}

TEST(Fork, TakesOtherSettings) {
    Scene scene = build_scene("mixed_pile:40").value();
    step(scene.world, scene, 40);
    WorldConfig config = scene.world.config();
    // No result depends on these.
    config.workers = 3;
    config.width = 1;
    config.broad_phase = BroadPhaseType::sweep_1;
    World same = scene.world.fork(config).value();
    // ... and on these it does.
    config.solver_steps = 2;
    config.gravity = {0.0f, 1.0f, 0.0f};
    World other = scene.world.fork(config).value();
    EXPECT_EQ(other.config().solver_steps, 2);
    step(same, scene, 40);
    step(other, scene, 40);
    step(scene.world, scene, 40);
    EXPECT_EQ(same.hash(), scene.world.hash());
    EXPECT_NE(other.hash(), scene.world.hash());
    config.solver_steps = 0;
    Result<World> refused = scene.world.fork(config);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_config);
}

// A box on a slope holds by the default friction and slides once that is gone; what has friction of its own stays.
TEST(Fork, DefaultFrictionReachesWhatWasGivenNone) {
    World world = WorldBuilder{}.friction(0.9f).build().value();
    const Quat slope = rotation_about({0.0f, 0.0f, 1.0f}, -0.4f);
    world
        .add_static_body({.shape = Box{{20.0f, 1.0f, 20.0f}},
                          .position = Position{} + rotate(slope, Vec3{0.0f, -1.0f, 0.0f}),
                          .orientation = slope})
        .value();
    auto box = [&](float z, std::optional<float> friction) {
        return world
            .add_rigid_body({.shape = Box{{0.5f, 0.5f, 0.5f}},
                             .position = Position{} + rotate(slope, Vec3{0.0f, 0.5f, z}),
                             .orientation = slope,
                             .friction = friction})
            .value();
    };
    BodyId plain = box(-3.0f, {}), rough = box(3.0f, 2.0f);
    for (int i = 0; i < 60; ++i) world.update(1.0f / 60.0f).value();
    const float held = world.get(plain).position().x;
    EXPECT_NEAR(held, 0.2f, 0.1f);
    WorldConfig config = world.config();
    config.friction = 0.0f;
    config.allow_sleep = false;
    World icy = world.fork(config).value();
    for (int i = 0; i < 60; ++i) icy.update(1.0f / 60.0f).value();
    EXPECT_GT(icy.get(plain).position().x, held + 0.5f);
    EXPECT_NEAR(icy.get(rough).position().x, world.get(rough).position().x, 0.02f);
}

TEST(Structures, IslandsColoursAndJointDefinitions) {
    Scene scene = build_scene("ragdolls:2").value();
    step(scene.world, scene, 90);
    World& world = scene.world;
    const std::vector<int> colours = world.contact_colours();
    ASSERT_EQ(static_cast<int>(colours.size()), world.contact_count());
    // Contacts of one colour share no body that moves.
    for (size_t i = 0; i < colours.size(); ++i)
        for (size_t j = 0; j < i; ++j) {
            if (colours[i] != colours[j] || colours[i] < 0) continue;
            const Contact a = world.contact(static_cast<int>(i)), b = world.contact(static_cast<int>(j));
            for (BodyId x : {a.body_a, a.body_b})
                for (BodyId y : {b.body_a, b.body_b}) {
                    if (x != y) continue;
                    EXPECT_NE(world.get_static(x).type(), BodyType::dynamic) << i << ' ' << j;
                }
        }
    EXPECT_EQ(world.island(world.body(0)), -1) << "the ground";
    for (int i = 0; i < world.joint_count(); ++i) {
        const JointDef def = world.joint_def(world.joint_id(i));
        EXPECT_EQ(world.island(def.body_a), world.island(def.body_b)) << i;
        // The two frames are in one place, but for what the solver leaves open.
        auto at = [&](BodyId id, const Transform& frame) {
            StaticBodyRef body = world.get_static(id);
            return body.position() + rotate(body.orientation(), frame.translation);
        };
        EXPECT_LT(length(at(def.body_a, def.frame_a) - at(def.body_b, def.frame_b)), 0.02f) << i;
    }
    EXPECT_EQ(world.joint_def(world.joint_id(0)).type, JointType::ball);
    EXPECT_FLOAT_EQ(world.joint_def(world.joint_id(0)).swing_limit, 0.5f);
}

}  // namespace
}  // namespace lendulet
