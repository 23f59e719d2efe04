// Case A19: static friction holds more than kinetic friction does.
#include <algorithm>
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr float static_mu = 0.6f, kinetic_mu = 0.4f;

BodyId add_block(World& world, const Frame& frame) {
    return add_body(world, frame,
                    {.shape = Box{{0.5f, 0.1f, 0.5f}},
                     .position = {0.0f, 0.1f, 0.0f},
                     .friction = static_mu,
                     .dynamic_friction = kinetic_mu,
                     .mass = 1.0f});
}

// Pulled by a force that grows by 0.1 m g a second, it breaks away at mu_s m g and then has a = F / m - mu_k g.
void pull(const Setting& s, Figures& out) {
    Quantity &breakaway = out.quantity("force at which it breaks away / m g", relative(0.01)),
             &acceleration = out.quantity("mean acceleration in the second after, m/s^2", relative(0.01));
    World world = s.world();
    add_fixed(world, s.frame, {.shape = Plane{}, .friction = static_mu, .dynamic_friction = kinetic_mu});
    BodyId block = add_block(world, s.frame);
    const double dt = s.dt();
    auto pull_at = [&](double t) { return 0.1 * standard_gravity * t; };
    double moving_since = 0.0, speed_then = 0.0;
    for (int i = 0, steps = s.steps(9.0); i < steps; ++i) {
        double middle = (i + 0.5) * dt;
        world.get(block).apply_force(s.frame.direction({static_cast<float>(pull_at(middle)), 0.0f, 0.0f})).value();
        advance(world, 1, s.dt());
        double v = velocity(world, s.frame, block).x, now = (i + 1) * dt;
        if (moving_since == 0.0 && v > 1e-3) {
            breakaway.add(pull_at(middle) / standard_gravity, static_mu);
            moving_since = now;
            speed_then = v;
        } else if (moving_since > 0.0 && now >= moving_since + 1.0) {
            double mean_pull = 0.5 * (pull_at(moving_since) + pull_at(now));
            acceleration.add((v - speed_then) / (now - moving_since), mean_pull - kinetic_mu * standard_gravity);
            break;
        }
    }
    if (moving_since == 0.0) breakaway.add(0.0, static_mu);  // it never moved
}

// Over N, at time t on a slow belt: it rises with the belt to mu_s, then swings over to 2 mu_k - mu_s at `frequency`,
// rad/s.
double exact_pull(double t, double rise, double frequency) {
    const double highest = static_mu, middle = kinetic_mu, half_period = pi_d / frequency;
    if (t < highest / rise) return rise * t;
    const double cycle = 2.0 * (highest - middle) / rise + half_period;
    double phase = std::fmod(t - highest / rise, cycle);
    if (phase < half_period) return middle + (highest - middle) * std::cos(frequency * phase);
    return 2.0 * middle - highest + rise * (phase - half_period);
}

// On a slow belt and held by a spring it sticks and slips by turns: the spring's force drops by 2 (mu_s - mu_k) N
// (Rabinowicz, Friction and Wear of Materials, 1965). The spring is an applied force, taken in the middle of each step.
void belt(const Setting& s, Figures& out) {
    Quantity& drop = out.quantity("drop of the spring's force / N", relative(0.05));
    Curve& curve = out.curve("stick-slip on a belt", "time, s", "spring force / N");
    constexpr double stiffness = 100.0, belt_speed = 0.01, mass = 1.0, weight = mass * standard_gravity;
    World world = s.world();
    add_body(world, s.frame,
             {.shape = Box{{5.0f, 0.5f, 2.0f}},
              .position = {0.0f, -0.5f, 0.0f},
              .velocity = {static_cast<float>(belt_speed), 0.0f, 0.0f},
              .friction = static_mu,
              .dynamic_friction = kinetic_mu,
              .kinematic = true});
    BodyId block = add_block(world, s.frame);
    const double x0 = place(world, s.frame, block).x, dt = s.dt();
    double highest = 0.0, lowest = 1e9;
    const int steps = s.steps(20.0);
    for (int i = 0; i < steps; ++i) {
        double x = place(world, s.frame, block).x - x0, v = velocity(world, s.frame, block).x;
        double force = stiffness * (x + 0.5 * dt * v);
        world.get(block).apply_force(s.frame.direction({static_cast<float>(-force), 0.0f, 0.0f})).value();
        advance(world, 1, s.dt());
        double ratio = force / weight, t = i * dt;
        highest = std::max(highest, ratio);
        if (highest > 0.55) lowest = std::min(lowest, ratio);  // it has slipped once
        if (i % (steps / 80) == 0)
            curve.add(t, ratio, exact_pull(t, stiffness * belt_speed / weight, std::sqrt(stiffness / mass)));
    }
    drop.add(highest - lowest, 2.0 * (static_cast<double>(static_mu) - static_cast<double>(kinetic_mu)));
}

}  // namespace

void static_and_kinetic(const Setting& s, Figures& out) {
    pull(s, out);
    belt(s, out);
}

}  // namespace lendulet::verify
