// What the queries share: checks at the door, the filter, and the step from a collider to a hit.
#pragma once

#include <string>

#include "collision/query/cast.h"
#include "collision/query/proximity.h"
#include "collision/query/ray.h"
#include "lendulet/query.h"
#include "world/world_data.h"

namespace lendulet {

// Each is the error for the first thing that is wrong, naming the call.
Status check_ray(const Ray& ray, const char* call);
Status check_filter(const WorldData& world, const QueryFilter& filter, const char* call);
Status check_point(Position point, const char* call);

// A placed shape, ready for use: unit quaternion, geometry that points into the shape given.
struct QueryShape {
    Geometry geometry;
    Pose pose;
};
Result<QueryShape> check_shape(const PosedShape& placed, const char* call);
Result<QueryShape> check_convex(const PosedShape& placed, const char* call);

// A cast, ready for use.
struct QueryCast {
    QueryShape shape;
    Motion motion;      // about the shape's origin, which is at the common frame's origin when it starts
    Vec3 lower, upper;  // bounds of the shape about its origin through all its turning, world axes
    float max_fraction;
};
Result<QueryCast> check_cast(const ShapeCast& cast, const char* call);

// Whether the filter lets a collider be seen.
inline bool is_seen(const QueryTarget& t, uint32_t ignored, const QueryFilter& f) {
    if (t.body == no_slot || t.body == ignored || (t.is_trigger && !f.see_triggers)) return false;
    bool types[] = {f.see_fixed, f.see_kinematic, f.see_dynamic};
    if (!types[t.type]) return false;
    if (t.group != 0 && t.group == f.collision.group) return false;
    return (t.category & f.collision.mask) != 0 && (f.collision.category & t.mask) != 0;
}

// A ray, ready for use.
struct QueryRay {
    Vec3d origin, translation;
    double inverse_square;  // 1 / |translation|^2
    float max_fraction;

    QueryRay() = default;
    explicit QueryRay(const Ray& r)
        : origin{r.origin.x, r.origin.y, r.origin.z},
          translation(to_double(r.translation)),
          inverse_square(1.0 / dot(translation, translation)),
          max_fraction(r.max_fraction) {}
};

// The ray, or cast, up to fraction `limit` against one target that lies within `radius` of its position; true with the
// hit's fraction, normal (world axes) and triangle.
bool cast_at(const Geometry& g, Vec3 position, Quat rotation, float radius, const QueryRay& ray, double limit,
             LocalRayHit& hit);
// The same against a sharp box in two parts, of which the first has no branches.
struct BoxTrial {
    Mat3d rotation;
    LocalRay ray;
    Chord chord;
    bool crosses;  // the line has a part in the box

    LENDULET_FORCE_INLINE void begin(const QueryTarget& box, const QueryRay& given, double limit) {
        const Vec3d from = given.origin - to_double(box.position);
        rotation = exact_rotation(box.rotation);
        ray = {transpose_multiply(rotation, from), transpose_multiply(rotation, given.translation), limit};
        crosses = chord_of_box(ray, to_double(box.half), chord);
    }
    LENDULET_FORCE_INLINE bool finish(LocalRayHit& hit) const {
        if (!crosses || !from_chord(chord, ray, hit)) return false;
        hit.normal = rotation * hit.normal;
        return true;
    }
};
bool cast_at_box(const QueryTarget& box, const QueryRay& ray, double limit, LocalRayHit& hit);
bool cast_at(const Geometry& g, Vec3 position, Quat rotation, const QueryCast& cast, double limit, CastHit& hit);

inline Vec3d in_double(Position p) { return {p.x, p.y, p.z}; }
inline Position at(Vec3d p) { return lendulet::at(to_float(p)); }

QueryHit make_hit(const LocalRayHit& hit, const QueryRay& ray);
QueryHit make_hit(const CastHit& hit, Position start);  // the point is relative to `start`
Proximity make_proximity(const Nearness& n, Position origin);

// Adds who was met.
template <class Hit>
void name_collider(const WorldData& world, uint32_t collider, Hit& hit) {
    const ColliderInfo& info = world.colliders.info[collider];
    hit.body = world.bodies.id(info.body);
    hit.collider = world.colliders.id(collider);
    hit.user_data = info.user_data;
    hit.body_user_data = world.bodies.info[info.body].user_data;
}

// The slot of the body to ignore, no_slot where there is none.
inline uint32_t ignored_slot(const QueryFilter& f) { return f.ignore_body ? f.ignore_body.index : no_slot; }

// visit(collider) for the colliders of one body.
template <class Visit>
void for_each_collider(const WorldData& world, uint32_t body, Visit&& visit) {
    for (uint32_t c = world.bodies.info[body].first_collider; c != no_slot; c = world.colliders.info[c].next) visit(c);
}

}  // namespace lendulet
