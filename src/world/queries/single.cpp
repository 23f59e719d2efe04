// Questions to one shape at a pose, which are also what a world asks each collider.
#include "world/queries/query.h"

namespace lendulet {
namespace {

double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

}  // namespace

bool cast_at(const Geometry& g, Vec3 position, Quat rotation, float radius, const QueryRay& ray, double limit,
             LocalRayHit& hit) {
    Vec3d from = ray.origin - to_double(position);
    double nearest = clamp(-dot(from, ray.translation) * ray.inverse_square, 0.0, limit);
    Vec3d closest = from + nearest * ray.translation;
    if (dot(closest, closest) > static_cast<double>(radius) * radius) return false;
    Mat3d r = exact_rotation(rotation);
    LocalRay local{transpose_multiply(r, from), transpose_multiply(r, ray.translation), limit};
    if (!cast_ray(g, local, hit)) return false;
    hit.normal = r * hit.normal;
    return true;
}

bool cast_at_box(const QueryTarget& box, const QueryRay& ray, double limit, LocalRayHit& hit) {
    BoxTrial trial;
    trial.begin(box, ray, limit);
    return trial.finish(hit);
}

bool cast_at(const Geometry& g, Vec3 position, Quat rotation, const QueryCast& cast, double limit, CastHit& hit) {
    Motion still;
    still.pivot = to_double(position) - in_double(cast.shape.pose.position);
    still.rotation = rotation;
    return cast_shapes(g, still, cast.shape.geometry, cast.motion, limit, hit);
}

QueryHit make_hit(const LocalRayHit& hit, const QueryRay& ray) {
    QueryHit out;
    out.hit = true;
    out.triangle = hit.triangle;
    out.fraction = static_cast<float>(hit.fraction);
    out.point = at(ray.origin + hit.fraction * ray.translation);
    out.normal = to_float(hit.normal);
    out.started_inside = hit.inside;
    return out;
}

QueryHit make_hit(const CastHit& hit, Position start) {
    QueryHit out;
    out.hit = true;
    out.triangle = hit.triangle;
    out.fraction = static_cast<float>(hit.fraction);
    out.point = at(in_double(start) + hit.point);
    out.normal = to_float(hit.normal);
    out.started_inside = hit.overlapping;
    return out;
}

Proximity make_proximity(const Nearness& n, Position origin) {
    Proximity out;
    out.found = true;
    out.triangle = n.triangle;
    out.distance = static_cast<float>(n.distance);
    out.normal = to_float(n.normal);
    out.point_a = at(in_double(origin) + n.point_a);
    out.point_b = at(in_double(origin) + n.point_b);
    return out;
}

Result<QueryHit> cast_ray(const PosedShape& target, const Ray& ray) {
    constexpr const char* call = "cast_ray";
    Result<QueryShape> shape = check_shape(target, call);
    if (!shape) return shape.error();
    if (Status s = check_ray(ray, call); !s) return s.error();
    const QueryShape& t = shape.value();
    const QueryRay ready(ray);
    float radius = 1.00001f * bounding_radius(t.geometry);
    LocalRayHit hit;
    if (!cast_at(t.geometry, from_origin(t.pose.position), t.pose.orientation, radius, ready, ray.max_fraction, hit))
        return QueryHit{};
    return make_hit(hit, ready);
}

Result<QueryHit> cast_shape(const PosedShape& target, const ShapeCast& cast) {
    constexpr const char* call = "cast_shape";
    Result<QueryShape> shape = check_shape(target, call);
    if (!shape) return shape.error();
    Result<QueryCast> c = check_cast(cast, call);
    if (!c) return c.error();
    const QueryShape& t = shape.value();
    CastHit hit;
    if (!cast_at(t.geometry, from_origin(t.pose.position), t.pose.orientation, c.value(), cast.max_fraction, hit))
        return QueryHit{};
    return make_hit(hit, c.value().shape.pose.position);
}

namespace {

// The two shapes with the convex one as B of the pair; `swapped` where that is the caller's A.
struct Ordered {
    QueryShape first, second;
    bool swapped;
    PlacedPair pair() const {
        return {&first.geometry, &second.geometry, first.pose.orientation, second.pose.orientation,
                in_double(second.pose.position) - in_double(first.pose.position)};
    }
};

Result<Ordered> in_order(const PosedShape& a, const PosedShape& b, const char* call) {
    Result<QueryShape> sa = check_shape(a, call);
    if (!sa) return sa.error();
    Result<QueryShape> sb = check_shape(b, call);
    if (!sb) return sb.error();
    auto convex = [](const QueryShape& s) {
        return s.geometry.kind != GeometryKind::plane && !has_triangles(s.geometry);
    };
    if (convex(sb.value())) return Ordered{sa.value(), sb.value(), false};
    if (convex(sa.value())) return Ordered{sb.value(), sa.value(), true};
    return Error{ErrorCode::bad_query, std::string(call) + ": one of the shapes must be convex"};
}

}  // namespace

Result<Proximity> closest_points(const PosedShape& a, const PosedShape& b) {
    Result<Ordered> o = in_order(a, b, "closest_points");
    if (!o) return o.error();
    Nearness n;
    if (!nearness(o.value().pair(), 1e37, n)) return Proximity{};
    if (o.value().swapped) {
        n.normal = -n.normal;
        Vec3d point = n.point_a;
        n.point_a = n.point_b, n.point_b = point;
    }
    return make_proximity(n, o.value().first.pose.position);
}

Result<bool> overlaps(const PosedShape& a, const PosedShape& b) {
    Result<Ordered> o = in_order(a, b, "overlaps");
    if (!o) return o.error();
    return touching(o.value().pair());
}

Result<bool> contains(const PosedShape& shape, Position point) {
    constexpr const char* call = "contains";
    Result<QueryShape> s = check_shape(shape, call);
    if (!s) return s.error();
    if (Status p = check_point(point, call); !p) return p.error();
    const QueryShape& q = s.value();
    if (has_triangles(q.geometry)) return false;
    static constexpr Geometry dot{};
    return touching({&q.geometry, &dot, q.pose.orientation, {}, in_double(point) - in_double(q.pose.position)});
}

}  // namespace lendulet
