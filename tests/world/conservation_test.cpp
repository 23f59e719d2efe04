// What bodies do to each other changes neither their momentum nor their angular momentum, whatever they are, however
// they move and through however many contacts with friction: they change by what rounding adds.
#include <gtest/gtest.h>

#include <cmath>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

World empty_space() { return WorldBuilder{}.no_gravity().build().value(); }

const Shape shapes[] = {Sphere{0.3f}, Capsule{0.25f, 0.2f}, Box{{0.3f, 0.2f, 0.25f}}, Cylinder{0.25f, 0.3f}};

// A hollow box that turns: what is in it is pressed against its walls and slides and rolls along them.
BodyId add_drum(World& world, float half_size, Vec3 angular_velocity) {
    const float outer = half_size + 0.2f, half = half_size + 0.1f;
    ColliderDef walls[6];
    for (int i = 0; i < 6; ++i) {
        const float side = i % 2 ? half : -half;
        Vec3 size{outer, outer, outer}, place{};
        if (i / 2 == 0) size.x = 0.1f, place.x = side;
        if (i / 2 == 1) size.y = 0.1f, place.y = side;
        if (i / 2 == 2) size.z = 0.1f, place.z = side;
        walls[i].shape = Box{size};
        walls[i].local.translation = place;
        walls[i].density = 300.0f;
    }
    RigidBodyDef drum;
    drum.velocity = {0.3f, 0.1f, -0.2f};
    drum.angular_velocity = angular_velocity;
    drum.colliders = walls;
    return world.add_rigid_body(drum).value();
}

double size(const double (&v)[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// Runs it and expects both to stay within `rounding` of the sum of all parts' magnitudes.
void expect_conserved(World& world, int steps, double rounding) {
    double linear = 0.0, angular = 0.0;
    for (int i = 0; i < world.body_count(); ++i) {
        const RigidBodyRef body = world.get(world.body(i));
        linear += length(body.momentum());
        angular += length(body.angular_momentum()) + length(cross(from_origin(body.centre_of_mass()), body.momentum()));
    }
    const Momentum before = world.momentum();
    double off = 0.0, off_linear = 0.0;
    bool touched = false;
    for (int i = 0; i < steps; ++i) {
        world.update(dt).value();
        const Momentum now = world.momentum();
        double d[3], e[3];
        for (int k = 0; k < 3; ++k) d[k] = now.angular[k] - before.angular[k], e[k] = now.linear[k] - before.linear[k];
        off = std::fmax(off, size(d));
        off_linear = std::fmax(off_linear, size(e));
        touched |= world.statistics().manifolds > 0;
    }
    EXPECT_TRUE(touched);
    EXPECT_LT(off, rounding * angular) << "of " << angular;
    EXPECT_LT(off_linear, rounding * linear) << "of " << linear;
}

// Two bodies that turn against each other, pressed together by a spring.
TEST(Conservation, OfTwoBodiesPressedTogether) {
    for (const Shape& shape : {Shape{Sphere{0.5f}}, Shape{Capsule{0.5f, 0.3f}}, Shape{Box{{0.5f, 0.5f, 0.5f}}},
                               Shape{Box{{0.5f, 0.3f, 0.4f}}}}) {
        World world = empty_space();
        RigidBodyDef def{.shape = shape, .friction = 0.5f};
        JointDef spring{.type = JointType::distance};
        def.position = {-0.499f, 0.0f, 0.0f};
        def.velocity = {0.0f, 0.5f, 0.0f};
        def.angular_velocity = {3.0f, 1.0f, 2.0f};
        spring.body_a = world.add_rigid_body(def).value();
        def.position.x = 0.499f;
        def.angular_velocity = {-1.0f, 0.0f, 1.0f};
        spring.body_b = world.add_rigid_body(def).value();
        spring.spring = {500.0f, 50.0f};
        spring.collide_connected = true;
        world.add_joint(spring).value();
        expect_conserved(world, 240, 1e-5);
    }
}

TEST(Conservation, OfWhatTumblesInADrum) {
    for (const Shape& shape : shapes) {
        for (float rolling : {0.0f, 0.02f}) {
            World world = empty_space();
            add_drum(world, 1.0f, {3.0f, 4.0f, 5.0f});
            world
                .add_rigid_body({.shape = shape,
                                 .position = {0.2f, 0.3f, -0.4f},
                                 .velocity = {1.0f, 0.5f, -1.0f},
                                 .angular_velocity = {2.0f, -3.0f, 1.0f},
                                 .friction = 0.5f,
                                 .rolling_friction = rolling,
                                 .spinning_friction = 0.5f * rolling})
                .value();
            expect_conserved(world, 240, 1e-5);
        }
    }
}

// Bounces too, which move bodies to where they would be after the time of impact.
TEST(Conservation, OfManyBodiesInADrum) {
    for (float restitution : {0.0f, 0.5f}) {
        World world = empty_space();
        add_drum(world, 2.0f, {1.0f, 2.0f, 3.0f});
        for (int i = 0; i < 75; ++i) {
            const float x = static_cast<float>(i % 5 - 2), y = static_cast<float>(i / 5 % 5 - 2),
                        z = static_cast<float>(i / 25 - 1);
            world
                .add_rigid_body({.shape = shapes[i % 4],
                                 .position = {0.7f * x, 0.7f * y, 0.9f * z},
                                 .velocity = {0.3f * y, -0.2f * z, 0.1f * x},
                                 .angular_velocity = {x, 0.5f * y, -z},
                                 .friction = 0.5f,
                                 .restitution = restitution})
                .value();
        }
        expect_conserved(world, 240, 1e-5);
    }
}

// Impacts of many at once, after which all fly on and tumble.
TEST(Conservation, OfBodiesThatMeet) {
    for (const Shape& shape : {Shape{Sphere{0.5f}}, Shape{Capsule{0.3f, 0.5f}}, Shape{Box{{0.5f, 0.3f, 0.7f}}}}) {
        for (float restitution : {0.0f, 0.7f}) {
            World world = empty_space();
            for (int i = 0; i < 8; ++i) {
                const float s = i & 1 ? 1.0f : -1.0f, t = i & 2 ? 1.0f : -1.0f, u = i & 4 ? 1.0f : -1.0f;
                world
                    .add_rigid_body({.shape = shape,
                                     .position = {1.2f * s, 1.3f * t, 1.4f * u},
                                     .velocity = {-2.0f * s + 0.3f * t, -2.1f * t, -1.8f * u + 0.3f * s},
                                     .angular_velocity = {3.0f * s, 2.0f * t * u, 1.0f},
                                     .friction = 0.5f,
                                     .restitution = restitution})
                    .value();
            }
            expect_conserved(world, 120, 1e-5);
        }
    }
}

}  // namespace
}  // namespace lendulet
