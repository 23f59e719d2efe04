#include "world/queries/scene.h"

#include "world/world_data.h"

namespace lendulet {
namespace {

// The trees are built anew where one in so many colliders has come, gone or been moved by hand.
constexpr int most_changes = 4;
// All of the moving tree is refitted where one in so many of its colliders has moved.
constexpr int most_moved = 4;

}  // namespace

void QueryScene::all_moved() {
    all_moved_ = true;
    ready_.store(false, std::memory_order_relaxed);
}

void QueryScene::moved(const Array<uint32_t>& colliders) {
    if (colliders.empty()) return;
    ready_.store(false, std::memory_order_relaxed);
    if (!built_ || all_moved_) return;
    for (uint32_t c : colliders) {
        if ((moved_.count() + 1) * most_moved > moving_tree_.count()) {
            all_moved_ = true;
            return;
        }
        // One that has just come is on the other list.
        if (c >= targets_.size() || targets_[c].moved) continue;
        targets_[c].moved = true;
        moved_.push_back(c);
    }
}

void QueryScene::changed(uint32_t collider) {
    ready_.store(false, std::memory_order_relaxed);
    if (!built_) return;
    if (targets_.size() <= collider) targets_.resize(collider + 1u), boxes_.resize(collider + 1u, BroadBox{});
    if (targets_[collider].changed) return;
    targets_[collider].changed = true;
    changed_.push_back(collider);
    built_ = changed_.count() <= 64 || changed_.count() * most_changes < moving_tree_.count() + fixed_tree_.count();
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
    if (built_) {
        change_some(world);
        if (all_moved_) move_all(world);
        else move_some(world);
        if (fixed_tree_.is_worn()) build_tree(world, fixed_tree_, false);
        if (moving_tree_.is_worn()) build_tree(world, moving_tree_, true);
    } else {
        build(world);
    }
    all_moved_ = false;
    moved_.clear();
    changed_.clear();
}

void QueryScene::change_some(const WorldData& world) {
    for (uint32_t c : changed_) {
        targets_[c].changed = false;
        for (QueryTree* tree : {&fixed_tree_, &moving_tree_})
            if (tree->holds(c)) tree->remove(c);
        targets_[c].body = no_slot;
        if (world.colliders.info[c].body == no_slot) continue;
        place(world, c);
        const bool moves = targets_[c].type != static_cast<uint8_t>(BodyType::fixed);
        (moves ? moving_tree_ : fixed_tree_).insert(boxes_[c]);
        if (moves && !targets_[c].moves) moving_.push_back(c);
        targets_[c].moves |= moves;
    }
}

void QueryScene::move_some(const WorldData& world) {
    for (uint32_t c : moved_) {
        targets_[c].moved = false;
        if (!moving_tree_.holds(c)) continue;
        place(world, c);
        moving_tree_.move(boxes_[c]);
    }
}

void QueryScene::move_all(const WorldData& world) {
    for (uint32_t c : moved_) targets_[c].moved = false;
    size_t kept = 0;
    for (uint32_t c : moving_) {
        targets_[c].moves = moving_tree_.holds(c);
        if (!targets_[c].moves) continue;
        place(world, c);
        moving_[kept++] = c;
    }
    moving_.resize_unset(kept);
    if (!moving_tree_.refit(boxes_.data())) build_tree(world, moving_tree_, true);
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
    const Geometry& geometry = world.colliders.geometry[c];
    t.half = geometry.size;
    t.is_box = geometry.kind == GeometryKind::box && !(geometry.rounding > 0.0f);
    boxes_[c] = box_of(world, c);
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
    boxes_.assign(targets_.size(), {});
    for (uint32_t c : world.colliders.slots.order()) place(world, c);
    build_tree(world, fixed_tree_, false);
    build_tree(world, moving_tree_, true);
    built_ = true;
}

// Of the boxes as they are.
void QueryScene::build_tree(const WorldData& world, QueryTree& tree, bool moves) {
    fresh_.clear();
    if (moves) moving_.clear();
    for (uint32_t c : world.colliders.slots.order()) {
        if ((targets_[c].type != static_cast<uint8_t>(BodyType::fixed)) != moves) continue;
        fresh_.push_back(boxes_[c]);
        targets_[c].moves = moves;
        if (moves) moving_.push_back(c);
    }
    tree.build(fresh_.data(), fresh_.count());
}

}  // namespace lendulet
