// Overlaps, closest points and containment in a world.
#include <algorithm>

#include "world/queries/query.h"
#include "world/validate.h"

namespace lendulet {
namespace {

// A query's shape among the colliders.
struct ShapeSearch {
    const WorldData& world;
    const QueryFilter& filter;
    const QueryShape& shape;
    uint32_t ignored;
    float lower[3], upper[3];

    ShapeSearch(const WorldData& w, const QueryFilter& f, const QueryShape& s)
        : world(w), filter(f), shape(s), ignored(ignored_slot(f)) {
        CentredBox box = bounds(s.geometry, s.pose.orientation);
        Vec3 centre = from_origin(s.pose.position) + box.centre;
        // Sums are rounded: not to lose what just touches.
        Vec3 half = box.half + 1e-6f * (absolute(centre) + box.half);
        lower[0] = centre.x - half.x, lower[1] = centre.y - half.y, lower[2] = centre.z - half.z;
        upper[0] = centre.x + half.x, upper[1] = centre.y + half.y, upper[2] = centre.z + half.z;
    }

    // The shape's place seen from a collider. Normals and points of the result are relative to the collider.
    bool near(uint32_t c, double limit, Nearness& n) const {
        const QueryTarget& t = world.query_scene.target(c);
        if (!is_seen(t, ignored, filter)) return false;
        Vec3d offset = in_double(shape.pose.position) - to_double(t.position);
        const Geometry& g = world.colliders.geometry[c];
        return nearness({&g, &shape.geometry, t.rotation, shape.pose.orientation, offset}, limit, n);
    }
    Proximity finished(uint32_t c, Nearness n) const {
        n.normal = -n.normal;
        Vec3d point = n.point_a;
        n.point_a = n.point_b, n.point_b = point;
        Proximity p = make_proximity(n, lendulet::at(world.query_scene.target(c).position));
        name_collider(world, c, p);
        return p;
    }
    template <class Visit>
    void for_each_candidate(Visit&& visit) const {
        if (filter.only_body) for_each_collider(world, filter.only_body.index, visit);
        else world.query_scene.overlapping(lower, upper, visit);
    }
};

Proximity nearest_of(const ShapeSearch& s, float max_distance) {
    Nearness best{}, found;
    uint32_t best_collider = no_slot;
    double limit = max_distance;
    auto visit = [&](uint32_t c) {
        auto rounded_up = [&] { return static_cast<float>(limit * 1.0000002); };
        if (!s.near(c, limit, found)) return rounded_up();
        bool first = best_collider == no_slot || found.distance < best.distance ||
                     (found.distance == best.distance && c < best_collider);
        if (!first) return rounded_up();
        best = found;
        best_collider = c;
        limit = maximum(found.distance, 0.0);
        return rounded_up();
    };
    if (s.filter.only_body) for_each_collider(s.world, s.filter.only_body.index, visit);
    else s.world.query_scene.nearest(s.lower, s.upper, max_distance, visit);
    return best_collider == no_slot ? Proximity{} : s.finished(best_collider, best);
}

// `solids_only`: not surfaces of triangles.
int all_overlaps(const ShapeSearch& s, std::span<Proximity> out, bool solids_only) {
    struct Met {
        uint32_t collider;
        Nearness nearness;
    };
    Array<Met> met;
    s.for_each_candidate([&](uint32_t c) {
        Nearness n;
        if (solids_only && has_triangles(s.world.colliders.geometry[c])) return;
        if (s.near(c, 0.0, n)) met.push_back({c, n});
    });
    auto by_id = [](const Met& a, const Met& b) { return a.collider < b.collider; };
    std::sort(met.begin(), met.end(), by_id);  // order: total
    for (size_t i = 0; i < met.size() && i < out.size(); ++i) out[i] = s.finished(met[i].collider, met[i].nearness);
    return met.count();
}

Status check_distance(float distance, const char* call) {
    if (is_finite(distance) && distance >= 0.0f) return {};
    return Error{ErrorCode::bad_query,
                 std::string(call) + ": max_distance is " + text(distance) + ", must be finite and not negative"};
}

QueryShape dot_at(Position point) { return {Geometry{}, {point, {}}}; }

}  // namespace

Result<Proximity> World::closest(const PosedShape& shape, float max_distance, const QueryFilter& filter) const {
    constexpr const char* call = "closest";
    Result<QueryShape> s = check_convex(shape, call);
    if (!s) return s.error();
    if (Status d = check_distance(max_distance, call); !d) return d.error();
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    return nearest_of({data(), filter, s.value()}, max_distance);
}

Result<Proximity> World::closest(Position point, float max_distance, const QueryFilter& filter) const {
    constexpr const char* call = "closest";
    if (Status p = check_point(point, call); !p) return p.error();
    if (Status d = check_distance(max_distance, call); !d) return d.error();
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    QueryShape dot = dot_at(point);
    return nearest_of({data(), filter, dot}, max_distance);
}

Result<int> World::overlap_shape(const PosedShape& shape, std::span<Proximity> out, const QueryFilter& filter) const {
    constexpr const char* call = "overlap_shape";
    Result<QueryShape> s = check_convex(shape, call);
    if (!s) return s.error();
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    return all_overlaps({data(), filter, s.value()}, out, false);
}

Result<bool> World::overlap_any(const PosedShape& shape, const QueryFilter& filter) const {
    constexpr const char* call = "overlap_any";
    Result<QueryShape> s = check_convex(shape, call);
    if (!s) return s.error();
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    const ShapeSearch search(data(), filter, s.value());
    bool any = false;
    search.for_each_candidate([&](uint32_t c) {
        Nearness n;
        any = any || search.near(c, 0.0, n);
    });
    return any;
}

Result<int> World::overlap_box(const Aabb& box, std::span<Proximity> out, const QueryFilter& filter) const {
    constexpr const char* call = "overlap_box";
    if (!is_finite(from_origin(box.lower)) || !is_finite(from_origin(box.upper)))
        return Error{ErrorCode::bad_query, "overlap_box: the box's corners must be finite"};
    Vec3 size = box.upper - box.lower;
    if (!(min_component(size) >= 0.0f))
        return Error{ErrorCode::bad_query, "overlap_box: the box's lower corner is above its upper one"};
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    QueryShape s{Geometry{}, {box.lower + 0.5f * size, {}}};
    s.geometry.kind = GeometryKind::box;
    s.geometry.size = 0.5f * size;
    return all_overlaps({data(), filter, s}, out, false);
}

Result<int> World::overlap_point(Position point, std::span<Proximity> out, const QueryFilter& filter) const {
    constexpr const char* call = "overlap_point";
    if (Status p = check_point(point, call); !p) return p.error();
    if (Status f = check_filter(data(), filter, call); !f) return f.error();
    data().query_scene.refresh(data());
    QueryShape dot = dot_at(point);
    return all_overlaps({data(), filter, dot}, out, true);
}

}  // namespace lendulet
