// A door on a hinge, a crane with a rope, an arm that a servo turns, and a shelf that breaks.
#include <cstdio>

#include "lendulet/lendulet.h"

using namespace lendulet;

namespace {

void run(World& world, float seconds) {
    for (float t = 0; t < seconds; t += 1.0f / 60) world.update(1.0f / 60).value();
}

// A door of 20 kg that opens by 100 degrees and is pulled shut.
void door() {
    World world = WorldBuilder{}.build().value();
    BodyId frame = world.add_static_body({.shape = Box{{0.05f, 1, 0.05f}}, .position = {0, 1, 0}}).value();
    BodyId leaf =
        world.add_rigid_body({.shape = Box{{0.4f, 1, 0.02f}}, .position = {0.45f, 1, 0}, .mass = 20.0f}).value();
    JointDef hinge = world.joint_at(JointType::hinge, frame, leaf, {0.05f, 1, 0}, {0, 1, 0}).value();
    hinge.limit = {0.0f, 100.0f / 180 * pi};
    hinge.spring = {.stiffness = 5, .damping = 8};  // N m/rad, N m s/rad
    JointId joint = world.add_joint(hinge).value();

    world.get(leaf).apply_angular_impulse({0, 10, 0}).value();
    float widest = 0;
    for (int i = 0; i < 600; ++i) {
        world.update(1.0f / 60).value();
        widest = maximum(widest, world.joint(joint).position);
    }
    std::printf("door: opened by %.0f degrees, now at %.0f\n", widest * 180 / pi,
                world.joint(joint).position * 180 / pi);
}

// A load on a rope of 3 m: the distance joint only keeps it from being farther away.
void crane() {
    World world = WorldBuilder{}.build().value();
    BodyId jib = world.add_static_body({.shape = Box{{2, 0.1f, 0.1f}}, .position = {0, 5, 0}}).value();
    BodyId load = world.add_rigid_body({.shape = Sphere{0.3f}, .position = {2, 4, 0}, .mass = 100.0f}).value();
    JointDef rope{.type = JointType::distance, .body_a = jib, .body_b = load, .limit = {0, 3}};
    rope.frame_a.translation = {2, -0.1f, 0};
    JointId joint = world.add_joint(rope).value();
    run(world, 5);
    std::printf("crane: the rope is %.3f m long and bears %.0f N\n", world.joint(joint).position,
                length(world.joint(joint).force));
}

// An arm of 1 m and 2 kg; the spring's target is where the servo should be.
void servo() {
    World world = WorldBuilder{}.build().value();
    BodyId base = world.add_static_body({.shape = Box{{0.1f, 0.1f, 0.1f}}}).value();
    BodyId arm = world.add_rigid_body({.shape = Capsule{0.4f, 0.1f}, .position = {0, 0.6f, 0}, .mass = 2.0f}).value();
    JointDef axle = world.joint_at(JointType::hinge, base, arm, {0, 0, 0}, {0, 0, 1}).value();
    JointId joint = world.add_joint(axle).value();
    for (float target : {0.5f, -0.5f, 1.2f}) {
        world.set_spring(joint, {.stiffness = 2000, .damping = 200, .target = target, .max_force = 150}).value();
        run(world, 1.5f);
        std::printf("servo: %.2f rad asked for, at %.3f\n", target, world.joint(joint).position);
    }
}

// A shelf on two bolts that hold 100 N each; books are laid on it until they do not.
void shelf() {
    World world = WorldBuilder{}.build().value();
    BodyId wall = world.add_static_body({.shape = Box{{1, 1, 0.1f}}, .position = {0, 2, -0.3f}}).value();
    BodyId board =
        world.add_rigid_body({.shape = Box{{0.5f, 0.02f, 0.2f}}, .position = {0, 2, 0}, .mass = 4.0f}).value();
    for (float x : {-0.4f, 0.4f}) {
        JointDef bolt = world.joint_at(JointType::fixed, wall, board, {x, 2, -0.2f}).value();
        bolt.break_force = 100;
        world.add_joint(bolt).value();
    }
    for (int books = 1; world.joint_count() == 2; ++books) {
        const int row = (books - 1) / 3, column = (books - 1) % 3;
        const Position place{0.25f * static_cast<float>(column - 1), 2.065f + 0.08f * static_cast<float>(row), 0};
        world.add_rigid_body({.shape = Box{{0.1f, 0.04f, 0.1f}}, .position = place, .mass = 2.0f}).value();
        for (int i = 0; i < 60; ++i) {
            world.update(1.0f / 60).value();
            for (const JointBreak& b : world.joint_breaks())
                std::printf("shelf: a bolt broke at %.0f N under %d books\n", length(b.force), books);
        }
    }
}

}  // namespace

int main() {
    door();
    crane();
    servo();
    shelf();
}
