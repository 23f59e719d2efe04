#include "world/narrow/manifold_records.h"

#include <cstring>

namespace lendulet {
namespace {

// In units of the smaller shape's radius.
constexpr float same_point_distance = 0.05f;

void set_centres(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b) {
    for (int k = 0; k < 3; ++k) r.arm_offset[k] = between_centres(a.centre[k], a.low[k], b.centre[k], b.low[k]);
}

void write_surface(const ContactSurface& surface, ContactRecord& r) {
    r.static_friction = surface.static_friction;
    r.dynamic_friction = surface.dynamic_friction;
    r.restitution = surface.restitution;
}

// Whether all of a surface is flat faces, with edges and corners between them.
bool is_sharp(const Geometry& g) {
    return g.rounding == 0.0f && (g.kind == GeometryKind::box || g.kind == GeometryKind::hull ||
                                  g.kind == GeometryKind::plane || has_triangles(g));
}

// Points that no name tells.
void take_nearest(ContactRecord& r, const OldContact& old, bool* found, bool* used, float tolerance, float scale) {
    for (int j = 0; j < r.point_count; ++j) {
        if (found[j]) continue;
        int best = -1;
        float nearest = tolerance * tolerance;
        for (int i = 0; i < old.point_count; ++i) {
            const float *p = r.points[j].position, *q = old.points[i].position;
            float d = length_squared(Vec3{p[0], p[1], p[2]} - Vec3{q[0], q[1], q[2]});
            if (!used[i] && d < nearest) nearest = d, best = i;
        }
        if (best < 0) continue;
        used[best] = true;
        r.normal_impulse[j] = scale * old.normal_impulse[best];
    }
}

}  // namespace

void prepare_record(const WorldData& world, const ColliderPair& p, ContactRecord& r) {
    write_surface(combine(world.colliders.surface[p.a], world.colliders.surface[p.b]), r);
    r.separation_speed = p.fixed_a ? world.config.static_separation_speed : world.config.rigid_separation_speed;
    const bool sharp = is_sharp(world.colliders.geometry[p.a]) && is_sharp(world.colliders.geometry[p.b]);
    const bool balls = world.colliders.geometry[p.a].kind == GeometryKind::point &&
                       world.colliders.geometry[p.b].kind == GeometryKind::point;
    r.flags = (p.flipped ? contact_flipped : 0u) | (sharp ? contact_sharp : 0u) | (balls ? contact_balls : 0u);
}

void set_surface(const WorldData& world, const ColliderPair& p, ContactRecord& r) {
    const ColliderStore& c = world.colliders;
    if (r.triangle < 0 || (c.materials[p.a].empty() && c.materials[p.b].empty())) return;
    write_surface(combine(c.surface_at(p.a, r.triangle), c.surface_at(p.b, r.triangle)), r);
}

void renew_surface(const WorldData& world, const ColliderPair& p, ContactRecord& r) {
    write_surface(combine(world.colliders.surface[p.a], world.colliders.surface[p.b]), r);
    set_surface(world, p, r);
}

void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const Manifold& m) {
    const Vec3 arm{a.arm[0], a.arm[1], a.arm[2]};
    r.point_count = m.count;
    r.normal[0] = m.normal.x, r.normal[1] = m.normal.y, r.normal[2] = m.normal.z;
    for (int j = 0; j < 4; ++j) {
        bool there = j < m.count;
        Vec3 x = there ? arm + m.points[j].position : Vec3{};
        r.points[j] = {{x.x, x.y, x.z}, there ? m.points[j].separation : far_separation};
        r.id[j] = there ? m.points[j].id : 0;
    }
    r.radius_a = m.radius_a, r.radius_b = m.radius_b, r.follow = m.follow;
    r.key = m.key;
    r.triangle = m.triangle;
    set_centres(r, a, b);
}

void fill_record(ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b, const BatchManifold& m) {
    static_assert(sizeof m.points == sizeof r.points && sizeof m.id == sizeof r.id);
    static_assert(absent_separation == far_separation);
    r.point_count = m.count;
    for (int k = 0; k < 3; ++k) r.normal[k] = m.normal[k];
    std::memcpy(r.points, m.points, sizeof m.points);
    std::memcpy(r.id, m.id, sizeof m.id);
    r.radius_a = m.radius_a, r.radius_b = m.radius_b;
    r.follow = m.follow;
    r.key = 0;
    r.triangle = -1;
    set_centres(r, a, b);
}

OldContact::OldContact(const ContactRecord& r)
    : twist_impulse(r.twist_impulse), key(r.key), point_count(r.point_count) {
    std::memcpy(normal_impulse, r.normal_impulse, sizeof normal_impulse);
    std::memcpy(friction_impulse, r.friction_impulse, sizeof friction_impulse);
    std::memcpy(points, r.points, sizeof points);
    std::memcpy(id, r.id, sizeof id);
}

void warm_start(ContactRecord& r, const OldContact& old, const ShapeFrame& a, const ShapeFrame& b, float scale) {
    bool used[4] = {}, found[4] = {};
    int left = r.point_count;
    for (int j = 0; j < 4; ++j) r.normal_impulse[j] = 0.0f;
    for (int j = 0; j < r.point_count; ++j)
        for (int i = 0; i < old.point_count && !found[j]; ++i) {
            if (used[i] || old.id[i] != r.id[j]) continue;
            found[j] = used[i] = true;
            r.normal_impulse[j] = scale * old.normal_impulse[i];
            --left;
        }
    if (left > 0) take_nearest(r, old, found, used, same_point_distance * minimum(a.radius, b.radius), scale);
    for (int k = 0; k < 3; ++k) r.friction_impulse[k] = scale * old.friction_impulse[k];
    r.twist_impulse = scale * old.twist_impulse;
}

void clear_impulses(ContactRecord& r) {
    for (float& x : r.normal_impulse) x = 0.0f;
    for (float& x : r.friction_impulse) x = 0.0f;
    r.twist_impulse = 0.0f;
}

void scale_impulses(ContactRecord& r, float scale) {
    for (float& x : r.normal_impulse) x *= scale;
    for (float& x : r.friction_impulse) x *= scale;
    r.twist_impulse *= scale;
}

}  // namespace lendulet
