// Groups of jointed bodies that need more substeps than the world's setting.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

struct Chain {
    World world;
    std::vector<JointId> joints;
    std::vector<BodyId> rods;
    BodyId load;
};

// Twenty rods of half a metre and 1 kg with a load of 100 kg, hanging or level, as PHYSICS case A28 has it.
Chain make_chain(bool hangs, WorldBuilder builder = {}) {
    Chain chain{builder.down_gravity(9.81f).sleep(false).build().value(), {}, {}, {}};
    World& world = chain.world;
    Vec3 along = hangs ? Vec3{0.0f, -1.0f, 0.0f} : Vec3{1.0f, 0.0f, 0.0f};
    CollisionFilter apart{.category = 1, .mask = 0};
    auto at = [&](float way) { return Position{way * along.x, way * along.y, 0.0f}; };
    BodyId before = world.add_static_body({.filter = apart}).value();
    auto hang = [&](BodyId body, float way) {
        chain.joints.push_back(world.add_joint(world.joint_at(JointType::ball, before, body, at(way)).value()).value());
        before = body;
    };
    for (int i = 0; i < 20; ++i) {
        float way = 0.5f * static_cast<float>(i);
        BodyId rod = world
                         .add_rigid_body({.shape = Box{{0.25f, 0.025f, 0.025f}},
                                          .position = at(way + 0.25f),
                                          .orientation = rotation_between({1.0f, 0.0f, 0.0f}, along),
                                          .filter = apart,
                                          .mass = 1.0f})
                         .value();
        hang(rod, way);
        chain.rods.push_back(rod);
    }
    chain.load =
        world.add_rigid_body({.shape = Sphere{0.3f}, .position = at(10.3f), .filter = apart, .mass = 100.0f}).value();
    hang(chain.load, 10.0f);
    return chain;
}

double stretch(const Chain& chain) {
    double sum = 0.0;
    for (JointId joint : chain.joints) sum += static_cast<double>(length(chain.world.joint(joint).linear_error));
    return sum / 10.0;
}

TEST(JointGroups, PayloadChainHangsAndSwingsAtItsLength) {
    for (bool hangs : {true, false}) {
        Chain chain = make_chain(hangs);
        double most = 0.0;
        for (int i = 0; i < 600; ++i) {
            chain.world.update(dt).value();
            most = std::fmax(most, stretch(chain));
        }
        EXPECT_LT(most, hangs ? 5e-4 : 1e-2);
    }
}

// Joint forces are reported per second whatever the substeps: the weight of all that hangs, once it no longer bounces.
TEST(JointGroups, ForcesAreThoseOfTheWorldsTime) {
    Chain chain = make_chain(true);
    for (int i = 0; i < 600; ++i) chain.world.update(dt).value();
    EXPECT_NEAR(chain.world.joint(chain.joints.front()).force.y, 120.0f * 9.81f, 3.0f);
    EXPECT_NEAR(chain.world.joint(chain.joints.back()).force.y, 100.0f * 9.81f, 3.0f);
}

// A group changes its multiple when its load goes; impulses stay in proportion, so that nothing jumps.
TEST(JointGroups, LoadMayComeOff) {
    Chain chain = make_chain(true);
    for (int i = 0; i < 60; ++i) chain.world.update(dt).value();
    chain.world.remove_joint(chain.joints.back()).value();
    chain.joints.pop_back();
    double most = 0.0;
    for (int i = 0; i < 120; ++i) {
        chain.world.update(dt).value();
        most = std::fmax(most, stretch(chain));
        EXPECT_LT(length(chain.world.get(chain.rods[0]).velocity()), 0.05f) << i;
    }
    EXPECT_LT(most, 4e-3);
}

// Bridges of any number of planks hang on their weight; a linkage follows its law. `longest`: greatest gap in the last
// second of four, in parts of a plank.
TEST(JointGroups, BridgesAreNoMechanisms) {
    for (int planks : {10, 30, 60}) {
        World world = WorldBuilder{}.sleep(false).build().value();
        BodyId before = world.add_static_body({.position = {0.0f, 0.0f, 0.0f}}).value();
        std::vector<JointId> joints;
        auto hinge = [&](BodyId body, int i) {
            const Position at{0.5f * static_cast<float>(i), 0.0f, 0.0f};
            joints.push_back(
                world.add_joint(world.joint_at(JointType::hinge, before, body, at, {0.0f, 0.0f, 1.0f}).value())
                    .value());
            before = body;
        };
        for (int i = 0; i < planks; ++i) {
            RigidBodyDef def{.shape = Box{{0.24f, 0.05f, 0.8f}}};
            def.position = {0.5f * static_cast<float>(i) + 0.25f, 0.0f, 0.0f};
            def.filter = {.category = 1, .mask = 0};
            hinge(world.add_rigid_body(def).value(), i);
        }
        hinge(world.add_static_body({.position = {0.5f * static_cast<float>(planks), 0.0f, 0.0f}}).value(), planks);
        float longest = 0.0f;
        for (int i = 0; i < 240; ++i) {
            world.update(dt).value();
            for (JointId joint : joints)
                if (i >= 180) longest = std::fmax(longest, length(world.joint(joint).linear_error));
        }
        EXPECT_LT(longest, 0.01f) << planks;
        EXPECT_EQ(world.statistics().hard_bodies, planks > 10 ? planks : 0);
    }
}

// The same bits for every width and number of workers, also where groups of several multiples meet contacts.
TEST(JointGroups, EveryWidthAndWorkerGivesTheSameBits) {
    uint64_t expected = 0;
    for (auto [width, workers] : {std::pair{1, 1}, {4, 2}, {8, 1}, {16, 5}}) {
        Chain chain = make_chain(false, WorldBuilder{}.width(width).workers(workers));
        World& world = chain.world;
        world.add_static_body({.shape = Box{{20.0f, 0.5f, 20.0f}}, .position = {0.0f, -9.0f, 0.0f}}).value();
        BodyId before{};
        for (int i = 0; i < 4; ++i) {  // a chain of its own that falls onto the ground
            Position x{0.6f * static_cast<float>(i), -8.0f, 3.0f};
            BodyId link =
                world.add_rigid_body({.shape = Box{{0.25f, 0.1f, 0.1f}}, .position = x, .mass = i < 3 ? 1.0f : 40.0f})
                    .value();
            if (i > 0)
                world.add_joint(world.joint_at(JointType::ball, before, link, x + Vec3{-0.3f, 0.0f, 0.0f}).value())
                    .value();
            before = link;
        }
        for (int i = 0; i < 150; ++i) world.update(dt).value();
        if (expected == 0) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width << " " << workers;
    }
}

}  // namespace
}  // namespace lendulet
