// Cases A38 and A39: closed loops of joints that a motor drives, and a spring.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr double drive = 10.0;  // rad/s
constexpr Vec3 z_axis{0.0f, 0.0f, 1.0f};

// A rod of 1 kg from a to b, in the plane z = 0, that turns with `spin` about z while a moves with `speed`.
BodyId add_rod(World& world, const Frame& frame, Vec3 a, Vec3 b, Vec3 speed, double spin) {
    Vec3 along = b - a;
    Vec3 turning = static_cast<float>(spin) * z_axis;
    return add_body(world, frame,
                    {.shape = Box{{0.5f * length(along), 0.02f, 0.02f}},
                     .position = at(a + 0.5f * along),
                     .orientation = rotation_about(z_axis, arc_tangent2(along.y, along.x)),
                     .velocity = speed + cross(turning, 0.5f * along),
                     .angular_velocity = turning,
                     .filter = {.group = 1},
                     .mass = 1.0f});
}

double angle_of(const World& world, const Frame& frame, BodyId rod) {
    Vec3d x = frame.local_direction(world.get(rod).rotation_matrix().x);
    return std::atan2(x.y, x.x);
}

// Base and crank at the origin with a motor between them.
struct Linkage {
    World world;
    BodyId base, crank;
    std::vector<JointId> joints;  // the motor's is the first

    Linkage(const Setting& s, float crank_length)
        : world(s.world({})), base(add_fixed(world, s.frame, {.shape = Sphere{0.02f}, .filter = {.group = 1}})) {
        crank = add_rod(world, s.frame, {}, {crank_length, 0.0f, 0.0f}, {}, drive);
        JointDef motor =
            world.joint_at(JointType::hinge, base, crank, s.frame.point({}), s.frame.direction(z_axis)).value();
        motor.motor = {static_cast<float>(drive), 1000.0f};
        joints.push_back(world.add_joint(motor).value());
    }
    double largest_gap() const {
        double most = 0.0;
        for (JointId joint : joints) most = std::fmax(most, length(to_double(world.joint(joint).linear_error)));
        return most;
    }
};

constexpr double r = 0.2, l = 0.5;

double slider_place(double phi) { return r * std::cos(phi) + std::sqrt(l * l - r * r * std::sin(phi) * std::sin(phi)); }

// Kinetic energy of crank, rod and slider (1 kg each, rods' height 0.04 m) at 10 rad/s.
double slider_crank_energy(double phi) {
    const double e = 1e-5;
    double slider = drive * (slider_place(phi + e) - slider_place(phi - e)) / (2.0 * e);
    double psi_rate = drive * r * std::cos(phi) / std::sqrt(l * l - r * r * std::sin(phi) * std::sin(phi));
    double x_rate = 0.5 * (-drive * r * std::sin(phi) + slider), y_rate = 0.5 * drive * r * std::cos(phi);
    double crank_inertia = (r * r + 0.0016) / 12.0 + 0.25 * r * r, rod_inertia = (l * l + 0.0016) / 12.0;
    return 0.5 * (crank_inertia * drive * drive + x_rate * x_rate + y_rate * y_rate +
                  rod_inertia * psi_rate * psi_rate + slider * slider);
}

// By virtual work the motor's torque is dE / d(phi) at constant speed, and its mean over a turn from `from` to `to` the
// quotient of differences.
double slider_crank_torque(double from, double to) {
    return (slider_crank_energy(to) - slider_crank_energy(from)) / (to - from);
}

void slider_crank(const Setting& s, Figures& out) {
    Linkage linkage(s, static_cast<float>(r));
    World& world = linkage.world;
    const Vec3 pin{static_cast<float>(r), 0.0f, 0.0f}, wrist{static_cast<float>(r + l), 0.0f, 0.0f};
    BodyId rod = add_rod(world, s.frame, pin, wrist, {0.0f, static_cast<float>(drive * r), 0.0f}, -drive * r / l);
    BodyId slider =
        add_body(world, s.frame,
                 {.shape = Box{{0.05f, 0.05f, 0.05f}}, .position = at(wrist), .filter = {.group = 1}, .mass = 1.0f});
    linkage.joints.push_back(add_joint(world, s.frame, JointType::hinge, linkage.crank, rod, pin, z_axis));
    linkage.joints.push_back(add_joint(world, s.frame, JointType::hinge, rod, slider, wrist, z_axis));
    linkage.joints.push_back(add_joint(world, s.frame, JointType::slider, linkage.base, slider, wrist));
    Quantity &gap = out.quantity("slider-crank: gap of a joint, m", at_most(s.pick(5e-4, 5e-5))),
             &where = out.quantity("slider-crank: place of the slider, m", within(s.pick(5e-4, 5e-5))),
             &speed = out.quantity("slider-crank: speed of the crank, rad/s", relative(0.01)),
             &torque = out.quantity("slider-crank: torque off virtual work / greatest", within(0.01));
    Curve& curve = out.curve("torque that drives a slider-crank", "crank, turns", "torque, N m");
    double greatest = 0.0;
    for (int i = 0; i < 720; ++i) {
        const double at = i * pi_d / 360.0;
        greatest = std::fmax(greatest, std::fabs(slider_crank_torque(at - 1e-3, at + 1e-3)));
    }
    const double turn = drive * static_cast<double>(s.dt());
    for (int i = 1, steps = s.steps(60.0 / s.scale); i <= steps; ++i) {
        advance(world, 1, s.dt());
        double phi = angle_of(world, s.frame, linkage.crank);
        gap.add(linkage.largest_gap());
        where.add(place(world, s.frame, slider).x, slider_place(phi));
        speed.add(spin(world, s.frame, linkage.crank).z, drive);
        double driven = s.frame.local_direction(world.joint(linkage.joints[0]).torque).z;
        double exact = slider_crank_torque(phi - turn, phi);
        torque.add((driven - exact) / greatest);
        if (i * drive * static_cast<double>(s.dt()) < 2.0 * pi_d)
            curve.add(i * drive * static_cast<double>(s.dt()) / (2.0 * pi_d), driven, exact);
    }
}

// Crank 0.2, coupler 0.5, rocker 0.4 and ground 0.6 m: by Grashof's condition the crank turns round. The rocker's angle
// follows from the triangle of its joints (Freudenstein's equation solved).
void four_bar(const Setting& s, Figures& out) {
    constexpr double coupler = 0.5, rocker = 0.4, ground = 0.6;
    Linkage linkage(s, static_cast<float>(r));
    World& world = linkage.world;
    auto joint_place = [&](double phi) {
        double px = r * std::cos(phi), py = r * std::sin(phi), dx = ground - px, dy = -py, d2 = dx * dx + dy * dy;
        double along = (coupler * coupler - rocker * rocker + d2) / (2.0 * d2);
        double up = std::sqrt(coupler * coupler / d2 - along * along);
        return Vec3d{px + along * dx - up * dy, py + along * dy + up * dx, 0.0};
    };
    auto as_float = [](Vec3d v) { return Vec3{static_cast<float>(v.x), static_cast<float>(v.y), 0.0f}; };
    const double e = 1e-5;
    Vec3d joint = joint_place(0.0), rate = (drive / (2.0 * e)) * (joint_place(e) - joint_place(-e));
    Vec3 pin{static_cast<float>(r), 0.0f, 0.0f}, far{static_cast<float>(ground), 0.0f, 0.0f}, top = as_float(joint);
    // Spins about z from the velocities of the ends: cross(along, difference) / length^2.
    auto spin_of = [](Vec3d along, Vec3d difference) {
        return (along.x * difference.y - along.y * difference.x) / dot(along, along);
    };
    Vec3d pin_rate{0.0, drive * r, 0.0};
    BodyId middle =
        add_rod(world, s.frame, pin, top, as_float(pin_rate), spin_of(joint - to_double(pin), rate - pin_rate));
    BodyId last = add_rod(world, s.frame, far, top, {}, spin_of(joint - to_double(far), rate));
    linkage.joints.push_back(add_joint(world, s.frame, JointType::hinge, linkage.crank, middle, pin, z_axis));
    linkage.joints.push_back(add_joint(world, s.frame, JointType::hinge, middle, last, top, z_axis));
    linkage.joints.push_back(add_joint(world, s.frame, JointType::hinge, linkage.base, last, far, z_axis));
    Quantity &gap = out.quantity("four-bar: gap of a joint, m", at_most(s.pick(5e-4, 5e-5))),
             &where = out.quantity("four-bar: end of the rocker off the exact, m", within(s.pick(5e-4, 5e-5))),
             &speed = out.quantity("four-bar: speed of the crank, rad/s", relative(0.01));
    for (int i = 1, steps = s.steps(60.0 / s.scale); i <= steps; ++i) {
        advance(world, 1, s.dt());
        double phi = angle_of(world, s.frame, linkage.crank), rocked = angle_of(world, s.frame, last);
        gap.add(linkage.largest_gap());
        Vec3d end{ground + rocker * std::cos(rocked), rocker * std::sin(rocked), 0.0};
        where.add(length(end - joint_place(phi)));
        speed.add(spin(world, s.frame, linkage.crank).z, drive);
    }
}

// A mass of 1 kg on a slider with a spring, thrown so that it would reach 0.1 m. v^2 + 2 zeta w x v + w^2 x^2 decays as
// exp(-2 zeta w t), and x crosses zero every pi / w_d.
void oscillate(const Setting& s, Figures& out, double hertz, double zeta, double seconds) {
    const double w = 2.0 * pi_d * hertz, reach = 0.1, damped = std::sqrt(1.0 - zeta * zeta);
    World world = s.world({});
    BodyId base = add_fixed(world, s.frame, {.shape = Sphere{0.02f}, .filter = {.group = 1}});
    BodyId mass = add_body(world, s.frame,
                           {.shape = Box{{0.05f, 0.05f, 0.05f}},
                            .velocity = {static_cast<float>(reach * w), 0.0f, 0.0f},
                            .filter = {.group = 1},
                            .mass = 1.0f});
    JointDef def =
        world.joint_at(JointType::slider, base, mass, s.frame.origin, s.frame.direction({1.0f, 0.0f, 0.0f})).value();
    def.spring = {static_cast<float>(w * w), static_cast<float>(2.0 * zeta * w)};
    world.add_joint(def).value();
    char name[64];
    std::snprintf(name, sizeof name, "%g Hz, damping ratio %g: ", hertz, zeta);
    double before = 0.0, first = 0.0, last = 0.0, farthest = 0.0, energy = 0.0;
    int crossings = 0;
    const int steps = s.steps(seconds);
    for (int i = 1; i <= steps; ++i) {
        advance(world, 1, s.dt());
        double x = place(world, s.frame, mass).x, v = velocity(world, s.frame, mass).x,
               t = i * static_cast<double>(s.dt());
        if (before * x < 0.0) {
            last = t - x / (x - before) * static_cast<double>(s.dt());
            if (crossings++ == 0) first = last;
        }
        before = x;
        farthest = std::fmax(farthest, std::fabs(x));
        energy = v * v + 2.0 * zeta * w * x * v + w * w * x * x;
    }
    out.quantity(name + std::string("farthest / undamped reach"), at_most(1e-3)).add(farthest / reach, 1.0);
    if (hertz > 4.0 || zeta >= 1.0) return;  // stable is all that is asked
    out.quantity(name + std::string("frequency, Hz"), relative(2e-3))
        .add(0.5 * (crossings - 1) / (last - first), hertz * damped);
    double rate = -0.5 * std::log(energy / (reach * w * reach * w)) / (steps * static_cast<double>(s.dt()));
    out.quantity(name + std::string("effective damping ratio"), at_most(2e-3)).add(rate / w, zeta);
}

}  // namespace

void closed_loops(const Setting& s, Figures& out) {
    slider_crank(s, out);
    four_bar(s, out);
}

void spring_mass_damper(const Setting& s, Figures& out) {
    for (double hertz : {1.0, 4.0, 15.0})
        for (double zeta : {0.0, 0.05, 1.0}) oscillate(s, out, hertz, zeta, 10.0 / hertz);
}

}  // namespace lendulet::verify
