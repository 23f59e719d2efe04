// Who may be elsewhere than before the last update.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "world/support.h"

namespace lendulet::test {
namespace {

std::vector<BodyId> moved(const World& world) {
    std::vector<BodyId> list(static_cast<size_t>(world.moved_bodies({})));
    EXPECT_EQ(world.moved_bodies(list), static_cast<int>(list.size()));
    return list;
}

bool has(const std::vector<BodyId>& list, BodyId id) { return std::find(list.begin(), list.end(), id) != list.end(); }

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

// Bodies fall, rest, fall asleep, are struck and removed; a kinematic one goes and stops.
TEST(MovedBodies, AreAllWhosePoseChanged) {
    World world = WorldBuilder{}.build().value();
    add_bowl(world);
    std::mt19937 random(77);
    std::uniform_real_distribution<float> place(-2.0f, 2.0f);
    for (int i = 0; i < 40; ++i)
        world
            .add_rigid_body({.shape = Box{{0.2f, 0.2f, 0.2f}},
                             .position = {place(random), 1.0f + 0.2f * static_cast<float>(i), place(random)}})
            .value();
    const BodyId lift =
        world.add_rigid_body({.shape = Box{{0.3f, 0.1f, 0.3f}}, .position = {0, 20, 0}, .kinematic = true}).value();
    int fewest = 1000, most = 0;
    for (int i = 0; i < 900; ++i) {
        if (i == 100) world.get(lift).set_velocity({0.0f, 0.5f, 0.0f}).value();
        if (i == 200) world.get(lift).set_velocity({}).value();
        if (i % 300 == 299) world.remove_body(world.body(world.body_count() / 2)).value();
        if (i == 700) world.get(world.body(10)).apply_impulse({0.0f, 200.0f, 0.0f}).value();
        std::vector<Pose> before;
        for (int k = 0; k < world.body_count(); ++k) before.push_back(world.get_static(world.body(k)).pose());
        run(world, 1);
        std::vector<BodyId> list = moved(world);
        for (int k = 0; k < world.body_count(); ++k) {
            const BodyId id = world.body(k);
            if (!same(world.get_static(id).pose(), before[static_cast<size_t>(k)])) {
                EXPECT_TRUE(has(list, id)) << "step " << i << ", body " << k;
            }
        }
        for (const SleepEvent& e : world.sleep_events()) EXPECT_TRUE(!e.asleep || has(list, e.body));
        for (BodyId id : list) EXPECT_TRUE(world.alive(id) && world.get_static(id).type() != BodyType::fixed);
        fewest = std::min(fewest, static_cast<int>(list.size())), most = std::max(most, static_cast<int>(list.size()));
        std::sort(list.begin(), list.end(), [](BodyId a, BodyId b) { return a.index < b.index; });
        EXPECT_EQ(std::adjacent_find(list.begin(), list.end()), list.end()) << "named twice";
    }
    EXPECT_EQ(most, 41);
    EXPECT_EQ(fewest, 0) << "what sleeps is not named";
}

TEST(MovedBodies, AreNamedFromWhenTheyAreAddedOrPlaced) {
    World world = WorldBuilder{}.no_gravity().build().value();
    const BodyId a = world.add_rigid_body({}).value(), b = world.add_rigid_body({.position = {5, 0, 0}}).value();
    EXPECT_EQ(moved(world).size(), 2u);
    run(world, 60);
    EXPECT_TRUE(moved(world).empty()) << "both sleep";
    world.get(b).set_pose({6, 0, 0}, {}).value();
    EXPECT_EQ(moved(world), std::vector{b});
    EXPECT_EQ(moved(world.fork().value()), std::vector{b});
    world.remove_body(b).value();
    EXPECT_TRUE(moved(world).empty());
    world.get(a).wake();
    BodyId first[1];
    world.add_rigid_body({.position = {9, 0, 0}}).value();
    EXPECT_EQ(world.moved_bodies(first), 2) << "as many as there are, of which one fits";
    EXPECT_EQ(first[0], a);
}

}  // namespace
}  // namespace lendulet::test
