// Snapshots of before a removal: what was removed is alive again under its old handles, and what comes then is what
// came after the snapshot, to the last bit.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "scale.h"
#include "world/snapshots.h"
#include "world/story.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

std::vector<BodyId> bodies_of(const World& world) {
    std::vector<BodyId> list;
    for (int i = 0; i < world.body_count(); ++i) list.push_back(world.body(i));
    return list;
}
std::vector<JointId> joints_of(const World& world) {
    std::vector<JointId> list;
    for (int i = 0; i < world.joint_count(); ++i) list.push_back(world.joint_id(i));
    return list;
}

// Every `nth` body and joint goes, others come into their places, and time passes.
void ravage(World& world, int nth, float time_step) {
    const std::vector<BodyId> bodies = bodies_of(world);
    for (size_t i = static_cast<size_t>(nth) - 1; i < bodies.size(); i += static_cast<size_t>(nth))
        world.remove_body(bodies[i]).value();
    const std::vector<JointId> joints = joints_of(world);
    for (size_t i = 0; i < joints.size(); i += static_cast<size_t>(nth)) world.remove_joint(joints[i]).value();
    for (int round = 0; round < 3; ++round) {
        run(world, 4, time_step);
        const ColliderDef two[] = {{.shape = Box{{0.2f, 0.2f, 0.2f}}},
                                   {.shape = Sphere{0.2f}, .local = {{0.0f, 0.4f, 0.0f}, {}}}};
        const float y = 3.0f + static_cast<float>(round);
        const BodyId a = world.add_rigid_body({.position = {0.3f, y, 0.1f}, .colliders = two}).value();
        const BodyId b = world.add_rigid_body({.shape = Sphere{0.3f}, .position = {0.3f, y + 0.9f, 0.1f}}).value();
        world.add_joint(world.joint_at(JointType::ball, a, b, {0.3f, y + 0.5f, 0.1f}).value()).value();
        if (round == 1) world.remove_body(a).value();
    }
    run(world, 4, time_step);
}

struct Played {
    const char* scene;
    int before, after;  // steps to the snapshot, and from there
};
void PrintTo(const Played& run, std::ostream* out) { *out << run.scene << " at " << run.before; }

class Removals : public ::testing::TestWithParam<Played> {};

TEST_P(Removals, AreUndoneToTheLastBit) {
    const Played& run = GetParam();
    Scene scene = build_scene(run.scene).value();
    World& world = scene.world;
    step(scene, run.before);
    const std::vector<uint8_t> saved = world.snapshot();
    const uint64_t hash = world.hash();
    const std::vector<BodyId> bodies = bodies_of(world);
    const std::vector<JointId> joints = joints_of(world);
    const std::vector<uint64_t> expected = hashes(scene, run.after);
    for (int nth : {3, 1, 2}) {
        world.restore(saved).value();
        ravage(world, nth, scene.dt);
        Status restored = world.restore(saved);
        ASSERT_TRUE(restored.ok()) << restored.error().message;
        EXPECT_EQ(world.hash(), hash);
        EXPECT_EQ(world.snapshot(), saved) << "a restored world gives the same bytes";
        EXPECT_EQ(world.check(), "");
        EXPECT_EQ(bodies_of(world), bodies);
        EXPECT_EQ(joints_of(world), joints);
        ASSERT_EQ(hashes(scene, run.after), expected) << nth;
        EXPECT_EQ(world.check(), "");
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Removals,
                         ::testing::Values(Played{"box_pile:60", 0, 40}, Played{"box_pile:60", 90, 60},
                                           Played{"mixed_pile:80", 120, 60}, Played{"mass_ratio:1000", 60, 60},
                                           Played{"stack:30", 90, 60}, Played{"ragdolls:3", 60, 60},
                                           Played{"mesh_terrain:40", 120, 40}, Played{"height_field:40", 120, 40},
                                           Played{"newtons_cradle", 70, 60}, Played{"chain_heavy", 50, 60},
                                           Played{"large_world_sleep:60", 150, 90}));

// A world with all sorts of things that a body can be made of and that may have changed on it.
struct Sorts {
    World world;
    BodyId floor, moved, kinematic, heavy, compound, top, still, chain[4];
    JointId hinge, servo, links[3];

    explicit Sorts(int kept = 64) : world(WorldBuilder{}.kept_removed(kept).build().value()) {
        floor = world.add_static_body({.shape = wavy_ground(12, 12.0f, 0.02f), .name = "ground"}).value();
        moved = world.add_static_body({.shape = Box{}, .position = {-6.0f, 0.5f, 0.0f}}).value();
        kinematic = world.add_rigid_body({.shape = Box{}, .position = {3.0f, 0.6f, 0.0f}, .kinematic = true}).value();
        heavy = add_cube(world, 0.0f, 0);
        const ColliderDef parts[] = {
            {.shape = Box{{0.4f, 0.1f, 0.4f}}, .events = Events::all},
            {.shape = octahedron(0.3f), .local = {{0.0f, 0.4f, 0.0f}, {}}, .user_data = 7},
            {.shape = Box{{1.0f, 1.0f, 1.0f}}, .local = {{0.0f, 0.0f, 0.0f}, {}}, .is_trigger = true}};
        compound =
            world.add_rigid_body({.position = {0.0f, 1.2f, 0.0f}, .colliders = parts, .name = "compound"}).value();
        top = world.add_rigid_body({.shape = Capsule{0.3f, 0.2f}, .position = {0.1f, 2.5f, 0.0f}}).value();
        still = add_cube(world, 8.0f, 0);
        for (int i = 0; i < 4; ++i)
            chain[i] = world
                           .add_rigid_body(
                               {.shape = Sphere{0.2f}, .position = {-3.0f + 0.5f * static_cast<float>(i), 4.0f, 2.0f}})
                           .value();
        for (int i = 0; i < 3; ++i)
            links[i] = join(JointType::ball, chain[i], chain[i + 1], {-2.75f + 0.5f * static_cast<float>(i), 4.0f, 2});
        hinge = join(JointType::hinge, floor, chain[0], {-3.0f, 4.0f, 2.0f});
        world.set_motor(hinge, {1.0f, 5.0f}).value();
        servo = join(JointType::six_degrees, kinematic, top, {1.0f, 2.0f, 0.0f});
        world.set_limit(servo, Coordinate::x, {-1.0f, 1.0f}).value();
        world.set_spring(servo, Coordinate::x, {.stiffness = 500, .damping = 20, .target = 0.2f}).value();
        run(world, 40);
        world.get(heavy).set_mass(2500.0f).value();
        world.get(still).set_type(BodyType::kinematic).value();
        world.set_pose(moved, {-5.0f, 0.5f, 0.5f}, {}).value();
        world.set_filter(world.get(compound).collider(1), {.group = 4}).value();
        world.set_material(world.get(top).collider(), {.static_friction = 0.9f, .rolling_friction = 0.01f}).value();
        run(world, 5);
        world.get(top).apply_force({0.0f, 100.0f, 0.0f}).value();
    }
    JointId join(JointType type, BodyId a, BodyId b, Position at) {
        return world.add_joint(world.joint_at(type, a, b, at, {0.0f, 0.0f, 1.0f}).value()).value();
    }
};

TEST(Removal, OfEverySortIsUndone) {
    Sorts s;
    World& world = s.world;
    const std::vector<uint8_t> saved = world.snapshot();
    const std::vector<BodyId> bodies = bodies_of(world);
    const ColliderId octahedron = world.get(s.compound).collider(1);
    run(world, 60);
    const uint64_t expected = world.hash();
    for (size_t first = 0; first < bodies.size(); ++first) {
        ASSERT_TRUE(world.restore(saved).ok());
        // All of them, beginning with another one each time, so that slots come back in every order.
        for (size_t i = 0; i < bodies.size(); ++i) world.remove_body(bodies[(first + i) % bodies.size()]).value();
        EXPECT_EQ(world.body_count(), 0);
        EXPECT_EQ(world.joint_count(), 0);
        run(world, 2);
        add_stack(world, 1.0f, static_cast<int>(first));
        run(world, 2);
        Status restored = world.restore(saved);
        ASSERT_TRUE(restored.ok()) << restored.error().message;
        EXPECT_EQ(world.snapshot(), saved) << first;
        EXPECT_EQ(world.check(), "") << first;
        EXPECT_TRUE(world.alive(octahedron));
        EXPECT_EQ(world.body_of(octahedron), s.compound);
        EXPECT_EQ(world.get(s.compound).name(), "compound");
        EXPECT_EQ(world.get(s.heavy).mass(), 2500.0f);
        EXPECT_EQ(world.get_static(s.moved).position(), (Position{-5.0f, 0.5f, 0.5f}));
        EXPECT_EQ(world.joint_def(s.servo).body_b, s.top);
        const Result<QueryHit> hit = world.cast_ray({{-5.0f, 5.0f, 0.5f}, {0.0f, -10.0f, 0.0f}});
        EXPECT_EQ(hit.value().body, s.moved);
        run(world, 60);
        ASSERT_EQ(world.hash(), expected) << first;
        world.get(s.still).set_type(BodyType::dynamic).value();  // with the mass that it was added with
        EXPECT_EQ(world.get(s.still).mass(), 1000.0f);
    }
}

// Rays were cast and bullets flew while it was gone, so that lists of what there is were made without it.
TEST(Removal, OfAWallIsUndoneForRaysAndBullets) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    world.add_static_body({.shape = Box{}, .position = {0.0f, 0.5f, 4.0f}}).value();
    const BodyId wall =
        world.add_static_body({.shape = Box{{0.02f, 3.0f, 3.0f}}, .position = {5.0f, 3.0f, 0.0f}}).value();
    const BodyId bullet =
        world.add_rigid_body({.shape = Sphere{0.05f}, .position = {0.0f, 2.0f, 0.0f}, .velocity = {200.0f, 0.0f, 0.0f}})
            .value();
    auto seen = [&] { return world.cast_ray({{4.0f, 2.0f, 1.0f}, {3.0f, 0.0f, 0.0f}}).value().body; };
    EXPECT_EQ(seen(), wall);
    const std::vector<uint8_t> saved = world.snapshot();
    run(world, 5);
    EXPECT_LT(world.get(bullet).position().x, 5.0f);
    const uint64_t expected = world.hash();
    for (int round = 0; round < 2; ++round) {
        world.restore(saved).value();
        world.remove_body(wall).value();
        EXPECT_EQ(seen(), BodyId{});
        run(world, 5);
        EXPECT_GT(world.get(bullet).position().x, 5.0f);
        world.restore(saved).value();
        EXPECT_EQ(seen(), wall);
        run(world, 5);
        EXPECT_EQ(world.hash(), expected);
    }
}

// Back and forth among snapshots, where some have what others have not.
TEST(Removal, IsDoneAgainOnTheWayForward) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 4);
    run(world, 20);
    std::vector<std::vector<uint8_t>> saved{world.snapshot()};
    std::vector<uint64_t> after;
    for (BodyId gone : {stack[1], stack[3], stack[0]}) {
        world.remove_body(gone).value();
        add_cube(world, 3.0f, static_cast<int>(saved.size()));
        run(world, 10);
        after.push_back(world.hash());
        saved.push_back(world.snapshot());
    }
    for (size_t at : {0u, 3u, 1u, 2u, 0u, 2u, 1u, 3u, 3u}) {
        ASSERT_TRUE(world.restore(saved[at]).ok()) << at;
        EXPECT_EQ(world.snapshot(), saved[at]) << at;
        EXPECT_EQ(world.check(), "") << at;
        EXPECT_EQ(world.alive(stack[1]), at < 1) << at;
        EXPECT_EQ(world.alive(stack[3]), at < 2) << at;
        if (at > 0) {
            EXPECT_EQ(world.hash(), after[at - 1]);
        }
    }
}

TEST(Removal, GivesNoHandleTwice) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    const BodyId first = add_cube(world, 0.0f, 0);
    const std::vector<uint8_t> saved = world.snapshot();
    std::vector<BodyId> seen{first};
    for (int round = 0; round < 4; ++round) {
        world.remove_body(first).value();
        const BodyId other = add_cube(world, 0.0f, 2);
        EXPECT_EQ(other.index, first.index);
        for (BodyId id : seen) EXPECT_NE(other, id);
        seen.push_back(other);
        EXPECT_FALSE(world.alive(first));
        world.restore(saved).value();
        for (BodyId id : seen) EXPECT_EQ(world.alive(id), id == first);
    }
}

TEST(Removal, OfJointsAloneIsUndone) {
    World world = WorldBuilder{}.build().value();
    const BodyId hook = world.add_static_body({.shape = Box{}, .position = {0.0f, 10.0f, 0.0f}}).value();
    std::vector<JointId> joints;
    for (int i = 0; i < 5; ++i) {
        const float x = 1.0f + static_cast<float>(i);
        const BodyId ball = world.add_rigid_body({.shape = Sphere{0.3f}, .position = {x, 10.0f, 0.0f}}).value();
        const BodyId before = i == 0 ? hook : world.body(i);
        JointDef def = world.joint_at(JointType::ball, before, ball, {x - 0.5f, 10.0f, 0.0f}).value();
        def.name = "link";
        def.user_data = static_cast<uint64_t>(i);
        joints.push_back(world.add_joint(def).value());
    }
    run(world, 30);
    const std::vector<uint8_t> saved = world.snapshot();
    run(world, 60);
    const uint64_t expected = world.hash();
    world.restore(saved).value();
    for (size_t i : {3u, 0u, 4u}) world.remove_joint(joints[i]).value();
    run(world, 30);
    world.restore(saved).value();
    EXPECT_EQ(joints_of(world), joints);
    EXPECT_EQ(world.joint_def(joints[3]).name, "link");
    EXPECT_EQ(world.joint_def(joints[3]).user_data, 3u);
    run(world, 60);
    EXPECT_EQ(world.hash(), expected);
}

// What broke is whole again, and breaks again.
TEST(Removal, OfBrokenJointsIsUndone) {
    World world = WorldBuilder{}.build().value();
    const BodyId hook = world.add_static_body({.shape = Box{}, .position = {0.0f, 10.0f, 0.0f}}).value();
    const BodyId load = add_cube(world, 0.0f, 8);
    JointDef def = world.joint_at(JointType::fixed, hook, load, {0.0f, 9.25f, 0.0f}).value();
    def.break_force = 12000.0f;
    const JointId joint = world.add_joint(def).value();
    run(world, 30);
    ASSERT_TRUE(world.alive(joint));
    const std::vector<uint8_t> saved = world.snapshot();
    for (int round = 0; round < 3; ++round) {
        world.get(load).apply_force({0.0f, -5000.0f, 0.0f}).value();
        run(world, 1);
        ASSERT_EQ(world.joint_breaks().size(), 1u) << round;
        EXPECT_EQ(world.joint_breaks()[0].joint, joint);
        EXPECT_FALSE(world.alive(joint));
        run(world, 20);
        world.restore(saved).value();
        EXPECT_TRUE(world.alive(joint));
        run(world, 20);
        EXPECT_TRUE(world.alive(joint)) << "without the pull it holds";
        world.restore(saved).value();
    }
}

TEST(Removal, IsUndoneInAForkToo) {
    World world = WorldBuilder{}.build().value();
    add_floor(world);
    std::vector<BodyId> stack = add_stack(world, 0.0f, 4);
    run(world, 20);
    const std::vector<uint8_t> saved = world.snapshot();
    run(world, 40);
    const uint64_t expected = world.hash();
    world.restore(saved).value();
    for (BodyId id : {stack[0], stack[2]}) world.remove_body(id).value();
    run(world, 10);
    World fork = world.fork().value();
    for (World* w : {&fork, &world}) {
        ASSERT_TRUE(w->restore(saved).ok());
        EXPECT_TRUE(w->alive(stack[0]) && w->alive(stack[2]));
        run(*w, 40);
        EXPECT_EQ(w->hash(), expected);
    }
    WorldConfig few = world.config();
    few.kept_removed = 1;
    for (BodyId id : {stack[0], stack[2]}) world.remove_body(id).value();
    World forgetful = world.fork(few).value();
    EXPECT_EQ(forgetful.restore(saved).error().code, ErrorCode::wrong_world);
    forgetful = world.fork().value();
    EXPECT_TRUE(forgetful.restore(saved).ok());
}

// Only so many are remembered. A snapshot that needs more is refused, and nothing has changed.
TEST(Removal, IsForgottenInTime) {
    World world = WorldBuilder{}.kept_removed(3).build().value();
    add_floor(world);
    std::vector<BodyId> row;
    for (int i = 0; i < 6; ++i) row.push_back(add_cube(world, 2.0f * static_cast<float>(i), 0));
    for (int i = 0; i < 5; ++i)
        world
            .add_joint(world
                           .joint_at(JointType::ball, row[static_cast<size_t>(i)], row[static_cast<size_t>(i) + 1],
                                     {2.0f * static_cast<float>(i) + 1.0f, 0.5f, 0.0f})
                           .value())
            .value();
    run(world, 10);
    const std::vector<uint8_t> saved = world.snapshot();
    auto expect_refused = [&](const std::string& says) {
        const std::vector<uint8_t> now = world.snapshot();
        const Status refused = world.restore(saved);
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, ErrorCode::wrong_world);
        EXPECT_EQ(refused.error().message, says);
        EXPECT_EQ(world.snapshot(), now);
        EXPECT_EQ(world.check(), "");
    };
    for (size_t i : {0u, 1u}) world.remove_body(row[i]).value();  // and two joints
    ASSERT_TRUE(world.restore(saved).ok());
    EXPECT_EQ(world.snapshot(), saved);
    for (size_t i : {0u, 1u, 2u, 3u}) world.remove_body(row[i]).value();
    expect_refused(
        "restore: 1 bodies and 1 joints of the snapshot are neither in this world nor among the last 3 of either that "
        "were removed (kept_removed)");
    world.forget_removed();
    expect_refused(
        "restore: 4 bodies and 4 joints of the snapshot are neither in this world nor among the last 3 of either that "
        "were removed (kept_removed)");
    const std::vector<uint8_t> later = world.snapshot();
    world.remove_body(row[5]).value();
    EXPECT_TRUE(world.restore(later).ok()) << "what goes afterwards is remembered";

    World none = WorldBuilder{}.kept_removed(0).build().value();
    const BodyId cube = add_cube(none, 0.0f, 0);
    const std::vector<uint8_t> before = none.snapshot();
    none.remove_body(cube).value();
    EXPECT_EQ(none.restore(before).error().code, ErrorCode::wrong_world);
    for (int wrong : {-1, (1 << 24) + 1})
        EXPECT_EQ(WorldBuilder{}.kept_removed(wrong).build().error().message,
                  "build: kept_removed is " + std::to_string(wrong) + ", must be 0 to 16777216");
}

// Bullets that come and go for a long time: the last ones are found, and are the same as ever.
TEST(Removal, OfManyInTurnIsUndone) {
    World world = WorldBuilder{}.kept_removed(40).build().value();
    add_floor(world);
    std::vector<BodyId> bullets;
    std::vector<std::vector<uint8_t>> saved;
    std::vector<uint64_t> hash;
    for (int i = 0; i < 300; ++i) {
        const float x = 0.7f * static_cast<float>(i % 7);
        bullets.push_back(
            world.add_rigid_body({.shape = Sphere{0.1f}, .position = {x, 1.0f, 0.0f}, .velocity = {9.0f, 0.0f, 0.0f}})
                .value());
        if (i >= 15) world.remove_body(bullets[static_cast<size_t>(i) - 15]).value();
        run(world, 1);
        saved.push_back(world.snapshot());
        hash.push_back(world.hash());
    }
    EXPECT_FALSE(world.restore(saved[250]).ok()) << "49 removals ago";
    for (size_t at : {270u, 275u, 272u, 299u, 268u}) {
        ASSERT_TRUE(world.restore(saved[at]).ok()) << at;
        EXPECT_EQ(world.hash(), hash[at]);
        EXPECT_EQ(world.snapshot(), saved[at]);
        EXPECT_EQ(world.check(), "");
    }
}

// A story is told, forgotten and told again, with all that comes and goes in it.
TEST(Removal, StoriesAreToldAgain) {
    for (uint32_t seed = 40; seed < 40 + static_cast<uint32_t>(scaled(6, 2)); ++seed) {
        World plain = WorldBuilder{}.build().value(), back = WorldBuilder{}.build().value();
        Story story(seed, {}), other(seed, {});
        story.begin(plain);
        other.begin(back);
        for (int round = 0; round < scaled(8, 3); ++round) {
            const std::vector<uint8_t> saved = back.snapshot();
            const Story told = other;
            for (int step = 0; step < 30; ++step) other.go_on(back, dt);
            Status restored = back.restore(saved);
            ASSERT_TRUE(restored.ok()) << seed << " round " << round << restored.error().message;
            ASSERT_EQ(back.snapshot(), saved) << seed << " round " << round;
            ASSERT_EQ(back.check(), "") << seed << " round " << round;
            other = told;
            for (int step = 0; step < 30; ++step) {
                story.go_on(plain, dt);
                other.go_on(back, dt);
                ASSERT_EQ(back.hash(), plain.hash()) << seed << " round " << round << " step " << step;
            }
        }
    }
}

// Nonsense that passes the checksum, of a world whose bodies and joints have to be brought back.
TEST(Removal, SealedNonsenseDoesNoHarm) {
    Sorts s;
    World& world = s.world;
    const std::vector<uint8_t> saved = world.snapshot();
    run(world, 60);
    const uint64_t expected = world.hash();
    int refused = 0;
    for (size_t i = 16; i + 8 < saved.size(); i += static_cast<size_t>(scaled(1, 3))) {
        world.restore(saved).value();
        for (BodyId id : {s.chain[1], s.top, s.compound}) world.remove_body(id).value();
        world.remove_joint(s.hinge).value();
        add_cube(world, 5.0f, 0);
        std::vector<uint8_t> bytes = saved;
        bytes[i] = static_cast<uint8_t>(bytes[i] ^ (i % 3 == 0 ? 0xff : i % 3 == 1 ? 0x41 : 0x02));
        seal(bytes);
        const std::vector<uint8_t> before = i % 16 == 0 ? world.snapshot() : std::vector<uint8_t>{};
        if (!world.restore(bytes).ok()) {
            ++refused;
            if (!before.empty()) {
                ASSERT_EQ(world.snapshot(), before) << i;
            }
        }
        ASSERT_EQ(world.check().find("order"), std::string::npos) << i;
        if (i % 8 == 0) run(world, 1);
    }
    EXPECT_GT(refused, 50);
    world.restore(saved).value();
    EXPECT_EQ(world.snapshot(), saved);
    run(world, 60);
    EXPECT_EQ(world.hash(), expected);
}

}  // namespace
}  // namespace lendulet::test
