// Rays and shape casts through a world.
#include <algorithm>

#include "world/queries/query.h"

namespace lendulet {
namespace {

constexpr int rays_per_task = 64, casts_per_task = 8;
// Fewer rays than this are cast in the order given.
constexpr size_t ordered_rays = 512;

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

// Which of 16 cells along each axis of [low, low + 16 / scale] x lies in, spread so that six axes interleave.
uint32_t spread_cell(float x, float low, float scale) {
    float cell = (x - low) * scale;
    uint32_t i = cell >= 15.0f ? 15u : cell > 0.0f ? static_cast<uint32_t>(cell) : 0u;
    return (i & 1u) | (i & 2u) << 5 | (i & 4u) << 10 | (i & 8u) << 15;
}

// The order in which rays are cast: those that start and end near each other one after the other, so that they find
// the same parts of the trees still in the caches. It has no influence on what they meet.
Array<uint32_t> coherent_order(std::span<const Ray> rays) {
    float low[6], high[6];
    auto coordinate = [](const Ray& r, int k) {
        Vec3 p = k < 3 ? from_origin(r.origin) : from_origin(r.origin + r.max_fraction * r.translation);
        return clamp(component(p, k % 3), -1e30f, 1e30f);
    };
    for (int k = 0; k < 6; ++k) {
        low[k] = 1e30f, high[k] = -1e30f;
        for (const Ray& r : rays) {
            float x = coordinate(r, k);
            low[k] = minimum(low[k], x), high[k] = maximum(high[k], x);
        }
    }
    Array<uint32_t> keys, order, sorted;
    keys.resize(rays.size());
    order.resize_unset(rays.size());
    sorted.resize_unset(rays.size());
    for (int k = 0; k < 6; ++k) {
        float scale = high[k] > low[k] ? 16.0f / (high[k] - low[k]) : 0.0f;
        for (size_t i = 0; i < rays.size(); ++i) keys[i] |= spread_cell(coordinate(rays[i], k), low[k], scale) << k;
    }
    for (size_t i = 0; i < rays.size(); ++i) order[i] = static_cast<uint32_t>(i);
    for (int shift = 0; shift < 24; shift += 12) {  // by counting, 12 bits at a time
        uint32_t first[4097] = {};
        for (uint32_t i : order) ++first[((keys[i] >> shift) & 4095u) + 1u];
        for (int b = 0; b < 4096; ++b) first[b + 1] += first[b];
        for (uint32_t i : order) sorted[first[(keys[i] >> shift) & 4095u]++] = i;
        order.swap(sorted);
    }
    return order;
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
    Array<uint32_t> order;
    if (rays.size() >= ordered_rays) order = coherent_order(rays);
    world.tasks.for_each(static_cast<int>(rays.size()), rays_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            size_t k = order.empty() ? i : order[i];
            out[k] = first_hit(RayProbe(world, rays[k]), filter);
        }
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
