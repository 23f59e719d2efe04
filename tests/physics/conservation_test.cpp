// Case A07: what collisions do to each other's bodies cancels. Momentum and angular momentum of a gas of balls and of a
// burst of boxes stay what they were, and energy never rises.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/cases.h"
#include "scenes/random.h"

namespace lendulet::cases {
namespace {

constexpr double rounding = 1e-6;  // relative: energies are sums of single-precision states

struct Drift {
    Worst momentum, angular, energy;
    explicit Drift(const std::string& name)
        : momentum(name + " |dP| / sum |p|", 1e-6, ""),
          angular(name + " |dL| / sum |l|", 1e-5, ""),
          energy(name + " largest rise of energy in a step", rounding, "") {}
    void finish() const {
        momentum.finish();
        angular.finish();
        energy.finish();
    }
};

// Runs the world and follows the sums about the frame's origin. `levers`: compare L with lever arms instead of the
// bodies' own angular momenta, which vanish for radial motion.
Totals follow(World& world, const Frame& frame, int steps, bool levers, Drift& drift) {
    Totals start = totals(world, frame.origin), last = start;
    for (int i = 0; i < steps; ++i) {
        advance(world, 1);
        Totals now = totals(world, frame.origin);
        double scale = levers ? now.lever_magnitudes : start.angular_magnitudes;
        drift.momentum.add(length(now.momentum - start.momentum) / start.momentum_magnitudes);
        drift.angular.add(length(now.angular_momentum - start.angular_momentum) / scale);
        drift.energy.add(std::fmax(0.0, now.kinetic_energy / last.kinetic_energy - 1.0));
        last = now;
    }
    return last;
}

TEST(Conservation, A07aGas) {
    Drift drift("A07a");
    for (const Frame& frame : random_frames()) {
        World world = builder_in(frame, {}).friction(0.5f).bounciness(0.9f).build().value();
        scenes::Random random(64);
        for (int i = 0; i < 64; ++i) {
            Vec3 place{static_cast<float>(i % 4) - 1.5f, static_cast<float>(i / 4 % 4) - 1.5f,
                       static_cast<float>(i / 16) - 1.5f};
            // Towards the middle, so that all of them meet, and a random part.
            Vec3 velocity = -2.0f * place + 3.0f * random.direction();
            Vec3 spin = 20.0f * random.direction();
            world
                .add_rigid_body({.shape = Sphere{0.5f},
                                 .position = frame.point(1.5f * place),
                                 .velocity = frame.direction(velocity),
                                 .angular_velocity = frame.direction(spin)})
                .value();
        }
        double before = totals(world, frame.origin).kinetic_energy;
        Totals end = follow(world, frame, 120, false, drift);
        EXPECT_LT(end.kinetic_energy, 0.98 * before) << "the balls never met";
    }
    drift.finish();
}

TEST(Conservation, A07bBurst) {
    Drift drift("A07b");
    Worst symmetry("A07b |P| / sum |p| at the end", 1e-6, "");
    for (const Frame& frame : random_frames()) {
        World world = world_in(frame, {});
        for (int i = 0; i < 512; ++i) {
            Vec3 place{static_cast<float>(i % 8) - 3.5f, static_cast<float>(i / 8 % 8) - 3.5f,
                       static_cast<float>(i / 64) - 3.5f};
            BodyId box = world
                             .add_rigid_body({.shape = Box{{0.5f, 0.5f, 0.5f}},
                                              .position = frame.point(place),
                                              .orientation = frame.rotation,
                                              .density = 1.0f})
                             .value();
            world.get(box).apply_impulse(frame.direction(5.0f * normalize(place))).value();
        }
        Totals end = follow(world, frame, 300, true, drift);
        symmetry.add(length(end.momentum) / end.momentum_magnitudes);
    }
    drift.finish();
    symmetry.finish();
}

}  // namespace
}  // namespace lendulet::cases
