// A character walks up stairs, rides a lift, pushes a crate, and ducks under a beam.
//
// Every frame: tell kinematic bodies where they go, update the character, then the world, all with the same dt.
#include "lendulet/character.h"

#include <cstdio>

#include "lendulet/lendulet.h"

using namespace lendulet;

constexpr float dt = 1.0f / 60.0f;
enum Stance { standing, crouching };

struct Game {
    World world = WorldBuilder().build().value();
    Character hero = make_hero(world);
    BodyId lift{}, crate{};

    static Character make_hero(World& world) {
        const Shape stances[] = {Capsule{0.6f, 0.3f}, Capsule{0.2f, 0.3f}};  // 1.8 m and 1 m tall
        return Character::add(world, {.stances = stances}).value();
    }
    void block(Vec3 half, Position middle) { world.add_static_body({.shape = Box{half}, .position = middle}).value(); }
    void frame(Vec3 velocity, float jump = 0.0f) {
        hero.update(world, {.velocity = velocity, .jump = jump}, dt).value();
        world.update(dt).value();
    }
    void go(Vec3 velocity, float seconds) {
        for (int i = 0; i < static_cast<int>(seconds / dt); ++i) frame(velocity);
    }
    // The lift goes up and stays there; who stands on it goes along.
    void ride(float height, float seconds) {
        const Position from = world.get(lift).position();
        const int steps = static_cast<int>(seconds / dt);
        for (int i = 1; i <= steps; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(steps);
            world.get(lift).move_to(from + Vec3{0.0f, share * height, 0.0f}, {}, dt).value();
            frame({});
        }
        world.get(lift).set_velocity({}).value();
    }
    bool report(const char* what, bool well) const {
        const Position p = hero.position();
        std::printf("%-22s at (%.2f, %.2f, %.2f)%s\n", what, p.x, p.y, p.z, well ? "" : ": NOT AS IT SHOULD BE");
        return well;
    }
};

int main() {
    Game g;
    g.world.add_static_body({.shape = Plane{}}).value();
    for (int i = 0; i < 5; ++i)  // five steps of 0.2 m, the last of them long
        g.block({i < 4 ? 0.15f : 1.0f, 0.1f * static_cast<float>(i + 1), 1.0f},
                {1.0f + 0.3f * static_cast<float>(i) + (i < 4 ? 0.0f : 0.85f), 0.1f * static_cast<float>(i + 1), 0.0f});
    g.lift =
        g.world.add_rigid_body({.shape = Box{{1.0f, 0.1f, 1.0f}}, .position = {5.05f, 0.9f, 0.0f}, .kinematic = true})
            .value();
    g.block({3.0f, 0.5f, 1.0f}, {9.05f, 2.5f, 0.0f});  // a ledge, 3 m up
    g.crate = g.world.add_rigid_body({.shape = Box{}, .position = {9.0f, 3.5f, 0.0f}, .mass = 60.0f}).value();

    bool well = true;
    g.go({2.0f, 0.0f, 0.0f}, 1.7f);
    well &= g.report("up the stairs", g.hero.stands() && g.hero.position().y > 0.99f);
    g.go({2.0f, 0.0f, 0.0f}, 0.9f);
    well &= g.report("on the lift", g.hero.state().ground_body == g.lift);
    g.ride(2.0f, 2.0f);
    well &= g.report("up with it", g.hero.stands() && g.hero.position().y > 2.99f);
    for (int i = 0; i < 300 && g.world.get(g.crate).position().x < 10.5f; ++i) g.frame({2.0f, 0.0f, 0.0f});
    well &= g.report("the crate is pushed", g.world.get(g.crate).position().x > 10.4f);
    g.go({-2.0f, 0.0f, 0.0f}, 0.5f);

    g.frame({-1.0f, 0.0f, 0.0f}, 4.0f);
    float top = 0.0f;
    for (int i = 0; i < 60 && !g.hero.stands(); ++i) {
        g.frame({});
        top = maximum(top, g.hero.position().y);
    }
    well &= g.report("jumped and landed", g.hero.stands() && top > 3.8f);

    const Position here = g.hero.position();
    g.block({0.5f, 0.5f, 1.0f}, here + Vec3{-1.5f, 1.7f, 0.0f});  // a beam, 1.2 m above the ground
    g.go({-2.0f, 0.0f, 0.0f}, 1.0f);
    well &= g.report("a beam is in the way", g.hero.position().x > here.x - 0.8f);
    well &= g.hero.set_stance(g.world, crouching).value();
    g.go({-1.0f, 0.0f, 0.0f}, 0.8f);
    well &= g.report("ducked under it", !g.hero.set_stance(g.world, standing).value());  // no room
    return well ? 0 : 1;
}
