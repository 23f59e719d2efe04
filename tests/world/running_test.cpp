// Surfaces that run over their bodies (Material::surface_velocity): conveyor belts, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

constexpr float weight = 9.81f;

World make(float friction = 0.5f, int width = 0, int workers = 1) {
    return WorldBuilder{}.down_gravity(weight).friction(friction).width(width).workers(workers).build().value();
}

BodyId add_belt(World& world, Vec3 velocity) {
    return world
        .add_static_body(
            {.shape = Box{{50.0f, 0.5f, 50.0f}}, .position = {0.0f, -0.5f, 0.0f}, .surface_velocity = velocity})
        .value();
}

float x_of(const World& world, BodyId id) { return static_cast<float>(world.get(id).position().x); }

TEST(RunningSurface, ABoxIsCarriedAlong) {
    const float u = 2.0f, mu = 0.5f;
    World world = make(mu);
    add_belt(world, {u, 0.0f, 0.0f});
    BodyId box = test::add_cube(world, 0.0f, 0);
    test::run(world, 15);  // it slides for u / (mu g) = 0.41 s
    EXPECT_NEAR(world.get(box).velocity().x, mu * weight * 15 * dt, 0.02f);
    test::run(world, 45);
    EXPECT_NEAR(world.get(box).velocity().x, u, 1e-3f);
    EXPECT_NEAR(x_of(world, box), u - u * u / (2.0f * mu * weight), 0.02f);
    EXPECT_NEAR(world.get(box).position().y, 0.5f, 2e-3f);
    test::run(world, 120);
    EXPECT_NEAR(x_of(world, box), 3.0f * u - u * u / (2.0f * mu * weight), 0.02f);
    EXPECT_FALSE(world.get(box).asleep());
}

TEST(RunningSurface, ABallRollsAtTwoSeventhsOfIt) {
    World world = make();
    add_belt(world, {0.0f, 0.0f, -3.5f});
    BodyId ball = world.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.0f, 0.5f, 0.0f}}).value();
    test::run(world, 90);
    const RigidBodyRef body = world.get(ball);
    EXPECT_NEAR(body.velocity().z, -1.0f, 2e-3f);
    EXPECT_NEAR(body.velocity_at({body.position().x, 0.0, body.position().z}).z, -3.5f, 5e-3f);
}

// A fast and small one, which turns by a radian in a step, is carried as well: what turns far and touches nothing that
// moves may not gain energy, but from a belt it does.
TEST(RunningSurface, CarriesWhatTurnsFast) {
    World world = make(0.8f);
    const float u = 6.0f;
    add_belt(world, {u, 0.0f, 0.0f});
    BodyId ball = world.add_rigid_body({.shape = Sphere{0.05f}, .position = {0.0f, 0.05f, 0.0f}}).value();
    test::run(world, 30);
    EXPECT_NEAR(world.get(ball).velocity().x, 2.0f / 7.0f * u, 0.01f * u);
}

TEST(RunningSurface, TheBeltsBodyFeelsTheReaction) {
    World world = WorldBuilder{}.down_gravity(weight).friction(0.0f).build().value();
    test::add_floor(world);
    const float u = 1.5f;
    BodyId cart = world
                      .add_rigid_body({.shape = Box{{4.0f, 0.25f, 1.0f}},
                                       .position = {0.0f, 0.25f, 0.0f},
                                       .friction = 1.0f,
                                       .surface_velocity = {u, 0.0f, 0.0f},
                                       .mass = 300.0f})
                      .value();
    BodyId box = world
                     .add_rigid_body({.shape = Box{{0.25f, 0.25f, 0.25f}},
                                      .position = {0.0f, 0.75f, 0.0f},
                                      .friction = 1.0f,
                                      .mass = 100.0f})
                     .value();
    // Its lower side runs over the floor too.
    Material smooth;
    smooth.static_friction = smooth.dynamic_friction = 0.0f;
    smooth.friction_combine = CombineRule::multiply;
    const BodyId floor = world.body(0);
    world.set_material(world.get_static(floor).collider(), smooth).value();
    Material rough = world.get_static(cart).material();
    rough.friction_combine = CombineRule::multiply;
    world.set_material(world.get_static(cart).collider(), rough).value();
    test::run(world, 60);
    EXPECT_NEAR(world.get(box).velocity().x, u * 300.0f / 400.0f, 2e-3f);
    EXPECT_NEAR(world.get(cart).velocity().x, -u * 100.0f / 400.0f, 2e-3f);
    EXPECT_NEAR(world.momentum().linear[0], 0.0, 1e-2);
}

TEST(RunningSurface, OfTwoTheDifferenceCounts) {
    World world = make();
    add_belt(world, {1.0f, 0.0f, 2.0f});
    BodyId box = world
                     .add_rigid_body({.shape = Box{{0.5f, 0.5f, 0.5f}},
                                      .position = {0.0f, 0.5f, 0.0f},
                                      .surface_velocity = {3.0f, 0.0f, 2.0f}})
                     .value();
    test::run(world, 90);
    EXPECT_NEAR(world.get(box).velocity().x, -2.0f, 5e-3f);
    EXPECT_NEAR(world.get(box).velocity().z, 0.0f, 5e-3f);
}

TEST(RunningSurface, TurnsWithItsColliderAndBody) {
    World world = make();
    ColliderDef belt;
    belt.shape = Box{{50.0f, 0.5f, 50.0f}};
    belt.local = {{}, rotation_about({0.0f, 1.0f, 0.0f}, 0.5f * pi)};  // x to -z
    belt.material.surface_velocity = {2.0f, 7.0f, 0.0f};               // 7 out of the plane counts for nothing
    world
        .add_static_body({.position = {0.0f, -0.5f, 0.0f},
                          .orientation = rotation_about({0.0f, 1.0f, 0.0f}, 0.25f * pi),
                          .colliders = {&belt, 1}})
        .value();
    BodyId box = test::add_cube(world, 0.0f, 0);
    test::run(world, 90);
    const Vec3 v = world.get(box).velocity(), along = rotate(rotation_about({0.0f, 1.0f, 0.0f}, 0.75f * pi), {2, 0, 0});
    EXPECT_NEAR(v.x, along.x, 5e-3f);
    EXPECT_NEAR(v.z, along.z, 5e-3f);
    EXPECT_NEAR(v.y, 0.0f, 5e-3f);
}

TEST(RunningSurface, TrianglesHaveTheirOwn) {
    World world = make();
    // Two strips along z: one runs on, one stands.
    const Vec3 v[] = {{-10, 0, -10}, {0, 0, -10}, {10, 0, -10}, {-10, 0, 10}, {0, 0, 10}, {10, 0, 10}};
    const uint32_t triangles[] = {0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5};
    const uint8_t of[] = {0, 0, 1, 1};
    TriangleOptions options;
    options.materials = of;
    Material table[2];
    table[1].surface_velocity = {0.0f, 0.0f, 1.0f};
    ColliderDef floor;
    floor.shape = TriangleMesh::from_triangles(v, triangles, options).value();
    floor.materials = table;
    world.add_static_body({.colliders = {&floor, 1}}).value();
    BodyId still = test::add_cube(world, -5.0f, 0), moved = test::add_cube(world, 5.0f, 0);
    test::run(world, 60);
    EXPECT_NEAR(world.get(still).velocity().z, 0.0f, 1e-3f);
    EXPECT_NEAR(world.get(moved).velocity().z, 1.0f, 1e-3f);
}

TEST(RunningSurface, StartsAndStopsAndWakes) {
    World world = make();
    BodyId belt = add_belt(world, {});
    BodyId box = test::add_cube(world, 0.0f, 0);
    test::run(world, 120);
    ASSERT_TRUE(world.get(box).asleep());
    Material runs;
    runs.surface_velocity = {1.0f, 0.0f, 0.0f};
    world.set_material(world.get_static(belt).collider(), runs).value();
    EXPECT_FALSE(world.get(box).asleep());
    const std::vector<uint8_t> before = world.snapshot();
    test::run(world, 60);
    EXPECT_NEAR(world.get(box).velocity().x, 1.0f, 1e-3f);
    const uint64_t then = world.hash();
    world.set_material(world.get_static(belt).collider(), {}).value();
    test::run(world, 60);
    EXPECT_NEAR(world.get(box).velocity().x, 0.0f, 1e-3f);
    world.restore(before).value();
    EXPECT_EQ(world.get_static(belt).material().surface_velocity, runs.surface_velocity);
    test::run(world, 60);
    EXPECT_EQ(world.hash(), then);
}

// A ball that strikes a belt without having touched it: it leaves with what friction gives in the impact.
TEST(RunningSurface, ImpactsTakeItAlong) {
    for (const float mu : {0.05f, 1.0f}) {
        World world = make(mu);
        const float u = 2.0f, fall = 1.0f, e = 0.6f;
        add_belt(world, {u, 0.0f, 0.0f});
        BodyId ball =
            world.add_rigid_body({.shape = Sphere{0.25f}, .position = {0.0f, 0.25f + fall, 0.0f}, .restitution = e})
                .value();
        test::run(world, 40);  // it strikes after 0.45 s and again after 0.99
        const float sliding = mu * (1.0f + e) * std::sqrt(2.0f * weight * fall), sticking = 2.0f / 7.0f * u;
        EXPECT_NEAR(world.get(ball).velocity().x, std::fmin(sliding, sticking), 0.01f * sticking) << mu;
    }
}

// A belt is a floor seen by who moves along: also to what turns far within a step, whose rows turn with it.
TEST(RunningSurface, IsAFloorSeenFromElsewhere) {
    const float u = 3.0f;
    const Vec3 spins[] = {{0.0f, 25.0f, 0.0f}, {0.0f, 0.0f, -12.0f}, {8.0f, 20.0f, 5.0f}};
    for (const Vec3 spin : spins) {
        Vec3 velocity[2], left[2];
        for (const bool runs : {false, true}) {
            World world = make(0.3f);
            add_belt(world, runs ? Vec3{u, 0.0f, 0.0f} : Vec3{});
            const BodyId box = world
                                   .add_rigid_body({.shape = Box{{0.3f, 0.2f, 0.25f}},
                                                    .position = {0.0f, 0.2f, 0.0f},
                                                    .velocity = {runs ? 0.0f : -u, 0.0f, 0.0f},
                                                    .angular_velocity = spin})
                                   .value();
            for (int i = 0; i < 48; ++i) world.update(1.0f / 240.0f).value();
            velocity[runs] = world.get(box).velocity(), left[runs] = world.get(box).angular_velocity();
        }
        EXPECT_LT(length(velocity[1] - velocity[0] - Vec3{u, 0.0f, 0.0f}), 0.01f * u) << spin.x << " " << spin.y;
        EXPECT_LT(length(left[1] - left[0]), 0.01f * length(spin)) << spin.x << " " << spin.y;
    }
}

World crowd(int width, int workers) {
    World world = make(0.6f, width, workers);
    add_belt(world, {1.0f, 0.0f, 0.5f});
    for (int i = 0; i < 90; ++i) {
        Shape shape = Sphere{0.2f};
        if (i % 3 == 1) shape = Capsule{0.3f, 0.1f};
        if (i % 3 == 2) shape = Box{{0.3f, 0.1f, 0.15f}};
        const float x = 0.5f * static_cast<float>(i % 5), z = 0.5f * static_cast<float>(i / 5 % 5);
        world
            .add_rigid_body({.shape = shape,
                             .position = {x, 0.5f + 0.5f * static_cast<float>(i / 25), z},
                             .angular_velocity = {9.0f, x, -6.0f * z},
                             .restitution = i % 4 == 0 ? 0.5f : 0.0f,
                             .surface_velocity = i % 7 == 0 ? Vec3{0.0f, 2.0f, 1.0f} : Vec3{}})
            .value();
    }
    return world;
}

TEST(RunningSurface, EveryWidthAndNumberOfWorkersGivesTheSameBits) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 3}}) {
        World world = crowd(width, workers);
        test::run(world, 120);
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width << " " << workers;
        EXPECT_TRUE(test::all_finite(world));
    }
}

TEST(RunningSurface, WhatIsNoNumberIsRefused) {
    World world = make();
    BodyId belt = add_belt(world, {1.0f, 0.0f, 0.0f});
    Material bad;
    bad.surface_velocity = {0.0f, std::numeric_limits<float>::infinity(), 0.0f};
    Status refused = world.set_material(world.get_static(belt).collider(), bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_material);
    EXPECT_EQ(world.get_static(belt).material().surface_velocity, (Vec3{1.0f, 0.0f, 0.0f}));
    Result<BodyId> body = world.add_rigid_body({.surface_velocity = {std::nanf(""), 0.0f, 0.0f}});
    ASSERT_FALSE(body);
    EXPECT_EQ(body.error().code, ErrorCode::bad_material);
    EXPECT_EQ(world.body_count(), 1);
}

}  // namespace
}  // namespace lendulet
