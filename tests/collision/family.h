// One shape of every kind with the poses in which it rests on a floor, for tests over all pairs.
#pragma once

#include "pairs.h"

namespace pairs {

struct Kind {
    const char* name;
    Shape shape;
};

inline std::vector<Vec3> rock(unsigned seed, int count, float size) {
    Random random(seed);
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(size * random.direction());
    return points;
}

inline std::vector<Vec3> octagonal_prism(float radius, float half_height) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        SinCos a = sin_cos(0.25f * pi * static_cast<float>(i));
        for (float y : {-half_height, half_height}) points.push_back({radius * a.cos, y, radius * a.sin});
    }
    return points;
}

inline std::vector<Kind> every_kind() {
    return {{"sphere", Sphere{0.4f}},
            {"capsule", Capsule{0.4f, 0.2f}},
            {"tapered capsule", TaperedCapsule{0.4f, 0.3f, 0.15f}},
            {"box", Box{{0.3f, 0.4f, 0.5f}}},
            {"rounded box", Box{{0.3f, 0.2f, 0.4f}, 0.1f}},
            {"cylinder", Cylinder{0.3f, 0.4f}},
            {"rounded cylinder", Cylinder{0.3f, 0.3f, 0.1f}},
            {"tapered cylinder", TaperedCylinder{0.4f, 0.4f, 0.2f}},
            {"cone", Cone{0.4f, 0.3f}},
            {"rock", ConvexHull::from_points(rock(4, 24, 0.5f)).value()},
            {"rounded rock", ConvexHull::from_points(rock(9, 12, 0.4f), 0.1f).value()}};
}

// A pose in which a shape rests on a level floor: how it is turned, how high its origin is, and how many points it
// needs at least to rest.
struct Rest {
    const char* name;
    Shape shape;
    Quat turn;
    float height;
    int points;
    bool symmetric;  // the points lie evenly about the origin
};

inline std::vector<Rest> every_rest() {
    const Vec3 z{0.0f, 0.0f, 1.0f};
    const Quat upright{}, lying = rotation_about(z, 0.5f * pi);
    // A cone's side slopes by r / (2 h) from the axis, a tapered capsule's by (R - r) / (2 h).
    float cone_half_angle = arc_tangent2(0.3f, 0.8f);
    Quat on_side = rotation_about(z, 0.5f * pi + cone_half_angle);
    float cone_height = 0.4f * sin_cos(cone_half_angle).sin;  // from the origin, half way up the axis, to the side
    float taper = 0.15f / 0.8f, lean = arc_tangent2(taper, std::sqrt(1.0f - taper * taper));
    Quat on_taper = rotation_about(z, 0.5f * pi + lean);
    ConvexHull prism = ConvexHull::from_points(octagonal_prism(0.5f, 0.3f)).value();
    return {{"sphere", Sphere{0.4f}, upright, 0.4f, 1, true},
            {"capsule lying", Capsule{0.4f, 0.2f}, lying, 0.2f, 2, true},
            {"capsule upright", Capsule{0.4f, 0.2f}, upright, 0.6f, 1, true},
            {"tapered capsule lying", TaperedCapsule{0.4f, 0.3f, 0.15f}, on_taper, 0.225f, 2, false},
            {"box", Box{{0.3f, 0.4f, 0.5f}}, upright, 0.4f, 4, true},
            {"box on its side", Box{{0.3f, 0.4f, 0.5f}}, lying, 0.3f, 4, true},
            {"rounded box", Box{{0.3f, 0.2f, 0.4f}, 0.1f}, upright, 0.3f, 4, true},
            {"cylinder", Cylinder{0.3f, 0.4f}, upright, 0.3f, 4, true},
            {"cylinder lying", Cylinder{0.3f, 0.4f}, lying, 0.4f, 2, true},
            {"rounded cylinder", Cylinder{0.3f, 0.3f, 0.1f}, upright, 0.4f, 4, true},
            {"rounded cylinder lying", Cylinder{0.3f, 0.3f, 0.1f}, lying, 0.4f, 2, true},
            {"tapered cylinder", TaperedCylinder{0.4f, 0.4f, 0.2f}, upright, 0.4f, 4, true},
            {"tapered cylinder on its top", TaperedCylinder{0.4f, 0.4f, 0.2f}, rotation_about(z, pi), 0.4f, 4, true},
            {"cone", Cone{0.4f, 0.3f}, upright, 0.4f, 4, true},
            {"cone on its side", Cone{0.4f, 0.3f}, on_side, cone_height, 2, false},
            {"prism", prism, upright, 0.3f, 4, true},
            {"prism on its side", prism,
             rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi) * rotation_about({0.0f, 1.0f, 0.0f}, 0.125f * pi),
             0.5f * 0.92387953f, 4, true}};
}

// Distance of a point from a solid, 0 inside; relative to the solid's position, world axes.
inline float outside(const Placed& solid, Vec3 point) {
    static const Solid dot_shape(Sphere{1.0f});
    GjkCache cache;
    Vec3 local = rotate_inverse(solid.rotation, point);
    float d =
        distance({&solid.solid.geometry, &dot_shape.geometry, {local, {}}}, cache, SimplexSolver::half_space, 1e9f)
            .distance;
    return maximum(0.0f, d - solid.solid.geometry.rounding);
}

}  // namespace pairs
