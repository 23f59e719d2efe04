// Cases A01 to A04: bodies that touch nothing, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/cases.h"
#include "scale.h"

namespace lendulet::cases {
namespace {

constexpr Vec3 start_velocity{3.0f, -2.0f, 4.0f};

// Galileo: x = x0 + v0 t + g t^2 / 2, from what the world was really given.
TEST(FreeMotion, A01FreeFall) {
    Worst position("A01 position error", 5e-3, "m"), velocity("A01 velocity error", 2e-3, "m/s");
    constexpr int steps = 600;
    for (const Frame& frame : random_frames()) {
        World world = world_in(frame);
        RigidBodyDef def{
            .shape = Sphere{0.5f}, .position = frame.point({}), .velocity = frame.direction(start_velocity)};
        def.mass = 1.0f;
        BodyId ball = world.add_rigid_body(def).value();
        Vec3d x0 = to_double(world.get(ball).position()), v0 = to_double(world.get(ball).velocity());
        Vec3d g = to_double(world.config().gravity);
        advance(world, steps);
        double t = steps * static_cast<double>(dt);
        position.add(length(to_double(world.get(ball).position()) - (x0 + t * v0 + (0.5 * t * t) * g)));
        velocity.add(length(to_double(world.get(ball).velocity()) - (v0 + t * g)));
    }
    position.finish();
    velocity.finish();
}

// Position error after 2 s of fall with linear drag: x = x0 + vt + (v0 - v_end) (1 - e^-ct) / c, v_end = g / c.
double drag_error(const Frame& frame, float drag, int steps_per_second, int solver_steps) {
    World world = builder_in(frame).solver_steps(solver_steps).build().value();
    RigidBodyDef def{.shape = Sphere{0.5f}, .position = frame.point({}), .velocity = frame.direction(start_velocity)};
    def.mass = 1.0f;
    def.linear_damping = drag;
    BodyId ball = world.add_rigid_body(def).value();
    Vec3d x0 = to_double(world.get(ball).position()), v0 = to_double(world.get(ball).velocity());
    Vec3d g = to_double(world.config().gravity);
    float step = 1.0f / static_cast<float>(steps_per_second);
    advance(world, 2 * steps_per_second, step);
    double t = 2 * steps_per_second * static_cast<double>(step), c = drag;
    Vec3d exact = x0 + t * v0 + (0.5 * t * t) * g;
    if (drag > 0.0f) exact = x0 + (t / c) * g + ((1.0 - std::exp(-c * t)) / c) * (v0 - (1.0 / c) * g);
    return length(to_double(world.get(ball).position()) - exact);
}

// Slope of log(error) over log(step), by least squares, of the steps whose error stands clear of round-off.
double fitted_slope(const std::vector<double>& steps, const std::vector<double>& errors, double floor, int* used) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < steps.size(); ++i) {
        if (errors[i] < floor) continue;
        double x = std::log(steps[i]), y = std::log(errors[i]);
        n += 1;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    *used = static_cast<int>(n);
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// In single precision a second-order error soon drowns in round-off: ulp of 24 m is 1.9e-6 m, and 960 steps each round
// a few times. What lies below the floor counts as exact.
TEST(FreeMotion, A02ConvergenceOrder) {
    constexpr double floor = 2e-5;  // m
    Worst without("A02 error without drag", floor, "m"),
        with_defaults("A02 error with drag, default substeps", floor, "m");
    double worst_slope = 1e9, coarsest = 0.0;
    for (const Frame& frame : random_frames(1.0f)) {
        std::vector<double> steps, errors;
        for (int rate : {30, 60, 120, 240, 480}) {
            without.add(drag_error(frame, 0.0f, rate, 1));
            with_defaults.add(drag_error(frame, 0.1f, rate, WorldConfig{}.solver_steps));
            steps.push_back(1.0 / rate);
            errors.push_back(drag_error(frame, 0.1f, rate, 1));
        }
        EXPECT_LE(errors.back(), floor);
        int used = 0;
        double slope = fitted_slope(steps, errors, floor, &used);
        if (used >= 2) worst_slope = std::fmin(worst_slope, slope);
        coarsest = std::fmax(coarsest, errors.front());
    }
    without.finish();
    with_defaults.finish();
    report("A02 error with drag at 1/30 s, one substep", coarsest, "m");
    if (worst_slope < 1e9) {
        report("A02 fitted order with drag", worst_slope, "(at least 1.9)");
        EXPECT_GE(worst_slope, 1.9);
    }
}

// A symmetric top's axis goes round L at L / I1 on a cone (Landau and Lifshitz, Mechanics, paragraph 33).
TEST(FreeMotion, A03SymmetricTop) {
    constexpr double i1 = 10.0 * (3.0 * 0.25 + 4.0) / 12.0, i3 = 0.5 * 10.0 * 0.25, spin = 10.0, across = 2.0;
    const double momentum = std::hypot(i1 * across, i3 * spin);
    Worst rate("A03 precession rate error", 0.2, "%"), cone("A03 cone drift", 0.2, "deg");
    Worst size("A03 |L| drift", 1e-5, ""), direction("A03 L direction drift", 0.01, "deg"),
        axial("A03 spin drift", 1e-4, "");
    constexpr int steps = 3600;
    for (const Frame& frame : random_frames()) {
        World world = world_in(frame, {});
        RigidBodyDef def{.shape = Cylinder{1.0f, 0.5f}, .position = frame.point({}), .orientation = frame.rotation};
        def.mass = 10.0f;
        def.angular_velocity = frame.direction({static_cast<float>(across), static_cast<float>(spin), 0.0f});
        BodyId top = world.add_rigid_body(def).value();
        Vec3d l0 = to_double(world.get(top).angular_momentum());
        size.add(length(l0) / momentum - 1.0);
        Vec3d e1 = cross(l0, to_double(world.get(top).rotation_matrix().y));
        e1 = (1.0 / length(e1)) * e1;
        Vec3d e2 = (1.0 / length(l0)) * cross(l0, e1);
        double phase = 0.0, last = 0.0;
        for (int i = 0; i <= steps; ++i) {
            if (i > 0) advance(world, 1);
            const RigidBodyRef body = world.get(top);
            Vec3d axis = to_double(body.rotation_matrix().y), l = to_double(body.angular_momentum());
            double now = std::atan2(dot(axis, e2), dot(axis, e1));
            if (i > 0) phase += std::remainder(now - last, 2.0 * 3.14159265358979323846);
            last = now;
            cone.add(degrees(angle_between(axis, l0) - std::atan2(i1 * across, i3 * spin)));
            size.add(length(l) / length(l0) - 1.0);
            direction.add(degrees(angle_between(l, l0)));
            axial.add(dot(to_double(body.angular_velocity()), axis) / spin - 1.0);
        }
        double seconds = steps * static_cast<double>(dt);
        rate.add(100.0 * (phase / seconds / (momentum / i1) - 1.0));
    }
    for (const Worst* worst : {&rate, &cone, &size, &direction, &axial}) worst->finish();
}

// Turning about the middle axis of inertia, close to the separatrix: it flips over 15 times a minute (Landau and
// Lifshitz, Mechanics, paragraph 37). Energy is watched for ten minutes.
TEST(FreeMotion, A04Dzhanibekov) {
    constexpr double first_flip = 2.48392;  // s
    Worst flip("A04 first flip error", 0.05, "%"), count("A04 flips in 60 s, off 15", 1, "");
    Worst size("A04 |L| drift in 10 min", 1e-5, ""), direction("A04 L direction drift in 10 min", 0.01, "deg");
    Worst energy("A04 energy drift in 10 min", 2e-4, "");
    const int steps = scaled(36000, 3600);
    for (const Frame& frame : random_frames()) {
        World world = world_in(frame, {});
        RigidBodyDef def{.shape = Box{{1.0f, 0.5f, 0.2f}}, .position = frame.point({}), .orientation = frame.rotation};
        def.mass = 12.0f;
        def.angular_velocity = frame.direction({0.05f, 5.0f, 0.05f});
        BodyId racket = world.add_rigid_body(def).value();
        Vec3d l0 = to_double(world.get(racket).angular_momentum());
        double e0 = totals(world, frame.origin).kinetic_energy, before = 5.0;
        int flips = 0;
        for (int i = 1; i <= steps; ++i) {
            advance(world, 1);
            const RigidBodyRef body = world.get(racket);
            Vec3d w = to_double(body.angular_velocity()), l = to_double(body.angular_momentum());
            double w2 = dot(w, to_double(body.rotation_matrix().y));
            if (i <= 3600 && w2 * before < 0.0) {
                double t = (i - w2 / (w2 - before)) * static_cast<double>(dt);
                if (flips++ == 0) flip.add(100.0 * (t / first_flip - 1.0));
            }
            before = w2;
            energy.add(0.5 * dot(w, l) / e0 - 1.0);
            size.add(length(l) / length(l0) - 1.0);
            direction.add(degrees(angle_between(l, l0)));
        }
        count.add(flips - 15);
    }
    for (const Worst* worst : {&flip, &count, &size, &direction, &energy}) worst->finish();
}

}  // namespace
}  // namespace lendulet::cases
