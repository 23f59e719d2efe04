// The face of a core that looks along a direction, as a polygon, a line or a point; input of clipping.
//
// Box and hull always give a polygon. On curved shapes the direction of a true contact is that of the surface's normal,
// so what touches can be read off it: along the axis the cap, at right angles to the side the side, else the rim. A
// little tolerance around those keeps two or more points while a resting body still rocks; the distances of the points
// along the contact normal sort out those that do not touch.
#include "geometry/geometry.h"
#include "geometry/hull.h"

namespace lendulet {

namespace {

// Sine of the angle to the side's normal up to which a side gives its two points (8.6 degrees).
constexpr float side_sine = segment_side_sine;
// Cosine of the angle to the axis from which a cap gives its polygon (14 degrees), beyond it the rim touches in a
// point.
constexpr float cap_cosine = 0.97f;
// Sine of the angle to the axis above which the polygon has the lowest point of the rim as well. Below it, a rim of
// radius 1 m that rolls over the corners rises and falls by less than 0.01 (1 - cos(pi/16)) = 0.2 mm.
constexpr float turning_sine = 0.01f;
// Sine of the angle about the axis within which that point is a corner.
constexpr float own_point = 0.02f;

constexpr int rim_points = 16;
// Cosines and sines of k pi / 8.
constexpr float c1 = 0.92387953f, c2 = 0.70710678f, c3 = 0.38268343f;
constexpr float rim_cosine[rim_points] = {1.0f,  c1,  c2,  c3,  0.0f, -c3, -c2, -c1,
                                          -1.0f, -c1, -c2, -c3, 0.0f, c3,  c2,  c1};
constexpr float rim_sine[rim_points] = {0.0f, c3, c2, c1, 1.0f, c1, c2, c3, 0.0f, -c3, -c2, -c1, -1.0f, -c1, -c2, -c3};

// Names of a cylinder's faces, and of the points of its rims: the fixed polygons' corners first, then the point of each
// rim that is nearest to the direction.
enum CylinderFace : uint16_t { bottom_cap, top_cap, cylinder_side, bottom_rim, top_rim };
constexpr uint16_t moving_point = 2 * rim_points;

void add(Face& face, Vec3 vertex, uint16_t id) {
    face.vertices[face.count] = vertex;
    face.ids[face.count++] = id;
}

void point_face(Face& face, Vec3 d, Vec3 vertex, uint16_t id) {
    face.normal = d;
    add(face, vertex, id);
}

void segment_face(Face& face, float half_height, Vec3 d) {
    face.normal = d;
    if (absolute(d.y) <= side_sine) {
        add(face, {0.0f, -half_height, 0.0f}, 0);
        add(face, {0.0f, half_height, 0.0f}, 1);
        face.id = 2;
    } else {
        uint16_t end = d.y > 0.0f ? 1 : 0;
        add(face, {0.0f, end ? half_height : -half_height, 0.0f}, end);
        face.id = end;
    }
}

void box_face(Face& face, Vec3 half, Vec3 d) {
    Vec3 size = absolute(d);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    bool positive = component(d, axis) >= 0.0f;
    static constexpr bool loop[4][2] = {{false, false}, {true, false}, {true, true}, {false, true}};
    for (int k = 0; k < 4; ++k) {
        // u, v and the axis are right-handed: (u, v) turns counter-clockwise about +axis, (v, u) about -axis.
        bool plus_u = loop[k][positive ? 0 : 1], plus_v = loop[k][positive ? 1 : 0];
        Vec3 corner;
        set_component(corner, axis, positive ? component(half, axis) : -component(half, axis));
        set_component(corner, u, plus_u ? component(half, u) : -component(half, u));
        set_component(corner, v, plus_v ? component(half, v) : -component(half, v));
        uint32_t id = (corner.x > 0.0f ? 1u : 0u) | (corner.y > 0.0f ? 2u : 0u) | (corner.z > 0.0f ? 4u : 0u);
        add(face, corner, static_cast<uint16_t>(id));
    }
    set_component(face.normal, axis, positive ? 1.0f : -1.0f);
    face.id = static_cast<uint16_t>(2 * axis + (positive ? 1 : 0));
}

// The direction across the y axis as a unit vector (x, z), +x where there is none, and the sine of the angle to the
// axis.
struct Azimuth {
    float x, z, sine;
};
Azimuth azimuth_of(Vec3 d) {
    float s = square_root(d.x * d.x + d.z * d.z);
    return s > 1e-12f ? Azimuth{d.x / s, d.z / s, s} : Azimuth{1.0f, 0.0f, 0.0f};
}

// The corners are fixed to the body, so that a disc that rocks keeps its contacts; the lowest point of the rim is one
// more between two of them, unless it is as good as on one.
void cap_face(Face& face, float radius, float y, Vec3 d, Azimuth a) {
    const bool top = y > 0.0f;
    const float around = top ? -1.0f : 1.0f;  // counter-clockwise about +y leads from x towards -z
    for (int k = 0; k < rim_points; ++k) {
        const float x = rim_cosine[k], z = around * rim_sine[k];
        add(face, {radius * x, y, radius * z}, static_cast<uint16_t>(k + (top ? rim_points : 0)));
        if (!(a.sine > turning_sine)) continue;
        const int next = (k + 1) % rim_points;
        const float from = around * (x * a.z - z * a.x), to = a.x * rim_sine[next] - around * a.z * rim_cosine[next];
        if (from > own_point && to > own_point)
            add(face, {radius * a.x, y, radius * a.z}, static_cast<uint16_t>(moving_point + top));
    }
    face.normal = {0.0f, d.y > 0.0f ? 1.0f : -1.0f, 0.0f};
    face.id = top ? top_cap : bottom_cap;
}

// size = {bottom radius, half height, top radius}. In the half plane of the direction the side runs from (bottom, -h)
// to (top, h); its outward normal is (2 h, bottom - top), normalised.
void tapered_cylinder_face(Face& face, Vec3 size, Vec3 d) {
    Azimuth a = azimuth_of(d);
    float height = 2.0f * size.y, taper = size.x - size.z;
    float norm = square_root(height * height + taper * taper);
    float along_side = (height * d.y - taper * a.sine) / norm, across_side = (height * a.sine + taper * d.y) / norm;
    bool on_side = absolute(along_side) <= side_sine && across_side > 0.0f;
    Vec3 bottom{size.x * a.x, -size.y, size.x * a.z}, top{size.z * a.x, size.y, size.z * a.z};
    float cap_radius = d.y > 0.0f ? size.z : size.x;
    bool on_cap = absolute(d.y) >= cap_cosine && cap_radius > 0.0f;
    if (on_cap && !(on_side && across_side > absolute(d.y))) {
        cap_face(face, cap_radius, d.y > 0.0f ? size.y : -size.y, d, a);
    } else if (on_side) {
        add(face, bottom, moving_point);
        add(face, top, moving_point + 1);
        face.normal = d;
        face.id = cylinder_side;
        if (size.x == size.z) face.extra_radius = size.x;
    } else {
        bool upper = along_side > 0.0f;
        point_face(face, d, upper ? top : bottom, static_cast<uint16_t>(moving_point + upper));
        face.id = upper ? top_rim : bottom_rim;
    }
}

// The tangent line of the two balls in the half plane of the direction touches both at the same normal, whose component
// along the axis is (bottom - top) / (2 h). Where one ball holds the other there is no such line.
void tapered_capsule_face(Face& face, Vec3 size, Vec3 d) {
    Azimuth a = azimuth_of(d);
    float sine = (size.x - size.z) / (2.0f * size.y);
    float cosine = square_root(maximum(1.0f - sine * sine, 0.0f));
    float along_side = cosine * d.y - sine * a.sine;
    Vec3 bottom{0.0f, -size.y, 0.0f}, top{0.0f, size.y, 0.0f};
    face.normal = d;
    if (absolute(sine) < 1.0f && absolute(along_side) <= side_sine) {
        Vec3 normal{cosine * a.x, sine, cosine * a.z};
        add(face, bottom + size.x * normal, 0);
        add(face, top + size.z * normal, 1);
        face.id = 2;
        return;
    }
    bool upper = absolute(sine) < 1.0f ? along_side > 0.0f : sine < 0.0f;
    float radius = upper ? size.z : size.x;
    add(face, (upper ? top : bottom) + radius * d, upper ? 1 : 0);
    face.id = upper ? 1 : 0;
    face.extra_radius = radius;
}

void hull_face(Face& face, const HullData& hull, Vec3 d) {
    uint32_t index = support_face(hull, d);
    const HullFace& polygon = hull.faces[index];
    face.normal = polygon.normal;
    face.id = static_cast<uint16_t>(index);
    for (uint32_t k = 0; k < polygon.outline_count; ++k) {
        uint32_t vertex = hull.outlines[polygon.outline + k];
        add(face, hull.vertices[vertex], static_cast<uint16_t>(vertex));
    }
    if (face.count > 0) return;
    for (uint32_t k = 0; k < polygon.edge_count; ++k) {
        uint32_t vertex = hull.edges[polygon.first_edge + k].origin;
        add(face, hull.vertices[vertex], static_cast<uint16_t>(vertex));
    }
}

// A triangle has a face on either side; seen from behind, its corners run the other way round.
void triangle_face(Face& face, const Vec3* p, Vec3 d) {
    Vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]), {0.0f, 1.0f, 0.0f});
    bool front = dot(normal, d) >= 0.0f;
    face.normal = front ? normal : -normal;
    face.id = front ? 0 : 1;
    add(face, p[0], 0);
    add(face, p[front ? 1 : 2], front ? 1 : 2);
    add(face, p[front ? 2 : 1], front ? 2 : 1);
}

}  // namespace

Face best_face(const Geometry& g, Vec3 direction) {
    Face face;
    Vec3 d = normalize(direction, {0.0f, 1.0f, 0.0f});
    switch (g.kind) {
        case GeometryKind::point:
            point_face(face, d, {}, 0);
            break;
        case GeometryKind::segment:
            segment_face(face, g.size.y, d);
            break;
        case GeometryKind::box:
            box_face(face, g.size, d);
            break;
        case GeometryKind::tapered_capsule:
            tapered_capsule_face(face, g.size, d);
            break;
        case GeometryKind::tapered_cylinder:
            tapered_cylinder_face(face, g.size, d);
            break;
        case GeometryKind::hull:
            hull_face(face, *g.hull, d);
            break;
        case GeometryKind::triangle:
            triangle_face(face, g.triangle, d);
            break;
        case GeometryKind::plane:
        case GeometryKind::mesh:
        case GeometryKind::height_field:
            break;
    }
    return face;
}

}  // namespace lendulet
