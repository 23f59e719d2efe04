// Impacts on bodies with joints: what they are part of bounces as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt, test::run;

constexpr CollisionFilter one_group{.group = 1};

// Balls of 0.25 m in a vertical row, joined where they touch, that fall at 5 m/s without gravity; how fast they leave.
float rebound(JointType type, int balls, float restitution, int width = 8, int workers = 1, uint64_t* hash = nullptr) {
    World world = WorldBuilder{}.no_gravity().sleep(false).width(width).workers(workers).build().value();
    world.add_static_body({.shape = Plane{}}).value();
    std::vector<BodyId> row;
    for (int i = 0; i < balls; ++i)
        row.push_back(world
                          .add_rigid_body({.shape = Sphere{0.25f},
                                           .position = {0.0f, 1.0f + 0.5f * static_cast<float>(i), 0.0f},
                                           .velocity = {0.0f, -5.0f, 0.0f},
                                           .restitution = restitution,
                                           .filter = one_group})
                          .value());
    for (int i = 0; i + 1 < balls; ++i) {
        const float y = 1.25f + 0.5f * static_cast<float>(i);
        JointDef def = world
                           .joint_at(type, row[static_cast<size_t>(i)], row[static_cast<size_t>(i) + 1],
                                     {0.0f, y, 0.0f}, {0.0f, 0.0f, 1.0f})
                           .value();
        if (type == JointType::six_degrees) {
            for (auto& a : def.axes.linear) a.limit = {0.0f, 0.0f};
            for (auto& a : def.axes.angular) a.limit = {0.0f, 0.0f};
        }
        world.add_joint(def).value();
    }
    run(world, 40);
    float momentum = 0.0f, mass = 0.0f;
    for (BodyId id : row) momentum += world.get(id).momentum().y, mass += world.get(id).mass();
    if (hash) *hash = world.hash();
    return momentum / mass;
}

TEST(JointImpacts, ARowOfBallsBouncesAsOne) {
    for (JointType type : {JointType::fixed, JointType::hinge, JointType::ball, JointType::six_degrees})
        for (float e : {1.0f, 0.8f, 0.5f})
            for (int balls : {1, 2, 3, 6})
                EXPECT_NEAR(rebound(type, balls, e), 5.0f * e, 0.1f * e) << static_cast<int>(type) << " " << balls;
}

// A long row whose joints lock all there is to lock, and say a part of it twice.
TEST(JointImpacts, GoThroughJointsOfAsManyRowsAsThereAre) {
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    world.add_static_body({.shape = Plane{}}).value();
    std::vector<BodyId> row;
    for (int i = 0; i < 10; ++i) {
        const float y = 1.0f + 0.5f * static_cast<float>(i);
        row.push_back(world
                          .add_rigid_body({.shape = Sphere{0.25f},
                                           .position = {0.0f, y, 0.0f},
                                           .velocity = {0.0f, -5.0f, 0.0f},
                                           .restitution = 1.0f,
                                           .filter = one_group})
                          .value());
        if (i == 0) continue;
        JointDef def{.type = JointType::six_degrees, .body_a = row[row.size() - 2], .body_b = row.back()};
        def.frame_a.translation = {0.0f, 0.25f, 0.0f}, def.frame_b.translation = {0.0f, -0.25f, 0.0f};
        for (JointAxis& a : def.axes.linear) a.limit = {0.0f, 0.0f};
        for (JointAxis& a : def.axes.angular) a.limit = {0.0f, 0.0f};
        for (bool& d : def.axes.distance_axes) d = true;
        def.axes.distance.limit = {0.0f, 0.0f};
        world.add_joint(def).value();
    }
    run(world, 40);
    ASSERT_TRUE(test::all_finite(world));
    EXPECT_GT(world.get(row.front()).velocity().y, 0.0f);
    EXPECT_LT(world.kinetic_energy(), 10 * 0.5 * 25.0 * static_cast<double>(world.get(row.front()).mass()) * 1.001);
}

TEST(JointImpacts, EveryWidthAndNumberOfWorkersGivesTheSameBits) {
    uint64_t expected = 0, hash = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 5}}) {
        rebound(JointType::hinge, 3, 0.8f, width, workers, &hash);
        if (expected == 0) expected = hash;
        EXPECT_EQ(hash, expected) << width;
    }
}

// A ball of 5 m/s hits a rod of 2 m that is hinged at its end, d from there.
TEST(JointImpacts, OnAHingedRodTurnIt) {
    for (float e : {1.0f, 0.5f})
        for (float d : {0.5f, 1.0f, 1.33f, 1.8f}) {
            World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
            BodyId post = world.add_static_body({.shape = Box{{0.05f, 0.05f, 0.05f}}, .filter = one_group}).value();
            BodyId rod = world
                             .add_rigid_body({.shape = Box{{1.0f, 0.1f, 0.1f}},
                                              .position = {1.0f, 0.0f, 0.0f},
                                              .density = 300.0f,
                                              .friction = 0.0f,
                                              .restitution = e,
                                              .filter = one_group})
                             .value();
            world.add_joint(world.joint_at(JointType::hinge, post, rod, {}, {0.0f, 1.0f, 0.0f}).value()).value();
            BodyId ball = world
                              .add_rigid_body({.shape = Sphere{0.1f},
                                               .position = {d, 0.0f, 1.0f},
                                               .velocity = {0.0f, 0.0f, -5.0f},
                                               .density = 2000.0f,
                                               .friction = 0.0f,
                                               .restitution = e})
                              .value();
            const float M = world.get(rod).mass(), m = world.get(ball).mass(), I = M * (4.04f / 12.0f + 1.0f);
            const float impulse = (1.0f + e) * 5.0f / (1.0f / m + d * d / I);
            const double energy = world.kinetic_energy();
            run(world, 30);
            EXPECT_NEAR(world.get(rod).angular_velocity().y, impulse * d / I, 2e-2f) << e << " " << d;
            EXPECT_NEAR(world.get(ball).velocity().z, impulse / m - 5.0f, 5e-2f) << e << " " << d;
            EXPECT_LT(world.kinetic_energy(), 1.0001 * energy);
        }
}

// Whatever is joined how and lands where, no impact adds energy, and flying groups keep their momenta.
TEST(JointImpacts, AddNoEnergy) {
    uint32_t state = 7;
    auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
    };
    auto vector = [&] {
        const float x = next(), y = next(), z = next();
        return Vec3{x, y, z};
    };
    for (int throws = 0; throws < 60; ++throws) {
        World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
        for (uint32_t group = 1; group <= 2; ++group) {
            BodyId last{};
            const float side = group == 1 ? -1.0f : 1.0f;
            const Vec3 v = Vec3{-3.0f * side, 0.0f, 0.0f} + vector();
            for (int i = 0; i < 5; ++i) {
                const Vec3 place{side * (1.0f + 0.1f * static_cast<float>(i)), 0.4f * static_cast<float>(i) - 0.8f,
                                 0.0f};
                BodyId body = world
                                  .add_rigid_body({.shape = Box{{0.15f, 0.2f, 0.1f}},
                                                   .position = at(place),
                                                   .velocity = v,
                                                   .friction = 0.3f,
                                                   .restitution = 0.9f,
                                                   .filter = {.group = group}})
                                  .value();
                const JointType types[] = {JointType::ball, JointType::hinge, JointType::fixed, JointType::slider};
                if (i > 0)
                    world
                        .add_joint(world
                                       .joint_at(types[(throws + i) % 4], last, body,
                                                 at(place - Vec3{0.0f, 0.2f, 0.0f}), normalize(vector()))
                                       .value())
                        .value();
                last = body;
            }
        }
        const Momentum before = world.momentum();
        double energy = world.kinetic_energy();
        const double first = energy;
        for (int i = 0; i < 60; ++i) {
            run(world, 1);
            const double now = world.kinetic_energy();
            EXPECT_LT(now - energy, 0.01 * first) << throws << " step " << i;
            energy = now;
        }
        const Momentum after = world.momentum();
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(after.linear[k], before.linear[k], 1e-2) << throws;
            EXPECT_NEAR(after.angular[k], before.angular[k], 3e-2) << throws;
        }
        EXPECT_EQ(world.statistics().contained_bodies, 0);
    }
}

// A cradle of balls on rods, the first one lifted by 45 degrees. While they touch, kicks are whole, and while one
// swings alone they are split: what falls in and what rises would each gain half a kick's work, 0.6 J in 20 s.
TEST(JointImpacts, ACradleOnRodsGainsNothing) {
    for (int balls : {2, 5}) {
        World world = WorldBuilder{}.sleep(false).build().value();
        const BodyId beam = world.add_static_body({.shape = Box{{1.0f, 0.02f, 0.02f}}}).value();
        for (int i = 0; i < balls; ++i) {
            const Position pivot{0.2f * static_cast<float>(i), 0.0f, 0.0f};
            const Quat turn = i == 0 ? rotation_about({0.0f, 0.0f, 1.0f}, -0.25f * pi) : Quat{};
            const BodyId ball = world
                                    .add_rigid_body({.shape = Sphere{0.1f},
                                                     .position = pivot + rotate(turn, Vec3{0.0f, -1.0f, 0.0f}),
                                                     .orientation = turn,
                                                     .density = 7800.0f,
                                                     .friction = 0.0f,
                                                     .restitution = 1.0f})
                                    .value();
            world.add_joint(world.joint_at(JointType::hinge, beam, ball, pivot, {0.0f, 0.0f, 1.0f}).value()).value();
        }
        auto energy = [&] { return world.kinetic_energy() + world.potential_energy(); };
        const double first = energy();
        double most = first;
        for (int i = 0; i < 1200; ++i) {
            run(world, 1);
            most = std::max(most, energy());
        }
        // Balls that hang as they touch sag by g h^2 / 2, 0.007 J each.
        EXPECT_LT(most - first, 0.02) << balls;
        EXPECT_GT(energy() - first, -0.1) << balls;
    }
}

}  // namespace
}  // namespace lendulet
