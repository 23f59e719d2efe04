// What new contacts between bodies at rest carry, guessed before the first step: a tall column would otherwise fall
// freely for as many steps as it takes the solver to learn of its weight from the bottom to the top, and spring back.
//
// From the top down, every body hands its weight and what it carries to the contacts beneath it, in equal parts. That
// is exact for columns and walls, and elsewhere a first guess like any other: the solver's rows go on from there.
#include "world/first_loads.h"

#include <algorithm>

#include "solver/solver.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr float upright = 0.9f;    // cosine between gravity and the normal of contacts that carry
constexpr float nearness = 1e-3f;  // of the size of the upper body: points farther apart do not carry yet

float gap_limit(const WorldData& world, uint32_t body) { return nearness * world.bodies.info[body].radius; }

void set_impulse(ContactRecord& r, float impulse, float limit) {
    int near = 0;
    for (int j = 0; j < r.point_count; ++j) near += r.points[j].separation < limit;
    for (int j = 0; j < r.point_count; ++j)
        if (r.points[j].separation < limit) r.normal_impulse[j] = impulse / static_cast<float>(near);
}

}  // namespace

void offer_first_load(WorldData& world, uint32_t record, const TouchingBodies& bodies, bool both) {
    const ContactRecord& r = world.records[record];
    const Vec3 g = world.config.gravity;
    float down = dot(Vec3{r.normal[0], r.normal[1], r.normal[2]}, g);
    if (!(down * down > upright * upright * dot(g, g)) || (!both && down > 0.0f)) return;
    uint32_t upper = down > 0.0f ? bodies.a : bodies.b, lower = down > 0.0f ? bodies.b : bodies.a;
    bool near = false;
    for (int j = 0; j < r.point_count; ++j) near = near || r.points[j].separation < gap_limit(world, upper);
    if (!near) return;
    float height = -dot(from_origin(world.bodies.pose[upper].position), g);
    world.first_loads.push_back({height, upper, both ? lower : no_slot, record, bodies});
}

void guess_first_loads(WorldData& world, float weight) {
    Array<FirstLoad>& list = world.first_loads;
    std::sort(list.begin(), list.end(), [](const FirstLoad& x, const FirstLoad& y) {  // order: total
        if (x.height != y.height) return x.height > y.height;
        return x.upper != y.upper ? x.upper < y.upper : x.record < y.record;
    });
    for (size_t i = 0; i < list.size();) {
        const uint32_t upper = list[i].upper;
        size_t end = i;
        while (end < list.size() && list[end].upper == upper) ++end;
        const IslandLoad& load = world.island_loads[upper];
        if (!load.held) {
            float share = load.carried / static_cast<float>(end - i);
            for (size_t k = i; k < end; ++k) {
                set_impulse(world.records[list[k].record], share * weight, gap_limit(world, upper));
                if (list[k].lower != no_slot) world.island_loads[list[k].lower].carried += share;
            }
        }
        i = end;
    }
}

namespace {

// How far the upper body of the contacts list[first .. end) is put down, by the mean of what each of them asks for.
float settled_by(const WorldData& world, size_t first, size_t end, float sinking) {
    float sum = 0.0f;
    for (size_t k = first; k < end; ++k) {
        const FirstLoad& f = world.first_loads[k];
        const ContactRecord& r = world.records[f.record];
        float impulse = 0.0f, gap = 0.0f, inverse_masses = world.bodies.mass[f.upper].inverse_mass, below = 0.0f;
        for (int j = 0; j < r.point_count; ++j) {
            impulse += r.normal_impulse[j];
            gap = minimum(gap, r.points[j].separation);
        }
        if (f.lower != no_slot) {
            inverse_masses += world.bodies.mass[f.lower].inverse_mass;
            below = world.island_loads[f.lower].settled;
        }
        const float overlap = minimum(sinking * impulse * inverse_masses, gap_limit(world, f.upper));
        sum += below + maximum(overlap + gap, 0.0f);
    }
    return sum / static_cast<float>(end - first);
}

// The contact's bodies have gone down by so much.
void follow_settling(ContactRecord& r, Vec3 down, float upper, float lower) {
    for (int j = 0; j < r.point_count; ++j) r.points[j].separation -= upper - lower;
    const bool a_above = dot(Vec3{r.normal[0], r.normal[1], r.normal[2]}, down) > 0.0f;
    const Vec3 between = (a_above ? lower - upper : upper - lower) * down;
    for (int k = 0; k < 3; ++k) r.arm_offset[k] += component(between, k);
}

}  // namespace

void settle_first_loads(WorldData& world, float dt) {
    const Array<FirstLoad>& list = world.first_loads;
    const float h = dt / static_cast<float>(world.config.solver_steps);
    const Vec3 down = normalize(world.config.gravity);
    for (const FirstLoad& f : list) {
        world.island_loads[f.upper].settled = 0.0f;
        if (f.lower != no_slot) world.island_loads[f.lower].settled = 0.0f;
    }
    for (size_t end = list.size(); end > 0;) {
        const uint32_t upper = list[end - 1].upper;
        size_t first = end;
        while (first > 0 && list[first - 1].upper == upper) --first;
        // Impulses are those of the setting's substep, and gaps go with the square of the island's.
        const auto shorter = substep_multiple(part_for(world, upper, dt));
        const float settled = settled_by(world, first, end, contact_leak / contact_bias * h / (shorter * shorter));
        world.island_loads[upper].settled = settled;
        Position& x = world.bodies.pose[upper].position;
        Vec3& low = world.bodies.momenta[upper].x_low;
        const Vec3 way = settled * down - low;
        const Position there = x + way;
        low = (there - x) - way;
        x = there;
        end = first;
    }
    for (const FirstLoad& f : list)
        follow_settling(world.records[f.record], down, world.island_loads[f.upper].settled,
                        f.lower == no_slot ? 0.0f : world.island_loads[f.lower].settled);
}

}  // namespace lendulet
