// Short ways to collide two shapes in a test.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "collision/narrow_phase.h"
#include "lendulet/shapes.h"

namespace pairs {

using namespace lendulet;

inline const Quat identity{};

// A shape with its geometry; keeps what the geometry points into.
struct Solid {
    Shape shape;
    Geometry geometry;
    explicit Solid(Shape s) : shape(std::move(s)), geometry(make_geometry(shape).value()) {}
};

struct Placed {
    const Solid& solid;
    Quat rotation;
};

inline CollidePair pair_of(const Placed& a, const Placed& b, Vec3 offset, float margin) {
    return {&a.solid.geometry, &b.solid.geometry, a.rotation, b.rotation, offset, margin};
}

inline std::vector<Manifold> manifolds(const CollidePair& pair) {
    PairCache cache;
    std::vector<Manifold> out(max_mesh_manifolds);
    out.resize(static_cast<size_t>(collide(pair, cache, {}, out.data(), max_mesh_manifolds)));
    return out;
}

// The only manifold of a pair; an empty one where there is none.
inline Manifold manifold(const CollidePair& pair) {
    std::vector<Manifold> all = manifolds(pair);
    EXPECT_LE(all.size(), 1u);
    return all.empty() ? Manifold{} : all[0];
}

inline float deepest(const Manifold& m) {
    float d = m.points[0].separation;
    for (int i = 1; i < m.count; ++i) d = minimum(d, m.points[i].separation);
    return d;
}

inline void expect_near(Vec3 a, Vec3 b, float tolerance, const char* what = "") {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

inline void expect_sound(const Manifold& m, float margin) {
    ASSERT_TRUE(finite(m.normal));
    EXPECT_NEAR(length(m.normal), 1.0f, 1e-5f);
    ASSERT_GE(m.count, 1);
    ASSERT_LE(m.count, 4);
    EXPECT_GE(m.follow, 0.0f);
    EXPECT_LE(m.follow, 1.0f);
    EXPECT_GE(m.radius_a, 0.0f);
    EXPECT_GE(m.radius_b, 0.0f);
    for (int i = 0; i < m.count; ++i) {
        EXPECT_TRUE(finite(m.points[i].position));
        EXPECT_LE(m.points[i].separation, margin);
        for (int k = 0; k < i; ++k) EXPECT_NE(m.points[i].id, m.points[k].id);
    }
}

struct Random {
    std::mt19937 engine;
    explicit Random(unsigned seed) : engine(seed) {}
    float in(float lo, float hi) { return lo + (hi - lo) * (static_cast<float>(engine() >> 8) / 16777216.0f); }
    Vec3 vector(float lo, float hi) {
        float x = in(lo, hi), y = in(lo, hi), z = in(lo, hi);
        return {x, y, z};
    }
    Vec3 direction() { return normalize(vector(-1.0f, 1.0f)); }
    Quat rotation() {
        float x = in(-1, 1), y = in(-1, 1), z = in(-1, 1), w = in(-1, 1);
        return normalize(Quat{x, y, z, w + 1e-3f});
    }
};

}  // namespace pairs
