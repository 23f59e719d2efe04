// The C interface: bodies of any shapes, and joints.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

Transform frame(const float* at, const float* q) { return {vector(at), rotation(q)}; }

lendulet_result keep(lendulet_world& world, Shape shape) {
    world.given.push_back(std::move(shape));
    return static_cast<lendulet_result>(world.given.size() - 1);
}

Status read_part(const lendulet_world& world, const lendulet_part& p, ColliderDef& def) {
    if (Status s = set_shape(world, p, "add_body", def.shape); !s) return s;
    def.local = frame(p.position, p.orientation);
    def.density = p.density;
    def.is_trigger = p.trigger != 0;
    def.filter.group = p.group;
    if (!(p.friction < 0.0f)) def.material.static_friction = p.friction;
    if (!(p.restitution < 0.0f)) def.material.restitution = p.restitution;
    return {};
}

std::string_view text_of(const char (&name)[64]) {
    size_t size = 0;
    while (size < sizeof name && name[size]) ++size;
    return {name, size};
}

Result<BodyId> add(World& world, const lendulet_body_definition& d, std::span<const ColliderDef> colliders) {
    if (d.type == LENDULET_FIXED)
        return world.add_static_body({.position = position(d.position),
                                      .orientation = rotation(d.orientation),
                                      .colliders = colliders,
                                      .name = text_of(d.name)});
    RigidBodyDef def{.position = position(d.position),
                     .orientation = rotation(d.orientation),
                     .velocity = vector(d.velocity),
                     .angular_velocity = vector(d.angular_velocity),
                     .colliders = colliders,
                     .linear_damping = d.linear_damping,
                     .angular_damping = d.angular_damping,
                     .gravity_factor = d.gravity_factor,
                     .kinematic = d.type == LENDULET_KINEMATIC,
                     .name = text_of(d.name)};
    if (d.mass != 0.0f) def.mass = d.mass;
    return world.add_rigid_body(def);
}

}  // namespace

extern "C" {

void lendulet_default_part(lendulet_part* out) {
    if (!out) return;
    *out = {};
    out->type = LENDULET_SPHERE;
    out->mesh = -1;
    out->size[0] = 0.5f;
    out->orientation[3] = 1.0f;
    out->density = 1000.0f;
    out->friction = out->restitution = -1.0f;
}

void lendulet_default_body(lendulet_body_definition* out) {
    if (!out) return;
    *out = {};
    out->orientation[3] = 1.0f;
    out->gravity_factor = 1.0f;
    out->type = LENDULET_DYNAMIC;
}

void lendulet_default_joint(lendulet_joint_definition* out) {
    const JointDef usual;
    if (!out) return;
    *out = {};
    out->type = LENDULET_BALL;
    out->orientation_a[3] = out->orientation_b[3] = 1.0f;
    out->limit[0] = usual.limit.lower, out->limit[1] = usual.limit.upper;
    out->twist[0] = usual.twist_limit.lower, out->twist[1] = usual.twist_limit.upper;
    out->swing = usual.swing_limit;
}

lendulet_result lendulet_add_hull(lendulet_world* world, const float* points, int32_t count, float rounding) {
    if (!world || !points || count < 0) return refuse_null("add_hull");
    std::vector<Vec3> list;
    for (int32_t i = 0; i < count; ++i) list.push_back(vector(points + 3 * static_cast<size_t>(i)));
    Result<ConvexHull> hull = ConvexHull::from_points(list, rounding);
    return hull ? keep(*world, hull.value()) : refuse(hull.error());
}

lendulet_result lendulet_add_mesh(lendulet_world* world, const float* vertices, int32_t vertex_count,
                                  const uint32_t* indices, int32_t triangle_count) {
    if (!world || !vertices || !indices || vertex_count < 0 || triangle_count < 0) return refuse_null("add_mesh");
    std::vector<Vec3> list;
    for (int32_t i = 0; i < vertex_count; ++i) list.push_back(vector(vertices + 3 * static_cast<size_t>(i)));
    Result<TriangleMesh> mesh = TriangleMesh::from_triangles(list, {indices, 3 * static_cast<size_t>(triangle_count)});
    return mesh ? keep(*world, mesh.value()) : refuse(mesh.error());
}

lendulet_result lendulet_add_body(lendulet_world* world, const lendulet_body_definition* definition,
                                  const lendulet_part* parts, int32_t part_count, lendulet_body* out) {
    if (!world || !definition || !parts) return refuse_null("add_body");
    if (part_count < 1 || definition->type < LENDULET_FIXED || definition->type > LENDULET_DYNAMIC)
        return refuse({ErrorCode::bad_collider, "add_body: a body needs a type and at least one part"});
    std::vector<ColliderDef> colliders(static_cast<size_t>(part_count));
    for (int32_t i = 0; i < part_count; ++i)
        if (Status read = read_part(*world, parts[i], colliders[static_cast<size_t>(i)]); !read)
            return refuse(read.error());
    Result<BodyId> id = add(world->scene.world, *definition, colliders);
    if (!id) return refuse(id.error());
    if (out) *out = number_of(id.value());
    return 0;
}

lendulet_result lendulet_add_joint(lendulet_world* world, const lendulet_joint_definition* d) {
    if (!world || !d) return refuse_null("add_joint");
    if (d->type < LENDULET_RIGID || d->type > LENDULET_SLIDER)
        return refuse({ErrorCode::bad_joint, "add_joint: there is no joint of that type"});
    JointDef def;
    def.type = static_cast<JointType>(d->type);
    def.body_a = id_of(d->body_a);
    def.body_b = id_of(d->body_b);
    def.frame_a = frame(d->position_a, d->orientation_a);
    def.frame_b = frame(d->position_b, d->orientation_b);
    def.limit = {d->limit[0], d->limit[1]};
    def.swing_limit = d->swing;
    def.twist_limit = {d->twist[0], d->twist[1]};
    def.motor = {d->motor_velocity, d->motor_force};
    def.spring.stiffness = d->spring[0];
    def.spring.damping = d->spring[1];
    def.spring.target = d->target;
    def.collide_connected = d->collide != 0;
    if (d->break_force != 0.0f) def.break_force = d->break_force;
    if (d->break_torque != 0.0f) def.break_torque = d->break_torque;
    Result<JointId> id = world->scene.world.add_joint(def);
    return id ? 0 : refuse(id.error());
}

}  // extern "C"
