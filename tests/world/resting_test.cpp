// Bodies at rest: what stays to be read of them, that waking goes on where sleep began, and that no way of touching
// them is missed.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "world/support.h"

namespace lendulet::test {
namespace {

bool all_asleep(const World& world) {
    for (int i = 0; i < world.body_count(); ++i) {
        BodyId id = world.body(i);
        if (world.get_static(id).type() == BodyType::dynamic && !world.get(id).asleep()) return false;
    }
    return true;
}

// Steps until everything sleeps; false where that takes more than so many steps.
bool fall_asleep(World& world, int most = 900) {
    for (int i = 0; i < most; ++i) {
        if (all_asleep(world)) return true;
        run(world, 1);
    }
    return false;
}

std::vector<Position> positions(const World& world) {
    std::vector<Position> out;
    for (int i = 0; i < world.body_count(); ++i) out.push_back(world.get_static(world.body(i)).position());
    return out;
}

float farthest_move(const World& world, const std::vector<Position>& before) {
    float most = 0.0f;
    for (int i = 0; i < world.body_count(); ++i)
        most = maximum(most, length(world.get_static(world.body(i)).position() - before[static_cast<size_t>(i)]));
    return most;
}

// --- what stays to be read

TEST(Rest, ContactsAndFiguresStayAsTheyWere) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    add_stack(world, 0.0f, 3);
    add_stack(world, 4.0f, 2);
    ASSERT_TRUE(fall_asleep(world));  // in this step all contacts were still gone through
    const StepStatistics last = world.statistics();
    const int contacts = world.contact_count();
    ASSERT_EQ(contacts, 5);
    auto weight_on_floor = [&] {
        float sum = 0.0f;
        for (int i = 0; i < world.contact_count(); ++i) {
            Contact c = world.contact(i);
            EXPECT_TRUE(world.alive(c.body_a) && world.alive(c.body_b));
            if (world.get_static(c.body_a).name() == "floor")
                for (int k = 0; k < c.point_count; ++k) sum += c.points[k].normal_impulse;
        }
        return sum;
    };
    const float substep = dt / static_cast<float>(world.config().solver_steps);
    EXPECT_NEAR(weight_on_floor(), 5.0f * 1000.0f * 9.81f * substep, 5.0f);
    run(world, 3);
    EXPECT_EQ(world.statistics().awake_bodies, 0);
    EXPECT_EQ(world.contact_count(), contacts);
    EXPECT_NEAR(weight_on_floor(), 5.0f * 1000.0f * 9.81f * substep, 5.0f);
    EXPECT_EQ(world.statistics().pairs, last.pairs);
    EXPECT_EQ(world.statistics().manifolds, last.manifolds);
    EXPECT_EQ(world.statistics().contact_points, last.contact_points);
    EXPECT_EQ(world.statistics().max_penetration, last.max_penetration);
    EXPECT_GT(world.statistics().contact_points, 0);
    EXPECT_EQ(world.check(), "");
}

TEST(Rest, ContactsOfARemovedSleeperAreGoneAtOnce) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    ASSERT_TRUE(fall_asleep(world));
    run(world, 2);
    world.remove_body(stack[1]).value();
    ASSERT_EQ(world.contact_count(), 1);
    EXPECT_TRUE(world.alive(world.contact(0).body_a) && world.alive(world.contact(0).body_b));
    EXPECT_EQ(world.check(), "");
    run(world, 1);
    EXPECT_EQ(world.statistics().manifolds, world.contact_count());
    EXPECT_EQ(world.check(), "");
}

TEST(Rest, TriggersStillReportSleepers) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    const ColliderDef zone[] = {{.shape = Box{{2.0f, 2.0f, 2.0f}}, .is_trigger = true}};
    world.add_static_body({.colliders = zone}).value();
    std::vector<BodyId> stack = add_stack(world, 0.0f, 2);
    BodyId beside = add_cube(world, 6.0f, 0);
    ASSERT_TRUE(fall_asleep(world));
    run(world, 5);
    EXPECT_EQ(world.overlaps().size(), 2u);
    // One that is put over sleepers later finds them too.
    BodyId late = world.add_static_body({.position = {6.0f, 0.0f, 0.0f}, .colliders = zone}).value();
    run(world, 5);
    ASSERT_EQ(world.overlaps().size(), 3u);
    EXPECT_TRUE(std::any_of(world.overlaps().begin(), world.overlaps().end(),
                            [&](const Overlap& o) { return o.trigger_body == late && o.other_body == beside; }));
    world.remove_body(stack[1]).value();
    EXPECT_EQ(world.fork().value().overlaps().size(), 2u) << "a fork lists those that there still are";
    world.remove_body(late).value();
    EXPECT_EQ(world.overlaps().size(), 3u) << "of the last step";
    run(world, 1);
    EXPECT_EQ(world.overlaps().size(), 1u);
    run(world, 2);
    EXPECT_EQ(world.overlaps().size(), 1u);
}

// --- waking goes on where sleep began

// Three stacks; how far any body moves in the first step and in 25 more, all woken first, if these are `factor` times
// as long as the steps before.
struct Moved {
    float at_once, later;
};
Moved moved_after_change(bool sleep, float factor) {
    World world = WorldBuilder{}.sleep(sleep).build().value();
    add_floor(world);
    for (int k = 0; k < 3; ++k) add_stack(world, 3.0f * static_cast<float>(k), 8);
    run(world, 400);
    EXPECT_EQ(all_asleep(world), sleep);
    const std::vector<Position> before = positions(world);
    for (int i = 0; i < world.body_count(); ++i)
        if (world.get_static(world.body(i)).type() == BodyType::dynamic) world.get(world.body(i)).wake();
    Moved moved{};
    run(world, 1, factor * dt);
    EXPECT_EQ(world.statistics().awake_bodies, 24);
    moved.at_once = farthest_move(world, before);
    run(world, 25, factor * dt);
    moved.later = farthest_move(world, before);
    return moved;
}

TEST(WokenPile, DoesNotJump) {
    Moved moved = moved_after_change(true, 1.0f);
    EXPECT_LT(moved.at_once, 2e-5f);
    EXPECT_LT(moved.later, 1e-3f);
}

// With shorter steps contacts are stiffer, so any pile rises a little: one that slept no more than one that did not.
TEST(WokenPile, TakesShorterStepsAsOneThatDidNotSleep) {
    Moved awake = moved_after_change(false, 0.5f), moved = moved_after_change(true, 0.5f);
    EXPECT_LT(moved.at_once, 1.1f * awake.at_once);
    EXPECT_LT(moved.later, 1.1f * awake.later);
}

TEST(WokenPile, OfManyShapesDoesNotJumpEither) {
    World world = WorldBuilder{}.build().value();
    add_mixed_pile(world, 3);
    run(world, 1000);
    std::vector<BodyId> sleepers;
    for (int i = 0; i < world.body_count(); ++i)
        if (world.get_static(world.body(i)).type() == BodyType::dynamic && world.get(world.body(i)).asleep())
            sleepers.push_back(world.body(i));
    ASSERT_GT(sleepers.size(), 7u) << "balls may roll on";
    std::vector<Position> before;
    for (BodyId id : sleepers) before.push_back(world.get(id).position());
    world.set_gravity(world.config().gravity).value();
    run(world, 5);
    EXPECT_EQ(world.statistics().awake_bodies, 27);
    for (size_t i = 0; i < sleepers.size(); ++i)
        EXPECT_LT(length(world.get(sleepers[i]).position() - before[i]), 1e-3f);
}

// --- nothing that touches them is missed

TEST(Rest, KinematicBodyThatStartsAgainCarriesSleepers) {
    World world = WorldBuilder{}.build().value();
    BodyId lift =
        world.add_rigid_body({.shape = Box{{2.0f, 0.5f, 2.0f}}, .position = {0.0f, -0.5f, 0.0f}, .kinematic = true})
            .value();
    std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    ASSERT_TRUE(fall_asleep(world));
    run(world, 60);
    ASSERT_EQ(world.statistics().awake_bodies, 0);
    world.get(lift).set_velocity({0.0f, 1.0f, 0.0f}).value();
    run(world, 60);
    EXPECT_NEAR(world.get(stack[2]).position().y, 3.5f, 0.05f);
    world.get(lift).set_velocity({}).value();
    EXPECT_TRUE(fall_asleep(world));
    EXPECT_EQ(world.check(), "");
}

TEST(Rest, KinematicBodyThatArrivesWakes) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 2);
    BodyId pusher = world.add_rigid_body({.shape = Box{}, .position = {-3.0f, 0.55f, 0.0f}, .kinematic = true}).value();
    ASSERT_TRUE(fall_asleep(world));
    run(world, 30);
    world.get(pusher).set_velocity({0.5f, 0.0f, 0.0f}).value();
    run(world, 180);
    EXPECT_TRUE(world.get(stack[0]).asleep()) << "not there yet";
    run(world, 120);
    EXPECT_GT(world.get(stack[0]).position().x, 0.3f);
}

TEST(Rest, AwakeBodyPutAgainstSleepersWakesThem) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    BodyId other = add_cube(world, 6.0f, 0);
    ASSERT_TRUE(fall_asleep(world));
    run(world, 10);
    world.get(other).set_pose({0.98f, 0.5f, 0.0f}, {}).value();
    run(world, 1);
    for (BodyId id : stack) EXPECT_FALSE(world.get(id).asleep());
}

TEST(Rest, JointsWakeWhatHangsOnThem) {
    World world = WorldBuilder{}.build().value();
    BodyId hook = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value(), above = hook;
    std::vector<BodyId> chain;
    std::vector<JointId> joints;
    for (int i = 0; i < 4; ++i) {
        Position at{0.0f, -0.5f - static_cast<float>(i), 0.0f};
        chain.push_back(
            world
                .add_rigid_body(
                    {.shape = Box{{0.1f, 0.4f, 0.1f}}, .position = at, .linear_damping = 2.0f, .angular_damping = 2.0f})
                .value());
        Position anchor{0.0f, -static_cast<float>(i), 0.0f};
        joints.push_back(
            world.add_joint(world.joint_at(JointType::hinge, above, chain.back(), anchor, {0.0f, 0.0f, 1.0f}).value())
                .value());
        above = chain.back();
    }
    auto asleep = [&] {
        return std::count_if(chain.begin(), chain.end(), [&](BodyId id) { return world.get(id).asleep(); });
    };
    ASSERT_TRUE(fall_asleep(world));
    run(world, 10);
    ASSERT_EQ(world.statistics().awake_bodies, 0);
    world.get(chain[3]).apply_impulse({5.0f, 0.0f, 0.0f}).value();
    run(world, 1);
    EXPECT_EQ(asleep(), 0) << "one link wakes all";
    ASSERT_TRUE(fall_asleep(world, 3000));
    world.set_motor(joints[0], {.target_velocity = 0.5f, .max_force = 1e5f}).value();
    run(world, 1);
    EXPECT_EQ(asleep(), 0) << "a motor that starts";
    world.set_motor(joints[0], {}).value();
    ASSERT_TRUE(fall_asleep(world, 3000));
    world.remove_joint(joints[2]).value();
    run(world, 60);
    EXPECT_LT(world.get(chain[3]).position().y, -6.0f) << "falls";
    EXPECT_NEAR(world.get(chain[1]).position().y, -1.5f, 0.01f);
    EXPECT_EQ(world.check(), "");
}

// A joint that is removed lets its bodies collide, one that is added keeps them apart, though no box has changed.
TEST(Rest, JointsBeginAndEndPairs) {
    World world = WorldBuilder{}.no_gravity().build().value();
    BodyId a = world.add_rigid_body({.shape = Sphere{0.5f}}).value();
    BodyId b = world.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.9f, 0.0f, 0.0f}}).value();
    JointDef def = world.joint_at(JointType::fixed, a, b, {0.45f, 0.0f, 0.0f}).value();
    JointId joint = world.add_joint(def).value();
    ASSERT_TRUE(fall_asleep(world));
    EXPECT_EQ(world.contact_count(), 0);
    world.remove_joint(joint).value();
    run(world, 1);
    EXPECT_EQ(world.contact_count(), 1);
    joint = world.add_joint(def).value();
    run(world, 1);
    EXPECT_EQ(world.contact_count(), 0);
    EXPECT_EQ(world.check(), "");
}

TEST(Rest, LandingOnOneOfManySleepersWakesItsGroupAlone) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> left = add_stack(world, -3.0f, 3), right = add_stack(world, 3.0f, 3);
    ASSERT_TRUE(fall_asleep(world));
    run(world, 10);
    world.add_rigid_body({.shape = Sphere{0.3f}, .position = {3.0f, 3.35f, 0.0f}, .velocity = {0.0f, -3.0f, 0.0f}})
        .value();
    run(world, 3);
    for (BodyId id : left) EXPECT_TRUE(world.get(id).asleep());
    for (BodyId id : right) EXPECT_FALSE(world.get(id).asleep());
    EXPECT_EQ(world.statistics().awake_bodies, 4);
    EXPECT_EQ(world.check(), "");
}

// --- any order of events

// Plays a long story of random calls; the world's hash at its end.
uint64_t story(BroadPhaseType type, int workers, unsigned seed, bool check) {
    World world = WorldBuilder{}.broad_phase(type).workers(workers).build().value();
    add_mixed_pile(world, 3);
    std::mt19937 random(seed);
    auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    auto somewhere = [&] {
        return Position{0.4f * static_cast<float>(below(20)) - 4.0f, 0.5f + 0.3f * static_cast<float>(below(8)),
                        0.4f * static_cast<float>(below(20)) - 4.0f};
    };
    auto any_body = [&] { return world.body(below(world.body_count())); };
    for (int event = 0; event < 120; ++event) {
        for (int calls = below(4); calls > 0; --calls) {
            const int what = below(9);
            BodyId id = any_body();
            bool rigid = world.get_static(id).type() != BodyType::fixed;
            if (what == 0 && world.get_static(id).name() != "ground") world.remove_body(id).value();
            if (what == 1) world.add_rigid_body({.shape = Box{{0.3f, 0.3f, 0.3f}}, .position = somewhere()}).value();
            if (what == 2) world.add_static_body({.shape = Sphere{0.4f}, .position = somewhere()}).value();
            if (what == 3)
                world.add_rigid_body({.shape = Capsule{0.2f, 0.3f}, .position = somewhere(), .kinematic = true})
                    .value();
            if (what == 4 && rigid) world.get(id).set_pose(somewhere(), {}).value();
            if (what == 5 && rigid) world.get(id).wake();
            if (what == 6 && rigid)
                world.get(id).set_velocity({0.0f, below(2) ? 1.0f : 0.0f, below(3) ? 0.0f : 0.5f}).value();
            if (what == 7) {
                BodyId other = any_body();
                Result<JointDef> def = world.joint_at(JointType::ball, id, other, world.get_static(id).position());
                if (def) world.add_joint(def.value()).value();
            }
            if (what == 8 && world.joint_count() > 0)
                world.remove_joint(world.joint_id(below(world.joint_count()))).value();
            if (check) {
                EXPECT_EQ(world.check(), "") << "event " << event << ", call " << what;
            }
        }
        for (int steps = event % 10 == 9 ? 90 : 1 + below(3); steps > 0; --steps) {
            run(world, 1);
            if (!check) continue;
            EXPECT_EQ(world.check(), "") << "event " << event;
            EXPECT_EQ(world.statistics().manifolds, world.contact_count());
        }
        if (check && ::testing::Test::HasFailure()) break;
    }
    return world.hash();
}

TEST(Rest, AnyStoryKeepsItsBooks) {
    for (unsigned seed = 1; seed <= 4; ++seed) story(BroadPhaseType::wide_tree, 1, seed, true);
}

TEST(Rest, AnyStoryEndsInTheSameBits) {
    const uint64_t expected = story(BroadPhaseType::wide_tree, 1, 5, false);
    EXPECT_EQ(story(BroadPhaseType::wide_tree, 2, 5, false), expected);
    for (BroadPhaseType type : {BroadPhaseType::all_pairs, BroadPhaseType::sweep_1, BroadPhaseType::sweep_3,
                                BroadPhaseType::rtree_star, BroadPhaseType::rtree_str, BroadPhaseType::rtree_omt})
        EXPECT_EQ(story(type, 1, 5, false), expected) << name_of(type);
}

TEST(Rest, AllBodiesCanGoInOneFrame) {
    World world = WorldBuilder{}.build().value();
    add_mixed_pile(world, 3);
    run(world, 300);
    std::vector<BodyId> ids;
    for (int i = 0; i < world.body_count(); ++i) ids.push_back(world.body(i));
    for (BodyId id : ids) world.remove_body(id).value();
    EXPECT_EQ(world.check(), "");
    EXPECT_EQ(world.body_count(), 0);
    EXPECT_EQ(world.contact_count(), 0);
    run(world, 2);
    EXPECT_EQ(world.statistics().pairs, 0);
    BodyId alone = world.add_rigid_body({.shape = Sphere{}}).value();
    EXPECT_EQ(world.body(0), alone);
    run(world, 2);
    EXPECT_EQ(world.check(), "");
}

}  // namespace
}  // namespace lendulet::test
