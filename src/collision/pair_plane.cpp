// A plane and any convex shape: the points of the face that looks at the plane, and the lowest point.
#include "collision/clip.h"
#include "collision/pair.h"

namespace lendulet {
namespace {

// The lowest point of a round shape may lie between the points by which its face is given; it joins them where it is
// deeper by more than this part of the face's size.
constexpr float deeper = 1e-3f;

// Corners of a box's face that looks along `direction`.
Face box_face(Vec3 half, Vec3 direction) {
    Face face;
    Vec3 d = absolute(direction);
    int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    float along = component(direction, axis) < 0.0f ? -1.0f : 1.0f;
    constexpr float sign_1[4] = {1.0f, -1.0f, -1.0f, 1.0f}, sign_2[4] = {1.0f, 1.0f, -1.0f, -1.0f};
    for (int i = 0; i < 4; ++i) {
        float s[3];
        s[axis] = along, s[(axis + 1) % 3] = sign_1[i], s[(axis + 2) % 3] = sign_2[i];
        face.vertices[i] = {s[0] * half.x, s[1] * half.y, s[2] * half.z};
        face.ids[i] = static_cast<uint16_t>((s[0] > 0.0f) | (s[1] > 0.0f) << 1 | (s[2] > 0.0f) << 2);
    }
    face.count = 4;
    return face;
}

Face lowest_face(const Geometry& g, Vec3 down) {
    if (g.kind == GeometryKind::box) return box_face(g.size, down);
    if (g.kind != GeometryKind::segment) return best_face(g, down);
    Face face;
    face.count = 2;
    face.vertices[0] = {0.0f, -g.size.y, 0.0f}, face.vertices[1] = {0.0f, g.size.y, 0.0f};
    face.ids[0] = 0, face.ids[1] = 1;
    return face;
}

bool has_flat_faces(GeometryKind kind) { return kind == GeometryKind::box || kind == GeometryKind::segment; }

}  // namespace

int collide_plane_convex(const CollidePair& pair, Manifold& out) {
    const Geometry& shape = *pair.b;
    Vec3 normal = rotate(pair.rotation_a, pair.a->size);
    float height = dot(normal, pair.offset) - pair.a->offset;  // of B's origin over the plane
    if (shape.kind == GeometryKind::point) {
        if (height - shape.rounding > pair.margin) return 0;
        return ball_manifold(pair.offset - height * normal, normal, height, 0.0f, shape.rounding, 1.0f, out);
    }
    Vec3 down = rotate_inverse(pair.rotation_b, -normal);
    Face face = lowest_face(shape, down);
    Vec3 u = perpendicular(normal), v = cross(normal, u);
    FacePoint points[max_face_vertices + 1];
    int count = 0;
    float deepest = 3e38f, size = 0.0f;
    auto add = [&](Vec3 local, uint32_t id) {
        Vec3 p = rotate(pair.rotation_b, local);
        points[count++] = {dot(p, u), dot(p, v), height - dot(down, local) - shape.rounding, id};
    };
    for (int i = 0; i < face.count; ++i) {
        add(face.vertices[i], point_id(face_feature(0), vertex_feature(face.ids[i])));
        deepest = minimum(deepest, points[i].separation);
        size = maximum(size, max_component(absolute(face.vertices[i] - face.vertices[0])));
    }
    if (!has_flat_faces(shape.kind)) {
        add(support_core(shape, down), point_id(face_feature(0), face_feature(0)));
        if (!(points[count - 1].separation < deepest - deeper * size)) --count;
    }
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        if (points[i].separation <= pair.margin) points[kept++] = points[i];
    }
    if (kept == 0) return 0;
    out = {};
    out.normal = normal;
    out.count = reduce_points(points, kept, pair.carried);
    Vec3 foot = pair.offset - height * normal;
    for (int i = 0; i < out.count; ++i) {
        const FacePoint& p = points[i];
        out.points[i] = {foot + p.u * u + p.v * v + (0.5f * p.separation) * normal, p.separation, p.id};
    }
    out.radius_b = shape.rounding + face.extra_radius;
    out.follow = 1.0f;
    return 1;
}

}  // namespace lendulet
