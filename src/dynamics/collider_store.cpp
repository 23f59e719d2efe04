#include "dynamics/collider_store.h"

#include "geometry/triangle_surface.h"

namespace lendulet {
namespace {

float combine(CombineRule rule, float a, float b) {
    switch (rule) {
        case CombineRule::average:
            return 0.5f * (a + b);
        case CombineRule::minimum:
            return minimum(a, b);
        case CombineRule::maximum:
            return maximum(a, b);
        case CombineRule::multiply:
            return a * b;
    }
    return 0.0f;
}

CombineRule stronger(CombineRule a, CombineRule b) { return a < b ? a : b; }

}  // namespace

ContactSurface combine(const Surface& a, const Surface& b) {
    CombineRule friction = stronger(a.friction_combine, b.friction_combine);
    CombineRule restitution = stronger(a.restitution_combine, b.restitution_combine);
    ContactSurface s;
    s.static_friction = combine(friction, a.static_friction, b.static_friction);
    s.dynamic_friction = combine(friction, a.dynamic_friction, b.dynamic_friction);
    s.restitution = combine(restitution, a.restitution, b.restitution);
    // A surface that slides harder than it sticks would gain energy from the difference.
    s.static_friction = maximum(s.static_friction, s.dynamic_friction);
    return s;
}

ExtraSurface combine_extra(const Surface& a, const Surface& b) {
    CombineRule friction = stronger(a.friction_combine, b.friction_combine);
    CombineRule restitution = stronger(a.restitution_combine, b.restitution_combine);
    return {combine(friction, a.rolling_friction, b.rolling_friction),
            combine(friction, a.spinning_friction, b.spinning_friction),
            combine(restitution, a.tangential_restitution, b.tangential_restitution)};
}

const Surface& ColliderStore::surface_at(uint32_t slot, int32_t triangle) const {
    if (triangle < 0 || materials[slot].empty()) return surface[slot];
    return materials[slot][TriangleSurface(geometry[slot]).material(static_cast<uint32_t>(triangle))];
}

Surface with_defaults(const Material& given, float friction, float restitution) {
    float fixed = given.static_friction.value_or(friction);
    return {fixed,
            given.dynamic_friction.value_or(fixed),
            given.restitution.value_or(restitution),
            given.friction_combine,
            given.restitution_combine,
            given.rolling_friction,
            given.spinning_friction,
            given.tangential_restitution,
            given.surface_velocity};
}

void ColliderStore::copy(const ColliderStore& o) {
    slots.copy(o.slots);
    copy_array(o.geometry, geometry);
    copy_array(o.local, local);
    copy_array(o.surface, surface);
    copy_array(o.info, info);
    shape = o.shape;
    given = o.given;
    material = o.material;
    materials = o.materials;
    table = o.table;
}

void ColliderStore::let_go(uint32_t slot) {
    shape[slot] = Sphere{};
    materials[slot].clear();
    table[slot].clear();
}

uint32_t ColliderStore::add() {
    uint32_t slot = slots.add();
    size_t n = slots.capacity();
    geometry.resize(n);
    local.resize(n);
    surface.resize(n, Surface{});
    info.resize(n);
    if (shape.size() < n) shape.resize(n), given.resize(n), material.resize(n), materials.resize(n), table.resize(n);
    info[slot] = {};
    return slot;
}

}  // namespace lendulet
