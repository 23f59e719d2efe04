// Bodies with restitution that rest on each other stand, and crowds of them come to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "world/support.h"

namespace lendulet::test {
namespace {

World world_with_friction(int workers = 1, int width = 0) {
    WorldBuilder builder;
    builder.gravity({0.0f, -10.0f, 0.0f}).friction(0.6f).sleep(false).workers(workers).width(width);
    return builder.build().value();
}

// How far a body of the list has gone from where it was at most, m.
float farthest(const World& world, const std::vector<BodyId>& bodies, const std::vector<Vec3>& places) {
    float most = 0.0f;
    for (size_t i = 0; i < bodies.size(); ++i)
        most = std::max(most, length(from_origin(world.get(bodies[i]).position()) - places[i]));
    return most;
}

// Until the solver knows who carries whom, bodies move against each other by more than what bounces: no blow.
TEST(Bouncy, PyramidsStand) {
    for (const auto& [base, restitution] : {std::pair{24, 0.2f}, {24, 0.6f}, {100, 0.2f}}) {
        World world = world_with_friction();
        add_floor(world, 80.0f);
        std::vector<BodyId> bodies;
        std::vector<Vec3> places;
        for (int row = 0; row < base; ++row)
            for (int i = 0; i < base - row; ++i) {
                const auto x = static_cast<float>(i), y = static_cast<float>(row);
                places.push_back({x + 0.5f * y - 0.5f * static_cast<float>(base), 0.5f + y, 0.0f});
                bodies.push_back(
                    world.add_rigid_body({.shape = Box{}, .position = at(places.back()), .restitution = restitution})
                        .value());
            }
        run(world, base > 24 ? 90 : 300);
        EXPECT_LT(farthest(world, bodies, places), base > 24 ? 0.1f : 0.02f) << base << " " << restitution;
    }
}

TEST(Bouncy, StacksStand) {
    for (float restitution : {0.3f, 0.9f})
        for (int height : {5, 20}) {
            World world = world_with_friction();
            add_floor(world);
            std::vector<BodyId> stack;
            std::vector<Vec3> places;
            for (int i = 0; i < height; ++i) {
                places.push_back({0.0f, 0.5f + static_cast<float>(i), 0.0f});
                stack.push_back(
                    world.add_rigid_body({.shape = Box{}, .position = at(places.back()), .restitution = restitution})
                        .value());
            }
            run(world, 600);
            EXPECT_LT(farthest(world, stack, places), 0.01f) << restitution << " " << height;
        }
}

// Boxes that fall into a yard.
World bouncy_heap(float restitution, std::vector<BodyId>& bodies, int workers = 1, int width = 0) {
    World world = world_with_friction(workers, width);
    world.add_static_body({.shape = Plane{}}).value();
    for (float sign : {-1.0f, 1.0f}) {
        world.add_static_body({.shape = Box{{1.0f, 20.0f, 6.0f}}, .position = {5.0f * sign, 0.0f, 0.0f}}).value();
        world.add_static_body({.shape = Box{{4.0f, 20.0f, 1.0f}}, .position = {0.0f, 0.0f, 5.0f * sign}}).value();
    }
    for (int i = 0; i < 300; ++i) {
        const auto x = static_cast<float>(i % 5), z = static_cast<float>(i / 5 % 5), y = static_cast<float>(i / 25);
        const Vec3 place{1.5f * x - 3.0f, 1.0f + 1.5f * y, 1.5f * z - 3.0f};
        const Quat turn =
            normalize(Quat{0.1f * static_cast<float>(i % 7), 0.2f, -0.1f * static_cast<float>(i % 5), 1.0f});
        bodies.push_back(world
                             .add_rigid_body({.shape = Box{{0.4f, 0.4f, 0.4f}},
                                              .position = at(place),
                                              .orientation = turn,
                                              .restitution = restitution})
                             .value());
    }
    return world;
}

TEST(Bouncy, HeapsComeToRestWithoutSinking) {
    for (float restitution : {0.2f, 0.6f}) {
        std::vector<BodyId> bodies;
        World world = bouncy_heap(restitution, bodies);
        double before = world.kinetic_energy() + world.potential_energy();
        const double start = before;
        float deepest = 0.0f, sum = 0.0f;
        for (int i = 0; i < 600; ++i) {
            run(world, 1);
            const double now = world.kinetic_energy() + world.potential_energy();
            // What was pressed into each other comes apart again: in sixteen such heaps by 0.006 of it at most.
            EXPECT_LT(now, before + 1e-2 * start) << restitution << " " << i;
            before = now;
            deepest = std::max(deepest, world.statistics().max_penetration);
            sum += world.statistics().max_penetration;
        }
        // Bodies arrive at 18 m/s: 0.3 m a step.
        EXPECT_LT(deepest, 0.3f) << restitution;
        EXPECT_LT(sum / 600.0f, 0.01f) << restitution;
        EXPECT_LT(world.statistics().max_penetration, 4e-3f) << restitution;
        EXPECT_LT(world.kinetic_energy(), 1e-5 * start) << restitution;
    }
}

TEST(Bouncy, SameBitsForWorkersAndWidths) {
    auto hash = [](int workers, int width) {
        std::vector<BodyId> bodies;
        World world = bouncy_heap(0.4f, bodies, workers, width);
        run(world, 120);
        return world.hash();
    };
    const uint64_t expected = hash(1, 1);
    for (int width : {4, 8, 16}) EXPECT_EQ(hash(width == 8 ? 1 : 3, width), expected) << width;
}

// Blows are not followed from body to body in a crowd; elsewhere they are, whatever goes on beside.
TEST(Bouncy, ACrowdFarAwayChangesNothing) {
    auto after = [](bool crowd) {
        std::vector<BodyId> bodies;
        World world = crowd ? bouncy_heap(0.9f, bodies) : world_with_friction();
        if (!crowd) world.add_static_body({.shape = Plane{}}).value();
        std::vector<BodyId> row;
        for (int i = 0; i < 5; ++i)
            row.push_back(world
                              .add_rigid_body({.shape = Sphere{0.5f},
                                               .position = {50.0f + static_cast<float>(i), 3.0f, 0.0f},
                                               .restitution = 0.9f})
                              .value());
        world.get(row[0]).set_velocity({3.0f, 0.0f, 0.0f}).value();
        run(world, 90);
        std::vector<Vec3> places;
        for (BodyId id : row) places.push_back(from_origin(world.get(id).position()));
        return places;
    };
    const std::vector<Vec3> alone = after(false), beside = after(true);
    for (size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(length_squared(alone[i] - beside[i]), 0.0f) << i;
    EXPECT_GT(alone[4].x, 54.5f);
}

}  // namespace
}  // namespace lendulet::test
