// A lift carries crates while a game draws at a rate of its own: fixed steps, poses in between, a kinematic body that
// goes where it is told, and only what moved is drawn anew.
#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <vector>

#include "lendulet/lendulet.h"

using namespace lendulet;

namespace {

constexpr float dt = 1.0f / 60;

// What a renderer keeps of a body: its last two poses.
struct Drawn {
    Pose before, now;
};

Position lift_at(double time) { return {0, 1.0f + 0.8f * static_cast<float>(std::sin(time)), 0}; }

}  // namespace

int main() {
    World world = WorldBuilder{}.build().value();
    world.add_static_body({.shape = Plane{}}).value();
    BodyId lift = world.add_rigid_body({.shape = Box{{2, 0.1f, 2}}, .position = lift_at(0), .kinematic = true}).value();
    BodyId crate = world.add_rigid_body({.shape = Box{{0.3f, 0.3f, 0.3f}}, .position = {0, 1.5f, 0}}).value();
    for (float x : {4.0f, 5.0f, 6.0f}) world.add_rigid_body({.shape = Box{}, .position = {x, 0.5f, 0}}).value();

    std::unordered_map<uint32_t, Drawn> scene;  // by BodyId::index
    std::vector<BodyId> moved(16);
    float unspent = 0.0f;  // time that has passed and is not simulated yet
    int copies = 0;
    for (int frame = 0; frame < 600; ++frame) {
        unspent += 1.0f / 144;  // what the clock says of the last frame; never more than some steps, or it snowballs
        while (unspent >= dt) {
            world.get(lift).move_to(lift_at(world.time() + dt), {}, dt).value();
            world.update(dt).value();
            const auto room = static_cast<size_t>(world.body_count());
            if (moved.size() < room) moved.resize(room);
            for (auto& [index, drawn] : scene) drawn.before = drawn.now;
            for (int i = 0, count = world.moved_bodies(moved); i < count; ++i, ++copies) {
                const Pose now = world.get(moved[static_cast<size_t>(i)]).pose();
                auto [place, is_new] = scene.try_emplace(moved[static_cast<size_t>(i)].index, Drawn{now, now});
                place->second.now = now;
            }
            unspent -= dt;
        }
        if (scene.empty() || frame % 144 != 0) continue;
        const Drawn& drawn = scene.at(crate.index);
        const Pose seen = interpolate(drawn.before, drawn.now, unspent / dt);
        std::printf("%3d frames: the crate is drawn at %.3f m\n", frame, seen.position.y);
    }
    std::printf("poses copied: %d of %d\n", copies, static_cast<int>(world.step_count()) * world.body_count());
}
