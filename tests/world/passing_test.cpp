// Contacts of balls that pass by each other get no row: what the bodies do when a third one strikes them on the way.
#include <gtest/gtest.h>

#include <random>

#include "world/support.h"

namespace lendulet::test {
namespace {

RigidBodyDef ball_at(Position at, Vec3 velocity, float friction = 0.0f, float restitution = 1.0f) {
    return {
        .shape = Sphere{0.3f}, .position = at, .velocity = velocity, .friction = friction, .restitution = restitution};
}

// `flier` would pass a tenth of a metre beside `target`; `striker` turns it there within the step.
struct Deflection {
    World world = WorldBuilder{}.no_gravity().build().value();
    BodyId flier, target, striker;
    explicit Deflection(bool strike, float restitution = 1.0f) {
        flier = world.add_rigid_body(ball_at({0.0f, 0.0f, 0.0f}, {20.0f, 20.0f, 0.0f}, 0.0f, restitution)).value();
        target = world.add_rigid_body(ball_at({0.6f, -0.39f, 0.0f}, {})).value();
        if (!strike) return;
        const Position behind{-0.45f, 0.45f, 0.0f};
        striker = world.add_rigid_body(ball_at(behind, {48.0f, -8.0f, 0.0f}, 0.0f, restitution)).value();
    }
    void run(int parts) { test::run(world, parts, dt / static_cast<float>(parts)); }
};

TEST(Passing, ContactsGetNoRow) {
    Deflection alone(false);
    alone.run(1);
    ASSERT_EQ(alone.world.contact_count(), 1);
    EXPECT_EQ(alone.world.contact_colours()[0], -1);
    // Where the two are at the end of the step.
    const Vec3 between = alone.world.get(alone.target).position() - alone.world.get(alone.flier).position();
    const Contact c = alone.world.contact(0);
    EXPECT_NEAR(c.points[0].separation, length(between) - 0.6f, 1e-5f);
    EXPECT_EQ(c.points[0].normal_impulse, 0.0f);
}

TEST(Passing, WhatIsTurnedAsideHitsWithinTheStep) {
    Deflection once(true), finely(true);
    once.run(1);
    finely.run(64);
    EXPECT_GT(length(finely.world.get(finely.target).velocity()), 10.0f);
    const BodyId coarse[] = {once.flier, once.target, once.striker};
    const BodyId fine[] = {finely.flier, finely.target, finely.striker};
    for (int i = 0; i < 3; ++i) {
        const auto a = once.world.get(coarse[i]), b = finely.world.get(fine[i]);
        EXPECT_LT(length(a.velocity() - b.velocity()), 0.01f * 48.0f) << i;
        EXPECT_LT(length(a.position() - b.position()), 0.005f) << i;
    }
}

// A contact that does not bounce turns it by its row, which no impact tells of.
TEST(Passing, WhatARowTurnsAsideHitsWithinTheStep) {
    Deflection once(true, 0.0f), finely(true, 0.0f);
    once.run(1);
    finely.run(64);
    const float struck = length(finely.world.get(finely.target).velocity());
    EXPECT_GT(struck, 10.0f);
    EXPECT_NEAR(length(once.world.get(once.target).velocity()), struck, 0.2f * struck);
}

// Balls in a box that never rest; in every step several hit another on the way from a third.
TEST(Passing, AGasDoesNotOverlap) {
    uint64_t hashes[4];
    for (int w = 0; w < 4; ++w) {
        World world = WorldBuilder{}.no_gravity().width(widths[w]).build().value();
        for (int axis = 0; axis < 3; ++axis)
            for (float side : {-1.0f, 1.0f}) {
                Vec3 half{4.0f, 4.0f, 4.0f}, at{};
                set_component(half, axis, 1.0f), set_component(at, axis, 4.0f * side);
                world
                    .add_static_body(
                        {.shape = Box{half}, .position = Position{} + at, .friction = 0.6f, .restitution = 1.0f})
                    .value();
            }
        std::mt19937 random(3);
        auto unit = [&] { return static_cast<float>(random() >> 8) * (2.0f / 16777216.0f) - 1.0f; };
        std::vector<BodyId> balls;
        for (int i = 0; i < 6 * 6 * 6; ++i) {
            const Position at{-2.2f + 0.88f * static_cast<float>(i % 6), -2.2f + 0.88f * static_cast<float>(i / 6 % 6),
                              -2.2f + 0.88f * static_cast<float>(i / 36)};
            balls.push_back(world.add_rigid_body(ball_at(at, 12.0f * Vec3{unit(), unit(), unit()}, 0.6f)).value());
        }
        const double energy = world.kinetic_energy();
        int overlapping = 0, hits = 0;
        for (int step = 0; step < 120; ++step) {
            run(world, 1);
            for (int i = 0; i < world.contact_count(); ++i) hits += world.contact(i).points[0].normal_impulse > 0.0f;
            for (size_t i = 0; i < balls.size(); ++i)
                for (size_t j = i + 1; j < balls.size(); ++j)
                    overlapping += length(world.get(balls[i]).position() - world.get(balls[j]).position()) < 0.598f;
        }
        EXPECT_LE(overlapping, 10) << hits;
        EXPECT_LT(world.kinetic_energy(), energy);
        hashes[w] = world.hash();
    }
    for (int w = 1; w < 4; ++w) EXPECT_EQ(hashes[w], hashes[0]) << widths[w];
}

}  // namespace
}  // namespace lendulet::test
