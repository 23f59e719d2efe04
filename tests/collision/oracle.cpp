#include "oracle.h"

#include <algorithm>
#include <cmath>

namespace oracle {

Real norm(Vec a) { return std::sqrt(dot(a, a)); }

Pose make_pose(Real x, Real y, Real z, Real w, Vec translation) {
    Real s = 2 / (x * x + y * y + z * z + w * w);
    return {{{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
             {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
             {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)}},
            translation};
}
Vec apply(const Pose& pose, Vec p) {
    return pose.translation + p.x * pose.columns[0] + p.y * pose.columns[1] + p.z * pose.columns[2];
}

Body make_box(Vec h) {
    Body body;
    for (int i = 0; i < 8; ++i) body.corners.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
    for (int i = 0; i < 8; ++i)
        for (int bit : {1, 2, 4})
            if (!(i & bit)) body.edges.push_back({i, i | bit});
    const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            int bit = 1 << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side ? bit : 0;
            Vec normal = (side ? Real(1) : Real(-1)) * axes[axis];
            body.triangles.push_back({{base, base | u, base | u | v}, normal});
            body.triangles.push_back({{base, base | v, base | u | v}, normal});
        }
    return body;
}

Body make_points(const std::vector<Vec>& corners) {
    Body body;
    body.corners = corners;
    int n = static_cast<int>(corners.size());
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j) body.edges.push_back({i, j});
    if (n == 3) {
        Vec normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        normal = (1 / norm(normal)) * normal;
        body.triangles.push_back({{0, 1, 2}, normal});
        body.triangles.push_back({{0, 1, 2}, Real(-1) * normal});
    }
    return body;
}

Body make_hull(const std::vector<Vec>& points) {
    Body body;
    body.corners = points;
    int n = static_cast<int>(points.size());
    Real size = 0;
    for (Vec p : points) size = std::max(size, norm(p));
    std::vector<bool> is_edge(static_cast<size_t>(n) * n);
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j)
            for (int k = j + 1; k < n; ++k) {
                Vec normal = cross(points[j] - points[i], points[k] - points[i]);
                Real length = norm(normal);
                if (!(length > 1e-12L * size * size)) continue;
                normal = (1 / length) * normal;
                bool above = false, below = false;
                for (int m = 0; m < n && !(above && below); ++m) {
                    Real height = dot(normal, points[m] - points[i]);
                    above = above || height > 1e-12L * size;
                    below = below || height < -1e-12L * size;
                }
                if (above && below) continue;
                body.triangles.push_back({{i, j, k}, above ? Real(-1) * normal : normal});
                for (auto [p, q] : {std::pair{i, j}, std::pair{j, k}, std::pair{i, k}}) {
                    if (!is_edge[p * n + q]) body.edges.push_back({p, q});
                    is_edge[p * n + q] = true;
                }
            }
    return body;
}

Body moved(const Body& body, const Pose& pose) {
    Body result = body;
    for (Vec& p : result.corners) p = apply(pose, p);
    for (auto& t : result.triangles) t.normal = apply(pose, t.normal) - pose.translation;
    return result;
}

Real support(const Body& body, Vec n) {
    Real best = dot(n, body.corners[0]);
    for (Vec p : body.corners) best = std::max(best, dot(n, p));
    return best;
}

namespace {

struct Pair {
    Real squared = 1e300L;
    Vec difference;  // from A to B
    void offer(Vec d) {
        Real s = dot(d, d);
        if (s < squared) squared = s, difference = d;
    }
};

Real clamp_unit(Real t) { return t < 0 ? 0 : t > 1 ? 1 : t; }

// All candidates of two segments: the crossing of the lines and the four end points against the other segment.
void offer_segments(Pair& pair, Vec p, Vec u, Vec q, Vec v) {
    Real a = dot(u, u), b = dot(u, v), c = dot(v, v);
    Vec w = q - p;
    Real determinant = a * c - b * b;
    if (determinant > 0) {
        Real s = (dot(u, w) * c - dot(v, w) * b) / determinant, t = (dot(u, w) * b - dot(v, w) * a) / determinant;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) pair.offer(q + t * v - (p + s * u));
    }
    for (int end = 0; end < 2; ++end) {
        Vec on_p = p + Real(end) * u, on_q = q + Real(end) * v;
        pair.offer(q + (c > 0 ? clamp_unit(dot(v, on_p - q) / c) : 0) * v - on_p);
        pair.offer(on_q - (p + (a > 0 ? clamp_unit(dot(u, on_q - p) / a) : 0) * u));
    }
}

// From the point p to the inside of a triangle, where it projects there.
bool to_triangle(const Body& body, const Body::Triangle& t, Vec p, Vec& difference) {
    Vec corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = body.corners[t.corner[i]];
    Vec n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    for (int i = 0; i < 3; ++i)
        if (dot(cross(n, corner[(i + 1) % 3] - corner[i]), p - corner[i]) < 0) return false;
    difference = (dot(n, corner[0] - p) / dot(n, n)) * n;
    return true;
}

Vec shortest(const Body& a, const Body& b) {
    Pair pair;
    for (Vec p : a.corners)
        for (Vec q : b.corners) pair.offer(q - p);
    // Two edges whose balls are farther apart than what was found already have nothing to offer.
    struct Ball {
        Vec centre;
        Real radius;
    };
    auto balls = [](const Body& body) {
        std::vector<Ball> out;
        for (auto [i, j] : body.edges) {
            Vec half = Real(0.5L) * (body.corners[j] - body.corners[i]);
            out.push_back({body.corners[i] + half, 1.0000001L * norm(half)});
        }
        return out;
    };
    const std::vector<Ball> of_a = balls(a), of_b = balls(b);
    for (size_t e = 0; e < a.edges.size(); ++e)
        for (size_t f = 0; f < b.edges.size(); ++f) {
            Vec between = of_b[f].centre - of_a[e].centre;
            Real reach = of_a[e].radius + of_b[f].radius + std::sqrt(pair.squared);
            if (dot(between, between) > reach * reach) continue;
            auto [i, j] = a.edges[e];
            auto [k, l] = b.edges[f];
            offer_segments(pair, a.corners[i], a.corners[j] - a.corners[i], b.corners[k], b.corners[l] - b.corners[k]);
        }
    // Corners are ends of edges, but for single points.
    if (b.edges.empty())
        for (auto [i, j] : a.edges)
            for (Vec q : b.corners) offer_segments(pair, a.corners[i], a.corners[j] - a.corners[i], q, {});
    if (a.edges.empty())
        for (auto [k, l] : b.edges)
            for (Vec p : a.corners) offer_segments(pair, p, {}, b.corners[k], b.corners[l] - b.corners[k]);
    Vec d;
    auto far = [&](const Body& body, const Body::Triangle& t, Vec p) {
        Real height = dot(t.normal, p - body.corners[t.corner[0]]);
        return height * height > 1.0000001L * pair.squared;
    };
    for (const auto& t : b.triangles)
        for (Vec p : a.corners)
            if (!far(b, t, p) && to_triangle(b, t, p, d)) pair.offer(d);
    for (const auto& t : a.triangles)
        for (Vec q : b.corners)
            if (!far(a, t, q) && to_triangle(a, t, q, d)) pair.offer(Real(-1) * d);
    return pair.difference;
}

}  // namespace

namespace {

// Directions of edges, each once.
std::vector<Vec> edge_directions(const Body& body) {
    std::vector<Vec> out;
    for (auto [i, j] : body.edges) {
        Vec d = body.corners[j] - body.corners[i];
        Real size = norm(d);
        if (!(size > 0)) continue;
        d = (1 / size) * d;
        bool known = false;
        for (Vec e : out) known = known || norm(cross(d, e)) < 1e-17L;
        if (!known) out.push_back(d);
    }
    return out;
}

int farthest(const Body& body, Vec n) {
    int best = 0;
    Real most = dot(body.corners[0], n);
    for (int i = 1; i < static_cast<int>(body.corners.size()); ++i) {
        Real along = dot(body.corners[i], n);
        if (along > most) most = along, best = i;
    }
    return best;
}

// Separations along directions from A to B. Any corner of each bounds them from above: most directions need no more
// than those of a few directions before to be known to be worse, by more than what a tie is judged by.
struct Separations {
    const Body &a, &b;
    std::vector<std::pair<Real, Vec>> candidates;
    Real best = -1e300L, tie = 0;
    static constexpr int remembered = 8;
    Vec between[remembered];  // corners of A and B
    int used = 0, next = 0;

    Separations(const Body& first, const Body& second) : a(first), b(second) {
        for (const Body* body : {&a, &b})
            for (Vec p : body->corners) tie = std::max(tie, norm(p - body->corners[0]));
        tie *= 1e-2L;
    }
    void offer(Vec n) {
        for (int i = 0; i < used; ++i)
            if (dot(between[i], n) < best - tie) return;
        int i = farthest(a, n), k = farthest(b, Real(-1) * n);
        Real separation = dot(b.corners[k] - a.corners[i], n);
        candidates.push_back({separation, n});
        best = std::max(best, separation);
        between[next] = b.corners[k] - a.corners[i];
        next = (next + 1) % remembered;
        used = std::max(used, next == 0 ? remembered : next);
    }
};

}  // namespace

Answer distance(const Body& a, const Body& b) {
    Separations along(a, b);
    for (const auto& t : a.triangles) along.offer(t.normal);
    for (const auto& t : b.triangles) along.offer(Real(-1) * t.normal);
    const std::vector<Vec> of_a = edge_directions(a), of_b = edge_directions(b);
    for (Vec u : of_a)
        for (Vec v : of_b) {
            if (along.best > along.tie) break;  // apart: the nearest features tell
            Vec n = cross(u, v);
            Real length = norm(n);
            if (!(length > 1e-12L)) continue;
            n = (1 / length) * n;
            along.offer(n);
            along.offer(Real(-1) * n);
        }
    const auto& candidates = along.candidates;
    Answer answer{-1e300L, {0, 1, 0}, -1e300L};
    for (const auto& [separation, n] : candidates)
        if (separation > answer.distance) answer.distance = separation, answer.normal = n;
    for (const auto& [separation, n] : candidates)
        if (dot(n, answer.normal) < std::cos(3.14159265L / 180))
            answer.runner_up = std::max(answer.runner_up, separation);
    // A flat difference never separates by more than rounding, though the bodies may be apart within its plane.
    if (candidates.empty() || answer.distance > -1e-15L * (norm(a.corners[0]) + norm(b.corners[0]))) {
        Vec d = shortest(a, b);
        answer.distance = norm(d);
        if (answer.distance > 0) answer.normal = (1 / answer.distance) * d;
        answer.runner_up = -1e300L;
    }
    return answer;
}

Real outside(const Body& body, Vec p) {
    if (body.triangles.size() >= 4) {
        bool inside = true;
        for (const auto& t : body.triangles) inside = inside && dot(t.normal, p - body.corners[t.corner[0]]) <= 0;
        if (inside) return 0;
    }
    return norm(shortest(make_points({p}), body));
}

Real signed_distance(const Tapered& shape, Vec p) {
    // In the half plane through the axis: x from the axis, y along it.
    Real x = std::sqrt(p.x * p.x + p.z * p.z), y = p.y, h = shape.half_height;
    Real r0 = shape.bottom_radius, r1 = shape.top_radius;
    if (shape.balls) {
        Real length = 2 * h, sine = (r0 - r1) / length;
        if (sine >= 1) return std::hypot(x, y + h) - r0;  // one ball holds the other
        if (sine <= -1) return std::hypot(x, y - h) - r1;
        Real cosine = std::sqrt(1 - sine * sine);
        Real along = (y + h) * cosine - x * sine;  // along the slanted side from the bottom ball's tangent point
        if (along <= 0) return std::hypot(x, y + h) - r0;
        if (along >= length * cosine) return std::hypot(x, y - h) - r1;
        return x * cosine + (y + h) * sine - r0;
    }
    auto to_segment = [&](Real ax, Real ay, Real bx, Real by) {
        Real dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy;
        Real t = squared > 0 ? clamp_unit(((x - ax) * dx + (y - ay) * dy) / squared) : 0;
        return std::hypot(x - ax - t * dx, y - ay - t * dy);
    };
    Real nearest = std::min({to_segment(0, -h, r0, -h), to_segment(0, h, r1, h), to_segment(r0, -h, r1, h)});
    bool inside = y >= -h && y <= h && x * 2 * h <= r0 * (h - y) + r1 * (y + h);
    return inside ? -nearest : nearest;
}

Real support(const Tapered& shape, Vec n) {
    Real spread = shape.balls ? norm(n) : std::sqrt(n.x * n.x + n.z * n.z);
    return std::max(shape.bottom_radius * spread - shape.half_height * n.y,
                    shape.top_radius * spread + shape.half_height * n.y);
}

Real segment_distance(Vec p, Vec u, Vec q, Vec v) {
    Pair pair;
    offer_segments(pair, p - u, 2 * u, q - v, 2 * v);
    return std::sqrt(pair.squared);
}

}  // namespace oracle
