// Snapshots: what comes after a restore is what came after the snapshot, to the last bit; bad bytes change nothing.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "world/snapshots.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

struct Stretch {
    const char* scene;
    int before, after;  // steps to the snapshot, and from there
};
void PrintTo(const Stretch& run, std::ostream* out) { *out << run.scene << " at " << run.before; }

class Snapshots : public ::testing::TestWithParam<Stretch> {};

TEST_P(Snapshots, TheRunAfterARestoreIsTheRunWithout) {
    const Stretch& run = GetParam();
    Scene scene = build_scene(run.scene).value();
    step(scene, run.before);
    const std::vector<uint8_t> saved = scene.world.snapshot();
    const uint64_t hash = scene.world.hash();
    const std::vector<uint64_t> expected = hashes(scene, run.after);
    for (int round = 0; round < 2; ++round) {
        Status restored = scene.world.restore(saved);
        ASSERT_TRUE(restored.ok()) << restored.error().message;
        EXPECT_EQ(scene.world.hash(), hash);
        EXPECT_EQ(scene.world.step_count(), static_cast<uint64_t>(run.before));
        EXPECT_EQ(scene.world.snapshot(), saved) << "a restored world gives the same bytes";
        EXPECT_EQ(scene.world.check(), "");
        ASSERT_EQ(hashes(scene, run.after), expected);
    }
}

TEST_P(Snapshots, AWorldThatWasBuiltAlikeTakesThem) {
    const Stretch& run = GetParam();
    Scene scene = build_scene(run.scene).value();
    step(scene, run.before);
    const std::vector<uint8_t> saved = scene.world.snapshot();
    const std::vector<uint64_t> expected = hashes(scene, run.after);
    auto configure = [](WorldBuilder& b) { b.workers(2).width(4).broad_phase(BroadPhaseType::sweep_1); };
    Scene other = build_scene(run.scene, configure).value();
    Status restored = other.world.restore(saved);
    ASSERT_TRUE(restored.ok()) << restored.error().message;
    ASSERT_EQ(hashes(other, run.after), expected);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Snapshots,
                         ::testing::Values(Stretch{"box_pile:60", 0, 40}, Stretch{"box_pile:60", 90, 60},
                                           Stretch{"mixed_pile:80", 120, 60}, Stretch{"stack:8", 60, 120},
                                           Stretch{"stack:30", 90, 60}, Stretch{"mass_ratio:1000", 60, 60},
                                           Stretch{"ragdolls:3", 60, 60}, Stretch{"mesh_terrain:40", 120, 40},
                                           Stretch{"height_field:40", 120, 40}, Stretch{"tumbler:4", 90, 60},
                                           Stretch{"newtons_cradle", 70, 60}, Stretch{"chain_heavy", 50, 60},
                                           Stretch{"dominoes:20", 60, 60}, Stretch{"large_world_sleep:60", 150, 90},
                                           Stretch{"wall_ball:6", 30, 60}));

// Sleeping before, waking after: the contacts of sleepers are in the snapshot too.
TEST(Snapshot, HoldsSleepersAndWhatWakesThem) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 4);
    run(world, 200);
    ASSERT_TRUE(world.get(stack[0]).asleep());
    const std::vector<uint8_t> asleep = world.snapshot();
    auto strike = [&] {
        run(world, 3);
        world.get(stack[3]).apply_impulse({900.0f, 0.0f, 0.0f}).value();
        run(world, 90);
        return world.hash();
    };
    const uint64_t expected = strike();
    world.restore(asleep).value();
    EXPECT_TRUE(world.get(stack[0]).asleep());
    EXPECT_EQ(world.contact_count(), 4);
    EXPECT_EQ(strike(), expected);
}

TEST(Snapshot, HoldsGravityForcesMotorsAndOverlaps) {
    World world = WorldBuilder{}.build().value();
    BodyId floor = add_floor(world);
    BodyId cube = add_cube(world, 0.0f, 3);
    BodyId arm = add_cube(world, 4.0f, 1);
    const ColliderDef gate[] = {{.shape = Box{{2.0f, 2.0f, 2.0f}}, .is_trigger = true}};
    world.add_static_body({.position = {0.0f, 3.0f, 0.0f}, .colliders = gate}).value();
    JointId hinge = world.add_joint(world.joint_at(JointType::hinge, floor, arm, {4.0f, 1.5f, 0.0f}).value()).value();
    world.set_motor(hinge, {2.0f, 1e5f}).value();
    run(world, 20);
    world.get(cube).apply_force({5000.0f, 0.0f, 0.0f}).value();
    const std::vector<uint8_t> saved = world.snapshot();
    const size_t overlaps = world.overlaps().size();
    ASSERT_GT(overlaps, 0u);
    run(world, 30);
    const uint64_t expected = world.hash();
    world.set_gravity({0.0f, 3.0f, 0.0f}).value();
    world.set_motor(hinge, {-5.0f, 1e5f}).value();
    run(world, 40);
    world.restore(saved).value();
    EXPECT_EQ(world.config().gravity, (Vec3{0.0f, -9.81f, 0.0f}));
    EXPECT_EQ(world.overlaps().size(), overlaps);
    run(world, 30);
    EXPECT_EQ(world.hash(), expected);
}

// A body that woke without a contact has forgotten the substeps that it slept with, whether it was saved since or not.
TEST(Snapshot, HoldsWhatBodiesRememberThatWokeInTheAir) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    BodyId cube = add_cube(world, 0.0f, 0);
    run(world, 120);
    ASSERT_TRUE(world.get(cube).asleep());
    world.get(cube).set_pose({0.0f, 2.0f, 0.0f}, {}).value();
    run(world, 3);
    World fork = world.fork().value();
    for (int step = 0; step < 60; ++step) {
        ASSERT_EQ(fork.snapshot(), world.snapshot()) << step;
        run(world, 1);
        run(fork, 1);
    }
}

// Bytes tell of room that nobody has written to, which hashes do not.
// What is done to a world between two steps wakes bodies whose contacts then rest until the next step begins.
TEST(Snapshot, MayBeTakenRightAfterSomethingWoke) {
    using Change = void (*)(World&, RigidBodyRef);
    const Change changes[] = {
        [](World&, RigidBodyRef box) { box.wake(); },
        [](World&, RigidBodyRef box) {
            box.apply_impulse({900.0f, 0.0f, 300.0f}).value();
        },
        [](World&, RigidBodyRef box) {
            box.set_pose({0.2f, 0.5f, 0.0f}, {}).value();
        },
        [](World&, RigidBodyRef box) { box.set_type(BodyType::kinematic).value(); },
        [](World& world, RigidBodyRef box) { world.set_events(box.collider(), Events::all).value(); },
        [](World& world, RigidBodyRef box) { world.set_filter(box.collider(), {2}).value(); },
        [](World& world, RigidBodyRef box) { world.set_material(box.collider(), {.static_friction = 0.1f}).value(); },
        [](World& world, RigidBodyRef) {
            world.set_gravity({1.0f, -5.0f, 0.0f}).value();
        },
        [](World& world, RigidBodyRef box) { world.remove_body(box.id()).value(); },
    };
    for (size_t i = 0; i < std::size(changes); ++i)
        for (const float then : {dt, 0.5f * dt}) {  // shorter steps than those in which it fell asleep
            auto build = [] {
                World world = WorldBuilder{}.build().value();
                add_floor(world);
                add_stack(world, 0.0f, 3);
                add_cube(world, 2.0f, 0);
                return world;
            };
            auto [world, other] = std::pair{build(), build()};
            for (World* w : {&world, &other}) {
                run(*w, 120);
                ASSERT_TRUE(w->get(w->body(1)).asleep());
                run(*w, 5, then);
                changes[i](*w, w->get(w->body(1)));
            }
            const std::vector<uint8_t> saved = world.snapshot();
            const uint64_t hash = world.hash();
            World fork = world.fork().value();
            run(world, 60, then);
            run(fork, 60, then);
            EXPECT_EQ(fork.hash(), world.hash()) << i;
            run(other, 60, then);
            EXPECT_EQ(other.hash(), world.hash()) << i;
            for (World* w : {&world, &other}) {
                Status restored = w->restore(saved);
                ASSERT_TRUE(restored.ok()) << i << restored.error().message;
                EXPECT_EQ(w->hash(), hash) << i;
                EXPECT_EQ(w->snapshot(), saved) << i;
                EXPECT_EQ(w->check(), "") << i;
                run(*w, 60, then);
                EXPECT_EQ(w->hash(), fork.hash()) << i;
            }
        }
}

TEST(Snapshot, OfCapsulesThatTouchIsTheSameForAllWidths) {
    auto make = [](int width, int workers) {
        World world = WorldBuilder{}.width(width).workers(workers).build().value();
        add_floor(world);
        for (int i = 0; i < 24; ++i) {
            const float x = 0.25f * static_cast<float>(i % 5), y = 0.3f + 0.3f * static_cast<float>(i / 5);
            world.add_rigid_body({.shape = Capsule{0.2f, 0.15f}, .position = {x, y, 0.01f * static_cast<float>(i)}})
                .value();
        }
        return world;
    };
    World world = make(1, 1), wide = make(16, 2);
    for (int step = 0; step < 30; ++step) {
        run(world, 1);
        run(wide, 1);
        ASSERT_EQ(wide.snapshot(), world.snapshot()) << step;
    }
}

// Servos: springs whose targets are set again as the world goes.
TEST(Snapshot, HoldsSprings) {
    for (JointType type : {JointType::hinge, JointType::slider, JointType::distance, JointType::six_degrees}) {
        World world = WorldBuilder{}.build().value();
        BodyId floor = add_floor(world), arm = add_cube(world, 0.0f, 1);
        JointDef def = world.joint_at(type, floor, arm, {0.0f, 4.0f, 0.0f}, {0.0f, 1.0f, 0.0f}).value();
        JointId joint = world.add_joint(def).value();
        auto aim = [&](Spring spring) {
            if (type == JointType::six_degrees) world.set_spring(joint, Coordinate::x, spring).value();
            else world.set_spring(joint, spring).value();
        };
        aim({.stiffness = 5e4f, .damping = 2e3f, .target = 1.0f});
        run(world, 20);
        const std::vector<uint8_t> saved = world.snapshot();
        run(world, 30);
        const uint64_t expected = world.hash();
        world.restore(saved).value();
        aim({.stiffness = 5e4f, .damping = 2e3f, .target = 0.3f, .max_force = 1e4f, .target_velocity = 0.5f});
        run(world, 30);
        EXPECT_NE(world.hash(), expected) << static_cast<int>(type);
        world.restore(saved).value();
        EXPECT_EQ(world.snapshot(), saved) << static_cast<int>(type);
        run(world, 30);
        EXPECT_EQ(world.hash(), expected) << static_cast<int>(type);
    }
}

// Boxes with round edges, whose queries remember a face. Bytes tell of caches that the motion does not show yet.
TEST(Snapshot, HoldsWhereDistanceQueriesBegin) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    for (int i = 0; i < 27; ++i) {
        const float x = static_cast<float>(i % 3), y = static_cast<float>(i / 9), z = static_cast<float>(i / 3 % 3);
        world
            .add_rigid_body({.shape = Box{{0.3f, 0.3f, 0.3f}, 0.05f},
                             .position = {0.9f * x + 0.1f * y, 1.0f + 0.9f * y, 0.9f * z},
                             .orientation = rotation_about({0.6f, 0.0f, 0.8f}, 0.5f * (x + z))})
            .value();
    }
    run(world, 40);
    const std::vector<uint8_t> saved = world.snapshot();
    run(world, 5);
    const std::vector<uint8_t> expected = world.snapshot();
    run(world, 20);
    world.restore(saved).value();
    run(world, 5);
    EXPECT_EQ(world.snapshot(), expected);
}

TEST(Snapshot, RemovesWhatWasAddedSinceAndNewBodiesGetTheSamePlaces) {
    World world = WorldBuilder{}.build().value();
    BodyId floor = add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 3);
    world.remove_body(add_cube(world, 3.0f, 0)).value();
    world.remove_body(add_cube(world, 5.0f, 0)).value();
    run(world, 40);
    const std::vector<uint8_t> saved = world.snapshot();
    BodyId last{};
    auto go_on = [&] {
        const ColliderDef two[] = {{.shape = Box{{0.3f, 0.3f, 0.3f}}},
                                   {.shape = Sphere{0.4f}, .local = {{0.0f, 0.5f, 0.0f}, {}}}};
        for (int i = 0; i < 3; ++i)
            last = world.add_rigid_body({.position = {0.1f, 4.0f + static_cast<float>(i), 0.0f}, .colliders = two})
                       .value();
        world.add_joint(world.joint_at(JointType::ball, stack[2], last, {0.0f, 4.0f, 0.0f}).value()).value();
        run(world, 60);
        return world.hash();
    };
    const uint64_t expected = go_on();
    BodyId ball = last;
    world.restore(saved).value();
    EXPECT_FALSE(world.alive(ball));
    EXPECT_EQ(world.body_count(), 4);
    EXPECT_EQ(world.joint_count(), 0);
    EXPECT_EQ(go_on(), expected);
    EXPECT_FALSE(world.alive(ball)) << "the new body of its place is another one";
    EXPECT_TRUE(world.alive(floor));
}

TEST(Snapshot, OfAnotherWorldIsRefused) {
    World a = WorldBuilder{}.build().value(), b = WorldBuilder{}.build().value();
    World more_steps = WorldBuilder{}.solver_steps(4).build().value();
    for (World* w : {&a, &b, &more_steps}) add_floor(*w);
    add_cube(a, 0.0f, 1);
    b.add_rigid_body({.shape = Sphere{0.5f}, .position = {0.0f, 1.5f, 0.0f}}).value();
    add_cube(more_steps, 0.0f, 1);
    const std::vector<uint8_t> saved = a.snapshot();
    for (World* w : {&b, &more_steps}) {
        const uint64_t hash = w->hash();
        EXPECT_EQ(w->restore(saved).error().code, ErrorCode::wrong_world);
        EXPECT_EQ(w->hash(), hash);
    }
}

// A small world in motion and its snapshot.
struct Small {
    World world = WorldBuilder{}.build().value();
    std::vector<uint8_t> saved;
    uint64_t hash;
    Small() {
        add_floor(world);
        add_stack(world, 0.0f, 2);
        world.add_rigid_body({.shape = octahedron(0.5f), .position = {0.2f, 2.6f, 0.1f}}).value();
        run(world, 30);
        saved = world.snapshot();
        run(world, 10);
        hash = world.hash();
    }
};

TEST(Snapshot, TruncatedOrAlteredBytesChangeNothing) {
    Small s;
    for (size_t size = 0; size < s.saved.size(); ++size) {
        Status restored = s.world.restore(std::span(s.saved).first(size));
        ASSERT_FALSE(restored.ok()) << size << " bytes";
        ASSERT_EQ(restored.error().code, ErrorCode::bad_snapshot);
    }
    for (size_t i = 0; i < s.saved.size(); ++i) {
        std::vector<uint8_t> bytes = s.saved;
        bytes[i] ^= 0x10;
        ASSERT_FALSE(s.world.restore(bytes).ok()) << "byte " << i;
    }
    std::vector<uint8_t> longer = s.saved;
    longer.push_back(0);
    EXPECT_EQ(s.world.restore(longer).error().code, ErrorCode::bad_snapshot);
    EXPECT_EQ(s.world.hash(), s.hash);
    s.world.restore(s.saved).value();
    run(s.world, 10);
    EXPECT_EQ(s.world.hash(), s.hash);
}

// Bytes that pass the checksum but are nonsense are refused, or are a state that the world can go on from.
TEST(Snapshot, SealedNonsenseDoesNoHarm) {
    Small s;
    int refused = 0;
    for (size_t i = 16; i + 8 < s.saved.size(); ++i) {
        std::vector<uint8_t> bytes = s.saved;
        bytes[i] = static_cast<uint8_t>(bytes[i] ^ (i % 3 == 0 ? 0xff : 0x41));
        seal(bytes);
        refused += !s.world.restore(bytes).ok();
        if (i % 8 == 0) run(s.world, 1);
    }
    EXPECT_GT(refused, 50);
    s.world.restore(s.saved).value();
    run(s.world, 10);
    EXPECT_EQ(s.world.hash(), s.hash);
}

TEST(Snapshot, IsSmall) {
    Scene scene = build_scene("box_pile:200").value();
    step(scene, 240);
    const StepStatistics& s = scene.world.statistics();
    const size_t bytes = scene.world.snapshot().size();
    EXPECT_LT(bytes, 160u * 200u + 300u * static_cast<size_t>(s.pairs)) << s.pairs << " pairs";
}

}  // namespace
}  // namespace lendulet::test
