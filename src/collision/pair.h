// The functions behind collide(): one for each family of pairs. Each writes at most one manifold and returns how many.
// They take the pair in the order of their name; collide() swaps arguments and result where the caller's order differs.
#pragma once

#include <cstdint>

#include "collision/narrow_phase.h"

namespace lendulet {

// Closed forms for balls and swept segments (kinds point and segment).
int collide_sphere_sphere(const CollidePair& pair, Manifold& out);
int collide_capsule_sphere(const CollidePair& pair, Manifold& out);
int collide_capsule_capsule(const CollidePair& pair, Manifold& out);
// A box, rounded or not, and a ball.
int collide_box_sphere(const CollidePair& pair, Manifold& out);
// Two sharp boxes by separating axes.
int collide_box_box(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold& out);
// A plane and any convex shape.
int collide_plane_convex(const CollidePair& pair, Manifold& out);
// Any two convex shapes by GJK and EPA.
int collide_convex_convex(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold& out);
// A mesh or height field and any convex shape; the only function with room for more than one manifold.
// `kept` may be null.
int collide_mesh_convex(const CollidePair& pair, const CollideSettings& settings, MeshCandidates* kept, Manifold* out,
                        int capacity);
bool overlap_mesh_convex(const CollidePair& pair, const CollideSettings& settings);

inline bool is_convex(const Geometry& g) { return g.kind != GeometryKind::plane && !has_triangles(g); }

// The same pair seen from B.
inline CollidePair swapped(const CollidePair& p) {
    return {p.b, p.a, p.rotation_b, p.rotation_a, -p.offset, p.margin, p.carried, -p.ahead};
}
// Turns a manifold of swapped(pair) into one of `pair`.
inline void swap_back(const CollidePair& pair, Manifold& m) {
    m.normal = -m.normal;
    for (int i = 0; i < m.count; ++i) m.points[i].position += pair.offset;
    float radius_a = m.radius_a;
    m.radius_a = m.radius_b;
    m.radius_b = radius_a;
    m.follow = 1.0f - m.follow;
}

// A manifold of one point between two balls of the given radii about core points that are `distance` apart along the
// unit `normal`; `core_a` is relative to A's position.
inline int ball_manifold(Vec3 core_a, Vec3 normal, float distance, float radius_a, float radius_b, float follow,
                         Manifold& out) {
    float separation = distance - radius_a - radius_b;
    out = {};
    out.normal = normal;
    out.count = 1;
    out.points[0] = {core_a + (radius_a + 0.5f * separation) * normal, separation, 0};
    out.radius_a = radius_a;
    out.radius_b = radius_b;
    out.follow = follow;
    return 1;
}

// Two balls roll on each other: with A still, the point between them moves by radius_a / (radius_a + radius_b) of what
// B's centre does.
inline float follow_of_balls(float radius_a, float radius_b) { return radius_a / (radius_a + radius_b); }

// The direction used where two cores coincide and none is better than another.
inline constexpr Vec3 undecided_normal{0.0f, 1.0f, 0.0f};

}  // namespace lendulet
