#include "world/narrow/manifold_records.h"

#include <cstring>

namespace lendulet {
namespace {

// In units of the smaller shape's radius.
constexpr float same_point_distance = 0.05f;

void fill_common(ContactRecord& r, const ContactBase& base, int count) {
    r.static_friction = base.surface.static_friction;
    r.dynamic_friction = base.surface.dynamic_friction;
    r.restitution = base.surface.restitution;
    for (int j = 0; j < 4; ++j) r.normal_impulse[j] = 0.0f;
    for (int k = 0; k < 3; ++k) r.friction_impulse[k] = 0.0f;
    r.twist_impulse = 0.0f;
    r.body_a = r.body_b = 0;
    r.point_count = count;
    r.arm_offset[0] = base.centres.x, r.arm_offset[1] = base.centres.y, r.arm_offset[2] = base.centres.z;
    r.separation_speed = base.separation_speed;
    r.flags = base.flags;
    r.pair = base.pair;
}

}  // namespace

ContactBase contact_base(const WorldData& world, const ColliderPair& p, uint32_t index) {
    const ColliderStore& c = world.colliders;
    uint32_t a = p.flipped ? p.b : p.a, b = p.flipped ? p.a : p.b;
    const ShapeFrame &fa = world.frames[a], &fb = world.frames[b];
    bool fixed_a = world.bodies.info[c.info[a].body].type != BodyType::dynamic;
    return {combine(c.surface[a], c.surface[b]),
            {fa.arm[0], fa.arm[1], fa.arm[2]},
            {fb.centre[0] - fa.centre[0], fb.centre[1] - fa.centre[1], fb.centre[2] - fa.centre[2]},
            fixed_a ? world.config.static_separation_speed : world.config.rigid_separation_speed,
            same_point_distance * minimum(c.info[a].radius, c.info[b].radius),
            p.flipped ? contact_flipped : 0u,
            index};
}

void fill_record(ContactRecord& r, const ContactBase& base, const Manifold& m) {
    fill_common(r, base, m.count);
    r.normal[0] = m.normal.x, r.normal[1] = m.normal.y, r.normal[2] = m.normal.z;
    for (int j = 0; j < 4; ++j) {
        bool there = j < m.count;
        Vec3 x = there ? base.arm_a + m.points[j].position : Vec3{};
        r.points[j] = {{x.x, x.y, x.z}, there ? m.points[j].separation : far_separation};
        r.id[j] = there ? m.points[j].id : 0;
    }
    r.radius_a = m.radius_a, r.radius_b = m.radius_b, r.follow = m.follow;
    r.key = m.key;
    r.triangle = m.triangle;
}

void fill_record(ContactRecord& r, const ContactBase& base, const BoxManifold& m) {
    static_assert(sizeof m.points == sizeof r.points && sizeof m.id == sizeof r.id);
    static_assert(absent_separation == far_separation);
    fill_common(r, base, m.count);
    for (int k = 0; k < 3; ++k) r.normal[k] = m.normal[k];
    std::memcpy(r.points, m.points, sizeof m.points);
    std::memcpy(r.id, m.id, sizeof m.id);
    r.radius_a = r.radius_b = 0.0f;
    r.follow = m.follow;
    r.key = 0;
    r.triangle = -1;
}

void warm_start(ContactRecord& r, const ContactRecord& old, float tolerance, float scale) {
    bool used[4] = {}, found[4] = {};
    auto take = [&](int j, int i) {
        found[j] = used[i] = true;
        r.normal_impulse[j] = scale * old.normal_impulse[i];
    };
    for (int j = 0; j < r.point_count; ++j)
        for (int i = 0; i < old.point_count && !found[j]; ++i)
            if (!used[i] && old.id[i] == r.id[j]) take(j, i);
    for (int j = 0; j < r.point_count; ++j) {
        if (found[j]) continue;
        int best = -1;
        float nearest = tolerance * tolerance;
        for (int i = 0; i < old.point_count; ++i) {
            const float *p = r.points[j].position, *q = old.points[i].position;
            float d = length_squared(Vec3{p[0], p[1], p[2]} - Vec3{q[0], q[1], q[2]});
            if (!used[i] && d < nearest) nearest = d, best = i;
        }
        if (best >= 0) take(j, best);
    }
    for (int k = 0; k < 3; ++k) r.friction_impulse[k] = scale * old.friction_impulse[k];
    r.twist_impulse = scale * old.twist_impulse;
}

void scale_impulses(ContactRecord& r, float scale) {
    for (float& x : r.normal_impulse) x *= scale;
    for (float& x : r.friction_impulse) x *= scale;
    r.twist_impulse *= scale;
}

}  // namespace lendulet
