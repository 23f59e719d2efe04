#include "character/outline.h"

namespace lendulet {
namespace {

Outline round_bar(float half_height, float bottom, float top, float rounding) {
    const float wide = maximum(bottom, top);
    return {-half_height - rounding, wide + rounding, wide + rounding,
            length(Vec3{half_height, wide, 0.0f}) + rounding};
}

struct Measure {
    Outline operator()(const Sphere& s) const { return {-s.radius, s.radius, s.radius, s.radius}; }
    Outline operator()(const Capsule& s) const {
        return {-s.half_height - s.radius, s.radius, s.radius, s.half_height + s.radius};
    }
    Outline operator()(const TaperedCapsule& s) const {
        const float wide = maximum(s.bottom_radius, s.top_radius);
        const float lowest = minimum(-s.half_height - s.bottom_radius, s.half_height - s.top_radius);
        return {lowest, wide, wide, s.half_height + wide};
    }
    Outline operator()(const Box& s) const {
        const Vec3 h = s.half_extents;
        return {-h.y - s.rounding, minimum(h.x, h.z) + s.rounding, length(Vec3{h.x, 0.0f, h.z}) + s.rounding,
                length(h) + s.rounding};
    }
    Outline operator()(const Cylinder& s) const { return round_bar(s.half_height, s.radius, s.radius, s.rounding); }
    Outline operator()(const TaperedCylinder& s) const {
        return round_bar(s.half_height, s.bottom_radius, s.top_radius, s.rounding);
    }
    Outline operator()(const Cone& s) const { return round_bar(s.half_height, s.radius, 0.0f, s.rounding); }
    Outline operator()(const ConvexHull& s) const {
        Vec3 lower = s.vertices()[0], upper = lower;
        float reach = 0.0f, across = 0.0f;
        for (Vec3 v : s.vertices()) {
            lower = minimum(lower, v), upper = maximum(upper, v);
            reach = maximum(reach, length(v));
            across = maximum(across, length(Vec3{v.x, 0.0f, v.z}));
        }
        const Vec3 half = 0.5f * (upper - lower);
        return {lower.y - s.rounding(), minimum(half.x, half.z) + s.rounding(), across + s.rounding(),
                reach + s.rounding()};
    }
    template <class Other>
    Outline operator()(const Other&) const {
        return {};
    }
};

struct Grow {
    float by;
    Shape operator()(const Sphere& s) const { return Sphere{s.radius + by}; }
    Shape operator()(const Capsule& s) const { return Capsule{s.half_height, s.radius + by}; }
    Shape operator()(const TaperedCapsule& s) const {
        return TaperedCapsule{s.half_height, s.bottom_radius + by, s.top_radius + by};
    }
    Shape operator()(const ConvexHull& s) const {
        Result<ConvexHull> hull = ConvexHull::from_points(s.vertices(), s.rounding() + by);
        return hull ? Shape(hull.value()) : Shape(s);
    }
    template <class Rounded>
    Shape operator()(Rounded s) const {
        if constexpr (requires { s.rounding += by; }) s.rounding += by;
        return s;
    }
};

}  // namespace

Outline outline_of(const Shape& shape) { return std::visit(Measure{}, shape); }
Shape grown(const Shape& shape, float by) { return std::visit(Grow{by}, shape); }

}  // namespace lendulet
