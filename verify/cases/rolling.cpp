// Cases A21 and A22: round bodies of I = beta m r^2 that slide, roll, and roll downhill.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr double ball_radius = 0.5;

struct Roller {
    std::string name;
    double beta;
    RigidBodyDef def;  // rolls about the frame's z axis; touches y = 0
};

std::vector<Roller> rollers() {
    constexpr float mass = 10.0f, r = 0.5f, half_height = 0.4f;
    RigidBodyDef ball{.shape = Sphere{r}}, shell = ball, cylinder{.shape = Cylinder{half_height, r}}, hoop;
    cylinder.orientation = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
    hoop = cylinder;
    constexpr float mr2 = mass * r * r, mh2 = mass * 4.0f * half_height * half_height;
    shell.inertia = SymMat3{2.0f / 3.0f * mr2, 2.0f / 3.0f * mr2, 2.0f / 3.0f * mr2};
    hoop.inertia = SymMat3{0.5f * mr2 + mh2 / 12.0f, mr2, 0.5f * mr2 + mh2 / 12.0f};
    for (RigidBodyDef* def : {&ball, &shell, &cylinder, &hoop}) {
        def->mass = mass;
        def->position = {0.0f, r, 0.0f};
    }
    return {{"ball", 0.4, ball}, {"shell", 2.0 / 3.0, shell}, {"cylinder", 0.5, cylinder}, {"hoop", 1.0, hoop}};
}

// A roller on the ground, in a world of its own.
struct Run {
    World world;
    Frame frame;
    BodyId id;
    Run(const Setting& s, Ground ground, const Roller& roller, float friction, Vec3 gravity, float speed)
        : world(s.world(gravity)), frame(s.frame) {
        add_ground(world, frame, ground, friction);
        RigidBodyDef def = roller.def;
        def.velocity = {speed, 0.0f, 0.0f};
        def.friction = friction;
        id = add_body(world, frame, def);
    }
    double speed() const { return velocity(world, frame, id).x; }
    double slip() const { return speed() + ball_radius * spin(world, frame, id).z; }  // of the point of contact
};

// Thrown without spin it slides for beta v / (mu g) and ends at v = v0 / (1 + beta), which it keeps.
void slide_one(const Setting& s, Figures& out, const Roller& roller, Ground ground) {
    constexpr double v0 = 5.0, mu = 0.3;
    const double rolling = v0 / (1.0 + roller.beta), exact_time = roller.beta * rolling / (mu * standard_gravity);
    Run run(s, ground, roller, 0.3f, down, static_cast<float>(v0));
    double start = run.speed(), z0 = place(run.world, s.frame, run.id).z;
    const int sample = s.steps(1.0 / 6.0);  // every one of them slides for longer
    advance(run.world, sample, s.dt());
    double slope = (start - run.speed()) / (sample * static_cast<double>(s.dt()));
    advance(run.world, s.steps(3.0) - sample, s.dt());
    double at_3s = run.speed();
    out.quantity(roller.name + ": speed after 3 s, m/s", relative(5e-4)).add(at_3s, rolling);
    // Where the line of sliding meets the final speed; at most a substep off.
    out.quantity(roller.name + ": sliding time, s", within(static_cast<double>(s.dt()) / s.solver_steps()))
        .add((start - at_3s) / slope, exact_time);
    out.quantity(roller.name + ": sideways after 3 s, m", within(1e-4)).add(place(run.world, s.frame, run.id).z - z0);
    advance(run.world, s.steps(7.0), s.dt());
    out.quantity(roller.name + ": speed after 10 s / after 3 s", within(2e-4)).add(run.speed() / at_3s, 1.0);
}

// The friction coefficient, as a part of the expected one, below which it slips while rolling down.
double slipping_threshold(const Setting& s, const Roller& roller, Ground ground, Vec3 gravity, double expected) {
    double low = 0.9, high = 1.1;  // slips, sticks
    for (int i = 0; i < 8; ++i) {
        double middle = 0.5 * (low + high);
        Run run(s, ground, roller, static_cast<float>(middle * expected), gravity, 0.0f);
        advance(run.world, s.steps(1.0), s.dt());
        (run.slip() > 1e-3 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

void slide_to_roll(const Setting& s, Figures& out) {
    for (const Roller& roller : rollers())
        for (Ground ground : grounds) slide_one(s, out, roller, ground);
    Curve& curve = out.curve("a thrown ball slides, then rolls", "time, s", "speed, m/s");
    Run run(s, Ground::plane, rollers()[0], 0.3f, down, 5.0f);
    const int steps = s.steps(1.5);
    for (int i = 0; i <= steps; ++i) {
        if (i > 0) advance(run.world, 1, s.dt());
        double t = i * static_cast<double>(s.dt());
        if (i % (steps / 30) == 0) curve.add(t, run.speed(), std::fmax(5.0 - 0.3 * standard_gravity * t, 5.0 / 1.4));
    }
}

// On 20 degrees: a = g sin / (1 + beta), without slipping while tan / mu <= (1 + beta) / beta.
void rolling_down(const Setting& s, Figures& out) {
    constexpr double slope = 20.0 * pi_d / 180.0, seconds = 2.0;
    const Vec3 gravity{static_cast<float>(standard_gravity * std::sin(slope)),
                       static_cast<float>(-standard_gravity * std::cos(slope)), 0.0f};
    for (const Roller& roller : rollers()) {
        const double threshold = std::tan(slope) * roller.beta / (1.0 + roller.beta);
        Quantity &acceleration = out.quantity(roller.name + ": acceleration, m/s^2", relative(1e-3)),
                 &slips = out.quantity(roller.name + ": mu at which it slips, of the exact", relative(0.01));
        for (Ground ground : grounds) {
            Run run(s, ground, roller, 0.8f, gravity, 0.0f);
            advance(run.world, s.steps(seconds), s.dt());
            acceleration.add(run.speed() / seconds, standard_gravity * std::sin(slope) / (1.0 + roller.beta));
            slips.add(slipping_threshold(s, roller, ground, gravity, threshold), 1.0);
        }
    }
}

}  // namespace lendulet::verify
