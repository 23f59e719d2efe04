#include "apps/picture/solids.h"

namespace picture {

using namespace lendulet;

namespace {

constexpr int sides = 32;     // of a circle
constexpr int cap_rings = 8;  // from the rim of a round cap to its pole
constexpr float plane_half_size = 200.0f;

// A point of the outline that is turned about the y axis: height, radius and the normal there.
struct Outline {
    float y, radius;
    float normal_y, normal_radius;
};

struct Surface {
    std::vector<Triangle> triangles;

    void add(Vec3 a, Vec3 b, Vec3 c, Vec3 na, Vec3 nb, Vec3 nc) { triangles.push_back({{a, b, c}, {na, nb, nc}}); }
    void add_flat(Vec3 a, Vec3 b, Vec3 c, Vec3 n) { add(a, b, c, n, n, n); }
    void add_quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 n) {
        add_flat(a, b, c, n);
        add_flat(a, c, d, n);
    }

    void turn(const Outline& lower, const Outline& upper) {
        for (int i = 0; i < sides; ++i) {
            SinCos s = sin_cos(2.0f * pi * static_cast<float>(i) / sides);
            SinCos t = sin_cos(2.0f * pi * static_cast<float>(i + 1) / sides);
            auto point = [](const Outline& o, SinCos a) { return Vec3{o.radius * a.cos, o.y, o.radius * a.sin}; };
            auto normal = [](const Outline& o, SinCos a) {
                return Vec3{o.normal_radius * a.cos, o.normal_y, o.normal_radius * a.sin};
            };
            add(point(lower, s), point(upper, s), point(upper, t), normal(lower, s), normal(upper, s),
                normal(upper, t));
            add(point(lower, s), point(upper, t), point(lower, t), normal(lower, s), normal(upper, t),
                normal(lower, t));
        }
    }
    void turn(const std::vector<Outline>& outline) {
        for (size_t i = 1; i < outline.size(); ++i) turn(outline[i - 1], outline[i]);
    }
};

// Two balls on the y axis and the cone that touches both: capsules and, with one ball, spheres. The cone meets each
// ball where the normal's height is (bottom - top) / distance, since the normals of both balls agree there.
void add_swept_balls(Surface& surface, float half_height, float bottom, float top) {
    float sine = half_height > 0.0f ? clamp((bottom - top) / (2.0f * half_height), -1.0f, 1.0f) : 0.0f;
    std::vector<Outline> outline;
    auto add_arc = [&](float from, float to, float centre, float radius) {  // by the sine of the latitude
        for (int i = 0; i <= cap_rings; ++i) {
            float t = static_cast<float>(i) / cap_rings;
            float turn = t * t * (3.0f - 2.0f * t);  // finer near the poles
            float y = from + (to - from) * turn;
            float r = square_root(maximum(1.0f - y * y, 0.0f));
            outline.push_back({centre + radius * y, radius * r, y, r});
        }
    };
    add_arc(-1.0f, sine, -half_height, bottom);
    add_arc(sine, 1.0f, half_height, top);
    surface.turn(outline);
}

void add_truncated_cone(Surface& surface, float half_height, float bottom, float top) {
    Vec3 n = normalize(Vec3{2.0f * half_height, bottom - top, 0.0f});
    surface.turn({-half_height, 0.0f, -1.0f, 0.0f}, {-half_height, bottom, -1.0f, 0.0f});
    surface.turn({-half_height, bottom, n.y, n.x}, {half_height, top, n.y, n.x});
    surface.turn({half_height, top, 1.0f, 0.0f}, {half_height, 0.0f, 1.0f, 0.0f});
}

void add_box(Surface& surface, Vec3 half) {
    for (int axis = 0; axis < 3; ++axis) {
        for (float side : {-1.0f, 1.0f}) {
            Vec3 n{}, u{}, v{};
            set_component(n, axis, side);
            set_component(u, (axis + 1) % 3, 1.0f);
            set_component(v, (axis + 2) % 3, 1.0f);
            Vec3 c = multiply(n, half), a = multiply(u, half), b = multiply(v, half);
            surface.add_quad(c - a - b, c + a - b, c + a + b, c - a + b, n);
        }
    }
}

// Every triangle of corners that leaves all corners on one side lies on the hull. Slow for many corners, but
// independent of how the engine built its hull.
void add_hull(Surface& surface, std::span<const Vec3> corners) {
    int count = static_cast<int>(corners.size());
    for (int i = 0; i < count; ++i) {
        for (int j = i + 1; j < count; ++j) {
            for (int k = j + 1; k < count; ++k) {
                Vec3 normal = normalize(cross(corners[j] - corners[i], corners[k] - corners[i]), {});
                float above = 0.0f, below = 0.0f;
                for (Vec3 p : corners) {
                    above = maximum(above, dot(normal, p - corners[i]));
                    below = minimum(below, dot(normal, p - corners[i]));
                }
                float flat = 1e-4f * (above - below);
                if (above <= flat) surface.add_flat(corners[i], corners[j], corners[k], normal);
                else if (-below <= flat) surface.add_flat(corners[i], corners[j], corners[k], -normal);
            }
        }
    }
}

struct AddShape {
    Surface& surface;

    void operator()(const Sphere& s) { add_swept_balls(surface, 0.0f, s.radius, s.radius); }
    void operator()(const Capsule& s) { add_swept_balls(surface, s.half_height, s.radius, s.radius); }
    void operator()(const TaperedCapsule& s) { add_swept_balls(surface, s.half_height, s.bottom_radius, s.top_radius); }
    void operator()(const Box& s) { add_box(surface, s.half_extents + Vec3{s.rounding, s.rounding, s.rounding}); }
    void operator()(const Cylinder& s) {
        add_truncated_cone(surface, s.half_height + s.rounding, s.radius + s.rounding, s.radius + s.rounding);
    }
    void operator()(const TaperedCylinder& s) {
        add_truncated_cone(surface, s.half_height + s.rounding, s.bottom_radius + s.rounding,
                           s.top_radius + s.rounding);
    }
    void operator()(const Cone& s) {
        add_truncated_cone(surface, s.half_height + s.rounding, s.radius + s.rounding, s.rounding);
    }
    void operator()(const ConvexHull& s) { add_hull(surface, s.vertices()); }
    void operator()(const Plane& s) {
        Vec3 n = normalize(s.normal), u = perpendicular(n), v = cross(n, u), c = s.offset * n;
        Vec3 a = plane_half_size * u, b = plane_half_size * v;
        surface.add_quad(c - a - b, c + a - b, c + a + b, c - a + b, n);
    }
    void operator()(const TriangleMesh&) {}
    void operator()(const HeightField&) {}
};

}  // namespace

std::vector<Triangle> triangles_of(const Shape& shape) {
    Surface surface;
    std::visit(AddShape{surface}, shape);
    return std::move(surface.triangles);
}

}  // namespace picture
