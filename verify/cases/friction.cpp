// Cases A17, A18 and A20: Coulomb's law for a flat box, on a slope and on the level.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

// A slope of 45 degrees is level ground with gravity tilted.
const float sin45 = std::sqrt(0.5f);
const Vec3 tilted{9.81f * sin45, -9.81f * sin45, 0.0f};

BodyId add_slab(World& world, const Frame& frame, float friction, Vec3 velocity = {}, Quat turn = {}) {
    return add_body(world, frame,
                    {.shape = Box{{0.5f, 0.1f, 0.5f}},
                     .position = {0.0f, 0.1f, 0.0f},
                     .orientation = turn,
                     .velocity = velocity,
                     .friction = friction});
}

struct Slide {
    double distance, speed;  // down the slope, at the end
    double early_distance;   // after half of the time
};

Slide slide_on_slope(const Setting& s, Ground ground, float friction, double seconds) {
    World world = s.world(tilted);
    add_ground(world, s.frame, ground, friction);
    BodyId slab = add_slab(world, s.frame, friction);
    const int steps = s.steps(seconds);
    double x0 = place(world, s.frame, slab).x;
    advance(world, steps / 2, s.dt());
    double early = place(world, s.frame, slab).x - x0;
    advance(world, steps - steps / 2, s.dt());
    return {place(world, s.frame, slab).x - x0, velocity(world, s.frame, slab).x, early};
}

struct Stop {
    double distance, direction_deg, yaw_deg;
};

// A slab thrown at 5 m/s in the direction `heading` slides to a stop.
Stop slide_to_stop(const Setting& s, Ground ground, float heading, float box_turn, Curve* curve = nullptr) {
    constexpr float friction = 0.5f;
    World world = s.world();
    add_ground(world, s.frame, ground, friction);
    SinCos h = sin_cos(heading);
    BodyId slab = add_slab(world, s.frame, friction, {5.0f * h.cos, 0.0f, 5.0f * h.sin},
                           rotation_about({0.0f, 1.0f, 0.0f}, box_turn));
    Vec3d x0 = place(world, s.frame, slab), v0 = velocity(world, s.frame, slab), moved;
    Vec3d edge = s.frame.local_direction(world.get(slab).rotation_matrix().x);
    const int steps = s.steps(1.5);
    for (int i = 0; i <= steps; ++i) {
        if (i > 0) advance(world, 1, s.dt());
        moved = place(world, s.frame, slab) - x0;
        moved.y = 0.0;
        double t = i * static_cast<double>(s.dt()), a = 0.5 * standard_gravity, sliding = std::fmin(t, 5.0 / a);
        if (curve && i % (steps / 30) == 0) curve->add(t, length(moved), 5.0 * sliding - 0.5 * a * sliding * sliding);
    }
    Vec3d turned = s.frame.local_direction(world.get(slab).rotation_matrix().x);
    return {length(moved), degrees(angle_between(moved, v0)), degrees(angle_between(edge, turned))};
}

}  // namespace

// It slips just where mu < tan 45 deg, and then by g (sin - mu cos) t^2 / 2. Creep is watched for 20 s, as a place 100
// m out is told in steps of 7.6e-6 m: in less time one such step would count as more than is allowed.
void stick_slip_threshold(const Setting& s, Figures& out) {
    constexpr double seconds = 5.0, watched = 20.0;
    const int stride = 100 / s.scaled(100, 5);
    Quantity &slipping = out.quantity("largest mu that slips", at_most(0.002)),
             &sticking = out.quantity("smallest mu that sticks", at_least(0.002)),
             &wrong = out.quantity("wrong outcomes where |mu - 1| > 0.002", at_most()),
             &creep = out.quantity("creep at mu = 1.2, m/s", within(1e-6));
    for (Ground ground : grounds) {
        double largest_slip = 0.0, smallest_stick = 9.0;
        int wrong_count = 0;
        for (int i = -100; i <= 100; i += stride) {
            float friction = 1.0f + 0.001f * static_cast<float>(i);
            Slide slide = slide_on_slope(s, ground, friction, seconds);
            double expected = 0.5 * standard_gravity * std::sqrt(0.5) * (1.0 - friction) * seconds * seconds;
            bool slips = slide.distance > 0.5 * expected && slide.distance > 1e-3;
            if (slips) largest_slip = std::max<double>(largest_slip, friction);
            else smallest_stick = std::min<double>(smallest_stick, friction);
            if (std::abs(i) > 2 && slips != (i < 0)) ++wrong_count;
        }
        slipping.add(largest_slip, 1.0);
        sticking.add(smallest_stick, 1.0);
        wrong.add(wrong_count);
        Slide held = slide_on_slope(s, ground, 1.2f, 2.0 * watched);
        creep.add((held.distance - held.early_distance) / watched);
    }
}

// Down the slope with a = g (sin - mu cos); on the level to a stop after d = v^2 / (2 mu g).
void sliding_and_stopping(const Setting& s, Figures& out) {
    constexpr double seconds = 3.0, mu = 0.5;
    Quantity &acceleration = out.quantity("acceleration down the slope, m/s^2", relative(5e-4)),
             &distance = out.quantity("stopping distance, m", relative(s.pick(1e-3, 5e-4)));
    Curve& curve = out.curve("a slab slides to a stop, mu = 0.5", "time, s", "way, m");
    for (Ground ground : grounds) {
        acceleration.add(slide_on_slope(s, ground, 0.5f, seconds).speed / seconds,
                         standard_gravity * std::sqrt(0.5) * (1.0 - mu));
        bool first = ground == Ground::plane;
        distance.add(slide_to_stop(s, ground, 0.0f, 0.0f, first ? &curve : nullptr).distance,
                     25.0 / (2.0 * mu * standard_gravity));
    }
}

// All directions are alike: the friction cone is round.
void isotropy(const Setting& s, Figures& out) {
    Quantity &spread = out.quantity("longest / shortest stopping distance", within(1e-3)),
             &direction = out.quantity("direction of the way, degrees", within(0.05)),
             &yaw = out.quantity("yaw, degrees", within(0.1));
    const int stride = 90 / s.scaled(18, 3);
    for (Ground ground : grounds)
        for (bool turned : {false, true}) {
            double shortest = 1e9, longest = 0.0;
            for (int angle = 0; angle <= 90; angle += stride) {
                float heading = static_cast<float>(angle) * pi / 180.0f;
                Stop stop = slide_to_stop(s, ground, heading, turned ? heading : 0.0f);
                shortest = std::fmin(shortest, stop.distance);
                longest = std::fmax(longest, stop.distance);
                direction.add(stop.direction_deg);
                yaw.add(stop.yaw_deg);
            }
            spread.add(longest / shortest, 1.0);
        }
}

}  // namespace lendulet::verify
