// Nothing passes through anything, however fast it flies or spins: what cases A40 and A41 do not look at.
#include <gtest/gtest.h>

#include "verify/cases/walls.h"
#include "world/support.h"

namespace lendulet::verify {
namespace {

using test::dt;

TEST(Continuous, AtAnyStep) {
    const Frame here{};
    int escaped = 0;
    for (float step : {1.0f / 240.0f, 1.0f / 30.0f, 0.1f, 0.5f})
        for (float speed : {30.0f, 150.0f, 700.0f})
            for (Wall wall : walls) {
                // Seen from 175 m away triangles are hit on edges: where such a ball is thrown to is chance.
                if (wall != Wall::box && speed * step > 300.0f) continue;
                for (float phase : {0.1f, 0.5f, 0.9f})
                    escaped += !held_by_wall(here, {wall, 0.005f, speed, phase, 8, step});
            }
    EXPECT_EQ(escaped, 0);
}

// A body that flies beside an obstacle, and slides over fine triangles, is not held up.
TEST(Continuous, NothingStopsWhatPassesBeside) {
    World world = WorldBuilder().no_gravity().no_friction().sleep(false).build().value();
    world.add_static_body({.shape = wall_shape(Wall::closed_mesh, {0.0005f, 2.0f, 2.0f})}).value();
    BodyId ball =
        world
            .add_rigid_body({.shape = Sphere{0.05f}, .position = {-4.0f, 2.3f, 0.0f}, .velocity = {300.0f, 0.0f, 0.0f}})
            .value();
    world.update(dt).value();
    EXPECT_EQ(world.statistics().stopped_bodies, 0);
    EXPECT_NEAR(world.get(ball).position().x, 1.0f, 1e-4f);
}

TEST(Continuous, SlidingOverAMeshIsUndisturbed) {
    World world = WorldBuilder().no_friction().sleep(false).build().value();
    world.add_static_body({.shape = test::wavy_ground(60, 30.0f, 0.0f)}).value();
    BodyId box = world.add_rigid_body({.shape = Box{{0.1f, 0.05f, 0.1f}}, .position = {-25.0f, 0.05f, 0.3f}}).value();
    advance(world, 30, dt);
    world.get(box).set_velocity({40.0f, 0.0f, 0.0f}).value();
    for (int i = 0; i < 60; ++i) {
        world.update(dt).value();
        EXPECT_EQ(world.statistics().stopped_bodies, 0) << i;
    }
    EXPECT_NEAR(world.get(box).position().x, 15.0f, 0.05f);
    EXPECT_NEAR(world.get(box).velocity().x, 40.0f, 0.04f);
}

// Kinematic bodies push what is in their way in front of them, also thin ones.
TEST(Continuous, NothingPassesThroughWhatIsMoved) {
    int escaped = 0, count = 0;
    for (float speed : {10.0f, 40.0f, 120.0f, 400.0f})
        for (Wall wall : walls)
            for (float phase : {0.1f, 0.4f, 0.7f}) {
                World world = WorldBuilder().no_gravity().sleep(false).build().value();
                BodyId paddle = world
                                    .add_rigid_body({.shape = wall_shape(wall, {0.005f, 1.0f, 1.0f}),
                                                     .position = {-0.3f - phase * speed * dt, 0.0f, 0.0f},
                                                     .velocity = {speed, 0.0f, 0.0f},
                                                     .kinematic = true})
                                    .value();
                BodyId ball = world.add_rigid_body({.shape = Sphere{0.05f}, .position = {0.0f, 0.1f, 0.2f}}).value();
                for (int i = 0; i < 6; ++i) {
                    world.update(dt).value();
                    ++count;
                    if (world.get(ball).position().x < world.get(paddle).position().x) {
                        ++escaped;
                        break;
                    }
                }
            }
    EXPECT_EQ(escaped, 0) << "of " << count;
}

// A turning paddle and fast balls between walls: how obstacles are found, through a list of few or through the broad
// phase, does not show, and nothing passes.
TEST(Continuous, FewObstaclesAndManyGiveTheSame) {
    auto build = [](int far_away) {
        World world = WorldBuilder().no_gravity().sleep(false).bounciness(1.0f).build().value();
        for (float side : {-1.0f, 1.0f}) {
            world.add_static_body({.shape = Box{{0.01f, 3.0f, 3.0f}}, .position = {3.0f * side, 0.0f, 0.0f}}).value();
            world.add_static_body({.shape = Box{{3.0f, 0.01f, 3.0f}}, .position = {0.0f, 3.0f * side, 0.0f}}).value();
            world.add_static_body({.shape = Box{{3.0f, 3.0f, 0.01f}}, .position = {0.0f, 0.0f, 3.0f * side}}).value();
        }
        world
            .add_rigid_body(
                {.shape = Box{{2.0f, 0.01f, 2.0f}}, .angular_velocity = {0.0f, 0.0f, 20.0f}, .kinematic = true})
            .value();
        for (int i = 0; i < 12; ++i) {
            const float x = static_cast<float>(i % 4) - 1.5f, z = static_cast<float>(i / 4) - 1.0f;
            world
                .add_rigid_body({.shape = Sphere{0.1f},
                                 .position = {x, i % 2 ? 1.0f : -1.0f, z},
                                 .velocity = {17.0f * z, 23.0f * x, -11.0f * x}})
                .value();
        }
        for (int i = 0; i < far_away; ++i)
            world
                .add_static_body(
                    {.shape = Box{{0.5f, 0.5f, 0.5f}}, .position = {100.0f + 2.0f * static_cast<float>(i), 0.0f, 0.0f}})
                .value();
        return world;
    };
    World few = build(0), many = build(60);
    int stopped = 0;
    for (int step = 0; step < 120; ++step) {
        few.update(dt).value();
        many.update(dt).value();
        stopped += few.statistics().stopped_bodies;
        EXPECT_EQ(few.statistics().stopped_bodies, many.statistics().stopped_bodies) << step;
    }
    EXPECT_GT(stopped, 0);
    for (int i = 0; i < few.body_count(); ++i) {
        const Position a = few.get_static(few.body(i)).position(), b = many.get_static(many.body(i)).position();
        EXPECT_TRUE(a == b) << i;
        EXPECT_LT(length(from_origin(a)), 3.1f * 1.74f) << i;
    }
}

// Bullets and the bodies they hit: without the flag light thin plates may be passed, with it never.
TEST(Continuous, BulletsMeetMovingBodies) {
    int escaped = 0;
    for (float speed : {50.0f, 200.0f, 800.0f})
        for (float phase : {0.1f, 0.45f, 0.8f})
            for (float towards : {0.0f, -30.0f, 15.0f}) {
                World world = WorldBuilder().no_gravity().sleep(false).build().value();
                BodyId plate = world
                                   .add_rigid_body({.shape = Box{{0.005f, 0.5f, 0.5f}},
                                                    .velocity = {towards, 0.0f, 0.0f},
                                                    .density = 20000.0f})
                                   .value();
                BodyId ball = world
                                  .add_rigid_body({.shape = Capsule{0.02f, 0.02f},
                                                   .position = {-0.2f - phase * speed * dt, 0.1f, 0.1f},
                                                   .velocity = {speed, 0.0f, 0.0f},
                                                   .angular_velocity = {0.0f, 0.0f, 90.0f},
                                                   .density = 500.0f,
                                                   .bullet = true})
                                  .value();
                for (int i = 0; i < 5; ++i) {
                    world.update(dt).value();
                    RigidBodyRef body = world.get(plate);
                    Vec3 local = rotate_inverse(body.orientation(), world.get(ball).position() - body.position());
                    if (local.x > 0.0f) {
                        ++escaped;
                        break;
                    }
                }
            }
    EXPECT_EQ(escaped, 0);
}

// A fan of three blades on a hinge, and a pole between them that they cannot pass.
TEST(Continuous, A41AFanStopsAtAPole) {
    for (float spin : {100.0f, 230.0f, 500.0f}) {
        World world = WorldBuilder().no_gravity().sleep(false).build().value();
        std::vector<ColliderDef> blades;
        for (int i = 0; i < 3; ++i) {
            Quat turn = rotation_about({0.0f, 0.0f, 1.0f}, static_cast<float>(i) * 2.0f * pi / 3.0f);
            blades.push_back({.shape = Box{{0.02f, 0.45f, 0.05f}}, .local = {rotate(turn, {0.0f, 0.5f, 0.0f}), turn}});
        }
        BodyId fan = world.add_rigid_body({.angular_velocity = {0.0f, 0.0f, spin}, .colliders = blades}).value();
        BodyId base = world.add_static_body({.shape = Sphere{0.02f}}).value();
        world
            .add_static_body({.shape = Cylinder{0.5f, 0.02f},
                              .position = {0.6f, 0.0f, 0.0f},
                              .orientation = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi)})
            .value();
        JointDef hinge = world.joint_at(JointType::hinge, base, fan, {}, {0.0f, 0.0f, 1.0f}).value();
        world.add_joint(hinge).value();
        const double energy = world.kinetic_energy();
        float turned = 0.0f;
        Quat before = world.get(fan).orientation();
        for (int i = 0; i < 60; ++i) {
            world.update(dt / 8.0f).value();  // so that less than half a turn goes between two looks
            Quat now = world.get(fan).orientation(), d = now * conjugate(before);
            if (d.w < 0.0f) d = {-d.x, -d.y, -d.z, -d.w};
            turned += 2.0f * arc_tangent2(d.z, d.w);
            before = now;
            EXPECT_LT(absolute(turned), 2.0f * pi / 3.0f) << "spin " << spin << " step " << i;
            EXPECT_LE(world.kinetic_energy(), 1.01 * energy) << "spin " << spin << " step " << i;
        }
    }
}

// The same bits for any number of workers, and nothing to do where nothing is fast.
TEST(Continuous, IsDeterministicAndIdleWhereNothingIsFast) {
    uint64_t hash = 0;
    for (int workers : {1, 2, 5}) {
        World world = WorldBuilder().workers(workers).build().value();
        world
            .add_static_body(
                {.shape = wall_shape(Wall::closed_mesh, {0.0005f, 6.0f, 6.0f}), .position = {3.0f, 0.0f, 0.0f}})
            .value();
        test::add_floor(world);
        for (int i = 0; i < 60; ++i) {
            auto f = static_cast<float>(i);
            world
                .add_rigid_body(
                    {.shape = i % 2 ? Shape{Box{{0.05f, 0.3f, 0.05f}}} : Shape{Sphere{0.08f}},
                     .position = {-1.0f - 0.05f * f, 0.6f + 0.4f * static_cast<float>(i % 8), 0.35f * f - 5.0f},
                     .velocity = {100.0f + 5.0f * f, 0.0f, 0.0f},
                     .angular_velocity = {0.0f, 3.0f * f, 200.0f},
                     .bullet = i % 3 == 0})
                .value();
        }
        int stopped = 0;
        for (int i = 0; i < 30; ++i) world.update(dt).value(), stopped += world.statistics().stopped_bodies;
        EXPECT_GT(stopped, 0);
        if (workers == 1) hash = world.hash();
        EXPECT_EQ(world.hash(), hash) << workers;
    }
    World calm = WorldBuilder().build().value();
    test::add_floor(calm);
    test::add_stack(calm, 0.0f, 5);
    for (int i = 0; i < 60; ++i) {
        calm.update(dt).value();
        EXPECT_EQ(calm.statistics().stopped_bodies, 0);
    }
}

}  // namespace
}  // namespace lendulet::verify
