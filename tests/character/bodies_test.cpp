// Characters among what moves: platforms, belts, crates, blows, and each other.
#include <gtest/gtest.h>

#include "character/walk.h"

namespace lendulet::test {
namespace {

const World& reading(const Walk& w) { return w.world; }

TEST(Character, RidesOnLiftsAndStaysWhereItStands) {
    for (Vec3 velocity : {Vec3{0.5f, 1.0f, 0.0f}, Vec3{2.0f, 0.0f, 1.0f}, Vec3{0.0f, -2.0f, 0.0f}}) {
        Walk w({.position = {0.3f, 0.006f, 0.2f}}, false);
        const BodyId lift = w.lift(Box{{1.5f, 0.1f, 1.5f}}, {0.0f, -0.1f, 0.0f});
        w.go({}, 0.1f);
        w.world.get(lift).set_velocity(velocity).value();
        ASSERT_EQ(w.who.state().ground_body, lift);
        const Vec3 start = w.at() - reading(w).get(lift).position();
        w.go({}, 2.0f);
        EXPECT_NEAR(length(w.at() - reading(w).get(lift).position() - start), 0.0f, 2e-3f);
        EXPECT_NEAR(length(w.who.velocity() - velocity), 0.0f, 0.02f);
        EXPECT_TRUE(w.who.stands());
    }
}

// Round and round: after each turn where it was, and in between as far from the axis.
TEST(Character, RidesOnTurntables) {
    Walk w({.position = {2.0f, 0.006f, 0.0f}}, false);
    const BodyId table = w.lift(Cylinder{0.1f, 4.0f}, {0.0f, -0.1f, 0.0f}, {}, {0.0f, 1.0f, 0.0f});
    w.go({}, 0.1f);
    const Vec3 start = to_local(reading(w).get(table).pose(), w.at());
    w.go({}, 2.0f * pi);
    EXPECT_NEAR(length(to_local(reading(w).get(table).pose(), w.at()) - start), 0.0f, 0.01f);
    EXPECT_TRUE(w.who.stands());
}

TEST(Character, IsCarriedByBelts) {
    Walk w;
    w.world
        .add_static_body({.shape = Box{{20.0f, 0.05f, 2.0f}},
                          .position = {0.0f, 0.05f, 0.0f},
                          .surface_velocity = {1.5f, 0.0f, 0.0f}})
        .value();
    w.who.set_position(w.world, {0.0f, 0.11f, 0.0f}).value();
    w.go({}, 0.2f);
    const Position from = w.at();
    w.go({}, 1.0f);
    EXPECT_NEAR(w.at().x - from.x, 1.5f, 0.01f);
    w.go({-1.5f, 0.0f, 0.0f}, 1.0f);
    EXPECT_NEAR(w.at().x - from.x, 1.5f, 0.01f);
}

TEST(Character, IsPushedByWhatIsKinematicAndSqueezedByTwo) {
    Walk w;
    const BodyId ram = w.lift(Box{{0.5f, 1.0f, 1.0f}}, {-2.0f, 1.1f, 0.0f}, {2.0f, 0.0f, 0.0f});
    float nearest = 1.0f;
    for (int i = 0; i < 120; ++i) {
        w.once();
        nearest = std::fmin(nearest, w.at().x - 0.3f - (reading(w).get(ram).position().x + 0.5f));
    }
    EXPECT_GT(nearest, 0.5f * w.who.skin());
    EXPECT_NEAR(w.at().x, 2.8f + w.who.skin(), 0.01f);
    EXPECT_NEAR(w.at().y, w.who.skin(), 1e-3f);
    w.put(Box{{0.5f, 2.0f, 5.0f}}, {4.0f, 2.0f, 0.0f});
    bool squeezed = false;
    for (int i = 0; i < 30; ++i) {
        w.once();
        squeezed = squeezed || w.who.state().squeezed;
        EXPECT_LT(w.at().x, 3.2f);
        EXPECT_GT(w.at().y, 0.0f);
    }
    EXPECT_TRUE(squeezed);
}

TEST(Character, IsNotPushedByWhatMayNot) {
    Walk w({.pushed_by = ~uint64_t{1}});
    w.lift(Box{{0.5f, 1.0f, 1.0f}}, {-2.0f, 1.1f, 0.0f}, {1.0f, 0.0f, 0.0f});
    w.go({}, 1.1f);
    EXPECT_NEAR(w.at().x, 0.0f, 1e-4f);
}

// 500 N are enough for a crate of 50 kg on a floor of friction 0.5, and not for one of 500 kg.
TEST(Character, PushesWithBoundedForce) {
    for (float mass : {50.0f, 500.0f}) {
        Walk w({.step_height = 0.2f});
        const BodyId crate = w.crate({1.5f, 0.5f, 0.0f}, mass);
        w.go({1.5f, 0.0f, 0.0f}, 3.0f);
        const float x = reading(w).get(crate).position().x;
        EXPECT_NEAR(x, mass < 100.0f ? 5.0f : 1.5f, mass < 100.0f ? 1.0f : 0.01f);
        EXPECT_LT(w.at().x, x - 0.8f);
    }
}

// Without friction a crate of mass M is as fast after t as F t / M.
TEST(Character, PushesWithItsForce) {
    World world = WorldBuilder{}.no_friction().build().value();
    add_floor(world);
    const BodyId crate =
        world.add_rigid_body({.shape = Box{}, .position = {1.0f, 0.5f, 0.0f}, .mass = 1000.0f}).value();
    Character who = Character::add(world, {.position = {0.15f, 0.006f, 0.0f}}).value();
    float touched = 0.0f;
    for (int i = 0; i < 60; ++i) {
        who.update(world, {.velocity = {3.0f, 0.0f, 0.0f}}, dt).value();
        float given = 0.0f;
        for (const CharacterContact& c : who.contacts())
            if (c.body == crate) given += c.impulse.x;
        EXPECT_LE(given, 500.0f * dt * 1.001f);
        touched += given;
        world.update(dt).value();
    }
    EXPECT_NEAR(world.get(crate).velocity().x, touched / 1000.0f, 1e-3f);
    EXPECT_NEAR(touched, 500.0f, 40.0f);
}

// What it stands on feels its weight: a plank on a spring goes down by m g / k.
TEST(Character, BearsOnWhatItStandsOn) {
    Walk w({.position = {0.0f, 2.106f, 0.0f}}, false);
    const BodyId ground = w.put(Box{{0.1f, 0.1f, 0.1f}}, {0.0f, -5.0f, 0.0f});
    const BodyId plank = w.crate({0.0f, 2.0f, 0.0f}, 20.0f, {1.0f, 0.1f, 1.0f});
    JointDef def = w.world.joint_at(JointType::slider, ground, plank, {0.0f, 2.0f, 0.0f}, {0.0f, 1.0f, 0.0f}).value();
    const float k = 10000.0f;
    def.spring = {.stiffness = k, .damping = 1000.0f, .target = 20.0f * 9.81f / k};
    w.world.add_joint(def).value();
    w.go({}, 4.0f);
    EXPECT_EQ(w.who.state().ground_body, plank);
    EXPECT_NEAR(reading(w).get(plank).position().y, 2.0f - 80.0f * 9.81f / k, 2e-3f);
}

// On a cart that rolls freely the momentum of both stays what it was: it walks, and the cart goes the other way; and it
// pushes the cart's own wall in vain.
TEST(Character, WalksOnCartsByActionAndReaction) {
    World world = WorldBuilder{}.no_friction().build().value();
    add_floor(world);
    const BodyId cart =
        world.add_rigid_body({.shape = Box{{4.0f, 0.25f, 2.0f}}, .position = {0.0f, 0.25f, 0.0f}, .mass = 400.0f})
            .value();
    Character who = Character::add(world, {.position = {0.0f, 0.506f, 0.0f}}).value();
    auto go = [&](float speed, int steps) {
        for (int i = 0; i < steps; ++i) {
            who.update(world, {.velocity = {speed, 0.0f, 0.0f}}, dt).value();
            const float momentum = 80.0f * who.state().inertia_velocity.x;
            world.update(dt).value();
            EXPECT_NEAR(momentum + world.get(cart).momentum().x, 0.0f, 0.5f) << i;
        }
    };
    go(0.0f, 30);
    go(2.0f, 60);
    // v + V = 0 with m v + M V: the cart takes m / (m + M) of what it walks.
    EXPECT_NEAR(world.get(cart).velocity().x, -2.0f * 80.0f / 480.0f, 0.02f);
    EXPECT_NEAR(who.velocity().x, 2.0f * 400.0f / 480.0f, 0.02f);
    go(0.0f, 60);
    EXPECT_NEAR(world.get(cart).velocity().x, 0.0f, 0.02f);
}

// A truck that hits it goes on with what two bodies have that stay together; a ball does not move it.
TEST(Character, IsHitByWhatIsDynamic) {
    World world = WorldBuilder{}.no_friction().build().value();
    add_floor(world, 100.0f);
    const BodyId truck = world
                             .add_rigid_body({.shape = Box{{2.0f, 1.0f, 1.0f}},
                                              .position = {-6.0f, 1.0f, 0.0f},
                                              .velocity = {10.0f, 0.0f, 0.0f},
                                              .mass = 2000.0f})
                             .value();
    Character who = Character::add(world, {.push_force = 0.0f}).value();
    for (int i = 0; i < 90; ++i) {
        who.update(world, {}, dt).value();
        world.update(dt).value();
    }
    EXPECT_NEAR(world.get(truck).velocity().x, 10.0f * 2000.0f / 2080.0f, 0.05f);
    EXPECT_GT(who.position().x, world.get(truck).position().x + 2.3f);
    EXPECT_TRUE(who.stands());
}

TEST(Character, GetsNoJitterFromACrateUnderItsFeet) {
    Walk w({.position = {0.0f, 1.05f, 0.0f}});
    const BodyId crate = w.crate({0.0f, 0.5f, 0.0f}, 10.0f);
    w.go({}, 1.0f);
    EXPECT_EQ(w.who.state().ground_body, crate);
    const Position there = w.at();
    for (int i = 0; i < 60; ++i) {
        w.once();
        EXPECT_NEAR(length(w.at() - there), 0.0f, 2e-3f);
        EXPECT_TRUE(w.who.stands());
    }
}

TEST(Character, CharactersStopAtEachOther) {
    Walk w({.filter = {.category = 2}, .pushed_by = ~uint64_t{2}});
    Character other =
        Character::add(w.world, {.position = {3.0f, 0.0f, 0.0f}, .filter = {.category = 2}, .pushed_by = ~uint64_t{2}})
            .value();
    for (int i = 0; i < 180; ++i) {
        w.who.update(w.world, {.velocity = {2.0f, 0.0f, 0.0f}}, dt).value();
        other.update(w.world, {.velocity = {-1.0f, 0.0f, 0.0f}}, dt).value();
        w.world.update(dt).value();
    }
    EXPECT_NEAR(other.position().x - w.at().x, 0.6f, 0.02f);
    EXPECT_NEAR(w.at().x, 1.6f, 0.3f);
}

}  // namespace
}  // namespace lendulet::test
