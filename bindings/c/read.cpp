// The C interface: what is read of a world. Lists are filled when they are asked for.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

#include "bindings/c/handle.h"
#include "scenes/plain_shape.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

// An upper bound of the speed of a body's material points, from the corner of its box that is farthest out.
float speed_of(const RigidBodyRef& body) {
    Aabb box = body.aabb();
    Position x = body.centre_of_mass();
    Vec3 reach = maximum(absolute(box.upper - x), absolute(box.lower - x));
    return length(body.velocity()) + length(reach) * length(body.angular_velocity());
}

lendulet_pose pose_of(const World& world, BodyId id) {
    StaticBodyRef body = world.get_static(id);
    lendulet_pose pose{};
    put(pose.position, body.position());
    put(pose.orientation, body.orientation());
    if (body.type() == BodyType::fixed) return pose;
    const RigidBodyRef moving = world.get(id);
    pose.speed = moving.asleep() ? -1.0f : speed_of(moving);
    return pose;
}

template <class T, int Number>
constexpr bool is_number = std::is_same_v<std::variant_alternative_t<Number, Shape>, T>;
static_assert(is_number<Sphere, LENDULET_SPHERE> && is_number<Capsule, LENDULET_CAPSULE> &&
              is_number<TaperedCapsule, LENDULET_TAPERED_CAPSULE> && is_number<Box, LENDULET_BOX> &&
              is_number<Cylinder, LENDULET_CYLINDER> && is_number<TaperedCylinder, LENDULET_TAPERED_CYLINDER> &&
              is_number<Cone, LENDULET_CONE> && is_number<ConvexHull, LENDULET_HULL> &&
              is_number<Plane, LENDULET_PLANE> && is_number<TriangleMesh, LENDULET_MESH> &&
              is_number<HeightField, LENDULET_HEIGHT_FIELD>);

int32_t mesh_number(std::vector<Shape>& meshes, const Shape& shape) {
    const void* surface = surface_of(shape);
    if (!surface) return -1;
    // The latest ones first: bodies of one kind are most often made one after another.
    for (size_t i = meshes.size(); i > 0; --i)
        if (surface_of(meshes[i - 1]) == surface) return static_cast<int32_t>(i - 1);
    meshes.push_back(shape);
    return static_cast<int32_t>(meshes.size() - 1);
}

lendulet_collider collider_of(lendulet_world& world, const StaticBodyRef& body, int body_index, int index) {
    lendulet_collider c{};
    const Shape& shape = body.shape(index);
    Transform local = body.collider_pose(index);
    c.body = body_index;
    c.body_type = static_cast<int32_t>(body.type());
    const PlainShape numbers = plain(shape);
    c.type = numbers.type;
    std::copy(std::begin(numbers.size), std::end(numbers.size), c.size);
    c.rounding = numbers.rounding;
    c.mesh = mesh_number(world.meshes, shape);
    c.trigger = body.is_trigger(index);
    put(c.position, local.translation);
    put(c.orientation, local.rotation);
    return c;
}

}  // namespace

extern "C" {

lendulet_result lendulet_read_poses(lendulet_world* world, const lendulet_pose** out) {
    if (!world || !out) return refuse_null("read_poses");
    const World& w = world->scene.world;
    world->poses.resize(static_cast<size_t>(w.body_count()));
    for (int i = 0; i < w.body_count(); ++i) world->poses[static_cast<size_t>(i)] = pose_of(w, w.body(i));
    return give(world->poses, out);
}

lendulet_result lendulet_read_bodies(lendulet_world* world, const lendulet_body** out) {
    if (!world || !out) return refuse_null("read_bodies");
    const World& w = world->scene.world;
    world->bodies.resize(static_cast<size_t>(w.body_count()));
    for (int i = 0; i < w.body_count(); ++i) world->bodies[static_cast<size_t>(i)] = number_of(w.body(i));
    return give(world->bodies, out);
}

lendulet_result lendulet_read_body(const lendulet_world* world, lendulet_body body, lendulet_body_state* out) {
    if (!world || !out) return refuse_null("read_body");
    const World& w = world->scene.world;
    const BodyId id = id_of(body);
    if (!w.alive(id)) return refuse({ErrorCode::stale_id, "read_body: there is no such body in this world"});
    StaticBodyRef fixed = w.get_static(id);
    *out = {};
    put(out->position, fixed.position());
    put(out->centre_of_mass, fixed.position());
    put(out->orientation, fixed.orientation());
    out->type = static_cast<int32_t>(fixed.type());
    out->mass = std::numeric_limits<float>::infinity();
    std::string_view name = fixed.name().substr(0, sizeof out->name - 1);
    std::memcpy(out->name, name.data(), name.size());
    if (fixed.type() == BodyType::fixed) return 0;
    const RigidBodyRef moving = w.get(id);
    put(out->centre_of_mass, moving.centre_of_mass());
    put(out->velocity, moving.velocity());
    put(out->angular_velocity, moving.angular_velocity());
    put(out->momentum, moving.momentum());
    put(out->angular_momentum, moving.angular_momentum());
    out->mass = moving.mass();
    out->asleep = moving.asleep();
    if (fixed.type() == BodyType::kinematic) return 0;
    out->kinetic_energy = moving.kinetic_energy();
    out->potential_energy = moving.potential_energy();
    return 0;
}

lendulet_result lendulet_read_colliders(lendulet_world* world, const lendulet_collider** out) {
    if (!world || !out) return refuse_null("read_colliders");
    const World& w = world->scene.world;
    world->colliders.clear();
    world->meshes.clear();
    for (int i = 0; i < w.body_count(); ++i) {
        StaticBodyRef body = w.get_static(w.body(i));
        for (int k = 0; k < body.collider_count(); ++k) world->colliders.push_back(collider_of(*world, body, i, k));
    }
    return give(world->colliders, out);
}

lendulet_result lendulet_read_mesh(lendulet_world* world, int32_t mesh, lendulet_mesh* out) {
    if (!world || !out) return refuse_null("read_mesh");
    if (mesh < 0 || static_cast<size_t>(mesh) >= world->meshes.size())
        return refuse({ErrorCode::bad_mesh, "read_mesh: there is no mesh of that number; read the colliders first"});
    auto take = [&](const auto& surface) {
        const auto vertices = surface.vertices();
        world->vertices.assign(vertices.begin(), vertices.end());
        world->indices = surface.triangles();
    };
    const Shape& shape = world->meshes[static_cast<size_t>(mesh)];
    if (const auto* hull = std::get_if<ConvexHull>(&shape)) take(*hull);
    else if (const auto* field = std::get_if<HeightField>(&shape)) take(*field);
    else take(std::get<TriangleMesh>(shape));
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    *out = {&world->vertices.data()->x, world->indices.data(), static_cast<int32_t>(world->vertices.size()),
            static_cast<int32_t>(world->indices.size() / 3)};
    return 0;
}

const char* lendulet_stage_name(int32_t stage) {
    // Literals, which end with a zero.
    return stage >= 0 && stage < LENDULET_STAGES ? name_of(static_cast<Stage>(stage)).data() : nullptr;
}

lendulet_result lendulet_read_statistics(const lendulet_world* world, lendulet_statistics* out) {
    if (!world || !out) return refuse_null("read_statistics");
    static_assert(LENDULET_STAGES == static_cast<int>(Stage::count));
    const World& w = world->scene.world;
    const StepStatistics& s = w.statistics();
    *out = {};
    for (int i = 0; i < LENDULET_STAGES; ++i) out->stage_ms[i] = s.stage_ms[i];
    out->total_ms = s.total_ms;
    out->kinetic_energy = w.kinetic_energy();
    out->potential_energy = w.potential_energy();
    Momentum m = w.momentum();
    for (int i = 0; i < 3; ++i) out->momentum[i] = m.linear[i], out->angular_momentum[i] = m.angular[i];
    out->bodies = w.body_count();
    out->awake_bodies = s.awake_bodies;
    out->joints = w.joint_count();
    out->pairs = s.pairs;
    out->manifolds = s.manifolds;
    out->contact_points = s.contact_points;
    out->colours = s.colours;
    out->max_penetration = s.max_penetration;
    return 0;
}

}  // extern "C"
