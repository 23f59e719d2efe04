#include "collision/clip.h"

namespace lendulet {
namespace {

// Tolerances relative to the size of the set of points. Below the first, depths count as equal: resting bodies tremble
// by 1e-5 of their size, and the choice of points must not. Below the second, a point adds nothing to the support.
constexpr float equal_depth = 5e-4f;
constexpr float negligible_reach = 1e-3f;
// A point that carried nothing must span this many times more than one that did. Of the many corners of round faces
// others would be chosen in every step, and a body turn over the one that is left out to find it the next time.
constexpr float fresh_worth = 0.25f;
// Scores this close are a tie, which the fixed direction decides: regular polygons are full of them.
constexpr float tie = 1e-4f;

// Twice the signed area of the triangle a, b, p.
float area(const FacePoint& a, const FacePoint& b, const FacePoint& p) {
    return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
}

void swap(FacePoint& a, FacePoint& b) {
    FacePoint t = a;
    a = b;
    b = t;
}

float size_of(const FacePoint* points, int count) {
    float u0 = points[0].u, u1 = u0, v0 = points[0].v, v1 = v0;
    for (int i = 1; i < count; ++i) {
        u0 = minimum(u0, points[i].u), u1 = maximum(u1, points[i].u);
        v0 = minimum(v0, points[i].v), v1 = maximum(v1, points[i].v);
    }
    return maximum(u1 - u0, v1 - v0);
}

// The slope of the fixed direction is no ratio of small integers, so that the corners of usual polygons do not tie.
float along_fixed_direction(const FacePoint& p) { return p.u + 0.618034f * p.v; }

// Moves the best of points[from..count) by `score` to `from`; the highest score is returned. Ties go to the end of the
// fixed direction for the first and third point and to its start for the others, so that symmetric outlines keep
// symmetric points.
template <class Score>
float pick(FacePoint* points, int from, int count, Score&& score) {
    float scores[max_clipped_points], best_score = scores[from] = score(points[from]);
    for (int i = from + 1; i < count; ++i) best_score = maximum(best_score, scores[i] = score(points[i]));
    float limit = best_score - tie * absolute(best_score);
    float end = from % 2 == 0 ? 1.0f : -1.0f;
    int best = -1;
    for (int i = from; i < count; ++i)
        if (scores[i] >= limit &&
            (best < 0 || end * along_fixed_direction(points[i]) > end * along_fixed_direction(points[best])))
            best = i;
    swap(points[from], points[best]);
    return best_score;
}

}  // namespace

int reduce_points(FacePoint* points, int count, const CarriedPoints& carried) {
    return count <= 4 ? count : thin_points(points, count, carried);
}

int thin_points(FacePoint* points, int count, const CarriedPoints& carried) {
    if (count <= 1) return count;
    float size = size_of(points, count);
    float reach = negligible_reach * size;
    float deepest = points[0].separation;
    for (int i = 1; i < count; ++i) deepest = minimum(deepest, points[i].separation);
    float limit = deepest + equal_depth * size;
    auto worth = [&](const FacePoint& p) { return carried.has(p.id) ? 1.0f : fresh_worth; };
    constexpr float lowest = -3e38f;
    pick(points, 0, count,
         [&](const FacePoint& p) { return p.separation <= limit ? along_fixed_direction(p) : lowest; });
    const FacePoint a = points[0];
    float far = pick(points, 1, count, [&](const FacePoint& p) {
        return worth(p) * ((p.u - a.u) * (p.u - a.u) + (p.v - a.v) * (p.v - a.v));
    });
    if (!(far > reach * reach)) return 1;
    if (count == 2) return 2;
    const FacePoint b = points[1];
    float least = reach * square_root(far);
    float third = pick(points, 2, count, [&](const FacePoint& p) { return worth(p) * absolute(area(a, b, p)); });
    if (!(third > least)) return 2;
    if (count == 3) return 3;
    const FacePoint c = points[2];
    float side = area(a, b, c) > 0.0f ? 1.0f : -1.0f;
    float fourth = pick(points, 3, count, [&](const FacePoint& p) {
        return worth(p) * maximum(maximum(-side * area(a, b, p), -side * area(b, c, p)), -side * area(c, a, p));
    });
    return fourth > least ? 4 : 3;
}

int shared_stretch(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1, PointPair* out) {
    Vec3 a = a1 - a0, b = b1 - b0;
    float aa = dot(a, a), ab = dot(a, b);
    if (!(ab * ab > 0.98f * aa * dot(b, b))) return 0;
    // Parameters along A of the ends of B.
    float start = dot(a, b0 - a0) / aa, turn = ab / aa, end = start + turn;
    float lower = maximum(0.0f, minimum(start, end)), upper = minimum(1.0f, maximum(start, end));
    if (!(upper - lower > 0.02f * minimum(1.0f, absolute(turn)))) return 0;
    for (int i = 0; i < 2; ++i) {
        float s = i == 0 ? lower : upper;
        out[i] = {a0 + s * a, b0 + clamp((s - start) / turn, 0.0f, 1.0f) * b};
    }
    return 2;
}

}  // namespace lendulet
