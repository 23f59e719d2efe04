// Events are part of what is the same: for any workers, widths and broad phases, and after snapshots and forks.
#include <gtest/gtest.h>

#include "world/support.h"

namespace lendulet::test {
namespace {

// All that a world reports, as numbers.
void note(const World& world, std::vector<float>& out) {
    auto ids = [&](const auto& e) {
        for (uint32_t x : {e.body_a.index, e.body_b.index, e.collider_a.index, e.collider_b.index})
            out.push_back(static_cast<float>(x));
    };
    auto overlap = [&](const Overlap& o) {
        for (uint32_t x : {o.trigger_body.index, o.other_body.index, o.trigger.index, o.other.index})
            out.push_back(static_cast<float>(x));
    };
    for (const ContactEvent& e : world.contact_begins()) ids(e);
    for (const ContactEvent& e : world.contact_ends()) ids(e), out.push_back(-1.0f);
    for (const ContactHit& h : world.contact_hits()) {
        ids(h);
        for (float x :
             {h.position.x, h.position.y, h.position.z, h.normal.x, h.normal.y, h.normal.z, h.speed, h.impulse})
            out.push_back(x);
    }
    for (const Overlap& o : world.trigger_begins()) overlap(o);
    for (const Overlap& o : world.trigger_ends()) overlap(o), out.push_back(-2.0f);
    for (const SleepEvent& e : world.sleep_events()) out.push_back(static_cast<float>(e.body.index) + 0.5f * e.asleep);
    out.push_back(-3.0f);
}

// A heap that falls in, with bouncy bodies, a trigger, a wind, and bodies that are removed.
struct Rain {
    World world;
    std::vector<BodyId> drops;

    explicit Rain(const WorldConfig& config) : world(WorldBuilder(config).build().value()) {
        add_bowl(world);
        const ColliderDef zone{.shape = Box{{2.0f, 0.5f, 2.0f}}, .is_trigger = true, .events = Events::contacts};
        world.add_static_body({.position = {0.0f, 3.0f, 0.0f}, .colliders = {&zone, 1}}).value();
        for (int i = 0; i < 80; ++i) {
            const auto k = static_cast<float>(i);
            RigidBodyDef def{.position = {2.2f * std::sin(k), 1.0f + 0.3f * k, 2.2f * std::cos(2.0f * k)}};
            if (i % 3 == 0) def.shape = Sphere{0.35f};
            if (i % 3 == 1) def.shape = Box{{0.3f, 0.25f, 0.4f}};
            if (i % 3 == 2) def.shape = Capsule{0.25f, 0.3f};
            if (i % 4 == 0) def.restitution = 0.5f;
            if (i % 2 == 0) def.events = i % 6 == 0 ? Events::contacts : Events::all;
            drops.push_back(world.add_rigid_body(def).value());
        }
    }
    void step(int i) {
        if (i % 40 == 39) world.remove_body(drops[static_cast<size_t>(i / 40)]).value();
        run(world, 1);
    }
};

TEST(Events, AreTheSameForWorkersWidthsAndBroadPhases) {
    std::vector<std::vector<float>> notes;
    std::vector<uint64_t> hashes;
    auto play = [&](const WorldConfig& config) {
        Rain rain(config);
        notes.emplace_back();
        for (int i = 0; i < 200; ++i) rain.step(i), note(rain.world, notes.back());
        hashes.push_back(rain.world.hash());
    };
    for (int workers : {1, 2, 5}) play(WorldBuilder().workers(workers).config());
    for (int width : widths) play(WorldBuilder().width(width).config());
    for (BroadPhaseType type : {BroadPhaseType::all_pairs, BroadPhaseType::sweep_1})
        play(WorldBuilder().broad_phase(type).workers(2).config());
    EXPECT_GT(notes[0].size(), size_t{2000});
    for (size_t i = 1; i < notes.size(); ++i) {
        EXPECT_EQ(hashes[i], hashes[0]) << i;
        EXPECT_TRUE(notes[i] == notes[0]) << i;
    }
}

// Who asks changes nothing but what is reported.
TEST(Events, DoNotChangeWhatHappens) {
    auto hash_of = [](Events events) {
        World world = WorldBuilder().bounciness(0.3f).build().value();
        add_bowl(world);
        add_mixed_pile(world, 3);
        for (int i = 0; i < 20; ++i)
            world
                .add_rigid_body({.shape = Sphere{0.3f},
                                 .position = {0.1f * static_cast<float>(i), 6.0f + static_cast<float>(i), 0.0f},
                                 .events = events})
                .value();
        run(world, 200);
        return world.hash();
    };
    EXPECT_EQ(hash_of(Events::none), hash_of(Events::all));
}

TEST(Events, GoOnAfterASnapshotAndInAFork) {
    for (int at : {1, 20, 39, 55, 77, 100, 140}) {
        Rain original({}), other({});
        for (int i = 0; i < at; ++i) original.step(i), other.step(i);
        // Between two updates: an end and a waking that are still to be told.
        for (Rain* rain : {&original, &other}) {
            rain->world.remove_body(rain->drops[20]).value();
            rain->world.get(rain->drops[30]).wake();
        }
        const std::vector<uint8_t> snapshot = original.world.snapshot();
        World fork = original.world.fork().value();
        other.world.restore(snapshot).value();
        EXPECT_TRUE(other.world.contact_begins().empty() && fork.contact_begins().empty());
        std::vector<float> first, second, third;
        for (int i = 0; i < 60; ++i) {
            run(original.world, 1), run(other.world, 1), run(fork, 1);
            note(original.world, first), note(other.world, second), note(fork, third);
        }
        EXPECT_GT(first.size(), size_t{200});
        EXPECT_TRUE(first == second) << at;
        EXPECT_TRUE(first == third) << at;
    }
}

}  // namespace
}  // namespace lendulet::test
