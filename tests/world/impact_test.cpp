// Impacts of what tumbles: whatever hits whatever, however fast it turns, no impact adds energy.
#include <gtest/gtest.h>

#include <algorithm>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

// Numbers between -1 and 1, the same ones in every run.
struct Numbers {
    uint32_t state = 1;
    float next() {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
    }
    Vec3 vector() { return {next(), next(), next()}; }
    Quat rotation() { return rotation_about(normalize(vector()), pi * next()); }
};

struct Surface {
    float friction, restitution, tangential;
};

const Shape shapes[] = {Box{{0.5f, 0.2f, 0.3f}}, Capsule{0.4f, 0.2f}, Cylinder{0.3f, 0.2f}, Sphere{0.3f}};

World thrown(const Shape& shape, const Surface& s, float spin, bool at_other, Numbers& numbers) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyDef def{.shape = shape,
                     .position = {0.0f, 1.2f, 0.0f},
                     .orientation = numbers.rotation(),
                     .velocity = Vec3{0.0f, -4.0f, 0.0f} + 2.0f * numbers.vector(),
                     .angular_velocity = spin * normalize(numbers.vector()),
                     .friction = s.friction,
                     .restitution = s.restitution,
                     .tangential_restitution = s.tangential};
    world.add_rigid_body(def).value();
    if (at_other) {
        def.position = {0.2f * numbers.next(), -0.2f, 0.2f * numbers.next()};
        def.orientation = numbers.rotation();
        def.velocity = numbers.vector();
        def.angular_velocity = spin * normalize(numbers.vector());
        world.add_rigid_body(def).value();
    } else {
        world
            .add_static_body({.shape = Box{{50.0f, 5.0f, 50.0f}},
                              .position = {0.0f, -5.0f, 0.0f},
                              .friction = s.friction,
                              .restitution = s.restitution,
                              .tangential_restitution = s.tangential})
            .value();
    }
    return world;
}

// Of so many throws the largest rise in a step, in parts of the energy at the start, and how many have any.
struct Rises {
    double largest = 0.0;
    int throws = 0;
};
Rises rises(const Shape& shape, const Surface& s, float spin, bool at_other, int throws = 20) {
    Numbers numbers;
    Rises all;
    for (int i = 0; i < throws; ++i) {
        double largest = 0.0;
        World world = thrown(shape, s, spin, at_other, numbers);
        const double start = world.kinetic_energy();
        double before = start;
        for (int step = 0; step < 60; ++step) {
            world.update(dt).value();
            const double now = world.kinetic_energy();
            largest = std::max(largest, (now - before) / start);
            before = now;
        }
        all.largest = std::max(all.largest, largest);
        all.throws += largest > 1e-5;
    }
    return all;
}
double largest_rise(const Shape& shape, const Surface& s, float spin, bool at_other) {
    return rises(shape, s, spin, at_other).largest;
}

TEST(Impacts, OnAFloorAddNoEnergy) {
    for (const Shape& shape : shapes)
        for (float spin : {0.0f, 10.0f, 100.0f})
            for (const Surface& s : {Surface{0.0f, 1.0f, 0.0f}, {0.6f, 1.0f, 0.0f}, {0.6f, 1.0f, 1.0f}})
                EXPECT_LT(largest_rise(shape, s, spin, false), 1e-5)
                    << spin << " " << s.friction << " " << s.tangential;
}

TEST(Impacts, OfBallsAndCapsulesAddNoEnergy) {
    for (const Shape& shape : {shapes[1], shapes[3]})
        for (float spin : {0.0f, 10.0f})
            for (const Surface& s : {Surface{0.0f, 1.0f, 0.0f}, {0.6f, 1.0f, 0.0f}, {0.6f, 1.0f, 1.0f}})
                EXPECT_LT(largest_rise(shape, s, spin, true), 2e-5) << spin << " " << s.friction << " " << s.tangential;
}

// Nor do blows without restitution, whose friction is not repeated, but for what undoing an overlap may cost.
TEST(Impacts, WithoutRestitutionAddNoEnergy) {
    for (const Shape& shape : shapes)
        for (float spin : {0.0f, 10.0f}) {
            const Rises r = rises(shape, {0.6f, 0.0f, 0.0f}, spin, false, 200);
            EXPECT_LE(r.throws, 10) << spin;
            EXPECT_LT(r.largest, 2e-2) << spin;
        }
}

// A billiard ball that rolls into another one head on: of its v + 0.4 r w the blow takes v and no more, whenever in a
// step they meet.
TEST(Impacts, AFollowShotExchangesSpeedAlone) {
    constexpr float r = 0.03f, v = 1.5f;
    for (int i = 0; i < 50; ++i) {
        World world = WorldBuilder{}.sleep(false).build().value();
        const ColliderDef table{
            .shape = Box{{50.0f, 1.0f, 50.0f}},
            .material = {
                .static_friction = 0.4f, .dynamic_friction = 0.4f, .restitution_combine = CombineRule::minimum}};
        world.add_static_body({.position = {0.0f, -1.0f, 0.0f}, .colliders = {&table, 1}}).value();
        RigidBodyDef def{.shape = Sphere{r},
                         .position = {0.0f, r, 0.0f},
                         .velocity = {v, 0.0f, 0.0f},
                         .angular_velocity = {0.0f, 0.0f, -v / r},
                         .friction = 0.0f,
                         .restitution = 1.0f};
        const BodyId cue = world.add_rigid_body(def).value();
        def.position.x = 2.0f * r + 0.1f + 0.0005f * static_cast<float>(i);
        def.velocity = def.angular_velocity = {};
        const BodyId object = world.add_rigid_body(def).value();
        for (int step = 0; step < 20; ++step) world.update(dt).value();
        auto rolled = [&](BodyId id) {
            return world.get(id).velocity().x - 0.4f * r * world.get(id).angular_velocity().z;
        };
        EXPECT_NEAR(rolled(object), v, 0.001f * v) << i;
        EXPECT_NEAR(rolled(cue), 0.4f * v, 0.001f * v) << i;
    }
}

}  // namespace
}  // namespace lendulet
