#include "physics/cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>

#include "scenes/random.h"

namespace lendulet::cases {
namespace {

QuatT<double> unit_double(Quat q) {
    double x = q.x, y = q.y, z = q.z, w = q.w;
    double s = 1.0 / std::sqrt(x * x + y * y + z * z + w * w);
    return {s * x, s * y, s * z, s * w};
}

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

}  // namespace

double length(Vec3d v) { return std::sqrt(dot(v, v)); }
double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }
double degrees(double radians) { return radians * (180.0 / 3.14159265358979323846); }

Vec3d Frame::local(Position world) const {
    return rotate_inverse(unit_double(rotation), to_double(world) - to_double(origin));
}
Vec3d Frame::local_direction(Vec3 world) const { return rotate_inverse(unit_double(rotation), to_double(world)); }

std::array<Frame, 5> random_frames(float reach) {
    std::array<Frame, 5> frames;
    scenes::Random random(2026);
    for (Frame& frame : frames) {
        frame.rotation = random.rotation();
        Vec3 direction = random.direction();
        frame.origin = at(random.range(0.3f * reach, reach) * direction);
    }
    return frames;
}

WorldBuilder builder_in(const Frame& frame, Vec3 gravity) {
    WorldBuilder builder;
    builder.gravity(frame.direction(gravity)).sleep(false);
    return builder;
}

World world_in(const Frame& frame, Vec3 gravity) { return builder_in(frame, gravity).build().value(); }

void add_ground(World& world, const Frame& frame, Ground ground, float friction, float restitution) {
    StaticBodyDef def;
    def.shape = Plane{};
    Pose pose = frame.pose({});
    if (ground == Ground::box) {
        def.shape = Box{{60.0f, 1.0f, 60.0f}};
        pose = frame.pose({0.0f, -1.0f, 0.0f});
    }
    def.position = pose.position;
    def.orientation = pose.orientation;
    def.friction = friction;
    def.restitution = restitution;
    world.add_static_body(def).value();
}

Totals totals(const World& world, Position point) {
    Totals sum;
    for (int i = 0; i < world.body_count(); ++i) {
        BodyId id = world.body(i);
        if (world.get_static(id).type() != BodyType::dynamic) continue;
        const RigidBodyRef body = world.get(id);
        Vec3d p = to_double(body.momentum()), spin = to_double(body.angular_momentum());
        Vec3d arm = to_double(body.centre_of_mass()) - to_double(point);
        Vec3d whole = cross(arm, p) + spin;
        double inverse_mass = body.inverse_mass();
        sum.kinetic_energy += 0.5 * dot(p, p) * inverse_mass + 0.5 * dot(spin, to_double(body.angular_velocity()));
        sum.momentum += p;
        sum.momentum_magnitudes += length(p);
        sum.angular_momentum += whole;
        sum.angular_magnitudes += length(whole);
        sum.lever_magnitudes += length(arm) * length(p) + length(spin);
    }
    return sum;
}

void advance(World& world, int steps, float step) {
    for (int i = 0; i < steps; ++i) world.update(step).value();
}

void Worst::add(double error) {
    ++count_;
    finite_ = finite_ && std::isfinite(error);
    if (std::fabs(error) > worst_) worst_ = std::fabs(error);
}

void Worst::finish() const {
    report(name_, worst_, unit_ + "  (at most " + text_of(tolerance_) + ")");
    EXPECT_GT(count_, 0) << name_;
    EXPECT_TRUE(finite_) << name_;
    EXPECT_LE(worst_, tolerance_) << name_ << ", " << unit_;
}

void report(const std::string& name, double value, const std::string& unit) {
    std::cout << "    " << name << ": " << text_of(value) << ' ' << unit << '\n';
    ::testing::Test::RecordProperty(name, text_of(value));
}

}  // namespace lendulet::cases
