// Case A07: what collisions do to each other's bodies cancels. Momentum and angular momentum of a gas of balls and of a
// burst of boxes stay what they were, and energy never rises.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

// Runs the world and follows the sums about the frame's origin. `levers`: compare L with lever arms instead of the
// bodies' own angular momenta, which vanish for radial motion.
Totals follow(World& world, const Setting& s, double seconds, bool levers, const std::string& name, Figures& out) {
    Quantity &momentum = out.quantity(name + ": |dP| / sum |p|", within(1e-6)),
             &angular = out.quantity(name + ": |dL| / sum |l|", within(1e-5)),
             // relative rounding of sums of single-precision states
                 &energy = out.quantity(name + ": energy after a step / before", at_most(1e-6));
    Totals start = totals(world, s.frame.origin), last = start;
    const int steps = s.steps(seconds);
    for (int i = 0; i < steps; ++i) {
        advance(world, 1, s.dt());
        Totals now = totals(world, s.frame.origin);
        double scale = levers ? now.lever_magnitudes : start.angular_magnitudes;
        momentum.add(length(now.momentum - start.momentum) / start.momentum_magnitudes);
        angular.add(length(now.angular_momentum - start.angular_momentum) / scale);
        energy.add(now.kinetic_energy / last.kinetic_energy, 1.0);
        last = now;
    }
    return last;
}

Vec3 grid_place(int i, int side) {
    float middle = 0.5f * static_cast<float>(side - 1);
    return {static_cast<float>(i % side) - middle, static_cast<float>(i / side % side) - middle,
            static_cast<float>(i / (side * side)) - middle};
}

void gas(const Setting& s, Figures& out) {
    World world = s.builder({}).friction(0.5f).bounciness(0.9f).build().value();
    scenes::Random random(64);
    for (int i = 0; i < 64; ++i) {
        Vec3 where = grid_place(i, 4);
        // Towards the middle, so that all of them meet, and a random part.
        Vec3 velocity = -2.0f * where + 3.0f * random.direction();
        Vec3 turning = 20.0f * random.direction();
        add_body(
            world, s.frame,
            {.shape = Sphere{0.5f}, .position = at(1.5f * where), .velocity = velocity, .angular_velocity = turning});
    }
    double before = totals(world, s.frame.origin).kinetic_energy;
    Totals end = follow(world, s, 2.0, false, "gas", out);
    out.quantity("gas: energy at the end / at the start (they met)", at_most()).add(end.kinetic_energy / before, 0.98);
}

void burst(const Setting& s, Figures& out) {
    World world = s.world({});
    for (int i = 0; i < 512; ++i) {
        Vec3 where = grid_place(i, 8);
        BodyId box = add_body(world, s.frame, {.shape = Box{}, .position = at(where), .density = 1.0f});
        world.get(box).apply_impulse(s.frame.direction(5.0f * normalize(where))).value();
    }
    Totals end = follow(world, s, 5.0, true, "burst", out);
    out.quantity("burst: |P| / sum |p| at the end", within(1e-6)).add(length(end.momentum) / end.momentum_magnitudes);
}

}  // namespace

void gas_and_burst(const Setting& s, Figures& out) {
    gas(s, out);
    burst(s, out);
}

}  // namespace lendulet::verify
