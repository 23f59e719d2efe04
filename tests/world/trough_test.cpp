// Balls in tracks of many triangles. What a polygon takes is known: each of its corners, or each step where a step goes
// over several, turns the way by some angle, and what was normal to the new way is lost without restitution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lendulet/lendulet.h"
#include "world/support.h"

namespace lendulet {
namespace {

using test::dt;

// Of the circle about (0, radius) from one angle to the other, counted from its lowest point.
TriangleMesh track(float radius, float from, float to, int facets) {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> triangles;
    for (int k = 0; k <= facets; ++k) {
        const SinCos a = sin_cos(from + (to - from) * static_cast<float>(k) / static_cast<float>(facets));
        for (float z : {-1.0f, 1.0f}) vertices.push_back({radius * a.sin, radius * (1.0f - a.cos), z});
        if (k == facets) break;
        const auto q = static_cast<uint32_t>(2 * k);
        for (uint32_t i : {q, q + 1, q + 2, q + 2, q + 1, q + 3}) triangles.push_back(i);
    }
    return TriangleMesh::from_triangles(vertices, triangles).value();
}

// Energies of a ball that swings in a trough of 1 m for ten seconds, in parts of the first: the last and the greatest.
struct Swing {
    double last, most;
};
Swing swing(int facets, float friction, float step) {
    constexpr float radius = 1.0f, r = 0.1f, angle = 0.3f;
    World world = WorldBuilder{}.sleep(false).build().value();
    world.add_static_body({.shape = track(radius, -1.0f, 1.0f, facets), .friction = friction}).value();
    const SinCos a = sin_cos(angle);
    const BodyId ball = world
                            .add_rigid_body({.shape = Sphere{r},
                                             .position = {(radius - r) * a.sin, radius - (radius - r) * a.cos, 0.0f},
                                             .friction = friction})
                            .value();
    const double rest = static_cast<double>(world.get(ball).mass()) * 9.81 * r;
    auto energy = [&] { return world.kinetic_energy() + world.potential_energy() - rest; };
    const double first = energy();
    Swing s{1.0, 1.0};
    for (int i = 0; i < static_cast<int>(10.0f / step); ++i) {
        world.update(step).value();
        s.last = energy() / first;
        s.most = std::max(s.most, s.last);
    }
    return s;
}

TEST(Troughs, ABallDoesNotSwingHigher) {
    for (int facets : {200, 1000})
        for (float friction : {0.0f, 0.5f})
            for (float step : {dt, 0.25f * dt}) {
                const Swing s = swing(facets, friction, step);
                EXPECT_GT(s.last, 0.9) << facets << " " << friction << " " << step;
                EXPECT_LT(s.most, facets == 200 ? 1.01 : 1.08) << facets << " " << friction << " " << step;
            }
}

// Without gravity and friction, through three quarters of a loop: facets of 0.19 m, of which a step goes over less than
// one, take cos^2 of the angle between them each.
TEST(Troughs, ALoopTakesWhatItsCornersTake) {
    constexpr float radius = 2.0f, r = 0.2f, turn = 2.0f * pi / 60.0f;
    World world = WorldBuilder{}.no_gravity().sleep(false).build().value();
    const TriangleMesh loop = track(radius / std::cos(0.5f * turn), -0.5f * turn, 44.5f * turn, 45);
    const float low = radius / std::cos(0.5f * turn) - radius;  // the facets' middles are `radius` from the axis
    world.add_static_body({.shape = loop, .position = {0.0f, -low, 0.0f}, .friction = 0.0f}).value();
    const BodyId ball =
        world
            .add_rigid_body(
                {.shape = Sphere{r}, .position = {0.0f, r, 0.0f}, .velocity = {12.0f, 0.0f, 0.0f}, .friction = 0.0f})
            .value();
    int corners = 0;
    Vec3 way{1.0f, 0.0f, 0.0f};
    for (int i = 0; i < 60; ++i) {
        world.update(dt).value();
        const Vec3 v = world.get(ball).velocity(), now = normalize(v);
        corners += static_cast<int>(std::lround(std::acos(static_cast<double>(std::min(dot(way, now), 1.0f))) / turn));
        way = now;
        EXPECT_NEAR(length(v), 12.0f * std::pow(std::cos(turn), static_cast<float>(corners)), 0.02f) << i;
    }
    EXPECT_GT(corners, 40);
}

}  // namespace
}  // namespace lendulet
