// Which function collides which kinds of shapes.
#include "collision/narrow_phase.h"

#include "collision/pair.h"

namespace lendulet {
namespace {

bool is_ball(const Geometry& g) { return g.kind == GeometryKind::point; }
bool is_capsule(const Geometry& g) { return g.kind == GeometryKind::segment; }
bool is_box(const Geometry& g) { return g.kind == GeometryKind::box; }

// Pairs that are written for the other order: the functions take the flatter shape first.
bool wants_swap(const CollidePair& p) {
    if (!is_convex(*p.b)) return true;
    return (is_ball(*p.a) && (is_capsule(*p.b) || is_box(*p.b)));
}

int collide_in_order(const CollidePair& p, PairCache& cache, const CollideSettings& settings, Manifold* out,
                     int capacity, MeshCandidates* near) {
    const Geometry &a = *p.a, &b = *p.b;
    if (has_triangles(a)) return collide_mesh_convex(p, settings, near, out, capacity);
    if (a.kind == GeometryKind::plane) return collide_plane_convex(p, *out);
    if (is_sharp_box(a) && is_sharp_box(b)) return collide_box_box(p, cache, settings, *out);
    if (is_ball(b)) {
        if (is_ball(a)) return collide_sphere_sphere(p, *out);
        if (is_capsule(a)) return collide_capsule_sphere(p, *out);
        if (is_box(a)) return collide_box_sphere(p, *out);
    }
    if (is_capsule(a) && is_capsule(b)) return collide_capsule_capsule(p, *out);
    return collide_convex_convex(p, cache, settings, *out);
}

}  // namespace

bool is_sharp_box(const Geometry& g) { return is_box(g) && g.rounding == 0.0f; }

bool has_closed_form(const Geometry& a, const Geometry& b) {
    auto round = [](const Geometry& g) { return is_ball(g) || is_capsule(g); };
    auto with = [&](const Geometry& one, const Geometry& other) {
        return is_ball(one) ? round(other) || is_box(other) || other.kind == GeometryKind::plane
                            : is_capsule(one) && (is_capsule(other) || other.kind == GeometryKind::plane);
    };
    return with(a, b) || with(b, a);
}

int collide(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold* out, int capacity,
            MeshCandidates* near) {
    cache.clearance = pair.margin;
    if (capacity <= 0 || (!is_convex(*pair.a) && !is_convex(*pair.b))) return 0;
    if (!wants_swap(pair)) return collide_in_order(pair, cache, settings, out, capacity, near);
    int count = collide_in_order(swapped(pair), cache, settings, out, capacity, near);
    for (int i = 0; i < count; ++i) swap_back(pair, out[i]);
    return count;
}

bool overlap(const CollidePair& pair, PairCache& cache, const CollideSettings& settings) {
    if (!is_convex(*pair.a) && !is_convex(*pair.b)) return false;
    CollidePair touching = wants_swap(pair) ? swapped(pair) : pair;
    touching.margin = 0.0f;
    if (has_triangles(*touching.a)) return overlap_mesh_convex(touching, settings);
    Manifold manifold;
    return collide_in_order(touching, cache, settings, &manifold, 1, nullptr) > 0;
}

}  // namespace lendulet
