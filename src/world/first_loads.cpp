// What new contacts between bodies at rest carry, guessed before the first step: a tall column would otherwise fall
// freely for as many steps as it takes the solver to learn of its weight from the bottom to the top, and spring back.
//
// From the top down, every body hands its weight and what it carries to the contacts beneath it, in equal parts. That
// is exact for columns and walls, and elsewhere a first guess like any other: the solver's rows go on from there.
#include <algorithm>

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

}  // namespace lendulet
