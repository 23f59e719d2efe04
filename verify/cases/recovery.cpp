// Case A33: bodies that were put into one another come apart within a second, gently.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

constexpr double cap = 3.0;  // m/s, the default separation speed

struct Watch {
    double fastest = 0.0, kinetic = 0.0;
};

// One second; the deepest overlap that is left counts as not separated.
Watch watch(World& world, const Setting& s, const std::vector<BodyId>& bodies, const std::string& name, Figures& out) {
    Watch seen;
    for (int i = 0, steps = s.steps(1.0); i < steps; ++i) {
        advance(world, 1, s.dt());
        for (BodyId id : bodies) seen.fastest = std::fmax(seen.fastest, length(velocity(world, s.frame, id)));
    }
    seen.kinetic = totals(world, s.frame.origin).kinetic_energy;
    out.quantity(name + ": fastest, m/s", at_most()).add(seen.fastest, cap);
    out.quantity(name + ": overlap after 1 s, m", at_most(1e-3)).add(world.statistics().max_penetration);
    return seen;
}

// Two cubes of 1 m and 1 kg, without gravity, overlapping by `depth`. Bound for the energy: m g depth.
void cubes(const Setting& s, Figures& out, double depth) {
    std::string name = "two cubes, " + std::to_string(static_cast<int>(std::lround(100.0 * depth))) + " %";
    World world = s.world({});
    std::vector<BodyId> pair;
    for (float x : {0.0f, static_cast<float>(1.0 - depth)})
        pair.push_back(add_body(world, s.frame, {.shape = Box{}, .position = {x, 0.0f, 0.0f}, .mass = 1.0f}));
    Watch seen = watch(world, s, pair, name, out);
    out.quantity(name + ": kinetic energy after 1 s / m g depth", at_most())
        .add(seen.kinetic / (standard_gravity * depth), 1.0);
}

void cluster(const Setting& s, Figures& out) {
    World world = s.world({});
    std::vector<BodyId> balls;
    for (int i = 0; i < 10; ++i) balls.push_back(add_body(world, s.frame, {.shape = Sphere{0.5f}, .mass = 1.0f}));
    watch(world, s, balls, "ten balls at one point", out);
}

// Half in the floor: it may rise, but not higher than it was sunk.
void in_the_floor(const Setting& s, Figures& out) {
    World world = s.world();
    add_ground(world, s.frame, Ground::box, 0.5f);
    BodyId box = add_body(world, s.frame, {.shape = Box{}, .mass = 1.0f});
    double highest = 0.0;
    for (int i = 0, steps = s.steps(2.0); i < steps; ++i) {
        advance(world, 1, s.dt());
        highest = std::fmax(highest, place(world, s.frame, box).y);
        out.quantity("cube half in the floor: fastest, m/s", at_most()).add(length(velocity(world, s.frame, box)), cap);
    }
    out.quantity("cube half in the floor: highest above rest / depth", at_most()).add((highest - 0.5) / 0.5, 1.0);
    out.quantity("cube half in the floor: height after 2 s, m", within(1e-3)).add(place(world, s.frame, box).y, 0.5);
}

}  // namespace

void penetration_recovery(const Setting& s, Figures& out) {
    for (double depth : {0.1, 0.5, 1.0}) cubes(s, out, depth);
    cluster(s, out);
    in_the_floor(s, out);
}

}  // namespace lendulet::verify
