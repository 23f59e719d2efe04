// Seams: where several bodies, or triangles that are no neighbours, make up one floor, the end of each piece is an edge
// that what slides over the floor could stumble on.
//
// A contact F keeps a convex shape above the plane through its points at right angles to its normal. A piece of another
// contact E (a convex shape, or a triangle) that does not rise above that plane cannot be met from above it, so what E
// adds by another normal than F's is nothing but the piece's end: E is silenced for this step. Both must stand still
// relative to each other: they are of one pair or of static bodies.
#include <new>

#include "geometry/triangle_surface.h"
#include "math/wide/gather.h"
#include "math/wide/wide.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int pairs_per_task = 64;
// Sine of the angle up to which two normals count as one; with more a body's direction would change by so much. The
// faces of one floor have the same normal but for rounding.
constexpr float same_normal = 2e-4f;
// What rises above the plane by less than this is part of the floor: of the shape's radius, and of the depth of its
// inner core, so that thin plates do not slide into walls.
constexpr float level_of_radius = 2e-4f, level_of_depth = 0.2f;
// Clipping takes points for inside that lie this much outside a face, in parts of the shape's diameter.
constexpr float overhang = 2e-4f;
// Coordinates are rounded.
constexpr float rounding = 5e-7f;

// A manifold with what it is of.
struct Touch {
    uint32_t record;
    uint32_t fixed;  // collider of the side that constraints do not move
    Vec3 origin;     // world position from which its points count
};

uint32_t fixed_collider(const ColliderPair& p) { return p.flipped ? p.b : p.a; }
uint32_t moved_collider(const ColliderPair& p) { return p.flipped ? p.a : p.b; }
bool has_floor(const ColliderPair& p) { return p.kind != PairKind::trigger && p.fixed_a && p.count > 0; }

Touch touch_of(const WorldData& world, const ColliderPair& p, uint32_t i) {
    const uint32_t fixed = fixed_collider(p);
    const float* c = world.frames[fixed].centre;
    return {p.first_record + i, fixed, {c[0], c[1], c[2]}};
}

// How far the piece that a manifold touches rises along a world direction.
float rise_of(const WorldData& world, const Touch& t, Vec3 direction) {
    const Geometry& g = world.colliders.geometry[t.fixed];
    const ShapeFrame& f = world.frames[t.fixed];
    const Quat q{f.rotation[0], f.rotation[1], f.rotation[2], f.rotation[3]};
    const Vec3 local = rotate_inverse(q, direction), at = t.origin + Vec3{f.arm[0], f.arm[1], f.arm[2]};
    if (g.kind == GeometryKind::plane) return 1e30f;
    if (!has_triangles(g)) return dot(direction, at) + dot(local, support_core(g, local)) + g.rounding;
    const TriangleSurface surface(g);
    Vec3 p[3];
    surface.corners(surface.index_of(static_cast<uint32_t>(world.records[t.record].triangle)), p);
    return dot(direction, at) + maximum(dot(local, p[0]), maximum(dot(local, p[1]), dot(local, p[2])));
}

// The plane that a manifold keeps the moved shape above.
struct Floor {
    using F = Wide<float, 4>;
    Touch touch;
    Vec3 normal;
    Vec3T<F> points;  // on the surface of the fixed side, where it was when the manifold was made; the first again
                      // where there are fewer
    float height, overlap;  // along the normal; how deep the shape is below it

    Floor(const WorldData& world, const Touch& t) : touch(t) {
        const ContactRecord& r = world.records[t.record];
        normal = {r.normal[0], r.normal[1], r.normal[2]};
        static_assert(sizeof r.points == 16 * sizeof(float));
        constexpr int32_t rows[4] = {0, 1, 2, 3};
        F x[4];
        gather4<4>(r.points[0].position, rows, 4, 0, x);
        F s = load_wide<F>(world.found_separations[t.record].s);
        auto there = F{0.0f, 1.0f, 2.0f, 3.0f} < splat<F>(static_cast<float>(r.point_count));
        for (F* v : {&x[0], &x[1], &x[2], &s}) *v = select(there, *v, splat<F>((*v)[0]));
        points = {x[0], x[1], x[2]};
        points = splat<F>(t.origin) + points - (splat<F>(0.5f) * s) * splat<F>(normal);
        const F heights = dot(splat<F>(normal), points);
        height = heights[0], overlap = maximum(0.0f, -s[0]);
        for (int j = 1; j < 4; ++j) height = minimum(height, heights[j]), overlap = maximum(overlap, -s[j]);
    }
    // Whether it is above the piece of E, whose points are in it.
    bool covers(const WorldData& world, const Floor& e, float level, float radius) const {
        const float slack = level + 2.5f * overhang * radius;
        const F above = dot(splat<F>(normal), e.points) - splat<F>(height);
        if (mask_bits((above > splat<F>(slack)) | (above < splat<F>(-slack - overlap))) != 0) return false;
        if (dot(normal, e.normal) < -level_of_depth) return false;
        if (length_squared(cross(normal, e.normal)) < same_normal * same_normal) return false;
        return rise_of(world, e.touch, normal) - height <= level;
    }
};

void silence(ContactRecord& r) {
    for (ContactPointRecord& p : r.points) p.separation = far_separation;
    for (float& x : r.normal_impulse) x = 0.0f;
    for (float& x : r.friction_impulse) x = 0.0f;
    r.twist_impulse = 0.0f;
}

// What rises above a floor by less than this is part of it.
float level_for(const ColliderInfo& moved) {
    return minimum(level_of_radius * moved.radius, level_of_depth * moved.depth);
}

float rounding_of(const Touch& a, const Touch& b) {
    return rounding * max_component(absolute(a.origin) + absolute(b.origin));
}

// Whether E is nothing but the end of a piece of the floor F.
bool is_covered(const WorldData& world, const Floor& e, const Floor& f, const ColliderInfo& moved, float level) {
    return f.covers(world, e, level, moved.radius) && !e.covers(world, f, level, moved.radius);
}

// Writes this pair's records alone, and reads of others what is not written here.
void silence_pair(WorldData& world, uint32_t number) {
    const ColliderPair& p = world.pairs.pairs[number];
    if (!has_floor(p)) return;
    const uint32_t moved = moved_collider(p);
    auto stands = [&](const ColliderPair& q) {
        return world.bodies.info[world.colliders.info[fixed_collider(q)].body].type == BodyType::fixed;
    };
    uint32_t covered = 0;  // bit i: record i of the pair
    static_assert(max_mesh_manifolds <= 32);
    world.pairs.for_each_of(moved, [&](uint32_t other) {
        const ColliderPair& q = world.pairs.pairs[other];
        if (other == number || !has_floor(q) || moved_collider(q) != moved || !(stands(p) && stands(q))) return;
        for (uint32_t k = 0; k < q.count; ++k) {
            const Floor floor(world, touch_of(world, q, k));
            for (uint32_t i = 0; i < p.count; ++i) {
                if ((covered >> i & 1) != 0) continue;
                const ColliderInfo& info = world.colliders.info[moved];
                const Floor end(world, touch_of(world, p, i));
                const float level = level_for(info) + rounding_of(end.touch, floor.touch);
                if (is_covered(world, end, floor, info, level)) covered |= 1u << i;
            }
        }
    });
    if (covered == 0 && !p.covered) return;
    for (uint32_t i = 0; i < p.count; ++i) {
        ContactRecord& r = world.records[p.first_record + i];
        if ((covered >> i & 1) != 0 || (p.covered && (r.flags & contact_covered) != 0)) silence(r);
    }
}

}  // namespace

void mark_covered(WorldData& world, ColliderPair& p) {
    alignas(Floor) std::byte room[max_mesh_manifolds * sizeof(Floor)];
    auto* floors = reinterpret_cast<Floor*>(room);
    const bool several = has_floor(p) && p.count > 1;
    for (uint32_t i = 0; several && i < p.count; ++i) new (floors + i) Floor(world, touch_of(world, p, i));
    const ColliderInfo& moved = world.colliders.info[moved_collider(p)];
    const float level = several ? level_for(moved) + rounding_of(floors[0].touch, floors[0].touch) : 0.0f;
    p.covered = false;
    for (uint32_t i = 0; i < p.count; ++i) {
        bool covered = false;
        for (uint32_t k = 0; several && k < p.count && !covered; ++k)
            covered = k != i && is_covered(world, floors[i], floors[k], moved, level);
        uint32_t& flags = world.records[p.first_record + i].flags;
        flags = covered ? flags | contact_covered : flags & ~contact_covered;
        p.covered |= covered;
    }
}

void SeamList::clear() {
    for (uint32_t collider : floored_) first_[collider] = none;
    floored_.clear();
    pairs_.clear();
}

void SeamList::add(uint32_t number, const ColliderPair& p) {
    if (!has_floor(p)) return;
    const uint32_t moved = moved_collider(p);
    if (moved >= first_.size()) first_.resize(moved + 1, none);
    uint32_t& first = first_[moved];
    bool listed = true;
    if (first == none) {
        floored_.push_back(moved);
        listed = p.covered;
        first = listed ? several : number;
    } else if (first != several) {
        pairs_.push_back(first);
        first = several;
    }
    if (listed) pairs_.push_back(number);
}

void silence_seams(WorldData& world) {
    const Array<uint32_t>& pairs = world.seams.pairs();
    world.tasks.for_each(pairs.count(), pairs_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) silence_pair(world, pairs[static_cast<size_t>(i)]);
    });
}

}  // namespace lendulet
