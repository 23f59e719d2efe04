// Case A08: a ball dropped from 1 m. Its n-th apex is at h0 e^(2n) (Newton's restitution), whatever the step: the
// bounce happens at its own time, not at the end of a step. So is the first of what lands flat, with all corners at
// once, and it does not turn.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr double h0 = 1.0;

struct Bouncer {
    Shape shape;
    float half_height;
};
const Bouncer ball{Sphere{0.5f}, 0.5f};

struct Drop {
    World world;
    BodyId body;
    Frame frame;
    double half_height;
    Drop(const Setting& s, Ground ground, float restitution, const Bouncer& bouncer = ball)
        : world(s.world()), frame(s.frame), half_height(bouncer.half_height) {
        add_ground(world, frame, ground, 0.5f, restitution);
        body = add_body(world, frame,
                        {.shape = bouncer.shape,
                         .position = {0.0f, 1.0f + bouncer.half_height, 0.0f},
                         .restitution = restitution,
                         .mass = 1.0f});
    }
    double height() const { return place(world, frame, body).y - half_height; }
    double speed() const { return velocity(world, frame, body).y; }
    // The height at which it would turn if it flew on: the apex, also where that lies between two steps.
    double apex() const { return height() + speed() * speed() / (2.0 * standard_gravity); }
};

// Height at time t of a ball with restitution e.
double exact_height(double t, double e) {
    double v = std::sqrt(2.0 * standard_gravity * h0), fall = v / standard_gravity;
    if (t <= fall) return h0 - 0.5 * standard_gravity * t * t;
    for (t -= fall, v *= e; v > 1e-3; v *= e) {
        double flight = 2.0 * v / standard_gravity;
        if (t <= flight) return v * t - 0.5 * standard_gravity * t * t;
        t -= flight;
    }
    return 0.0;
}

// Apex `n` over h0, and the highest there was.
struct Apexes {
    double last = 0.0, highest = 0.0;
};
Apexes bounce(const Setting& s, Ground ground, float restitution, int n) {
    Drop drop(s, ground, restitution);
    Apexes found;
    double before = -1.0;
    int count = 0;
    for (int i = 0, steps = s.steps(12.0); i < steps && count < n; ++i) {
        advance(drop.world, 1, s.dt());
        double now = drop.speed();
        if (before > 0.0 && now <= 0.0) {
            ++count;
            found.last = drop.apex() / h0;
            found.highest = std::fmax(found.highest, found.last);
        }
        before = now;
    }
    if (count < n) found.last = 0.0;  // it came to rest too early
    return found;
}

// The first apex over h0 of what lands flat with e = 0.8, and how fast it then turns, rad/s.
void land_flat(const Setting& s, Ground ground, Quantity& apex, Quantity& spin) {
    const Bouncer bouncers[] = {{Box{{0.5f, 0.5f, 0.5f}}, 0.5f},
                                {Box{{0.5f, 0.1f, 0.3f}}, 0.1f},
                                {Box{{0.1f, 0.6f, 0.15f}}, 0.6f},
                                {Cylinder{0.25f, 0.4f}, 0.25f}};
    for (const Bouncer& bouncer : bouncers) {
        Drop drop(s, ground, 0.8f, bouncer);
        for (int i = 0, steps = s.steps(2.0); i < steps && !(drop.speed() > 0.0); ++i) advance(drop.world, 1, s.dt());
        apex.add(drop.apex() / h0, 0.64);
        spin.add(static_cast<double>(length(drop.world.get(drop.body).angular_velocity())));
    }
}

}  // namespace

void bounce_heights(const Setting& s, Figures& out) {
    Quantity &elastic = out.quantity("e = 1: apex 10 / h0", within(s.pick(2e-3, 2e-4))),
             &highest = out.quantity("e = 1: highest apex / h0", at_most(s.pick(5e-4, 1e-4))),
             &first = out.quantity("e = 0.5: apex 1 / h0", within(s.pick(3e-3, 1e-3))),
             &second = out.quantity("e = 0.5: apex 2 / h0", within(2e-3)),
             &dead = out.quantity("e = 0: rebound, m/s", at_most(1e-3)),
             &flat = out.quantity("boxes and a cylinder that land flat, e = 0.8: apex 1 / h0", within(3e-3)),
             &spin = out.quantity("... and how fast they then turn, rad/s", at_most(1e-2));
    Curve& curve = out.curve("a ball bounces, e = 0.5", "time, s", "height, m");
    for (Ground ground : grounds) {
        Apexes ten = bounce(s, ground, 1.0f, 10);
        elastic.add(ten.last, 1.0);
        highest.add(ten.highest, 1.0);
        first.add(bounce(s, ground, 0.5f, 1).last, 0.25);
        second.add(bounce(s, ground, 0.5f, 2).last, 0.0625);
        land_flat(s, ground, flat, spin);
        Drop drop(s, ground, 0.0f);
        for (int i = 0, steps = s.steps(2.0); i < steps; ++i) {
            advance(drop.world, 1, s.dt());
            dead.add(std::fmax(drop.speed(), 0.0));
        }
    }
    Drop drop(s, Ground::plane, 0.5f);
    const int steps = s.steps(2.0);
    for (int i = 0; i <= steps; ++i) {
        if (i > 0) advance(drop.world, 1, s.dt());
        double t = i * static_cast<double>(s.dt());
        if (i % (steps / 60) == 0) curve.add(t, drop.height(), exact_height(t, 0.5));
    }
}

}  // namespace lendulet::verify
