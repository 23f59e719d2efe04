// Closed forms for pairs of balls, capsules and boxes with balls: nearest points of cores, then the radii.
#include "collision/clip.h"
#include "collision/pair.h"

namespace lendulet {
namespace {

// Core points closer than this part of the radii have no direction between them that means anything.
constexpr float coincident = 1e-6f;

// Half axis of a capsule in world axes.
Vec3 half_axis(const Geometry& g, Quat rotation) { return rotate(rotation, {0.0f, g.size.y, 0.0f}); }

int between_cores(const CollidePair& pair, Vec3 core_a, Vec3 core_b, Vec3 fallback, float follow, Manifold& out) {
    float ra = pair.a->rounding, rb = pair.b->rounding;
    Vec3 between = core_b - core_a;
    float distance = length(between);
    if (distance - ra - rb > pair.margin) return 0;
    bool apart = distance > coincident * (ra + rb);
    return ball_manifold(core_a, apart ? (1.0f / distance) * between : fallback, distance, ra, rb, follow, out);
}

// Parameters in [-1, 1] of the nearest points of two segments through the origin and `offset` with half axes a and b.
// (Lumelsky 1985; where they are parallel, any pair of nearest points.)
struct SegmentParameters {
    float s, t;
};
SegmentParameters nearest_of_segments(Vec3 a, Vec3 b, Vec3 offset) {
    float aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ao = dot(a, offset), bo = dot(b, offset);
    float determinant = aa * bb - ab * ab;
    float s = determinant > 1e-6f * aa * bb ? clamp((ao * bb - ab * bo) / determinant, -1.0f, 1.0f) : 0.0f;
    float t = bb > 0.0f ? (s * ab - bo) / bb : 0.0f;
    float t_in = clamp(t, -1.0f, 1.0f);
    if (t != t_in && aa > 0.0f) s = clamp((t_in * ab + ao) / aa, -1.0f, 1.0f);
    return {s, t_in};
}

// Two points where the segments lie along each other.
int along_each_other(const CollidePair& pair, Vec3 a, Vec3 b, Vec3 normal, Manifold& out) {
    PointPair ends[2];
    int count = shared_stretch(-a, a, pair.offset - b, pair.offset + b, ends);
    float ra = pair.a->rounding, rb = pair.b->rounding;
    out = {};
    out.normal = normal;
    for (int i = 0; i < count; ++i) {
        float separation = dot(ends[i].on_b - ends[i].on_a, normal) - ra - rb;
        if (separation > pair.margin) continue;
        Vec3 position = 0.5f * (ends[i].on_a + ends[i].on_b) + (0.5f * (ra - rb)) * normal;
        out.points[out.count++] = {position, separation, static_cast<uint32_t>(i)};
    }
    out.radius_a = ra;
    out.radius_b = rb;
    out.follow = follow_of_balls(ra, rb);
    return out.count > 0 ? 1 : 0;
}

// The nearest face of a box to a point inside it; ties go to the first axis, then to the positive side.
struct NearestFace {
    Vec3 normal;
    float depth;
};
NearestFace nearest_face(Vec3 half, Vec3 p) {
    Vec3 depth = half - absolute(p);
    if (depth.x <= depth.y && depth.x <= depth.z) return {{p.x < 0.0f ? -1.0f : 1.0f, 0.0f, 0.0f}, depth.x};
    if (depth.y <= depth.z) return {{0.0f, p.y < 0.0f ? -1.0f : 1.0f, 0.0f}, depth.y};
    return {{0.0f, 0.0f, p.z < 0.0f ? -1.0f : 1.0f}, depth.z};
}

}  // namespace

int collide_sphere_sphere(const CollidePair& pair, Manifold& out) {
    return between_cores(pair, {}, pair.offset, undecided_normal, follow_of_balls(pair.a->rounding, pair.b->rounding),
                         out);
}

int collide_capsule_sphere(const CollidePair& pair, Manifold& out) {
    Vec3 a = half_axis(*pair.a, pair.rotation_a);
    float s = clamp(dot(a, pair.offset) / dot(a, a), -1.0f, 1.0f);
    return between_cores(pair, s * a, pair.offset, perpendicular(normalize(a)),
                         follow_of_balls(pair.a->rounding, pair.b->rounding), out);
}

int collide_capsule_capsule(const CollidePair& pair, Manifold& out) {
    Vec3 a = half_axis(*pair.a, pair.rotation_a), b = half_axis(*pair.b, pair.rotation_b);
    SegmentParameters nearest = nearest_of_segments(a, b, pair.offset);
    Vec3 on_a = nearest.s * a, on_b = pair.offset + nearest.t * b;
    // Where the axes meet, out along their common perpendicular on the side of B's centre.
    Vec3 across = cross(a, b);
    bool parallel = dot(across, across) <= 0.01f * dot(a, a) * dot(b, b);  // within 6 degrees
    Vec3 fallback = parallel ? perpendicular(normalize(a)) : normalize(across);
    if (dot(fallback, pair.offset) < 0.0f) fallback = -fallback;
    bool crossing = !parallel && absolute(nearest.s) < 1.0f && absolute(nearest.t) < 1.0f;
    float follow = crossing ? 0.5f : follow_of_balls(pair.a->rounding, pair.b->rounding);
    Manifold one;
    if (between_cores(pair, on_a, on_b, fallback, follow, one) == 0) return 0;
    // Seen along A the stretch exists only where the normal is nearly perpendicular to the axes.
    Vec3 axis = normalize(a);
    if (parallel && absolute(dot(one.normal, axis)) < 0.1f && along_each_other(pair, a, b, one.normal, out)) return 1;
    out = one;
    return 1;
}

int collide_box_sphere(const CollidePair& pair, Manifold& out) {
    Vec3 half = pair.a->size;
    Vec3 centre = rotate_inverse(pair.rotation_a, pair.offset);
    Vec3 core = maximum(-half, minimum(half, centre));
    Vec3 between = centre - core;
    float distance = length(between);
    float ra = pair.a->rounding, rb = pair.b->rounding;
    if (distance - ra - rb > pair.margin) return 0;
    if (distance > coincident * rb) {
        int axes_outside = (between.x != 0.0f) + (between.y != 0.0f) + (between.z != 0.0f);
        float on_edge = ra > 0.0f ? follow_of_balls(ra, rb) : axes_outside == 2 ? 0.5f : 0.0f;
        Vec3 normal = rotate(pair.rotation_a, (1.0f / distance) * between);
        return ball_manifold(rotate(pair.rotation_a, core), normal, distance, ra, rb,
                             axes_outside == 1 ? 1.0f : on_edge, out);
    }
    NearestFace face = nearest_face(half, centre);
    Vec3 on_face = rotate(pair.rotation_a, centre + face.depth * face.normal);
    return ball_manifold(on_face, rotate(pair.rotation_a, face.normal), -face.depth, ra, rb, 1.0f, out);
}

}  // namespace lendulet
