// Case A24: a tall box tips over just where the moments about its lower edge change sign.
#include <cmath>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr float width = 0.5f, height = 1.0f;

// Whether a box of 1 kg on a slope, pushed horizontally at `level` above the ground, tips within 8 s. Slope and force
// grow to what is asked over the first 2 s.
struct Load {
    double slope_deg, force;
    float level;
};
bool tips(const Setting& s, Ground ground, Load load) {
    World world = s.world();
    add_ground(world, s.frame, ground, 1.0f);
    BodyId box = add_body(world, s.frame,
                          {.shape = Box{{0.5f * width, 0.5f * height, 0.5f * width}},
                           .position = {0.0f, 0.5f * height, 0.0f},
                           .friction = 1.0f,
                           .mass = 1.0f});
    const Vec3d upright = to_double(world.get(box).rotation_matrix().y);
    const int growing = s.steps(2.0);
    for (int i = 0, steps = s.steps(10.0); i < steps; ++i) {
        double part = std::fmin(static_cast<double>(i) / growing, 1.0), slope = part * load.slope_deg * pi_d / 180.0;
        world
            .set_gravity(s.frame.direction({static_cast<float>(standard_gravity * std::sin(slope)),
                                            static_cast<float>(-standard_gravity * std::cos(slope)), 0.0f}))
            .value();
        RigidBodyRef body = world.get(box);
        body.apply_force(s.frame.direction({static_cast<float>(part * load.force), 0.0f, 0.0f}),
                         body.position() + rotate(body.orientation(), {0.0f, load.level - 0.5f * height, 0.0f}))
            .value();
        advance(world, 1, s.dt());
        if (degrees(angle_between(to_double(world.get(box).rotation_matrix().y), upright)) > 5.0) return true;
    }
    return false;
}

template <class Tips>
double bisect(double stands, double falls, int halvings, Tips&& tips_at) {
    for (int i = 0; i < halvings; ++i) {
        double middle = 0.5 * (stands + falls);
        (tips_at(middle) ? falls : stands) = middle;
    }
    return 0.5 * (stands + falls);
}

}  // namespace

// On a slope at tan = b / h; pushed at height y by F = m g b / (2 y).
void tipping(const Setting& s, Figures& out) {
    Quantity &angle = out.quantity("slope at which it tips, degrees", within(0.1)),
             &force = out.quantity("force at which it tips, N", relative(5e-3));
    constexpr float level = 0.9f;
    const double exact_angle = degrees(std::atan2(width, height));
    const double exact_force = standard_gravity * static_cast<double>(width) / (2.0 * static_cast<double>(level));
    for (Ground ground : grounds) {
        angle.add(bisect(exact_angle - 0.5, exact_angle + 0.5, 6,
                         [&](double slope) {
                             return tips(s, ground, {slope, 0.0, 0.5f * height});
                         }),
                  exact_angle);
        double pushed = bisect(0.97, 1.03, 6, [&](double part) {
            return tips(s, ground, {0.0, part * exact_force, level});
        });
        force.add(pushed * exact_force, exact_force);
    }
}

}  // namespace lendulet::verify
