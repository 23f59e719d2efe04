// What every hull must satisfy, checked in double precision and by topology; and random inputs for geometry tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "geometry/hull.h"

namespace lendulet {

inline Vec3 random_vector(std::mt19937& random, float range = 1.0f) {
    std::uniform_real_distribution<float> value(-range, range);
    float x = value(random), y = value(random), z = value(random);
    return {x, y, z};
}

inline Vec3 random_unit(std::mt19937& random) {
    for (;;) {
        Vec3 v = random_vector(random);
        float squared = length_squared(v);
        if (squared > 0.01f && squared < 1.0f) return normalize(v);
    }
}

inline Quat random_rotation(std::mt19937& random) {
    return rotation_about(random_unit(random), std::uniform_real_distribution<float>(-pi, pi)(random));
}

inline double dot_double(Vec3 a, Vec3 b) { return double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z; }

inline float size_of(std::span<const Vec3> points) {
    Vec3 lower = points[0], upper = points[0];
    for (Vec3 p : points) lower = minimum(lower, p), upper = maximum(upper, p);
    return max_component(upper - lower);
}

// A sentence about what is wrong with the hull's connections, or nothing.
inline std::string topology_fault(const HullData& hull) {
    auto edges = static_cast<uint32_t>(hull.edges.size());
    size_t expected = 0;
    std::vector<uint32_t> degree(hull.vertices.size(), 0);
    for (uint32_t f = 0; f < hull.faces.size(); ++f) {
        const HullFace& face = hull.faces[f];
        if (face.first_edge != expected) return "half edges of a face are not consecutive";
        if (face.edge_count < 3) return "a face has fewer than three edges";
        expected += face.edge_count;
        std::set<uint32_t> seen;
        for (uint32_t k = 0; k < face.edge_count; ++k) {
            uint32_t e = face.first_edge + k, after = face.first_edge + (k + 1) % face.edge_count;
            const HullEdge& edge = hull.edges[e];
            if (edge.face != f) return "a half edge names another face";
            if (edge.origin >= hull.vertices.size() || edge.twin >= edges) return "an index is out of range";
            const HullEdge& twin = hull.edges[edge.twin];
            if (twin.twin != e || twin.face == f) return "twins do not match";
            if (twin.origin != hull.edges[after].origin) return "a twin runs between other corners";
            if (!seen.insert(edge.origin).second) return "a face visits a corner twice";
            ++degree[edge.origin];
        }
    }
    if (expected != edges) return "half edges belong to no face";
    for (size_t v = 0; v < degree.size(); ++v) {
        if (degree[v] < 3) return "a corner has fewer than three faces";
        if (hull.edges[hull.vertex_edge[v]].origin != v) return "vertex_edge leads elsewhere";
    }
    if (hull.vertices.size() + hull.faces.size() != edges / 2 + 2) return "Euler's formula does not hold";
    return {};
}

// The largest height of a point above a face, depth of a corner below its own face, and depth of a corner behind the
// line between its neighbours in a face's outline, in metres.
struct HullErrors {
    double outside = 0.0, uneven = 0.0, dent = 0.0;
};
inline HullErrors hull_errors(const HullData& hull, std::span<const Vec3> points) {
    HullErrors r;
    for (const HullFace& face : hull.faces) {
        for (Vec3 p : points) r.outside = std::max(r.outside, dot_double(face.normal, p) - face.offset);
        for (Vec3 p : hull.vertices) r.outside = std::max(r.outside, dot_double(face.normal, p) - face.offset);
        for (uint32_t k = 0; k < face.edge_count; ++k) {
            auto corner = [&](uint32_t i) {
                return hull.vertices[hull.edges[face.first_edge + (k + i) % face.edge_count].origin];
            };
            Vec3 a = corner(0), b = corner(1), c = corner(2);
            Vec3 inward = cross(face.normal, normalize(c - a));
            r.dent = std::max(r.dent, dot_double(inward, b - a));
            r.uneven = std::max(r.uneven, face.offset - dot_double(face.normal, b));
        }
    }
    return r;
}

inline void expect_valid_hull(const HullData& hull, std::span<const Vec3> points, double relative = 1e-5) {
    EXPECT_EQ(topology_fault(hull), "");
    double size = size_of(points), reach = 0.0;
    for (Vec3 p : points) reach = std::max<double>(reach, max_component(absolute(p)));
    HullErrors errors = hull_errors(hull, points);
    EXPECT_LT(errors.outside, relative * size);
    EXPECT_LT(errors.dent, relative * size);
    EXPECT_LT(errors.uneven, relative * size + 5e-7 * reach);  // planes are given in single precision
    EXPECT_GT(hull.volume, 0.0f);
    EXPECT_EQ(static_cast<size_t>(hull.dropped_points), points.size() - hull.vertices.size());
    ASSERT_EQ(hull.xs.size() % 16, 0u);
    for (size_t i = 0; i < hull.xs.size(); ++i) {
        Vec3 v = hull.vertices[std::min(i, hull.vertices.size() - 1)];
        ASSERT_EQ((Vec3{hull.xs[i], hull.ys[i], hull.zs[i]}), v);
    }
}

}  // namespace lendulet
