// Static bodies that are put elsewhere, and bodies whose mass is set, while the world runs.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

ErrorCode refusal_of(const Status& s) { return s.ok() ? ErrorCode::io : s.error().code; }

// A cube that sleeps on a table 1 m above the floor.
struct Table {
    World world;
    BodyId floor, table, cube;
    Quat level{};
};
Table table(BroadPhaseType type = BroadPhaseType::wide_tree, int workers = 1) {
    World world = WorldBuilder{}.broad_phase(type).workers(workers).build().value();
    const BodyId floor = add_floor(world);
    const BodyId top =
        world.add_static_body({.shape = Box{{1.0f, 0.1f, 1.0f}}, .position = {0.0f, 0.9f, 0.0f}, .events = Events::all})
            .value();
    const BodyId cube = world.add_rigid_body({.shape = Box{}, .position = {0.0f, 1.5f, 0.0f}}).value();
    run(world, 120);
    return {std::move(world), floor, top, cube};
}

TEST(MovedStaticBody, LetsFallWhatRestedOnIt) {
    for (BroadPhaseType type :
         {BroadPhaseType::wide_tree, BroadPhaseType::all_pairs, BroadPhaseType::sweep_1, BroadPhaseType::rtree_star}) {
        Table t = table(type);
        ASSERT_TRUE(t.world.get(t.cube).asleep());
        t.world.set_pose(t.table, {10.0f, 0.9f, 0.0f}, t.level).value();
        EXPECT_FALSE(t.world.get(t.cube).asleep());
        EXPECT_EQ(t.world.get_static(t.table).position().x, 10.0f);
        run(t.world, 1);
        ASSERT_EQ(t.world.contact_ends().size(), 1u);
        EXPECT_EQ(t.world.check(), "");
        run(t.world, 119);
        EXPECT_NEAR(t.world.get(t.cube).position().y, 0.5f, 0.01f) << static_cast<int>(type);
        // What comes there now lands on it, and rays find it there.
        t.world.get(t.cube).set_pose({10.0f, 1.6f, 0.0f}, t.level).value();
        run(t.world, 60);
        EXPECT_NEAR(t.world.get(t.cube).position().y, 1.5f, 0.01f) << static_cast<int>(type);
        EXPECT_EQ(t.world.cast_ray({{10.0f, 0.5f, 0.0f}, {0.0f, 5.0f, 0.0f}}).value().body, t.table);
        EXPECT_FALSE(t.world.cast_ray_any({{0.0f, 0.5f, 0.0f}, {0.0f, 5.0f, 0.0f}}).value());
        EXPECT_EQ(t.world.check(), "");
    }
}

TEST(MovedStaticBody, WakesAndPushesOutWhatItComesInto) {
    Table t = table();
    t.world.set_pose(t.table, {0.0f, 1.0f, 0.0f}, t.level).value();  // 10 cm into the cube
    EXPECT_FALSE(t.world.get(t.cube).asleep());
    run(t.world, 180);
    EXPECT_NEAR(t.world.get(t.cube).position().y, 1.6f, 0.01f);
    EXPECT_TRUE(t.world.get(t.cube).asleep());
    // Another sleeper that it had nothing to do with.
    const BodyId other = add_cube(t.world, 5.0f, 0);
    run(t.world, 120);
    ASSERT_TRUE(t.world.get(other).asleep());
    t.world.set_pose(t.table, {6.3f, 0.5f, 0.0f}, t.level).value();
    EXPECT_FALSE(t.world.get(other).asleep());
    run(t.world, 120);
    EXPECT_LT(t.world.get(other).position().x, 4.81f);
    EXPECT_EQ(t.world.check(), "");
}

TEST(MovedStaticBody, TakesTheAnchorOfItsJointsAlong) {
    World world = WorldBuilder{}.build().value();
    const BodyId hook = world.add_static_body({.shape = Sphere{0.1f}, .position = {0.0f, 5.0f, 0.0f}}).value();
    const BodyId load = world.add_rigid_body({.shape = Sphere{0.2f}, .position = {0.0f, 3.0f, 0.0f}}).value();
    world.add_joint({.type = JointType::distance, .body_a = hook, .body_b = load, .limit = {2.0f, 2.0f}}).value();
    run(world, 120);
    ASSERT_TRUE(world.get(load).asleep());
    world.set_pose(hook, {0.0f, 5.2f, 0.0f}, {}).value();
    EXPECT_FALSE(world.get(load).asleep());
    run(world, 240);
    EXPECT_NEAR(world.get(load).position().y, 3.2f, 0.01f);
}

TEST(MovedStaticBody, IsRefusedWhereItCannotBe) {
    Table t = table();
    const uint64_t hash = t.world.hash();
    EXPECT_EQ(refusal_of(t.world.set_pose(t.table, {std::nanf(""), 0.0f, 0.0f}, t.level)), ErrorCode::non_finite);
    EXPECT_EQ(refusal_of(t.world.set_pose(t.table, {1e8f, 0.0f, 0.0f}, t.level)), ErrorCode::out_of_world);
    EXPECT_EQ(refusal_of(t.world.set_pose(t.table, {}, {0.0f, 0.0f, 0.0f, 2.0f})), ErrorCode::bad_rotation);
    EXPECT_EQ(refusal_of(t.world.set_pose({}, {}, t.level)), ErrorCode::stale_id);
    World other = WorldBuilder{}.build().value();
    EXPECT_EQ(refusal_of(other.set_pose(t.table, {}, t.level)), ErrorCode::wrong_world);
    EXPECT_EQ(t.world.hash(), hash);
    EXPECT_TRUE(t.world.get(t.cube).asleep());
    EXPECT_EQ(t.world.get_static(t.table).position().y, 0.9f);
    t.world.set_pose(t.cube, {0.0f, 3.0f, 0.0f}, t.level).value();  // of those that move too
    EXPECT_EQ(t.world.get(t.cube).position().y, 3.0f);
    t.world.remove_body(t.table).value();
    EXPECT_EQ(refusal_of(t.world.set_pose(t.table, {}, t.level)), ErrorCode::stale_id);
}

TEST(MovedStaticBody, GoesBackWithSnapshotsAndForks) {
    Table t = table();
    const std::vector<uint8_t> at_rest = t.world.snapshot();
    t.world.set_pose(t.table, {0.5f, 1.2f, 0.0f}, rotation_about({0.0f, 0.0f, 1.0f}, 0.3f)).value();
    const std::vector<uint8_t> at_once = t.world.snapshot();
    run(t.world, 10);
    const std::vector<uint8_t> moved = t.world.snapshot();
    World fork = t.world.fork().value();
    run(t.world, 60);
    run(fork, 60);
    const uint64_t expected = t.world.hash();
    EXPECT_EQ(fork.hash(), expected);

    t.world.restore(at_rest).value();
    EXPECT_EQ(t.world.snapshot(), at_rest);
    EXPECT_EQ(t.world.get_static(t.table).position().y, 0.9f);
    EXPECT_TRUE(t.world.cast_ray_any({{-0.9f, 0.5f, 0.0f}, {0.0f, 0.6f, 0.0f}}).value());
    run(t.world, 60);
    EXPECT_NEAR(t.world.get(t.cube).position().y, 1.5f, 0.01f);
    EXPECT_EQ(t.world.check(), "");

    t.world.restore(moved).value();
    EXPECT_EQ(t.world.snapshot(), moved);
    run(t.world, 60);
    EXPECT_EQ(t.world.hash(), expected);
    EXPECT_EQ(t.world.check(), "");
    t.world.restore(at_once).value();
    run(t.world, 70);
    EXPECT_EQ(t.world.hash(), expected) << "between the call and the step";
    // A world that was built alike gets it moved.
    Table other = table(BroadPhaseType::sweep_1, 2);
    other.world.restore(moved).value();
    EXPECT_NEAR(other.world.get_static(other.table).position().y, 1.2f, 0.0f);
    run(other.world, 60);
    EXPECT_EQ(other.world.hash(), expected);
}

TEST(MovedStaticBody, AgainAndAgainAmongManyGivesTheSameBits) {
    uint64_t expected = 0;
    for (BroadPhaseType type : {BroadPhaseType::wide_tree, BroadPhaseType::all_pairs, BroadPhaseType::rtree_omt})
        for (int workers : {1, 3}) {
            World world = WorldBuilder{}.broad_phase(type).workers(workers).build().value();
            add_bowl(world);
            const BodyId stone =
                world.add_static_body({.shape = Box{{0.6f, 0.6f, 0.6f}}, .position = {0.0f, 0.5f, 0.0f}}).value();
            for (int i = 0; i < 40; ++i)
                world
                    .add_rigid_body({.shape = Box{{0.3f, 0.3f, 0.3f}},
                                     .position = {static_cast<float>(i % 4) - 1.5f, 1.5f + 0.5f * static_cast<float>(i),
                                                  0.3f * static_cast<float>(i % 3)}})
                    .value();
            for (int k = 0; k < 12; ++k) {
                run(world, 15);
                const float x = static_cast<float>(k % 3) - 1.0f, z = static_cast<float>(k % 4) - 1.5f;
                world.set_pose(stone, {x, 0.5f, z}, rotation_about({0.0f, 1.0f, 0.0f}, static_cast<float>(k))).value();
                ASSERT_EQ(world.check(), "");
            }
            run(world, 15);
            EXPECT_EQ(world.check(), "");
            if (expected == 0) expected = world.hash();
            EXPECT_EQ(world.hash(), expected) << static_cast<int>(type);
        }
}

TEST(SetMass, KeepsVelocitiesAndScalesInertia) {
    World world = WorldBuilder{}.no_gravity().build().value();
    const Vec3 v{1.0f, 2.0f, -0.5f}, w{0.0f, 3.0f, 0.0f};
    const BodyId id =
        world.add_rigid_body({.shape = Box{{0.5f, 0.2f, 0.3f}}, .velocity = v, .angular_velocity = w, .mass = 6.0f})
            .value();
    const float inertia = world.get(id).inverse_inertia().yy;
    world.get(id).set_mass(24.0f).value();
    EXPECT_EQ(world.get(id).mass(), 24.0f);
    EXPECT_FLOAT_EQ(world.get(id).inverse_inertia().yy, inertia / 4.0f);
    EXPECT_NEAR(length(world.get(id).velocity() - v), 0.0f, 1e-6f);
    EXPECT_NEAR(length(world.get(id).angular_velocity() - w), 0.0f, 1e-6f);
    EXPECT_NEAR(world.get(id).momentum().y, 48.0f, 1e-5f);
    world.get(id).apply_impulse({24.0f, 0.0f, 0.0f}).value();
    EXPECT_NEAR(world.get(id).velocity().x, 2.0f, 1e-6f);
    world.get(id).set_mass(6.0f).value();
    EXPECT_EQ(world.get(id).inverse_inertia().yy, inertia) << "as it was, to the last bit";
    world.get(id).set_type(BodyType::kinematic).value();
    world.get(id).set_mass(12.0f).value();
    world.get(id).set_type(BodyType::dynamic).value();
    EXPECT_EQ(world.get(id).mass(), 12.0f);
    EXPECT_FLOAT_EQ(world.get(id).inverse_inertia().yy, inertia / 2.0f);
}

// A seesaw that sleeps in balance.
TEST(SetMass, WakesWhatIsInBalance) {
    World world = WorldBuilder{}.build().value();
    const BodyId post = world.add_static_body({.shape = Sphere{0.05f}, .position = {0.0f, 1.0f, 0.0f}}).value();
    const BodyId beam =
        world.add_rigid_body({.shape = Box{{2.0f, 0.05f, 0.2f}}, .position = {0.0f, 1.0f, 0.0f}}).value();
    world.add_joint(world.joint_at(JointType::hinge, post, beam, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}).value())
        .value();
    BodyId loads[2];
    for (int i = 0; i < 2; ++i)
        loads[i] =
            world
                .add_rigid_body(
                    {.shape = Box{{0.2f, 0.2f, 0.2f}}, .position = {i == 0 ? -1.5f : 1.5f, 1.25f, 0.0f}, .mass = 50.0f})
                .value();
    run(world, 180);
    ASSERT_TRUE(world.get(beam).asleep());
    world.get(loads[1]).set_mass(60.0f).value();
    EXPECT_FALSE(world.get(beam).asleep());
    run(world, 60);
    EXPECT_LT(world.get(loads[1]).position().y, 1.1f);
}

TEST(SetMass, IsRefusedWhereItCannotBe) {
    World world = WorldBuilder{}.build().value();
    const BodyId ball = world.add_rigid_body({.shape = Sphere{0.5f}, .velocity = {1e30f, 0.0f, 0.0f}}).value();
    const BodyId lift =
        world.add_rigid_body({.shape = Box{}, .position = {5.0f, 0.0f, 0.0f}, .kinematic = true}).value();
    const float mass = world.get(ball).mass();
    for (float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 1e12f})
        EXPECT_EQ(refusal_of(world.get(ball).set_mass(bad)), ErrorCode::non_finite);
    for (float bad : {0.0f, -1.0f, 2e12f, 1e-10f})
        EXPECT_EQ(refusal_of(world.get(ball).set_mass(bad)), ErrorCode::bad_mass);
    EXPECT_EQ(refusal_of(world.get(lift).set_mass(1.0f)), ErrorCode::bad_mass);
    EXPECT_EQ(world.get(ball).mass(), mass);
    const BodyId speck =
        world.add_rigid_body({.shape = Sphere{}, .mass = 1.0f, .inertia = SymMat3{1e-30f, 1e-30f, 1e-30f}}).value();
    EXPECT_EQ(refusal_of(world.get(speck).set_mass(1e-9f)), ErrorCode::bad_inertia);
    EXPECT_EQ(world.get(speck).mass(), 1.0f);
}

TEST(SetMass, IsInSnapshotsAndForks) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    const std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    run(world, 60);
    const std::vector<uint8_t> before = world.snapshot();
    world.get(stack[2]).set_mass(4000.0f).value();
    run(world, 5);
    const std::vector<uint8_t> after = world.snapshot();
    World fork = world.fork().value();
    run(world, 30);
    run(fork, 30);
    const uint64_t expected = world.hash();
    EXPECT_EQ(fork.hash(), expected);
    fork.restore(before).value();
    EXPECT_EQ(fork.get(stack[2]).mass(), 1000.0f);
    EXPECT_EQ(fork.snapshot(), before);
    fork.restore(after).value();
    EXPECT_EQ(fork.get(stack[2]).mass(), 4000.0f);
    EXPECT_EQ(fork.snapshot(), after);
    run(fork, 30);
    EXPECT_EQ(fork.hash(), expected);
    EXPECT_EQ(fork.check(), "");
}

}  // namespace
}  // namespace lendulet::test
