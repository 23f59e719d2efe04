// Questions to the broad phase: boxes near a box, boxes along a ray, the boxes of the structure itself.
#include <algorithm>

#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

// Where the segment enters the box, in [0, 1]; above 1 where it misses.
float entry(const BroadBox& box, const float origin[3], const float translation[3]) {
    float t0 = 0.0f, t1 = 1.0f;
    for (int k = 0; k < 3; ++k) {
        if (translation[k] == 0.0f) {
            if (origin[k] < box.lower[k] || origin[k] > box.upper[k]) return 2.0f;
            continue;
        }
        float a = (box.lower[k] - origin[k]) / translation[k], b = (box.upper[k] - origin[k]) / translation[k];
        t0 = maximum(t0, minimum(a, b));
        t1 = minimum(t1, maximum(a, b));
    }
    return t0 <= t1 ? t0 : 2.0f;
}

// Tests every box whose collider still exists: for the time between a removal and the next step.
uint32_t nearest_of_all(const WorldData& world, const float origin[3], const float translation[3], float& t) {
    uint32_t best = no_box;
    t = 1.0f;
    for (const Array<BroadBox>* set : {&world.moving_boxes, &world.fixed_boxes})
        for (const BroadBox& box : *set) {
            float e = world.colliders.info[box.index].boxed ? entry(box, origin, translation) : 2.0f;
            if (e < t || (e == t && e <= 1.0f && box.index < best)) t = e, best = box.index;
        }
    return best;
}

}  // namespace

int World::query_boxes(const Aabb& box, ColliderId* out, int capacity) const {
    float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
    Array<uint32_t> hits;
    data().broad_phase.query_box(lower, upper, hits);
    std::sort(hits.begin(), hits.end());  // order: total
    int count = 0;
    for (uint32_t slot : hits) {
        if (!data().colliders.info[slot].boxed) continue;
        if (count < capacity) out[count] = data().colliders.id(slot);
        ++count;
    }
    return count;
}

Result<BoxHit> World::nearest_box(Position origin, Vec3 translation) const {
    if (!is_finite(from_origin(origin)) || !is_finite(translation))
        return Error{ErrorCode::bad_query, "nearest_box: origin and translation must be finite"};
    if (!(length_squared(translation) > 0.0f)) return Error{ErrorCode::bad_query, "nearest_box: the ray has no length"};
    float o[3] = {origin.x, origin.y, origin.z}, d[3] = {translation.x, translation.y, translation.z}, t = 0.0f;
    uint32_t slot = data().broad_phase.ray(o, d, 1.0f, t);
    if (slot != no_box && !data().colliders.info[slot].boxed) slot = nearest_of_all(data(), o, d, t);
    if (slot == no_box) return BoxHit{{}, {}, 1.0f};
    return BoxHit{data().bodies.id(data().colliders.info[slot].body), data().colliders.id(slot), t};
}

void World::visit_aabbs(void (*visit)(void*, const AabbView&), void* context) const {
    Array<BroadPhaseBox> boxes;
    data().broad_phase.boxes(boxes);
    for (const BroadPhaseBox& b : boxes)
        visit(context, {{{b.lower[0], b.lower[1], b.lower[2]}, {b.upper[0], b.upper[1], b.upper[2]}}, b.depth, b.leaf});
}

}  // namespace lendulet
