// Case A26: a row of dominoes falls at a speed that scales with sqrt(g H) (McLachlan and others, SIAM Review 25, 1983;
// Efthimiou and Johnson, SIAM Review 49, 2007).
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr int count = 60;
constexpr double tilt_deg = 10.0;  // the wave is where a domino has this tilt

struct Wave {
    double speed;   // between dominoes 15 and 55, over sqrt(g H)
    double spread;  // standard deviation of the speeds over eight dominoes each, over their mean
};

Wave topple(const Setting& s, float scale, float dt) {
    const float height = 0.048f * scale, width = 0.024f * scale, thickness = 0.0075f * scale, pitch = 0.02f * scale;
    World world = s.world();
    add_ground(world, s.frame, Ground::plane, 0.5f);
    const float spin = square_root(9.81f / height);
    std::vector<BodyId> row;
    for (int i = 0; i < count; ++i) {
        RigidBodyDef def{.shape = Box{{0.5f * thickness, 0.5f * height, 0.5f * width}},
                         .position = {pitch * static_cast<float>(i), 0.5f * height, 0.0f}};
        if (i == 0) {  // about its lower front edge
            def.angular_velocity = {0.0f, 0.0f, -spin};
            def.velocity = cross(def.angular_velocity, Vec3{-0.5f * thickness, 0.5f * height, 0.0f});
        }
        row.push_back(add_body(world, s.frame, def));
    }
    const Vec3d upright = to_double(s.frame.direction({0.0f, 1.0f, 0.0f}));
    std::vector<double> passed(count, -1.0), before(count, 0.0);
    const double limit = 12.0 * std::sqrt(static_cast<double>(scale));
    for (int i = 1; i * static_cast<double>(dt) < limit && passed[count - 1] < 0.0; ++i) {
        advance(world, 1, dt);
        for (size_t k = 0; k < count; ++k) {
            if (passed[k] >= 0.0) continue;
            double now = degrees(angle_between(to_double(world.get(row[k]).rotation_matrix().y), upright));
            if (now >= tilt_deg) passed[k] = (i - (now - tilt_deg) / (now - before[k])) * static_cast<double>(dt);
            before[k] = now;
        }
    }
    const double unit = static_cast<double>(pitch) / std::sqrt(standard_gravity * static_cast<double>(height));
    auto speed_between = [&](size_t a, size_t b) {
        return passed[b] < 0.0 ? 0.0 : static_cast<double>(b - a) * unit / (passed[b] - passed[a]);
    };
    double sum = 0.0, squares = 0.0;
    for (size_t k = 15; k < 55; k += 8) {
        double v = speed_between(k, k + 8);
        sum += v;
        squares += v * v;
    }
    double mean = sum / 5.0;
    return {speed_between(15, 55), std::sqrt(std::fmax(squares / 5.0 - mean * mean, 0.0)) / mean};
}

}  // namespace

void dominoes(const Setting& s, Figures& out) {
    Wave small = topple(s, 1.0f, s.dt());
    out.quantity("speeds from domino 15 on, standard deviation / mean", at_most(0.02)).add(small.spread);
    out.quantity("speed four times as large / as it is, over sqrt(g H)", within(0.02))
        .add(topple(s, 4.0f, s.dt()).speed / small.speed, 1.0);
    out.quantity("speed sixteen times as large / as it is, over sqrt(g H)", within(0.02))
        .add(topple(s, 16.0f, s.dt()).speed / small.speed, 1.0);
    out.quantity("speed / sqrt(g H), against steps of 1/1920 s", relative(0.05))
        .add(small.speed, topple(s, 1.0f, 1.0f / 1920.0f).speed);
}

}  // namespace lendulet::verify
