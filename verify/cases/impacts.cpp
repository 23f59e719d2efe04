// Cases A12 to A14: balls meet balls and walls, without gravity.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

struct CradleEnd {
    double speeds[5], energy, momentum;  // over the speed, energy and momentum of what came in
};

// Five balls in a row with `gap` between them; the last `incoming` come in at 5 m/s.
CradleEnd run_cradle(const Setting& s, float gap, int incoming) {
    constexpr float radius = 0.5f, speed = 5.0f;
    World world = s.builder({}).no_friction().max_bounciness().build().value();
    BodyId balls[5];
    for (int i = 0; i < 5; ++i) {
        bool moves = i < incoming;
        float x = static_cast<float>(i) * (2.0f * radius + gap) - (moves ? 0.3f : 0.0f);
        balls[i] = add_body(world, s.frame,
                            {.shape = Sphere{radius},
                             .position = {x, 0.0f, 0.0f},
                             .velocity = {moves ? speed : 0.0f, 0.0f, 0.0f},
                             .mass = 1.0f});
    }
    Totals before = totals(world, s.frame.origin);
    Vec3d direction = (1.0 / length(before.momentum)) * before.momentum;
    advance(world, s.steps(0.5), s.dt());
    Totals after = totals(world, s.frame.origin);
    CradleEnd end{};
    for (int i = 0; i < 5; ++i) end.speeds[i] = velocity(world, s.frame, balls[i]).x / static_cast<double>(speed);
    end.energy = after.kinetic_energy / before.kinetic_energy;
    end.momentum = dot(after.momentum, direction) / length(before.momentum);
    return end;
}

struct Outcome {
    Vec3d velocity, spin;  // in the case's frame
};

// A ball of radius 0.5 at (3, -5, 0) m/s against y = 0. `gap` moves the moment of impact within its step.
Outcome bounce(const Setting& s, Ground ground, float friction, float gap) {
    World world = s.world({});
    add_ground(world, s.frame, ground, friction, 0.8f);
    BodyId ball = add_body(world, s.frame,
                           {.shape = Sphere{0.5f},
                            .position = {-0.6f, 0.5f + gap, 0.0f},
                            .velocity = {3.0f, -5.0f, 0.0f},
                            .friction = friction,
                            .restitution = 0.8f});
    advance(world, s.steps(0.5), s.dt());
    return {velocity(world, s.frame, ball), spin(world, s.frame, ball)};
}

// Friction sees the whole normal impulse, restitution included (Brach, Mechanical Impact Dynamics, 1991). `tangential`:
// the speed along the wall afterwards.
void oblique(const Setting& s, Figures& out, float friction, double tangential) {
    constexpr double approach = 5.0, restitution = 0.8, speed = 3.0, radius = 0.5;
    const double turning = (speed - tangential) / (0.4 * radius);
    Quantity &normal = out.quantity("normal speed, m/s", relative(1e-3)),
             &along = out.quantity("tangential speed, m/s", relative(1e-3)),
             &sideways = out.quantity("sideways speed / tangential speed", within(1e-3)),
             &rolling = out.quantity("spin, rad/s", relative(2e-3)),
             &other = out.quantity("spin about other axes / spin", within(2e-3));
    for (int phase = 0; phase < 5; ++phase)
        for (Ground ground : grounds) {
            Outcome end = bounce(s, ground, friction, 1.0f + 0.017f * static_cast<float>(phase));
            normal.add(end.velocity.y, restitution * approach);
            along.add(end.velocity.x, tangential);
            sideways.add(end.velocity.z / tangential);
            rolling.add(-end.spin.z, turning);
            other.add(length(Vec3d{end.spin.x, end.spin.y, 0.0}) / turning);
        }
}

struct SuperballEnd {
    Vec3d velocity, spin;
    double energy;  // after / before
};

// A ball of radius 0.5 at (3, -5, 0) m/s and with `spin` that rolls it forward, off the floor, or off the floor, the
// underside of a table at 2 m and the floor again.
SuperballEnd throw_superball(const Setting& s, float tangential, float spin_rate, bool table) {
    World world = s.world({});
    StaticBodyDef wall{.shape = Box{{10.0f, 0.5f, 10.0f}},
                       .position = {0.0f, -0.5f, 0.0f},
                       .friction = 20.0f,
                       .restitution = 1.0f,
                       .tangential_restitution = tangential};
    add_fixed(world, s.frame, wall);
    wall.position = {0.0f, 2.5f, 0.0f};
    if (table) add_fixed(world, s.frame, wall);
    BodyId ball = add_body(world, s.frame,
                           {.shape = Sphere{0.5f},
                            .position = {-0.6f, 0.9f, 0.0f},
                            .velocity = {3.0f, -5.0f, 0.0f},
                            .angular_velocity = {0.0f, 0.0f, -spin_rate},
                            .friction = 20.0f,
                            .restitution = 1.0f,
                            .tangential_restitution = tangential});
    double before = totals(world, s.frame.origin).kinetic_energy;
    advance(world, s.steps(table ? 0.55 : 0.2), s.dt());
    return {velocity(world, s.frame, ball), spin(world, s.frame, ball),
            totals(world, s.frame.origin).kinetic_energy / before};
}

}  // namespace

// n in, n out: with gaps by momentum and energy alone, touching as in nature, where the impulse passes from ball to
// ball (Smith, Kaufman, Vouga, Tamstorf, Grinspun, "Reflections on Simultaneous Impact", SIGGRAPH 2012).
void cradle(const Setting& s, Figures& out) {
    for (bool touching : {false, true}) {
        std::string name = touching ? "touching: " : "with gaps: ";
        Quantity &last = out.quantity(name + "speed of the outgoing / v0", touching ? at_least(0.02) : within(1e-3)),
                 &others = out.quantity(name + "speed of the others / v0", within(touching ? 0.02 : 1e-3)),
                 &momentum = out.quantity(name + "momentum after / before", within(1e-6)),
                 &energy = out.quantity(name + "energy after / before", within(5e-3));
        for (int incoming : {1, 2, 3}) {
            CradleEnd end = run_cradle(s, touching ? 0.0f : 0.1f, incoming);
            for (int i = 0; i < 5; ++i)
                if (i >= 5 - incoming) last.add(end.speeds[i], 1.0);
                else others.add(end.speeds[i]);
            momentum.add(end.momentum, 1.0);
            energy.add(end.energy, 1.0);
        }
    }
}

// A ball that turns its slip round: with u = v - R w the slip, v' = v - 2/7 (1 + e_t) u and R w' = R w + 5/7 (1 + e_t)
// u (Garwin, American Journal of Physics 37, 1969). Then from floor to table to floor, which sends it back.
void superball(const Setting& s, Figures& out) {
    constexpr double speed = 3.0, radius = 0.5;
    Quantity &along = out.quantity("tangential speed, m/s", within(3e-3)),
             &turning = out.quantity("R times spin, m/s", within(3e-3)),
             &energy = out.quantity("e_t = 1: energy after / before", within(1e-4)),
             &back = out.quantity("floor, table, floor: tangential speed, m/s", within(3e-3)),
             &kept = out.quantity("floor, table, floor: energy after / before", within(1e-4));
    for (float share : {0.5f, 1.0f})
        for (float before : {-10.0f, 0.0f, 10.0f}) {
            SuperballEnd end = throw_superball(s, share, before, false);
            double u = speed - radius * before, part = (1.0 + static_cast<double>(share)) * u;
            along.add(end.velocity.x, speed - 2.0 / 7.0 * part);
            turning.add(-radius * end.spin.z, radius * before + 5.0 / 7.0 * part);
            if (share == 1.0f) energy.add(end.energy, 1.0);
        }
    double v = speed, rw = 0.0;
    for (double side : {1.0, -1.0, 1.0}) {  // at the table the ball's top rubs
        double u = v - side * rw;
        v -= 4.0 / 7.0 * u;
        rw += side * 10.0 / 7.0 * u;
    }
    SuperballEnd end = throw_superball(s, 1.0f, 0.0f, true);
    back.add(end.velocity.x, v);
    kept.add(end.energy, 1.0);
}

// The tangential impulse is mu times the normal one: dv_t = mu (1 + e) v_n.
void oblique_sliding(const Setting& s, Figures& out) { oblique(s, out, 0.05f, 3.0 - 0.05 * 1.8 * 5.0); }

// It rolls off: v_t = v / (1 + 2/5).
void oblique_gripping(const Setting& s, Figures& out) { oblique(s, out, 1.0f, 3.0 * 5.0 / 7.0); }

}  // namespace lendulet::verify
