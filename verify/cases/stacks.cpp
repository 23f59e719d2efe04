// Cases A29 and A32: what stands, stands, and carries its weight.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"

namespace lendulet::verify {
namespace {

struct Pile {
    World world;
    Frame frame;
    float size;
    std::vector<BodyId> boxes;  // from the bottom to the top
    std::vector<Vec3d> start;

    Pile(const Setting& s, float edge, bool sleep = false)
        : world(s.builder().sleep(sleep).build().value()), frame(s.frame), size(edge) {
        add_ground(world, frame, Ground::box, 0.5f);
    }
    void add(float x, int level, float mass) {
        Vec3 where{x * size, (0.5f + static_cast<float>(level)) * size, 0.0f};
        float half = 0.5f * size;
        boxes.push_back(
            add_body(world, frame, {.shape = Box{{half, half, half}}, .position = at(where), .mass = mass}));
        start.push_back(place(world, frame, boxes.back()));
    }
    Vec3d moved(size_t i) const { return place(world, frame, boxes[i]) - start[i]; }
    double sideways(size_t i) const { return std::hypot(moved(i).x, moved(i).z); }
    double largest_sideways() const {
        double most = 0.0;
        for (size_t i = 0; i < boxes.size(); ++i) most = std::fmax(most, sideways(i));
        return most;
    }
    double deepest() const {
        double most = 0.0;
        for (int k = 0; k < world.contact_count(); ++k) {
            Contact contact = world.contact(k);
            for (int j = 0; j < contact.point_count; ++j)
                most = std::fmax(most, -static_cast<double>(contact.points[j].separation));
        }
        return most;
    }
    // Of all contacts with the ground, N. Impulses are those of a substep as it is set.
    double ground_force(const Setting& s) const {
        double sum = 0.0;
        for (int k = 0; k < world.contact_count(); ++k) {
            Contact contact = world.contact(k);
            if (world.get_static(contact.body_a).type() == BodyType::dynamic &&
                world.get_static(contact.body_b).type() == BodyType::dynamic)
                continue;
            for (int j = 0; j < contact.point_count; ++j) sum += contact.points[j].normal_impulse;
        }
        return sum * s.solver_steps() / static_cast<double>(s.dt());
    }
};

// Ten seconds under loads of `masses`, from the bottom to the top.
void unequal(const Setting& s, Figures& out, const std::string& name, const std::vector<float>& masses) {
    Pile pile(s, 1.0f);
    for (size_t i = 0; i < masses.size(); ++i) pile.add(0.0f, static_cast<int>(i), masses[i]);
    Quantity &sink = out.quantity(name + ": sink of the top, m", within(s.pick(0.01, 1e-3))),
             &drift = out.quantity(name + ": sideways, m", within(1e-3));
    for (int i = 0; i < 20; ++i) {
        advance(pile.world, s.steps(0.5), s.dt());
        sink.add(-pile.moved(masses.size() - 1).y);
        drift.add(pile.largest_sideways());
    }
}

// A minute of a pile of equal boxes, which `build` makes.
template <class Build>
void stand(const Setting& s, Figures& out, const std::string& name, float edge, double per_face, int levels,
           Build&& build) {
    Pile pile(s, edge);
    build(pile);
    per_face *= s.pick(1.0, 0.2);
    Quantity &lateral = out.quantity(name + ": sideways, m", within(5e-3)),
             &sink = out.quantity(name + ": sink of the top, m", within(per_face * levels)),
             &depth = out.quantity(name + ": deepest overlap of a face, m", at_most(per_face)),
             &weight = out.quantity(name + ": force on the ground / weight", within(0.01));
    const int seconds = s.scaled(60, 5);
    double force = 0.0;
    for (int i = 0; i < seconds; ++i) {
        const bool last = i == seconds - 1;
        for (int k = 0, steps = s.steps(1.0); k < steps; ++k) {
            advance(pile.world, 1, s.dt());
            if (last) force += pile.ground_force(s) / steps;
        }
        lateral.add(pile.largest_sideways());
    }
    sink.add(-pile.moved(pile.boxes.size() - 1).y);
    depth.add(pile.deepest());
    weight.add(force / (static_cast<double>(pile.boxes.size()) * standard_gravity), 1.0);

    Pile sleepy(s, edge, true);
    build(sleepy);
    advance(sleepy.world, s.steps(5.0), s.dt());
    double awake = 0.0;
    for (BodyId box : sleepy.boxes) awake += sleepy.world.get(box).asleep() ? 0.0 : 1.0;
    out.quantity(name + ": boxes still awake after 5 s", at_most()).add(awake);
}

void build_column(Pile& pile, int height) {
    for (int i = 0; i < height; ++i) pile.add(0.0f, i, 1.0f);
}

void build_pyramid(Pile& pile, int base) {
    for (int level = 0; level < base; ++level)
        for (int i = 0; i < base - level; ++i)
            pile.add(1.05f * (static_cast<float>(i) - 0.5f * static_cast<float>(base - level - 1)), level, 1.0f);
}

}  // namespace

void mass_ratio_stacks(const Setting& s, Figures& out) {
    unequal(s, out, "1000 kg on 1 kg", {1.0f, 1000.0f});
    unequal(s, out, "1 kg on 1000 kg", {1000.0f, 1.0f});
    std::vector<float> alternating;
    for (int i = 0; i < 10; ++i) alternating.push_back(i % 2 ? 1000.0f : 1.0f);
    unequal(s, out, "ten by turns 1 and 1000 kg", alternating);
}

void tall_stacks(const Setting& s, Figures& out) {
    for (float edge : {1.0f, 0.05f}) {
        std::string size = edge == 1.0f ? " of 1 m" : " of 5 cm";
        stand(s, out, "column of 20" + size, edge, 5e-4, 20, [](Pile& pile) { build_column(pile, 20); });
        stand(s, out, "pyramid of base 20" + size, edge, 5e-4, 20, [](Pile& pile) { build_pyramid(pile, 20); });
        stand(s, out, "column of 100" + size, edge, 5e-3, 100, [](Pile& pile) { build_column(pile, 100); });
    }
}

}  // namespace lendulet::verify
