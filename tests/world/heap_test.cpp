// Heaps of long and thin bodies come to rest: bodies that lie on few points must not turn from one to another for ever.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "world/support.h"

namespace lendulet::test {
namespace {

// `count` bodies, `reach` long from the middle, thrown one above the other into a yard that is 2.4 times as wide as
// they are long.
struct Heap {
    World world;
    std::vector<BodyId> bodies;
};
Heap throw_heap(const Shape& shape, float reach, int count, unsigned seed, float rolling_friction) {
    World world = WorldBuilder{}.gravity({0.0f, -10.0f, 0.0f}).friction(0.6f).build().value();
    const float inner = 2.4f * reach, height = 0.5f * static_cast<float>(count);
    world.add_static_body({.shape = Plane{}}).value();
    for (float side : {-1.0f, 1.0f}) {
        const float at = side * (inner + 1.0f);
        world.add_static_body({.shape = Box{{1.0f, height, inner + 2.0f}}, .position = {at, 0.0f, 0.0f}}).value();
        world.add_static_body({.shape = Box{{inner, height, 1.0f}}, .position = {0.0f, 0.0f, at}}).value();
    }
    std::mt19937 random(seed);
    auto unit = [&] { return static_cast<float>(random() >> 8) * (2.0f / 16777216.0f) - 1.0f; };
    std::vector<BodyId> bodies;
    for (int i = 0; i < count; ++i) {
        const Position at{reach * unit(), 1.0f + 0.4f * static_cast<float>(i), reach * unit()};
        const Quat turn = normalize(Quat{unit(), unit(), unit(), unit() + 1.5f});
        bodies.push_back(world
                             .add_rigid_body({.shape = shape,
                                              .position = at,
                                              .orientation = turn,
                                              .density = 100.0f,
                                              .friction = 0.6f,
                                              .rolling_friction = rolling_friction})
                             .value());
    }
    return {std::move(world), std::move(bodies)};
}

// How many still move after `seconds`.
int awake_after(const Shape& shape, float reach, int count, int seconds, float rolling_friction = 0.0f) {
    Heap heap = throw_heap(shape, reach, count, 7, rolling_friction);
    run(heap.world, 60 * seconds);
    return static_cast<int>(
        std::count_if(heap.bodies.begin(), heap.bodies.end(), [&](BodyId id) { return !heap.world.get(id).asleep(); }));
}

TEST(Heap, PlanksComeToRest) { EXPECT_EQ(awake_after(Box{{1.0f, 0.05f, 0.3f}}, 1.0f, 60, 20), 0); }

TEST(Heap, PlatesComeToRest) { EXPECT_EQ(awake_after(Box{{0.5f, 0.03f, 0.5f}}, 0.5f, 60, 20), 0); }

TEST(Heap, SticksComeToRest) { EXPECT_EQ(awake_after(Box{{1.0f, 0.06f, 0.06f}}, 1.0f, 60, 20), 0); }

TEST(Heap, SmallTilesComeToRest) { EXPECT_EQ(awake_after(Box{{0.1f, 0.01f, 0.05f}}, 0.1f, 40, 20), 0); }

TEST(Heap, CoinsThatResistRollingComeToRest) { EXPECT_EQ(awake_after(Cylinder{0.06f, 0.5f}, 0.5f, 60, 20, 0.01f), 0); }

// Without rolling friction a coin that leans on two rims swings on them like a pendulum and loses next to nothing. Few
// do, and those below them lie still: of 600 in ten heaps, at most one in fifty moves.
TEST(Heap, FewCoinsRock) {
    int moving = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Heap heap = throw_heap(Cylinder{0.06f, 0.5f}, 0.5f, 60, seed, 0.0f);
        run(heap.world, 20 * 60);
        for (BodyId id : heap.bodies) {
            const auto body = heap.world.get(id);
            moving += length(body.velocity()) + 0.5f * length(body.angular_velocity()) > 0.01f;
        }
    }
    EXPECT_LE(moving, 12);
}

TEST(Heap, HullsOfManyCornersComeToRest) {
    std::vector<Vec3> points;
    for (int k = 0; k < 16; ++k) {
        const float angle = 0.125f * pi * static_cast<float>(k);
        for (float y : {-0.06f, 0.06f}) points.push_back({0.5f * std::cos(angle), y, 0.5f * std::sin(angle)});
    }
    EXPECT_EQ(awake_after(ConvexHull::from_points(points).value(), 0.5f, 60, 20), 0);
}

}  // namespace
}  // namespace lendulet::test
