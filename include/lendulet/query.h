// Questions to a world, to one body or to one shape: rays, casts, overlaps, closest points, containment.
//
// What they see is the present: every collider where its body is now, also bodies that were added, removed or moved
// since the last step. All solids are closed sets, so touching counts. Meshes and height fields are
// surfaces without an inside, met from both sides unless they are one-sided.
//
// Errors are ErrorCode::bad_query with a sentence: numbers that are not finite, rays and casts without length, boxes
// whose lower corner is above the upper one, shapes that no body accepts, ids of bodies that are gone. See
// docs/queries.md for cost and threads.
#pragma once

#include <cstdint>

#include "lendulet/body.h"

namespace lendulet {

// The points origin + t * translation, t from 0 to max_fraction (>= 0, finite). The translation must not be zero.
struct Ray {
    Position origin{};
    Vec3 translation{0.0f, -1.0f, 0.0f};  // m
    float max_fraction = 1.0f;
};

// A shape somewhere. For most questions it must be convex: neither a plane nor a surface of triangles.
struct PosedShape {
    Shape shape{};
    Pose pose{};  // of the shape's frame
};

// A convex shape on its way: its origin moves evenly along `translation` while it turns evenly about its origin. One of
// the two must not be zero.
struct ShapeCast {
    PosedShape start{};
    Vec3 translation{};         // m
    Vec3 rotation{};            // world axes: the axis of the turn times its angle, rad; at most 100 rad
    float max_fraction = 1.0f;  // >= 0, finite
};

// Which colliders a query sees.
struct QueryFilter {
    // As if the query were a collider with this filter: both must find the other's category in their mask, and
    // colliders of the same non-zero group are not seen. The default sees everything.
    CollisionFilter collision{~uint64_t{0}, ~uint64_t{0}, 0};
    BodyId ignore_body{};  // not seen
    BodyId only_body{};    // if given, nothing else is seen, and the query costs no more than that body's colliders
    bool see_fixed = true, see_kinematic = true, see_dynamic = true;  // by type of body
    bool see_triggers = false;
};

// Where a ray or a cast meets a collider.
struct QueryHit {
    bool hit = false;  // where not, the rest is unset
    BodyId body{};     // null where a single shape was asked
    ColliderId collider{};
    int32_t triangle = -1;  // of a mesh or height field, as counted when it was made
    float fraction = 1.0f;  // of the translation
    Position point{};       // on the collider's surface
    Vec3 normal{};          // unit, out of the collider there
    // The ray or shape was already inside at fraction 0. The normal then points against the ray; for a shape it is that
    // of the shortest way out.
    bool started_inside = false;
    uint64_t user_data = 0, body_user_data = 0;  // of the collider and of the body
    explicit operator bool() const { return hit; }
};

// How a collider, or a shape B, lies to a query's shape or point A.
struct Proximity {
    bool found = false;  // where not, the rest is unset
    BodyId body{};       // null where two single shapes were asked
    ColliderId collider{};
    int32_t triangle = -1;
    // Between the surfaces, m; negative where they overlap: the length of the shortest way out. Moving A by
    // distance * normal makes them touch. Of overlapping triangles of a surface the one that takes the longest way
    // counts.
    float distance = 0.0f;
    Vec3 normal{};                  // unit, from A to B
    Position point_a{}, point_b{};  // on the surfaces
    uint64_t user_data = 0, body_user_data = 0;
    explicit operator bool() const { return found; }
};

// --- one shape at a pose; a mesh, a height field or a plane may be the target

// Where the ray meets the shape first.
Result<QueryHit> cast_ray(const PosedShape& target, const Ray& ray);
// Where the cast shape first touches the target.
Result<QueryHit> cast_shape(const PosedShape& target, const ShapeCast& cast);
// Distance or depth, with the nearest points. One of the two must be convex. The points of two overlapping shapes are
// the ends of the shortest way out.
Result<Proximity> closest_points(const PosedShape& a, const PosedShape& b);
// Whether the two have a point in common. One of them must be convex.
Result<bool> overlaps(const PosedShape& a, const PosedShape& b);
// Whether the point is in the solid; never, where that is a mesh or height field.
Result<bool> contains(const PosedShape& shape, Position point);

}  // namespace lendulet
