// What the world reports of contacts, triggers and boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "world/support.h"

namespace lendulet::test {
namespace {

TEST(Contacts, ImpulsesOfARestingBoxCarryItsWeight) {
    World world = WorldBuilder{}.sleep(false).build().value();
    BodyId floor = add_floor(world), box = add_cube(world, 0.3f, 0);
    run(world, 120);
    ASSERT_EQ(world.contact_count(), 1);
    Contact c = world.contact(0);
    EXPECT_EQ(c.point_count, 4);
    EXPECT_EQ(c.triangle, -1);
    // From A to B, whichever of the two is A.
    float up = c.body_a == floor ? 1.0f : -1.0f;
    EXPECT_EQ(c.body_a == floor ? c.body_b : c.body_a, box);
    EXPECT_EQ(world.body_of(c.collider_a), c.body_a);
    EXPECT_EQ(world.body_of(c.collider_b), c.body_b);
    EXPECT_NEAR(up * c.normal.y, 1.0f, 1e-6f);
    float sum = 0.0f;
    for (int j = 0; j < c.point_count; ++j) {
        EXPECT_GT(c.points[j].normal_impulse, 0.0f);
        EXPECT_NEAR(absolute(c.points[j].position.x - 0.3f), 0.5f, 1e-3f);
        EXPECT_NEAR(absolute(c.points[j].position.z), 0.5f, 1e-3f);
        EXPECT_NEAR(c.points[j].position.y, 0.0f, 2e-3f);
        EXPECT_NEAR(c.points[j].separation, world.get(box).position().y - 0.5f, 1e-4f);
        sum += c.points[j].normal_impulse;
    }
    float h = dt / static_cast<float>(world.config().solver_steps);
    EXPECT_NEAR(sum / (1000.0f * 9.81f * h), 1.0f, 0.01f);
    EXPECT_LT(length(c.friction_impulse), 0.01f * sum);
    EXPECT_EQ(world.statistics().contact_points, 4);
    EXPECT_NEAR(world.statistics().max_penetration, 0.5f - world.get(box).position().y, 1e-4f);
}

// On a slope friction carries m g sin(angle); reported on B, it points uphill for the box.
TEST(Contacts, FrictionImpulseHoldsABoxOnASlope) {
    const float angle = 0.3f;
    World world = WorldBuilder{}.friction(0.8f).sleep(false).build().value();
    Quat tilt = rotation_about({0.0f, 0.0f, 1.0f}, angle);
    world.add_static_body({.shape = Plane{}, .orientation = tilt}).value();
    BodyId box =
        world
            .add_rigid_body({.shape = Box{}, .position = at(rotate(tilt, Vec3{0.0f, 0.5f, 0.0f})), .orientation = tilt})
            .value();
    run(world, 120);
    ASSERT_EQ(world.contact_count(), 1);
    Contact c = world.contact(0);
    Vec3 friction = c.body_b == box ? c.friction_impulse : -c.friction_impulse;
    SinCos s = sin_cos(angle);
    float h = dt / static_cast<float>(world.config().solver_steps), weight = 1000.0f * 9.81f * h;
    EXPECT_NEAR(dot(friction, rotate(tilt, Vec3{1.0f, 0.0f, 0.0f})) / (weight * s.sin), 1.0f, 0.01f);
    EXPECT_NEAR(dot(friction, c.normal), 0.0f, 1e-3f * weight);
}

TEST(Contacts, ForcesOnSoftlyStackedBoxesAddUp) {
    World world = WorldBuilder{}.sleep(false).build().value();
    BodyId floor = add_floor(world);
    add_stack(world, 0.0f, 5);
    run(world, 240);
    float h = dt / static_cast<float>(world.config().solver_steps), on_floor = 0.0f;
    for (int i = 0; i < world.contact_count(); ++i) {
        Contact c = world.contact(i);
        if (c.body_a != floor && c.body_b != floor) continue;
        for (int j = 0; j < c.point_count; ++j) on_floor += c.points[j].normal_impulse;
    }
    EXPECT_NEAR(on_floor / (5.0f * 1000.0f * 9.81f * h), 1.0f, 0.01f);
}

TEST(Contacts, OrderIsThatOfColliders) {
    World world = WorldBuilder{}.build().value();
    add_mixed_pile(world, 3);
    run(world, 90);
    ASSERT_GT(world.contact_count(), 10);
    auto name = [&](int i) {
        Contact c = world.contact(i);
        return std::pair{std::min(c.collider_a.index, c.collider_b.index),
                         std::max(c.collider_a.index, c.collider_b.index)};
    };
    int on_mesh = 0, without = 0;
    for (int i = 0; i < world.contact_count(); ++i) {
        if (i > 0) {
            EXPECT_LE(name(i - 1), name(i));
        }
        on_mesh += world.contact(i).triangle >= 0;
        // Where a neighbour's face stands for it, a contact with a mesh has no points.
        EXPECT_GE(world.contact(i).point_count, world.contact(i).triangle >= 0 ? 0 : 1);
        without += world.contact(i).point_count == 0;
        EXPECT_LE(world.contact(i).point_count, 4);
    }
    EXPECT_GT(on_mesh - without, 3);
    EXPECT_EQ(world.check(), "");
}

TEST(Contacts, FiltersAndGroupsKeepColliderApart) {
    World world = WorldBuilder{}.build().value();
    StaticBodyDef floor{.shape = Plane{}};
    floor.filter.category = 2;
    world.add_static_body(floor).value();
    RigidBodyDef blind{.position = {0.0f, 0.5f, 0.0f}};
    blind.filter.mask = 1;
    RigidBodyDef seeing{.position = {0.0f, 0.5f, 0.0f}};
    seeing.filter.group = blind.filter.group = 5;
    BodyId falls = world.add_rigid_body(blind).value(), rests = world.add_rigid_body(seeing).value();
    run(world, 60);
    EXPECT_LT(world.get(falls).position().y, -4.0f);
    EXPECT_NEAR(world.get(rests).position().y, 0.5f, 0.01f);
}

TEST(Triggers, ReportOverlapsAndDoNotPush) {
    World world = WorldBuilder{}.no_gravity().build().value();
    ColliderDef zone;
    zone.shape = Sphere{1.0f};
    zone.is_trigger = true;
    BodyId area = world.add_static_body({.position = {0.0f, 0.0f, 0.0f}, .colliders = {&zone, 1}}).value();
    BodyId ball =
        world.add_rigid_body({.shape = Sphere{0.5f}, .position = {-3.0f, 0.0f, 0.0f}, .velocity = {1.0f, 0.0f, 0.0f}})
            .value();
    double entered = -1.0, left = -1.0;
    for (int i = 0; i < 400; ++i) {
        run(world, 1);
        EXPECT_EQ(world.contact_count(), 0);
        ASSERT_LE(world.overlaps().size(), 1u);
        if (world.overlaps().empty()) {
            if (entered >= 0.0 && left < 0.0) left = world.time();
            continue;
        }
        if (entered < 0.0) entered = world.time();
        EXPECT_EQ(world.overlaps()[0].trigger_body, area);
        EXPECT_EQ(world.overlaps()[0].other_body, ball);
        EXPECT_EQ(world.overlaps()[0].trigger, world.get_static(area).collider());
        EXPECT_EQ(world.overlaps()[0].other, world.get(ball).collider());
    }
    // Centres are 1.5 m apart after 1.5 s and again after 4.5 s.
    EXPECT_NEAR(entered, 1.5, 2.1 * dt);
    EXPECT_NEAR(left, 4.5, 2.1 * dt);
    EXPECT_EQ(world.get(ball).velocity(), (Vec3{1.0f, 0.0f, 0.0f}));
    run(world, 1);
    world.get(ball).set_pose({}, {}).value();
    run(world, 1);
    ASSERT_EQ(world.overlaps().size(), 1u);
    world.remove_body(ball).value();
    ASSERT_EQ(world.overlaps().size(), 1u) << "the list is that of the last step";
    EXPECT_FALSE(world.alive(world.overlaps()[0].other_body));
    run(world, 1);
    EXPECT_TRUE(world.overlaps().empty());
}

// The list of overlaps may be gone through while what it names is removed or filtered out, awake and at rest.
TEST(Triggers, TheListStaysWhileItIsRead) {
    for (bool resting : {false, true}) {
        World world = WorldBuilder{}.no_gravity().build().value();
        const ColliderDef zone[] = {{.shape = Box{{5.0f, 5.0f, 5.0f}}, .is_trigger = true}};
        world.add_static_body({.colliders = zone}).value();
        for (int i = 0; i < 10; ++i) {
            const float x = 0.5f * static_cast<float>(i) - 2.5f;
            world.add_rigid_body({.shape = Sphere{0.1f}, .position = {x, 0.0f, 0.0f}}).value();
        }
        run(world, resting ? 60 : 1);
        ASSERT_EQ(world.overlaps().size(), 10u);
        int seen = 0;
        for (const Overlap& o : world.overlaps()) {
            const bool removes = ++seen % 2 == 0;
            if (removes) world.remove_body(o.other_body).value();
            else world.set_filter(o.other, {.mask = 0}).value();
        }
        EXPECT_EQ(seen, 10);
        EXPECT_EQ(world.overlaps().size(), 10u);
        EXPECT_EQ(world.body_count(), 6);
        EXPECT_EQ(world.check(), "");
        run(world, 1);
        EXPECT_TRUE(world.overlaps().empty());
    }
}

class Queries : public ::testing::TestWithParam<BroadPhaseType> {};

TEST_P(Queries, BoxesAndRaysAgreeWithTheBodies) {
    World world = WorldBuilder{}.no_gravity().broad_phase(GetParam()).build().value();
    for (int i = 0; i < 40; ++i)
        world.add_rigid_body({.shape = Sphere{0.5f}, .position = {3.0f * static_cast<float>(i), 0.0f, 0.0f}}).value();
    BodyId wall = world.add_static_body({.shape = Box{{0.5f, 9.0f, 9.0f}}, .position = {-5.0f, 0.0f, 0.0f}}).value();
    run(world, 1);
    ColliderId found[8];
    Aabb box{{5.0f, -0.1f, -0.1f}, {13.0f, 0.1f, 0.1f}};
    ASSERT_EQ(world.query_boxes(box, found, 8), 3);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(world.body_of(found[i]), world.body(i + 2));
    EXPECT_EQ(world.query_boxes(box, nullptr, 0), 3) << "counts also what has no room";
    EXPECT_EQ(world.query_boxes({{0.0f, 5.0f, 0.0f}, {100.0f, 6.0f, 1.0f}}, found, 8), 0);

    BoxHit hit = world.nearest_box({1.0f, 0.0f, 0.0f}, {10.0f, 0.0f, 0.0f}).value();
    EXPECT_EQ(hit.body, world.body(1));
    EXPECT_EQ(hit.collider, world.get(hit.body).collider());
    EXPECT_NEAR(hit.fraction, 0.15f, 0.003f);
    EXPECT_EQ(world.nearest_box({-1.0f, 0.0f, 0.0f}, {-10.0f, 0.0f, 0.0f}).value().body, wall);
    EXPECT_FALSE(world.nearest_box({1.0f, 0.0f, 0.0f}, {0.0f, 9.0f, 0.0f}).value().body);
    EXPECT_EQ(world.nearest_box({3.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}).value().fraction, 0.0f);
    EXPECT_EQ(world.nearest_box({}, {}).error().code, ErrorCode::bad_query);
    EXPECT_EQ(world.nearest_box({}, {std::nanf(""), 0.0f, 0.0f}).error().code, ErrorCode::bad_query);

    // A removed collider is not found any more, and the new owner of its slot not at the old place.
    world.remove_body(world.body(1)).value();
    world.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.0f, 500.0f, 0.0f}}).value();
    EXPECT_EQ(world.query_boxes({{2.9f, -0.1f, -0.1f}, {3.1f, 0.1f, 0.1f}}, found, 8), 0);
    EXPECT_EQ(world.nearest_box({1.0f, 0.0f, 0.0f}, {10.0f, 0.0f, 0.0f}).value().body, world.body(1))
        << "the next in the row";
    run(world, 1);
    EXPECT_EQ(world.query_boxes({{-1.0f, 499.0f, -1.0f}, {1.0f, 501.0f, 1.0f}}, found, 8), 1);
}

TEST_P(Queries, EveryColliderHasALeafBoxAndEveryBoxHoldsItsBody) {
    World world = WorldBuilder{}.broad_phase(GetParam()).build().value();
    add_mixed_pile(world, 3);
    run(world, 10);
    std::vector<Aabb> leaves;
    int deepest = 0;
    world.for_each_aabb([&](const AabbView& view) {
        EXPECT_GE(view.depth, 0);
        deepest = std::max(deepest, view.depth);
        if (view.leaf) leaves.push_back(view.box);
    });
    EXPECT_EQ(leaves.size(), static_cast<size_t>(world.body_count()));
    bool has_levels = name_of(GetParam()).starts_with("rtree") || GetParam() == BroadPhaseType::wide_tree;
    EXPECT_EQ(deepest > 0, has_levels);
    for (int i = 0; i < world.body_count(); ++i) {
        Aabb box = world.get_static(world.body(i)).aabb();
        bool held = std::any_of(leaves.begin(), leaves.end(), [&](const Aabb& leaf) {
            return min_component(box.lower - leaf.lower) >= -1e-3f && min_component(leaf.upper - box.upper) >= -1e-3f;
        });
        EXPECT_TRUE(held) << i;
    }
}
INSTANTIATE_TEST_SUITE_P(Structures, Queries,
                         ::testing::Values(BroadPhaseType::all_pairs, BroadPhaseType::sweep_1, BroadPhaseType::sweep_3,
                                           BroadPhaseType::rtree_quadratic, BroadPhaseType::rtree_star,
                                           BroadPhaseType::rtree_str, BroadPhaseType::rtree_omt,
                                           BroadPhaseType::wide_tree));

}  // namespace
}  // namespace lendulet::test
