// Cases A09 to A11: balls that bounce at their own steps of 1 and 10 ms (after SimBenchmark, Hwangbo, Kang and Lee,
// leggedrobotics.github.io/SimBenchmark): the mean of the squared energy error, and of the squared overlaps.
#include <algorithm>
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr float marble_radius = 0.1f, mass = 10.0f;

World elastic_world(const Setting& s, float restitution) {
    World world = s.builder().no_friction().bounciness(restitution).build().value();
    add_ground(world, s.frame, Ground::plane, 0.0f, restitution);
    return world;
}

BodyId add_ball(World& world, const Frame& frame, Vec3 where) {
    return add_body(world, frame, {.shape = Sphere{marble_radius}, .position = at(where), .mass = mass});
}

double mean_squared_energy_error(World& world, const Setting& s, double seconds, float step, Curve* curve = nullptr) {
    const double start = energy_above_ground(world, s.frame);
    const int steps = static_cast<int>(seconds / static_cast<double>(step) + 0.5);
    double sum = 0.0;
    for (int i = 1; i <= steps; ++i) {
        advance(world, 1, step);
        double now = energy_above_ground(world, s.frame);
        sum += (now - start) * (now - start);
        if (curve && i % std::max(steps / 40, 1) == 0) curve->add(i * static_cast<double>(step), now, start);
    }
    return sum / steps;
}

// 6 x 6 x 6 balls 0.21 m apart, each a little out of its place, the lowest 1.101 m above the ground.
World cube_of_balls(const Setting& s, float restitution) {
    World world = elastic_world(s, restitution);
    scenes::Random random(42);
    for (int i = 0; i < 216; ++i) {
        auto step = [](int k) { return 0.21f * static_cast<float>(k); };
        float x = step(i % 6) + random.range(-0.001f, 0.001f);
        float z = step(i / 6 % 6) + random.range(-0.001f, 0.001f);
        add_ball(world, s.frame, {x, 1.101f + step(i / 36), z});
    }
    return world;
}

}  // namespace

// 7 x 7 balls dropped from 5 m, elastic and without friction.
void bouncing_balls(const Setting& s, Figures& out) {
    Curve& curve = out.curve("energy of 49 elastic balls, dt = 10 ms", "time, s", "energy, J");
    for (float step : {0.001f, 0.01f}) {
        const bool fine = step < 0.005f;
        World world = elastic_world(s, 1.0f);
        for (int i = 0; i < 49; ++i)
            add_ball(world, s.frame, {static_cast<float>(i % 7), 5.0f, static_cast<float>(i / 7)});
        double seconds = fine ? 20.0 / s.scale : 20.0;
        double error = mean_squared_energy_error(world, s, seconds, step, fine ? nullptr : &curve);
        out.quantity(fine ? "mean squared energy error at 1 ms, J^2" : "mean squared energy error at 10 ms, J^2",
                     at_most(fine ? 1.0 : 500.0))
            .add(error);
    }
}

void elastic_cube_of_balls(const Setting& s, Figures& out) {
    World world = cube_of_balls(s, 1.0f);
    out.quantity("mean squared energy error at 1 ms, J^2", at_most(10.0))
        .add(mean_squared_energy_error(world, s, 10.0 / s.scale, 0.001f));
}

// The mean over the steps of the sum of the squared depths, m^2.
void dead_cube_of_balls(const Setting& s, Figures& out) {
    for (float step : {0.001f, 0.01f}) {
        const bool fine = step < 0.005f;
        World world = cube_of_balls(s, 0.0f);
        const int steps = static_cast<int>((fine ? 10.0 / s.scale : 10.0) / static_cast<double>(step) + 0.5);
        double sum = 0.0;
        for (int i = 0; i < steps; ++i) {
            advance(world, 1, step);
            for (int k = 0; k < world.contact_count(); ++k) {
                Contact contact = world.contact(k);
                for (int j = 0; j < contact.point_count; ++j) {
                    double depth = std::fmax(-static_cast<double>(contact.points[j].separation), 0.0);
                    sum += depth * depth;
                }
            }
        }
        out.quantity(fine ? "mean sum of squared depths at 1 ms, m^2" : "mean sum of squared depths at 10 ms, m^2",
                     at_most(fine ? 1.4e-4 : 0.016))
            .add(sum / steps);
    }
}

}  // namespace lendulet::verify
