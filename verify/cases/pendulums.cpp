// Cases A06 and A36: one body on one joint.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

double gap(const World& world, JointId joint) { return length(to_double(world.joint(joint).linear_error)); }

// Complete elliptic integral of the first kind with modulus k, by the arithmetic-geometric mean (Abramowitz and Stegun
// 17.6).
double elliptic_k(double k) {
    double a = 1.0, b = std::sqrt(1.0 - k * k);
    while (std::fabs(a - b) > 1e-15 * a) {
        double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 0.5 * pi_d / a;
}

// A disc on a point 1 m from its centre, its axis at `theta` from the vertical, started in steady precession, the slow
// root of I1 cos(theta) W^2 - I3 w3 W + m g l = 0 (Goldstein, Classical Mechanics, 5.7).
void spin_top(const Setting& s, Figures& out, double w3, double theta, Curve* curve) {
    constexpr double i3 = 0.125, i1 = (3.0 * 0.25 + 0.01) / 12.0 + 1.0, mgl = standard_gravity;
    const double a = i1 * std::cos(theta), b = i3 * w3, W = 2.0 * mgl / (b + std::sqrt(b * b - 4.0 * a * mgl));
    World world = s.world();
    BodyId base = add_fixed(world, s.frame, {.shape = Sphere{0.02f}});
    Vec3 axis{static_cast<float>(std::sin(theta)), static_cast<float>(std::cos(theta)), 0.0f};
    Vec3 precession{0.0f, static_cast<float>(W), 0.0f};
    BodyId top = add_body(world, s.frame,
                          {.shape = Cylinder{0.05f, 0.5f},
                           .position = at(axis),
                           .orientation = rotation_about({0.0f, 0.0f, 1.0f}, static_cast<float>(-theta)),
                           .velocity = cross(precession, axis),
                           .angular_velocity = precession + static_cast<float>(w3 - W * std::cos(theta)) * axis,
                           .mass = 1.0f});
    JointId joint = add_joint(world, s.frame, JointType::ball, base, top, {});
    std::string name = std::to_string(static_cast<int>(w3)) + " rad/s at " +
                       std::to_string(static_cast<int>(degrees(theta) + 0.5)) + " degrees: ";
    Quantity &rate = out.quantity(name + "precession, rad/s", relative(s.pick(1e-3, 2e-4))),
             &tilt = out.quantity(name + "tilt of the axis, degrees", within(s.pick(0.2, 0.02))),
             &spinning = out.quantity(name + "spin, rad/s", relative(1e-4)),
             &apart = out.quantity(name + "gap of the joint, m", at_most(1e-4));
    double phase = 0.0, last = 0.0;
    const int steps = s.steps(10.0);
    for (int i = 1; i <= steps; ++i) {
        advance(world, 1, s.dt());
        Vec3d now = s.frame.local_direction(world.get(top).rotation_matrix().y);
        double angle = std::atan2(-now.z, now.x), t = i * static_cast<double>(s.dt());
        phase += std::remainder(angle - last, 2.0 * pi_d);
        last = angle;
        double tilted = degrees(std::atan2(std::hypot(now.x, now.z), now.y));
        tilt.add(tilted, degrees(theta));
        spinning.add(dot(spin(world, s.frame, top), now), w3);
        apart.add(gap(world, joint));
        if (curve && i % (steps / 40) == 0) curve->add(t, tilted, degrees(theta));
    }
    rate.add(phase / (steps * static_cast<double>(s.dt())), W);
}

// A rod hinged at its end, released at `amplitude`: T = 4 sqrt(I / m g d) K(sin(amplitude / 2)).
void swing(const Setting& s, Figures& out, int amplitude_deg, double seconds, Curve* curve) {
    constexpr double d = 0.5, inertia = (1.0 + 0.01) / 12.0 + d * d, mgd = standard_gravity * d;
    const double amplitude = amplitude_deg * pi_d / 180.0;
    const double period = 4.0 * std::sqrt(inertia / mgd) * elliptic_k(std::sin(0.5 * amplitude));
    World world = s.world();
    BodyId base = add_fixed(world, s.frame, {.shape = Sphere{0.02f}});
    // At rest the rod, along its local x, hangs along -y.
    auto turn = static_cast<float>(amplitude - 0.5 * pi_d);
    Quat orientation = rotation_about({0.0f, 0.0f, 1.0f}, turn);
    BodyId rod = add_body(world, s.frame,
                          {.shape = Box{{0.5f, 0.05f, 0.05f}},
                           .position = at(rotate(orientation, {0.5f, 0.0f, 0.0f})),
                           .orientation = orientation,
                           .mass = 1.0f});
    JointId joint = add_joint(world, s.frame, JointType::hinge, base, rod, {}, {0.0f, 0.0f, 1.0f});
    std::string name = "from " + std::to_string(amplitude_deg) + " degrees: ";
    Quantity &time = out.quantity(name + "period, s", relative(s.pick(2e-4, 5e-5))),
             &energy = out.quantity(name + "change of energy / m g d", within(s.pick(2e-3, 5e-4))),
             &apart = out.quantity(name + "gap of the joint, m", at_most(1e-4));
    const double start = energy_above_ground(world, s.frame);
    double before = amplitude, first = 0.0, last = 0.0;
    int crossings = 0;
    const int steps = s.steps(seconds);
    for (int i = 1; i <= steps; ++i) {
        advance(world, 1, s.dt());
        Vec3d x = place(world, s.frame, rod);
        double angle = std::atan2(x.x, -x.y), t = i * static_cast<double>(s.dt());
        if (before < 0.0 && angle >= 0.0 && angle - before < pi_d) {
            last = t - angle / (angle - before) * static_cast<double>(s.dt());
            if (crossings++ == 0) first = last;
        }
        before = angle;
        energy.add((energy_above_ground(world, s.frame) - start) / mgd);
        apart.add(gap(world, joint));
        if (curve && i % (steps / 30) == 0)
            curve->add(t, 1.0 + (energy_above_ground(world, s.frame) - start) / mgd, 1.0);
    }
    time.add((last - first) / (crossings - 1), period);
}

}  // namespace

void heavy_top(const Setting& s, Figures& out) {
    Curve& curve = out.curve("tilt of a heavy top, 50 rad/s", "time, s", "from the vertical, degrees");
    spin_top(s, out, 50.0, 0.5 * pi_d, &curve);
    spin_top(s, out, 100.0, 0.5 * pi_d, nullptr);
    spin_top(s, out, 100.0, pi_d / 3.0, nullptr);
}

void pendulum(const Setting& s, Figures& out) {
    Curve& curve = out.curve("energy of a pendulum from 90 degrees", "time, s", "above its lowest / m g d");
    swing(s, out, 90, 60.0, &curve);
    for (int amplitude : {5, 30, 150}) swing(s, out, amplitude, 20.0, nullptr);
}

}  // namespace lendulet::verify
