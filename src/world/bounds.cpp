// Stage 1: where every collider that may move is, and the box that holds it through the step.
#include <algorithm>
#include <limits>

#include "world/body_lanes/kernels.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int colliders_per_task = 256;

BoundBatch batch_of(WorldData& world, float dt) {
    BoundBatch batch;
    batch.bodies = columns(world.bodies);
    batch.local = world.colliders.local.data();
    batch.geometry = world.colliders.geometry.data();
    batch.frames = world.frames.data();
    batch.boxes = world.moving_boxes.data();
    batch.dt = dt;
    batch.fall = dt * length(world.config.gravity);
    batch.most_fall = 2.0f * max_speed;
    batch.most_foreseen_turn = world.config.continuous ? most_foreseen_turn : std::numeric_limits<float>::infinity();
    return batch;
}

void set_lane(BoundBatch& batch, int i, WorldData& world, uint32_t slot) {
    const ColliderInfo& info = world.colliders.info[slot];
    const BodyInfo& body = world.bodies.info[info.body];
    const Geometry& geometry = world.colliders.geometry[slot];
    const bool fixed = body.type == BodyType::fixed;
    batch.collider[i] = static_cast<int32_t>(slot);
    batch.body[i] = static_cast<int32_t>(info.body);
    batch.kinematic[i] = body.type == BodyType::kinematic ? 1.0f : 0.0f;
    batch.fixed[i] = fixed ? 1.0f : 0.0f;
    batch.gravity_factor[i] = fixed ? 0.0f : body.gravity_factor;
    batch.radius[i] = info.radius;
    CentredBox box;
    const bool given = geometry.kind > GeometryKind::box;
    if (given) box = bounds(geometry, world.bodies.pose[info.body].orientation * world.colliders.local[slot].rotation);
    batch.given[i] = given ? 1.0f : 0.0f;
    for (int k = 0; k < 3; ++k) {
        batch.given_centre[k][i] = component(box.centre, k);
        batch.given_half[k][i] = component(box.half, k);
    }
}

void set_box(BroadBox& box, uint32_t index, const BoundBatch& batch, int i) {
    box = {{batch.lower[0][i], batch.lower[1][i], batch.lower[2][i]},
           index,
           {batch.upper[0][i], batch.upper[1][i], batch.upper[2][i]},
           0u};
}

void mark_boxed(WorldData& world, uint32_t slot) {
    ColliderInfo& info = world.colliders.info[slot];
    if (!info.boxed) info.boxed = true, info.boxed_at = static_cast<uint32_t>(world.steps);
}

// Of one collider, whose box in the broad phase is none of those that move.
void bound_one(WorldData& world, uint32_t slot, BoundBatch& batch) {
    const BroadBox none{};
    batch.boxes = &none;
    batch.count = 1;
    for (int i = 0; i < filled(1); ++i) {
        set_lane(batch, i, world, slot);
        batch.box[i] = 0;
        batch.unboxed[i] = 1.0f;
    }
    world.body_kernels.bound(batch);
}

// Colliders [begin, end) of the movers.
void bound_movers(WorldData& world, int begin, int end, BoundBatch& batch) {
    const uint32_t* slots = world.movers.colliders.data() + begin;
    batch.count = end - begin;
    for (int i = 0; i < filled(batch.count); ++i) {
        const uint32_t slot = slots[i < batch.count ? i : batch.count - 1];
        set_lane(batch, i, world, slot);
        batch.box[i] = static_cast<int32_t>(world.box_place[slot]);
        batch.unboxed[i] = world.moving_boxes[world.box_place[slot]].index == slot ? 0.0f : 1.0f;
        mark_boxed(world, slot);
    }
    world.body_kernels.bound(batch);
    for (int i = 0; i < batch.count; ++i) {
        const bool renewed = batch.renewed[i] > 0.0f;
        world.renewed[static_cast<size_t>(begin + i)] = renewed;
        if (renewed) set_box(world.moving_boxes[static_cast<size_t>(batch.box[i])], slots[i], batch, i);
    }
}

// Colliders that have come or gone; the others have not moved.
void bound_fixed(WorldData& world) {
    ColliderStore& colliders = world.colliders;
    world.fixed_boxes.swap(world.fixed_boxes_before);
    world.fixed_boxes.clear();
    BoundBatch batch = batch_of(world, 0.0f);
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
        bound_one(world, slot, batch);
        mark_boxed(world, slot);
        set_box(world.fixed_boxes.push_back({}), slot, batch, 0);
    }
}

}  // namespace

void set_frame(WorldData& world, uint32_t slot) {
    BoundBatch batch = batch_of(world, 0.0f);
    bound_one(world, slot, batch);
}

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
        BoundBatch batch = batch_of(world, dt);
        for (int i = begin; i < end; i += body_batch) bound_movers(world, i, std::min(i + body_batch, end), batch);
    });
    for (size_t i = 0; i < movers.size(); ++i)
        if (world.renewed[i]) world.changed_boxes.push_back(world.box_place[movers[i]]);
}

}  // namespace lendulet
