// Motion of single bodies through the public interface, against closed forms.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr Vec3 half{0.5f, 1.0f, 1.5f};  // of a box of 6 m^3
constexpr float mass = 6.0f;            // kg, at density 1

RigidBodyDef spinning_box() {
    return {.shape = Box{half},
            .position = {1.0f, 2.0f, 3.0f},
            .orientation = rotation_about({1.0f, 2.0f, 3.0f}, 0.7f),
            .velocity = {1.0f, -2.0f, 0.5f},
            .angular_velocity = {0.3f, 0.6f, -0.9f},
            .density = 1.0f};
}

void expect_near(Vec3 a, Vec3 b, float tolerance, const char* what) {
    EXPECT_LE(length(a - b), tolerance) << what << ": (" << a.x << ' ' << a.y << ' ' << a.z << ") and (" << b.x << ' '
                                        << b.y << ' ' << b.z << ')';
}

TEST(Body, VelocitiesAreDerivedFromMomenta) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyDef def = spinning_box();
    const RigidBodyRef body = world.get(world.add_rigid_body(def).value());
    expect_near(body.momentum(), mass * def.velocity, 1e-5f, "p = m v");
    // L = R I R^T w with I = m/3 (b^2 + c^2, ...) of half extents.
    Vec3 inertia = (mass / 3.0f) * Vec3{half.y * half.y + half.z * half.z, half.x * half.x + half.z * half.z,
                                        half.x * half.x + half.y * half.y};
    Vec3 local = rotate_inverse(def.orientation, def.angular_velocity);
    expect_near(body.angular_momentum(), rotate(def.orientation, multiply(inertia, local)), 1e-5f, "L = I w");
    expect_near(body.angular_velocity(), def.angular_velocity, 1e-6f, "w");
    expect_near(body.inverse_inertia() * body.angular_momentum(), def.angular_velocity, 1e-6f, "inverse inertia");
    float energy = 0.5f * mass * length_squared(def.velocity) + 0.5f * dot(multiply(inertia, local), local);
    EXPECT_NEAR(body.kinetic_energy(), energy, 1e-5f);
}

TEST(Body, VelocityAndEffectivenessAtAPoint) {
    World world = WorldBuilder{}.no_gravity().build().value();
    const Position point{2.0f, 2.5f, 4.0f};
    const Vec3 u = normalize(Vec3{1.0f, -2.0f, 0.7f});
    BodyId id = world.add_rigid_body(spinning_box()).value();
    RigidBodyRef body = world.get(id);
    Vec3 before = body.velocity_at(point), r = point - body.centre_of_mass();
    expect_near(before, body.velocity() + cross(body.angular_velocity(), r), 1e-6f, "v + w x r");
    float effect = body.impulse_effectiveness(point, u);
    const float size = 3.0f;
    body.apply_impulse(size * u, point).value();
    EXPECT_NEAR(dot(body.velocity_at(point) - before, u), size * effect, 2e-6f);
    EXPECT_GT(effect, body.inverse_mass());
    EXPECT_NEAR(body.impulse_effectiveness(body.centre_of_mass(), u), body.inverse_mass(), 1e-7f);
}

TEST(Body, ImpulsesAddToMomenta) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyRef body = world.get(world.add_rigid_body(spinning_box()).value());
    Vec3 p = body.momentum(), L = body.angular_momentum();
    const Vec3 J{1.0f, 2.0f, -3.0f};
    const Position point{0.0f, 3.0f, 3.5f};
    body.apply_impulse(J, point).value();
    expect_near(body.momentum(), p + J, 1e-5f, "p + J");
    expect_near(body.angular_momentum(), L + cross(point - body.centre_of_mass(), J), 1e-5f, "L + r x J");
    body.apply_impulse(-J, point).value();
    body.apply_angular_impulse(J).value();
    expect_near(body.momentum(), p, 1e-5f, "p");
    expect_near(body.angular_momentum(), L + J, 1e-5f, "L + H");
    body.apply_impulse(J).value();
    expect_near(body.angular_momentum(), L + J, 1e-5f, "an impulse at the centre turns nothing");
}

TEST(Body, ForceAndTorqueHoldForOneStep) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyDef def = spinning_box();
    BodyId id = world.add_rigid_body(def).value();
    RigidBodyRef body = world.get(id);
    Vec3 p = body.momentum(), L = body.angular_momentum();
    const Vec3 F{30.0f, 0.0f, -12.0f}, torque{0.0f, 6.0f, 3.0f};
    const Position point{1.0f, 2.0f, 4.0f};
    Vec3 arm = point - body.centre_of_mass();
    body.apply_force(F, point).value();
    body.apply_force(F).value();
    body.apply_torque(torque).value();
    run(world, 1);
    expect_near(body.momentum(), p + (2.0f * dt) * F, 1e-5f, "p + F dt");
    expect_near(body.angular_momentum(), L + dt * (torque + cross(arm, F)), 1e-5f, "L + T dt");
    run(world, 5);
    expect_near(body.momentum(), p + (2.0f * dt) * F, 1e-5f, "the force has ended");
}

TEST(Body, SettersAndGetters) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyRef body = world.get(world.add_rigid_body(spinning_box()).value());
    const Quat q = rotation_about({0.0f, 0.0f, 1.0f}, 1.1f);
    body.set_pose({7.0f, 8.0f, 9.0f}, {1.0005f * q.x, 1.0005f * q.y, 1.0005f * q.z, 1.0005f * q.w}).value();
    EXPECT_EQ(body.position(), (Position{7.0f, 8.0f, 9.0f}));
    EXPECT_NEAR(dot(body.orientation(), body.orientation()), 1.0f, 1e-6f) << "nearly unit quaternions are normalised";
    body.set_velocity({1.0f, 2.0f, 3.0f}).value();
    body.set_angular_velocity({3.0f, 2.0f, 1.0f}).value();
    expect_near(body.velocity(), {1.0f, 2.0f, 3.0f}, 1e-6f, "v");
    expect_near(body.angular_velocity(), {3.0f, 2.0f, 1.0f}, 1e-5f, "w");
    body.set_momentum({6.0f, 0.0f, 0.0f}).value();
    body.set_angular_momentum({0.0f, 6.0f, 0.0f}).value();
    expect_near(body.velocity(), {1.0f, 0.0f, 0.0f}, 1e-6f, "p / m");
    expect_near(body.angular_momentum(), {0.0f, 6.0f, 0.0f}, 0.0f, "L");
}

TEST(Body, DampingIsAnExactExponential) {
    for (int solver_steps : {1, 8}) {
        World world = WorldBuilder{}.no_gravity().solver_steps(solver_steps).build().value();
        RigidBodyDef def{.shape = Sphere{}, .velocity = {10.0f, 0.0f, 0.0f}, .angular_velocity = {0.0f, 4.0f, 0.0f}};
        def.linear_damping = 0.8f;
        def.angular_damping = 2.0f;
        BodyId id = world.add_rigid_body(def).value();
        run(world, 40, 0.05f);  // 2 s in coarse steps
        EXPECT_NEAR(world.get(id).velocity().x, 10.0 * std::exp(-1.6), 2e-5) << solver_steps;
        EXPECT_NEAR(world.get(id).angular_velocity().y, 4.0 * std::exp(-4.0), 2e-6) << solver_steps;
        EXPECT_NEAR(world.get(id).position().x, 10.0 / 0.8 * (1.0 - std::exp(-1.6)),
                    1e-4 + 0.02 / (solver_steps * solver_steps));
    }
}

TEST(Body, GravityFactor) {
    World world = WorldBuilder{}.build().value();
    std::vector<BodyId> balls;
    for (float factor : {0.0f, 1.0f, -0.5f, 3.0f}) {
        RigidBodyDef def{.shape = Sphere{}, .position = {5.0f * static_cast<float>(balls.size()), 0.0f, 0.0f}};
        def.gravity_factor = factor;
        balls.push_back(world.add_rigid_body(def).value());
        EXPECT_NEAR(world.get(balls.back()).potential_energy(), 0.0f, 1e-6f);
    }
    run(world, 60);
    const float factors[] = {0.0f, 1.0f, -0.5f, 3.0f};
    for (size_t i = 0; i < balls.size(); ++i) {
        const RigidBodyRef ball = world.get(balls[i]);
        EXPECT_NEAR(ball.velocity().y, -9.81f * factors[i], 1e-4f);
        EXPECT_NEAR(ball.position().y, -0.5f * 9.81f * factors[i], 1e-4f);
        EXPECT_NEAR(ball.energy(), 0.0f, 1e-3f * ball.mass()) << "energy of free fall";
    }
}

TEST(Body, WholeWorldFiguresAreSums) {
    World world = WorldBuilder{}.gravity({1.0f, -9.0f, 2.0f}).build().value();
    double p[3] = {}, L[3] = {}, kinetic = 0.0, potential = 0.0;
    for (int i = 0; i < 5; ++i) {
        RigidBodyDef def = spinning_box();
        def.position.x += 10.0f * static_cast<float>(i);
        def.velocity.z = static_cast<float>(i);
        const RigidBodyRef body = world.get(world.add_rigid_body(def).value());
        Vec3 momentum = body.momentum(), spin = body.angular_momentum();
        Vec3 orbit = cross(from_origin(body.centre_of_mass()), momentum);
        for (int k = 0; k < 3; ++k) {
            p[k] += component(momentum, k);
            L[k] += component(spin, k) + component(orbit, k);
        }
        kinetic += body.kinetic_energy();
        potential += body.potential_energy();
    }
    world.add_static_body({}).value();
    BodyId kinematic =
        world.add_rigid_body({.position = {0.0f, 50.0f, 0.0f}, .velocity = {9.0f, 0.0f, 0.0f}, .kinematic = true})
            .value();
    Momentum sum = world.momentum();
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(sum.linear[k], p[k], 1e-4);
        EXPECT_NEAR(sum.angular[k], L[k], 1e-2);
    }
    EXPECT_NEAR(world.kinetic_energy(), kinetic, 1e-3);
    EXPECT_NEAR(world.potential_energy(), potential, 1e-2);
    EXPECT_TRUE(std::isinf(world.get(kinematic).mass()));
    EXPECT_EQ(world.get(kinematic).inverse_mass(), 0.0f);
    EXPECT_EQ(world.get(kinematic).momentum(), Vec3{});
}

TEST(Body, KinematicArrivesWhereItWasSent) {
    World world = WorldBuilder{}.build().value();
    ColliderDef part;
    part.shape = Box{{0.2f, 0.5f, 0.3f}};
    part.local = {{1.0f, 0.0f, 0.0f}, rotation_about({1.0f, 1.0f, 0.0f}, 0.4f)};
    BodyId id =
        world.add_rigid_body({.position = {1.0f, 2.0f, 3.0f}, .colliders = {&part, 1}, .kinematic = true}).value();
    const Position target{1.5f, 1.0f, 3.25f};
    for (float angle : {0.0f, 1e-4f, 0.3f, 3.0f}) {
        Quat q = rotation_about({1.0f, -2.0f, 0.5f}, angle);
        world.get(id).move_to(target, q, dt).value();
        run(world, 1);
        const RigidBodyRef body = world.get(id);
        EXPECT_LE(length(body.position() - target), 2e-6f) << angle;
        EXPECT_NEAR(absolute(dot(body.orientation(), q)), 1.0f, 1e-6f) << angle;
        EXPECT_LE(length(rotate(body.orientation(), Vec3{1.0f, 0.0f, 0.0f}) - rotate(q, Vec3{1.0f, 0.0f, 0.0f})), 4e-6f)
            << angle;
    }
    world.get(id).set_velocity({2.0f, 0.0f, 0.0f}).value();
    world.get(id).set_angular_velocity({}).value();
    run(world, 60);
    EXPECT_NEAR(world.get(id).position().x, target.x + 2.0f, 1e-5f) << "neither gravity nor anything else acts on it";
    EXPECT_NEAR(world.get(id).position().y, target.y, 1e-6f);
}

TEST(Body, GivenMassPropertiesWin) {
    World world = WorldBuilder{}.no_gravity().build().value();
    RigidBodyDef def{.shape = Box{{0.5f, 0.5f, 0.5f}}, .position = {1.0f, 0.0f, 0.0f}};
    def.mass = 2.0f;
    def.centre_of_mass = Vec3{0.0f, 0.25f, 0.0f};
    def.inertia = SymMat3{2.0f, 3.0f, 4.0f, 0.5f, 0.0f, 0.0f};
    const RigidBodyRef body = world.get(world.add_rigid_body(def).value());
    EXPECT_EQ(body.mass(), 2.0f);
    EXPECT_NEAR(body.centre_of_mass().y, 0.25f, 1e-6f);
    expect_near(body.inverse_inertia() * (*def.inertia * Vec3{1.0f, 2.0f, 3.0f}), {1.0f, 2.0f, 3.0f}, 1e-5f, "inertia");
    EXPECT_LT(length(body.position() - def.position), 1e-6f);
}

}  // namespace
}  // namespace lendulet::test
