// Stage 1: where every collider is, and the box that holds it through the step.
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int colliders_per_task = 256;

// The margin between two colliders is the sum of half of each one's.
float half_margin(const ColliderInfo& info) { return 0.5f * minimum(contact_margin, 0.25f * info.radius); }

void set_box(BroadBox& box, uint32_t index, Position lower, Position upper) {
    box = {{lower.x, lower.y, lower.z}, index, {upper.x, upper.y, upper.z}, 0u};
}

// Box of a collider now, grown by `grow` and swept along `sweep`.
void bound_collider(WorldData& world, uint32_t slot, Vec3 sweep, float grow, BroadBox& box) {
    const ColliderPlace& place = world.colliders.place[slot];
    CentredBox b = bounds(world.colliders.geometry[slot], place.rotation);
    Position centre = world.bodies.pose[world.colliders.info[slot].body].position + (place.arm + b.centre);
    Vec3 half = b.half + Vec3{grow, grow, grow};
    Position lower = centre - half, upper = centre + half;
    lower = lower + minimum(sweep, Vec3{});
    upper = upper + maximum(sweep, Vec3{});
    set_box(box, slot, lower, upper);
    world.colliders.info[slot].boxed = true;
}

// What the narrow phase reads; `turn`: by how much the body turns within the step, rad.
void set_frame(WorldData& world, uint32_t slot, float turn) {
    const ColliderInfo& info = world.colliders.info[slot];
    const ColliderPlace& place = world.colliders.place[slot];
    const Geometry& geometry = world.colliders.geometry[slot];
    const BodyInfo& body = world.bodies.info[info.body];
    const Position x = world.bodies.pose[info.body].position;
    ShapeFrame& f = world.frames[slot];
    const float rotation[4] = {place.rotation.x, place.rotation.y, place.rotation.z, place.rotation.w};
    bool moved = f.centre[0] != x.x || f.centre[1] != x.y || f.centre[2] != x.z;
    for (int k = 0; k < 4; ++k) moved |= f.rotation[k] != rotation[k], f.rotation[k] = rotation[k];
    world.still[slot] = body.type == BodyType::fixed || (body.asleep && !moved) ? 1 : 0;
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
    f.radius = info.radius;
}

void bound_moving(WorldData& world, uint32_t slot, float dt, BroadBox& box) {
    const ColliderInfo& info = world.colliders.info[slot];
    uint32_t body = info.body;
    world.colliders.update_place(slot, world.bodies.pose[body].orientation);
    float turn = dt * length(world.bodies.angular_velocity(body));
    set_frame(world, slot, turn);
    float grow = half_margin(info);
    Vec3 sweep;
    if (!world.bodies.info[body].asleep) {
        sweep = dt * world.bodies.velocity(body);
        float fall = 0.5f * dt *
                     minimum(dt * length(world.config.gravity) * absolute(world.bodies.info[body].gravity_factor),
                             2.0f * max_speed);
        // A turning shape reaches no farther than its radius about the body's centre, nor than the arc it runs through.
        float reach = length(world.colliders.place[slot].arm) + info.radius;
        grow += fall + (turn > 0.05f ? minimum(turn, 2.0f) * reach : 0.0f);
    }
    bound_collider(world, slot, sweep, grow, box);
}

}  // namespace

void update_bounds(WorldData& world, float dt) {
    ColliderStore& colliders = world.colliders;
    world.frames.resize(static_cast<size_t>(colliders.slots.capacity()));
    world.still.resize(world.frames.size());
    if (world.fixed_changed) {
        world.fixed_boxes.clear();
        for (uint32_t slot : colliders.slots.order()) {
            uint32_t body = colliders.info[slot].body;
            if (world.bodies.info[body].type != BodyType::fixed) continue;
            colliders.update_place(slot, world.bodies.pose[body].orientation);
            set_frame(world, slot, 0.0f);
            bound_collider(world, slot, {}, half_margin(colliders.info[slot]), world.fixed_boxes.push_back({}));
        }
        world.broad_phase.set_fixed(world.fixed_boxes.data(), world.fixed_boxes.count());
        world.fixed_changed = false;
    }
    world.moving_boxes.clear();
    for (uint32_t slot : colliders.slots.order())
        if (world.bodies.info[colliders.info[slot].body].type != BodyType::fixed)
            world.moving_boxes.push_back({{}, slot, {}, 0u});
    world.tasks.for_each(world.moving_boxes.count(), colliders_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            BroadBox& box = world.moving_boxes[static_cast<size_t>(i)];
            bound_moving(world, box.index, dt, box);
        }
    });
    world.broad_phase.set_moving(world.moving_boxes.data(), world.moving_boxes.count());
}

}  // namespace lendulet
