// What the cases share: where a case stands in the world, its settings, and the figures that it measures. Everything is
// measured in double precision from what the world reports.
#pragma once

#include <array>
#include <deque>
#include <string>

#include "lendulet/lendulet.h"
#include "scenes/random.h"
#include "verify/verify.h"

namespace lendulet::verify {

using Vec3d = Vec3T<double>;

inline constexpr double standard_gravity = 9.81;  // m/s^2
inline constexpr double pi_d = 3.14159265358979323846;
inline constexpr Vec3 down{0.0f, -9.81f, 0.0f};

inline Vec3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3d to_double(Position p) { return {p.x, p.y, p.z}; }
double length(Vec3d v);
double angle_between(Vec3d a, Vec3d b);  // in [0, pi], rad; exact for small angles too
inline double degrees(double radians) { return radians * (180.0 / pi_d); }

// Where a case stands in the world.
struct Frame {
    Quat rotation;
    Position origin;

    Position point(Vec3 local) const { return origin + rotate(rotation, local); }
    Vec3 direction(Vec3 local) const { return rotate(rotation, local); }
    Vec3d local(Position world) const;        // the frame's view of a point of the world
    Vec3d local_direction(Vec3 world) const;  // ... and of a vector
};
// Random rotations with origins between 30 and 100 m from the world's.
std::array<Frame, 5> random_frames();

// What `within` is relative to, and which side of the exact value is allowed.
struct Tolerance {
    enum class Kind { absolute, relative, at_most, at_least };
    Kind kind;
    double value;
};
inline Tolerance within(double value) { return {Tolerance::Kind::absolute, value}; }
inline Tolerance relative(double value) { return {Tolerance::Kind::relative, value}; }
// How far a value may lie above (below) the exact one; the other side is free.
inline Tolerance at_most(double excess = 0.0) { return {Tolerance::Kind::at_most, excess}; }
inline Tolerance at_least(double deficit = 0.0) { return {Tolerance::Kind::at_least, deficit}; }

// A measured quantity: keeps the worst sample.
class Quantity {
public:
    Quantity(std::string name, Tolerance tolerance) : name_(std::move(name)), tolerance_(tolerance) {}
    void add(double measured, double exact = 0.0);
    void merge(const Quantity& other);
    Row row(std::string_view case_id, Quality quality) const;
    const std::string& name() const { return name_; }

private:
    std::string name_;
    Tolerance tolerance_;
    double measured_ = 0.0, exact_ = 0.0, badness_ = 0.0;
    int64_t count_ = 0;
};

// What one run of a case in one place gives. References stay valid.
class Figures {
public:
    // `name` says the unit of the value: "height, m".
    Quantity& quantity(const std::string& name, Tolerance tolerance);
    Curve& curve(std::string title, std::string x_label, std::string y_label);
    std::deque<Quantity> quantities;
    std::deque<Curve> curves;
};

// How and where a case is run.
struct Setting {
    Quality quality = Quality::d60;
    Frame frame;
    int scale = 1;

    bool hq() const { return quality == Quality::hq; }
    double pick(double d60, double hq_value) const { return hq() ? hq_value : d60; }
    float dt() const { return hq() ? 1.0f / 240.0f : 1.0f / 60.0f; }
    int solver_steps() const { return WorldConfig{}.solver_steps; }
    int steps(double seconds) const { return static_cast<int>(seconds / static_cast<double>(dt()) + 0.5); }
    int scaled(int count, int least) const { return count / scale < least ? least : count / scale; }

    // The settings of the quality with sleeping off, and gravity given in the frame's axes.
    WorldBuilder builder(Vec3 gravity = down) const;
    World world(Vec3 gravity = down) const { return builder(gravity).build().value(); }
};

using CaseFunction = void (*)(const Setting&, Figures&);

// Bodies described in the frame's axes: pose and velocities are turned into the world's.
BodyId add_body(World& world, const Frame& frame, RigidBodyDef def);
BodyId add_fixed(World& world, const Frame& frame, StaticBodyDef def);
JointId add_joint(World& world, const Frame& frame, JointType type, BodyId a, BodyId b, Vec3 anchor,
                  Vec3 axis = {1.0f, 0.0f, 0.0f});

// Both kinds of flat ground: their top is y = 0 of the frame.
enum class Ground { plane, box };
inline constexpr Ground grounds[] = {Ground::plane, Ground::box};
BodyId add_ground(World& world, const Frame& frame, Ground ground, float friction, float restitution = 0.0f);

// What a body does, in the frame's axes.
Vec3d place(const World& world, const Frame& frame, BodyId id);  // of the centre of mass
Vec3d velocity(const World& world, const Frame& frame, BodyId id);
Vec3d spin(const World& world, const Frame& frame, BodyId id);  // angular velocity

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
// Of all dynamic bodies, with height above y = 0 of the frame, J.
double energy_above_ground(const World& world, const Frame& frame);

void advance(World& world, int steps, float dt);

}  // namespace lendulet::verify
