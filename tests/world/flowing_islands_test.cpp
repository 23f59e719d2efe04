// Which islands take fewer substeps than are set: large ones most of whose bodies move against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "world/support.h"

namespace lendulet::test {
namespace {

using Configure = std::function<void(WorldBuilder&)>;

// `side` squared columns of `height` cubes of 0.8 m in a yard, let go above each other with gaps and turned.
World falling_heap(int side, int height, const Configure& configure = {}) {
    WorldBuilder builder;
    builder.gravity({0.0f, -10.0f, 0.0f}).friction(0.6f).sleep(false);
    if (configure) configure(builder);
    World world = builder.build().value();
    const float inner = 0.75f * static_cast<float>(side), tall = 2.0f * static_cast<float>(height);
    world.add_static_body({.shape = Plane{}}).value();
    for (float sign : {-1.0f, 1.0f}) {
        const float at = sign * (inner + 1.0f);
        world.add_static_body({.shape = Box{{1.0f, tall, inner + 2.0f}}, .position = {at, 0.0f, 0.0f}}).value();
        world.add_static_body({.shape = Box{{inner, tall, 1.0f}}, .position = {0.0f, 0.0f, at}}).value();
    }
    const auto count = static_cast<float>(side);
    for (int i = 0; i < side * side * height; ++i) {
        const auto x = static_cast<float>(i % side), z = static_cast<float>(i / side % side);
        const auto y = static_cast<float>(i / (side * side)), turn = static_cast<float>(i % 7);
        world
            .add_rigid_body({.shape = Box{{0.4f, 0.4f, 0.4f}},
                             .position = {1.45f * (x - 0.5f * (count - 1.0f)), 1.0f + 1.45f * y,
                                          1.45f * (z - 0.5f * (count - 1.0f))},
                             .orientation = normalize(Quat{0.1f * turn, 0.2f, -0.1f * turn, 1.0f})})
            .value();
    }
    return world;
}

int flowing_steps(World& world, int steps) {
    int count = 0;
    for (int i = 0; i < steps; ++i) {
        run(world, 1);
        count += world.statistics().flowing_bodies > 0;
    }
    return count;
}

double energy(const World& world) { return world.kinetic_energy() + world.potential_energy(); }

TEST(FlowingIslands, HeapsFlowUntilTheyLie) {
    World world = falling_heap(6, 10);
    int flowing = 0;
    float deepest = 0.0f;
    double before = energy(world);
    const double start = before;
    for (int i = 0; i < 240; ++i) {
        run(world, 1);
        const StepStatistics& s = world.statistics();
        if (s.flowing_bodies > 0) {
            ++flowing;
            EXPECT_GT(s.flowing_bodies, 150);
            deepest = std::max(deepest, s.max_penetration);
        }
        const double now = energy(world);
        EXPECT_LT(now, before + 1e-2 * start) << i;
        before = now;
    }
    EXPECT_GT(flowing, 15);
    EXPECT_LT(deepest, 0.08f);
    EXPECT_EQ(flowing_steps(world, 60), 0);
    EXPECT_LT(world.statistics().max_penetration, 4e-3f);
    EXPECT_EQ(world.check(), "");
}

// A block of cubes that touch and shear each other, after some steps that all of it flows in.
struct Sheared {
    std::vector<Pose> poses;
    float impulse = 0.0f;  // of all contacts, N s
};
Sheared sheared(int substeps, bool flows) {
    World world = WorldBuilder{}.solver_steps(substeps).sleep(false).friction(0.05f).build().value();
    add_floor(world);
    for (int i = 0; i < 256; ++i) {
        const auto x = static_cast<float>(i % 8), y = static_cast<float>(i / 64), z = static_cast<float>(i / 8 % 8);
        const Vec3 velocity{i % 2 ? 2.0f : -2.0f, 0.0f, i % 3 ? 1.8f : -1.9f};
        world.add_rigid_body({.shape = Box{}, .position = {x, 0.5f + y, z}, .velocity = velocity}).value();
    }
    for (int i = 0; i < 2; ++i) {
        run(world, 1);
        EXPECT_EQ(world.statistics().flowing_bodies, flows ? 256 : 0) << i;
    }
    Sheared out;
    for (int i = 0; i < world.body_count(); ++i) {
        const StaticBodyRef body = world.get_static(world.body(i));
        out.poses.push_back({body.position(), body.orientation()});
    }
    for (int i = 0; i < world.contact_count(); ++i) {
        const Contact contact = world.contact(i);
        for (int j = 0; j < contact.point_count; ++j) out.impulse += contact.points[j].normal_impulse;
    }
    return out;
}

// What flows goes, to the bit, as it would if half of the substeps were set. Impulses are told for those that are set.
TEST(FlowingIslands, TakeHalfOfTheSubsteps) {
    const Sheared half = sheared(8, true), set = sheared(4, false), all = sheared(6, false);
    int other = 0;
    for (size_t i = 0; i < half.poses.size(); ++i) {
        const Vec3 x = from_origin(half.poses[i].position), y = from_origin(set.poses[i].position);
        EXPECT_EQ(length_squared(x - y), 0.0f) << i;
        const Quat turn = half.poses[i].orientation, expected = set.poses[i].orientation;
        EXPECT_EQ(turn.x, expected.x) << i;
        EXPECT_EQ(turn.w, expected.w) << i;
        other += length_squared(x - from_origin(all.poses[i].position)) > 0.0f;
    }
    EXPECT_GT(other, 200);
    EXPECT_GT(half.impulse, 0.0f);
    EXPECT_EQ(half.impulse, 0.5f * set.impulse);
}

// Motion is that of bodies against each other: what is carried along stands.
TEST(FlowingIslands, WhatIsCarriedDoesNot) {
    World world = WorldBuilder{}.sleep(false).friction(0.9f).build().value();
    const BodyId deck = world
                            .add_rigid_body({.shape = Box{{12.0f, 0.5f, 12.0f}},
                                             .position = {0.0f, -0.5f, 0.0f},
                                             .velocity = {4.0f, 0.0f, 0.0f},
                                             .kinematic = true})
                            .value();
    for (int i = 0; i < 400; ++i) {
        const auto x = static_cast<float>(i % 10), z = static_cast<float>(i / 10 % 10), y = static_cast<float>(i / 100);
        world
            .add_rigid_body({.shape = Box{},
                             .position = {2.0f * x - 9.0f, 0.5f + y, 2.0f * z - 9.0f},
                             .velocity = {4.0f, 0.0f, 0.0f}})
            .value();
    }
    EXPECT_EQ(flowing_steps(world, 60), 0);
    // As soon as it is held, all slides and falls over.
    world.get(deck).set_velocity({0.0f, 0.0f, 6.0f}).value();
    EXPECT_GT(flowing_steps(world, 20), 10);
}

// All that touches a body that is moved by hand goes with it, and it moves by their substeps.
TEST(FlowingIslands, WhatIsMovedByHandGoesWithThem) {
    World world = WorldBuilder{}.gravity({0.0f, -10.0f, 0.0f}).friction(0.6f).sleep(false).build().value();
    std::vector<ColliderDef> walls;
    for (float sign : {-1.0f, 1.0f}) {
        walls.push_back({.shape = Box{{4.0f, 0.5f, 4.0f}}, .local = {{0.0f, 4.5f * sign, 0.0f}, {}}});
        walls.push_back({.shape = Box{{0.5f, 4.0f, 4.0f}}, .local = {{4.5f * sign, 0.0f, 0.0f}, {}}});
        walls.push_back({.shape = Box{{5.0f, 5.0f, 0.5f}}, .local = {{0.0f, 0.0f, 4.5f * sign}, {}}});
    }
    const BodyId drum =
        world.add_rigid_body({.angular_velocity = {0.0f, 0.0f, 0.8f}, .colliders = walls, .kinematic = true}).value();
    std::vector<BodyId> boxes;
    for (int i = 0; i < 343; ++i) {
        const auto x = static_cast<float>(i % 7), y = static_cast<float>(i / 7 % 7), z = static_cast<float>(i / 49);
        const Position at{x - 3.0f, y - 3.0f, z - 3.0f};
        boxes.push_back(world.add_rigid_body({.shape = Box{{0.3f, 0.3f, 0.3f}}, .position = at}).value());
    }
    int together = 0;
    for (int i = 0; i < 300; ++i) {
        run(world, 1);
        together += world.statistics().flowing_bodies > 200;
        EXPECT_LT(world.statistics().max_penetration, 0.08f) << i;
    }
    EXPECT_GT(together, 100);
    const Quat turn = world.get(drum).orientation();
    EXPECT_NEAR(std::remainder(2.0f * std::atan2(turn.z, turn.w) - 0.8f * 5.0f, 2.0f * 3.14159265f), 0.0f, 1e-3f);
    for (BodyId id : boxes) {
        const Vec3 x = rotate(conjugate(turn), from_origin(world.get(id).position()));
        EXPECT_LT(std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}), 3.75f);
    }
}

TEST(FlowingIslands, SmallOnesDoNot) {
    World world = falling_heap(3, 6);
    EXPECT_EQ(flowing_steps(world, 180), 0);
}

// Bodies that are joined: gaps of joints would grow with the square of the substep.
TEST(FlowingIslands, JointedOnesDoNot) {
    World world = falling_heap(6, 10);
    for (int i = 0; i < world.body_count(); ++i) {
        const BodyId id = world.body(i);
        if (world.get_static(id).type() != BodyType::dynamic || i % 2 == 0) continue;
        const Position at = world.get(id).position();
        const BodyId bob =
            world.add_rigid_body({.shape = Sphere{0.1f}, .position = {at.x, at.y + 0.65f, at.z}}).value();
        world.add_joint(world.joint_at(JointType::ball, id, bob, {at.x, at.y + 0.5f, at.z}).value()).value();
    }
    EXPECT_EQ(flowing_steps(world, 150), 0);
}

// Half of the substeps must be whole ones, and not too few.
TEST(FlowingIslands, FewOrOddSubstepsStay) {
    for (const auto& [substeps, flows] : {std::pair{4, false}, {6, false}, {9, false}, {10, true}, {16, true}}) {
        World world = falling_heap(6, 10, [&, n = substeps](WorldBuilder& b) { b.solver_steps(n); });
        EXPECT_EQ(flowing_steps(world, 90) > 0, flows) << substeps;
    }
    // Nor do they where a step is so long that what is slow would sink.
    World world = falling_heap(6, 10);
    int flowing = 0;
    for (int i = 0; i < 30; ++i) {
        run(world, 1, 0.1f);
        flowing += world.statistics().flowing_bodies > 0;
    }
    EXPECT_LT(flowing, 5);
}

// A tall pack of smooth plates takes more substeps while it stands, and soon no more than are set when it is thrown
// about.
TEST(FlowingIslands, WhatIsThrownAboutIsNotHard) {
    World world = WorldBuilder{}.sleep(false).friction(0.0f).build().value();
    add_floor(world, 200.0f);
    std::vector<BodyId> plates;
    for (int i = 0; i < 40; ++i)
        plates.push_back(world
                             .add_rigid_body({.shape = Box{{1.0f, 0.1f, 1.0f}},
                                              .position = {0.0f, 0.1f + 0.2f * static_cast<float>(i), 0.0f}})
                             .value());
    run(world, 10);
    ASSERT_EQ(world.statistics().hard_bodies, 40);
    for (size_t i = 0; i < plates.size(); ++i)
        world.get(plates[i]).set_velocity({i % 2 == 0 ? 1.0f : -1.0f, 0.0f, i % 3 == 0 ? 0.8f : -0.7f}).value();
    run(world, 16);
    EXPECT_GT(world.statistics().contact_points, 60);
    EXPECT_EQ(world.statistics().hard_bodies, 0);
}

TEST(FlowingIslands, SameBitsForWorkersWidthsAndSnapshots) {
    auto after = [](int workers, int width, bool restored) {
        World world = falling_heap(6, 10, [&](WorldBuilder& b) { b.workers(workers).width(width); });
        EXPECT_GT(flowing_steps(world, 110), 5);
        if (restored) {
            const std::vector<uint8_t> saved = world.snapshot();
            EXPECT_GT(world.statistics().flowing_bodies, 0);
            run(world, 5);
            world.restore(saved).value();
        }
        EXPECT_GT(flowing_steps(world, 20), 5);
        return world.hash();
    };
    const uint64_t expected = after(1, 1, false);
    EXPECT_EQ(after(2, 8, false), expected);
    EXPECT_EQ(after(3, 16, true), expected);
    EXPECT_EQ(after(1, 4, true), expected);
}

}  // namespace
}  // namespace lendulet::test
