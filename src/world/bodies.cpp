// Adding and removing bodies: checks, mass properties, colliders.
#include <string>

#include "geometry/mass.h"
#include "geometry/triangle_surface.h"
#include "math/turned.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr size_t max_name = 255;

// A collider that was checked and is ready to be stored.
struct CheckedCollider {
    Geometry geometry;
    ColliderDef def;
    Surface surface;
    std::vector<Surface> materials;
};

Error refused(ErrorCode code, const char* call, std::string what) {
    return {code, std::string(call) + ": " + std::move(what)};
}

// The table of materials that a collider's triangles choose from.
Result<std::vector<Surface>> make_materials(const WorldConfig& config, const ColliderDef& def, const Geometry& g,
                                            const char* call) {
    std::vector<Surface> table;
    if (def.materials.empty()) return table;
    if (!has_triangles(g))
        return refused(ErrorCode::bad_material, call, "only meshes and height fields have a table of materials");
    const int most = TriangleSurface(g).most_material();
    if (def.materials.size() <= static_cast<size_t>(most))
        return refused(ErrorCode::bad_material, call,
                       "a triangle has material " + std::to_string(most) + ", but the table has only " +
                           std::to_string(def.materials.size()));
    for (const Material& m : def.materials) {
        Result<Surface> surface = make_surface(config, m, call);
        if (!surface) return surface.error();
        table.push_back(surface.value());
    }
    return table;
}

Result<CheckedCollider> check_collider(WorldData& world, const ColliderDef& def, bool moves, const char* call) {
    Result<Geometry> geometry = make_geometry(def.shape);
    if (!geometry) return refused(geometry.error().code, call, geometry.error().message);
    CheckedCollider c{geometry.value(), def, {}, {}};
    if (Status s = valid_offset(def.local.translation, "the collider's local position", call); !s) return s.error();
    if (c.geometry.kind == GeometryKind::plane && absolute(c.geometry.offset) > world_extent)
        return refused(ErrorCode::out_of_world, call,
                       "Plane: offset is " + text(c.geometry.offset) + " m, must be within " + text(world_extent));
    Result<Quat> q = unit_quaternion(def.local.rotation, call);
    if (!q) return q.error();
    c.def.local.rotation = q.value();
    if (!is_finite(def.density) || !(def.density > 0.0f))
        return refused(ErrorCode::bad_mass, call, "density is " + text(def.density) + ", must be positive");
    if (Status s = check_events(def.events, call); !s) return s.error();
    Result<Surface> surface = make_surface(world.config, def.material, call);
    if (!surface) return surface.error();
    c.surface = surface.value();
    Result<std::vector<Surface>> materials = make_materials(world.config, def, c.geometry, call);
    if (!materials) return materials.error();
    c.materials = std::move(materials).value();
    if (moves && c.geometry.kind == GeometryKind::height_field)
        return refused(ErrorCode::shape_not_dynamic, call, "a height field cannot be on a moving body");
    if (moves && c.geometry.kind == GeometryKind::plane)
        return refused(ErrorCode::shape_not_dynamic, call, "a plane cannot be on a moving body");
    if (moves && c.geometry.kind == GeometryKind::mesh) {
        if (!c.geometry.hull)
            return refused(ErrorCode::shape_not_dynamic, call,
                           "a flat mesh has no hull to collide as on a moving body");
        c.geometry.kind = GeometryKind::hull;
        c.geometry.mesh = nullptr;
        c.materials.clear();
    }
    return c;
}

// The colliders of a definition: its list, or its one shape with the material fields beside it.
template <class Def>
std::vector<ColliderDef> colliders_of(const Def& def, float density) {
    if (!def.colliders.empty()) return {def.colliders.begin(), def.colliders.end()};
    ColliderDef one;
    one.shape = def.shape;
    one.material.static_friction = def.friction;
    one.material.dynamic_friction = def.dynamic_friction ? def.dynamic_friction : def.friction;
    one.material.restitution = def.restitution;
    one.material.rolling_friction = def.rolling_friction;
    one.material.spinning_friction = def.spinning_friction;
    one.material.tangential_restitution = def.tangential_restitution;
    one.material.surface_velocity = def.surface_velocity;
    one.filter = def.filter;
    one.events = def.events;
    one.density = density;
    return {one};
}

Result<MassProperties> body_mass(const RigidBodyDef& def, const std::vector<CheckedCollider>& colliders,
                                 const char* call) {
    std::vector<MassProperties> parts;
    for (const CheckedCollider& c : colliders)
        if (!c.def.is_trigger) parts.push_back(placed(mass_properties(c.geometry, c.def.density), c.def.local));
    MassProperties total = combined(parts);
    if (def.mass) {
        if (!is_finite(*def.mass) || !(*def.mass > 0.0f))
            return refused(ErrorCode::bad_mass, call, "mass is " + text(*def.mass) + ", must be positive");
        total = with_mass(total, *def.mass);
    }
    if (def.centre_of_mass) {
        if (Status s = valid_offset(*def.centre_of_mass, "centre of mass", call); !s) return s.error();
        // The same solid on another centre: its inertia about that follows by the parallel axis theorem.
        Vec3 d = *def.centre_of_mass - total.centre;
        SymMat3& i = total.inertia;
        float m = total.mass, d2 = dot(d, d);
        i = {i.xx + m * (d2 - d.x * d.x), i.yy + m * (d2 - d.y * d.y), i.zz + m * (d2 - d.z * d.z),
             i.xy - m * d.x * d.y,        i.xz - m * d.x * d.z,        i.yz - m * d.y * d.z};
        total.centre = *def.centre_of_mass;
    }
    if (def.inertia) total.inertia = *def.inertia;
    if (Status s = check_mass(total.mass, call); !s) return s.error();
    return total;
}

Status set_mass(BodyStore& bodies, uint32_t slot, const MassProperties& m, PrincipalInertia principal) {
    BodyMass& mass = bodies.mass[slot];
    mass.mass = m.mass;
    mass.inverse_mass = 1.0f / m.mass;
    mass.inertia = principal.inertia;
    mass.inverse_inertia = {1.0f / principal.inertia.x, 1.0f / principal.inertia.y, 1.0f / principal.inertia.z};
    float most = max_component(mass.inertia), least = min_component(mass.inertia);
    mass.anisotropy = most - least <= equal_moments * most ? 1.0f : most / least;
    bodies.principal[slot] = {m.centre, principal.rotation};
    return {};
}

// Positive, and each no larger than the other two together (it is a sum of squares of distances).
Status check_inertia(Vec3 i, const char* call) {
    const bool positive = can_be_inverted(i);
    float sum = i.x + i.y + i.z, most = max_component(i);
    if (!positive || 2.0f * most > sum * (1.0f + 1e-5f))
        return refused(ErrorCode::bad_inertia, call,
                       "principal inertia is " + text(i.x) + ", " + text(i.y) + ", " + text(i.z) +
                           ": each must be positive and at most the sum of the others");
    return {};
}

void store_colliders(WorldData& world, uint32_t body, std::vector<CheckedCollider>& list) {
    BodyInfo& info = world.bodies.info[body];
    Transform to_principal = inverse(world.bodies.principal[body]);
    info.radius = 0.0f;
    info.depth = 3e38f;
    uint32_t last = no_slot;
    for (CheckedCollider& c : list) {
        uint32_t slot = world.colliders.add();
        ColliderInfo& ci = world.colliders.info[slot];
        ci.body = body;
        ci.is_trigger = c.def.is_trigger;
        ci.filter = c.def.filter;
        ci.user_data = c.def.user_data;
        ci.radius = bounding_radius(c.geometry);
        ci.depth = inner_core(c.geometry).depth;
        if (!ci.is_trigger) info.depth = minimum(info.depth, ci.depth);
        world.colliders.geometry[slot] = c.geometry;
        world.colliders.surface[slot] = c.surface;
        world.has_extras |= c.surface.has_extra();
        for (const Surface& s : c.materials) world.has_extras |= s.has_extra();
        world.colliders.table[slot].clear();
        if (!c.materials.empty()) world.colliders.table[slot].assign(c.def.materials.begin(), c.def.materials.end());
        world.colliders.materials[slot] = std::move(c.materials);
        world.colliders.given[slot] = c.def.local;
        world.colliders.material[slot] = c.def.material;
        world.colliders.local[slot] = to_principal * c.def.local;
        world.colliders.shape[slot] = std::move(c.def.shape);
        (last == no_slot ? info.first_collider : world.colliders.info[last].next) = slot;
        last = slot;
        ++info.collider_count;
        world.query_scene.changed(slot);
        world.continuous.colliders_changed = true;
        world.frames.resize(world.colliders.slots.capacity());
        world.at_rest.resize(world.frames.size());
        world.box_place.resize(world.frames.size(), no_box);
        world.box_place[slot] = no_box;
        set_asks(world, slot, c.def.events);
        info.radius = maximum(info.radius, length(world.colliders.local[slot].translation) + ci.radius);
    }
}

Result<std::vector<CheckedCollider>> check_colliders(WorldData& world, const std::vector<ColliderDef>& defs, bool moves,
                                                     const char* call) {
    std::vector<CheckedCollider> out;
    for (const ColliderDef& d : defs) {
        Result<CheckedCollider> c = check_collider(world, d, moves, call);
        if (!c) return c.error();
        out.push_back(std::move(c).value());
    }
    return out;
}

Status check_motion(const RigidBodyDef& def, const char* call) {
    if (!is_finite(def.velocity) || !is_finite(def.angular_velocity))
        return refused(ErrorCode::non_finite, call, "velocities must be finite");
    return check_drag(def.linear_damping, def.angular_damping, def.gravity_factor, call);
}

// The last box takes the place of the one that goes.
void remove_box(WorldData& world, uint32_t collider) {
    uint32_t place = world.box_place[collider];
    if (world.bodies.info[world.colliders.info[collider].body].type == BodyType::fixed) {
        world.fixed_changed = true;
    } else if (place != no_box) {
        world.forgotten.push_back(collider);
        world.moving_boxes[place] = world.moving_boxes.back();
        world.box_place[world.moving_boxes[place].index] = place;
        world.moving_boxes.pop_back();
        world.changed_boxes.push_back(place);
    }
    world.box_place[collider] = no_box;
}

}  // namespace

Result<BodyId> World::add_rigid_body(const RigidBodyDef& def) {
    constexpr const char* call = "add_rigid_body";
    WorldData& world = data();
    if (Status s = check_motion(def, call); !s) return s.error();
    if (Status s = valid_position(def.position, call); !s) return s.error();
    Result<Quat> q = unit_quaternion(def.orientation, call);
    if (!q) return q.error();
    std::vector<ColliderDef> defs = colliders_of(def, def.density);
    Result<std::vector<CheckedCollider>> colliders = check_colliders(world, defs, !def.kinematic, call);
    if (!colliders) return colliders.error();
    MassProperties mass{};
    PrincipalInertia principal{};
    if (!def.kinematic) {
        Result<MassProperties> m = body_mass(def, colliders.value(), call);
        if (!m) return m.error();
        mass = m.value();
        principal = principal_axes(mass.inertia);
        if (Status s = check_inertia(principal.inertia, call); !s) return s.error();
        Vec3 spin{length(def.angular_velocity), 0.0f, 0.0f};
        if (!is_finite(mass.mass * def.velocity) || !is_finite(max_component(principal.inertia) * spin))
            return refused(ErrorCode::non_finite, call, "momentum and angular momentum must be finite");
    }
    // Nothing can be refused from here on.
    for (size_t i = 0; i < defs.size(); ++i)
        if (!def.kinematic && std::holds_alternative<TriangleMesh>(defs[i].shape))
            world.warnings.push_back("body '" + std::string(def.name) +
                                     "' moves: its triangle mesh collides as its convex hull");
    uint32_t slot = world.bodies.add();
    BodyInfo& info = world.bodies.info[slot];
    info.type = def.kinematic ? BodyType::kinematic : BodyType::dynamic;
    info.massless = def.kinematic;
    info.allow_sleep = def.allow_sleep;
    info.bullet = def.bullet;
    info.gravity_factor = def.gravity_factor;
    info.linear_damping = def.linear_damping;
    info.angular_damping = def.angular_damping;
    info.user_data = def.user_data;
    world.bodies.name[slot] = std::string(def.name.substr(0, max_name));
    if (def.kinematic) world.bodies.principal[slot] = {def.centre_of_mass.value_or(Vec3{}), {}};
    else set_mass(world.bodies, slot, mass, principal).value();
    world.bodies.set_user_pose(slot, {def.position, q.value()});
    world.bodies.momenta[slot].p = def.kinematic ? def.velocity : mass.mass * def.velocity;
    world.bodies.momenta[slot].L =
        def.kinematic ? def.angular_velocity : world.bodies.inertia_times(slot, def.angular_velocity);
    store_colliders(world, slot, colliders.value());
    info.placed_at = static_cast<uint32_t>(world.steps);
    add_mover(world, slot);
    return world.bodies.id(slot);
}

Result<BodyId> World::add_static_body(const StaticBodyDef& def) {
    constexpr const char* call = "add_static_body";
    WorldData& world = data();
    if (Status s = valid_position(def.position, call); !s) return s.error();
    Result<Quat> q = unit_quaternion(def.orientation, call);
    if (!q) return q.error();
    Result<std::vector<CheckedCollider>> colliders = check_colliders(world, colliders_of(def, 1.0f), false, call);
    if (!colliders) return colliders.error();
    uint32_t slot = world.bodies.add();
    world.bodies.info[slot].user_data = def.user_data;
    world.bodies.name[slot] = std::string(def.name.substr(0, max_name));
    world.bodies.set_user_pose(slot, {def.position, q.value()});
    store_colliders(world, slot, colliders.value());
    world.bodies.info[slot].placed_at = static_cast<uint32_t>(world.steps);
    world.bodies.info[slot].solver_index = static_body;
    world.fixed_changed = true;
    return world.bodies.id(slot);
}

Status World::set_user_data(BodyId id, uint64_t user_data) {
    WorldData& world = data();
    if (!world.bodies.alive(id)) return no_such(world.bodies.slots, id.generation, "set_user_data", "body");
    world.bodies.info[id.index].user_data = user_data;
    return {};
}

Status World::remove_body(BodyId id) {
    WorldData& world = data();
    if (!world.bodies.alive(id)) return no_such(world.bodies.slots, id.generation, "remove_body", "body");
    uint32_t slot = id.index;
    wake_touching(world, slot);  // what rested on it falls
    remove_joints_of(world, slot);
    remove_mover(world, slot);
    keep_removed_body(world, slot);
    for (uint32_t c = world.bodies.info[slot].first_collider; c != no_slot;) {
        uint32_t next = world.colliders.info[c].next;
        world.pairs.for_each_of(c, [&](uint32_t number) { forget_pair(world, number); });
        set_asks(world, c, Events::none);
        remove_box(world, c);
        world.colliders.let_go(c);
        world.colliders.info[c].body = no_slot;
        world.colliders.info[c].boxed = false;
        world.query_scene.changed(c);
        world.continuous.colliders_changed = true;
        world.colliders.slots.remove(c);
        c = next;
    }
    world.bodies.info[slot].first_collider = no_slot;
    if (slot < world.island_loads.size()) world.island_loads[slot] = {};
    world.bodies.slots.remove(slot);
    return {};
}

}  // namespace lendulet
