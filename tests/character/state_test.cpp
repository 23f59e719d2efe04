// What is refused, stances, snapshots, and walks at random.
#include <gtest/gtest.h>

#include <cstring>

#include "character/motion_bounds.h"
#include "character/walk.h"

namespace lendulet::test {
namespace {

struct Random {
    uint32_t state = 12345;
    float operator()(float low, float high) {
        state = state * 1664525u + 1013904223u;
        return low + (high - low) * static_cast<float>(state >> 8) / 16777216.0f;
    }
    Vec3 direction() {
        const float angle = (*this)(-pi, pi);
        return {std::cos(angle), 0.0f, std::sin(angle)};
    }
};

TEST(Character, RefusesWhatCannotBe) {
    World world = WorldBuilder{}.build().value();
    const float nan = std::nanf("");
    auto code = [&](const CharacterDef& def) { return Character::add(world, def).error().code; };
    EXPECT_EQ(code({.shape = Plane{}}), ErrorCode::bad_collider);
    EXPECT_EQ(code({.shape = Capsule{0.5f, -1.0f}}), ErrorCode::bad_collider);
    EXPECT_EQ(code({.position = {nan, 0.0f, 0.0f}}), ErrorCode::non_finite);
    EXPECT_EQ(code({.orientation = Quat{1.0f, 1.0f, 0.0f, 0.0f}}), ErrorCode::bad_rotation);
    EXPECT_EQ(code({.mass = 0.0f}), ErrorCode::bad_mass);
    EXPECT_EQ(code({.max_slope = 2.0f}), ErrorCode::bad_extent);
    EXPECT_EQ(code({.step_height = -1.0f}), ErrorCode::bad_extent);
    EXPECT_EQ(code({.push_force = -1.0f}), ErrorCode::bad_material);
    EXPECT_EQ(code({.skin = 0.2f}), ErrorCode::bad_extent);
    EXPECT_EQ(world.body_count(), 0);

    Walk w;
    w.once();
    const CharacterState before = w.who.state();
    EXPECT_EQ(w.who.update(w.world, {.velocity = {nan, 0.0f, 0.0f}}, dt).error().code, ErrorCode::non_finite);
    EXPECT_EQ(w.who.update(w.world, {.jump = -1.0f}, dt).error().code, ErrorCode::non_finite);
    EXPECT_EQ(w.who.update(w.world, {}, 0.0f).error().code, ErrorCode::bad_time_step);
    EXPECT_EQ(w.who.set_position(w.world, {nan, 0.0f, 0.0f}).error().code, ErrorCode::non_finite);
    EXPECT_EQ(w.who.set_velocity({nan, 0.0f, 0.0f}).error().code, ErrorCode::non_finite);
    EXPECT_EQ(w.who.set_stance(w.world, 1).error().code, ErrorCode::bad_collider);
    EXPECT_EQ(w.who.state().position, before.position);
    EXPECT_EQ(w.who.state().velocity, before.velocity);
    w.who.remove(w.world).value();
    EXPECT_EQ(w.who.update(w.world, {}, dt).error().code, ErrorCode::stale_id);
}

TEST(Character, CrouchesAndStandsUpWhereThereIsRoom) {
    const Shape stances[] = {Capsule{0.6f, 0.3f}, Capsule{0.2f, 0.3f}};
    Walk w({.stances = stances});
    w.put(Box{{1.0f, 0.5f, 2.0f}}, {2.0f, 1.7f, 0.0f});  // 1.2 m above the floor
    w.go({2.0f, 0.0f, 0.0f}, 1.0f);
    EXPECT_LT(w.at().x, 0.8f);
    EXPECT_TRUE(w.who.set_stance(w.world, 1).value());
    w.go({2.0f, 0.0f, 0.0f}, 0.6f);
    EXPECT_GT(w.at().x, 1.5f);
    EXPECT_FALSE(w.who.set_stance(w.world, 0).value());
    EXPECT_EQ(w.who.state().stance, 1);
    w.go({2.0f, 0.0f, 0.0f}, 1.2f);
    EXPECT_TRUE(w.who.set_stance(w.world, 0).value());
    EXPECT_NEAR(w.at().y, w.who.skin(), 1e-3f);
    // Rays meet the stance that it has.
    const Ray high{.origin = w.at() + Vec3{-5.0f, 1.5f, 0.0f}, .translation = {4.9f, 0.0f, 0.0f}};
    EXPECT_TRUE(w.world.cast_ray(high, {.only_body = w.who.body()}).value());
    EXPECT_TRUE(w.who.set_stance(w.world, 1).value());
    EXPECT_FALSE(w.world.cast_ray(high, {.only_body = w.who.body()}).value());
}

TEST(Character, GoesBackWithSnapshots) {
    const Shape stances[] = {Capsule{0.6f, 0.3f}, Capsule{0.2f, 0.3f}};
    Walk w({.stances = stances});
    for (int i = 0; i < 20; ++i)
        w.crate({static_cast<float>(1 + i % 5), 0.5f + static_cast<float>(i / 5), 0.0f}, 10.0f);
    w.go({1.0f, 0.0f, 0.2f}, 0.5f);
    const std::vector<uint8_t> snapshot = w.world.snapshot();
    const CharacterState state = w.who.state();
    uint64_t hash[2];
    Position there[2];
    for (int turn = 0; turn < 2; ++turn) {
        w.go({1.0f, 0.0f, 0.1f}, 1.0f);
        (void)w.who.set_stance(w.world, 1);
        w.go({2.0f, 0.0f, 0.1f}, 1.0f);
        hash[turn] = w.world.hash(), there[turn] = w.at();
        w.world.restore(snapshot).value();
        w.who.set_state(w.world, state).value();
    }
    EXPECT_EQ(hash[0], hash[1]);
    EXPECT_EQ(there[0], there[1]);
    CharacterState bad = state;
    bad.stance = 7;
    EXPECT_EQ(w.who.set_state(w.world, bad).error().code, ErrorCode::bad_collider);
}

// The same bits for any number of workers and lanes.
TEST(Character, ComputesTheSameForAllWidthsAndWorkers) {
    uint64_t first = 0;
    for (int workers : {1, 3})
        for (int width : widths) {
            World world = WorldBuilder{}.workers(workers).width(width).build().value();
            add_bowl(world);
            for (int i = 0; i < 12; ++i)
                world
                    .add_rigid_body({.shape = Box{{0.2f, 0.2f, 0.2f}},
                                     .position = {0.6f * static_cast<float>(i % 4) - 1.0f,
                                                  0.3f + 0.3f * static_cast<float>(i / 4), 0.1f}})
                    .value();
            Character who = Character::add(world, {.position = {2.0f, 0.1f, 2.0f}}).value();
            Random random;
            for (int i = 0; i < 180; ++i) {
                who.update(world, {.velocity = 3.0f * random.direction(), .jump = i % 50 == 0 ? 4.0f : 0.0f}, dt)
                    .value();
                world.update(dt).value();
            }
            uint64_t hash = world.hash();
            float place[3] = {who.position().x, who.position().y, who.position().z};
            for (float x : place) {
                uint32_t bits;
                std::memcpy(&bits, &x, sizeof bits);
                hash = hash * 31 + bits;
            }
            if (first == 0) first = hash;
            EXPECT_EQ(hash, first) << workers << " " << width;
        }
}

// Over waves of triangles, some steep, with walls of boxes: never below the surface, never slower than it can be.
TEST(Character, NeverPassesThroughMeshesOrFields) {
    Random random;
    for (int kind = 0; kind < 2; ++kind)
        for (float step : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 240.0f}) {
            Walk w({.position = {0.0f, 3.0f, 0.0f}}, false);
            w.step = step;
            constexpr int n = 33;
            std::vector<float> heights(n * n);
            for (float& h : heights) h = random(0.0f, 0.9f);
            const HeightField field =
                HeightField::from_heights(
                    {.columns = n, .rows = n, .heights = heights, .origin = {-16.0f, 0.0f, -16.0f}})
                    .value();
            if (kind == 0) w.put(field, {});
            else w.put(TriangleMesh::from_triangles(field.vertices(), field.triangles()).value(), {});
            for (int i = 0; i < 12; ++i)
                w.put(Box{{random(0.1f, 1.0f), 1.0f, random(0.1f, 1.0f)}},
                      {random(-8.0f, 8.0f), 0.6f, random(-8.0f, 8.0f)},
                      rotation_about({0.0f, 1.0f, 0.0f}, random(0.0f, 3.0f)));
            for (int side = 0; side < 4; ++side)
                w.put(Box{{side < 2 ? 0.5f : 12.0f, 4.0f, side < 2 ? 12.0f : 0.5f}}, {side == 0   ? -12.0f
                                                                                      : side == 1 ? 12.0f
                                                                                                  : 0.0f,
                                                                                      2.0f,
                                                                                      side == 2   ? -12.0f
                                                                                      : side == 3 ? 12.0f
                                                                                                  : 0.0f});
            for (int way = 0; way < 40; ++way) {
                const Vec3 velocity = random(1.0f, 8.0f) * random.direction();
                for (int i = 0; i < static_cast<int>(0.5f / step); ++i) {
                    w.once({.velocity = velocity, .jump = i == 5 && way % 4 == 0 ? 4.0f : 0.0f});
                    ASSERT_TRUE(finite(from_origin(w.at())));
                    ASSERT_LT(std::fmax(std::fabs(w.at().x), std::fabs(w.at().z)), 11.5f);
                    const QueryHit below = w.world
                                               .cast_ray({w.at() + Vec3{0.0f, 0.3f, 0.0f}, {0.0f, -20.0f, 0.0f}},
                                                         {.ignore_body = w.who.body()})
                                               .value();
                    ASSERT_TRUE(below) << kind << " " << step << " " << way << " " << w.at().y;
                }
            }
        }
}

// Among crates, balls and lifts that go every way: numbers stay numbers, and nobody gets through the floor or far out.
TEST(Character, SurvivesRandomWorlds) {
    Random random;
    for (int round = 0; round < 12; ++round) {
        Walk w({.shape = round % 3 == 0 ? Shape(Box{{0.3f, 0.9f, 0.3f}}) : Shape(Capsule{0.6f, 0.3f}),
                .position = {0.0f, 0.1f, 0.0f}},
               false);
        add_bowl(w.world);
        for (int i = 0; i < 10; ++i) {
            const Position place{random(-2.5f, 2.5f), random(0.5f, 4.0f), random(-2.5f, 2.5f)};
            if (i % 3 == 0)
                w.lift(Box{{0.4f, 0.1f, 0.4f}}, place, {random(-1.0f, 1.0f), 0.0f, random(-1.0f, 1.0f)},
                       {0.0f, random(-2.0f, 2.0f), 0.0f});
            else w.crate(place, random(1.0f, 200.0f), {random(0.1f, 0.5f), random(0.1f, 0.5f), random(0.1f, 0.5f)});
        }
        for (int way = 0; way < 20; ++way) {
            const Vec3 velocity = random(0.0f, 6.0f) * random.direction();
            for (int i = 0; i < 15; ++i) {
                w.once({.velocity = velocity, .jump = random(-8.0f, 5.0f) > 0.0f ? 4.0f : 0.0f});
                ASSERT_TRUE(finite(from_origin(w.at()))) << round;
                ASSERT_GT(w.at().y, -0.01f) << round << " " << way;
                ASSERT_LT(std::fmax(std::fabs(w.at().x), std::fabs(w.at().z)), 3.05f) << round << " " << way;
            }
        }
        EXPECT_TRUE(all_finite(w.world));
        EXPECT_EQ(w.world.check(), "");
    }
}

// Beside all points of a fine grid none is nearer that keeps the bounds.
TEST(MotionBounds, AreKeptByTheNearestMotion) {
    Random random;
    for (int round = 0; round < 300; ++round) {
        MotionBound bounds[6];
        const int count = 1 + round % 6;
        for (int i = 0; i < count; ++i)
            bounds[i] = {normalize(Vec3{random(-1.0f, 1.0f), random(-1.0f, 1.0f), random(-1.0f, 1.0f)}),
                         random(-0.5f, 0.0f), false};
        const Vec3 wanted{random(-1.0f, 1.0f), random(-1.0f, 1.0f), random(-1.0f, 1.0f)};
        const std::span<const MotionBound> all{bounds, static_cast<size_t>(count)};
        const NearestMotion nearest = nearest_motion(wanted, all);
        ASSERT_TRUE(nearest.possible);
        auto keeps = [&](Vec3 d, float slack) {
            for (const MotionBound& b : all)
                if (dot(b.normal, d) < b.least - slack) return false;
            return true;
        };
        EXPECT_TRUE(keeps(nearest.motion, 1e-4f));
        for (int i = 0; i < 2000; ++i) {
            const Vec3 d{random(-1.0f, 1.0f), random(-1.0f, 1.0f), random(-1.0f, 1.0f)};
            if (keeps(d, 0.0f)) {
                EXPECT_GE(length(d - wanted), length(nearest.motion - wanted) - 1e-4f);
            }
        }
    }
    // Two that leave nothing: what stands is kept, what moves is not.
    const MotionBound squeezing[] = {{{1.0f, 0.0f, 0.0f}, 0.2f, true}, {{-1.0f, 0.0f, 0.0f}, 0.0f, false}};
    const NearestMotion held = nearest_motion({}, squeezing);
    EXPECT_FALSE(held.possible);
    EXPECT_EQ(held.motion, Vec3{});
}

}  // namespace
}  // namespace lendulet::test
