// Input that is allowed but absurd: the world stays finite, absurd bodies are reported, and others do not suffer.
#include <gtest/gtest.h>

#include "numbers.h"
#include "scale.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

TEST(Extremes, SpeedsAreCutAndCounted) {
    World world = WorldBuilder{}.no_gravity().build().value();
    BodyId fast = world.add_rigid_body({.shape = Sphere{}, .velocity = {1e6f, 0.0f, 0.0f}}).value();
    BodyId spinning =
        world.add_rigid_body({.shape = Box{}, .position = {0.0f, 9.0f, 0.0f}, .angular_velocity = {0.0f, 1e6f, 0.0f}})
            .value();
    BodyId absurd = world.add_rigid_body({.shape = Sphere{}, .position = {0.0f, 30.0f, 0.0f}}).value();
    world.get(absurd).set_momentum({0.0f, 3e38f, 0.0f}).value();
    world.get(absurd).set_angular_momentum({3e38f, 0.0f, 3e38f}).value();
    run(world, 1);
    EXPECT_EQ(world.statistics().capped_bodies, 3);
    EXPECT_EQ(world.statistics().contained_bodies, 0);
    EXPECT_TRUE(all_finite(world));
    EXPECT_NEAR(length(world.get(fast).velocity()), 1e4f, 1.0f);
    EXPECT_GT(world.get(fast).velocity().x, 0.0f);
    EXPECT_NEAR(length(world.get(spinning).angular_velocity()), 3e3f, 1.0f);
    EXPECT_NEAR(world.get(absurd).velocity().y, 1e4f, 1.0f);
    EXPECT_NEAR(world.get(absurd).position().y, 30.0f + 1e4f * dt, 0.1f) << "moved with the speed it was cut to";
}

TEST(Extremes, HugeForceEndsInTheGreatestSpeed) {
    World world = WorldBuilder{}.no_gravity().build().value();
    BodyId pushed = world.add_rigid_body({.shape = Sphere{}}).value();
    world.get(pushed).apply_force({0.0f, 1e30f, 1e30f}).value();
    world.get(pushed).apply_torque({1e30f, 0.0f, 0.0f}).value();
    run(world, 1);
    EXPECT_EQ(world.statistics().capped_bodies, 1);
    EXPECT_EQ(world.statistics().contained_bodies, 0);
    Vec3 v = world.get(pushed).velocity();
    EXPECT_NEAR(length(v), 1e4f, 1.0f);
    EXPECT_NEAR(v.y, v.z, 1.0f);
    EXPECT_TRUE(all_finite(world));
    run(world, 10);
    EXPECT_TRUE(all_finite(world));
}

// What should drive a body out of numbers: whatever is done to it, those that it touches and all others go on.
TEST(Extremes, OneAbsurdBodyDoesNotPoisonOthers) {
    World alone = WorldBuilder{}.build().value(), together = WorldBuilder{}.build().value();
    BodyId witness[2];
    for (World* world : {&alone, &together}) {
        add_floor(*world);
        witness[world == &together] = add_cube(*world, 10.0f, 0);
        add_stack(*world, 0.0f, 3);
    }
    RigidBodyDef wild{.position = {0.0f, 3.5f, 0.0f}};
    wild.gravity_factor = 1e38f;
    BodyId heavy = together.add_rigid_body(wild).value();
    wild.position.x = 1.0f;
    wild.gravity_factor = -1e38f;
    wild.mass = 1e-9f;
    together.add_rigid_body(wild).value();
    for (int i = 0; i < 60; ++i) {
        together.get(heavy).apply_torque({3e38f, 0.0f, 0.0f}).value();
        run(alone, 1);
        run(together, 1);
        ASSERT_TRUE(all_finite(together)) << "step " << i;
        ASSERT_EQ(together.check(), "") << "step " << i;
    }
    EXPECT_GT(together.statistics().capped_bodies + together.statistics().contained_bodies, 0);
    EXPECT_EQ(together.get(witness[1]).position(), alone.get(witness[0]).position())
        << "a body far away takes no notice";
}

// Some of a heap's bodies have moments of inertia with which no impulse off their centre has a finite answer, and some
// hang on each other.
World broken_heap(uint32_t seed, int width, int workers) {
    RandomNumbers numbers{seed * 7919u + 1u};
    World world = WorldBuilder{}.width(width).workers(workers).build().value();
    world.add_static_body({.shape = Plane{}, .rolling_friction = 0.01f}).value();
    std::vector<BodyId> bodies;
    for (int i = 0; i < 24; ++i) {
        const float size = numbers.in(0.1f, 0.4f);
        RigidBodyDef def{.shape = i % 2 == 0 ? Shape{Box{{size, 0.2f, 0.3f}}} : Shape{Capsule{size, 0.2f}},
                         .position = {numbers.in(-1.5f, 1.5f), numbers.in(0.5f, 2.5f), numbers.in(-1.5f, 1.5f)},
                         .velocity = numbers.vector(3.0f)};
        if (i % 5 == 0) {
            const float moment = i % 2 == 0 ? 1e-30f : 1e-35f;
            def.mass = numbers.in(0.1f, 1e4f);
            def.inertia = SymMat3{moment, moment, moment, 0.0f, 0.0f, 0.0f};
        }
        bodies.push_back(world.add_rigid_body(def).value());
    }
    for (size_t i = 0; i < 3; ++i) {
        BodyId a = bodies[5 * i], b = bodies[5 * i + 7];
        const JointType type = i % 2 == 0 ? JointType::fixed : JointType::six_degrees;
        world.add_joint(world.joint_at(type, a, b, world.get(a).position()).value()).value();
    }
    return world;
}

// How far what is no number comes in the lanes of a step depends on who lies beside whom there: that must not show.
TEST(Extremes, WhatIsPutBackIsTheSameForAllWidthsAndWorkers) {
    for (uint32_t seed = 0; seed < 6; ++seed) {
        World world = broken_heap(seed, 1, 1), others[] = {broken_heap(seed, 4, 1), broken_heap(seed, 16, 2)};
        int put_back = 0;
        for (int step = 0; step < scaled(60, 15); ++step) {
            run(world, 1);
            put_back += world.statistics().contained_bodies;
            ASSERT_TRUE(all_finite(world)) << seed << " step " << step;
            ASSERT_EQ(world.check(), "") << seed << " step " << step;
            const std::vector<uint8_t> state = world.snapshot();
            for (World& other : others) {
                run(other, 1);
                ASSERT_EQ(other.hash(), world.hash()) << seed << " step " << step;
                ASSERT_EQ(other.snapshot(), state) << seed << " step " << step;
                ASSERT_EQ(other.statistics().contained_bodies, world.statistics().contained_bodies);
            }
            ASSERT_TRUE(world.restore(state).ok()) << seed << " step " << step;
        }
        EXPECT_GT(put_back, 0) << seed;
    }
}

// A body that is no number any more takes along what it touches, and nothing that only lies on the same ground; not
// even where it has so many contacts with that that they find no colour.
TEST(Extremes, WhatIsPutBackStaysWithinItsIsland) {
    World alone = WorldBuilder{}.build().value(), beside = broken_heap(1, 0, 1);
    alone.add_static_body({.shape = Plane{}, .rolling_friction = 0.01f}).value();
    std::vector<BodyId> stacks[2];
    for (World* world : {&alone, &beside}) stacks[world == &beside] = add_stack(*world, 10.0f, 4);
    std::vector<ColliderDef> feet;
    for (int i = 0; i < 24; ++i)
        feet.push_back({.shape = Box{{0.1f, 0.1f, 0.1f}}, .local = {{0.3f * static_cast<float>(i), 0.0f, 0.0f}, {}}});
    RigidBodyDef comb{.position = {-12.0f, 0.1f, 5.0f}, .velocity = {0.0f, -2.0f, 0.0f}, .colliders = feet};
    comb.inertia = SymMat3{1e-35f, 1e-35f, 1e-35f, 0.0f, 0.0f, 0.0f};
    beside.add_rigid_body(comb).value();
    int put_back = 0;
    for (int step = 0; step < 60; ++step) {
        run(alone, 1);
        run(beside, 1);
        put_back += beside.statistics().contained_bodies;
        for (size_t i = 0; i < 4; ++i)
            ASSERT_EQ(beside.get(stacks[1][i]).position(), alone.get(stacks[0][i]).position()) << "step " << step;
    }
    EXPECT_GT(put_back, 0);
}

// What held a body is forgotten when that is put back, by rows that a joint keeps as well: else it would be put back
// for ever, long after what made it no number has gone.
TEST(Extremes, WhatIsPutBackIsFreeAgain) {
    for (JointType type : {JointType::ball, JointType::fixed, JointType::hinge}) {
        World world = WorldBuilder{}.build().value();
        BodyId post = world.add_static_body({.shape = Sphere{0.1f}, .position = {0.0f, 5.0f, 0.0f}}).value();
        BodyId good = world.add_rigid_body({.shape = Box{{0.2f, 0.2f, 0.2f}}, .position = {0.0f, 4.0f, 0.0f}}).value();
        world.add_joint(world.joint_at(type, post, good, {0.0f, 5.0f, 0.0f}).value()).value();
        RigidBodyDef def{.shape = Box{{0.2f, 0.2f, 0.2f}}, .position = {0.25f, 4.35f, 0.25f}};
        def.velocity = {0.0f, -20.0f, 0.0f};
        def.inertia = SymMat3{1e-35f, 1e-35f, 1e-35f, 0.0f, 0.0f, 0.0f};
        BodyId bad = world.add_rigid_body(def).value();
        int put_back = 0;
        for (int step = 0; step < 10 && put_back == 0; ++step) {
            run(world, 1);
            put_back = world.statistics().contained_bodies;
        }
        EXPECT_EQ(put_back, 2) << static_cast<int>(type);
        world.get(bad).set_pose({50.0f, 0.0f, 0.0f}, {}).value();
        for (int step = 0; step < 60; ++step) {
            run(world, 1);
            ASSERT_EQ(world.statistics().contained_bodies, 0) << static_cast<int>(type) << " step " << step;
        }
        EXPECT_NEAR(world.get(good).position().y, 4.0f, 1e-3f);
    }
}

TEST(Extremes, TinySteps) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 4);
    run(world, 60);
    for (float step : {1e-3f, 1e-5f, 1e-7f, 1e-9f, 1e-20f, 1e-44f}) {
        Position before = world.get(stack[3]).position();
        run(world, 3, step);
        run(world, 3);
        ASSERT_TRUE(all_finite(world)) << step;
        EXPECT_EQ(world.statistics().contained_bodies, 0) << step;
        EXPECT_LT(length(world.get(stack[3]).position() - before), 0.01f) << step;
        EXPECT_LT(length(world.get(stack[3]).velocity()), 0.1f) << step;
    }
}

TEST(Extremes, LongSteps) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    add_stack(world, 0.0f, 3);
    run(world, 3, 10.0f);
    EXPECT_TRUE(all_finite(world));
    EXPECT_EQ(world.step_count(), 30u);
    EXPECT_EQ(world.check(), "");
}

// In a substep of 1/8 s it turns by hundreds of radians about its axis, and so does that about L.
TEST(Extremes, ATopTurnsByHundredsOfRadiansInASubstep) {
    World world = WorldBuilder{}.no_gravity().build().value();
    const BodyId id =
        world.add_rigid_body({.shape = Capsule{0.5f, 0.05f}, .angular_velocity = {1500.0f, 2000.0f, 1000.0f}}).value();
    const Vec3 L = world.get(id).angular_momentum();
    run(world, 5, 1.0f);
    EXPECT_TRUE(all_finite(world));
    EXPECT_EQ(world.statistics().contained_bodies, 0);
    EXPECT_EQ(world.get(id).angular_momentum(), L);
}

TEST(Extremes, StrongGravity) {
    World world = WorldBuilder{}.down_gravity(1e6f).build().value();
    add_floor(world);
    add_stack(world, 0.0f, 3);
    run(world, 60);
    EXPECT_TRUE(all_finite(world));
    EXPECT_EQ(world.check(), "");
}

TEST(Extremes, TwoBodiesAtTheSamePlaceComeApart) {
    const Shape shapes[] = {Box{}, Sphere{}, Capsule{}, Cylinder{}, Cone{}, octahedron(0.5f)};
    for (const Shape& shape : shapes) {
        World world = WorldBuilder{}.no_gravity().build().value();
        BodyId a = world.add_rigid_body({.shape = shape}).value(), b = world.add_rigid_body({.shape = shape}).value();
        float fastest = 0.0f;
        for (int i = 0; i < 90; ++i) {
            run(world, 1);
            fastest = maximum(fastest, maximum(length(world.get(a).velocity()), length(world.get(b).velocity())));
        }
        EXPECT_TRUE(all_finite(world)) << shape.index();
        EXPECT_GT(length(world.get(b).position() - world.get(a).position()), 0.4f) << shape.index();
        EXPECT_LT(fastest, 3.5f) << shape.index() << ": faster than the separation speed";
        EXPECT_LT(world.statistics().max_penetration, 0.02f) << shape.index();
    }
}

TEST(Extremes, AThousandBodiesAtOnePoint) {
    const int n = scaled(1000, 100);
    World world = WorldBuilder{}.no_gravity().solver_steps(1).build().value();
    for (int i = 0; i < n; ++i) world.add_rigid_body({.shape = Sphere{0.5f}}).value();
    run(world, 1);
    EXPECT_EQ(world.statistics().pairs, n * (n - 1) / 2);
    run(world, 1);
    EXPECT_TRUE(all_finite(world));
    EXPECT_EQ(world.statistics().contained_bodies, 0);
    EXPECT_EQ(world.check(), "");
}

TEST(Extremes, FarFromTheOrigin) {
    World world = WorldBuilder{}.build().value();
    const float far = 1e6f;  // positions resolve 1/16 m here
    world.add_static_body({.shape = Box{{20.0f, 0.5f, 20.0f}}, .position = {far, -0.5f, -far}}).value();
    BodyId box = world.add_rigid_body({.position = {far, 0.5f, -far}}).value();
    run(world, 120);
    EXPECT_TRUE(all_finite(world));
    EXPECT_NEAR(world.get(box).position().y, 0.5f, 0.01f);
    EXPECT_NEAR(world.get(box).position().x, far, 0.25f);
}

TEST(Extremes, SmallBodies) {
    World world = WorldBuilder{}.build().value();
    world.add_static_body({.shape = Plane{}}).value();
    const float s = 1e-3f;
    const Shape shapes[] = {Box{{s, s, s}}, Sphere{s}, Capsule{s, s}, Cylinder{s, s}, octahedron(2.0f * s)};
    std::vector<BodyId> bodies;
    for (const Shape& shape : shapes)
        bodies.push_back(
            world.add_rigid_body({.shape = shape, .position = {0.1f * static_cast<float>(bodies.size()), 0.01f, 0.0f}})
                .value());
    run(world, 240);
    EXPECT_TRUE(all_finite(world));
    for (BodyId id : bodies) {
        EXPECT_GT(world.get(id).position().y, 0.5f * s) << id.index;
        EXPECT_LT(world.get(id).position().y, 3.0f * s) << id.index;
        EXPECT_LT(length(world.get(id).velocity()), 0.05f) << id.index;
    }
}

TEST(Extremes, HugeBodiesKeepTheirAngularMomentum) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyDef def{.shape = Box{{5000.0f, 2000.0f, 1000.0f}}, .angular_velocity = {0.1f, 2.0f, 0.3f}};
    def.mass = 1e12f;
    BodyId id = world.add_rigid_body(def).value();
    Vec3 L = world.get(id).angular_momentum();
    run(world, 60);
    EXPECT_EQ(world.statistics().contained_bodies, 0);
    EXPECT_EQ(world.get(id).angular_momentum(), L);
}

}  // namespace
}  // namespace lendulet::test
