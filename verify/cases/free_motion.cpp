// Cases A01 to A04: bodies that touch nothing.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr Vec3 start_velocity{3.0f, -2.0f, 4.0f};

BodyId add_ball(World& world, const Frame& frame, float drag) {
    return add_body(world, frame,
                    {.shape = Sphere{0.5f}, .velocity = start_velocity, .mass = 1.0f, .linear_damping = drag});
}

// Position error after 2 s of fall with linear drag: x = x0 + vt + (v0 - v_end) (1 - e^-ct) / c, v_end = g / c. Near
// the world's origin, since round-off would drown the error elsewhere.
double drag_error(const Setting& s, float drag, int steps_per_second, int solver_steps) {
    Frame frame = s.frame;
    frame.origin = at(0.01f * from_origin(frame.origin));
    World world = s.builder().solver_steps(solver_steps).build().value();
    BodyId ball = add_ball(world, frame, drag);
    Vec3d x0 = to_double(world.get(ball).position()), v0 = to_double(world.get(ball).velocity());
    Vec3d g = to_double(world.config().gravity);
    float step = 1.0f / static_cast<float>(steps_per_second);
    advance(world, 2 * steps_per_second, step);
    double t = 2 * steps_per_second * static_cast<double>(step), c = drag;
    Vec3d exact = x0 + t * v0 + (0.5 * t * t) * g;
    if (drag > 0.0f) exact = x0 + (t / c) * g + ((1.0 - std::exp(-c * t)) / c) * (v0 - (1.0 / c) * g);
    return length(to_double(world.get(ball).position()) - exact);
}

}  // namespace

// Galileo: x = x0 + v0 t + g t^2 / 2, from what the world was really given.
void free_fall(const Setting& s, Figures& out) {
    Quantity &position = out.quantity("position error after 10 s, m", within(5e-3)),
             &speed = out.quantity("velocity error after 10 s, m/s", within(2e-3));
    Curve& fall = out.curve("free fall", "time, s", "height, m");
    World world = s.world();
    BodyId ball = add_ball(world, s.frame, 0.0f);
    Vec3d x0 = to_double(world.get(ball).position()), v0 = to_double(world.get(ball).velocity());
    Vec3d g = to_double(world.config().gravity);
    const int steps = s.steps(10.0);
    for (int i = 0; i <= steps; ++i) {
        if (i > 0) advance(world, 1, s.dt());
        double t = i * static_cast<double>(s.dt());
        if (i % (steps / 20) == 0)
            fall.add(t, place(world, s.frame, ball).y, start_velocity.y * t - 0.5 * standard_gravity * t * t);
        if (i < steps) continue;
        position.add(length(to_double(world.get(ball).position()) - (x0 + t * v0 + (0.5 * t * t) * g)));
        speed.add(length(to_double(world.get(ball).velocity()) - (v0 + t * g)));
    }
}

// In single precision a second-order error soon drowns in round-off: ulp of 24 m is 1.9e-6 m, and 960 steps each round
// a few times. What lies below the floor counts as exact; the slope of log(error) over log(step) is fitted to the rest.
void convergence_order(const Setting& s, Figures& out) {
    constexpr double floor = 2e-5;  // m
    Quantity &without = out.quantity("error without drag, m", within(floor)),
             &usual = out.quantity("error with drag and the quality's substeps, m", within(floor)),
             &finest = out.quantity("error with drag, one substep, 1/480 s, m", within(floor));
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int rate : {30, 60, 120, 240, 480}) {
        without.add(drag_error(s, 0.0f, rate, 1));
        usual.add(drag_error(s, 0.1f, rate, s.solver_steps()));
        double error = drag_error(s, 0.1f, rate, 1);
        if (rate == 480) finest.add(error);
        if (error < floor) continue;
        double x = std::log(1.0 / rate), y = std::log(error);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    if (n >= 2)
        out.quantity("fitted order with drag", at_least(0.1)).add((n * sxy - sx * sy) / (n * sxx - sx * sx), 2.0);
}

// A symmetric top's axis goes round L at L / I1 on a cone (Landau and Lifshitz, Mechanics, paragraph 33). Its rate is
// that of a minute, the rest is watched for ten.
void symmetric_top(const Setting& s, Figures& out) {
    constexpr double i1 = 10.0 * (3.0 * 0.25 + 4.0) / 12.0, i3 = 0.5 * 10.0 * 0.25, along = 10.0, across = 2.0;
    const double momentum = std::hypot(i1 * across, i3 * along), cone_angle = std::atan2(i1 * across, i3 * along);
    Quantity &rate = out.quantity("rate of precession, rad/s", relative(s.pick(2e-3, 1e-4))),
             &cone = out.quantity("angle of the cone, degrees", within(s.pick(0.2, 0.01))),
             &size = out.quantity("|L|, kg m^2/s", relative(1e-5)),
             &direction = out.quantity("direction of L, degrees", within(0.01)),
             &axial = out.quantity("spin about the axis, rad/s", relative(1e-4));
    World world = s.world({});
    BodyId top = add_body(world, s.frame,
                          {.shape = Cylinder{1.0f, 0.5f},
                           .angular_velocity = {static_cast<float>(across), static_cast<float>(along), 0.0f},
                           .mass = 10.0f});
    Vec3d l0 = to_double(world.get(top).angular_momentum());
    Vec3d e1 = cross(l0, to_double(world.get(top).rotation_matrix().y));
    e1 = (1.0 / length(e1)) * e1;
    Vec3d e2 = (1.0 / length(l0)) * cross(l0, e1);
    double phase = 0.0, last = 0.0;
    const int minute = s.steps(60.0), steps = s.scaled(10 * minute, minute);
    for (int i = 0; i <= steps; ++i) {
        if (i > 0) advance(world, 1, s.dt());
        const RigidBodyRef body = world.get(top);
        Vec3d axis = to_double(body.rotation_matrix().y), l = to_double(body.angular_momentum());
        double now = std::atan2(dot(axis, e2), dot(axis, e1));
        if (i > 0) phase += std::remainder(now - last, 2.0 * pi_d);
        last = now;
        if (i == minute) rate.add(phase / (minute * static_cast<double>(s.dt())), momentum / i1);
        cone.add(degrees(angle_between(axis, l0)), degrees(cone_angle));
        size.add(length(l), momentum);
        direction.add(degrees(angle_between(l, l0)));
        axial.add(dot(to_double(body.angular_velocity()), axis), along);
    }
}

namespace {

// Bodies of three different moments at 1000 rad/s, near each of their axes, for a minute.
void spin_fast(const Setting& s, Figures& out) {
    Quantity &size = out.quantity("1000 rad/s: |L|, kg m^2/s", relative(1e-5)),
             &direction = out.quantity("1000 rad/s: direction of L, degrees", within(0.01)),
             &energy = out.quantity("1000 rad/s: energy, J", relative(2e-4));
    for (Vec3 axis : {Vec3{1.0f, 0.05f, 0.03f}, Vec3{0.03f, 1.0f, 0.05f}, Vec3{0.05f, 0.03f, 1.0f}}) {
        World world = s.world({});
        BodyId body = add_body(world, s.frame,
                               {.shape = Box{{0.1f, 0.05f, 0.02f}}, .angular_velocity = 1000.0f * normalize(axis)});
        Vec3d l0 = to_double(world.get(body).angular_momentum());
        double e0 = totals(world, s.frame.origin).kinetic_energy;
        for (int i = 0, steps = s.steps(60.0 / s.scale); i < steps; ++i) {
            advance(world, 1, s.dt());
            Vec3d l = to_double(world.get(body).angular_momentum());
            size.add(length(l), length(l0));
            direction.add(degrees(angle_between(l, l0)));
            energy.add(totals(world, s.frame.origin).kinetic_energy, e0);
        }
    }
}

}  // namespace

// Turning about the middle axis of inertia, close to the separatrix: it flips over 15 times a minute (Landau and
// Lifshitz, Mechanics, paragraph 37). Energy is watched for ten minutes.
void dzhanibekov(const Setting& s, Figures& out) {
    constexpr double first_flip = 2.48392;  // s
    Quantity &flip = out.quantity("first flip, s", relative(s.pick(5e-4, 2e-4))),
             &count = out.quantity("flips in 60 s", within(1)),
             &size = out.quantity("|L| in 10 min, kg m^2/s", relative(1e-5)),
             &direction = out.quantity("direction of L in 10 min, degrees", within(0.01)),
             &energy = out.quantity("energy in 10 min, J", relative(2e-4));
    Curve& curve = out.curve("energy while tumbling", "time, s", "energy, J");
    World world = s.world({});
    BodyId racket = add_body(
        world, s.frame, {.shape = Box{{1.0f, 0.5f, 0.2f}}, .angular_velocity = {0.05f, 5.0f, 0.05f}, .mass = 12.0f});
    Vec3d l0 = to_double(world.get(racket).angular_momentum());
    double e0 = totals(world, s.frame.origin).kinetic_energy, before = 5.0;
    int flips = 0;
    const int minute = s.steps(60.0), steps = s.scaled(10 * minute, minute);
    for (int i = 1; i <= steps; ++i) {
        advance(world, 1, s.dt());
        const RigidBodyRef body = world.get(racket);
        Vec3d w = to_double(body.angular_velocity()), l = to_double(body.angular_momentum());
        double w2 = dot(w, to_double(body.rotation_matrix().y)), now = 0.5 * dot(w, l);
        if (i <= minute && w2 * before < 0.0) {
            double t = (i - w2 / (w2 - before)) * static_cast<double>(s.dt());
            if (flips++ == 0) flip.add(t, first_flip);
        }
        before = w2;
        energy.add(now, e0);
        size.add(length(l), length(l0));
        direction.add(degrees(angle_between(l, l0)));
        if (i % (steps / 20) == 0) curve.add(i * static_cast<double>(s.dt()), now, e0);
    }
    count.add(flips, 15);
    spin_fast(s, out);
}

}  // namespace lendulet::verify
