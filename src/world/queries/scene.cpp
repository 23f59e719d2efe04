#include "world/queries/scene.h"

#include <algorithm>

#include "world/world_data.h"

namespace lendulet {

void QueryScene::all_moved() {
    moved_ = true;
    ready_.store(false, std::memory_order_relaxed);
}

void QueryScene::changed(uint32_t collider) {
    ready_.store(false, std::memory_order_relaxed);
    if (!built_) return;
    if (targets_.size() <= collider) targets_.resize(collider + 1u);
    targets_[collider].loose = true;
    for (uint32_t c : loose_)
        if (c == collider) return;
    loose_.push_back(collider);
    if (loose_.count() > most_loose) built_ = false;
}

void QueryScene::refresh(const WorldData& world) {
    if (ready_.load(std::memory_order_acquire)) return;
    while (busy_.exchange(true, std::memory_order_acquire)) {}
    if (!ready_.load(std::memory_order_relaxed)) {
        update(world);
        ready_.store(true, std::memory_order_release);
    }
    busy_.store(false, std::memory_order_release);
}

void QueryScene::update(const WorldData& world) {
    if (!built_ || (moved_ && !refit(world))) build(world);
    moved_ = false;
    size_t kept = 0;
    for (uint32_t c : loose_) {
        bool alive = world.colliders.info[c].body != no_slot;
        targets_[c].body = no_slot;
        if (!alive) continue;
        place(world, c);
        targets_[c].loose = true;
        loose_[kept++] = c;
    }
    // Those that are gone keep their mark: what the trees still have of them is not to be met.
    loose_.resize_unset(kept);
    std::sort(loose_.begin(), loose_.end());  // order: total
}

void QueryScene::place(const WorldData& world, uint32_t c) {
    const ColliderInfo& info = world.colliders.info[c];
    const Pose& pose = world.bodies.pose[info.body];
    const Transform& local = world.colliders.local[c];
    QueryTarget& t = targets_[c];
    t.position = from_origin(pose * local.translation);
    t.rotation = pose.orientation * local.rotation;
    t.radius = 1.00001f * info.radius;  // not smaller for rounding
    t.body = info.body;
    t.category = info.filter.category, t.mask = info.filter.mask, t.group = info.filter.group;
    t.type = static_cast<uint8_t>(world.bodies.info[info.body].type);
    t.is_trigger = info.is_trigger;
    t.loose = false;
}

BroadBox QueryScene::box_of(const WorldData& world, uint32_t c) const {
    constexpr float rounding = 1e-6f;  // of coordinates and sizes
    CentredBox b = bounds(world.colliders.geometry[c], targets_[c].rotation);
    Vec3 centre = targets_[c].position + b.centre;
    Vec3 half = b.half + rounding * (absolute(centre) + b.half);
    Vec3 lower = centre - half, upper = centre + half;
    return {{lower.x, lower.y, lower.z}, c, {upper.x, upper.y, upper.z}, 0u};
}

void QueryScene::build(const WorldData& world) {
    targets_.assign(world.colliders.slots.capacity(), {});
    loose_.clear();
    fixed_boxes_.clear();
    moving_boxes_.clear();
    for (uint32_t c : world.colliders.slots.order()) {
        place(world, c);
        bool moves = world.bodies.info[targets_[c].body].type != BodyType::fixed;
        (moves ? moving_boxes_ : fixed_boxes_).push_back(box_of(world, c));
    }
    fixed_tree_.build(fixed_boxes_.data(), fixed_boxes_.count());
    moving_tree_.build(moving_boxes_.data(), moving_boxes_.count());
    built_ = true;
}

bool QueryScene::refit(const WorldData& world) {
    for (BroadBox& box : moving_boxes_) {
        if (targets_[box.index].loose) continue;
        place(world, box.index);
        box = box_of(world, box.index);
    }
    return moving_tree_.refit(moving_boxes_.data());
}

}  // namespace lendulet
