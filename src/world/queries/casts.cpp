// Rays and shape casts through a world.
#include <algorithm>

#include "base/prefetch.h"
#include "world/queries/query.h"

namespace lendulet {
namespace {

constexpr int casts_per_task = 8;

// A ray on its way through the world's colliders: what the walks need, and the exact test.
struct RayProbe {
    using Hit = LocalRayHit;
    QueryRay ray;
    SweptBox swept;

    RayProbe() = default;
    explicit RayProbe(const Ray& r)
        : ray(r),
          swept{{r.origin.x, r.origin.y, r.origin.z}, {r.translation.x, r.translation.y, r.translation.z}, {}} {}
    float limit() const { return ray.max_fraction; }
    bool test(const Geometry& g, const QueryTarget& t, double limit, Hit& hit) const {
        if (t.is_box) return cast_at_box(t, ray, limit, hit);
        return cast_at(g, t.position, t.rotation, t.radius, ray, limit, hit);
    }
    QueryHit finished(const Hit& hit) const { return make_hit(hit, ray); }
};

struct ShapeProbe {
    using Hit = CastHit;
    const QueryCast& cast;
    SweptBox swept;

    explicit ShapeProbe(const QueryCast& c) : cast(c) {
        Vec3 middle = from_origin(c.shape.pose.position) + 0.5f * (c.lower + c.upper), h = 0.5f * (c.upper - c.lower);
        Vec3 along = to_float(c.motion.translation);
        swept = {{middle.x, middle.y, middle.z}, {along.x, along.y, along.z}, {h.x, h.y, h.z}};
    }
    float limit() const { return cast.max_fraction; }
    bool test(const Geometry& g, const QueryTarget& t, double limit, Hit& hit) const {
        return cast_at(g, t.position, t.rotation, cast, limit, hit);
    }
    QueryHit finished(const Hit& hit) const { return make_hit(hit, cast.shape.pose.position); }
};

// Whom a query asks, and which of its colliders it sees.
struct Asked {
    const WorldData& world;
    const QueryFilter& filter;
    const uint32_t ignored;

    Asked(const WorldData& w, const QueryFilter& f) : world(w), filter(f), ignored(ignored_slot(f)) {}
    // The exact test against collider c up to fraction `limit`; false, too, where it is not seen.
    template <class Probe>
    bool meets(const Probe& probe, uint32_t c, double limit, typename Probe::Hit& hit) const {
        const QueryTarget& t = world.query_scene.target(c);
        return is_seen(t, ignored, filter) && probe.test(world.colliders.geometry[c], t, limit, hit);
    }
};

// visit(collider) for whatever the probe may meet; it returns how far the search still goes.
template <class Probe, class Visit>
void for_each_candidate(const Asked& asked, const Probe& probe, Visit&& visit) {
    if (asked.filter.only_body) return for_each_collider(asked.world, asked.filter.only_body.index, visit);
    asked.world.query_scene.cast(probe.swept, probe.limit(), visit);
}

// The fraction as a limit for walks: not less.
float rounded_up(double fraction) { return static_cast<float>(fraction * 1.0000002); }

// What a probe meets first of what it has been tested with.
template <class Probe>
struct FirstHit {
    double limit;
    float walk_limit;
    uint32_t collider = no_slot;
    typename Probe::Hit hit;

    FirstHit() = default;
    explicit FirstHit(const Probe& probe) : limit(probe.limit()), walk_limit(probe.limit()) {}
    void test(const Asked& asked, const Probe& probe, uint32_t c) {
        typename Probe::Hit found;
        if (asked.meets(probe, c, limit, found)) take(c, found);
    }
    // Collider c is met. True where before all others.
    bool take(uint32_t c, const typename Probe::Hit& found) {
        if (collider != no_slot && !(found.fraction < limit || (found.fraction == limit && c < collider))) return false;
        hit = found;
        collider = c;
        limit = found.fraction;
        walk_limit = rounded_up(limit);
        return true;
    }
    QueryHit finished(const Asked& asked, const Probe& probe) const {
        if (collider == no_slot) return {};
        QueryHit out = probe.finished(hit);
        name_collider(asked.world, collider, out);
        return out;
    }
};

template <class Probe>
QueryHit first_hit(const Asked& asked, const Probe& probe) {
    FirstHit<Probe> first(probe);
    for_each_candidate(asked, probe, [&](uint32_t c) {
        first.test(asked, probe, c);
        return first.walk_limit;
    });
    return first.finished(asked, probe);
}

// Rays that take their way through the trees by turns. What they meet does not depend on it: the tests are those of
// single rays, and the first of all hits is the same in whatever order they are found.
struct RayGroup {
    static constexpr int room = 64;
    const Asked& asked;
    int count = 0;
    RayProbe probe[room];
    FirstHit<RayProbe> first[room];
    SweptBox swept[room];
    float limit[room];
    BoxTrial trials[most_visits];

    explicit RayGroup(const Asked& a) : asked(a) {}
    void add(const Ray& ray) {
        probe[count] = RayProbe(ray);
        first[count] = FirstHit<RayProbe>(probe[count]);
        swept[count] = probe[count].swept;
        limit[count] = ray.max_fraction;
        ++count;
    }
    static void visit(void* group, const CastVisit* visits, int count) {
        static_cast<RayGroup*>(group)->visit(visits, count);
    }
    // Which boxes are met cannot be foreseen, so all are tested before the first is looked at.
    void visit(const CastVisit* visits, int visit_count) {
        const QueryScene& scene = asked.world.query_scene;
        for (int k = 0; k < visit_count; ++k) {
            const auto [i, c] = visits[k];
            const QueryTarget& t = scene.target(c);
            if (t.is_box) trials[k].begin(t, probe[i].ray, first[i].limit);
        }
        for (int k = 0; k < visit_count; ++k) {
            const auto [i, c] = visits[k];
            const QueryTarget& t = scene.target(c);
            LocalRayHit found;
            const bool met = t.is_box ? trials[k].finish(found) && is_seen(t, asked.ignored, asked.filter)
                                      : asked.meets(probe[i], c, first[i].limit, found);
            if (!met || !first[i].take(c, found)) continue;
            limit[i] = first[i].walk_limit;
            // What is read when the group is finished.
            prefetch(&asked.world.colliders.info[c]);
            prefetch(&asked.world.bodies.info[t.body]);
        }
    }
    void cast() {
        if (!asked.filter.only_body)
            return asked.world.query_scene.cast_many({{}, 0, swept, limit, count, this, visit, nullptr, 0});
        for (int i = 0; i < count; ++i)
            for_each_collider(asked.world, asked.filter.only_body.index,
                              [&](uint32_t c) { first[i].test(asked, probe[i], c); });
    }
    QueryHit finished(int i) const { return first[i].finished(asked, probe[i]); }
};

void cast_in_groups(const Asked& asked, std::span<const Ray> rays, std::span<QueryHit> out) {
    constexpr size_t room = RayGroup::room;
    for (size_t begin = 0; begin < rays.size(); begin += room) {
        const size_t count = rays.size() - begin < room ? rays.size() - begin : room;
        RayGroup group(asked);
        for (size_t i = 0; i < count; ++i) group.add(rays[begin + i]);
        group.cast();
        for (size_t i = 0; i < count; ++i) out[begin + i] = group.finished(static_cast<int>(i));
    }
}

template <class Probe>
bool any_hit(const Asked& asked, const Probe& probe) {
    bool any = false;
    for_each_candidate(asked, probe, [&](uint32_t c) {
        typename Probe::Hit found;
        any = any || asked.meets(probe, c, probe.limit(), found);
        return any ? -1.0f : probe.limit();  // nothing more
    });
    return any;
}

template <class Probe>
int all_hits(const Asked& asked, const Probe& probe, std::span<QueryHit> out) {
    struct Met {
        double fraction;
        uint32_t collider;
        typename Probe::Hit hit;
    };
    Array<Met> met;
    for_each_candidate(asked, probe, [&](uint32_t c) {
        typename Probe::Hit found;
        if (asked.meets(probe, c, probe.limit(), found)) met.push_back({found.fraction, c, found});
        return probe.limit();
    });
    std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {  // order: total
        return a.fraction != b.fraction ? a.fraction < b.fraction : a.collider < b.collider;
    });
    for (size_t i = 0; i < met.size() && i < out.size(); ++i) {
        out[i] = probe.finished(met[i].hit);
        name_collider(asked.world, met[i].collider, out[i]);
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
    if (Status s = checked(data(), ray, filter, "cast_ray"); !s) return s.error();
    data().query_scene.refresh(data());
    return first_hit(Asked(data(), filter), RayProbe(ray));
}

Result<bool> World::cast_ray_any(const Ray& ray, const QueryFilter& filter) const {
    if (Status s = checked(data(), ray, filter, "cast_ray_any"); !s) return s.error();
    data().query_scene.refresh(data());
    return any_hit(Asked(data(), filter), RayProbe(ray));
}

Result<int> World::cast_ray_all(const Ray& ray, std::span<QueryHit> out, const QueryFilter& filter) const {
    if (Status s = checked(data(), ray, filter, "cast_ray_all"); !s) return s.error();
    data().query_scene.refresh(data());
    return all_hits(Asked(data(), filter), RayProbe(ray), out);
}

Status World::cast_rays(std::span<const Ray> rays, std::span<QueryHit> out, const QueryFilter& filter) {
    constexpr const char* call = "cast_rays";
    WorldData& world = data();
    if (Status s = check_lengths(rays.size(), out.size(), call); !s) return s;
    if (Status s = check_filter(world, filter, call); !s) return s;
    for (size_t i = 0; i < rays.size(); ++i)
        if (Status s = check_ray(rays[i], call); !s) return at_place(s.error(), i);
    world.query_scene.refresh(world);
    const Asked asked(world, filter);
    world.tasks.for_each(static_cast<int>(rays.size()), RayGroup::room, [&](int begin, int end, int) {
        const auto first = static_cast<size_t>(begin), count = static_cast<size_t>(end - begin);
        cast_in_groups(asked, rays.subspan(first, count), out.subspan(first, count));
    });
    return {};
}

Result<QueryHit> World::cast_shape(const ShapeCast& cast, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(data(), cast, filter, "cast_shape");
    if (!c) return c.error();
    data().query_scene.refresh(data());
    return first_hit(Asked(data(), filter), ShapeProbe(c.value()));
}

Result<bool> World::cast_shape_any(const ShapeCast& cast, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(data(), cast, filter, "cast_shape_any");
    if (!c) return c.error();
    data().query_scene.refresh(data());
    return any_hit(Asked(data(), filter), ShapeProbe(c.value()));
}

Result<int> World::cast_shape_all(const ShapeCast& cast, std::span<QueryHit> out, const QueryFilter& filter) const {
    Result<QueryCast> c = checked(data(), cast, filter, "cast_shape_all");
    if (!c) return c.error();
    data().query_scene.refresh(data());
    return all_hits(Asked(data(), filter), ShapeProbe(c.value()), out);
}

Status World::cast_shapes(std::span<const ShapeCast> casts, std::span<QueryHit> out, const QueryFilter& filter) {
    constexpr const char* call = "cast_shapes";
    WorldData& world = data();
    if (Status s = check_lengths(casts.size(), out.size(), call); !s) return s;
    for (size_t i = 0; i < casts.size(); ++i)
        if (Result<QueryCast> c = checked(world, casts[i], filter, call); !c) return at_place(c.error(), i);
    world.query_scene.refresh(world);
    const Asked asked(world, filter);
    world.tasks.for_each(static_cast<int>(casts.size()), casts_per_task, [&](int begin, int end, int) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            Result<QueryCast> c = check_cast(casts[i], call);
            out[i] = first_hit(asked, ShapeProbe(c.value()));
        }
    });
    return {};
}

}  // namespace lendulet
