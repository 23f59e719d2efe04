// Stage 1: where every collider that may move is, and the box that holds it through the step.
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int colliders_per_task = 256;
// By this share of its margin a box is wider than it need be, so that it can stay as it is while the body trembles or
// creeps: in a pile that lies, hardly any box changes. A wider one would make pairs that never touch, 1 in 30 at twice
// this.
constexpr float box_leeway = 0.25f;

// The margin between two colliders is the sum of half of each one's.
float half_margin(const ColliderInfo& info) { return 0.5f * minimum(contact_margin, 0.25f * info.radius); }

void set_box(BroadBox& box, uint32_t index, Position lower, Position upper) {
    box = {{lower.x, lower.y, lower.z}, index, {upper.x, upper.y, upper.z}, 0u};
}

// Box of a collider now, grown by `grow` and swept along `sweep`.
void bound_collider(WorldData& world, uint32_t slot, Vec3 sweep, float grow, BroadBox& box) {
    const ColliderPlace& place = world.colliders.place[slot];
    ColliderInfo& info = world.colliders.info[slot];
    CentredBox b = bounds(world.colliders.geometry[slot], place.rotation);
    Position centre = world.bodies.pose[info.body].position + (place.arm + b.centre);
    Vec3 half = b.half + Vec3{grow, grow, grow};
    Position lower = centre - half, upper = centre + half;
    lower = lower + minimum(sweep, Vec3{});
    upper = upper + maximum(sweep, Vec3{});
    set_box(box, slot, lower, upper);
    if (!info.boxed) info.boxed = true, info.boxed_at = static_cast<uint32_t>(world.steps);
}

// Whether a side of a box is beyond that of what it holds, by at most `leeway`; infinite sides may be equal.
bool holds(float side, float held, float sign, float leeway) {
    float beyond = sign * (side - held);
    return side == held || (beyond >= 0.0f && beyond <= leeway);
}

// Puts a box around `tight` in the place of `box`, unless that holds it and is not much too wide; false where it stays.
// What moves far in a step would get a new box each time, and gets no leeway.
bool renew(BroadBox& box, BroadBox tight, float leeway, bool fast) {
    bool stays = box.index == tight.index;
    for (int k = 0; k < 3 && stays; ++k)
        stays = holds(box.lower[k], tight.lower[k], -1.0f, 2.0f * leeway) &&
                holds(box.upper[k], tight.upper[k], 1.0f, 2.0f * leeway);
    if (stays) return false;
    for (int k = 0; k < 3 && !fast; ++k) tight.lower[k] -= leeway, tight.upper[k] += leeway;
    box = tight;
    return true;
}

}  // namespace

void set_frame(WorldData& world, uint32_t slot, float turn) {
    const ColliderInfo& info = world.colliders.info[slot];
    const ColliderPlace& place = world.colliders.place[slot];
    const Geometry& geometry = world.colliders.geometry[slot];
    const BodyInfo& body = world.bodies.info[info.body];
    const Position x = world.bodies.pose[info.body].position;
    ShapeFrame& f = world.frames[slot];
    const float rotation[4] = {place.rotation.x, place.rotation.y, place.rotation.z, place.rotation.w};
    for (int k = 0; k < 4; ++k) f.rotation[k] = rotation[k];
    Vec3 v = world.bodies.velocity(info.body);
    f.centre[0] = x.x, f.centre[1] = x.y, f.centre[2] = x.z;
    f.velocity[0] = v.x, f.velocity[1] = v.y, f.velocity[2] = v.z;
    f.arm[0] = place.arm.x, f.arm[1] = place.arm.y, f.arm[2] = place.arm.z;
    f.near = minimum(contact_margin, 0.25f * info.radius);
    // Of what never turns no point moves, however far out.
    f.reach = body.type == BodyType::fixed ? 0.0f : minimum(length(place.arm) + info.radius, 1e30f);
    // Where a body turns that far, points found now say nothing of where it will touch: stop_at_impacts() does.
    bool foreseen = turn <= most_foreseen_turn || !world.config.continuous;
    f.turning = foreseen ? minimum(turn, 2.0f) * f.reach : 0.0f;
    f.half[0] = geometry.size.x, f.half[1] = geometry.size.y, f.half[2] = geometry.size.z;
    f.rounding = geometry.rounding;
    f.radius = info.radius;
    const Vec3 low = world.bodies.momenta[info.body].x_low;
    f.low[0] = low.x, f.low[1] = low.y, f.low[2] = low.z;
}

namespace {

// False where the collider's box stays as it was.
bool bound_mover(WorldData& world, uint32_t slot, float dt) {
    const ColliderInfo& info = world.colliders.info[slot];
    uint32_t body = info.body;
    world.colliders.update_place(slot, world.bodies.pose[body].orientation);
    float turn = dt * length(world.bodies.angular_velocity(body));
    set_frame(world, slot, turn);
    float grow = half_margin(info);
    const float leeway = box_leeway * grow;
    Vec3 sweep = dt * world.bodies.velocity(body);
    float fall =
        0.5f * dt *
        minimum(dt * length(world.config.gravity) * absolute(world.bodies.info[body].gravity_factor), 2.0f * max_speed);
    // A turning shape reaches no farther than its radius about the body's centre, nor than the arc it runs through.
    float reach = length(world.colliders.place[slot].arm) + info.radius;
    grow += fall + (turn > 0.05f ? minimum(turn, 2.0f) * reach : 0.0f);
    BroadBox tight;
    bound_collider(world, slot, sweep, grow, tight);
    bool fast = max_component(absolute(sweep)) > leeway;
    return renew(world.moving_boxes[world.box_place[slot]], tight, leeway, fast);
}

// Colliders that have come or gone; the others have not moved.
void bound_fixed(WorldData& world) {
    ColliderStore& colliders = world.colliders;
    world.fixed_boxes.swap(world.fixed_boxes_before);
    world.fixed_boxes.clear();
    for (uint32_t slot : colliders.slots.order()) {
        uint32_t body = colliders.info[slot].body;
        if (world.bodies.info[body].type != BodyType::fixed) continue;
        const uint32_t before = world.box_place[slot];
        world.box_place[slot] = static_cast<uint32_t>(world.fixed_boxes.size());
        if (before != no_box) {
            world.fixed_boxes.push_back(world.fixed_boxes_before[before]);
            continue;
        }
        world.at_rest[slot] = 1;
        colliders.update_place(slot, world.bodies.pose[body].orientation);
        set_frame(world, slot, 0.0f);
        bound_collider(world, slot, {}, half_margin(colliders.info[slot]), world.fixed_boxes.push_back({}));
    }
}

}  // namespace

void update_bounds(WorldData& world, float dt) {
    if (world.fixed_changed) bound_fixed(world);
    const Array<uint32_t>& movers = world.movers.colliders;
    for (uint32_t slot : movers) {
        if (world.box_place[slot] != no_box) continue;
        world.box_place[slot] = static_cast<uint32_t>(world.moving_boxes.size());
        world.moving_boxes.push_back({{}, no_box, {}, 0u});
    }
    world.renewed.resize_unset(movers.size());
    world.tasks.for_each(movers.count(), colliders_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            size_t k = static_cast<size_t>(i);
            world.renewed[k] = bound_mover(world, movers[k], dt) ? 1 : 0;
        }
    });
    for (size_t i = 0; i < movers.size(); ++i)
        if (world.renewed[i]) world.changed_boxes.push_back(world.box_place[movers[i]]);
}

}  // namespace lendulet
