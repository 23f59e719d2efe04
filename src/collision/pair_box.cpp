// Two sharp boxes: separating axes (Gottschalk, Lin, Manocha 1996), then the incident face clipped by the reference
// face, or the point between two edges. The hot path of every pile: lanes are axes of a box in the first stage and
// edges of the incident face in the second, and the only branches are early exits and the kind of contact.
#include "collision/clip.h"
#include "collision/pair.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

using F4 = Wide<float, 4>;

// A face is preferred to an edge axis that separates better by less than this part of the smallest half extent, and the
// axis of the last step to any other: contacts of faces are stable, and a change of axis changes every point.
constexpr float axis_tolerance = 5e-3f;
// Points this part of the size outside the reference face still count as inside it, so that round-off does not make
// the corners of boxes of equal size come and go.
constexpr float overhang = 2e-4f;
constexpr float no_axis = -3e38f;

F4 lanes(float a, float b, float c, float d) {
    float v[4] = {a, b, c, d};
    return load_wide<F4>(v);
}
F4 all(float a) { return splat<F4>(a); }

// Both boxes along the axes of each. rows[i] lane j = columns[j] lane i = (axis i of A) . (axis j of B).
struct BoxPair {
    Mat3 a, b;    // axes in the world
    Vec3 offset;  // centre of B minus centre of A, world
    float half_a[4], half_b[4];
    alignas(16) float rows[3][4], columns[3][4];
    alignas(16) float along_a[4], along_b[4];  // the offset along the axes of A and of B
};

void store3(float* to, Vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = 0.0f; }

// Axis numbers: 0..2 faces of A, 3..5 faces of B, 6 + 3 i + j edge i of A with edge j of B.
struct BestAxis {
    int axis;
    float separation;
};

// The axes of a matrix, lane by lane: x components, y components, z components.
Vec3T<F4> axis_lanes(const Mat3& m) {
    return {lanes(m.x.x, m.y.x, m.z.x, 0.0f), lanes(m.x.y, m.y.y, m.z.y, 0.0f), lanes(m.x.z, m.y.z, m.z.z, 0.0f)};
}

void face_axes(BoxPair& p, float* separations) {
    Vec3T<F4> a = axis_lanes(p.a), b = axis_lanes(p.b);
    Vec3T<F4> d = splat<F4>(p.offset);
    F4 da = dot(a, d), db = dot(b, d);
    F4 reach_a = load_wide<F4>(p.half_a), reach_b = load_wide<F4>(p.half_b);
    const Vec3 axes_a[3] = {p.a.x, p.a.y, p.a.z}, axes_b[3] = {p.b.x, p.b.y, p.b.z};
    for (int k = 0; k < 3; ++k) {
        F4 row = dot(splat<F4>(axes_a[k]), b), column = dot(splat<F4>(axes_b[k]), a);
        store_wide(p.rows[k], row);
        store_wide(p.columns[k], column);
        reach_a = reach_a + p.half_b[k] * absolute(column);
        reach_b = reach_b + p.half_a[k] * absolute(row);
    }
    store_wide(p.along_a, da);
    store_wide(p.along_b, db);
    store_wide(separations, absolute(da) - reach_a);
    store_wide(separations + 4, absolute(db) - reach_b);
}

// Separation along the cross product of edge i of A and edge j of B, lane j; nearly parallel edges have none, the faces
// cover them.
F4 edge_axes(const BoxPair& p, int i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    F4 r1 = load_wide<F4>(p.rows[i1]), r2 = load_wide<F4>(p.rows[i2]);
    const float* r = p.rows[i];
    F4 next = absolute(lanes(r[1], r[2], r[0], 0.0f)), last = absolute(lanes(r[2], r[0], r[1], 0.0f));
    F4 half_next = lanes(p.half_b[1], p.half_b[2], p.half_b[0], 0.0f);
    F4 half_last = lanes(p.half_b[2], p.half_b[0], p.half_b[1], 0.0f);
    F4 distance = absolute(p.along_a[i2] * r1 - p.along_a[i1] * r2);
    F4 reach = (p.half_a[i1] * absolute(r2) + p.half_a[i2] * absolute(r1)) + (half_next * last + half_last * next);
    F4 sine_squared = r1 * r1 + r2 * r2;
    F4 separation = (distance - reach) / square_root(maximum(sine_squared, all(1e-12f)));
    return select(sine_squared > all(1e-5f), separation, all(no_axis));
}

// The axis of largest separation; `apart` as soon as one exceeds the margin.
BestAxis best_axis(BoxPair& p, float margin, uint32_t remembered, bool& apart) {
    alignas(16) float faces[8], edges[12];
    face_axes(p, faces);
    apart = true;
    int face = 0;
    float separation = faces[0];
    for (int k = 1; k < 6; ++k) {
        float s = faces[k < 3 ? k : k + 1];
        bool better = s > separation;
        face = better ? k : face;
        separation = better ? s : separation;
    }
    if (separation > margin) return {face, separation};
    for (int i = 0; i < 3; ++i) store_wide(edges + 4 * i, edge_axes(p, i));
    int edge = 0;
    float edge_separation = edges[0];
    for (int k = 1; k < 9; ++k) {
        float s = edges[k + k / 3];
        bool better = s > edge_separation;
        edge = better ? k : edge;
        edge_separation = better ? s : edge_separation;
    }
    if (edge_separation > margin) return {edge + 6, edge_separation};
    apart = false;
    float smallest = minimum(minimum(minimum(p.half_a[0], p.half_a[1]), p.half_a[2]),
                             minimum(minimum(p.half_b[0], p.half_b[1]), p.half_b[2]));
    float tolerance = axis_tolerance * smallest;
    BestAxis best =
        edge_separation > separation + tolerance ? BestAxis{edge + 6, edge_separation} : BestAxis{face, separation};
    if (remembered >= 1 && remembered <= 15) {
        int k = static_cast<int>(remembered) - 1;
        float s = k < 3 ? faces[k] : k < 6 ? faces[k + 1] : edges[k - 6 + (k - 6) / 3];
        if (s > best.separation - tolerance) best = {k, s};
    }
    return best;
}

// --- faces

// Names of a box's features: corners 0..7 by the signs of their coordinates, edges 8..19, faces 20..25.
uint32_t sign_bit(float s) { return s > 0.0f ? 1u : 0u; }
uint32_t box_edge(int axis, float sign_next, float sign_last) {
    return 8u + 4u * static_cast<uint32_t>(axis) + sign_bit(sign_next) + 2u * sign_bit(sign_last);
}
uint32_t box_corner(int axis, float sign, float sign_next, float sign_last) {
    return sign_bit(sign) << axis | sign_bit(sign_next) << (axis + 1) % 3 | sign_bit(sign_last) << (axis + 2) % 3;
}
uint32_t box_face(int axis, float sign) { return 20u + 2u * static_cast<uint32_t>(axis) + sign_bit(sign); }

// The reference face and the incident face in its coordinates: u and v along the reference box's next two axes, w along
// the normal, from the reference box's centre.
struct Faces {
    int axis, incident_axis;
    float sign, incident_sign;
    float half_u, half_v, half_w;
    Vec3 centre, edge_1, edge_2;  // of the incident face: centre and half edges along its next two axes
    bool reference_is_b;
};

Faces faces_of(const BoxPair& p, int axis) {
    Faces f;
    f.reference_is_b = axis >= 3;
    f.axis = f.reference_is_b ? axis - 3 : axis;
    const auto& turn = f.reference_is_b ? p.columns : p.rows;  // [reference axis][incident axis]
    const float* along = f.reference_is_b ? p.along_b : p.along_a;
    const float* half = f.reference_is_b ? p.half_b : p.half_a;
    const float* incident_half = f.reference_is_b ? p.half_a : p.half_b;
    float toward = f.reference_is_b ? -1.0f : 1.0f;  // the offset leads from A to B
    const int k = f.axis, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    float w = toward * along[k];
    f.sign = w < 0.0f ? -1.0f : 1.0f;
    f.half_u = half[k1], f.half_v = half[k2], f.half_w = half[k];
    const float* n = turn[k];
    float n0 = absolute(n[0]), n1 = absolute(n[1]), n2 = absolute(n[2]);
    const int j = n0 >= n1 && n0 >= n2 ? 0 : n1 >= n2 ? 1 : 2;
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    f.incident_axis = j;
    f.incident_sign = f.sign * n[j] > 0.0f ? -1.0f : 1.0f;
    auto axis_of = [&](int i) { return Vec3{turn[k1][i], turn[k2][i], f.sign * n[i]}; };
    f.centre =
        Vec3{toward * along[k1], toward * along[k2], f.sign * w} + f.incident_sign * incident_half[j] * axis_of(j);
    f.edge_1 = incident_half[j1] * axis_of(j1);
    f.edge_2 = incident_half[j2] * axis_of(j2);
    return f;
}

// Candidates: 0..3 where the incident edges enter the reference face, 4..7 where they leave it, 8..11 the corners of
// the reference face that lie within the incident one.
struct Candidates {
    alignas(16) float u[12], v[12], w[12];
    alignas(16) float enter_u[4], enter_v[4], leave_u[4], leave_v[4];  // edge parameters at the sides
    uint32_t valid;
};

F4 safe_inverse(F4 d) {
    F4 tiny = all(1e-12f);
    return all(1.0f) / select(absolute(d) > tiny, d, tiny);
}

void clip_edges(const Faces& f, float slack_u, float slack_v, Candidates& c) {
    // Edge e runs from corner e to corner e + 1; the corners go round with signs ++, -+, --, +-.
    F4 s1 = lanes(1.0f, -1.0f, -1.0f, 1.0f), s2 = lanes(1.0f, 1.0f, -1.0f, -1.0f);
    F4 g1 = lanes(-2.0f, 0.0f, 2.0f, 0.0f), g2 = lanes(0.0f, -2.0f, 0.0f, 2.0f);
    Vec3T<F4> e1 = splat<F4>(f.edge_1), e2 = splat<F4>(f.edge_2);
    Vec3T<F4> corner = splat<F4>(f.centre) + s1 * e1 + s2 * e2, along = g1 * e1 + g2 * e2;
    F4 iu = safe_inverse(along.x), iv = safe_inverse(along.y);
    F4 hu = all(f.half_u + slack_u), hv = all(f.half_v + slack_v), zero = all(0.0f), one = all(1.0f);
    F4 ua = (-hu - corner.x) * iu, ub = (hu - corner.x) * iu, va = (-hv - corner.y) * iv, vb = (hv - corner.y) * iv;
    F4 enter_u = minimum(ua, ub), enter_v = minimum(va, vb), leave_u = maximum(ua, ub), leave_v = maximum(va, vb);
    F4 t0 = maximum(maximum(enter_u, enter_v), zero), t1 = minimum(minimum(leave_u, leave_v), one);
    store_wide(c.u, corner.x + t0 * along.x);
    store_wide(c.v, corner.y + t0 * along.y);
    store_wide(c.w, corner.z + t0 * along.z);
    store_wide(c.u + 4, corner.x + t1 * along.x);
    store_wide(c.v + 4, corner.y + t1 * along.y);
    store_wide(c.w + 4, corner.z + t1 * along.z);
    store_wide(c.enter_u, enter_u);
    store_wide(c.enter_v, enter_v);
    store_wide(c.leave_u, leave_u);
    store_wide(c.leave_v, leave_v);
    c.valid = mask_bits(t0 <= t1) | mask_bits((t0 < t1) & (t1 < one)) << 4;
}

void project_corners(const Faces& f, float slack, Candidates& c) {
    F4 u = f.half_u * lanes(1.0f, -1.0f, -1.0f, 1.0f), v = f.half_v * lanes(1.0f, 1.0f, -1.0f, -1.0f);
    float determinant = f.edge_1.x * f.edge_2.y - f.edge_1.y * f.edge_2.x;
    float inverse = absolute(determinant) > 1e-30f ? 1.0f / determinant : 0.0f;
    F4 du = u - all(f.centre.x), dv = v - all(f.centre.y);
    F4 p1 = inverse * (du * f.edge_2.y - dv * f.edge_2.x), p2 = inverse * (f.edge_1.x * dv - f.edge_1.y * du);
    // Corners on the rim are left to the edges, which are clipped by a slightly larger rectangle.
    F4 in1 = all(1.0f - slack / length(f.edge_1)), in2 = all(1.0f - slack / length(f.edge_2));
    store_wide(c.u + 8, u);
    store_wide(c.v + 8, v);
    store_wide(c.w + 8, all(f.centre.z) + p1 * f.edge_1.z + p2 * f.edge_2.z);
    c.valid |= mask_bits((absolute(p1) < in1) & (absolute(p2) < in2)) << 8;
}

constexpr float corner_1[4] = {1.0f, -1.0f, -1.0f, 1.0f}, corner_2[4] = {1.0f, 1.0f, -1.0f, -1.0f};

// Names of the two features that meet in candidate q.
uint32_t name_of_candidate(const Faces& f, const Candidates& c, int q) {
    const int j = f.incident_axis, k = f.axis, e = q & 3;
    uint32_t incident, reference;
    if (q >= 8) {
        incident = box_face(j, f.incident_sign);
        reference = box_corner(k, f.sign, corner_1[e], corner_2[e]);
    } else if (q < 4 && c.enter_u[e] <= 0.0f && c.enter_v[e] <= 0.0f) {
        incident = box_corner(j, f.incident_sign, corner_1[e], corner_2[e]);
        reference = box_face(k, f.sign);
    } else {
        // Even edges run along the incident face's first axis, on one side of the second.
        incident = (e & 1) == 0 ? box_edge((j + 1) % 3, corner_2[e], f.incident_sign)
                                : box_edge((j + 2) % 3, f.incident_sign, corner_1[e]);
        bool enters = q < 4;
        bool through_u = enters ? c.enter_u[e] > c.enter_v[e] : c.leave_u[e] < c.leave_v[e];
        // It enters through the side that it runs away from. Its direction says which side that is, also where the
        // crossing itself is lost in round-off.
        const Vec3& half_edge = (e & 1) == 0 ? f.edge_1 : f.edge_2;
        float side = ((e < 2) == enters ? 1.0f : -1.0f) * (through_u ? half_edge.x : half_edge.y);
        reference = through_u ? box_edge((k + 2) % 3, f.sign, side) : box_edge((k + 1) % 3, side, f.sign);
    }
    return f.reference_is_b ? point_id(incident, reference) : point_id(reference, incident);
}

int face_manifold(const BoxPair& p, int axis, float margin, Manifold& out) {
    Faces f = faces_of(p, axis);
    Candidates c;
    float slack_u = overhang * minimum(f.half_u, absolute(f.edge_1.x) + absolute(f.edge_2.x));
    float slack_v = overhang * minimum(f.half_v, absolute(f.edge_1.y) + absolute(f.edge_2.y));
    clip_edges(f, slack_u, slack_v, c);
    project_corners(f, 0.5f * minimum(slack_u, slack_v), c);
    FacePoint points[12];
    int count = 0;
    for (uint32_t bits = c.valid; bits != 0; bits &= bits - 1) {
        int q = __builtin_ctz(bits);
        float separation = c.w[q] - f.half_w;
        points[count] = {c.u[q], c.v[q], separation, static_cast<uint32_t>(q)};
        count += separation <= margin;
    }
    count = reduce_points(points, count);
    if (count == 0) return 0;
    const Mat3& m = f.reference_is_b ? p.b : p.a;
    const Vec3 axes[3] = {m.x, m.y, m.z};
    Vec3 u = axes[(f.axis + 1) % 3], v = axes[(f.axis + 2) % 3], w = f.sign * axes[f.axis];
    Vec3 centre = f.reference_is_b ? p.offset : Vec3{};
    out.normal = f.reference_is_b ? -w : w;
    out.count = count;
    for (int i = 0; i < count; ++i) {
        const FacePoint& q = points[i];
        Vec3 position = centre + (q.u * u + q.v * v + (f.half_w + 0.5f * q.separation) * w);
        out.points[i] = {position, q.separation, name_of_candidate(f, c, static_cast<int>(q.id))};
    }
    out.follow = f.reference_is_b ? 0.0f : 1.0f;
    return 1;
}

// --- edges

float sign_of(float s) { return s > 0.0f ? 1.0f : -1.0f; }

// The nearest points of the two edges whose cross product is the axis; 0 where they lie beyond the edges' ends, which
// happens only to boxes apart.
int edge_manifold(const BoxPair& p, int i, int j, float margin, Manifold& out) {
    const Vec3 axes_a[3] = {p.a.x, p.a.y, p.a.z}, axes_b[3] = {p.b.x, p.b.y, p.b.z};
    Vec3 ea = axes_a[i], eb = axes_b[j];
    Vec3 n = normalize(cross(ea, eb));
    if (dot(n, p.offset) < 0.0f) n = -n;
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    float a1 = sign_of(dot(n, axes_a[i1])), a2 = sign_of(dot(n, axes_a[i2]));
    float b1 = -sign_of(dot(n, axes_b[j1])), b2 = -sign_of(dot(n, axes_b[j2]));
    Vec3 on_a = (a1 * p.half_a[i1]) * axes_a[i1] + (a2 * p.half_a[i2]) * axes_a[i2];
    Vec3 on_b = p.offset + ((b1 * p.half_b[j1]) * axes_b[j1] + (b2 * p.half_b[j2]) * axes_b[j2]);
    Vec3 gap = on_b - on_a;
    float cosine = dot(ea, eb), along_a = dot(ea, gap), along_b = dot(eb, gap);
    float inverse = 1.0f / maximum(1.0f - cosine * cosine, 1e-6f);
    float s = (along_a - cosine * along_b) * inverse, t = (cosine * along_a - along_b) * inverse;
    constexpr float beyond = 1.0f + 1e-3f;
    if (absolute(s) > beyond * p.half_a[i] || absolute(t) > beyond * p.half_b[j]) return 0;
    on_a += s * ea;
    on_b += t * eb;
    float separation = dot(on_b - on_a, n);
    if (separation > margin) return 0;
    out.normal = n;
    out.count = 1;
    out.points[0] = {0.5f * (on_a + on_b), separation, point_id(box_edge(i, a1, a2), box_edge(j, b1, b2))};
    out.follow = 0.5f;
    return 1;
}

}  // namespace

int collide_box_box(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold& out) {
    BoxPair p;
    p.a = rotation_matrix(pair.rotation_a);
    p.b = rotation_matrix(pair.rotation_b);
    p.offset = pair.offset;
    store3(p.half_a, pair.a->size);
    store3(p.half_b, pair.b->size);
    bool apart;
    BestAxis best = best_axis(p, pair.margin, cache.feature, apart);
    if (apart) return 0;
    cache.feature = static_cast<uint32_t>(best.axis) + 1;
    out.radius_a = out.radius_b = 0.0f;
    out.triangle = -1;
    out.key = 0;
    int found = best.axis < 6 ? face_manifold(p, best.axis, pair.margin, out)
                              : edge_manifold(p, (best.axis - 6) / 3, (best.axis - 6) % 3, pair.margin, out);
    if (found > 0) return found;
    // The faces or edges that face each other do not overlap: the boxes are apart, corner to edge or corner to corner,
    // and the separating axis is not the direction of the shortest distance.
    cache.feature = 0;
    return collide_convex_convex(pair, cache, settings, out);
}

}  // namespace lendulet
