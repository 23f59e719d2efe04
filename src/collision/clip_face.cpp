// Faces for contacts and their clipping (Sutherland, Hodgman 1974) in the plane of the reference face. Every corner of
// the result keeps the names of the two features that meet there.
#include "collision/clip.h"
#include "collision/trace.h"

namespace lendulet {
namespace {

// Points this part of the smaller face's size outside the reference face still count as over it, so that round-off does
// not make the corners of faces of equal size come and go.
constexpr float overhang = 2e-4f;

// A corner while clipping. `edge` is the line that leads on to the next corner: an incident edge by the index of its
// first corner, or first_side + the index of a side of the reference face.
constexpr int first_side = max_face_vertices;
struct Corner {
    float u, v, w;
    int edge;
    uint32_t incident, reference;  // features
};

// A side of the reference face: distance(p) = m . p - offset is positive inside.
struct Side {
    float mu, mv, offset;
    float distance(const Corner& c) const { return mu * c.u + mv * c.v - offset; }
};

int next_of(int i, int count) { return i + 1 < count ? i + 1 : 0; }

uint32_t edge_of(const Face& face, int i) { return edge_feature(face.ids[i], face.ids[next_of(i, face.count)]); }

// The corner where the line `edge` of the polygon meets a side.
Corner crossing(const Corner& from, const Corner& to, float t, int side, const Face& reference, const Face& incident) {
    Corner c{from.u + t * (to.u - from.u), from.v + t * (to.v - from.v), from.w + t * (to.w - from.w), from.edge, 0, 0};
    if (from.edge < first_side) {
        c.incident = edge_of(incident, from.edge);
        c.reference = edge_of(reference, side);
    } else {  // two sides of the reference face: its corner between them
        int other = from.edge - first_side;
        int corner = next_of(other, reference.count) == side ? side : other;
        c.incident = face_feature(incident.id);
        c.reference = vertex_feature(reference.ids[corner]);
    }
    return c;
}

// Distances of the corners from a side; the least of them.
float distances_from(const Side& side, const Corner* in, int count, float* out) {
    float least = out[0] = side.distance(in[0]);
    for (int i = 1; i < count; ++i) {
        out[i] = side.distance(in[i]);
        least = minimum(out[i], least);
    }
    return least;
}

// `distance`: of the corners from the side.
int clip_by_side(const Corner* in, int count, const float* distance, int index, const Face& reference,
                 const Face& incident, Corner* out) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        const int k = next_of(i, count);
        const float d = distance[i], d_next = distance[k];
        bool inside = d >= 0.0f, inside_next = d_next >= 0.0f;
        // A convex polygon gains one corner a side at most; round-off in slivers must not overrun the buffer.
        if (inside && kept < max_clipped_points) out[kept++] = in[i];
        if (inside != inside_next && kept < max_clipped_points) {
            Corner c = crossing(in[i], in[k], d / (d - d_next), index, reference, incident);
            if (inside) c.edge = first_side + index;
            out[kept++] = c;
        }
    }
    return kept;
}

// An open segment: the stretch inside all sides.
int clip_segment(const Corner* in, const Side* sides, const Face& reference, const Face& incident, Corner* out) {
    float t0 = 0.0f, t1 = 1.0f;
    int side0 = -1, side1 = -1;
    for (int i = 0; i < reference.count; ++i) {
        float d0 = sides[i].distance(in[0]), d1 = sides[i].distance(in[1]);
        if (d0 < 0.0f && d1 < 0.0f) return 0;
        if ((d0 < 0.0f) == (d1 < 0.0f)) continue;
        float t = d0 / (d0 - d1);
        if (d0 < 0.0f && t > t0) t0 = t, side0 = i;
        if (d1 < 0.0f && t < t1) t1 = t, side1 = i;
    }
    if (t0 > t1) return 0;
    out[0] = side0 < 0 ? in[0] : crossing(in[0], in[1], t0, side0, reference, incident);
    out[1] = side1 < 0 ? in[1] : crossing(in[0], in[1], t1, side1, reference, incident);
    return 2;
}

struct Extent {
    float u0, u1, v0, v1;
    float size() const { return maximum(u1 - u0, v1 - v0); }
};
Extent extent_of(const Corner* c, int count) {
    Extent e{c[0].u, c[0].u, c[0].v, c[0].v};
    for (int i = 1; i < count; ++i) {
        e.u0 = minimum(e.u0, c[i].u), e.u1 = maximum(e.u1, c[i].u);
        e.v0 = minimum(e.v0, c[i].v), e.v1 = maximum(e.v1, c[i].v);
    }
    return e;
}

void project(const Face& face, const ClippedFace& plane, Corner* out) {
    for (int i = 0; i < face.count; ++i) {
        Vec3 p = face.vertices[i] - plane.origin;
        out[i] = {dot(p, plane.u), dot(p, plane.v), dot(p, plane.normal), i, 0, 0};
    }
}

int sides_of(const Corner* corners, int count, float slack, Side* out) {
    for (int i = 0; i < count; ++i) {
        const Corner &a = corners[i], &b = corners[next_of(i, count)];
        float mu = a.v - b.v, mv = b.u - a.u;
        float length = square_root(mu * mu + mv * mv), inverse = length > 0.0f ? 1.0f / length : 0.0f;
        mu *= inverse, mv *= inverse;
        out[i] = {mu, mv, mu * a.u + mv * a.v - slack};
    }
    return count;
}

template <class Observer>
LENDULET_FORCE_INLINE void clip(const Face& reference, const Face& incident, bool reference_is_b, float limit,
                                ClippedFace& out, Observer& observer) {
    Corner a[max_clipped_points], b[max_clipped_points];
    Side sides[max_face_vertices];
    out.count = 0;
    out.origin = reference.vertices[0];
    out.normal = reference.normal;
    out.u = perpendicular(out.normal);
    out.v = cross(out.normal, out.u);
    project(reference, out, b);
    Extent over = extent_of(b, reference.count);
    project(incident, out, a);
    Extent under = extent_of(a, incident.count);
    out.size = incident.count > 1 ? minimum(over.size(), under.size()) : over.size();
    float slack = overhang * out.size, reach = 2.0f * slack;  // more than the sides' slack reaches at a square corner
    if (under.u0 > over.u1 + reach || under.u1 < over.u0 - reach) return;
    if (under.v0 > over.v1 + reach || under.v1 < over.v0 - reach) return;
    int side_count = sides_of(b, reference.count, slack, sides);
    for (int i = 0; i < incident.count; ++i) {
        a[i].incident = vertex_feature(incident.ids[i]);
        a[i].reference = face_feature(reference.id);
    }
    Corner *from = a, *to = b;
    int count = incident.count;
    observer.clip_start(b, reference.count, a, count);
    if (count == 2) {
        count = clip_segment(a, sides, reference, incident, b);
        from = b;
        observer.clip_side(reference.count - 1, b, count);
    } else {
        float distance[max_clipped_points];
        for (int i = 0; i < side_count && count > 0; ++i) {
            if (!(distances_from(sides[i], from, count, distance) >= 0.0f)) {  // else it cuts nothing
                count = clip_by_side(from, count, distance, i, reference, incident, to);
                Corner* swap = from;
                from = to, to = swap;
            }
            observer.clip_side(i, from, count);
        }
    }
    for (int i = 0; i < count; ++i) {
        const Corner& c = from[i];
        if (c.w > limit) continue;
        uint32_t id = reference_is_b ? point_id(c.incident, c.reference) : point_id(c.reference, c.incident);
        out.points[out.count++] = {c.u, c.v, c.w, id};
    }
}

}  // namespace

void transform_face(const Transform& t, Face& face) {
    for (int i = 0; i < face.count; ++i) face.vertices[i] = t * face.vertices[i];
    face.normal = rotate(t.rotation, face.normal);
}

void clip_face(const Face& reference, const Face& incident, bool reference_is_b, float limit, ClippedFace& out) {
    SilentObserver silent;
    clip(reference, incident, reference_is_b, limit, out, silent);
}

void clip_face(const Face& reference, const Face& incident, bool reference_is_b, float limit, ClippedFace& out,
               Recorder& recorder) {
    clip(reference, incident, reference_is_b, limit, out, recorder);
}

}  // namespace lendulet
