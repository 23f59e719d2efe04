// Case A34: rolling and spinning friction on single bodies, where it has closed forms, and what it makes of a pile.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr float roller_radius = 0.5f;

// A body of moment beta m r^2 that rolls against b N slows by b g / (r (1 + beta)), until it stands.
void rolls_out(const Setting& s, Figures& out, const char* name, const Shape& shape, Quat turned, double beta) {
    constexpr float arm = 0.02f, v0 = 2.0f;
    const double slowing = arm * standard_gravity / (roller_radius * (1.0 + beta));
    Quantity &rate = out.quantity(std::string(name) + ": slowing by rolling friction, m/s^2", relative(2e-3)),
             &way = out.quantity(std::string(name) + ": way until it stands, m", relative(2e-3)),
             &rest = out.quantity(std::string(name) + ": speed after that, m/s", within(1e-4));
    World world = s.world();
    add_fixed(world, s.frame,
              {.shape = Box{{40.0f, 0.5f, 10.0f}}, .position = {0.0f, -0.5f, 0.0f}, .rolling_friction = arm});
    BodyId body = add_body(world, s.frame,
                           {.shape = shape,
                            .position = {0.0f, roller_radius, 0.0f},
                            .orientation = turned,
                            .velocity = {v0, 0.0f, 0.0f},
                            .angular_velocity = {0.0f, 0.0f, -v0 / roller_radius},
                            .rolling_friction = arm});
    double start = place(world, s.frame, body).x;
    advance(world, s.steps(1.0), s.dt());
    double early = velocity(world, s.frame, body).x;
    advance(world, s.steps(2.0), s.dt());
    rate.add((early - velocity(world, s.frame, body).x) / 2.0, slowing);
    Curve& curve = out.curve(std::string(name) + " that rolls to a stop", "time, s", "speed, m/s");
    const double standing = v0 / slowing;
    for (double t = 3.0; t < 1.5 * standing; t += 0.25) {
        curve.add(t, velocity(world, s.frame, body).x, std::fmax(v0 - slowing * t, 0.0));
        advance(world, s.steps(0.25), s.dt());
    }
    way.add(place(world, s.frame, body).x - start, 0.5 * v0 * v0 / slowing);
    rest.add(length(velocity(world, s.frame, body)));
}

// A ball that turns about the normal against s N slows by 5 s g / (2 r^2).
void spins_out(const Setting& s, Figures& out) {
    constexpr float arm = 0.01f, w0 = 10.0f;
    Quantity &rate = out.quantity("ball: slowing by spinning friction, rad/s^2", relative(2e-3)),
             &place_kept = out.quantity("ball: way while it spins, m", within(1e-4));
    World world = s.world();
    add_fixed(world, s.frame,
              {.shape = Box{{5.0f, 0.5f, 5.0f}}, .position = {0.0f, -0.5f, 0.0f}, .spinning_friction = arm});
    BodyId ball = add_body(world, s.frame,
                           {.shape = Sphere{roller_radius},
                            .position = {0.0f, roller_radius, 0.0f},
                            .angular_velocity = {0.0f, w0, 0.0f},
                            .spinning_friction = arm});
    advance(world, s.steps(1.0), s.dt());
    double early = spin(world, s.frame, ball).y;
    advance(world, s.steps(4.0), s.dt());
    rate.add((early - spin(world, s.frame, ball).y) / 4.0,
             2.5 * arm * standard_gravity / (roller_radius * roller_radius));
    Vec3d at = place(world, s.frame, ball);
    place_kept.add(std::hypot(at.x, at.z));
}

// On a slope a ball stays where tan(slope) is less than b / r, and rolls where it is more.
void stays_on_slope(const Setting& s, Figures& out) {
    constexpr double slope = 0.1;  // rad
    const double arm = roller_radius * std::tan(slope);
    Quantity &stays = out.quantity("slope: creep below the threshold, m/s", within(1e-5)),
             &rolls = out.quantity("slope: acceleration above it, m/s^2", relative(5e-3));
    for (double share : {1.05, 0.8}) {
        World world = s.world(Vec3{static_cast<float>(standard_gravity * std::sin(slope)),
                                   static_cast<float>(-standard_gravity * std::cos(slope)), 0.0f});
        const float given = static_cast<float>(share * arm);
        add_fixed(world, s.frame,
                  {.shape = Box{{40.0f, 0.5f, 5.0f}}, .position = {0.0f, -0.5f, 0.0f}, .rolling_friction = given});
        BodyId ball = add_body(
            world, s.frame,
            {.shape = Sphere{roller_radius}, .position = {0.0f, roller_radius, 0.0f}, .rolling_friction = given});
        advance(world, s.steps(1.0), s.dt());
        double x = place(world, s.frame, ball).x, v = velocity(world, s.frame, ball).x;
        advance(world, s.steps(3.0), s.dt());
        if (share > 1.0) stays.add((place(world, s.frame, ball).x - x) / 3.0);
        else
            rolls.add((velocity(world, s.frame, ball).x - v) / 3.0,
                      standard_gravity * std::sin(slope) * (1.0 - share) * 5.0 / 7.0);
    }
}

// The slope of a heap of balls that was let go as a column: a cone of slope tan(phi) has its centre of mass at half the
// mean distance of its matter from the axis times that.
double heap_angle(const Setting& s, float friction, float rolling, uint64_t seed, float dt) {
    constexpr float r = 0.02f;
    constexpr int side = 8, layers = 24;
    World world = s.builder().friction(friction).build().value();
    const float arm = rolling * r;
    add_fixed(world, s.frame,
              {.shape = Box{{3.0f, 0.1f, 3.0f}}, .position = {0.0f, -0.1f, 0.0f}, .rolling_friction = arm});
    scenes::Random random(seed);
    std::vector<BodyId> balls;
    for (int layer = 0; layer < layers; ++layer)
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k) {
                auto along = [&](int n) {
                    return 2.2f * r * (static_cast<float>(n) - 0.5f * (side - 1)) + random.range(-0.1f * r, 0.1f * r);
                };
                const float across = along(i), ahead = along(k);
                Vec3 x{across, 1.1f * r + 2.2f * r * static_cast<float>(layer), ahead};
                balls.push_back(
                    add_body(world, s.frame, {.shape = Sphere{r}, .position = at(x), .rolling_friction = arm}));
            }
    for (int i = 0, steps = static_cast<int>(4.0f / dt); i < steps; ++i) world.update(dt).value();
    Vec3d middle{};
    double n = 0.0;
    for (BodyId ball : balls) {
        Vec3d x = place(world, s.frame, ball);
        if (std::hypot(x.x, x.z) < 1.0) middle = middle + x, n += 1.0;
    }
    middle = (1.0 / n) * middle;
    double away = 0.0, height = 0.0;
    for (BodyId ball : balls) {
        Vec3d x = place(world, s.frame, ball);
        if (std::hypot(x.x, x.z) >= 1.0) continue;  // those that rolled off by themselves
        away += std::hypot(x.x - middle.x, x.z - middle.z) / n;
        height += (x.y - r) / n;
    }
    return degrees(std::atan(2.0 * height / away));
}

}  // namespace

// Steeper with sliding and with rolling friction, whatever the seed and the step (Zhou, Xu, Yu, Zulli, Physical Review
// E 64, 2001, for the trend).
void angle_of_repose(const Setting& s, Figures& out) {
    rolls_out(s, out, "ball", Sphere{roller_radius}, {}, 0.4);
    rolls_out(s, out, "cylinder", Cylinder{0.4f, roller_radius}, rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi), 0.5);
    spins_out(s, out);
    stays_on_slope(s, out);
    if (s.scale >= 20) return;  // a slow build
    Quantity &friction = out.quantity("heap: rise of the angle from friction 0.1 to 0.6, degrees", at_least(0.0)),
             &rolling = out.quantity("heap: rise from rolling friction 0 to 0.1 r, degrees", at_least(0.0)),
             &more = out.quantity("heap: rise from 0.1 r to 0.3 r, degrees", at_least(0.0)),
             &seeds = out.quantity("heap: another seed, degrees", within(2.0)),
             &halved = out.quantity("heap: half the step, degrees", within(2.0));
    const double smooth = heap_angle(s, 0.1f, 0.1f, 1, s.dt()), rough = heap_angle(s, 0.6f, 0.1f, 1, s.dt()),
                 bare = heap_angle(s, 0.6f, 0.0f, 1, s.dt()), most = heap_angle(s, 0.6f, 0.3f, 1, s.dt());
    friction.add(rough - smooth, 1.0);
    rolling.add(rough - bare, 1.0);
    more.add(most - rough, 1.0);
    seeds.add(heap_angle(s, 0.6f, 0.1f, 2, s.dt()), rough);
    halved.add(heap_angle(s, 0.6f, 0.1f, 1, 0.5f * s.dt()), rough);
}

}  // namespace lendulet::verify
