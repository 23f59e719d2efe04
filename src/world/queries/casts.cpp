// Rays and shape casts through a world.
#include <algorithm>

#include "world/queries/query.h"

namespace lendulet {
namespace {

constexpr int rays_per_task = 64, casts_per_task = 8;

// A ray on its way through the world's colliders: what the walks need, and the exact test.
struct RayProbe {
    using Hit = LocalRayHit;
    const WorldData& world;
    const QueryRay ray;
    float origin[3], translation[3], half[3] = {};

    RayProbe(const WorldData& w, const Ray& r)
        : world(w),
          ray(r),
          origin{r.origin.x, r.origin.y, r.origin.z},
          translation{r.translation.x, r.translation.y, r.translation.z} {}
    float limit() const { return ray.given.max_fraction; }
    bool test(uint32_t c, const QueryTarget& t, double limit, Hit& hit) const {
        return cast_at(world.colliders.geometry[c], t.position, t.rotation, t.radius, ray, limit, hit);
    }
    QueryHit finished(const Hit& hit) const { return make_hit(hit, ray); }
};

struct ShapeProbe {
    using Hit = CastHit;
    const WorldData& world;
    const QueryCast& cast;
    float origin[3], translation[3], half[3];

    ShapeProbe(const WorldData& w, const QueryCast& c) : world(w), cast(c) {
        Vec3 middle = from_origin(c.shape.pose.position) + 0.5f * (c.lower + c.upper), h = 0.5f * (c.upper - c.lower);
        Vec3 along = to_float(c.motion.translation);
        origin[0] = middle.x, origin[1] = middle.y, origin[2] = middle.z;
        translation[0] = along.x, translation[1] = along.y, translation[2] = along.z;
        half[0] = h.x, half[1] = h.y, half[2] = h.z;
    }
    float limit() const { return cast.max_fraction; }
    bool test(uint32_t c, const QueryTarget& t, double limit, Hit& hit) const {
        return cast_at(world.colliders.geometry[c], t.position, t.rotation, cast, limit, hit);
    }
    QueryHit finished(const Hit& hit) const { return make_hit(hit, cast.shape.pose.position); }
};

// visit(collider) for whatever the probe may meet; it returns how far the search still goes.
template <class Probe, class Visit>
void for_each_candidate(const Probe& probe, const QueryFilter& filter, Visit&& visit) {
    float limit = probe.limit();
    if (filter.only_body)
        return for_each_collider(probe.world, filter.only_body.index, [&](uint32_t c) { limit = visit(c, limit); });
    probe.world.query_scene.cast(probe.origin, probe.translation, probe.half, limit,
                                 [&](uint32_t c) { return limit = visit(c, limit); });
}

// The fraction as a limit for walks: not less.
float rounded_up(double fraction) { return static_cast<float>(fraction * 1.0000002); }

template <class Probe>
QueryHit first_hit(const Probe& probe, const QueryFilter& filter) {
    const QueryScene& scene = probe.world.query_scene;
    const uint32_t ignored = ignored_slot(filter);
    typename Probe::Hit best, found;
    uint32_t best_collider = no_slot;
    double limit = probe.limit();
    for_each_candidate(probe, filter, [&](uint32_t c, float walk_limit) {
        const QueryTarget& t = scene.target(c);
        if (!is_seen(t, ignored, filter) || !probe.test(c, t, limit, found)) return walk_limit;
        bool first = best_collider == no_slot || found.fraction < best.fraction ||
                     (found.fraction == best.fraction && c < best_collider);
        if (!first) return walk_limit;
        best = found;
        best_collider = c;
        limit = found.fraction;
        return rounded_up(limit);
    });
    if (best_collider == no_slot) return {};
    QueryHit hit = probe.finished(best);
    name_collider(probe.world, best_collider, hit);
    return hit;
}

template <class Probe>
bool any_hit(const Probe& probe, const QueryFilter& filter) {
    const QueryScene& scene = probe.world.query_scene;
    const uint32_t ignored = ignored_slot(filter);
    bool any = false;
    for_each_candidate(probe, filter, [&](uint32_t c, float walk_limit) {
        const QueryTarget& t = scene.target(c);
        typename Probe::Hit found;
        if (any || !is_seen(t, ignored, filter) || !probe.test(c, t, probe.limit(), found)) return walk_limit;
        any = true;
        return -1.0f;  // nothing more
    });
    return any;
}

template <class Probe>
int all_hits(const Probe& probe, const QueryFilter& filter, std::span<QueryHit> out) {
    const QueryScene& scene = probe.world.query_scene;
    const uint32_t ignored = ignored_slot(filter);
    struct Met {
        double fraction;
        uint32_t collider;
        typename Probe::Hit hit;
    };
    Array<Met> met;
    for_each_candidate(probe, filter, [&](uint32_t c, float walk_limit) {
        const QueryTarget& t = scene.target(c);
        typename Probe::Hit found;
        if (is_seen(t, ignored, filter) && probe.test(c, t, probe.limit(), found))
            met.push_back({found.fraction, c, found});
        return walk_limit;
    });
    std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {  // order: total
        return a.fraction != b.fraction ? a.fraction < b.fraction : a.collider < b.collider;
    });
    for (size_t i = 0; i < met.size() && i < out.size(); ++i) {
        out[i] = probe.finished(met[i].hit);
        name_collider(probe.world, met[i].collider, out[i]);
    }
    return met.count();
}

Status checked(const WorldData& world, const Ray& ray, const QueryFilter& filter, const char* call) {
    if (Status s = check_ray(ray, call); !s) return s;
    return check_filter(world, filter, call);
}

Result<QueryCast> checked(const WorldData& world, const ShapeCast& cast, const QueryFilter& filter, const char* call) {
    if (Status s = check_filter(world, filter, call); !s) return s.error();
    return check_cast(cast, call);
}

Error at_place(const Error& error, size_t i) {
    return {error.code, error.message + " (element " + std::to_string(i) + ")"};
}

Status check_lengths(size_t in, size_t out, const char* call) {
    if (in == out && in <= 0x7fffffff) return {};
    return Error{ErrorCode::bad_query, std::string(call) + ": there is room for " + std::to_string(out) +
                                           " hits, but there are " + std::to_string(in) + " casts"};
}

}  // namespace

Result<QueryHit> World::cast_ray(const Ray& ray, const QueryFilter& filter) const {
    if (Status s = checked(*data_, ray, filter, "cast_ray"); !s) return s.error();
    data_->query_scene.refresh(*data_);
    return first_hit(RayProbe(*data_, ray), filter);
}

Result<bool> World::cast_ray_any(const Ray& ray, const QueryFilter& filter) const {
    if (Status s = checked(*data_, ray, filter, "cast_ray_any"); !s) return s.error();
    data_->query_scene.refresh(*data_);
    return any_hit(RayProbe(*data_, ray), filter);
}

Result<int> World::cast_ray_all(const Ray& ray, std::span<QueryHit> out, const QueryFilter& filter) const {
    if (Status s = checked(*data_, ray, filter, "cast_ray_all"); !s) return s.error();
    data_->query_scene.refresh(*data_);
    return all_hits(RayProbe(*data_, ray), filter, out);
}

Status World::cast_rays(std::span<const Ray> rays, std::span<QueryHit> out, const QueryFilter& filter) {
    constexpr const char* call = "cast_rays";
    WorldData& world = *data_;
    if (Status s = check_lengths(rays.size(), out.size(), call); !s) return s;
    if (Status s = check_filter(world, filter, call); !s) return s;
    for (size_t i = 0; i < rays.size(); ++i)
        if (Status s = check_ray(rays[i], call); !s) return at_place(s.error(), i);
    world.query_scene.refresh(world);
    world.tasks.for_each(static_cast<int>(rays.size()), rays_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            out[i] = first_hit(RayProbe(world, rays[i]), filter);
    });
    return {};
}

Result<QueryHit> World::cast_shape(const ShapeCast& cast, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(*data_, cast, filter, "cast_shape");
    if (!c) return c.error();
    data_->query_scene.refresh(*data_);
    return first_hit(ShapeProbe(*data_, c.value()), filter);
}

Result<bool> World::cast_shape_any(const ShapeCast& cast, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(*data_, cast, filter, "cast_shape_any");
    if (!c) return c.error();
    data_->query_scene.refresh(*data_);
    return any_hit(ShapeProbe(*data_, c.value()), filter);
}

Result<int> World::cast_shape_all(const ShapeCast& cast, std::span<QueryHit> out, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(*data_, cast, filter, "cast_shape_all");
    if (!c) return c.error();
    data_->query_scene.refresh(*data_);
    return all_hits(ShapeProbe(*data_, c.value()), filter, out);
}

Status World::cast_shapes(std::span<const ShapeCast> casts, std::span<QueryHit> out, const QueryFilter& filter) {
    constexpr const char* call = "cast_shapes";
    WorldData& world = *data_;
    if (Status s = check_lengths(casts.size(), out.size(), call); !s) return s;
    for (size_t i = 0; i < casts.size(); ++i)
        if (Result<QueryCast> c = checked(world, casts[i], filter, call); !c) return at_place(c.error(), i);
    world.query_scene.refresh(world);
    world.tasks.for_each(static_cast<int>(casts.size()), casts_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            Result<QueryCast> c = check_cast(casts[i], call);
            out[i] = first_hit(ShapeProbe(world, c.value()), filter);
        }
    });
    return {};
}

}  // namespace lendulet
