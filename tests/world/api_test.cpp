// The public interface: values and errors, handles, iteration, names, time.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "world/support.h"

namespace lendulet::test {
namespace {

TEST(Api, HelloWorldBouncesAndSettles) {
    World world = WorldBuilder{}.down_gravity(9.81f).friction(0.5f).build().value();
    world.add_static_body({.shape = Box{{10, 0.5f, 10}}, .position = {0, -0.5f, 0}}).value();
    BodyId ball =
        world.add_rigid_body({.shape = Sphere{1}, .position = {0, 10, 0}, .density = 500, .restitution = 0.9f}).value();
    float lowest = 100.0f, second_top = 0.0f;
    for (int i = 0; i < 200; ++i) {
        world.update(1.0f / 60).value();
        lowest = minimum(lowest, world.get(ball).position().y);
        if (i > 120) second_top = maximum(second_top, world.get(ball).position().y);
    }
    // 9 m of fall, 0.81 of it back up.
    EXPECT_NEAR(lowest, 1.0f, 0.25f);
    EXPECT_NEAR(second_top, 1.0f + 0.81f * 9.0f, 0.05f);
    EXPECT_NEAR(world.time(), 200.0 / 60, 1e-5);
    EXPECT_EQ(world.step_count(), 200u);
    EXPECT_EQ(world.check(), "");
}

TEST(Api, ResultHoldsValueOrError) {
    Result<std::string> good(std::string("a value that is too long for the small string buffer"));
    ASSERT_TRUE(good.ok());
    Result<std::string> moved(std::move(good));
    EXPECT_EQ(moved.value().substr(0, 7), "a value");
    Result<std::string> bad(Error{ErrorCode::io, "no such file, and a sentence long enough to need the heap"});
    EXPECT_FALSE(bad);
    moved = std::move(bad);
    ASSERT_FALSE(moved);
    EXPECT_EQ(moved.error().code, ErrorCode::io);
    EXPECT_EQ(std::move(moved).value_or("other"), "other");
    EXPECT_TRUE(Status{}.ok());
    EXPECT_FALSE(Status(Error{ErrorCode::io, "x"}));
}

TEST(ApiDeathTest, ValueOfAnErrorEndsTheProgramWithItsSentence) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    World world = WorldBuilder{}.build().value();
    EXPECT_EXIT(world.add_rigid_body({.shape = Sphere{-1.0f}}).value(), ::testing::ExitedWithCode(2),
                "add_rigid_body.*radius");
    EXPECT_EXIT(world.get(BodyId{}), ::testing::ExitedWithCode(2), "get: body is a null handle");
}

// A view knows its body: after its removal it neither reads nor writes the one that took its place.
TEST(ApiDeathTest, ViewsOfRemovedBodiesEndTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    World world = WorldBuilder{}.no_gravity().build().value();
    const BodyId first = world.add_rigid_body({}).value();
    RigidBodyRef view = world.get(first);
    world.remove_body(first).value();
    const BodyId second = world.add_rigid_body({}).value();
    ASSERT_EQ(second.index, first.index);
    EXPECT_EQ(view.id(), first) << "its id may be asked for, to see whether it is alive";
    EXPECT_EXIT(view.set_velocity({7.0f, 0.0f, 0.0f}).value(), ::testing::ExitedWithCode(2),
                "a view: there is no such body any more");
    EXPECT_EXIT(static_cast<void>(view.position()), ::testing::ExitedWithCode(2), "no such body");
    EXPECT_EXIT(view.set_bullet(true), ::testing::ExitedWithCode(2), "no such body");
}

TEST(ApiDeathTest, CollidersThatABodyHasNotEndTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    World world = WorldBuilder{}.build().value();
    const ColliderDef two[] = {{.shape = Box{}}, {.shape = Sphere{}}};
    const BodyId id = world.add_rigid_body({.colliders = two}).value();
    const RigidBodyRef body = world.get(id);
    EXPECT_EQ(world.body_of(body.collider(1)), id);
    EXPECT_NE(body.collider(1), body.collider(0));
    for (int none : {-1, 2, 7}) {
        EXPECT_FALSE(body.collider(none));
        EXPECT_EXIT(static_cast<void>(body.shape(none)), ::testing::ExitedWithCode(2), "shape: the body has no coll");
        EXPECT_EXIT(static_cast<void>(body.is_trigger(none)), ::testing::ExitedWithCode(2), "it has 2");
    }
}

TEST(ApiDeathTest, WorldsThatWereMovedFromEndTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    World first = WorldBuilder{}.build().value();
    const World second = std::move(first);
    EXPECT_EXIT(first.update(dt).value(), ::testing::ExitedWithCode(2), "this world was moved from");
    EXPECT_EXIT(static_cast<void>(first.body_count()), ::testing::ExitedWithCode(2), "this world was moved from");
    EXPECT_EXIT(static_cast<void>(first.hash()), ::testing::ExitedWithCode(2), "this world was moved from");
}

TEST(Api, WorldsMove) {
    World first = WorldBuilder{}.build().value();
    BodyId ball = first.add_rigid_body({.shape = Sphere{}}).value();
    World second = std::move(first);
    run(second, 5);
    EXPECT_LT(second.get(ball).position().y, 0.0f);
    first = WorldBuilder{}.no_gravity().build().value();
    EXPECT_EQ(first.body_count(), 0);
}

TEST(Ids, NullAndForeignIndicesAreNotAlive) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    EXPECT_FALSE(BodyId{});
    EXPECT_FALSE(world.alive(BodyId{}));
    EXPECT_FALSE(world.alive(BodyId{7, 1}));
    EXPECT_FALSE(world.alive(BodyId{~0u, 1}));
    EXPECT_FALSE(world.alive(JointId{}));
    EXPECT_FALSE(world.alive(ColliderId{}));
    EXPECT_FALSE(world.alive(ColliderId{99, 1}));
    const BodyId cube = add_cube(world, 0.0f, 0);
    const ColliderId collider = world.get(cube).collider();
    EXPECT_TRUE(world.alive(collider));
    EXPECT_FALSE(WorldBuilder{}.build().value().alive(collider));
    world.remove_body(cube).value();
    EXPECT_FALSE(world.alive(collider));
    EXPECT_EQ(world.body_of(ColliderId{}), BodyId{});
    EXPECT_EQ(world.body_of(ColliderId{99, 1}), BodyId{});
    EXPECT_EQ(world.body(-1), BodyId{});
    EXPECT_EQ(world.body(1), BodyId{});
    EXPECT_EQ(world.joint_id(0), JointId{});
    EXPECT_EQ(world.contact(0).point_count, 0);
}

TEST(Ids, RemovedBodyIsRefusedByEveryCallAlsoWhenItsSlotIsUsedAgain) {
    World world = WorldBuilder{}.build().value();
    BodyId old = world.add_rigid_body({.shape = Sphere{}}).value(), other = add_floor(world);
    ColliderId old_collider = world.get(old).collider();
    JointId old_joint = world.add_joint(world.joint_at(JointType::ball, old, other, {}).value()).value();
    run(world, 2);
    world.remove_body(old).value();
    BodyId fresh = world.add_rigid_body({.shape = Box{}}).value();
    EXPECT_EQ(fresh.index, old.index) << "this test wants the slot to be used again";
    EXPECT_NE(fresh, old);
    EXPECT_FALSE(world.alive(old));
    EXPECT_FALSE(world.alive(old_joint));
    EXPECT_TRUE(world.alive(fresh));
    EXPECT_EQ(world.body_of(old_collider), BodyId{});
    EXPECT_EQ(world.body_of(world.get(fresh).collider()), fresh);
    EXPECT_EQ(world.remove_body(old).error().code, ErrorCode::stale_id);
    EXPECT_EQ(world.joint_at(JointType::ball, old, other, {}).error().code, ErrorCode::stale_id);
    EXPECT_EQ(world.joint_at(JointType::ball, fresh, old, {}).error().code, ErrorCode::stale_id);
    JointDef def = world.joint_at(JointType::ball, fresh, other, {}).value();
    def.body_a = old;
    EXPECT_EQ(world.add_joint(def).error().code, ErrorCode::stale_id);
    EXPECT_EQ(world.remove_joint(old_joint).error().code, ErrorCode::stale_id);
    EXPECT_EQ(world.set_motor(old_joint, {}).error().code, ErrorCode::stale_id);
    EXPECT_EQ(world.joint_count(), 0);
    EXPECT_TRUE(world.alive(fresh)) << "no refused call may touch the new owner of the slot";
    run(world, 2);
    EXPECT_EQ(world.check(), "");
}

TEST(Ids, IterationIsInCreationOrder) {
    World world = WorldBuilder{}.build().value();
    std::vector<BodyId> expected;
    for (int i = 0; i < 6; ++i)
        expected.push_back(world.add_rigid_body({.position = {3.0f * static_cast<float>(i), 0.0f, 0.0f}}).value());
    for (int i : {4, 1}) {
        world.remove_body(expected[static_cast<size_t>(i)]).value();
        expected.erase(expected.begin() + i);
    }
    for (int i = 0; i < 3; ++i)
        expected.push_back(world.add_rigid_body({.position = {3.0f * static_cast<float>(i), 9.0f, 0.0f}}).value());
    ASSERT_EQ(world.body_count(), static_cast<int>(expected.size()));
    for (int i = 0; i < world.body_count(); ++i) EXPECT_EQ(world.body(i), expected[static_cast<size_t>(i)]) << i;
}

TEST(Views, UserDataIsSetAndSeenByQueries) {
    World world = WorldBuilder{}.build().value();
    const BodyId ball = world.add_rigid_body({.shape = Sphere{0.5f}, .user_data = 1}).value();
    const BodyId floor = world.add_static_body({.position = {0.0f, -3.0f, 0.0f}}).value();
    const uint64_t hash = world.hash();
    world.set_user_data(ball, ~uint64_t{0}).value();
    world.set_user_data(floor, 5).value();
    EXPECT_EQ(world.get(ball).user_data(), ~uint64_t{0});
    EXPECT_EQ(world.get_static(floor).user_data(), 5u);
    EXPECT_EQ(world.cast_ray({.origin = {0.0f, 1.0f, 0.0f}}).value().body_user_data, ~uint64_t{0});
    EXPECT_EQ(world.hash(), hash);
    world.remove_body(ball).value();
    EXPECT_EQ(world.set_user_data(ball, 2).error().code, ErrorCode::stale_id);
    EXPECT_EQ(World(WorldBuilder{}.build().value()).set_user_data(floor, 2).error().code, ErrorCode::wrong_world);
}

TEST(Views, TellWhatWasGiven) {
    World world = WorldBuilder{}.build().value();
    const Quat turned = rotation_about({0.0f, 1.0f, 0.0f}, 0.5f);
    ColliderDef parts[2];
    parts[0].shape = Box{{0.5f, 0.25f, 0.75f}};
    parts[1].shape = Sphere{0.5f};
    parts[1].local = {{0.0f, 2.0f, 0.0f}, turned};
    BodyId id = world
                    .add_rigid_body({.position = {1.0f, 2.0f, 3.0f},
                                     .orientation = turned,
                                     .colliders = parts,
                                     .user_data = 77,
                                     .name = "part"})
                    .value();
    const RigidBodyRef body = world.get(id);
    EXPECT_EQ(body.id(), id);
    EXPECT_EQ(body.type(), BodyType::dynamic);
    EXPECT_EQ(body.name(), "part");
    EXPECT_EQ(body.user_data(), 77u);
    EXPECT_EQ(body.collider_count(), 2);
    EXPECT_EQ(std::get<Box>(body.shape()).half_extents.z, 0.75f);
    EXPECT_EQ(std::get<Sphere>(body.shape(1)).radius, 0.5f);
    EXPECT_EQ(body.collider_pose(1).translation.y, 2.0f);
    EXPECT_EQ(world.body_of(body.collider(1)), id);
    EXPECT_LT(length(body.position() - Position{1.0f, 2.0f, 3.0f}), 1e-6f);
    EXPECT_NEAR(absolute(dot(body.orientation(), turned)), 1.0f, 1e-6f);
    EXPECT_EQ(body.pose().position, body.position());
    EXPECT_EQ(body.pose().orientation, body.orientation());
    EXPECT_LT(length(body.rotation_matrix().x - rotate(turned, Vec3{1.0f, 0.0f, 0.0f})), 1e-6f);
    // Masses 750 and 523.6 kg: the centre lies between the parts.
    const float ball = 1000.0f * 4.0f / 3.0f * pi * 0.125f;
    EXPECT_NEAR(body.mass(), 750.0f + ball, 0.01f);
    EXPECT_NEAR(body.inverse_mass() * body.mass(), 1.0f, 1e-6f);
    EXPECT_NEAR(body.centre_of_mass().y, 2.0f + 2.0f * ball / (750.0f + ball), 1e-5f);
    EXPECT_NEAR(body.aabb().upper.y, 4.5f, 1e-5f);
    EXPECT_NEAR(body.aabb().lower.y, 1.75f, 1e-5f);
    EXPECT_EQ(world.get_static(id).name(), "part");
    EXPECT_EQ(world.get(world.add_rigid_body({}).value()).name(), "");
}

TEST(Views, LongNamesAreCut) {
    World world = WorldBuilder{}.build().value();
    std::string name(1 << 20, 'x');
    EXPECT_EQ(world.get(world.add_rigid_body({.name = name}).value()).name().size(), 255u);
}

TEST(Api, MovingMeshWarnsAndStaticOneDoesNot) {
    World world = WorldBuilder{}.build().value();
    const Vec3 corners[] = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    TriangleMesh mesh = TriangleMesh::from_triangles(corners, faces).value();
    world.add_static_body({.shape = mesh}).value();
    EXPECT_TRUE(world.warnings().empty());
    world.add_rigid_body({.shape = mesh, .name = "rock"}).value();
    ASSERT_EQ(world.warnings().size(), 1u);
    EXPECT_NE(world.warnings()[0].find("rock"), std::string::npos);
}

TEST(Time, ZeroStepDoesNothing) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    add_stack(world, 0.0f, 3);
    run(world, 10);
    uint64_t before = world.hash();
    world.update(0.0f).value();
    EXPECT_EQ(world.hash(), before);
    EXPECT_EQ(world.step_count(), 10u);
}

TEST(Time, BadStepsAreRefused) {
    World world = WorldBuilder{}.build().value();
    world.add_rigid_body({}).value();
    uint64_t before = world.hash();
    for (float bad : {-1.0f, -1e-30f, std::nanf(""), std::numeric_limits<float>::infinity(), 1001.0f}) {
        Status s = world.update(bad);
        ASSERT_FALSE(s) << bad;
        EXPECT_EQ(s.error().code, ErrorCode::bad_time_step);
        EXPECT_EQ(world.hash(), before);
    }
}

TEST(Time, LongStepsAreCutIntoEqualParts) {
    World whole = WorldBuilder{}.build().value();
    BodyId id = whole.add_rigid_body({.shape = Sphere{}, .velocity = {1.0f, 30.0f, 0.0f}}).value();
    whole.get(id).apply_force({0.0f, 0.0f, 5000.0f}).value();
    whole.update(2.5f).value();
    EXPECT_EQ(whole.step_count(), 3u);
    EXPECT_NEAR(whole.time(), 2.5, 1e-6);
    // A force holds for the whole update, as many parts as it has.
    const RigidBodyRef ball = whole.get(id);
    EXPECT_NEAR(ball.momentum().z, 2.5f * 5000.0f, 0.05f);
    EXPECT_NEAR(ball.position().y, 30.0f * 2.5f - 0.5f * 9.81f * 6.25f, 1e-3f);
    whole.update(2.5f).value();
    EXPECT_NEAR(ball.momentum().z, 2.5f * 5000.0f, 0.05f) << "and no longer";
}

TEST(Names, OfEveryChoiceLeadBackToIt) {
    for (BroadPhaseType t :
         {BroadPhaseType::all_pairs, BroadPhaseType::sweep_1, BroadPhaseType::sweep_3, BroadPhaseType::rtree_quadratic,
          BroadPhaseType::rtree_star, BroadPhaseType::rtree_str, BroadPhaseType::rtree_omt, BroadPhaseType::wide_tree})
        EXPECT_EQ(broad_phase_from_name(name_of(t)).value(), t);
    for (SimplexSolver s : {SimplexSolver::barycentric, SimplexSolver::half_space})
        EXPECT_EQ(simplex_from_name(name_of(s)).value(), s);
    for (Integrator i :
         {Integrator::momentum, Integrator::explicit_euler, Integrator::symplectic_euler, Integrator::runge_kutta_4})
        EXPECT_EQ(integrator_from_name(name_of(i)).value(), i);
    EXPECT_EQ(broad_phase_from_name("octree").error().code, ErrorCode::unknown_name);
    EXPECT_EQ(simplex_from_name("").error().code, ErrorCode::unknown_name);
    EXPECT_EQ(integrator_from_name("Momentum").error().code, ErrorCode::unknown_name);
}

}  // namespace
}  // namespace lendulet::test
