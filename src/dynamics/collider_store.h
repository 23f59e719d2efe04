// All colliders of a world: shapes placed on bodies, with surface and filter.
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory.h"
#include "dynamics/body_store.h"
#include "dynamics/slots.h"
#include "geometry/geometry.h"
#include "lendulet/body.h"

namespace lendulet {

// A material with the world's defaults filled in.
struct Surface {
    float static_friction, dynamic_friction, restitution;
    CombineRule friction_combine, restitution_combine;
    float rolling_friction = 0.0f, spinning_friction = 0.0f, tangential_restitution = 0.0f;
    Vec3 velocity{};  // over its body, in the collider's frame, m/s
    bool runs() const { return velocity.x != 0.0f || velocity.y != 0.0f || velocity.z != 0.0f; }
    bool has_extra() const {
        return rolling_friction > 0.0f || spinning_friction > 0.0f || tangential_restitution > 0.0f || runs();
    }
};

Surface with_defaults(const Material& given, float friction, float restitution);

// The surface of a contact. Where rules disagree the one that comes first in CombineRule wins.
struct ContactSurface {
    float static_friction, dynamic_friction, restitution;
};
ContactSurface combine(const Surface& a, const Surface& b);
// And what few surfaces have; by the same rules.
struct ExtraSurface {
    float rolling_friction, spinning_friction, tangential_restitution;
};
ExtraSurface combine_extra(const Surface& a, const Surface& b);

inline bool filters_match(const CollisionFilter& a, const CollisionFilter& b) {
    if (a.group != 0 && a.group == b.group) return false;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

struct ColliderInfo {
    uint32_t body = no_slot, next = no_slot;  // the body's next collider
    bool is_trigger = false;
    Events events = Events::none;
    bool boxed = false;     // in the broad phase since the last step; a new owner of a slot is not
    uint32_t boxed_at = 0;  // number of the step in which it came there
    float radius = 0.0f;    // of a sphere about the shape's position that holds it
    float depth = 0.0f;     // of its inner core below its surface, m
    CollisionFilter filter{};
    uint64_t user_data = 0;
};

struct ColliderStore {
    Slots slots;
    Array<Geometry> geometry;
    Array<Transform> local;  // in the body's principal frame
    Array<Surface> surface;
    Array<ColliderInfo> info;
    std::vector<std::vector<Surface>> materials;  // of triangles; empty: all have `surface`
    // As given: keeps shared hulls and meshes alive; in the user's body frame; without the world's defaults.
    std::vector<Shape> shape;
    std::vector<Transform> given;
    std::vector<Material> material;
    std::vector<std::vector<Material>> table;  // for `materials`

    ColliderStore(const Memory* memory, uint32_t world)
        : slots(memory, world), geometry(memory), local(memory), surface(memory), info(memory) {}

    uint32_t add();
    // Lets go of shared hulls, meshes and height fields of a collider that is removed.
    void let_go(uint32_t slot);
    // The surface of a collider at one of its triangles (number in the user's list), or at none: -1.
    const Surface& surface_at(uint32_t slot, int32_t triangle) const;
    // Becomes a copy of another world's colliders, with their handles; hulls and meshes are shared.
    void copy(const ColliderStore& o);
    ColliderId id(uint32_t slot) const { return {slot, slots.generation(slot)}; }
    bool alive(ColliderId c) const { return slots.alive(c.index, c.generation); }
};

}  // namespace lendulet
