// Checks of what queries are given.
#include "geometry/hull.h"
#include "world/queries/query.h"
#include "world/validate.h"

namespace lendulet {
namespace {

constexpr float longest_turn = 100.0f;  // rad

Error bad(const char* call, const std::string& what) { return {ErrorCode::bad_query, std::string(call) + ": " + what}; }

Status check_fraction(float fraction, const char* call) {
    if (is_finite(fraction) && fraction >= 0.0f) return {};
    return bad(call, "max_fraction is " + text(fraction) + ", must be finite and not negative");
}

}  // namespace

Status check_ray(const Ray& ray, const char* call) {
    if (!is_finite(from_origin(ray.origin)) || !is_finite(ray.translation))
        return bad(call, "the ray's origin and translation must be finite");
    if (!(max_component(absolute(ray.translation)) > 0.0f)) return bad(call, "the ray has no length");
    return check_fraction(ray.max_fraction, call);
}

Status check_point(Position point, const char* call) {
    if (is_finite(from_origin(point))) return {};
    return bad(call, "the point must be finite");
}

Status check_filter(const WorldData& world, const QueryFilter& filter, const char* call) {
    if (filter.ignore_body && !world.bodies.alive(filter.ignore_body))
        return bad(call, "the filter's ignore_body is no body of this world any more");
    if (filter.only_body && !world.bodies.alive(filter.only_body))
        return bad(call, "the filter's only_body is no body of this world any more");
    return {};
}

Result<QueryShape> check_shape(const PosedShape& placed, const char* call) {
    Result<Geometry> geometry = make_geometry(placed.shape);
    if (!geometry) return bad(call, geometry.error().message);
    if (!is_finite(from_origin(placed.pose.position))) return bad(call, "the shape's position must be finite");
    Result<Quat> q = unit_quaternion(placed.pose.orientation, call);
    if (!q) return Error{ErrorCode::bad_query, q.error().message};
    return QueryShape{geometry.value(), {placed.pose.position, q.value()}};
}

Result<QueryShape> check_convex(const PosedShape& placed, const char* call) {
    Result<QueryShape> shape = check_shape(placed, call);
    if (!shape) return shape;
    const Geometry& g = shape.value().geometry;
    if (g.kind == GeometryKind::plane || has_triangles(g))
        return bad(call, "the shape must be convex: neither a plane nor a mesh nor a height field");
    return shape;
}

Result<QueryCast> check_cast(const ShapeCast& cast, const char* call) {
    Result<QueryShape> shape = check_convex(cast.start, call);
    if (!shape) return shape.error();
    if (!is_finite(cast.translation) || !is_finite(cast.rotation))
        return bad(call, "translation and rotation must be finite");
    float angle = length(cast.rotation);
    if (!(angle <= longest_turn))
        return bad(call, "the rotation is " + text(angle) + " rad, must be at most " + text(longest_turn));
    if (!(max_component(absolute(cast.translation)) > 0.0f) && !(angle > 0.0f))
        return bad(call, "the cast goes nowhere: translation and rotation are zero");
    if (Status s = check_fraction(cast.max_fraction, call); !s) return s.error();
    QueryCast c{shape.value(), {}, {}, {}, cast.max_fraction};
    c.motion.rotation = c.shape.pose.orientation;
    c.motion.translation = to_double(cast.translation);
    c.motion.axis = normalize(cast.rotation);
    c.motion.angle = angle;
    CentredBox box = bounds(c.shape.geometry, c.motion.rotation);
    c.lower = box.centre - box.half, c.upper = box.centre + box.half;
    if (angle > 0.0f) {
        float reach = bounding_radius(c.shape.geometry);
        c.lower = {-reach, -reach, -reach}, c.upper = {reach, reach, reach};
    }
    return c;
}

}  // namespace lendulet
