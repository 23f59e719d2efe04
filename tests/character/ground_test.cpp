// Walking on what stands: floors, walls, slopes, stairs, and jumping.
#include <gtest/gtest.h>

#include "character/walk.h"

namespace lendulet::test {
namespace {

TEST(Character, GoesAsFastAsItIsToldAtAnyRate) {
    for (float step : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 240.0f}) {
        Walk w;
        w.step = step;
        w.go({2.0f, 0.0f, 1.0f}, 2.0f);
        EXPECT_NEAR(w.at().x, 4.0f, 0.08f);  // but for the first step, which finds the ground
        EXPECT_NEAR(w.at().z, 2.0f, 0.04f);
        EXPECT_NEAR(w.at().y, w.who.skin(), 1e-4f);
        EXPECT_TRUE(w.who.stands());
        EXPECT_NEAR(length(w.who.velocity() - Vec3{2.0f, 0.0f, 1.0f}), 0.0f, 1e-3f);
        const Position there = w.at();
        w.go({}, 1.0f);
        EXPECT_EQ(w.at(), there);
    }
}

TEST(Character, SlidesAlongWallsAndStopsInCorners) {
    Walk w;
    w.put(Box{{0.5f, 2.0f, 5.0f}}, {2.0f, 2.0f, 0.0f});
    w.go({2.0f, 0.0f, 1.0f}, 2.0f);
    EXPECT_NEAR(w.at().x, 1.2f - w.who.skin(), 1e-3f);
    EXPECT_NEAR(w.at().z, 2.0f, 0.02f);
    w.put(Box{{5.0f, 2.0f, 0.5f}}, {0.0f, 2.0f, 3.5f});
    w.go({2.0f, 0.0f, 1.0f}, 2.0f);
    EXPECT_NEAR(w.at().x, 1.2f - w.who.skin(), 1e-3f);
    EXPECT_NEAR(w.at().z, 2.7f - w.who.skin(), 1e-3f);
}

// Two walls that meet at 20 degrees: it stops in between, does not tremble, and comes out again.
TEST(Character, StandsStillInAcuteCorners) {
    for (float step : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 240.0f}) {
        Walk w;
        w.step = step;
        const float half = 0.5f * 20.0f * pi / 180.0f;
        for (float side : {-1.0f, 1.0f}) {
            const Quat turn = rotation_about({0.0f, 1.0f, 0.0f}, side * half);
            w.put(Box{{5.0f, 2.0f, 0.5f}}, Position{5.0f, 2.0f, 0.0f} + rotate(turn, {-5.0f, 0.0f, -side * 0.5f}),
                  turn);
        }
        w.who.set_position(w.world, {-1.0f, 0.0f, 0.05f}).value();
        w.go({3.0f, 0.0f, 0.3f}, 3.0f);
        const Position there = w.at();
        for (int i = 0; i < 30; ++i) {
            w.go({3.0f, 0.0f, 0.3f}, step);
            EXPECT_NEAR(length(w.at() - there), 0.0f, 1e-4f);
        }
        w.go({-3.0f, 0.0f, 0.0f}, 0.5f);
        EXPECT_LT(w.at().x, there.x - 1.0f);
    }
}

TEST(Character, WalksSlopesAtItsSpeedAndNotThoseTooSteep) {
    for (float slope : {0.3f, 0.7f, 0.9f, 1.2f}) {
        Walk w;
        w.who.set_position(w.world, {-1.0f, 0.01f, 0.0f}).value();
        const Quat turn = rotation_about({0.0f, 0.0f, 1.0f}, slope);
        w.put(Box{{20.0f, 1.0f, 3.0f}}, at(rotate(turn, {20.0f, -1.0f, 0.0f})), turn);
        w.go({2.0f, 0.0f, 0.0f}, 2.0f);
        const Position from = w.at();
        if (slope > 0.8f) {
            EXPECT_NEAR(from.y, w.who.skin(), 1e-3f) << slope;
            EXPECT_LT(from.x, 0.0f);
            continue;
        }
        for (int i = 0; i < 60; ++i) {
            w.go({2.0f, 0.0f, 0.0f}, dt);
            EXPECT_TRUE(w.who.stands());
        }
        EXPECT_NEAR(w.at().x - from.x, 2.0f * std::cos(slope), 2e-3f) << slope;
        EXPECT_NEAR(w.at().y - from.y, 2.0f * std::sin(slope), 2e-3f) << slope;
        const Position top = w.at();
        w.go({}, 1.0f);
        EXPECT_NEAR(length(w.at() - top), 0.0f, 1e-4f) << "it does not slide down";
        for (int i = 0; i < 60; ++i) {
            w.go({-2.0f, 0.0f, 0.0f}, dt);
            EXPECT_TRUE(w.who.stands()) << "it does not hop";
        }
        EXPECT_NEAR(length(w.at() - from), 0.0f, 5e-3f) << slope;
    }
}

// What is too steep it slides down, with g sin(slope).
TEST(Character, SlidesDownSteepSlopes) {
    const float slope = 1.0f;
    Walk w({.max_slope = 0.8f}, false);
    const Quat turn = rotation_about({0.0f, 0.0f, 1.0f}, slope);
    w.put(Box{{100.0f, 1.0f, 3.0f}}, {0.0f, 0.0f, 0.0f}, turn);
    // The capsule's lower ball a skin off the face.
    w.who.set_position(w.world, at(rotate(turn, {0.0f, 1.301f + w.who.skin(), 0.0f}) - Vec3{0.0f, 0.3f, 0.0f})).value();
    w.go({}, 0.1f);
    EXPECT_EQ(w.who.state().ground, CharacterGround::steep);
    const Position from = w.at();
    const float speed = length(w.who.velocity());
    w.go({5.0f, 0.0f, 0.0f}, 1.0f);
    const float gone = speed + 0.5f * 9.81f * std::sin(slope);
    EXPECT_NEAR(length(w.at() - from), gone, 0.02f * gone);
    EXPECT_EQ(w.who.state().ground, CharacterGround::steep);
}

TEST(Character, StandsInGroovesOfSteepFaces) {
    Walk w({.position = {0.0f, 1.0f, 0.0f}}, false);
    for (float side : {-1.0f, 1.0f}) w.put(Plane{{side * std::sin(1.0f), std::cos(1.0f), 0.0f}}, {});
    w.go({}, 2.0f);
    const Position there = w.at();
    int stood = 0;
    for (int i = 0; i < 30; ++i) {
        w.go({}, dt);
        stood += w.who.stands();
        EXPECT_NEAR(length(w.at() - there), 0.0f, 1e-3f);
    }
    EXPECT_EQ(stood, 30);
    w.go({0.0f, 0.0f, 1.0f}, 1.0f);
    EXPECT_NEAR(w.at().z - there.z, 1.0f, 0.02f);
}

TEST(Character, ClimbsStairsGoesDownThemAndStopsAtWhatIsHigher) {
    for (float step : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 240.0f})
        for (const Shape& shape :
             {Shape(Capsule{0.6f, 0.3f}), Shape(Cylinder{0.9f, 0.3f}), Shape(Box{{0.3f, 0.9f, 0.3f}})}) {
            Walk w({.shape = shape});
            w.step = step;
            for (int i = 0; i < 6; ++i) {
                const float half = 0.15f * static_cast<float>(i + 1);
                w.put(Box{{0.2f, half, 2.0f}}, {1.0f + 0.4f * static_cast<float>(i), half, 0.0f});
            }
            const float landing = 0.5f * 1.8f;
            w.put(Box{{1.0f, landing, 2.0f}}, {4.2f, landing, 0.0f});
            w.go({2.0f, 0.0f, 0.0f}, 2.0f);
            EXPECT_NEAR(w.at().y, 1.8f + w.who.skin(), 2e-3f) << shape.index() << " " << step;
            EXPECT_NEAR(w.at().x, 4.0f, 0.2f) << "as fast as on the level " << shape.index() << " " << step;
            for (int i = 0; i < static_cast<int>(1.9f / step); ++i) {
                w.go({-2.0f, 0.0f, 0.0f}, step);
                EXPECT_TRUE(w.who.stands()) << i << " " << shape.index() << " " << step;
            }
            w.put(Box{{0.2f, 0.2f, 2.0f}}, {-2.0f, 0.2f, 0.0f});  // 0.4 m high
            w.go({-2.0f, 0.0f, 0.0f}, 2.0f);
            EXPECT_NEAR(w.at().x, -1.5f + w.who.skin(), 5e-3f) << shape.index();
            EXPECT_NEAR(w.at().y, w.who.skin(), 2e-3f) << shape.index();
        }
}

// Up to v^2 / 2 g, and down again after 2 v / g, at any rate.
TEST(Character, JumpsAsHighAsAParabolaAndLands) {
    for (float step : {1.0f / 30.0f, 1.0f / 60.0f, 1.0f / 240.0f}) {
        Walk w;
        w.step = step;
        w.once();
        w.once({.velocity = {1.0f, 0.0f, 0.0f}, .jump = 4.0f});
        float top = 0.0f, x = 0.0f;
        int steps = 1;
        while (!w.who.stands() && steps < 1000) {
            w.once();
            top = std::fmax(top, w.at().y);
            x = w.at().x;
            ++steps;
        }
        EXPECT_NEAR(top, 16.0f / (2.0f * 9.81f) + w.who.skin(), 4.0f * step * step + 1e-3f);
        EXPECT_NEAR(static_cast<float>(steps) * step, 8.0f / 9.81f, 2.0f * step);
        EXPECT_NEAR(x, 8.0f / 9.81f, 2.0f * step);
        EXPECT_NEAR(w.at().y, w.who.skin(), 1e-3f);
    }
}

TEST(Character, HitsItsHeadAndFallsAgain) {
    Walk w;
    w.put(Box{{2.0f, 0.5f, 2.0f}}, {0.0f, 2.6f, 0.0f});
    w.once();
    w.once({.jump = 4.0f});
    for (int i = 0; i < 10; ++i) w.once();
    EXPECT_LE(w.who.velocity().y, 0.0f);
    EXPECT_LT(w.at().y, 0.3f);
}

TEST(Character, AcceleratesInTheAirAsItIsTold) {
    Walk w({.position = {0.0f, 5.0f, 0.0f}}, false);
    for (int i = 0; i < 60; ++i) w.once({.acceleration = {3.0f, 9.81f, 0.0f}});
    EXPECT_NEAR(w.at().x, 1.5f, 1e-3f);
    EXPECT_NEAR(w.at().y, 5.0f, 1e-3f);
}

// Any direction is up, and any size of character.
TEST(Character, WalksWithAnyUpAtAnySize) {
    for (float size : {0.1f, 1.0f, 11.0f}) {
        const Quat turn = normalize(Quat{0.3f, -0.5f, 0.2f, 0.7f});
        const Vec3 up = rotate(turn, {0.0f, 1.0f, 0.0f}), ahead = rotate(turn, {1.0f, 0.0f, 0.0f});
        World world = WorldBuilder{}.gravity(-9.81f * size * up).build().value();
        world
            .add_static_body(
                {.shape = Box{{20.0f * size, size, 5.0f * size}}, .position = at(-size * up), .orientation = turn})
            .value();
        world
            .add_static_body({.shape = Box{{2.0f * size, 0.15f * size, 2.0f * size}},
                              .position = at(4.0f * size * ahead + 0.15f * size * up),
                              .orientation = turn})
            .value();
        Character who = Character::add(world, {.shape = Capsule{0.6f * size, 0.3f * size},
                                               .position = at(0.05f * size * up),
                                               .step_height = 0.35f * size})
                            .value();
        for (int i = 0; i < 120; ++i) {
            who.update(world, {.velocity = 2.0f * size * ahead}, dt).value();
            world.update(dt).value();
        }
        EXPECT_TRUE(who.stands());
        EXPECT_NEAR(dot(from_origin(who.position()), ahead) / size, 3.8f, 0.1f);  // it falls for 0.1 s first
        EXPECT_NEAR(dot(from_origin(who.position()), up) / size, 0.3f + who.skin() / size, 2e-3f);
    }
}

}  // namespace
}  // namespace lendulet::test
