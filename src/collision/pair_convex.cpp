// Any two convex shapes: nearest points or depth of the cores by GJK and EPA, then as many points as the faces that
// look at each other share. (thesis 4.3.1)
#include "collision/clip.h"
#include "collision/pair.h"

namespace lendulet {
namespace {

// Cosine of the angle to the normal within which a face counts as touching flat, about 3.5 degrees. The normal of the
// nearest points of two faces is that of a face but for round-off, which grows as the gap closes.
constexpr float flat = 0.998f;
// A face becomes the reference only where it is better by this (in cosine) than the one that would be kept.
constexpr float reference_hysteresis = 5e-4f;
// The nearest point joins the clipped ones where it is deeper by this part of the faces' size: it lies on the rim of a
// round face, between the points by which that is given.
constexpr float deeper = 1e-3f;
// Values of PairCache::feature: the reference face of the last step. Above the axes of boxes.
constexpr uint32_t reference_a = 101, reference_b = 102;

// What the steps below share, in the frame of A.
struct Contact {
    const CollidePair* pair;
    Transform b_in_a;
    ConvexDistance nearest;
    float sweep;  // sum of the radii around the cores
    Face a, b;
};

float flatness(const Face& face, Vec3 normal) { return face.count >= 3 ? dot(face.normal, normal) : -1.0f; }

Vec3 to_world(const Contact& c, Vec3 v) { return rotate(c.pair->rotation_a, v); }

// Half way between the surfaces over core points of A and B.
Vec3 half_way(const Contact& c, Vec3 core_a, Vec3 core_b, Vec3 normal) {
    return 0.5f * (core_a + core_b) + (0.5f * (c.pair->a->rounding - c.pair->b->rounding)) * normal;
}

bool is_ball(const Face& face) { return face.count < 2; }

// The nearest points alone.
int point_manifold(const Contact& c, float follow, Manifold& out) {
    Vec3 normal = c.nearest.normal;
    out.normal = to_world(c, normal);
    out.count = 1;
    Vec3 position = half_way(c, c.nearest.point_a, c.nearest.point_b, normal);
    out.points[0] = {to_world(c, position), c.nearest.distance - c.sweep, 0};
    out.radius_a = c.pair->a->rounding + (is_ball(c.a) ? c.a.extra_radius : 0.0f);
    out.radius_b = c.pair->b->rounding + (is_ball(c.b) ? c.b.extra_radius : 0.0f);
    out.follow = follow;
    return 1;
}

float follow_of_points(const Contact& c) {
    float ra = c.pair->a->rounding + c.a.extra_radius, rb = c.pair->b->rounding + c.b.extra_radius;
    bool ball = is_ball(c.a) || is_ball(c.b);
    return ball && ra + rb > 0.0f ? follow_of_balls(ra, rb) : 0.5f;
}

// Two lines along each other: a capsule on a lying cylinder.
int line_manifold(const Contact& c, Manifold& out) {
    PointPair ends[2];
    int count = shared_stretch(c.a.vertices[0], c.a.vertices[1], c.b.vertices[0], c.b.vertices[1], ends);
    Vec3 normal = c.nearest.normal;
    out.normal = to_world(c, normal);
    for (int i = 0; i < count; ++i) {
        float separation = dot(ends[i].on_b - ends[i].on_a, normal) - c.sweep;
        if (separation > c.pair->margin) continue;
        Vec3 position = half_way(c, ends[i].on_a, ends[i].on_b, normal);
        out.points[out.count++] = {to_world(c, position), separation, 1u + static_cast<uint32_t>(i)};
    }
    out.radius_a = c.pair->a->rounding + c.a.extra_radius;
    out.radius_b = c.pair->b->rounding + c.b.extra_radius;
    out.follow = out.radius_a + out.radius_b > 0.0f ? follow_of_balls(out.radius_a, out.radius_b) : 0.5f;
    return out.count > 0 ? 1 : 0;
}

// The face of one shape over the reference face of the other. The normal is the reference face's own.
int face_manifold(const Contact& c, bool from_b, Manifold& out) {
    const Face &reference = from_b ? c.b : c.a, &incident = from_b ? c.a : c.b;
    const Geometry &below = from_b ? *c.pair->b : *c.pair->a, &above = from_b ? *c.pair->a : *c.pair->b;
    ClippedFace clipped;
    clip_face(reference, incident, from_b, c.pair->margin + c.sweep, clipped);
    if (clipped.count == 0) return 0;
    float deepest = clipped.points[0].separation;
    for (int i = 1; i < clipped.count; ++i) deepest = minimum(deepest, clipped.points[i].separation);
    Vec3 tip = (from_b ? c.nearest.point_a : c.nearest.point_b) - clipped.origin;
    float tip_height = dot(tip, clipped.normal);
    if (tip_height < deepest - deeper * clipped.size) {
        uint32_t id = point_id(face_feature(reference.id), face_feature(incident.id));
        clipped.points[clipped.count++] = {dot(tip, clipped.u), dot(tip, clipped.v), tip_height, id};
    }
    out.count = reduce_points(clipped.points, clipped.count, c.pair->carried);
    out.normal = to_world(c, from_b ? -clipped.normal : clipped.normal);
    for (int i = 0; i < out.count; ++i) {
        const FacePoint& p = clipped.points[i];
        // Half way between the surfaces, which lie the radii inwards of the two cores' points.
        Vec3 position = clipped.point(p, 0.5f * (p.separation + below.rounding - above.rounding));
        out.points[i] = {to_world(c, position), p.separation - c.sweep, p.id};
    }
    out.radius_a = c.pair->a->rounding + (from_b ? c.a.extra_radius : 0.0f);
    out.radius_b = c.pair->b->rounding + (from_b ? 0.0f : c.b.extra_radius);
    out.follow = from_b ? 0.0f : 1.0f;
    return 1;
}

}  // namespace

int collide_convex_convex(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold& out) {
    const Transform b_in_a{rotate_inverse(pair.rotation_a, pair.offset), conjugate(pair.rotation_a) * pair.rotation_b};
    const float sweep = pair.a->rounding + pair.b->rounding;
    const ConvexDistance nearest =
        distance({pair.a, pair.b, b_in_a}, cache.gjk, settings.simplex, 2.0f * pair.margin + sweep);
    if (!(nearest.distance - sweep <= pair.margin)) {
        cache.clearance = nearest.distance - sweep;
        return 0;
    }
    const Vec3 normal = nearest.normal;
    // The faces are made in their places: they are too large to be copied.
    Contact c{&pair,
              b_in_a,
              nearest,
              sweep,
              best_face(*pair.a, normal),
              best_face(*pair.b, rotate_inverse(b_in_a.rotation, -normal))};
    transform_face(c.b_in_a, c.b);
    float flat_a = flatness(c.a, normal), flat_b = flatness(c.b, -normal);
    bool from_b = flat_b > flat_a + (cache.feature == reference_b ? -reference_hysteresis : reference_hysteresis);
    out = {};
    if (maximum(flat_a, flat_b) >= flat) {
        cache.feature = from_b ? reference_b : reference_a;
        if (is_ball(from_b ? c.a : c.b)) return point_manifold(c, from_b ? 0.0f : 1.0f, out);
        if (face_manifold(c, from_b, out)) return 1;
    } else {
        cache.feature = 0;
        if (c.a.count == 2 && c.b.count == 2 && line_manifold(c, out)) return 1;
    }
    out = {};
    return point_manifold(c, follow_of_points(c), out);
}

}  // namespace lendulet
