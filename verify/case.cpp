#include "verify/case.h"

#include <cmath>
#include <limits>

namespace lendulet::verify {
namespace {

QuatT<double> unit_double(Quat q) {
    double x = q.x, y = q.y, z = q.z, w = q.w;
    double s = 1.0 / std::sqrt(x * x + y * y + z * z + w * w);
    return {s * x, s * y, s * z, s * w};
}

// How bad a value is; negative where it is on the free side of a one-sided bound.
double badness(Tolerance tolerance, double measured, double exact) {
    if (!std::isfinite(measured) || !std::isfinite(exact)) return std::numeric_limits<double>::infinity();
    switch (tolerance.kind) {
        case Tolerance::Kind::absolute:
            return std::fabs(measured - exact);
        case Tolerance::Kind::relative:
            return std::fabs(measured / exact - 1.0);
        case Tolerance::Kind::at_most:
            return measured - exact;
        case Tolerance::Kind::at_least:
            return exact - measured;
    }
    return std::numeric_limits<double>::infinity();
}

template <class Visit>
void for_each_dynamic(const World& world, Visit&& visit) {
    for (int i = 0; i < world.body_count(); ++i) {
        BodyId id = world.body(i);
        if (world.get_static(id).type() == BodyType::dynamic) visit(world.get(id));
    }
}

double kinetic_energy(const RigidBodyRef& body) {
    Vec3d p = to_double(body.momentum()), L = to_double(body.angular_momentum());
    return 0.5 * dot(p, p) * body.inverse_mass() + 0.5 * dot(L, to_double(body.angular_velocity()));
}

}  // namespace

double length(Vec3d v) { return std::sqrt(dot(v, v)); }
double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

Vec3d Frame::local(Position world) const {
    return rotate_inverse(unit_double(rotation), to_double(world) - to_double(origin));
}
Vec3d Frame::local_direction(Vec3 world) const { return rotate_inverse(unit_double(rotation), to_double(world)); }

std::array<Frame, 5> random_frames() {
    std::array<Frame, 5> frames;
    scenes::Random random(2026);
    for (Frame& frame : frames) {
        frame.rotation = random.rotation();
        Vec3 direction = random.direction();
        frame.origin = at(random.range(30.0f, 100.0f) * direction);
    }
    return frames;
}

void Quantity::add(double measured, double exact) {
    double bad = badness(tolerance_, measured, exact);
    if (count_++ > 0 && bad <= badness_) return;
    measured_ = measured;
    exact_ = exact;
    badness_ = bad;
}

void Quantity::merge(const Quantity& other) {
    if (other.count_ > 0 && (count_ == 0 || other.badness_ > badness_)) *this = other;
}

Row Quantity::row(std::string_view case_id, Quality quality) const {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    double error = count_ > 0 ? std::fmax(badness_, 0.0) : nothing;
    return {std::string(case_id),
            quality,
            name_,
            count_ > 0 ? measured_ : nothing,
            exact_,
            error,
            tolerance_.value,
            tolerance_.kind == Tolerance::Kind::relative,
            error <= tolerance_.value};
}

Quantity& Figures::quantity(const std::string& name, Tolerance tolerance) {
    for (Quantity& quantity : quantities)
        if (quantity.name() == name) return quantity;
    return quantities.emplace_back(name, tolerance);
}

Curve& Figures::curve(std::string title, std::string x_label, std::string y_label) {
    return curves.emplace_back(Curve{{}, std::move(title), std::move(x_label), std::move(y_label), {}});
}

WorldBuilder Setting::builder(Vec3 gravity) const {
    WorldBuilder builder;
    builder.gravity(frame.direction(gravity)).sleep(false).solver_steps(solver_steps());
    return builder;
}

BodyId add_body(World& world, const Frame& frame, RigidBodyDef def) {
    def.position = frame.point(from_origin(def.position));
    def.orientation = frame.rotation * def.orientation;
    def.velocity = frame.direction(def.velocity);
    def.angular_velocity = frame.direction(def.angular_velocity);
    return world.add_rigid_body(def).value();
}

BodyId add_fixed(World& world, const Frame& frame, StaticBodyDef def) {
    def.position = frame.point(from_origin(def.position));
    def.orientation = frame.rotation * def.orientation;
    return world.add_static_body(def).value();
}

JointId add_joint(World& world, const Frame& frame, JointType type, BodyId a, BodyId b, Vec3 anchor, Vec3 axis) {
    JointDef def = world.joint_at(type, a, b, frame.point(anchor), frame.direction(axis)).value();
    return world.add_joint(def).value();
}

BodyId add_ground(World& world, const Frame& frame, Ground ground, float friction, float restitution) {
    StaticBodyDef def{.shape = Plane{}, .friction = friction, .restitution = restitution};
    if (ground == Ground::box) {
        def.shape = Box{{60.0f, 1.0f, 60.0f}};
        def.position = {0.0f, -1.0f, 0.0f};
    }
    return add_fixed(world, frame, def);
}

Vec3d place(const World& world, const Frame& frame, BodyId id) { return frame.local(world.get(id).centre_of_mass()); }
Vec3d velocity(const World& world, const Frame& frame, BodyId id) {
    return frame.local_direction(world.get(id).velocity());
}
Vec3d spin(const World& world, const Frame& frame, BodyId id) {
    return frame.local_direction(world.get(id).angular_velocity());
}

Totals totals(const World& world, Position point) {
    Totals sum;
    for_each_dynamic(world, [&](const RigidBodyRef& body) {
        Vec3d p = to_double(body.momentum()), own = to_double(body.angular_momentum());
        Vec3d arm = to_double(body.centre_of_mass()) - to_double(point), whole = cross(arm, p) + own;
        sum.kinetic_energy += kinetic_energy(body);
        sum.momentum += p;
        sum.momentum_magnitudes += length(p);
        sum.angular_momentum += whole;
        sum.angular_magnitudes += length(whole);
        sum.lever_magnitudes += length(arm) * length(p) + length(own);
    });
    return sum;
}

double energy_above_ground(const World& world, const Frame& frame) {
    double sum = 0.0, g = length(to_double(world.config().gravity));
    for_each_dynamic(world, [&](const RigidBodyRef& body) {
        sum += kinetic_energy(body) + g / body.inverse_mass() * frame.local(body.centre_of_mass()).y;
    });
    return sum;
}

void advance(World& world, int steps, float dt) {
    for (int i = 0; i < steps; ++i) world.update(dt).value();
}

}  // namespace lendulet::verify
