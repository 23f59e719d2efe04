// What is changed while the world runs: filters, materials, drag, sleep, joints' bounds; and what of it snapshots hold.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

ErrorCode code_of(const Status& s) { return s.ok() ? ErrorCode::io : s.error().code; }

struct Yard {
    World world = WorldBuilder().build().value();
    BodyId floor = add_floor(world);
    BodyId box = add_cube(world, 0.0f, 0);
    ColliderId floor_collider = world.get_static(floor).collider(), box_collider = world.get(box).collider();
};

constexpr CollisionFilter nobody{2, 0, 0};

TEST(Alter, FilteredOutABoxFallsThroughTheFloor) {
    for (const bool change_floor : {false, true}) {
        Yard y;
        y.world.set_events(y.box_collider, Events::contacts).value();
        run(y.world, 60);
        ASSERT_TRUE(y.world.get(y.box).asleep());
        y.world.set_filter(change_floor ? y.floor_collider : y.box_collider, nobody).value();
        EXPECT_EQ(y.world.get_static(change_floor ? y.floor : y.box).filter().mask, 0u);
        EXPECT_EQ(y.world.contact_count(), 0);
        run(y.world, 1);
        EXPECT_EQ(y.world.contact_ends().size(), 1u);
        run(y.world, 29);
        EXPECT_NEAR(y.world.get(y.box).position().y, 0.5f - 0.5f * 9.81f * 0.25f, 0.01f);
        EXPECT_EQ(y.world.check(), "");
    }
}

// A sleeper that lies in what it does not meet wakes where it does.
TEST(Alter, FilteredInABoxIsPushedOut) {
    for (const bool change_block : {false, true}) {
        Yard y;
        const BodyId block = y.world
                                 .add_static_body({.shape = Box{{0.3f, 0.3f, 0.3f}},
                                                   .position = {0.6f, 0.5f, 0.0f},
                                                   .filter = {2, change_block ? 0 : ~uint64_t{0}, 0}})
                                 .value();
        if (!change_block) y.world.set_filter(y.box_collider, {1, ~uint64_t{2}, 0}).value();
        run(y.world, 60);
        ASSERT_TRUE(y.world.get(y.box).asleep());
        ASSERT_NEAR(y.world.get(y.box).position().x, 0.0f, 1e-3f);
        World fork = y.world.fork().value();  // which has no broad phase yet
        for (World* world : {&y.world, &fork}) {
            const ColliderId other = world->get_static(block).collider();
            world->set_filter(change_block ? other : y.box_collider, {}).value();
            run(*world, 60);
            EXPECT_LT(world->get(y.box).position().x, -0.15f);
            EXPECT_EQ(world->check(), "");
        }
        EXPECT_EQ(fork.hash(), y.world.hash());
    }
}

TEST(Alter, TriggersFollowFilters) {
    World world = WorldBuilder().no_gravity().build().value();
    const ColliderDef zone{.shape = Box{{1.0f, 1.0f, 1.0f}}, .is_trigger = true, .events = Events::contacts};
    const BodyId trigger = world.add_static_body({.colliders = {&zone, 1}}).value();
    const BodyId box = world.add_rigid_body({.shape = Box{}}).value();
    run(world, 1);
    ASSERT_EQ(world.trigger_begins().size(), 1u);
    run(world, 60);
    ASSERT_TRUE(world.get(box).asleep());
    world.set_filter(world.get_static(trigger).collider(), nobody).value();
    EXPECT_EQ(world.overlaps().size(), 1u) << "of the last step";
    run(world, 1);
    EXPECT_EQ(world.trigger_ends().size(), 1u);
    EXPECT_TRUE(world.overlaps().empty());
    world.set_filter(world.get_static(trigger).collider(), {}).value();
    run(world, 1);
    EXPECT_EQ(world.trigger_begins().size(), 1u);
    EXPECT_EQ(world.overlaps().size(), 1u);
}

TEST(Alter, QueriesSeeTheNewFilter) {
    Yard y;
    const Ray down{.origin = {0.0f, 5.0f, 0.0f}, .translation = {0.0f, -10.0f, 0.0f}};
    QueryFilter all;
    all.collision = {1, 1, 0};
    EXPECT_EQ(y.world.cast_ray(down, all).value().body, y.box);
    y.world.set_filter(y.box_collider, {2, ~uint64_t{0}, 0}).value();
    EXPECT_EQ(y.world.cast_ray(down, all).value().body, y.floor);
}

// A box that sleeps on a slope of 30 degrees slides by g (sin - mu cos) when its friction falls.
TEST(Alter, LessFrictionLetsASleeperSlide) {
    for (float mu : {0.0f, 0.2f}) {
        World world = WorldBuilder().friction(0.7f).build().value();
        const float slope = pi / 6.0f;
        const Quat tilt{0.0f, 0.0f, std::sin(0.5f * slope), std::cos(0.5f * slope)};
        world.add_static_body({.shape = Box{{40.0f, 0.5f, 5.0f}}, .orientation = tilt}).value();
        const Vec3 up = rotate(tilt, {0.0f, 1.0f, 0.0f}), along = rotate(tilt, {-1.0f, 0.0f, 0.0f});
        const BodyId box =
            world.add_rigid_body({.shape = Box{{0.5f, 0.2f, 0.5f}}, .position = at(0.7f * up), .orientation = tilt})
                .value();
        run(world, 60);
        ASSERT_TRUE(world.get(box).asleep());
        Material smooth;
        smooth.static_friction = smooth.dynamic_friction = mu;
        world.set_material(world.get(box).collider(), smooth).value();
        EXPECT_EQ(world.get(box).material().static_friction, mu);
        run(world, 60);
        const float expected = 9.81f * (0.5f - 0.5f * (mu + 0.7f) * std::cos(slope));  // the mean of both
        EXPECT_NEAR(dot(world.get(box).velocity(), along), expected, 0.02f * expected) << mu;
    }
}

TEST(Alter, RestitutionOfWhatLies) {
    Yard y;
    const BodyId ball = y.world.add_rigid_body({.shape = Sphere{0.5f}, .position = {4.0f, 3.5f, 0.0f}}).value();
    run(y.world, 30);
    Material rubber;
    rubber.restitution = 0.5f;
    y.world.set_material(y.world.get(ball).collider(), rubber).value();
    float top = 0.0f;
    for (int i = 0; i < 60; ++i) {
        run(y.world, 1);
        if (y.world.get(ball).velocity().y > 0.0f) top = std::max(top, y.world.get(ball).position().y - 0.5f);
    }
    EXPECT_NEAR(top, 0.25f * 3.0f, 0.02f);
}

TEST(Alter, DragAndGravity) {
    World world = WorldBuilder().build().value();
    const BodyId id = world.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.0f, 50.0f, 0.0f}}).value();
    RigidBodyRef body = world.get(id);
    body.set_gravity_factor(0.0f).value();
    body.set_damping(0.7f, 0.3f).value();
    body.set_velocity({2.0f, 0.0f, 0.0f}).value();
    body.set_angular_velocity({0.0f, 1.0f, 0.0f}).value();
    run(world, 60);
    EXPECT_NEAR(world.get(id).velocity().x, 2.0f * std::exp(-0.7f), 1e-3f);
    EXPECT_NEAR(world.get(id).velocity().y, 0.0f, 1e-6f);
    EXPECT_NEAR(world.get(id).angular_velocity().y, std::exp(-0.3f), 1e-3f);
    EXPECT_EQ(world.get(id).linear_damping(), 0.7f);
    EXPECT_EQ(world.get(id).angular_damping(), 0.3f);
    EXPECT_EQ(world.get(id).gravity_factor(), 0.0f);
    const float nan = std::nanf("");
    EXPECT_EQ(code_of(world.get(id).set_damping(-1.0f, 0.0f)), ErrorCode::bad_material);
    EXPECT_EQ(code_of(world.get(id).set_damping(0.0f, nan)), ErrorCode::non_finite);
    EXPECT_EQ(code_of(world.get(id).set_gravity_factor(nan)), ErrorCode::non_finite);
    EXPECT_EQ(world.get(id).linear_damping(), 0.7f);
}

TEST(Alter, SleepAndBullets) {
    Yard y;
    run(y.world, 60);
    RigidBodyRef box = y.world.get(y.box);
    ASSERT_TRUE(box.asleep());
    box.set_allow_sleep(false);
    EXPECT_FALSE(box.asleep());
    EXPECT_FALSE(box.allow_sleep());
    run(y.world, 120);
    EXPECT_FALSE(y.world.get(y.box).asleep());
    y.world.get(y.box).set_allow_sleep(true);
    run(y.world, 60);
    EXPECT_TRUE(y.world.get(y.box).asleep());
    // A shot at a thin plate that is free to move: it goes through unless it is a bullet.
    for (const bool bullet : {false, true}) {
        World world = WorldBuilder().no_gravity().build().value();
        world.add_rigid_body({.shape = Box{{0.005f, 2.0f, 2.0f}}, .position = {10.0f, 0.0f, 0.0f}, .mass = 1000.0f})
            .value();
        const BodyId shot = world
                                .add_rigid_body({.shape = Box{{0.02f, 0.05f, 0.03f}},
                                                 .velocity = {1500.0f, 0.0f, 0.0f},
                                                 .angular_velocity = {200.0f, 450.0f, 350.0f}})
                                .value();
        world.get(shot).set_bullet(bullet);
        EXPECT_EQ(world.get(shot).bullet(), bullet);
        run(world, 10);
        EXPECT_EQ(world.get(shot).position().x < 10.5f, bullet) << world.get(shot).position().x;
    }
}

TEST(Alter, RefusesWhatIsGoneOrElsewhere) {
    Yard y, other;
    const ColliderId elsewhere = other.box_collider;
    EXPECT_EQ(code_of(y.world.set_filter(elsewhere, {})), ErrorCode::wrong_world);
    EXPECT_EQ(code_of(y.world.set_material(elsewhere, {})), ErrorCode::wrong_world);
    EXPECT_EQ(code_of(y.world.set_events(elsewhere, Events::all)), ErrorCode::wrong_world);
    Material bad;
    bad.restitution = 1.5f;
    EXPECT_EQ(code_of(y.world.set_material(y.box_collider, bad)), ErrorCode::bad_material);
    EXPECT_FALSE(y.world.get(y.box).material().restitution.has_value());
    y.world.remove_body(y.box).value();
    EXPECT_EQ(code_of(y.world.set_filter(y.box_collider, {})), ErrorCode::stale_id);
    EXPECT_EQ(code_of(y.world.set_material(y.box_collider, {})), ErrorCode::stale_id);
    EXPECT_EQ(code_of(y.world.set_events(y.box_collider, Events::all)), ErrorCode::stale_id);
}

// What is no value of an enumeration would be refused by restore() in a snapshot of the very world.
TEST(Alter, WhatIsNoneIsRefused) {
    World world = WorldBuilder().build().value();
    const auto events = static_cast<Events>(4);
    Material material;
    material.friction_combine = static_cast<CombineRule>(4);
    EXPECT_EQ(world.add_rigid_body({.events = events}).error().code, ErrorCode::bad_collider);
    const ColliderDef collider{.material = material};
    EXPECT_EQ(world.add_static_body({.colliders = {&collider, 1}}).error().code, ErrorCode::bad_material);
    EXPECT_EQ(world.body_count(), 0);
    const BodyId body = world.add_rigid_body({}).value();
    const ColliderId id = world.get(body).collider();
    EXPECT_EQ(world.set_events(id, events).error().code, ErrorCode::bad_collider);
    EXPECT_EQ(world.set_material(id, material).error().code, ErrorCode::bad_material);
    EXPECT_TRUE(world.restore(world.snapshot()));
}

TEST(Alter, EventsFromNowOn) {
    Yard y;
    run(y.world, 60);
    ASSERT_TRUE(y.world.get(y.box).asleep());
    y.world.set_events(y.floor_collider, Events::contacts).value();
    EXPECT_EQ(y.world.get_static(y.floor).events(), Events::contacts);
    run(y.world, 1);
    EXPECT_EQ(y.world.contact_begins().size(), 1u);  // it touches already
    y.world.set_events(y.floor_collider, Events::none).value();
    y.world.get(y.box).set_pose({0.0f, 9.0f, 0.0f}, {}).value();
    run(y.world, 1);
    EXPECT_TRUE(y.world.contact_ends().empty());
}

// ---------------------------------------------------------------------------------------------------------------------
// Types

TEST(SetType, FallsStopsToAccelerateAndFallsAgain) {
    World world = WorldBuilder().build().value();
    const BodyId id = world
                          .add_rigid_body({.shape = Box{{0.5f, 0.2f, 0.3f}},
                                           .position = {0.0f, 100.0f, 0.0f},
                                           .angular_velocity = {0.0f, 2.0f, 0.0f}})
                          .value();
    const float mass = world.get(id).mass();
    run(world, 60);
    world.get(id).set_type(BodyType::kinematic).value();
    EXPECT_EQ(world.get(id).type(), BodyType::kinematic);
    EXPECT_EQ(world.get(id).inverse_mass(), 0.0f);
    const float height = world.get(id).position().y;
    run(world, 60);
    EXPECT_NEAR(world.get(id).velocity().y, -9.81f, 1e-3f);
    EXPECT_NEAR(world.get(id).position().y, height - 9.81f, 1e-2f);
    EXPECT_NEAR(world.get(id).angular_velocity().y, 2.0f, 1e-4f);
    world.get(id).set_type(BodyType::dynamic).value();
    EXPECT_EQ(world.get(id).mass(), mass);
    run(world, 60);
    EXPECT_NEAR(world.get(id).velocity().y, -2.0f * 9.81f, 1e-2f);
    EXPECT_NEAR(world.get(id).angular_momentum().y, 2.0f / world.get(id).inverse_inertia().yy, 1e-2f * mass);
    EXPECT_EQ(world.check(), "");
}

// What lies on it does not notice, until it is let go; nor do events of contacts.
TEST(SetType, PlatformThatIsLetGo) {
    World world = WorldBuilder().build().value();
    const BodyId floor = add_floor(world);
    const BodyId platform =
        world
            .add_rigid_body(
                {.shape = Box{{1.0f, 0.1f, 1.0f}}, .position = {0.0f, 3.0f, 0.0f}, .events = Events::contacts})
            .value();
    world.get(platform).set_type(BodyType::kinematic).value();
    const BodyId box = world.add_rigid_body({.shape = Box{}, .position = {0.0f, 3.6f, 0.0f}}).value();
    run(world, 60);
    ASSERT_TRUE(world.get(box).asleep());
    EXPECT_NEAR(world.get(platform).position().y, 3.0f, 1e-6f);
    world.get(platform).set_type(BodyType::dynamic).value();
    EXPECT_EQ(world.check(), "");
    run(world, 1);
    EXPECT_TRUE(world.contact_ends().empty() && world.contact_begins().empty());
    EXPECT_FALSE(world.get(box).asleep());
    run(world, 20);
    EXPECT_LT(world.get(box).position().y, 3.3f);
    run(world, 100);
    EXPECT_NEAR(world.get(platform).position().y, 0.1f, 0.01f);
    EXPECT_NEAR(world.get(box).position().y, 0.7f, 0.01f);
    // At rest on the floor it becomes kinematic: that contact ends, the one with the box goes on.
    ASSERT_TRUE(world.get(box).asleep());
    world.get(platform).set_type(BodyType::kinematic).value();
    run(world, 1);
    ASSERT_EQ(world.contact_ends().size(), 1u);
    EXPECT_EQ(world.contact_ends()[0].body_a, floor);
    EXPECT_TRUE(world.contact_begins().empty());
    world.get(platform).set_velocity({0.0f, 1.0f, 0.0f}).value();
    run(world, 60);
    EXPECT_NEAR(world.get(box).position().y, 1.7f, 0.01f);
    EXPECT_EQ(world.check(), "");
}

TEST(SetType, JointsRestBetweenWhatCannotBeMoved) {
    World world = WorldBuilder().build().value();
    const BodyId post = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
    const BodyId rod =
        world.add_rigid_body({.shape = Box{{0.5f, 0.05f, 0.05f}}, .position = {0.6f, 0.0f, 0.0f}}).value();
    const JointId joint =
        world.add_joint(world.joint_at(JointType::hinge, post, rod, {0.1f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}).value())
            .value();
    run(world, 5);
    world.get(rod).set_type(BodyType::kinematic).value();
    world.get(rod).set_velocity({}).value();
    world.get(rod).set_angular_velocity({}).value();
    const float angle = world.joint(joint).position;
    run(world, 60);
    EXPECT_NEAR(world.joint(joint).position, angle, 1e-5f);
    world.get(rod).set_type(BodyType::dynamic).value();
    run(world, 30);
    EXPECT_LT(world.joint(joint).position, angle - 0.5f);
    EXPECT_LT(length(world.joint(joint).linear_error), 1e-3f);
}

TEST(SetType, Refuses) {
    World world = WorldBuilder().build().value();
    const BodyId mover = world.add_rigid_body({.shape = Box{}, .kinematic = true}).value();
    const BodyId box = world.add_rigid_body({.shape = Box{}, .position = {5.0f, 0.0f, 0.0f}}).value();
    EXPECT_TRUE(world.get(mover).set_type(BodyType::kinematic).ok());
    EXPECT_EQ(code_of(world.get(mover).set_type(BodyType::dynamic)), ErrorCode::bad_mass);
    EXPECT_EQ(code_of(world.get(box).set_type(BodyType::fixed)), ErrorCode::bad_collider);
    world.get(box).set_type(BodyType::kinematic).value();
    world.get(box).set_velocity({3e38f, 0.0f, 0.0f}).value();
    EXPECT_EQ(code_of(world.get(box).set_type(BodyType::dynamic)), ErrorCode::non_finite);
    EXPECT_EQ(world.get(box).type(), BodyType::kinematic);
}

// ---------------------------------------------------------------------------------------------------------------------
// Snapshots

// Everything that can be changed is, one thing after another.
struct Changing {
    World world = WorldBuilder().build().value();
    BodyId rod;
    JointId hinge;

    Changing() {
        add_floor(world);
        const BodyId post =
            world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}, .position = {9.0f, 3.0f, 0.0f}}).value();
        add_mixed_pile(world, 2);
        rod = world.add_rigid_body({.shape = Box{{0.5f, 0.1f, 0.1f}}, .position = {0.2f, 7.0f, 0.1f}}).value();
        const BodyId hinged =
            world.add_rigid_body({.shape = Box{{0.5f, 0.05f, 0.05f}}, .position = {9.6f, 3.0f, 0.0f}, .mass = 1.0f})
                .value();
        hinge = world
                    .add_joint(
                        world.joint_at(JointType::hinge, post, hinged, {9.1f, 3.0f, 0.0f}, {0.0f, 0.0f, 1.0f}).value())
                    .value();
    }
    void step(int i) {
        const BodyId some = world.body(3 + i % 7);
        const auto k = static_cast<float>(i % 5);
        if (i % 11 == 2) {
            Material m;
            m.static_friction = m.dynamic_friction = 0.1f * k;
            m.restitution = 0.1f * k;
            if (i % 2 == 0) m.rolling_friction = 0.01f;
            world.set_material(world.get_static(some).collider(), m).value();
        }
        if (i % 13 == 4) world.set_filter(world.get_static(some).collider(), {1, i % 2 ? ~uint64_t{0} : 2u, 0}).value();
        if (i % 9 == 5) world.get(rod).set_damping(0.3f * k, 0.2f * k).value();
        if (i % 17 == 6) world.get(rod).set_gravity_factor(0.5f + 0.2f * k).value();
        if (i % 19 == 7) world.get(rod).set_bullet(i % 2 == 0), world.get(rod).set_allow_sleep(i % 2 == 1);
        if (i % 15 == 8) world.set_limit(hinge, {-0.2f - 0.1f * k, 0.5f}).value();
        if (i % 23 == 9) world.set_events(world.get_static(some).collider(), Events::all).value();
        if (i % 25 == 10) {
            const bool kinematic = i % 2 == 0;
            world.get(rod).set_type(kinematic ? BodyType::kinematic : BodyType::dynamic).value();
        }
        run(world, 1);
    }
};

TEST(Alter, SnapshotsAndForksHoldWhatWasChanged) {
    constexpr int end = 120;
    std::vector<uint64_t> hashes;
    std::vector<size_t> begins;
    Changing original;
    std::vector<std::vector<uint8_t>> snapshots;
    for (int i = 0; i < end; ++i) {
        snapshots.push_back(original.world.snapshot());
        original.step(i);
        hashes.push_back(original.world.hash());
        begins.push_back(original.world.contact_begins().size());
        ASSERT_EQ(original.world.check(), "") << i;
    }
    auto follows = [&](Changing& run, int from) {
        for (int i = from; i < end; ++i) {
            run.step(i);
            ASSERT_EQ(run.world.hash(), hashes[static_cast<size_t>(i)]) << from << " " << i;
            ASSERT_EQ(run.world.contact_begins().size(), begins[static_cast<size_t>(i)]) << from << " " << i;
        }
    };
    for (int from : {0, 7, 28, 61, 90, 110}) {
        const std::vector<uint8_t>& saved = snapshots[static_cast<size_t>(from)];
        original.world.restore(saved).value();  // back from later changes
        EXPECT_EQ(original.world.snapshot(), saved);
        Changing fork;
        fork.world = original.world.fork().value();
        fork.rod = original.rod, fork.hinge = original.hinge;
        follows(original, from);
        follows(fork, from);
        Changing fresh;  // in which nothing was changed
        fresh.world.restore(saved).value();
        follows(fresh, from);
    }
}

}  // namespace
}  // namespace lendulet::test
