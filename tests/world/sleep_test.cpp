// Falling asleep, and every way to be woken.
#include <gtest/gtest.h>

#include <functional>

#include "world/support.h"

namespace lendulet::test {
namespace {

// A stack of five cubes on a floor; steps until all of it sleeps. Fails where that takes more than 5 s.
struct SleepingStack {
    World world = WorldBuilder{}.build().value();
    BodyId floor = add_floor(world);
    std::vector<BodyId> stack;
    int steps = 0;

    explicit SleepingStack(int height = 5) {
        stack = add_stack(world, 0.0f, height);
        while (steps < 300 && !all_asleep()) run(world, 1), ++steps;
    }
    bool all_asleep() const { return count_asleep() == static_cast<int>(stack.size()); }
    int count_asleep() const {
        int n = 0;
        for (BodyId id : stack) n += world.alive(id) && world.get(id).asleep();
        return n;
    }
    RigidBodyRef top() { return world.get(stack.back()); }
};

TEST(Sleep, SettledStackSleepsWithinFiveSecondsAndCostsNothing) {
    SleepingStack s;
    ASSERT_TRUE(s.all_asleep()) << "after 5 s";
    run(s.world, 2);
    EXPECT_EQ(s.world.statistics().awake_bodies, 0);
    Position before = s.top().position();
    uint64_t hash = s.world.hash();
    run(s.world, 120);
    EXPECT_EQ(s.top().position(), before);
    EXPECT_EQ(s.world.hash(), hash);
    EXPECT_EQ(s.top().velocity(), Vec3{});
    EXPECT_EQ(s.world.contact_count(), 5) << "contacts of sleeping bodies are still there to be read";
}

TEST(Sleep, DoesNotTouchWhatMoves) {
    SleepingStack s;
    BodyId ball =
        s.world.add_rigid_body({.shape = Sphere{0.5f}, .position = {8.0f, 0.5f, 0.0f}, .velocity = {0.0f, 0.0f, 3.0f}})
            .value();
    run(s.world, 30);
    EXPECT_TRUE(s.all_asleep());
    EXPECT_FALSE(s.world.get(ball).asleep());
    EXPECT_EQ(s.world.statistics().awake_bodies, 1);
}

struct Waking {
    const char* name;
    std::function<void(SleepingStack&)> act;
};
void PrintTo(const Waking& w, std::ostream* out) { *out << w.name; }

class Wakes : public ::testing::TestWithParam<Waking> {};

TEST_P(Wakes, TheWholeStack) {
    SleepingStack s;
    ASSERT_TRUE(s.all_asleep());
    GetParam().act(s);
    run(s.world, 2);
    EXPECT_EQ(s.count_asleep(), 0);
    EXPECT_EQ(s.world.check(), "");
    // And what is left in peace sleeps again.
    run(s.world, 600);
    EXPECT_TRUE(all_finite(s.world));
}

const Waking wakings[] = {
    {"impulse",
     [](SleepingStack& s) {
         s.top().apply_impulse({200.0f, 0.0f, 0.0f}).value();
     }},
    {"angular_impulse",
     [](SleepingStack& s) {
         s.top().apply_angular_impulse({0.0f, 200.0f, 0.0f}).value();
     }},
    {"force",
     [](SleepingStack& s) {
         s.top().apply_force({20000.0f, 0.0f, 0.0f}).value();
     }},
    {"torque",
     [](SleepingStack& s) {
         s.top().apply_torque({0.0f, 20000.0f, 0.0f}).value();
     }},
    {"velocity",
     [](SleepingStack& s) {
         s.top().set_velocity({0.5f, 0.0f, 0.0f}).value();
     }},
    {"moved_by_hand",
     [](SleepingStack& s) {
         Position p = s.top().position();
         s.top().set_pose({p.x + 0.05f, p.y, p.z}, {}).value();
     }},
    {"wake", [](SleepingStack& s) { s.top().wake(); }},
    {"gravity",
     [](SleepingStack& s) {
         s.world.set_gravity({0.0f, -20.0f, 0.0f}).value();
     }},
    {"hit",
     [](SleepingStack& s) {
         s.world
             .add_rigid_body({.shape = Sphere{0.3f}, .position = {-0.9f, 2.5f, 0.0f}, .velocity = {10.0f, 0.0f, 0.0f}})
             .value();
         run(s.world, 3);
     }},
    {"kinematic_push",
     [](SleepingStack& s) {
         s.world.add_rigid_body({.position = {-1.05f, 0.5f, 0.0f}, .velocity = {1.0f, 0.0f, 0.0f}, .kinematic = true})
             .value();
         run(s.world, 3);
     }},
    {"kinematic_put_there",
     [](SleepingStack& s) {
         BodyId lift = s.world.add_rigid_body({.position = {-9.0f, 0.5f, 0.0f}, .kinematic = true}).value();
         run(s.world, 2);
         s.world.get(lift).set_pose({-0.95f, 0.5f, 0.0f}, {}).value();
     }},
    {"static_body_added",
     [](SleepingStack& s) {
         s.world.add_static_body({.position = {-0.95f, 0.5f, 0.0f}}).value();
     }},
    {"floor_removed", [](SleepingStack& s) { s.world.remove_body(s.floor).value(); }},
    {"joint_added",
     [](SleepingStack& s) {
         s.world.add_joint(s.world.joint_at(JointType::ball, s.floor, s.stack[2], {0.5f, 2.5f, 0.0f}).value()).value();
     }},
};
INSTANTIATE_TEST_SUITE_P(By, Wakes, ::testing::ValuesIn(wakings),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Sleep, BodyFallsWhenItsSupportIsRemoved) {
    SleepingStack s;
    ASSERT_TRUE(s.all_asleep());
    float height = s.top().position().y;
    s.world.remove_body(s.stack[0]).value();
    run(s.world, 120);
    EXPECT_NEAR(s.top().position().y, height - 1.0f, 0.05f);
}

TEST(Sleep, TwoRemovalsInOneFrameWakeBothNeighbours) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> a = add_stack(world, -4.0f, 3), b = add_stack(world, 4.0f, 3);
    run(world, 300);
    for (BodyId id : {a[0], a[2], b[0], b[2]}) ASSERT_TRUE(world.get(id).asleep());
    world.remove_body(a[0]).value();
    world.remove_body(b[1]).value();
    run(world, 60);
    EXPECT_NEAR(world.get(a[1]).position().y, 0.5f, 0.05f);
    EXPECT_NEAR(world.get(a[2]).position().y, 1.5f, 0.05f);
    EXPECT_NEAR(world.get(b[2]).position().y, 1.5f, 0.05f);
    // Both pieces of one support in one frame: what lay on both falls too.
    world.remove_body(a[1]).value();
    world.remove_body(a[2]).value();
    world.remove_body(b[0]).value();
    run(world, 60);
    EXPECT_NEAR(world.get(b[2]).position().y, 0.5f, 0.05f);
}

TEST(Sleep, RemovedAndReplacedSupportInOneFrame) {
    SleepingStack s;
    ASSERT_TRUE(s.all_asleep());
    s.world.remove_body(s.stack[0]).value();
    // Takes the slot of the one removed, but stands elsewhere: must not inherit its contacts.
    s.world.add_rigid_body({.position = {6.0f, 0.5f, 0.0f}}).value();
    run(s.world, 120);
    EXPECT_NEAR(s.top().position().y, 3.5f, 0.05f);
}

TEST(Sleep, SwitchedOffNeverHappens) {
    World world = WorldBuilder{}.sleep(false).build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    run(world, 400);
    for (BodyId id : stack) EXPECT_FALSE(world.get(id).asleep());
    EXPECT_EQ(world.statistics().awake_bodies, 3);
}

TEST(Sleep, OneBodyThatMayNotSleepKeepsItsIslandAwake) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    BodyId lower = add_cube(world, 0.0f, 0), alone = add_cube(world, 5.0f, 0);
    RigidBodyDef restless{.position = {0.0f, 1.5f, 0.0f}};
    restless.allow_sleep = false;
    world.add_rigid_body(restless).value();
    run(world, 300);
    EXPECT_FALSE(world.get(lower).asleep());
    EXPECT_TRUE(world.get(alone).asleep());
}

// Sleep and waking are part of what is the same in every run.
TEST(Sleep, RunsAreEqualToTheLastBit) {
    auto story = [](int workers) {
        World world = WorldBuilder{}.workers(workers).build().value();
        add_mixed_pile(world, 3);
        run(world, 400);
        world.get(world.body(10)).apply_impulse({0.0f, 3000.0f, 100.0f}).value();
        run(world, 100);
        world.remove_body(world.body(8)).value();
        run(world, 100);
        return world.hash();
    };
    uint64_t first = story(1);
    EXPECT_EQ(story(1), first);
    EXPECT_EQ(story(2), first);
}

}  // namespace
}  // namespace lendulet::test
