// Events: contacts that begin and end, hits, triggers, sleep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "world/support.h"

namespace lendulet::test {
namespace {

using Key = std::pair<uint32_t, uint32_t>;
Key key_of(const ContactEvent& e) { return {e.collider_a.index, e.collider_b.index}; }

// What begins and ends in turn, checked to do so.
struct Ledger {
    std::set<Key> touching;
    int begun = 0, ended = 0;
    bool consistent = true;

    void read(const World& world) {
        // Where a pair begins and ends in one update, which is which follows from what it was before.
        for (const ContactEvent& e : world.contact_begins()) consistent &= touching.insert(key_of(e)).second, ++begun;
        for (const ContactEvent& e : world.contact_ends()) consistent &= touching.erase(key_of(e)) == 1, ++ended;
    }
};

World make_world(float restitution = 0.0f) { return WorldBuilder().bounciness(restitution).build().value(); }

BodyId add_ball(World& world, Position at, float radius = 0.5f, Events events = Events::all) {
    return world.add_rigid_body({.shape = Sphere{radius}, .position = at, .events = events}).value();
}

TEST(Events, NobodyAsksNothingIsReported) {
    World world = make_world();
    add_floor(world);
    add_ball(world, {0.0f, 2.0f, 0.0f}, 0.5f, Events::none);
    for (int i = 0; i < 120; ++i) {
        run(world, 1);
        EXPECT_TRUE(world.contact_begins().empty() && world.contact_ends().empty() && world.contact_hits().empty());
    }
}

// A ball dropped without bouncing: speed sqrt(2 g h), and an impulse of m v and the weight for what is left of the
// step.
TEST(Events, HitOfADeadBallHasTheSpeedOfTheFall) {
    for (float height : {0.2f, 0.5f, 1.0f, 2.0f, 3.3f, 5.0f, 7.1f, 20.0f}) {
        World world = make_world();
        const BodyId floor = add_floor(world);
        const BodyId ball = add_ball(world, {1.0f, 0.5f + height, 2.0f});
        const float mass = world.get(ball).mass(), speed = std::sqrt(2.0f * 9.81f * height);
        int begins = 0, hits = 0;
        for (int i = 0; i < 180; ++i) {
            run(world, 1);
            begins += static_cast<int>(world.contact_begins().size());
            EXPECT_TRUE(world.contact_ends().empty()) << height;
            for (const ContactHit& hit : world.contact_hits()) {
                ++hits;
                EXPECT_EQ(hit.body_a, floor);
                EXPECT_EQ(hit.body_b, ball);
                EXPECT_NEAR(hit.speed, speed, 0.005f * speed) << height;
                EXPECT_NEAR(hit.normal.y, 1.0f, 1e-5f);
                EXPECT_NEAR(hit.position.x, 1.0f, 1e-3f);
                EXPECT_NEAR(hit.position.y, 0.0f, 1e-2f);
                EXPECT_NEAR(hit.position.z, 2.0f, 1e-3f);
                EXPECT_GT(hit.impulse, 0.98f * mass * speed) << height;
                EXPECT_LT(hit.impulse, 1.02f * mass * (speed + 2.0f * 9.81f * dt)) << height;
            }
        }
        EXPECT_EQ(begins, 1) << height;
        EXPECT_EQ(hits, 1) << height;
    }
}

TEST(Events, HitsOfABouncingBallAreThoseOfNewton) {
    for (float e : {0.3f, 0.5f, 0.8f, 1.0f}) {
        World world = make_world(e);
        add_floor(world);
        const float height = 2.0f;
        const BodyId ball = add_ball(world, {0.0f, 0.5f + height, 0.0f});
        const float mass = world.get(ball).mass();
        float speed = std::sqrt(2.0f * 9.81f * height);
        Ledger ledger;
        int hits = 0;
        for (int i = 0; i < 150; ++i) {
            run(world, 1);
            ledger.read(world);
            for (const ContactHit& hit : world.contact_hits()) {
                EXPECT_NEAR(hit.speed, speed, 0.01f * speed) << e << " " << hits;
                EXPECT_NEAR(hit.impulse, mass * speed * (1.0f + e), 0.01f * mass * speed * (1.0f + e)) << e;
                EXPECT_GE(hit.speed, world.config().hit_speed);
                speed *= e;
                ++hits;
            }
        }
        EXPECT_TRUE(ledger.consistent);
        EXPECT_GE(hits, e == 1.0f ? 2 : 1);
        EXPECT_GE(ledger.begun, hits);
        EXPECT_NEAR(ledger.begun, ledger.ended, 1);
    }
}

// Substeps of an island under load are shorter: what is reported is the same.
TEST(Events, StackUnderABallThatFallsOnIt) {
    World world = make_world();
    add_floor(world);
    const std::vector<BodyId> stack = add_stack(world, 0.0f, 10);
    run(world, 30);
    const float height = 1.0f;
    const BodyId ball = add_ball(world, {0.0f, 10.5f + height, 0.0f});
    const float mass = world.get(ball).mass(), speed = std::sqrt(2.0f * 9.81f * height);
    int hits = 0;
    for (int i = 0; i < 60; ++i) {
        run(world, 1);
        for (const ContactHit& hit : world.contact_hits()) {
            ++hits;
            EXPECT_EQ(hit.body_b, ball);
            EXPECT_EQ(hit.body_a, stack.back());
            EXPECT_NEAR(hit.speed, speed, 0.02f * speed);
            // The stack gives way or not: between a free cube and a wall.
            EXPECT_GT(hit.impulse, 0.5f * mass * speed);
            EXPECT_LT(hit.impulse, 1.2f * mass * speed);
        }
    }
    EXPECT_EQ(hits, 1);
}

// A bullet that is put where it met a thin wall is reported with the step that answers it, with what that takes from
// it.
TEST(Events, BulletStoppedByContinuousCollision) {
    const Shape shapes[] = {Sphere{0.2f}, Sphere{0.31f}, Box{{0.2f, 0.3f, 0.5f}}, Box{{0.37f, 0.3f, 0.5f}}};
    int stopped = 0;
    for (const Shape& shape : shapes) {
        World world = WorldBuilder().no_gravity().no_bounciness().build().value();
        const BodyId wall =
            world.add_static_body({.shape = Box{{0.01f, 4.0f, 4.0f}}, .position = {10.0f, 0.0f, 0.0f}}).value();
        const BodyId bullet =
            world.add_rigid_body({.shape = shape, .velocity = {400.0f, 0.0f, 0.0f}, .events = Events::all}).value();
        float speed = 0.0f, impulse = 0.0f;
        for (int i = 0; i < 8; ++i) {
            run(world, 1);
            stopped += world.statistics().stopped_bodies;
            for (const ContactHit& hit : world.contact_hits()) {
                impulse += hit.impulse;
                EXPECT_EQ(hit.body_a, wall);
                EXPECT_NEAR(hit.normal.x, -1.0f, 1e-3f);
                if (speed > 0.0f) continue;
                EXPECT_NEAR(hit.position.x, 9.99f, 0.02f);
                speed = hit.speed;
            }
        }
        const RigidBodyRef after = world.get(bullet);
        EXPECT_NEAR(speed, 400.0f, 1.0f);
        EXPECT_NEAR(impulse, after.mass() * (400.0f - after.velocity().x), 0.005f * 400.0f * after.mass());
    }
    EXPECT_GT(stopped, 0);
}

// What lies does not come and go: stacks, a heap and what rolls over the triangles of a floor.
TEST(Events, RestingContactsDoNotFlicker) {
    World world = make_world();
    const BodyId floor =
        world
            .add_static_body(
                {.shape = Box{{20.0f, 0.5f, 20.0f}}, .position = {0.0f, -0.5f, 0.0f}, .events = Events::contacts})
            .value();
    EXPECT_TRUE(world.alive(floor));
    for (int k = 0; k < 6; ++k)
        for (int i = 0; i < 4 + k; ++i)
            world
                .add_rigid_body({.shape = Box{},
                                 .position = {3.0f * static_cast<float>(k), 0.5f + static_cast<float>(i), 0.0f},
                                 .events = Events::contacts,
                                 .allow_sleep = false})
                .value();
    Ledger ledger;
    for (int i = 0; i < 600; ++i) {
        run(world, 1);
        ledger.read(world);
        if (i > 1) {
            EXPECT_TRUE(world.contact_begins().empty() && world.contact_ends().empty()) << i;
        }
    }
    EXPECT_TRUE(ledger.consistent);
    EXPECT_EQ(ledger.touching.size(), size_t{4 + 5 + 6 + 7 + 8 + 9});
}

TEST(Events, HeapThatLiesIsQuiet) {
    World world = make_world();
    add_bowl(world);
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k)
            for (int y = 0; y < 6; ++y) {
                const float x = -2.1f + 1.05f * static_cast<float>(i) + 0.1f * static_cast<float>(y % 3),
                            z = -2.1f + 1.05f * static_cast<float>(k) + 0.07f * static_cast<float>(y % 2);
                const Position at{x, 0.6f + 1.2f * static_cast<float>(y), z};
                RigidBodyDef def{.position = at, .events = Events::contacts, .allow_sleep = false};
                // A ball that nothing slows spins and rolls on in its place.
                if ((i + k + y) % 3 == 0)
                    def.shape = Sphere{0.5f}, def.rolling_friction = def.spinning_friction = 0.01f;
                else if ((i + k + y) % 3 == 1) def.shape = Box{{0.5f, 0.4f, 0.45f}};
                else def.shape = octahedron(0.6f);
                world.add_rigid_body(def).value();
            }
    Ledger ledger;
    int late = 0;
    for (int i = 0; i < 1500; ++i) {
        run(world, 1);
        ledger.read(world);
        if (i >= 900) late += static_cast<int>(world.contact_begins().size() + world.contact_ends().size());
    }
    EXPECT_TRUE(ledger.consistent);
    EXPECT_EQ(late, 0);
    EXPECT_GT(ledger.touching.size(), size_t{200});
}

TEST(Events, RollingOverTrianglesIsOneContact) {
    World world = make_world();
    world.add_static_body({.shape = wavy_ground(40, 20.0f, 0.0f), .position = {0.0f, 0.0f, 0.0f}}).value();
    const BodyId ball = world
                            .add_rigid_body({.shape = Sphere{0.5f},
                                             .position = {-15.0f, 0.5f, 0.3f},
                                             .velocity = {4.0f, 0.0f, 0.7f},
                                             .angular_velocity = {1.4f, 0.0f, -8.0f},
                                             .events = Events::all})
                            .value();
    const BodyId box = world
                           .add_rigid_body({.shape = Box{},
                                            .position = {-15.0f, 0.5f, -6.0f},
                                            .velocity = {12.0f, 0.0f, 2.0f},
                                            .friction = 0.1f,
                                            .events = Events::all})
                           .value();
    Ledger ledger;
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        run(world, 1);
        ledger.read(world);
        hits += static_cast<int>(world.contact_hits().size());
    }
    EXPECT_GT(world.get(ball).position().x, 0.0f);
    EXPECT_GT(world.get(box).position().x, 0.0f);
    EXPECT_TRUE(ledger.consistent);
    EXPECT_EQ(ledger.begun, 2);
    EXPECT_EQ(ledger.ended, 0);
    EXPECT_EQ(hits, 0);
}

TEST(Events, BeginAndEndOnceEachHoweverTheyPart) {
    World world = make_world();
    const BodyId floor = add_floor(world);
    const BodyId thrown = add_ball(world, {0.0f, 0.5f, 0.0f}), moved = add_ball(world, {3.0f, 0.5f, 0.0f}),
                 removed = add_ball(world, {6.0f, 0.5f, 0.0f}), sleeper = add_ball(world, {9.0f, 0.5f, 0.0f});
    const ColliderId gone = world.get(removed).collider();
    run(world, 1);
    ASSERT_EQ(world.contact_begins().size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        const ContactEvent& e = world.contact_begins()[i];
        const BodyId balls[] = {thrown, moved, removed, sleeper};
        EXPECT_EQ(e.body_a, floor);
        EXPECT_EQ(e.body_b, balls[i]);
        EXPECT_EQ(world.body_of(e.collider_b), balls[i]);
    }
    Ledger ledger;
    for (int i = 0; i < 60; ++i) {
        run(world, 1);
        EXPECT_TRUE(world.contact_begins().empty() && world.contact_ends().empty()) << i;
    }
    ASSERT_TRUE(world.get(sleeper).asleep() && world.get(thrown).asleep());
    world.get(thrown).apply_impulse({0.0f, 3.0f * world.get(thrown).mass(), 0.0f}).value();
    world.get(moved).set_pose({3.0f, 5.0f, 0.0f}, {}).value();
    world.remove_body(removed).value();
    EXPECT_TRUE(world.contact_ends().empty());  // of the last update
    run(world, 1);
    ASSERT_EQ(world.contact_ends().size(), 3u);
    EXPECT_EQ(world.contact_ends()[0].body_b, thrown);
    EXPECT_EQ(world.contact_ends()[1].body_b, moved);
    EXPECT_EQ(world.contact_ends()[2].body_b, removed);
    EXPECT_EQ(world.contact_ends()[2].collider_b, gone);
    EXPECT_FALSE(world.alive(removed));
    EXPECT_TRUE(world.contact_begins().empty());
    world.remove_body(floor).value();
    run(world, 1);
    ASSERT_EQ(world.contact_ends().size(), 1u);  // of all that touched it, the sleeper is left
    EXPECT_EQ(world.contact_ends()[0].body_b, sleeper);
    run(world, 1);
    EXPECT_TRUE(world.contact_ends().empty());
}

TEST(Events, EitherColliderAsks) {
    for (const Events asks : {Events::contacts, Events::hits}) {
        World world = make_world();
        world.add_static_body({.shape = Box{{9.0f, 0.5f, 9.0f}}, .position = {0.0f, -0.5f, 0.0f}, .events = asks})
            .value();
        add_ball(world, {0.0f, 2.0f, 0.0f}, 0.5f, Events::none);
        size_t begins = 0, hits = 0;
        for (int i = 0; i < 60; ++i) {
            run(world, 1);
            begins += world.contact_begins().size(), hits += world.contact_hits().size();
        }
        EXPECT_EQ(begins, asks == Events::contacts ? 1u : 0u);
        EXPECT_EQ(hits, asks == Events::hits ? 1u : 0u);
    }
}

TEST(Events, HitSpeedIsASetting) {
    const float speed = std::sqrt(2.0f * 9.81f);
    for (bool later : {false, true})
        for (float least : {0.0f, 0.98f * speed, 1.02f * speed}) {
            World world = WorldBuilder().hit_speed(later ? 100.0f : least).build().value();
            if (later) world.set_hit_speed(least).value();
            add_floor(world);
            add_ball(world, {0.0f, 1.5f, 0.0f});
            size_t hits = 0;
            for (int i = 0; i < 60; ++i) run(world, 1), hits += world.contact_hits().size();
            EXPECT_EQ(hits, least < speed ? 1u : 0u) << least;
        }
    EXPECT_EQ(WorldBuilder().hit_speed(-1.0f).build().error().code, ErrorCode::bad_config);
    EXPECT_EQ(WorldBuilder().hit_speed(std::nanf("")).build().error().code, ErrorCode::bad_config);
    World world = WorldBuilder().build().value();
    for (float bad : {-1.0f, std::nanf(""), std::numeric_limits<float>::infinity()})
        EXPECT_EQ(world.set_hit_speed(bad).error().code, ErrorCode::bad_config);
    EXPECT_EQ(world.config().hit_speed, 1.0f);
}

TEST(Events, TriggersTellWhoComesAndGoes) {
    World world = make_world();
    add_floor(world);
    const ColliderDef zone{.shape = Box{{1.0f, 1.0f, 1.0f}}, .is_trigger = true, .events = Events::contacts};
    const BodyId trigger = world.add_static_body({.position = {0.0f, 3.0f, 0.0f}, .colliders = {&zone, 1}}).value();
    const BodyId ball = add_ball(world, {0.0f, 6.0f, 0.0f}, 0.5f, Events::none);
    int begins = 0, ends = 0;
    for (int i = 0; i < 120; ++i) {
        run(world, 1);
        for (const Overlap& o : world.trigger_begins()) {
            ++begins;
            EXPECT_EQ(o.trigger_body, trigger);
            EXPECT_EQ(o.other_body, ball);
            EXPECT_NEAR(world.get(ball).position().y, 4.3f, 0.3f);
        }
        for (const Overlap& o : world.trigger_ends()) {
            ++ends;
            EXPECT_EQ(o.other_body, ball);
            EXPECT_NEAR(world.get(ball).position().y, 1.2f, 0.4f);
        }
    }
    EXPECT_TRUE(world.contact_begins().empty());
    EXPECT_EQ(begins, 1);
    EXPECT_EQ(ends, 1);
    world.get(ball).set_pose({0.0f, 3.0f, 0.0f}, {}).value();
    run(world, 1);
    EXPECT_EQ(world.trigger_begins().size(), 1u);
    world.remove_body(ball).value();
    run(world, 1);
    ASSERT_EQ(world.trigger_ends().size(), 1u);
    EXPECT_EQ(world.trigger_ends()[0].trigger_body, trigger);
    EXPECT_EQ(world.trigger_ends()[0].other_body, ball);
}

TEST(Events, SleepIsToldOnce) {
    World world = make_world();
    add_floor(world);
    const std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    int asleep = 0, woken = 0;
    for (int i = 0; i < 90; ++i) {
        run(world, 1);
        for (const SleepEvent& e : world.sleep_events()) (e.asleep ? asleep : woken) += 1;
    }
    EXPECT_EQ(asleep, 3);
    EXPECT_EQ(woken, 0);
    world.get(stack[1]).wake();
    run(world, 1);
    ASSERT_EQ(world.sleep_events().size(), 3u);  // with all that it touches
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(world.sleep_events()[i].body, stack[i]);
        EXPECT_FALSE(world.sleep_events()[i].asleep);
    }
    run(world, 1);
    EXPECT_TRUE(world.sleep_events().empty());
    run(world, 120);
    ASSERT_TRUE(world.get(stack[0]).asleep());
    world.get(stack[0]).wake();
    world.remove_body(stack[0]).value();
    run(world, 1);
    for (const SleepEvent& e : world.sleep_events()) EXPECT_NE(e.body, stack[0]);
}

// Every split of the fall into steps gives the same hit, also where the blow falls into the last substep of one.
TEST(Events, HitAtTheEndOfAStepIsReportedWhole) {
    for (int k = 0; k < 40; ++k) {
        const float height = 1.0f + 0.0115f * static_cast<float>(k), speed = std::sqrt(2.0f * 9.81f * height);
        World world = make_world();
        add_floor(world);
        const BodyId ball = add_ball(world, {0.0f, 0.5f + height, 0.0f});
        const float mass = world.get(ball).mass();
        int hits = 0;
        for (int i = 0; i < 60; ++i) {
            run(world, 1);
            for (const ContactHit& hit : world.contact_hits()) {
                ++hits;
                EXPECT_NEAR(hit.speed, speed, 0.005f * speed) << k;
                EXPECT_GT(hit.impulse, 0.98f * mass * speed) << k;
                EXPECT_LT(hit.impulse, 1.02f * mass * (speed + 2.0f * 9.81f * dt)) << k;
            }
            world.restore(world.snapshot()).value();  // what is pending is part of the state
        }
        EXPECT_EQ(hits, 1) << k;
    }
}

TEST(Events, OfAnUpdateThatWasCutAreAllThere) {
    World world = make_world();
    add_floor(world);
    const BodyId ball = add_ball(world, {0.0f, 20.0f, 0.0f}, 0.5f);
    world.get(ball).set_velocity({0.0f, -1.0f, 0.0f}).value();
    run(world, 1, 4.0f);
    EXPECT_EQ(world.contact_begins().size(), 1u);
    EXPECT_EQ(world.contact_hits().size(), 1u);
}

}  // namespace
}  // namespace lendulet::test
