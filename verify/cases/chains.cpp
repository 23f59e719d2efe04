// Cases A27 and A28: twenty rods of half a metre on ball joints.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr int links = 20;
constexpr double link_length = 0.5;
constexpr float half_link = 0.25f;

struct Chain {
    World world;
    Frame frame;
    std::vector<BodyId> rods;
    std::vector<JointId> joints;
    BodyId first_support{};
};

// Rods of 1 kg along `directions` (unit vectors), one after the other from the frame's origin, where the first is
// fixed.
Chain make_chain(const Setting& s, const std::vector<Vec3>& directions, float damping) {
    Chain chain{s.world(), s.frame, {}, {}, {}};
    chain.first_support = add_fixed(chain.world, s.frame, {.shape = Sphere{0.02f}, .filter = {.group = 1}});
    BodyId before = chain.first_support;
    Vec3 end{};
    for (Vec3 direction : directions) {
        BodyId rod = add_body(chain.world, s.frame,
                              {.shape = Box{{half_link, 0.025f, 0.025f}},
                               .position = at(end + half_link * direction),
                               .orientation = rotation_between({1.0f, 0.0f, 0.0f}, direction),
                               .filter = {.group = 1},
                               .mass = 1.0f,
                               .linear_damping = damping,
                               .angular_damping = damping});
        chain.joints.push_back(add_joint(chain.world, s.frame, JointType::ball, before, rod, end));
        chain.rods.push_back(rod);
        end = end + 2.0f * half_link * direction;
        before = rod;
    }
    return chain;
}

// Sum of all gaps over the chain's length.
double stretch(const Chain& chain) {
    double sum = 0.0;
    for (JointId joint : chain.joints) sum += length(to_double(chain.world.joint(joint).linear_error));
    return sum / (links * link_length);
}

void carry(const Setting& s, Figures& out, bool hanging) {
    Vec3 direction = hanging ? Vec3{0.0f, -1.0f, 0.0f} : Vec3{1.0f, 0.0f, 0.0f};
    Chain chain = make_chain(s, std::vector<Vec3>(links, direction), 0.0f);
    constexpr float radius = 0.3f;
    Vec3 end = static_cast<float>(links * link_length) * direction;
    BodyId load = add_body(
        chain.world, s.frame,
        {.shape = Sphere{radius}, .position = at(end + radius * direction), .filter = {.group = 1}, .mass = 100.0f});
    chain.joints.push_back(add_joint(chain.world, s.frame, JointType::ball, chain.rods.back(), load, end));
    Quantity& worst = hanging ? out.quantity("hanging: sum of gaps / length", at_most(s.pick(5e-3, 5e-4)))
                              : out.quantity("swung from level: sum of gaps / length", at_most(s.pick(0.01, 2e-3)));
    for (int i = 0, steps = s.steps(10.0); i < steps; ++i) {
        advance(chain.world, 1, s.dt());
        worst.add(stretch(chain));
    }
}

}  // namespace

// Hung over a span of 7 m the rods' slopes are tan = (k - (N + 1) / 2) w / H, with H / w = 4.619754 so that they span
// it. It starts as a V and is damped to rest.
void hanging_chain(const Setting& s, Figures& out) {
    constexpr double span = 7.0, pull = 4.619754;  // H / w
    std::vector<Vec3> directions;
    const double across = 0.5 * span / (0.5 * links * link_length);
    for (int k = 0; k < links; ++k)
        directions.push_back(
            normalize(Vec3{static_cast<float>(across),
                           static_cast<float>((k < links / 2 ? -1 : 1) * std::sqrt(1.0 - across * across)), 0.0f}));
    Chain chain = make_chain(s, directions, 1.0f);
    Vec3 far{static_cast<float>(span), 0.0f, 0.0f};
    BodyId support =
        add_fixed(chain.world, s.frame, {.shape = Sphere{0.02f}, .position = at(far), .filter = {.group = 1}});
    chain.joints.push_back(add_joint(chain.world, s.frame, JointType::ball, chain.rods.back(), support, far));
    advance(chain.world, s.steps(30.0), s.dt());

    Quantity &node = out.quantity("place of a rod / length, off the exact", within(s.pick(2e-3, 2e-4))),
             &force = out.quantity("horizontal force at the support / weight of a rod", relative(0.01));
    Curve& curve = out.curve("a hanging chain", "across, m", "height, m");
    double x = 0.0, y = 0.0;
    for (int k = 1; k <= links; ++k) {
        double slope = std::atan((k - 0.5 * (links + 1)) / pull);
        double dx = link_length * std::cos(slope), dy = link_length * std::sin(slope);
        Vec3d rod = place(chain.world, s.frame, chain.rods[static_cast<size_t>(k - 1)]);
        node.add(std::hypot(rod.x - (x + 0.5 * dx), rod.y - (y + 0.5 * dy), rod.z) / (links * link_length));
        curve.add(rod.x, rod.y, y + 0.5 * dy);
        x += dx, y += dy;
    }
    force.add(std::fabs(s.frame.local_direction(chain.world.joint(chain.joints[0]).force).x) / standard_gravity, pull);
}

void payload_chain(const Setting& s, Figures& out) {
    carry(s, out, true);
    carry(s, out, false);
}

}  // namespace lendulet::verify
