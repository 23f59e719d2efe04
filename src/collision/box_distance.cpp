// The nearest point of a face of the difference is that of its plane or lies on its rim, where it is found as for two
// segments (Ericson, Real-Time Collision Detection, 5.1.9): on the plane through two edges, one of each, the segments'
// nearest points are those of the face. Apart, the supports along the way between the points prove that no other face
// is nearer, so that one that is remembered needs no comparison. Overlapping, the depth is the least overlap of the
// shadows on the fifteen axes (Gottschalk, Lin, Manocha 1996), all of which are compared; they also tell the face to
// try where none is remembered, or one that is not the nearest any more.
#include "collision/box_distance.h"

#include <bit>

#include "collision/box_candidates.h"
#include "collision/gjk_search.h"

namespace lendulet {
namespace {

static_assert(GjkCache::unknown_face == face_count + 1);

// Of S: how far beyond the ends of an edge rounding may put a point.
constexpr double beyond = 1e-9;
// Of S: nearer than this the way between points on a rim is rounding.
constexpr double touching = 1e-12;
// A distance is proven where the supports leave less than these: of the distance, as it bounds the error of the normal,
// and of S.
constexpr double relative_gap = 1e-9, absolute_gap = 1e-14;

double squared(double x) { return x * x; }
LENDULET_FORCE_INLINE double clamped(double x, double limit) { return maximum(-limit, minimum(limit, x)); }

// A face of the difference with the corners of A and of B that it begins at, whose coordinates along the face's edges
// are 0.
struct Face {
    int number;
    FacePlane plane;
    Lanes corner_a, corner_b;
    LENDULET_FORCE_INLINE Face(const BoxDifference& boxes, int face, const FacePlane& p)
        : number(face),
          plane(p),
          corner_a(towards_signs(boxes.half_a, p.n) * spans[face].kept_a),
          corner_b(towards_signs(boxes.half_b, -p.n_in_b) * spans[face].kept_b) {}
};

struct Nearest {
    Lanes n;          // unit, from A to B
    double distance;  // negative: depth
    double u, v;      // of the point, along the edges
    double gap;       // between the distance and the lower bound proven for it
};

// The point of the rim that is nearest to the origin, where that of the plane, at u_plane along the first edge,
// is not in the face. w is the middle of the face.
LENDULET_FORCE_INLINE bool nearest_on_rim(const BoxDifference& boxes, const Face& face, Lanes w, double u_plane,
                                          double max_distance, Nearest& out) {
    const Span& span = spans[face.number];
    const Lanes g = boxes.edge[span.first], h = boxes.edge[span.second];
    const double half_g = boxes.half[span.first], half_h = boxes.half[span.second];
    const double p = dot(g, w), q = dot(h, w), cosine = face.plane.cosine;
    const double v = clamped(-(q + cosine * clamped(u_plane, half_g)), half_h);
    const double u = clamped(-(p + cosine * v), half_g);
    const Lanes y = w + (u * g + v * h), y_in_b = boxes.to_b(y);
    // How much farther the supports reach than the corners. Along the face's edges they do not. Exactly zero where the
    // corners are the supports. All is times the distance, so that it need not wait for the root.
    const double gap = sum(span.kept_a * (absolute(y) * boxes.half_a) - y * face.corner_a +
                           (span.kept_b * (absolute(y_in_b) * boxes.half_b) + y_in_b * face.corner_b));
    const double square = dot(y, y), size_squared = squared(boxes.size), bound = square - gap;
    const double limit = max_distance > 0.0 ? squared(max_distance) : 0.0;
    const bool proven = gap <= relative_gap * square || squared(gap) <= squared(absolute_gap) * size_squared * square;
    const bool is_beyond = bound > 0.0 && squared(bound) > limit * square;
    if (!(proven || is_beyond) || !(square > squared(touching) * size_squared)) return false;
    const double distance = square_root(square), inverse = distance * (1.0 / square);
    out = {inverse * y, proven ? distance : inverse * bound, u, v, proven ? inverse * gap : 0.0};
    return true;
}

// True where the point is proven to be the nearest of the difference, or the boxes to be beyond `max_distance`; where
// they overlap along the normal, where the point lies in the face.
LENDULET_FORCE_INLINE bool nearest_of_face(const BoxDifference& boxes, const Face& face, double max_distance,
                                           Nearest& out) {
    const Span& span = spans[face.number];
    const FacePlane& plane = face.plane;
    const Lanes w = boxes.t + boxes.from_b(face.corner_b) - face.corner_a;
    const double p = dot(boxes.edge[span.first], w), q = dot(boxes.edge[span.second], w);
    const double inverse = 1.0 / plane.sine_squared, slack = beyond * boxes.size;
    const double u = (plane.cosine * q - p) * inverse, v = (plane.cosine * p - q) * inverse;
    if (absolute(u) <= boxes.half[span.first] + slack && absolute(v) <= boxes.half[span.second] + slack) {
        const double scale = square_root(inverse);
        out = {scale * plane.n, scale * plane.separation_times_sine, u, v, 0.0};
        return true;
    }
    return plane.separation_times_sine > 0.0 && nearest_on_rim(boxes, face, w, u, max_distance, out);
}

LENDULET_FORCE_INLINE void write(const BoxDifference& boxes, const Face& face, const Nearest& nearest, GjkCache& cache,
                                 ConvexDistance& out) {
    const Span& span = spans[face.number];
    const Lanes on_edges = nearest.u * along_edge_of_a[span.first] + nearest.v * along_edge_of_a[span.second];
    const Lanes on_a = face.corner_a - on_edges;
    out = {static_cast<float>(nearest.distance),
           to_float(nearest.n),
           to_float(on_a),
           to_float(on_a + nearest.distance * nearest.n),
           0,
           0,
           nearest.gap <= certified_distance * boxes.size};
    cache.face = static_cast<uint8_t>(face.number + 1);
    cache.direction = out.normal;
    if (cache.count != 0) return;
    cache.count = 1;
    cache.a[0] = to_float(towards_signs(boxes.half_a, face.plane.n));
    cache.b[0] = to_float(towards_signs(boxes.half_b, -face.plane.n_in_b));
}

LENDULET_FORCE_INLINE bool is_nearest(const BoxDifference& boxes, int number, const FacePlane& plane,
                                      double max_distance, GjkCache& cache, ConvexDistance& out) {
    const Face face(boxes, number, plane);
    Nearest nearest;
    if (!nearest_of_face(boxes, face, max_distance, nearest)) return false;
    write(boxes, face, nearest, cache, out);
    return true;
}

// Of several faces the one along whose normal the boxes are farthest apart.
int best_of(const BoxDifference& boxes, uint32_t faces) {
    int best = 0;
    double most = -1e300;
    for (; faces != 0; faces &= faces - 1) {
        const int face = std::countr_zero(faces);
        const FacePlane plane = plane_of(boxes, face);
        const double separation = plane.separation_times_sine / square_root(plane.sine_squared);
        if (separation > most) best = face, most = separation;
    }
    return best;
}

}  // namespace

bool closest_of_boxes(const BoxDifference& boxes, float max_distance, GjkCache& cache, ConvexDistance& out) {
    int face = cache.face - 1;
    bool known = static_cast<unsigned>(face) < face_count;
    FacePlane plane;
    if (known) {
        plane = plane_of(boxes, face);
        if (plane.separation_times_sine > 0.0 && plane.sine_squared > static_cast<double>(least_sine_squared)) {
            if (is_nearest(boxes, face, plane, max_distance, cache, out)) return true;
            known = false;
        }
    }
    const uint32_t candidates = best_candidates(boxes);
    if (candidates == 0) return false;
    // It is mostly the last one again: what follows need not wait for the comparison.
    if (!known || candidates != 1u << face) {
        face = (candidates & (candidates - 1)) == 0 ? std::countr_zero(candidates) : best_of(boxes, candidates);
        plane = plane_of(boxes, face);
    }
    return is_nearest(boxes, face, plane, max_distance, cache, out);
}

}  // namespace lendulet
