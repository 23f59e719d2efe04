// Case A23: a box of 10 kg is pulled over the ground under 25 balls of 1 kg, which roll on it (after SimBenchmark).
// With f1 = mu1 (M + n m) g from the ground, every ball gets f2 = ((F - f1) / M) / (3.5 / m + n / M) from the box, for
// its lowest point has 1 + 5/2 times the acceleration of its centre.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr double M = 10.0, m = 1.0, F = 150.0, mu_ground = 0.4;
constexpr int n = 25;

struct Accelerations {
    double box, ball;
};
Accelerations exact() {
    double f1 = mu_ground * (M + n * m) * standard_gravity, f2 = (F - f1) / M / (3.5 / m + n / M);
    return {(F - f1 - n * f2) / M, f2 / m};
}

// The mean over 4 s of the squared velocity errors of the box and of the middle ball.
double mean_squared_error(const Setting& s, Vec3 direction, double seconds, Curve* curve) {
    constexpr float step = 0.001f, radius = 0.5f;
    World world = s.world();
    add_ground(world, s.frame, Ground::plane, 0.4f);
    // The mean of two coefficients counts: 0.4 between box and ground, 0.8 between box and balls.
    BodyId box =
        add_body(world, s.frame,
                 {.shape = Box{{10.0f, 0.5f, 10.0f}}, .position = {0.0f, 0.5f, 0.0f}, .friction = 0.4f, .mass = 10.0f});
    BodyId middle{};
    for (int i = 0; i < n; ++i) {
        BodyId ball = add_body(
            world, s.frame,
            {.shape = Sphere{radius},
             .position = {2.0f * static_cast<float>(i % 5 - 2), 1.0f + radius, 2.0f * static_cast<float>(i / 5 - 2)},
             .friction = 1.2f,
             .mass = 1.0f});
        if (i == n / 2) middle = ball;
    }
    const int steps = static_cast<int>(seconds / static_cast<double>(step) + 0.5);
    const Accelerations a = exact();
    const Vec3d u = to_double(direction);
    double sum = 0.0;
    for (int i = 1; i <= steps; ++i) {
        world.get(box).apply_force(s.frame.direction(static_cast<float>(F) * direction)).value();
        advance(world, 1, step);
        double t = i * static_cast<double>(step);
        Vec3d box_error = velocity(world, s.frame, box) - (a.box * t) * u;
        Vec3d ball_error = velocity(world, s.frame, middle) - (a.ball * t) * u;
        sum += dot(box_error, box_error) + dot(ball_error, ball_error);
        if (curve && i % (steps / 20) == 0) curve->add(t, dot(velocity(world, s.frame, middle), u), a.ball * t);
    }
    return sum / steps;
}

}  // namespace

void rolling_carrier(const Setting& s, Figures& out) {
    Curve& curve = out.curve("a ball on a pulled box", "time, s", "speed, m/s");
    const double seconds = 4.0 / s.scale;
    out.quantity("pulled along an axis: mean squared velocity error, m^2/s^2", at_most(1e-5))
        .add(mean_squared_error(s, {0.0f, 0.0f, 1.0f}, seconds, nullptr));
    out.quantity("pulled at 60 degrees: mean squared velocity error, m^2/s^2", at_most(1e-5))
        .add(mean_squared_error(s, {0.5f, 0.0f, std::sqrt(0.75f)}, seconds, &curve));
}

}  // namespace lendulet::verify
