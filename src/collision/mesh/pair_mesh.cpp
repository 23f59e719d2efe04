// A mesh or height field and a convex shape, triangle by triangle. Triangles push towards the side on which the
// shape's centre is; one-sided ones to their front alone. Edges within a flat or hollow part of the surface must not be
// felt: a contact whose normal leans across such an edge belongs to the neighbour, or gets the normal of the face.
//
// Faces come first: clipping the shape's face by the triangle often proves that the triangle's normal is the direction
// of the shortest way out; only edges that can touch need GJK and EPA.
#include <cstddef>
#include <new>

#include "collision/mesh/candidates.h"
#include "collision/mesh/filter.h"
#include "collision/mesh/footing.h"
#include "collision/mesh/manifolds.h"
#include "collision/mesh/over_triangle.h"
#include "collision/pair.h"

namespace lendulet {
namespace {

// Cosine to the triangle's normal from which a contact is one of its face, 1.8 degrees.
constexpr float upright = 0.9995f;
// Sine of the angle by which a contact may lean across an edge that cannot touch and still be one of this triangle's
// face.
constexpr float lean_tolerance = 1e-3f;
constexpr float level = MeshQuery::level;
// Cosine from which the shape's own face is the reference for an edge of the mesh.
constexpr float flat = 0.998f;

constexpr int no_face = -1;
// Before closest points are sought otherwise; of the shape's size, the least distance at which they are, and how far
// what is proven may be off.
constexpr int most_steps = 3;
constexpr float least_between = 0.01f, proven_gap = 1e-6f;

struct MeshCollision : MeshQuery {
    using MeshQuery::MeshQuery;

    static constexpr int most_jobs = OverTriangleBatch::capacity;
    OverTriangleBatch batch;
    int face_of[most_jobs];  // the face that each triangle of the batch is looked at by; none: only its rim might touch

    // Faces of the shape: triangles of one plane share them, and so do those that one face of a box or hull looks at.
    int face_count = 0;
    int32_t face_number[most_jobs + 1];  // -1: of other shapes
    Vec3 facing{};                       // the normal of the plane that the last one looks at
    alignas(ShapeFace) std::byte faces[(most_jobs + 1) * sizeof(ShapeFace)];
    ShapeFace& face_at(int i) { return reinterpret_cast<ShapeFace*>(faces)[i]; }
    const ShapeFace& face_at(int i) const { return reinterpret_cast<const ShapeFace*>(faces)[i]; }

    Footing footing;
    // Triangles that the shape is beside: their edges are left until it is known what else it stands on.
    static constexpr int most_beside = MeshCandidates::capacity + OverTriangleBatch::capacity;
    int beside_count = 0;
    Footing::Beside beside[most_beside];
};

// By how much the box within which triangles are kept is wider than needed: of the shape's size and of the margin,
// which tells how far it may move in a step.
constexpr float leeway_of_size = 0.08f, leeway_of_margin = 2.0f, most_leeway = 0.5f;
// What is spent is a sum, which must not lose digits; of the shape's size.
constexpr float most_spent = 50.0f;
// Wider than rounding, where none are kept: whether a triangle is near is the filter's to say.
constexpr float least_leeway = 0.01f;

// visit(triangles, what the filter found of them) for those that may come within `limit` of the core, in the order of
// the mesh.
template <class Visit>
void for_each_near(const MeshQuery& q, float limit, MeshCandidates* kept, Visit&& visit) {
    MeshFilter filter(q, limit);
    auto look_through = [&](const uint32_t* triangles, int count) {
        filter.test(triangles, count);
        visit(triangles, filter);
    };
    const Vec3 lower = q.position + q.lower, upper = q.position + q.upper;
    constexpr int most = MeshFilter::capacity;
    uint32_t waiting[MeshCandidates::capacity];
    if (kept != nullptr) {
        const MeshCandidates::Placing now{q.position, q.turn, q.pair.margin, filter.reach()};
        const float slack = level * q.size;
        if (kept->count < 0) kept->stand(now);
        else kept->move(now, slack);
        if (!kept->hold(lower, upper) || kept->spent > most_spent * q.size) {
            const float leeway = leeway_of_size * q.size + leeway_of_margin * q.pair.margin;
            kept->find(q.surface, lower, upper, minimum(leeway, most_leeway * q.size));
        }
        if (kept->are_listed()) {
            uint8_t places[MeshCandidates::capacity];
            const int count = kept->near(waiting, places);
            for (int first = 0; first < count; first += most) {
                const int some = count - first < most ? count - first : most;
                look_through(waiting + first, some);
                for (int i = 0; i < some; ++i) kept->set_apart(places[first + i], filter.away(i));
            }
            return;
        }
    }
    int count = 0;
    const float leeway = least_leeway * q.size;
    const Vec3 wider{leeway, leeway, leeway};
    for_each_triangle(q.surface, lower - wider, upper + wider, [&](uint32_t index) {
        waiting[count++] = index;
        if (count < most) return;
        look_through(waiting, count);
        count = 0;
    });
    look_through(waiting, count);
}

void start(const MeshQuery& q, const Triangle& t, Vec3 normal, bool face, float radius, float follow,
           TriangleContact& out) {
    out.normal = out.front = normal;
    out.face = face;
    out.radius = radius;
    out.follow = follow;
    out.original = t.original;
    out.material = q.surface.material(t.original);
    out.count = 0;
}

void add_point(Vec3 position, float separation, uint32_t id, TriangleContact& out) {
    out.points[out.count++] = {position.x, position.y, position.z, separation, id};
}

// Whether a contact on these edges of the triangle leans across one that cannot touch.
bool leans_across(const Triangle& t, uint8_t edges, Vec3 normal) {
    for (int i = 0; i < 3; ++i) {
        bool closed = (edges & ~t.touching) >> i & 1;
        if (closed && dot(normal, normalize(out_across(t, i))) > lean_tolerance) return true;
    }
    return false;
}

// Whether a surface beyond these edges of the triangle is nearer to what is apart from it by the unit `normal` over
// `point`, which is on them.
bool is_nearer_across(const MeshQuery& q, const Triangle& t, uint8_t edges, Vec3 point, Vec3 normal) {
    for (int i = 0; i < 3; ++i) {
        if ((edges >> i & 1) == 0) continue;
        int32_t across = q.surface.neighbour(t.index, i);
        if (across < 0) continue;
        const Triangle n = q.triangle(static_cast<uint32_t>(across));
        if (n.from_behind != t.from_behind) continue;
        int shared = 0;
        while (shared < 2 && q.surface.neighbour(n.index, shared) != static_cast<int32_t>(t.index)) ++shared;
        Vec3 inwards = n.vertices[(shared + 2) % 3] - point;
        if (dot(normal, inwards) > lean_tolerance * length(inwards)) return true;
    }
    return false;
}

// --- balls

void sphere_triangle(const MeshQuery& q, const Triangle& t, TriangleContact& out) {
    float radius = q.shape.rounding;
    TrianglePoint nearest = nearest_on_triangle(t.vertices, {});
    Vec3 between = -nearest.point;
    float distance = nearest.edges == 0 ? dot(t.normal, between) : length(between);
    if (distance - radius > q.pair.margin) return;
    Vec3 normal = t.normal;
    bool face = nearest.edges == 0 || !(distance > 1e-6f * radius);
    if (!face) {
        normal = (1.0f / distance) * between;
        if (leans_across(t, nearest.edges, normal)) return;  // the neighbour is nearer
        if (is_nearer_across(q, t, nearest.edges, nearest.point, normal)) return;
        face = dot(normal, t.normal) > 1.0f - 0.5f * lean_tolerance * lean_tolerance;
        if (face) normal = t.normal;
    }
    float separation = distance - radius;
    start(q, t, normal, face, radius, face ? 1.0f : nearest.edges & (nearest.edges - 1) ? 0.0f : 0.5f, out);
    add_point(nearest.point + (0.5f * separation) * normal, separation, 0, out);
}

// Number i of what the filter left, of which it knows all places.
Triangle left_triangle(const MeshQuery& q, const uint32_t* triangles, const MeshFilter& found, int i) {
    Triangle t;
    for (int k = 0; k < 3; ++k) t.vertices[k] = found.corner(i, k);
    t.normal = found.normal(i);
    t.from_behind = found.is_behind(i);
    t.name(q.surface, triangles[found.number(i)]);
    return t;
}

// A ball that moves by less than this part of its size until the middle of a step touches what is below it.
constexpr float least_ahead = 1e-3f;

// Where a ball rolls over many triangles in a step, those that bend towards each other by little give one contact, and
// its normal is that of the triangle which the ball is over in the middle of the step: with the first one's it runs
// into those ahead, is pushed out of them for nothing, and swings higher and higher in a trough.
void collide_ball(const MeshQuery& q, const uint32_t* triangles, const MeshFilter& found, MeshManifolds& manifolds) {
    const bool one_sided = q.surface.one_sided();
    const Vec3 ahead = rotate_inverse(q.pair.rotation_a, q.pair.ahead);
    const bool moves = length_squared(ahead) > least_ahead * least_ahead * q.size * q.size;
    float least = 0.0f;
    uint64_t over[MeshFilter::capacity / 64 + 1] = {};
    for (int i = 0; i < found.live(); ++i) {
        if (one_sided && found.is_behind(i)) continue;
        TriangleContact contact;
        sphere_triangle(q, left_triangle(q, triangles, found, i), contact);
        if (contact.count == 0) continue;
        contact.single = moves;
        contact.nears = -dot(contact.normal, ahead);
        least = minimum(least, contact.points[0].separation);
        if (contact.face) over[i / 64] |= uint64_t{1} << (i % 64);
        manifolds.add(contact);
    }
    for (int i = 0; moves && i < found.live(); ++i) {
        if ((one_sided && found.is_behind(i)) || (over[i / 64] >> (i % 64) & 1) != 0) continue;
        const Triangle t = left_triangle(q, triangles, found, i);
        const float separation = -dot(t.normal, t.vertices[0]) - q.shape.rounding;
        if (separation > q.pair.margin || !(separation >= least)) continue;
        const TrianglePoint nearest = nearest_on_triangle(t.vertices, ahead);
        if (nearest.edges != 0) continue;
        TriangleContact contact;
        start(q, t, t.normal, true, q.shape.rounding, 1.0f, contact);
        add_point(-(q.shape.rounding + 0.5f * separation) * t.normal, separation, 0, contact);
        contact.single = true;
        contact.nears = -dot(contact.normal, ahead);
        manifolds.add(contact);
    }
}

// --- faces

// The face that looks at a plane, by its number where the filter knows it.
int look_at(MeshCollision& q, Vec3 normal, int32_t number) {
    int i = q.face_count - 1;
    if (number >= 0) {
        while (i >= 0 && q.face_number[i] != number) --i;
        if (i >= 0) return i;
    } else if (i >= 0 && q.facing == normal) {
        return i;
    }
    i = q.face_count++;
    q.facing = normal;
    q.face_number[i] = number;
    new (&q.face_at(i)) ShapeFace(q.shape, -normal);
    return i;
}

// A triangle of the batch.
struct FaceJob {
    Triangle t;
    const Face& face;
    Vec3 lowest;   // the core's point along the normal
    float height;  // of that over the triangle
    bool apart;    // the core is farther than the limit, though not from its plane
    uint8_t beyond;
};

// The part of the shape's face over the triangle, and its lowest point where that is over it and below the face.
void read_over(const MeshCollision& q, const FaceJob& job, int lane, FaceOverTriangle& out) {
    q.batch.read(lane, job.t, job.face, q.surface, out);
    float deepest = 3e38f;
    for (int i = 0; i < out.count; ++i) deepest = minimum(deepest, out.points[i].height);
    if (job.height < deepest - 10.0f * level * q.size && q.batch.lowest_over(lane)) {
        const uint32_t id = point_id(face_feature(0), face_feature(job.face.id));
        const Vec3 foot = job.lowest - job.height * job.t.normal;
        out.points[out.count++] = {foot.x, foot.y, foot.z, job.height, id};
    }
}

void face_contact(const MeshQuery& q, const FaceJob& job, const FaceOverTriangle& over, TriangleContact& out) {
    const Triangle& t = job.t;
    float radius = q.shape.rounding;
    start(q, t, t.normal, true, radius + job.face.extra_radius, 1.0f, out);
    const Vec3 front = q.surface.normal(t.index);
    out.front = t.from_behind ? -front : front;
    for (int i = 0; i < over.count && i < max_clipped_points; ++i) {
        const FaceOverTriangle::Point& p = over.points[i];
        add_point(p.foot() + (0.5f * (p.height - radius)) * t.normal, p.height - radius, p.id, out);
    }
}

// Whether the triangle's normal is certainly the direction of the shortest way out. Apart, it is where the lowest point
// of the core is over the triangle. Overlapping, take a segment from a lowest point p to the centre: leaving the
// triangle by the side over edge i takes at least the distance of that edge from the plane of the segment and the
// edge's direction, and the whole core needs at least as much as a segment in it.
bool is_shortest(const MeshQuery& q, const FaceJob& job, const FaceOverTriangle& over) {
    const Triangle& t = job.t;
    float lowest = job.height, limit = lowest + level * q.size;
    Vec3 p{};
    float count = 0.0f;
    for (int i = 0; i < over.count; ++i) {
        if (over.points[i].height > limit) continue;
        p += over.points[i].foot() + over.points[i].height * t.normal;
        count += 1.0f;
    }
    if (count == 0.0f) return false;
    if (lowest >= 0.0f) return true;
    p = (1.0f / count) * p;
    Vec3 along = q.heart - p;
    if (dot(t.normal, q.heart - t.vertices[0]) < -lowest) return false;
    for (int i = 0; i < 3; ++i) {
        Vec3 edge = t.vertices[(i + 1) % 3] - t.vertices[i];
        Vec3 side = normalize(cross(along, edge));
        if (absolute(dot(side, p - t.vertices[i])) < -lowest) return false;
    }
    return true;
}

// --- edges

uint8_t edges_at(const MeshQuery& q, const Triangle& t, Vec3 point) {
    uint8_t edges = 0;
    for (int i = 0; i < 3; ++i) {
        bool on = dot(point - t.vertices[i], normalize(out_across(t, i))) > -10.0f * level * q.size;
        edges = static_cast<uint8_t>(edges | on << i);
    }
    return edges;
}

// The core's point nearest to p, of lines and boxes; of others, that farthest along `towards`.
Vec3 nearest_in_core(const Geometry& g, Vec3 p, Vec3 towards) {
    if (g.kind == GeometryKind::segment) return {0.0f, clamp(p.y, -g.size.y, g.size.y), 0.0f};
    if (g.kind != GeometryKind::box) return support_core(g, towards);
    return {clamp(p.x, -g.size.x, g.size.x), clamp(p.y, -g.size.y, g.size.y), clamp(p.z, -g.size.z, g.size.z)};
}

// From one to the other and back (Cheney, Goldstein 1959): the nearest points of core and triangle, or that the two are
// farther apart than `limit`, where the core's farthest point against the direction between them proves it after few
// steps. Where they are very near the direction is not certain enough.
bool find_nearest(const MeshQuery& q, const Triangle& t, float limit, ConvexDistance& out) {
    Vec3 in_core = support_core(q.shape, -t.normal);
    for (int step = 0; step < most_steps; ++step) {
        const Vec3 point = nearest_on_triangle(t.vertices, in_core).point, between = in_core - point;
        const float d = length(between);
        if (!(d > least_between * q.size)) return false;
        const Vec3 normal = (1.0f / d) * between;
        const float gap = dot(normal, in_core - support_core(q.shape, -normal));
        if (gap <= proven_gap * q.size || d - gap > limit) {
            out = {d - maximum(gap, 0.0f), normal, point, in_core, 0, 0, true};
            return true;
        }
        in_core = nearest_in_core(q.shape, point, -normal);
    }
    return false;
}

ConvexDistance distance_to(const MeshQuery& q, const Triangle& t, float limit) {
    ConvexDistance found;
    if (find_nearest(q, t, limit, found)) return found;
    Geometry flat_core;
    flat_core.kind = GeometryKind::triangle;
    flat_core.triangle = t.vertices;
    GjkCache cold;
    return distance({&flat_core, &q.shape, {}}, cold, q.settings.simplex, limit);
}

// Behind a closed surface's side, whose neighbour across one of these edges the shape's centre is in front of: the
// neighbour pushes out, and pushing deeper in would be wrong.
bool neighbour_pushes(const MeshQuery& q, const Triangle& t, uint8_t edges) {
    for (int i = 0; i < 3; ++i) {
        int32_t neighbour = q.surface.neighbour(t.index, i);
        if (!((edges & t.bent) >> i & 1) || neighbour < 0) continue;
        const Vec3 front = q.to_contact * q.surface.normal(static_cast<uint32_t>(neighbour));
        float height = dot(front, q.heart - t.vertices[i]);
        if (t.from_behind ? height > 0.0f : height < 0.0f) return true;
    }
    return false;
}

// The triangle's points near the shape's own flat face; the normal is that face's.
bool on_shape_face(const MeshQuery& q, const Triangle& t, const Face& face, TriangleContact& out) {
    ClippedFace clipped;
    float radius = q.shape.rounding;
    clip_face(face, face_of(t, q.surface), true, q.pair.margin + radius, clipped);
    if (clipped.count == 0) return false;
    start(q, t, -clipped.normal, false, radius, 0.0f, out);
    for (int i = 0; i < clipped.count; ++i) {
        const FacePoint& p = clipped.points[i];
        add_point(clipped.point(p, 0.5f * (p.separation + radius)), p.separation - radius, p.id, out);
    }
    return true;
}

// A line of the shape, its face for this normal, along an edge of the triangle.
bool along_edge(const MeshQuery& q, const Triangle& t, const Face& line, uint8_t edges, Vec3 normal,
                TriangleContact& out) {
    for (int i = 0; i < 3; ++i) {
        PointPair ends[2];
        if (!(edges >> i & 1)) continue;
        if (!shared_stretch(t.vertices[i], t.vertices[(i + 1) % 3], line.vertices[0], line.vertices[1], ends)) continue;
        start(q, t, normal, false, q.shape.rounding + line.extra_radius, 0.0f, out);
        for (uint32_t k = 0; k < 2; ++k) {
            float separation = dot(ends[k].on_b - ends[k].on_a, normal) - q.shape.rounding;
            if (separation > q.pair.margin) continue;
            Vec3 position = 0.5f * (ends[k].on_a + ends[k].on_b - q.shape.rounding * normal);
            add_point(position, separation, point_id(edge_feature(t.original, k), vertex_feature(line.ids[k])), out);
        }
        return out.count > 0;
    }
    return false;
}

void edge_contact(const MeshQuery& q, const Triangle& t, const ConvexDistance& nearest, uint8_t edges,
                  TriangleContact& out) {
    Vec3 normal = nearest.normal;
    const Face face = best_face(q.shape, -normal);
    if (face.count >= 3 && dot(face.normal, normal) < -flat && on_shape_face(q, t, face, out)) return;
    if (face.count == 2 && along_edge(q, t, face, edges, normal, out)) return;
    float radius = q.shape.rounding;
    bool vertex = (edges & (edges - 1)) != 0;
    start(q, t, normal, false, radius + (face.count == 1 ? face.extra_radius : 0.0f), vertex ? 0.0f : 0.5f, out);
    Vec3 position = 0.5f * (nearest.point_a + nearest.point_b - radius * normal);
    add_point(position, nearest.distance - radius, point_id(edge_feature(t.original, edges), 0), out);
}

// Where the nearest points of core and triangle are on its edges or corners, what these give; true where that is all
// there is to it.
bool rim_contact(const MeshQuery& q, const Triangle& t, const ConvexDistance& nearest, TriangleContact& out) {
    float lean = dot(nearest.normal, t.normal);
    uint8_t edges = edges_at(q, t, nearest.point_a);
    if (lean >= upright || edges == 0) return false;
    bool overlapping = nearest.distance <= 0.0f;
    bool wrong_side = overlapping && lean < 0.0f;
    bool closed = leans_across(t, edges, nearest.normal);
    if (!wrong_side && !closed) {
        if (overlapping || !is_nearer_across(q, t, edges, nearest.point_a, nearest.normal))
            edge_contact(q, t, nearest, edges, out);
        return true;
    }
    return overlapping && closed && neighbour_pushes(q, t, edges);
}

// Whether only the rim of a triangle might touch the shape, which is beside it.
bool is_beside(const MeshQuery& q, uint32_t index, const MeshFilter& found, int i) {
    if (!found.has_lowest() || found.is_apart(i) || found.is_behind(i) || !found.is_beside(i)) return false;
    return (q.surface.convex_edges(index) & q.surface.sharp_edges(index)) == 0;
}

void leave_for_later(MeshCollision& q, const Footing::Beside& t) { q.beside[q.beside_count++] = t; }

// Where nothing of the shape's face lies over a triangle: whether that is all, or its rim is left for later.
bool bare_triangle(MeshCollision& q, const Footing::Beside& t, bool apart, float height) {
    const uint8_t convex = q.surface.convex_edges(t.index), concave = q.surface.concave_edges(t.index);
    const uint8_t touching = t.from_behind ? concave : convex;
    if (touching == 0 && (height >= 0.0f || !t.from_behind || (convex | concave) == 0)) return true;
    if (apart) return true;
    if ((touching & q.surface.sharp_edges(t.index)) != 0 || q.beside_count >= MeshCollision::most_beside) return false;
    leave_for_later(q, t);
    return true;
}

// What a triangle gives whose face is cut.
void convex_triangle(MeshCollision& q, const FaceJob& job, int lane, TriangleContact& out) {
    const Triangle& t = job.t;
    const float limit = q.batch.limit;
    FaceOverTriangle over;
    read_over(q, job, lane, over);
    // A face within a flat or hollow part can touch with its own normal only, and so can the part of one within a
    // gently rolling surface that the shape is over. Overlapping from behind, the way out may be across an edge.
    const bool gentle = (t.touching & t.sharp) == 0, over_face = over.count > 0;
    bool sure = (t.touching == 0 || (gentle && !job.apart && over_face)) &&
                (job.height >= 0.0f || !t.from_behind || t.bent == 0);
    if (sure || is_shortest(q, job, over)) return face_contact(q, job, over, out);
    if (job.apart) return;
    if (gentle && !over_face && q.beside_count < MeshCollision::most_beside)
        return leave_for_later(q, {t.index, job.beyond, t.from_behind});
    ConvexDistance nearest = distance_to(q, t, limit);
    if (nearest.distance > limit || rim_contact(q, t, nearest, out)) return;
    face_contact(q, job, over, out);
}

// Those of the batch, for which faces are chosen and cut.
void collide_batch(MeshCollision& q, const uint32_t* triangles, MeshFilter& found, int first,
                   MeshManifolds& manifolds) {
    OverTriangleBatch& batch = q.batch;
    batch.begin(found.batch(), first);
    const bool one_sided = q.surface.one_sided();
    bool may_be_later = q.beside_count + batch.count <= MeshCollision::most_beside;
    for (int k = 0; k < batch.count; ++k) {
        const int i = first + k;
        q.face_of[k] = no_face;
        if (one_sided && found.is_behind(i)) continue;
        if (may_be_later && is_beside(q, triangles[found.number(i)], found, i)) continue;
        const Vec3 normal = found.normal(i);
        if (!found.has_lowest()) found.set_lowest(i, support_core(q.shape, -normal));
        q.face_of[k] = look_at(q, normal, found.face(i));
        batch.set_face(k, q.face_at(q.face_of[k]));
    }
    q.settings.clip(batch);
    for (int k = 0; k < batch.count; ++k) {
        const int i = first + k;
        if (q.face_of[k] == no_face) {
            if (one_sided && found.is_behind(i)) continue;
            const uint32_t index = triangles[found.number(i)];
            q.footing.note(index, false, found.edges_beyond(i));
            if (q.surface.convex_edges(index) != 0) leave_for_later(q, {index, found.edges_beyond(i), false});
            continue;
        }
        const float height = batch.lowest_height[k];
        if (height > batch.limit) continue;
        const uint32_t index = triangles[found.number(i)];
        const uint8_t beyond = found.has_lowest() ? found.edges_beyond(i) : batch.beyond(k);
        q.footing.note(index, found.is_behind(i), found.is_apart(i) ? uint8_t{0} : beyond);
        if (batch.is_bare(k) && bare_triangle(q, {index, beyond, found.is_behind(i)}, found.is_apart(i), height))
            continue;
        const FaceJob job{left_triangle(q, triangles, found, i),
                          q.face_at(q.face_of[k]).face,
                          found.lowest(i),
                          height,
                          found.is_apart(i),
                          beyond};
        TriangleContact contact;
        convex_triangle(q, job, k, contact);
        manifolds.add(contact);
    }
}

void collide_faces(MeshCollision& q, const uint32_t* triangles, MeshFilter& found, MeshManifolds& manifolds) {
    const bool one_sided = q.surface.one_sided();
    for (int i = 0; i < found.far(); ++i) {
        const bool behind = found.is_far_behind(i);
        if (!one_sided || !behind) q.footing.note(triangles[found.far_number(i)], behind, 0);
    }
    for (int first = 0; first < found.live(); first += OverTriangleBatch::capacity) {
        q.face_count = 0;
        collide_batch(q, triangles, found, first, manifolds);
    }
}

// What the shape is beside, once all that it is over is known.
void beside_triangle(MeshCollision& q, int i, TriangleContact& out) {
    if (!q.footing.may_touch_rim(q, q.beside[i])) return;
    const Triangle t = q.triangle(q.beside[i].index);
    float limit = q.pair.margin + q.shape.rounding;
    ConvexDistance nearest = distance_to(q, t, limit);
    if (nearest.distance <= limit) rim_contact(q, t, nearest, out);
}

}  // namespace

int collide_mesh_convex(const CollidePair& pair, const CollideSettings& settings, MeshCandidates* kept, Manifold* out,
                        int capacity) {
    MeshCollision q(pair, settings);
    q.batch.limit = pair.margin + q.shape.rounding, q.batch.level = level * q.size;
    MeshManifolds manifolds(10.0f * level * q.size);
    for_each_near(q, q.batch.limit, kept, [&](const uint32_t* triangles, MeshFilter& found) {
        if (pair.b->kind == GeometryKind::point) collide_ball(q, triangles, found, manifolds);
        else collide_faces(q, triangles, found, manifolds);
    });
    for (int i = 0; i < q.beside_count; ++i) {
        TriangleContact contact;
        beside_triangle(q, i, contact);
        manifolds.add(contact);
    }
    return manifolds.write({pair.rotation_a, q.contact_rotation(), pair.offset}, out,
                           capacity < max_mesh_manifolds ? capacity : max_mesh_manifolds);
}

bool overlap_mesh_convex(const CollidePair& pair, const CollideSettings& settings) {
    const MeshQuery q(pair, settings);
    bool touching = false;
    for_each_near(q, q.shape.rounding, nullptr, [&](const uint32_t* triangles, const MeshFilter& found) {
        for (int i = 0; i < found.live() && !touching; ++i) {
            if (found.is_apart(i)) continue;
            const Triangle t = left_triangle(q, triangles, found, i);
            const float radius = q.shape.rounding;
            touching = pair.b->kind == GeometryKind::point ? length(nearest_on_triangle(t.vertices, {}).point) <= radius
                                                           : distance_to(q, t, radius).distance <= radius;
        }
    });
    return touching;
}

}  // namespace lendulet
