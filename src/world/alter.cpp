// Changes of colliders and bodies while they live, and what follows from them for pairs and sleepers.
#include "world/narrow/manifold_records.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

// Calls visit(number) for all pairs of a collider and wakes the bodies of each before.
template <class Visit>
void wake_pairs_of(WorldData& world, uint32_t collider, Visit&& visit) {
    wake_body(world, world.colliders.info[collider].body);
    world.pairs.for_each_of(collider, [&](uint32_t number) {
        const ColliderPair& p = world.pairs.pairs[number];
        wake_body(world, p.body_a), wake_body(world, p.body_b);
        visit(number);
    });
}

// Wakes what a collider lies in and may meet now.
void wake_newly_met(WorldData& world, uint32_t collider) {
    const Pose& pose = world.bodies.pose[world.colliders.info[collider].body];
    const Transform& local = world.colliders.local[collider];
    const CentredBox box = bounds(world.colliders.geometry[collider], pose.orientation * local.rotation);
    const Vec3 centre = from_origin(pose * local.translation) + box.centre, low = centre - box.half,
               high = centre + box.half;
    const float lower[3] = {low.x, low.y, low.z}, upper[3] = {high.x, high.y, high.z};
    world.query_scene.refresh(world);
    world.query_scene.overlapping(lower, upper, [&](uint32_t other) {
        const BoxPair p{collider < other ? collider : other, collider < other ? other : collider};
        if (other == collider || !wanted(world, p) || world.pairs.find(p.a, p.b) != no_pair) return;
        wake_body(world, world.colliders.info[other].body);
    });
}

// Surfaces of a pair's contacts after a material has changed.
void renew_surfaces(WorldData& world, ColliderPair& p) {
    if (p.kind == PairKind::trigger) return;
    const ColliderStore& c = world.colliders;
    p.bounces = p.kind == PairKind::boxes && combine(c.surface[p.a], c.surface[p.b]).restitution > 0.0f;
    for (uint32_t i = p.first_record; i < p.first_record + p.prepared; ++i) renew_surface(world, p, world.records[i]);
}

// A body of another type: pairs are made anew, with what events know of them.
void renew_pairs_of(WorldData& world, uint32_t collider) {
    Array<BoxPair> colliders(&world.memory);
    world.pairs.for_each_of(collider, [&](uint32_t number) {
        const ColliderPair& p = world.pairs.pairs[number];
        if (p.kind != PairKind::trigger) colliders.push_back({p.a, p.b});
    });
    for (const BoxPair& c : colliders) {
        const uint32_t number = world.pairs.find(c.a, c.b);
        ColliderPair& p = world.pairs.pairs[number];
        const bool touches = p.touches, want = wanted(world, c);
        if (want) p.touches = false;  // nothing ends
        forget_pair(world, number);
        if (want) world.pairs.pairs[begin_pair(world, c)].touches = touches;
    }
    wake_newly_met(world, collider);
    world.refiltered.push_back(collider);
}

}  // namespace

void set_body_type(WorldData& world, uint32_t slot, BodyType type) {
    world.bodies.set_type(slot, type);
    if (slot < world.island_loads.size()) world.island_loads[slot] = {};
    for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot; c = world.colliders.info[c].next)
        world.query_scene.changed(c);
    world.continuous.colliders_changed = true;
    world.movers.joints_changed = world.joints_changed = world.joint_groups_changed = true;
}

Status RigidBodyRef::set_type(BodyType type) {
    constexpr const char* call = "set_type";
    const uint32_t body = slot();
    const BodyInfo& info = world_->bodies.info[body];
    if (type != BodyType::dynamic && type != BodyType::kinematic)
        return Error{ErrorCode::bad_collider, std::string(call) + ": a body that moves cannot become static"};
    if (type == info.type) return {};
    if (info.massless)
        return Error{ErrorCode::bad_mass, std::string(call) + ": it was added as kinematic, without mass"};
    const BodyMass& mass = world_->bodies.mass_as_dynamic(body);
    if (!is_finite(mass.mass * velocity()) || !is_finite(max_component(mass.inertia) * angular_velocity()))
        return Error{ErrorCode::non_finite, std::string(call) + ": momentum and angular momentum must be finite"};
    wake();
    wake_touching(*world_, body);
    world_->joints.for_each_of(body, [&](uint32_t joint) {
        wake_body(*world_, world_->joints.info[joint].body_a);
        wake_body(*world_, world_->joints.info[joint].body_b);
    });
    set_body_type(*world_, body, type);
    for (uint32_t c = info.first_collider; c != no_slot; c = world_->colliders.info[c].next) renew_pairs_of(*world_, c);
    return {};
}

Status RigidBodyRef::set_mass(float mass) {
    constexpr const char* call = "set_mass";
    const uint32_t body = slot();
    BodyStore& bodies = world_->bodies;
    if (!is_finite(mass)) return Error{ErrorCode::non_finite, std::string(call) + ": mass must be finite"};
    if (Status s = check_mass(mass, call); !s) return s;
    if (bodies.info[body].massless)
        return Error{ErrorCode::bad_mass, std::string(call) + ": it was added as kinematic, without mass"};
    // In proportion to the body as it was added, so that the same mass gives the same body.
    const BodyMass& first = bodies.mass_as_added(body);
    const float times = mass == first.mass ? 1.0f : mass / first.mass;
    BodyMass now = first;
    now.mass = mass;
    now.inverse_mass = 1.0f / mass;
    now.inertia = times * first.inertia;
    now.inverse_inertia = {1.0f / now.inertia.x, 1.0f / now.inertia.y, 1.0f / now.inertia.z};
    if (!can_be_inverted(now.inertia) || !is_finite(now.inverse_inertia))
        return Error{ErrorCode::bad_inertia,
                     std::string(call) + ": with " + text(mass) + " kg its moments of inertia would have no inverse"};
    if (!is_finite(mass * velocity()) || !is_finite(max_component(now.inertia) * angular_velocity()))
        return Error{ErrorCode::non_finite, std::string(call) + ": momentum and angular momentum must be finite"};
    wake();
    wake_touching(*world_, body);
    bodies.alter_mass(body, now);
    if (body < world_->island_loads.size()) world_->island_loads[body] = {};
    world_->joints_changed = world_->joint_groups_changed = true;
    return {};
}

namespace {

// A static body elsewhere: as one that goes and one that comes.
void move_static(WorldData& world, uint32_t body, const Pose& pose) {
    wake_touching(world, body);  // what it leaves behind
    world.joints.for_each_of(body, [&](uint32_t joint) {
        wake_body(world, world.joints.info[joint].body_a);
        wake_body(world, world.joints.info[joint].body_b);
    });
    world.bodies.alter_pose(body, pose);
    world.bodies.info[body].placed_at = static_cast<uint32_t>(world.steps);
    for (uint32_t c = world.bodies.info[body].first_collider; c != no_slot; c = world.colliders.info[c].next) {
        world.pairs.for_each_of(c, [&](uint32_t number) { forget_pair(world, number); });
        world.box_place[c] = no_box;
        world.colliders.info[c].boxed = false;
        world.query_scene.changed(c);
        wake_newly_met(world, c);
    }
    world.fixed_changed = world.joints_changed = world.continuous.colliders_changed = true;
}

}  // namespace

Status World::set_pose(BodyId id, Position position, Quat orientation) {
    constexpr const char* call = "set_pose";
    WorldData& world = data();
    if (!world.bodies.alive(id)) return no_such(world.bodies.slots, id.generation, call, "body");
    if (world.bodies.info[id.index].type != BodyType::fixed) return get(id).set_pose(position, orientation);
    Result<Quat> q = unit_quaternion(orientation, call);
    if (!q) return q.error();
    if (Status s = valid_position(position, call); !s) return s;
    move_static(world, id.index, {position, q.value()});
    return {};
}

void set_collider_filter(WorldData& world, uint32_t collider, const CollisionFilter& filter) {
    world.colliders.info[collider].filter = filter;
    world.query_scene.changed(collider);
    wake_pairs_of(world, collider, [&](uint32_t number) {
        const ColliderPair& p = world.pairs.pairs[number];
        if (!wanted(world, {p.a, p.b})) forget_pair(world, number);
    });
    wake_newly_met(world, collider);
    world.refiltered.push_back(collider);
}

void set_collider_material(WorldData& world, uint32_t collider, const Material& material) {
    ColliderStore& c = world.colliders;
    c.material[collider] = material;
    c.surface[collider] = with_defaults(material, world.config.friction, world.config.restitution);
    world.has_extras |= c.surface[collider].has_extra();
}

Status World::set_filter(ColliderId id, const CollisionFilter& filter) {
    WorldData& world = data();
    if (!world.colliders.alive(id)) return no_such(world.colliders.slots, id.generation, "set_filter", "collider");
    set_collider_filter(world, id.index, filter);
    return {};
}

Status World::set_material(ColliderId id, const Material& material) {
    constexpr const char* call = "set_material";
    WorldData& world = data();
    if (!world.colliders.alive(id)) return no_such(world.colliders.slots, id.generation, call, "collider");
    if (!world.colliders.materials[id.index].empty())
        return Error{ErrorCode::bad_collider, std::string(call) + ": its triangles have materials of their own"};
    Result<Surface> surface = make_surface(world.config, material, call);
    if (!surface) return surface.error();
    set_collider_material(world, id.index, material);
    wake_pairs_of(world, id.index, [&](uint32_t number) { renew_surfaces(world, world.pairs.pairs[number]); });
    return {};
}

Status World::set_events(ColliderId id, Events events) {
    WorldData& world = data();
    if (!world.colliders.alive(id)) return no_such(world.colliders.slots, id.generation, "set_events", "collider");
    if (Status s = check_events(events, "set_events"); !s) return s;
    set_asks(world, id.index, events);
    wake_pairs_of(world, id.index, [&](uint32_t number) {
        ColliderPair& p = world.pairs.pairs[number];
        p.touches = p.touches && (world.events.asks[p.a] | world.events.asks[p.b]) != 0;
    });
    return {};
}

Status RigidBodyRef::set_damping(float linear, float angular) {
    BodyInfo& info = world_->bodies.info[slot()];
    if (Status s = check_drag(linear, angular, info.gravity_factor, "set_damping"); !s) return s;
    info.linear_damping = linear, info.angular_damping = angular;
    wake();
    return {};
}
Status RigidBodyRef::set_gravity_factor(float factor) {
    BodyInfo& info = world_->bodies.info[slot()];
    if (Status s = check_drag(info.linear_damping, info.angular_damping, factor, "set_gravity_factor"); !s) return s;
    info.gravity_factor = factor;
    wake();
    return {};
}
void RigidBodyRef::set_bullet(bool bullet) { world_->bodies.info[slot()].bullet = bullet; }
void RigidBodyRef::set_allow_sleep(bool allow) {
    world_->bodies.info[slot()].allow_sleep = allow;
    if (!allow) wake();
}
float RigidBodyRef::linear_damping() const { return world_->bodies.info[slot()].linear_damping; }
float RigidBodyRef::angular_damping() const { return world_->bodies.info[slot()].angular_damping; }
float RigidBodyRef::gravity_factor() const { return world_->bodies.info[slot()].gravity_factor; }
bool RigidBodyRef::bullet() const { return world_->bodies.info[slot()].bullet; }
bool RigidBodyRef::allow_sleep() const { return world_->bodies.info[slot()].allow_sleep; }

}  // namespace lendulet
