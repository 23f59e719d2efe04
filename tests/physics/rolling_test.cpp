// Case A21: a round body thrown without spin slides, then rolls. With I = beta m r^2 it ends at v0 / (1 + beta) after
// beta v0 / ((1 + beta) mu g), and keeps that speed: it is looked at after 3 s and again after 10 s.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/cases.h"

namespace lendulet::cases {
namespace {

struct Roller {
    const char* name;
    double beta;
    RigidBodyDef def;  // rolls about its local z (ball) or y (cylinder) axis
    Quat turn;
};

std::vector<Roller> rollers() {
    constexpr float mass = 10.0f, radius = 0.5f, half_height = 0.4f;
    const Quat lying = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
    RigidBodyDef ball{.shape = Sphere{radius}}, shell = ball, cylinder{.shape = Cylinder{half_height, radius}},
                                                hoop = cylinder;
    for (RigidBodyDef* def : {&ball, &shell, &cylinder, &hoop}) def->mass = mass;
    constexpr float mr2 = mass * radius * radius, mh2 = mass * 4.0f * half_height * half_height;
    shell.inertia = SymMat3{2.0f / 3.0f * mr2, 2.0f / 3.0f * mr2, 2.0f / 3.0f * mr2};
    hoop.inertia = SymMat3{0.5f * mr2 + mh2 / 12.0f, mr2, 0.5f * mr2 + mh2 / 12.0f};
    return {{"ball", 0.4, ball, {}},
            {"shell", 2.0 / 3.0, shell, {}},
            {"cylinder", 0.5, cylinder, lying},
            {"hoop", 1.0, hoop, lying}};
}

struct Roll {
    double speed_at_3s, speed_at_10s, lateral_at_3s, lateral_at_10s;
    double sliding_time;      // where the line of sliding meets the final speed, s
    double sliding_distance;  // of the first sample that rolls, less what it rolled since, m
};

Roll roll(const Frame& frame, Ground ground, const Roller& roller) {
    constexpr float friction = 0.3f, start_speed = 5.0f;
    constexpr int sliding_sample = 10;  // steps; every one of the bodies slides for longer
    World world = world_in(frame);
    add_ground(world, frame, ground, friction);
    RigidBodyDef def = roller.def;
    Pose pose = frame.pose({0.0f, 0.5f, 0.0f}, roller.turn);
    def.position = pose.position;
    def.orientation = pose.orientation;
    def.velocity = frame.direction({start_speed, 0.0f, 0.0f});
    def.friction = friction;
    BodyId id = world.add_rigid_body(def).value();
    auto speed = [&] { return frame.local_direction(world.get(id).velocity()).x; };
    auto place = [&] { return frame.local(world.get(id).position()); };
    Vec3d x0 = place();
    double v0 = speed();
    advance(world, sliding_sample);
    double slope = (v0 - speed()) / (sliding_sample * static_cast<double>(dt));
    advance(world, 180 - sliding_sample);
    Roll result{};
    result.speed_at_3s = speed();
    result.lateral_at_3s = place().z - x0.z;
    result.sliding_time = (v0 - result.speed_at_3s) / slope;
    result.sliding_distance =
        place().x - x0.x - result.speed_at_3s * (180 * static_cast<double>(dt) - result.sliding_time);
    advance(world, 420);
    result.speed_at_10s = speed();
    result.lateral_at_10s = place().z - x0.z;
    return result;
}

TEST(Rolling, A21SlideToRoll) {
    constexpr double v0 = 5.0, mu = 0.3;
    const double substep = static_cast<double>(dt) / WorldConfig{}.solver_steps;
    for (const Roller& roller : rollers()) {
        std::string name = std::string("A21 ") + roller.name;
        Worst speed(name + " speed error", 0.05, "%"), time(name + " time error", substep, "s");
        Worst lateral(name + " lateral at 3 s", 1e-4, "m"), loss(name + " change of speed from 3 to 10 s", 0.02, "%");
        double rolling = v0 / (1.0 + roller.beta), sliding_time = roller.beta * rolling / (mu * standard_gravity);
        double sliding_distance = 0.5 * (v0 * v0 - rolling * rolling) / (mu * standard_gravity), distance_error = 0.0,
               late_lateral = 0.0;
        for (const Frame& frame : random_frames())
            for (Ground ground : grounds) {
                Roll end = roll(frame, ground, roller);
                speed.add(100.0 * (end.speed_at_3s / rolling - 1.0));
                time.add(end.sliding_time - sliding_time);
                lateral.add(end.lateral_at_3s);
                late_lateral = std::fmax(late_lateral, std::fabs(end.lateral_at_10s));
                loss.add(100.0 * (end.speed_at_10s / end.speed_at_3s - 1.0));
                distance_error = std::fmax(distance_error, std::fabs(end.sliding_distance / sliding_distance - 1.0));
            }
        for (const Worst* worst : {&speed, &time, &lateral, &loss}) worst->finish();
        report(name + " lateral at 10 s", late_lateral, "m");
        report(name + " sliding distance error", 100.0 * distance_error, "%");
    }
}

}  // namespace
}  // namespace lendulet::cases
