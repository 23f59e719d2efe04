// What the physics cases share: random frames, worlds with the shipping settings, and figures of which the worst
// counts.
//
// A case is written in its own frame (y up) and run in five worlds that are turned and moved at random: a result that
// holds along the axes only is no result. Everything is measured in double precision from what the world reports.
#pragma once

#include <array>
#include <string>

#include "lendulet/lendulet.h"

namespace lendulet::cases {

using Vec3d = Vec3T<double>;

inline constexpr double standard_gravity = 9.81;  // m/s^2
inline constexpr float dt = 1.0f / 60.0f;         // the default settings are tested at this step

inline Vec3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3d to_double(Position p) { return {p.x, p.y, p.z}; }
double length(Vec3d v);
// In [0, pi], exact for small angles too.
double angle_between(Vec3d a, Vec3d b);
double degrees(double radians);

// Where a case stands in the world.
struct Frame {
    Quat rotation;
    Position origin;

    Position point(Vec3 local) const { return origin + rotate(rotation, local); }
    Vec3 direction(Vec3 local) const { return rotate(rotation, local); }
    Vec3d local(Position world) const;        // the frame's view of a point of the world
    Vec3d local_direction(Vec3 world) const;  // ... and of a vector
    Pose pose(Vec3 position, Quat orientation = {}) const { return {point(position), rotation * orientation}; }
};

// Five random rotations with origins up to `reach` metres from the world's.
std::array<Frame, 5> random_frames(float reach = 100.0f);

// The shipping defaults with sleeping off, and gravity given in the frame's axes.
WorldBuilder builder_in(const Frame& frame, Vec3 gravity = {0.0f, -9.81f, 0.0f});
World world_in(const Frame& frame, Vec3 gravity = {0.0f, -9.81f, 0.0f});

// Both kinds of flat ground: their top is y = 0 of the frame.
enum class Ground { plane, box };
inline constexpr Ground grounds[] = {Ground::plane, Ground::box};
void add_ground(World& world, const Frame& frame, Ground ground, float friction, float restitution = 0.0f);

// Sums over all dynamic bodies: energy, linear momentum, and angular momentum about a point with the sum of its parts'
// magnitudes, which is what a drift is compared with.
struct Totals {
    double kinetic_energy = 0.0;  // J
    Vec3d momentum;               // kg m/s
    double momentum_magnitudes = 0.0;
    Vec3d angular_momentum;  // kg m^2/s
    double angular_magnitudes = 0.0;
    double lever_magnitudes = 0.0;  // sum of |x - point| |p| + |L|: does not vanish for radial motion
};
Totals totals(const World& world, Position point);

void advance(World& world, int steps, float step = dt);

// A measured quantity: keeps the largest magnitude over all frames; finish() prints and records it, and fails where it
// exceeds the tolerance or was never measured.
class Worst {
public:
    Worst(std::string name, double tolerance, std::string unit)
        : name_(std::move(name)), unit_(std::move(unit)), tolerance_(tolerance) {}
    void add(double error);
    void finish() const;
    double value() const { return worst_; }

private:
    std::string name_, unit_;
    double tolerance_, worst_ = 0.0;
    int count_ = 0;
    bool finite_ = true;
};

// Prints and records a figure that has no tolerance.
void report(const std::string& name, double value, const std::string& unit);

}  // namespace lendulet::cases
