// Queries to worlds: they agree with brute force over colliders, see the present, and obey their filters.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "scale.h"
#include "world/support.h"

namespace lendulet {
namespace {

using namespace test;

struct Random {
    uint32_t state;
    float in(float lo, float hi) {
        state = state * 1664525u + 1013904223u;
        return lo + (hi - lo) * static_cast<float>(state >> 8) / 16777216.0f;
    }
    Vec3 vector(float lo, float hi) {
        float x = in(lo, hi), y = in(lo, hi), z = in(lo, hi);
        return {x, y, z};
    }
    Quat rotation() { return normalize(Quat{in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1) + 0.001f}); }
};

// A pile of all kinds of shapes on waves, with a wall, a plane, a sweeping bar and a trigger.
World mixed_world(int workers = 1, BroadPhaseType type = BroadPhaseType::rtree_omt) {
    World world = WorldBuilder().workers(workers).broad_phase(type).build().value();
    world.add_static_body({.shape = wavy_ground(16, 12.0f, 0.2f), .user_data = 77}).value();
    world.add_static_body({.shape = Plane{{0.0f, 1.0f, 0.0f}, -3.0f}}).value();
    world.add_static_body({.shape = Box{{6.0f, 1.0f, 0.1f}}, .position = {0.0f, 1.0f, -5.0f}}).value();
    add_mixed_pile(world, 5);
    Random random{5};
    const Shape shapes[] = {Cylinder{0.3f, 0.4f}, TaperedCapsule{0.3f, 0.3f, 0.1f}, Cone{0.4f, 0.3f},
                            Box{{0.3f, 0.2f, 0.3f}, 0.1f}, TaperedCylinder{0.3f, 0.4f, 0.2f, 0.05f}};
    for (int i = 0; i < 25; ++i)
        world
            .add_rigid_body({.shape = shapes[i % 5],
                             .position = at(random.vector(-3.0f, 3.0f) + Vec3{0.0f, 9.0f, 0.0f}),
                             .orientation = random.rotation(),
                             .user_data = static_cast<uint64_t>(i)})
            .value();
    const ColliderDef bar[] = {{.shape = Capsule{2.0f, 0.1f}, .user_data = 5},
                               {.shape = Sphere{0.3f}, .local = {{0.0f, 2.0f, 0.0f}, {}}, .user_data = 6}};
    world
        .add_rigid_body({.position = {4.0f, 2.0f, 0.0f},
                         .angular_velocity = {0.0f, 0.0f, 1.0f},
                         .colliders = bar,
                         .kinematic = true})
        .value();
    const ColliderDef zone[] = {{.shape = Box{{2.0f, 2.0f, 2.0f}}, .is_trigger = true}};
    world.add_static_body({.position = {0.0f, 2.0f, 0.0f}, .colliders = zone}).value();
    return world;
}

Pose world_pose(StaticBodyRef body, int collider) {
    return Pose{body.position(), body.orientation()} * body.collider_pose(collider);
}

bool is_trigger_body(const World& world, BodyId id) { return id == world.body(world.body_count() - 1); }

// visit(body, collider id, shape where it stands) for every collider but the trigger, in the order of ids.
template <class Visit>
void for_each(const World& world, Visit&& visit) {
    for (int i = 0; i < world.body_count(); ++i) {
        if (is_trigger_body(world, world.body(i))) continue;
        StaticBodyRef body = world.get_static(world.body(i));
        for (int k = 0; k < body.collider_count(); ++k) {
            Shape shape = body.shape(k);
            if (auto* mesh = std::get_if<TriangleMesh>(&shape); mesh && body.type() == BodyType::dynamic) continue;
            visit(body, body.collider(k), PosedShape{shape, world_pose(body, k)});
        }
    }
}

Ray random_ray(Random& random) {
    Position from = at(random.vector(-8.0f, 8.0f) + Vec3{0.0f, 4.0f, 0.0f});
    return {from, at(random.vector(-5.0f, 5.0f)) - from, random.in(0.5f, 1.5f)};
}

// Of one world or of two that were built alike, whose handles differ in the number of the world alone.
bool same(const QueryHit& a, const QueryHit& b) {
    return a.hit == b.hit && a.body.index == b.body.index && a.collider.index == b.collider.index &&
           a.triangle == b.triangle && a.fraction == b.fraction && a.point == b.point && a.normal == b.normal &&
           a.started_inside == b.started_inside && a.user_data == b.user_data && a.body_user_data == b.body_user_data;
}

TEST(Queries, RaysAgreeWithBruteForce) {
    World world = mixed_world();
    Random random{1};
    int hits = 0;
    for (int step = 0; step < 6; ++step) {
        run(world, 20);
        for (int i = 0; i < scaled(120, 10); ++i) {
            Ray ray = random_ray(random);
            std::vector<std::pair<float, ColliderId>> expected;
            for_each(world, [&](StaticBodyRef, ColliderId id, const PosedShape& shape) {
                if (QueryHit h = cast_ray(shape, ray).value()) expected.push_back({h.fraction, id});
            });
            std::sort(expected.begin(), expected.end(), [](auto& a, auto& b) {
                return a.first != b.first ? a.first < b.first : a.second.index < b.second.index;
            });
            std::array<QueryHit, 100> all;
            int count = world.cast_ray_all(ray, all).value();
            ASSERT_EQ(count, static_cast<int>(expected.size()));
            for (int k = 0; k < count; ++k) {
                auto at_k = static_cast<size_t>(k);
                EXPECT_NEAR(all[at_k].fraction, expected[at_k].first, 2e-6f);
                if (k > 0) {
                    EXPECT_GE(all[at_k].fraction, all[at_k - 1].fraction);
                }
            }
            QueryHit first = world.cast_ray(ray).value();
            EXPECT_EQ(first.hit, count > 0);
            EXPECT_EQ(world.cast_ray_any(ray).value(), count > 0);
            if (count > 0) {
                ++hits;
                EXPECT_TRUE(same(first, all[0]));
                EXPECT_EQ(world.body_of(first.collider), first.body);
            }
        }
    }
    EXPECT_GT(hits, scaled(300, 20));
}

TEST(Queries, CastsAgreeWithBruteForce) {
    World world = mixed_world();
    run(world, 100);
    Random random{2};
    const Shape shapes[] = {Sphere{0.3f}, Box{{0.2f, 0.3f, 0.4f}}, Capsule{0.4f, 0.1f}, Cone{0.3f, 0.3f}};
    int hits = 0;
    for (int i = 0; i < scaled(240, 12); ++i) {
        Ray way = random_ray(random);
        ShapeCast cast{.start = {shapes[i % 4], {way.origin, random.rotation()}}, .translation = way.translation};
        if (i % 3 == 0) cast.rotation = random.vector(-2.0f, 2.0f);
        int count = 0;
        float least = 2.0f;
        for_each(world, [&](StaticBodyRef, ColliderId, const PosedShape& shape) {
            if (QueryHit h = cast_shape(shape, cast).value()) ++count, least = minimum(least, h.fraction);
        });
        std::array<QueryHit, 100> all;
        ASSERT_EQ(world.cast_shape_all(cast, all).value(), count) << "case " << i;
        QueryHit first = world.cast_shape(cast).value();
        EXPECT_EQ(world.cast_shape_any(cast).value(), count > 0);
        ASSERT_EQ(first.hit, count > 0);
        if (!first) continue;
        ++hits;
        // The world's own pose of a collider is rounded differently from the public one.
        EXPECT_NEAR(first.fraction, least, 1e-4f) << "case " << i;
        EXPECT_TRUE(same(first, all[0])) << "case " << i;
    }
    EXPECT_GT(hits, scaled(100, 5));
}

TEST(Queries, OverlapsAndNearestAgreeWithBruteForce) {
    World world = mixed_world();
    run(world, 100);
    Random random{3};
    const Shape shapes[] = {Sphere{0.5f}, Box{{0.5f, 0.3f, 0.4f}}, Capsule{0.6f, 0.2f}, Cylinder{0.5f, 0.5f}};
    int overlapping = 0, found = 0;
    for (int i = 0; i < scaled(300, 12); ++i) {
        PosedShape shape{shapes[i % 4], {at(random.vector(-4.0f, 4.0f) + Vec3{0.0f, 2.0f, 0.0f}), random.rotation()}};
        int count = 0;
        float least = 1e30f;
        for_each(world, [&](StaticBodyRef, ColliderId, const PosedShape& other) {
            Proximity p = closest_points(shape, other).value();
            count += p.distance < -1e-5f;
            least = minimum(least, p.distance);
            if (absolute(p.distance) > 1e-5f) {
                EXPECT_EQ(overlaps(shape, other).value(), p.distance < 0.0f);
            }
            Proximity back = closest_points(other, shape).value();
            EXPECT_NEAR(back.distance, p.distance, 2e-5f);
        });
        std::array<Proximity, 100> all;
        int n = world.overlap_shape(shape, all).value();
        EXPECT_GE(n, count);
        for (int k = 0; k < n; ++k) {
            const Proximity& p = all[static_cast<size_t>(k)];
            EXPECT_LE(p.distance, 0.0f);
            if (k > 0) {
                EXPECT_LT(all[static_cast<size_t>(k) - 1].collider.index, p.collider.index);
            }
        }
        overlapping += n;
        EXPECT_EQ(world.overlap_any(shape).value(), n > 0);
        Proximity near = world.closest(shape, 2.0f).value();
        ASSERT_EQ(near.found, least <= 2.0f);
        if (!near) continue;
        ++found;
        EXPECT_NEAR(near.distance, least, 1e-5f);
        EXPECT_NEAR(dot(near.point_b - near.point_a, near.normal), near.distance, 1e-4f);
    }
    EXPECT_GT(overlapping, scaled(150, 5));
    EXPECT_GT(found, scaled(200, 8));
}

TEST(Queries, PointsAreInWhatContainsThem) {
    World world = mixed_world();
    run(world, 60);
    Random random{4};
    int inside = 0;
    for (int i = 0; i < scaled(600, 120); ++i) {
        Position point = at(random.vector(-3.0f, 3.0f) + Vec3{0.0f, 1.5f, 0.0f});
        int count = 0;
        for_each(world,
                 [&](StaticBodyRef, ColliderId, const PosedShape& shape) { count += contains(shape, point).value(); });
        std::array<Proximity, 20> all;
        ASSERT_EQ(world.overlap_point(point, all).value(), count);
        inside += count;
        Proximity near = world.closest(point, 3.0f).value();
        if (count > 0) {
            EXPECT_LE(near.distance, 0.0f);
        }
        int in_box = world.overlap_box({point, point}, all).value();  // a box without size
        EXPECT_GE(in_box, count);
    }
    EXPECT_GT(inside, scaled(80, 2));
}

// Batches of any size, of which groups go by turns, and with every filter.
TEST(Queries, BatchesOfRaysAskWhomTheFilterNames) {
    World world = mixed_world(1, BroadPhaseType::wide_tree);
    run(world, 60);
    Random random{16};
    const BodyId one = world.body(world.body_count() / 2);
    const QueryFilter filters[] = {
        {}, {.ignore_body = one}, {.only_body = one}, {.see_fixed = false}, {.see_dynamic = false}};
    int hits = 0;
    for (const QueryFilter& filter : filters)
        for (size_t size : {0, 1, 2, 11, 12, 13, 63, 64, 65, 200}) {
            std::vector<Ray> rays;
            for (size_t i = 0; i < size; ++i) {
                rays.push_back(random_ray(random));
                if (i % 7 == 0) rays.back().translation.x = -0.0f, rays.back().translation.z = 0.0f;
                if (i % 5 == 0) rays.back().max_fraction = random.in(0.0f, 3.0f);
            }
            std::vector<QueryHit> out(size);
            world.cast_rays(rays, out, filter).value();
            for (size_t i = 0; i < size; ++i) {
                ASSERT_TRUE(same(out[i], world.cast_ray(rays[i], filter).value())) << size << " " << i;
                hits += out[i].hit;
            }
        }
    EXPECT_GT(hits, 500);
}

// The same bits from one call over an array as from single calls, with any number of workers and any broad phase.
TEST(Queries, BatchesGiveWhatSingleCallsGive) {
    std::vector<Ray> rays;
    std::vector<ShapeCast> casts;
    Random random{6};
    for (int i = 0; i < scaled(3000, 300); ++i) rays.push_back(random_ray(random));
    for (int i = 0; i < scaled(300, 30); ++i) {
        Ray way = random_ray(random);
        casts.push_back({.start = {Capsule{0.3f, 0.2f}, {way.origin, random.rotation()}},
                         .translation = way.translation,
                         .rotation = i % 2 ? random.vector(-1.0f, 1.0f) : Vec3{}});
    }
    std::vector<QueryHit> first_rays, first_casts;
    for (auto [workers, type] :
         {std::pair{1, BroadPhaseType::rtree_omt}, {2, BroadPhaseType::all_pairs}, {5, BroadPhaseType::sweep_1}}) {
        World world = mixed_world(workers, type);
        run(world, 60);
        std::vector<QueryHit> out(rays.size()), cast_out(casts.size());
        world.cast_rays(rays, out).value();
        world.cast_shapes(casts, cast_out).value();
        if (workers == 1) {
            for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same(out[i], world.cast_ray(rays[i]).value())) << i;
            for (size_t i = 0; i < casts.size(); ++i)
                ASSERT_TRUE(same(cast_out[i], world.cast_shape(casts[i]).value())) << i;
            first_rays = out, first_casts = cast_out;
        }
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same(out[i], first_rays[i])) << i;
        for (size_t i = 0; i < casts.size(); ++i) ASSERT_TRUE(same(cast_out[i], first_casts[i])) << i;
    }
}

// A tree that was refitted for many steps answers like one that was built for the present.
TEST(Queries, DoNotDependOnTheirHistory) {
    World asked = mixed_world(), fresh = mixed_world();
    Random random{7};
    for (int i = 0; i < 120; ++i) {
        asked.update(dt).value();
        fresh.update(dt).value();
        asked.cast_ray(random_ray(random)).value();
    }
    for (int i = 0; i < scaled(2000, 100); ++i) {
        Ray ray = random_ray(random);
        ASSERT_TRUE(same(asked.cast_ray(ray).value(), fresh.cast_ray(ray).value())) << i;
    }
    EXPECT_EQ(asked.hash(), fresh.hash());
}

TEST(Queries, SeeThePresent) {
    World world = WorldBuilder().build().value();
    const Ray down{{0.0f, 10.0f, 0.0f}, {0.0f, -20.0f, 0.0f}};
    EXPECT_FALSE(world.cast_ray(down).value());
    add_floor(world);
    EXPECT_NEAR(world.cast_ray(down).value().point.y, 0.0f, 1e-5f);
    BodyId cube = add_cube(world, 0.0f, 3);
    EXPECT_EQ(world.cast_ray(down).value().body, cube);  // before any step
    EXPECT_NEAR(world.cast_ray(down).value().point.y, 4.0f, 1e-5f);
    run(world, 10);
    EXPECT_NEAR(world.cast_ray(down).value().point.y, world.get(cube).position().y + 0.5f, 1e-5f);
    world.get(cube).set_pose({7.0f, 2.0f, 0.0f}, {}).value();
    EXPECT_NE(world.cast_ray(down).value().body, cube);
    EXPECT_EQ(world.cast_ray({{7.0f, 10.0f, 0.0f}, {0.0f, -20.0f, 0.0f}}).value().body, cube);
    world.remove_body(cube).value();
    EXPECT_NE(world.cast_ray({{7.0f, 10.0f, 0.0f}, {0.0f, -20.0f, 0.0f}}).value().body, cube);
    // Slots are used again, also while their former owners are still in the trees; and more than fit beside those.
    std::vector<BodyId> balls;
    for (int round = 0; round < 3; ++round) {
        for (BodyId b : balls) world.remove_body(b).value();
        balls.clear();
        for (int i = 0; i < (round == 1 ? 100 : 20); ++i)
            balls.push_back(
                world
                    .add_static_body({.shape = Sphere{0.4f},
                                      .position = {static_cast<float>(i), 5.0f + static_cast<float>(round), 0.0f}})
                    .value());
        for (size_t i = 0; i < balls.size(); ++i) {
            Ray ray{{static_cast<float>(i), 10.0f, 0.0f}, {0.0f, -20.0f, 0.0f}};
            EXPECT_EQ(world.cast_ray(ray).value().body, balls[i]) << round;
            std::array<QueryHit, 8> all;
            EXPECT_EQ(world.cast_ray_all(ray, all).value(), i < 20 ? 2 : 1 + (i <= 20)) << round << ' ' << i;
        }
    }
    // A body that is thrown out of the box that it had in the step.
    BodyId thrown = world.add_rigid_body({.shape = Sphere{0.2f}, .position = {0.0f, 1.0f, 3.0f}}).value();
    world.get(thrown).set_velocity({50.0f, 0.0f, 0.0f}).value();
    run(world, 1);
    Position now = world.get(thrown).position();
    EXPECT_EQ(world.cast_ray({now + Vec3{0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}}).value().body, thrown);
    EXPECT_EQ(world.check(), "");
}

TEST(Queries, HitsNameWhatTheyMet) {
    World world = mixed_world();
    QueryHit ground = world.cast_ray({{9.0f, 5.0f, 9.0f}, {0.0f, -10.0f, 0.0f}}).value();
    ASSERT_TRUE(ground);
    EXPECT_GE(ground.triangle, 0);
    EXPECT_EQ(ground.body_user_data, 77u);
    EXPECT_GT(ground.normal.y, 0.5f);
    QueryHit bar = world.cast_ray({{4.0f, 2.0f, -3.0f}, {0.0f, 0.0f, 6.0f}}).value();
    ASSERT_TRUE(bar);
    EXPECT_EQ(bar.user_data, 5u);
    EXPECT_EQ(bar.triangle, -1);
    EXPECT_NEAR(bar.fraction, 2.9f / 6.0f, 1e-6f);
    EXPECT_NEAR(bar.normal.z, -1.0f, 1e-6f);
}

TEST(Queries, FiltersChooseWhatIsSeen) {
    World world = WorldBuilder().no_gravity().build().value();
    const ColliderDef zone[] = {{.shape = Sphere{1.0f}, .is_trigger = true}};
    BodyId trigger = world.add_static_body({.position = {0.0f, 8.0f, 0.0f}, .colliders = zone}).value();
    BodyId dynamic = world.add_rigid_body({.position = {0.0f, 6.0f, 0.0f}, .filter = {.category = 2}}).value();
    BodyId kinematic =
        world.add_rigid_body({.position = {0.0f, 4.0f, 0.0f}, .filter = {.category = 4, .mask = 8}, .kinematic = true})
            .value();
    BodyId fixed = world.add_static_body({.position = {0.0f, 2.0f, 0.0f}, .filter = {.group = 3}}).value();
    const Ray down{{0.0f, 10.0f, 0.0f}, {0.0f, -20.0f, 0.0f}};
    auto first = [&](const QueryFilter& f) { return world.cast_ray(down, f).value().body; };
    EXPECT_EQ(first({}), dynamic);
    EXPECT_EQ(first({.see_triggers = true}), trigger);
    EXPECT_EQ(first({.ignore_body = dynamic}), kinematic);
    EXPECT_EQ(first({.see_dynamic = false}), kinematic);
    EXPECT_EQ(first({.see_kinematic = false, .see_dynamic = false}), fixed);
    EXPECT_EQ(first({.see_fixed = false, .see_kinematic = false, .see_dynamic = false}), BodyId{});
    EXPECT_EQ(first({.only_body = fixed}), fixed);
    EXPECT_EQ(first({.collision = {.category = ~0ull, .mask = 4}}), kinematic);
    EXPECT_EQ(first({.collision = {.category = 1, .mask = ~0ull}, .see_dynamic = false}), fixed);  // its mask is 8
    EXPECT_EQ(first({.collision = {~0ull, ~0ull, 3}, .see_kinematic = false, .see_dynamic = false}), BodyId{});
    std::array<QueryHit, 2> some;
    EXPECT_EQ(world.cast_ray_all(down, some, {.see_triggers = true}).value(), 4);  // more than there is room for
    EXPECT_EQ(some[0].body, trigger);
    EXPECT_EQ(some[1].body, dynamic);
    std::array<Proximity, 4> near;
    PosedShape big{Sphere{3.0f}, {{0.0f, 4.0f, 0.0f}, {}}};
    EXPECT_EQ(world.overlap_shape(big, near, {.ignore_body = kinematic}).value(), 2);
    EXPECT_EQ(world.closest(Position{0.0f, 0.0f, 0.0f}, 9.0f, {.only_body = kinematic}).value().body, kinematic);
    EXPECT_EQ(world
                  .cast_shape({.start = {Sphere{0.1f}, {{0.0f, 10.0f, 0.0f}, {}}}, .translation = {0.0f, -9.0f, 0.0f}},
                              {.ignore_body = dynamic})
                  .value()
                  .body,
              kinematic);
}

// Of colliders met at the same fraction the one with the smallest id.
TEST(Queries, TiesGoToTheSmallestId) {
    World world = WorldBuilder().build().value();
    std::vector<BodyId> same_place;
    for (int i = 0; i < 20; ++i) same_place.push_back(world.add_static_body({.shape = Box{}}).value());
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(world.cast_ray({{0.1f, 5.0f, 0.2f}, {0.0f, -10.0f, 0.0f}}).value().body, same_place[0]);
        EXPECT_EQ(world.closest(Position{3.0f, 0.0f, 0.0f}, 9.0f).value().body, same_place[0]);
        std::array<Proximity, 20> all;
        EXPECT_EQ(world.overlap_point({}, all).value(), 20);
        run(world, 1);
    }
}

// Const calls on several threads between steps, the first of which find the trees out of date.
TEST(Queries, RunOnSeveralThreadsAtOnce) {
    World world = mixed_world();
    run(world, 30);
    for (int round = 0; round < 10; ++round) {
        run(world, 1);
        const World& seen = world;
        QueryHit out[3][20];
        std::vector<std::thread> threads;
        for (int k = 0; k < 3; ++k)
            threads.emplace_back([&, k] {
                Random random{static_cast<uint32_t>(round)};
                for (QueryHit& hit : out[k]) hit = seen.cast_ray(random_ray(random)).value();
            });
        for (std::thread& t : threads) t.join();
        for (int i = 0; i < 20; ++i) {
            EXPECT_TRUE(same(out[0][i], out[1][i]));
            EXPECT_TRUE(same(out[0][i], out[2][i]));
        }
    }
}

}  // namespace
}  // namespace lendulet
