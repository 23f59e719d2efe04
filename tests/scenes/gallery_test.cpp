// The gallery does what its scenes are about: what should stand stands, what should fall falls, machines run.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scale.h"
#include "scenes/scene.h"

namespace lendulet {
namespace {

class Gallery {
public:
    explicit Gallery(const char* name) : scene(build_scene(name).value()) {}
    void run(float seconds) {
        const int steps = static_cast<int>(seconds / scene.dt);
        for (int i = 0; i < steps; ++i) {
            if (scene.before_step) scene.before_step(scene.world, static_cast<int>(scene.world.step_count()));
            scene.world.update(scene.dt).value();
            contained += scene.world.statistics().contained_bodies;
        }
        EXPECT_EQ(contained, 0);
        EXPECT_EQ(scene.world.check(), "");
    }
    int count() const { return scene.world.body_count(); }
    StaticBodyRef body(int i) const { return scene.world.get_static(scene.world.body(i)); }
    const RigidBodyRef moving(int i) const { return scene.world.get(scene.world.body(i)); }
    int find(const std::string& name) const {
        for (int i = 0; i < count(); ++i)
            if (body(i).name() == name) return i;
        ADD_FAILURE() << "no body is named " << name;
        return 0;
    }
    bool dynamic(int i) const { return body(i).type() == BodyType::dynamic; }

    Scene scene;
    int contained = 0;
};

TEST(Gallery, EveryDominoOfTheSpiralFalls) {
    Gallery gallery("domino_spiral:80");
    gallery.run(14.0f);
    int fallen = 0;
    for (int i = 1; i < gallery.count(); ++i)
        fallen += rotate(gallery.body(i).orientation(), Vec3{0.0f, 1.0f, 0.0f}).y < 0.6f;
    EXPECT_EQ(fallen, 80);
}

TEST(Gallery, TheTowerIsWrecked) {
    Gallery gallery("brick_tower:12");
    std::vector<Position> start;
    for (int i = 0; i < gallery.count(); ++i) start.push_back(gallery.body(i).position());
    gallery.run(1.0f);
    EXPECT_LT(length(gallery.body(1).position() - start[1]), 0.05f) << "it stands until it is struck";
    gallery.run(6.0f);
    int moved = 0;
    for (int i = 1; i < gallery.count(); ++i)
        moved += gallery.dynamic(i) && length(gallery.body(i).position() - start[static_cast<size_t>(i)]) > 0.5f;
    EXPECT_GT(moved, 50);
}

TEST(Gallery, TheArchAndTheHouseOfCardsStand) {
    for (const char* name : {"arch:15", "card_house:4"}) {
        Gallery gallery(name);
        std::vector<float> height;
        for (int i = 0; i < gallery.count(); ++i) height.push_back(gallery.body(i).position().y);
        gallery.run(10.0f);
        const int built = name[0] == 'a' ? 16 : gallery.count();  // crates fall onto the arch
        for (int i = 1; i < built; ++i)
            EXPECT_NEAR(gallery.body(i).position().y, height[static_cast<size_t>(i)], 0.06f) << name << ' ' << i;
    }
}

TEST(Gallery, RagdollsReachTheFootOfTheSlope) {
    Gallery gallery("ragdoll_avalanche:12");
    gallery.run(8.0f);
    int below = 0, parts = 0;
    for (int i = 0; i < gallery.count(); ++i)
        if (gallery.dynamic(i)) ++parts, below += gallery.body(i).position().y < 1.5f;
    EXPECT_GT(below, parts / 2);
}

TEST(Gallery, TheLorryCrossesTheBridge) {
    Gallery gallery("bridge:26");
    const int lorry = gallery.find("lorry");
    EXPECT_LT(gallery.body(lorry).position().x, -12.0f);
    gallery.run(13.0f);
    EXPECT_GT(gallery.body(lorry).position().x, 12.0f);
    for (int i = 0; i < gallery.count(); ++i)
        if (gallery.dynamic(i)) {
            EXPECT_GT(gallery.body(i).position().y, -4.0f) << i;
        }
}

TEST(Gallery, TheCarStaysOnItsWheels) {
    Gallery gallery("car");
    const int car = gallery.find("car");
    float way = 0.0f;
    for (int second = 0; second < 30; ++second) {
        const Position before = gallery.body(car).position();
        gallery.run(1.0f);
        way += length(gallery.body(car).position() - before);
        EXPECT_GT(rotate(gallery.body(car).orientation(), Vec3{0.0f, 1.0f, 0.0f}).y, 0.5f) << second;
    }
    EXPECT_GT(way, 80.0f);
    const Position at = gallery.body(car).position();
    EXPECT_LT(std::hypot(at.x, at.z), 58.0f) << "it is still on the hills";
}

// Speeds are to each other as the numbers of teeth, whichever way round.
TEST(Gallery, GearsKeepTheirRatios) {
    Gallery gallery("gear_train:5");
    gallery.run(6.0f);
    constexpr float teeth[] = {12.0f, 22.0f, 14.0f, 28.0f, 10.0f};
    float turned[5] = {};
    for (int step = 0; step < 300; ++step) {
        gallery.run(1.0f / 60.0f + 1e-4f);
        int gear = 0;
        for (int i = 0; i < gallery.count(); ++i)
            if (gallery.body(i).name() == "gear") turned[gear++] += gallery.moving(i).angular_velocity().z / 60.0f;
    }
    EXPECT_GT(std::abs(turned[0]), 5.0f);
    for (int i = 1; i < 5; ++i)
        EXPECT_NEAR(turned[i] * teeth[i], -turned[i - 1] * teeth[i - 1], 0.03f * std::abs(turned[0]) * teeth[0]) << i;
}

TEST(Gallery, TheWalkerWalks) {
    Gallery gallery("walker");
    const int chassis = gallery.find("chassis");
    const Position start = gallery.body(chassis).position();
    gallery.run(12.0f);
    const Vec3 way = gallery.body(chassis).position() - start;
    EXPECT_GT(std::abs(way.x), 3.0f);
    EXPECT_LT(std::abs(way.z), 1.5f);
    EXPECT_NEAR(way.y, 0.0f, 0.25f);
}

TEST(Gallery, GrainsRunThroughTheGlassAndStayInIt) {
    Gallery gallery("hourglass:300");
    auto above = [&] {
        int count = 0;
        for (int i = 0; i < gallery.count(); ++i) count += gallery.dynamic(i) && gallery.body(i).position().y > 2.9f;
        return count;
    };
    const int full = above();
    gallery.run(11.0f);
    EXPECT_LT(above(), full / 3);
    gallery.run(5.0f);  // it has been turned over
    for (int i = 0; i < gallery.count(); ++i) {
        const Position p = gallery.body(i).position();
        if (!gallery.dynamic(i)) continue;
        EXPECT_LT(std::hypot(p.x, p.z), 1.4f) << i;
        EXPECT_GT(p.y, 0.6f) << i;
    }
}

TEST(Gallery, MarblesGoRound) {
    Gallery gallery("marble_machine:30");
    std::vector<char> lifted(static_cast<size_t>(gallery.count()));
    for (int step = 0; step < 1500; ++step) {
        gallery.run(1.0f / 60.0f + 1e-4f);
        for (int i = 0; i < gallery.count(); ++i) {
            const Position p = gallery.body(i).position();
            if (!gallery.dynamic(i)) continue;
            if (p.y > 4.2f) lifted[static_cast<size_t>(i)] = 1;
            if (step % 300 == 0) {
                EXPECT_LT(std::hypot(p.x, p.y - 3.2f), 3.0f) << i;
            }
        }
    }
    int count = 0;
    for (char up : lifted) count += up;
    EXPECT_GT(count, 10);
}

// The one keeps energy and angular momentum; the other gains energy within seconds.
TEST(Gallery, TheHandleTumblesAndTheNaiveOneGainsEnergy) {
    Gallery gallery("t_handle");
    const float energy = gallery.moving(0).kinetic_energy(), spin = length(gallery.moving(1).angular_velocity());
    const Vec3 L = gallery.moving(0).angular_momentum();
    float fastest = spin, lowest = 1.0f;
    for (int step = 0; step < 1200; ++step) {
        gallery.run(1.0f / 60.0f + 1e-4f);
        fastest = maximum(fastest, length(gallery.moving(1).angular_velocity()));
        lowest = minimum(lowest, rotate(gallery.moving(0).orientation(), Vec3{0.0f, 1.0f, 0.0f}).y);
    }
    EXPECT_EQ(gallery.moving(0).angular_momentum(), L);
    EXPECT_NEAR(gallery.moving(0).kinetic_energy(), energy, 1e-3f * energy);
    EXPECT_LT(lowest, -0.9f) << "it turns over";
    EXPECT_GT(fastest, 1.25f * spin);
}

}  // namespace
}  // namespace lendulet
