// Stage 1: where every collider that may move is, and the box that holds it through the step.
#include <algorithm>
#include <limits>

#include "world/body_lanes/kernels.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int colliders_per_task = 256;
constexpr BroadBox unset_box{{}, no_box, {}, 0u};

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

// Frames of at most body_batch colliders; no boxes.
void frame_batch(WorldData& world, const uint32_t* slots, int count, BoundBatch& batch) {
    const BroadBox none{};
    batch.boxes = &none;
    batch.count = count;
    for (int i = 0; i < filled(count); ++i) {
        set_lane(batch, i, world, slots[std::min(i, count - 1)]);
        batch.box[i] = 0;
        batch.unboxed[i] = 1.0f;
    }
    world.body_kernels.bound(batch);
}

// And their boxes, those that change, among `boxes`; a new one has no index there yet.
void bound_batch(WorldData& world, const uint32_t* slots, int count, Array<BroadBox>& boxes, BoundBatch& batch) {
    batch.boxes = boxes.data();
    batch.count = count;
    for (int i = 0; i < filled(count); ++i) {
        const uint32_t slot = slots[std::min(i, count - 1)], place = world.box_place[slot];
        set_lane(batch, i, world, slot);
        batch.box[i] = static_cast<int32_t>(place);
        batch.unboxed[i] = boxes[place].index == slot ? 0.0f : 1.0f;
        mark_boxed(world, slot);
    }
    world.body_kernels.bound(batch);
    for (int i = 0; i < count; ++i)
        if (batch.renewed[i] > 0.0f) set_box(boxes[world.box_place[slots[i]]], slots[i], batch, i);
}

// Colliders that have come or gone; the others have not moved.
void bound_fixed(WorldData& world) {
    const ColliderStore& colliders = world.colliders;
    world.fixed_boxes.swap(world.fixed_boxes_before);
    world.fixed_boxes.clear();
    BoundBatch batch = batch_of(world, 0.0f);
    uint32_t fresh[body_batch];
    int count = 0;
    auto bound_fresh = [&] {
        if (count > 0) bound_batch(world, fresh, count, world.fixed_boxes, batch);
        count = 0;
    };
    for (uint32_t slot : colliders.slots.order()) {
        uint32_t body = colliders.info[slot].body;
        if (world.bodies.info[body].type != BodyType::fixed) continue;
        const uint32_t before = world.box_place[slot];
        world.box_place[slot] = static_cast<uint32_t>(world.fixed_boxes.size());
        world.fixed_boxes.push_back(before == no_box ? unset_box : world.fixed_boxes_before[before]);
        if (before != no_box) continue;
        world.at_rest[slot] = 1;
        fresh[count++] = slot;
        if (count == body_batch) bound_fresh();
    }
    bound_fresh();
}

}  // namespace

void set_frames(WorldData& world, const Array<uint32_t>& colliders) {
    BoundBatch batch = batch_of(world, 0.0f);
    for_each_batch(0, colliders.count(),
                   [&](int first, int count) { frame_batch(world, colliders.data() + first, count, batch); });
}

void update_bounds(WorldData& world, float dt) {
    if (world.fixed_changed) bound_fixed(world);
    const Array<uint32_t>& movers = world.movers.colliders;
    for (uint32_t slot : movers) {
        if (world.box_place[slot] != no_box) continue;
        world.box_place[slot] = static_cast<uint32_t>(world.moving_boxes.size());
        world.moving_boxes.push_back(unset_box);
    }
    world.renewed.resize_unset(movers.size());
    world.tasks.for_each(movers.count(), colliders_per_task, [&](int begin, int end, int) {
        BoundBatch batch = batch_of(world, dt);
        for_each_batch(begin, end, [&](int first, int count) {
            bound_batch(world, movers.data() + first, count, world.moving_boxes, batch);
            for (int i = 0; i < count; ++i)
                world.renewed[static_cast<size_t>(first + i)] = batch.renewed[i] > 0.0f ? 1 : 0;
        });
    });
    for (size_t i = 0; i < movers.size(); ++i)
        if (world.renewed[i]) world.changed_boxes.push_back(world.box_place[movers[i]]);
}

}  // namespace lendulet
