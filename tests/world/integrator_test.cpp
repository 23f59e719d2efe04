// The four integrators on bodies that touch nothing: their order, and what they do to energy and L. The figures of
// docs/integrators.md come from here: run with LENDULET_INTEGRATOR_TABLE=1 to print them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr Integrator integrators[] = {Integrator::explicit_euler, Integrator::symplectic_euler,
                                      Integrator::runge_kutta_4, Integrator::momentum};
constexpr int rates[] = {30, 60, 120, 240, 480};  // steps a second, one substep each

struct Errors {
    double value[std::size(rates)];
};

// Distance from the exact place after 2 s of fall with linear drag of 0.5 /s:
// x = v_end t + (v0 - v_end) (1 - e^-ct) / c with v_end = g / c.
double fall_error(Integrator integrator, int rate) {
    World world = WorldBuilder{}.integrator(integrator).solver_steps(1).build().value();
    RigidBodyDef def{.shape = Sphere{0.5f}, .velocity = {3.0f, 8.0f, -2.0f}};
    def.linear_damping = 0.5f;
    BodyId ball = world.add_rigid_body(def).value();
    run(world, 2 * rate, 1.0f / static_cast<float>(rate));
    const double c = 0.5, t = 2.0, g = static_cast<double>(-9.81f), gone = (1.0 - std::exp(-c * t)) / c;
    const double exact[3] = {3.0 * gone, g / c * t + (8.0 - g / c) * gone, -2.0 * gone};
    Position x = world.get(ball).position();
    return std::hypot(x.x - exact[0], x.y - exact[1], x.z - exact[2]);
}

// A box that tumbles about its middle axis, for `seconds`.
struct Tumble {
    double energy_drift = 0.0, momentum_drift = 0.0;  // relative, at the end
    double worst_energy_drift = 0.0;
    bool momentum_unchanged = true;  // to the last bit, at every step
    Quat orientation;
};
Tumble tumble(Integrator integrator, int rate, float seconds) {
    World world = WorldBuilder{}.no_gravity().integrator(integrator).solver_steps(1).build().value();
    RigidBodyDef def{.shape = Box{{1.0f, 0.5f, 0.2f}}, .angular_velocity = {0.05f, 5.0f, 0.05f}};
    def.mass = 12.0f;
    BodyId id = world.add_rigid_body(def).value();
    const RigidBodyRef body = world.get(id);
    const Vec3 L = body.angular_momentum();
    const double energy = world.kinetic_energy();
    Tumble out;
    int steps = static_cast<int>(seconds * static_cast<float>(rate) + 0.5f);
    for (int i = 0; i < steps; ++i) {
        run(world, 1, 1.0f / static_cast<float>(rate));
        out.momentum_unchanged &= body.angular_momentum() == L;
        out.energy_drift = world.kinetic_energy() / energy - 1.0;
        out.worst_energy_drift = std::fmax(out.worst_energy_drift, std::fabs(out.energy_drift));
    }
    Vec3 change = body.angular_momentum() - L;
    out.momentum_drift = length(change) / length(L);
    out.orientation = body.orientation();
    return out;
}

// Angle between the orientation after 1 s and one from 3840 steps a second of Runge-Kutta, rad.
double turn_error(Integrator integrator, int rate) {
    static const Quat exact = tumble(Integrator::runge_kutta_4, 3840, 1.0f).orientation;
    Quat d = tumble(integrator, rate, 1.0f).orientation * conjugate(exact);
    return 2.0 * std::asin(std::fmin(1.0, std::hypot(d.x, d.y, d.z)));
}

// Slope of log(error) over log(step) by least squares, over the errors that stand clear of rounding.
double fitted_order(const Errors& errors, double floor) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < std::size(rates); ++i) {
        if (errors.value[i] < floor) continue;
        double x = -std::log(static_cast<double>(rates[i])), y = std::log(errors.value[i]);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return n < 2 ? 0.0 : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

template <class Measure>
Errors over_rates(Measure&& measure) {
    Errors e;
    for (size_t i = 0; i < std::size(rates); ++i) e.value[i] = measure(rates[i]);
    return e;
}

TEST(Integrators, OrdersInFallWithDrag) {
    auto errors = [](Integrator i) { return over_rates([i](int rate) { return fall_error(i, rate); }); };
    EXPECT_NEAR(fitted_order(errors(Integrator::explicit_euler), 1e-4), 1.0, 0.1);
    EXPECT_NEAR(fitted_order(errors(Integrator::symplectic_euler), 1e-4), 1.0, 0.1);
    // What is left of these two is rounding at every step.
    for (double e : errors(Integrator::runge_kutta_4).value) EXPECT_LT(e, 1e-4);
    Errors m = errors(Integrator::momentum);
    EXPECT_GE(fitted_order(m, 1e-5), 1.9);
    EXPECT_LT(m.value[1], 1e-3);
}

TEST(Integrators, OrdersInTumbling) {
    auto order = [](Integrator i, int rate) { return std::log2(turn_error(i, rate) / turn_error(i, 2 * rate)); };
    EXPECT_NEAR(order(Integrator::explicit_euler, 120), 1.0, 0.15);
    EXPECT_NEAR(order(Integrator::symplectic_euler, 120), 1.0, 0.15);
    EXPECT_NEAR(order(Integrator::runge_kutta_4, 8), 4.0, 0.6);  // finer steps drown in rounding
    // Up to 1/240 s it turns in parts of about that length; half of those, and half of the error is rounding.
    for (int rate : {30, 60, 120, 240}) EXPECT_LT(turn_error(Integrator::momentum, rate), 4e-6) << rate;
    EXPECT_LT(turn_error(Integrator::momentum, 480), 2e-6);
}

TEST(Integrators, MomentumKeepsLToTheLastBitAndEnergyWithoutDrift) {
    for (int rate : {30, 60, 240}) {
        Tumble t = tumble(Integrator::momentum, rate, 30.0f);
        EXPECT_TRUE(t.momentum_unchanged) << rate;
        EXPECT_LT(t.worst_energy_drift, 5e-6) << rate;
    }
    // Explicit Euler moves energy; the better method is better.
    double explicit_drift = std::fabs(tumble(Integrator::explicit_euler, 60, 10.0f).energy_drift);
    double runge_kutta_drift = std::fabs(tumble(Integrator::runge_kutta_4, 60, 10.0f).energy_drift);
    EXPECT_GT(explicit_drift, 1e-3);
    EXPECT_LT(runge_kutta_drift, 0.1 * explicit_drift);
}

using Quat64 = QuatT<double>;
using Vec64 = Vec3T<double>;

Quat64 turn_about(Vec64 axis, double angle) {
    const double s = std::sin(0.5 * angle) / std::sqrt(dot(axis, axis));
    return {s * axis.x, s * axis.y, s * axis.z, std::cos(0.5 * angle)};
}

// A body with two equal moments turns about its axis and the axis about L, both evenly, at any speed and in any step.
TEST(Integrators, SymmetricBodiesTurnAsTheClosedFormSays) {
    const Shape shapes[] = {Capsule{0.5f, 0.2f}, Cylinder{0.1f, 0.6f}, Box{{0.8f, 0.2f, 0.2f}},
                            Box{{0.3f, 0.3f, 0.9f}}};
    const Vec64 axes[] = {{0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 4; ++i)
        for (float spin : {0.3f, 5.0f, 100.0f, 1000.0f})
            for (float dt : {1.0f / 240.0f, 1.0f / 60.0f, 1.0f / 15.0f}) {
                World world = WorldBuilder{}.no_gravity().build().value();
                const Quat q0 = normalize(Quat{0.3f, -0.2f, 0.5f, 0.7f});
                const BodyId id = world
                                      .add_rigid_body({.shape = shapes[i],
                                                       .orientation = q0,
                                                       .angular_velocity = {0.6f * spin, 0.64f * spin, -0.48f * spin}})
                                      .value();
                const RigidBodyRef body = world.get(id);
                const Vec3 l = body.angular_momentum(), w = body.angular_velocity();
                const double energy = world.kinetic_energy();
                run(world, static_cast<int>(std::lround(1.0f / dt)), dt);
                EXPECT_NEAR(world.kinetic_energy(), energy, (2e-6 + 5e-8 * static_cast<double>(spin)) * energy)
                    << i << ", " << spin << " rad/s";

                const Quat64 q{q0.x, q0.y, q0.z, q0.w};
                const Vec64 axis = rotate(q, axes[i]), L{l.x, l.y, l.z}, W{w.x, w.y, w.z};
                const double L2 = dot(L, L), along = dot(W, axis);
                const Vec64 across = W - along * axis, pull = L - dot(L, axis) * axis;
                const double precession = std::sqrt(L2) * std::sqrt(dot(across, across) / dot(pull, pull));
                const double own = along - precession * dot(L, axis) / std::sqrt(L2);
                const Quat64 exact = multiply(turn_about(L, precession), multiply(turn_about(axis, own), q));
                const Quat now = body.orientation();
                const Quat64 off = multiply(Quat64{now.x, now.y, now.z, now.w}, conjugate(exact));
                // Orientations are rounded some thousand times; where the axis leans by that, the rates are others.
                EXPECT_LT(2.0 * std::sqrt(off.x * off.x + off.y * off.y + off.z * off.z),
                          2e-6 + static_cast<double>(spin > 500.0f ? 2e-4f * spin : 1e-5f * spin))
                    << i << ", " << spin << " rad/s, steps of " << dt << " s";
            }
}

// Chosen for bodies that touch nothing only: in contact all give the same.
TEST(Integrators, ContactsAreSolvedWithEveryOne) {
    uint64_t hashes[4];
    for (size_t i = 0; i < 4; ++i) {
        World world = WorldBuilder{}.integrator(integrators[i]).sleep(false).build().value();
        add_floor(world);
        add_stack(world, 0.0f, 3);
        run(world, 60);
        EXPECT_NEAR(world.get(world.body(3)).position().y, 2.5f, 0.02f);
        hashes[i] = world.hash();
    }
    for (uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

// Largest distance in the fifth second of a ball on a spring that the program itself computes, from 1 m.
float spring_amplitude(float hertz, float damping_ratio, bool by_impulse) {
    World world = WorldBuilder{}.no_gravity().build().value();
    const BodyId ball = world.add_rigid_body({.shape = Sphere{}, .position = {1.0f, 0.0f, 0.0f}, .mass = 1.0f}).value();
    const float omega = 2.0f * pi * hertz;
    float largest = 0.0f;
    for (int i = 0; i < 300; ++i) {
        RigidBodyRef body = world.get(ball);
        const Vec3 away = from_origin(body.position());
        const Vec3 force = -omega * omega * away - 2.0f * damping_ratio * omega * body.velocity();
        if (by_impulse) body.apply_impulse(dt * force).value();
        else body.apply_force(force).value();
        world.update(dt).value();
        if (i > 240) largest = maximum(largest, absolute(body.position().x));
    }
    return largest;
}

TEST(Integrators, SpringsOfTheProgramKeepTheirEnergyAsImpulses) {
    for (float hertz : {0.5f, 1.0f, 2.0f, 4.0f}) {
        EXPECT_NEAR(spring_amplitude(hertz, 0.0f, true), 1.0f, 0.03f) << hertz;
        if (hertz > 2.0f) continue;  // the limit on speed would end the growth
        const float turned = 2.0f * pi * hertz * dt, growth = std::pow(1.0f + 0.5f * turned * turned, 0.5f * 300.0f);
        const float by_force = spring_amplitude(hertz, 0.0f, false);
        EXPECT_GT(by_force, 0.8f * growth) << hertz;
        EXPECT_LT(by_force, 1.1f * growth) << hertz;
    }
}

void print_row(const char* name, const Errors& e) {
    std::printf("| %s |", name);
    for (double v : e.value) std::printf(" %.2g |", v);
    std::printf("\n");
}

TEST(Integrators, Table) {
    if (!std::getenv("LENDULET_INTEGRATOR_TABLE")) GTEST_SKIP() << "set LENDULET_INTEGRATOR_TABLE to print the table";
    for (Integrator i : integrators) {
        std::string name(name_of(i));
        print_row((name + ", place after 2 s, m").c_str(), over_rates([i](int r) { return fall_error(i, r); }));
        print_row((name + ", turn after 1 s, rad").c_str(), over_rates([i](int r) { return turn_error(i, r); }));
        print_row((name + ", energy after 10 s").c_str(),
                  over_rates([i](int r) { return tumble(i, r, 10.0f).energy_drift; }));
        print_row((name + ", worst energy in 10 s").c_str(),
                  over_rates([i](int r) { return tumble(i, r, 10.0f).worst_energy_drift; }));
        print_row((name + ", L after 10 s").c_str(),
                  over_rates([i](int r) { return tumble(i, r, 10.0f).momentum_drift; }));
    }
    for (float hertz : {0.5f, 1.0f, 2.0f, 4.0f}) {
        std::printf("| spring of %g Hz |", static_cast<double>(hertz));
        for (bool by_impulse : {false, true})
            std::printf(" %.3g (%.2g) |", static_cast<double>(spring_amplitude(hertz, 0.0f, by_impulse)),
                        static_cast<double>(spring_amplitude(hertz, 0.05f, by_impulse)));
        std::printf("\n");
    }
}

}  // namespace
}  // namespace lendulet::test
