// Queries bring their trees up to date by what has changed: the answers are those of a world that builds them anew.
#include <gtest/gtest.h>

#include <vector>

#include "lendulet/lendulet.h"
#include "scale.h"
#include "world/support.h"

namespace lendulet {
namespace {

struct Game {
    World world = WorldBuilder().build().value();
    std::vector<BodyId> bodies;
    uint32_t state = 1;

    float random(float low, float high) {
        state = state * 1664525u + 1013904223u;
        return low + (high - low) * static_cast<float>(state >> 8) * (1.0f / 16777216.0f);
    }
    Position place(float low, float high) { return {random(-20.0f, 20.0f), random(low, high), random(-20.0f, 20.0f)}; }
    void add() {
        if (random(0.0f, 1.0f) < 0.3f)
            bodies.push_back(
                world.add_static_body({.shape = Box{{0.4f, 0.4f, 0.4f}}, .position = place(0.0f, 6.0f)}).value());
        else
            bodies.push_back(world
                                 .add_rigid_body({.shape = Sphere{random(0.1f, 0.5f)},
                                                  .position = place(1.0f, 8.0f),
                                                  .kinematic = random(0.0f, 1.0f) < 0.1f})
                                 .value());
    }
    void change() {
        const auto i = static_cast<size_t>(random(0.0f, static_cast<float>(bodies.size()) - 0.01f));
        const BodyId body = bodies[i];
        if (random(0.0f, 1.0f) < 0.4f) {
            ASSERT_TRUE(world.remove_body(body).ok());
            bodies[i] = bodies.back();
            bodies.pop_back();
            add();
        } else if (world.get_static(body).type() != BodyType::fixed) {
            ASSERT_TRUE(world.get(body).set_pose(place(1.0f, 8.0f), {}).ok());
        }
    }
    void expect_answers_of_a_new_world() {
        const World fresh = world.fork().value();
        for (int i = 0; i < 20; ++i) {
            const Ray ray{place(-1.0f, 9.0f), {random(-30.0f, 30.0f), random(-8.0f, 8.0f), random(-30.0f, 30.0f)}};
            const QueryHit hit = world.cast_ray(ray).value(), expected = fresh.cast_ray(ray).value();
            ASSERT_EQ(hit.collider, expected.collider);
            ASSERT_EQ(hit.fraction, expected.fraction);
            const Position low = place(-1.0f, 4.0f);
            std::vector<Proximity> found(200), right(200);
            const Aabb box{low, low + Vec3{6.0f, 4.0f, 6.0f}};
            const int n = world.overlap_box(box, found).value();
            ASSERT_EQ(n, fresh.overlap_box(box, right).value());
            for (size_t k = 0; k < static_cast<size_t>(n) && k < found.size(); ++k)
                ASSERT_EQ(found[k].collider, right[k].collider);
        }
    }
};

TEST(QueryTrees, FollowWhatComesAndGoes) {
    for (int changes : {1, 5, 150}) {
        Game game;
        game.world.add_static_body({.shape = Plane{}}).value();
        for (int i = 0; i < 300; ++i) game.add();
        for (int step = 0; step < scaled(60, 4); ++step) {
            for (int k = 0; k < changes; ++k) game.change();
            const float dt = step % 3 != 0 ? 1.0f / 60.0f : 0.0f;
            ASSERT_TRUE(game.world.update(dt).ok());
            if (step % 4 != 1) game.expect_answers_of_a_new_world();
            if (HasFatalFailure()) return;
        }
    }
}

TEST(QueryTrees, FollowBodiesThatFallAsleep) {
    Game game;
    game.world.add_static_body({.shape = Plane{}}).value();
    for (int i = 0; i < 200; ++i) game.add();
    for (int step = 0; step < scaled(400, 20); ++step) {
        ASSERT_TRUE(game.world.update(1.0f / 60.0f).ok());
        if (step % 50 == 0) game.expect_answers_of_a_new_world();
    }
    game.expect_answers_of_a_new_world();
    const std::vector<uint8_t> before = game.world.snapshot();
    for (BodyId body : game.bodies) {
        if (game.world.get_static(body).type() != BodyType::dynamic) continue;
        ASSERT_TRUE(game.world.get(body).set_velocity({0.0f, 4.0f, 0.0f}).ok());
    }
    for (int step = 0; step < 20; ++step) ASSERT_TRUE(game.world.update(1.0f / 60.0f).ok());
    game.expect_answers_of_a_new_world();
    ASSERT_TRUE(game.world.restore(before).ok());
    game.expect_answers_of_a_new_world();
}

}  // namespace
}  // namespace lendulet
