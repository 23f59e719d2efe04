// How packed bodies are cut into tiles, and how contacts are coloured in them.
#include "solver/tiles.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>
#include "lendulet/lendulet.h"

namespace lendulet {
namespace {

TEST(Tiles, PlacesAreDenseButForTheFillers) {
    for (int begin : {reserved_bodies, 160})
        for (int bodies : {0, 1, 15, 16, 500, 1024, 1025, 1100, 2044, 2045, 5000}) {
            TilePlaces places(begin, bodies);
            const BodyRange range{begin, places.end()};
            const Tiles tiles(range);
            EXPECT_EQ((places.end() - begin) % block_bodies, 0) << bodies;
            std::set<int> taken, empty;
            for (int i = 0, before = begin - 1; i < bodies; ++i) {
                const int place = places.take();
                ASSERT_GT(place, before);
                ASSERT_LT(place, places.end()) << bodies;
                taken.insert(before = place);
            }
            places.for_each_empty([&](int place) { empty.insert(place); });
            EXPECT_EQ(static_cast<int>(taken.size() + empty.size()), places.end() - begin) << bodies;
            for (int place : empty) EXPECT_EQ(taken.count(place), 0u) << bodies;
            if (tiles.count == 1) continue;
            int covered = begin;
            for (int t = 0; t < tiles.count; ++t) {
                EXPECT_EQ(tiles.bodies(t).begin, covered) << bodies;
                covered = tiles.bodies(t).end;
                EXPECT_EQ(empty.count(tiles.filler(t)), 1u) << bodies << ' ' << t;
                EXPECT_EQ(tiles.of(tiles.filler(t)), t);
            }
            EXPECT_EQ(covered, places.end()) << bodies;
        }
}

TEST(Tiles, PairsBelongToATileOrLieBetween) {
    const Tiles tiles(BodyRange{reserved_bodies, reserved_bodies + 3 * tile_bodies});
    ASSERT_EQ(tiles.count, 3);
    const int first = reserved_bodies, second = first + tile_bodies;
    EXPECT_EQ(tiles.of(first, second - 1), 0);
    EXPECT_EQ(tiles.of(second - 1, second), tiles.count);
    EXPECT_EQ(tiles.of(static_body, second), 1);
    EXPECT_EQ(tiles.of(second, static_body), 1);
    EXPECT_EQ(Tiles(BodyRange{first, first + 2 * tile_bodies}).count, 1);
}

// Three walls of bricks, of 1250 bodies in all: several tiles, with contacts between them.
World walls(int workers, int width) {
    World world = WorldBuilder().sleep(false).workers(workers).width(width).build().value();
    world.add_static_body({.shape = Box{{100.0f, 0.5f, 100.0f}}, .position = {0.0f, -0.5f, 0.0f}}).value();
    for (int row = 0; row < 10; ++row)
        for (int wall = 0; wall < 3; ++wall)
            for (int i = 0; i < 42; ++i)
                world
                    .add_rigid_body(
                        {.shape = Box{{0.5f, 0.25f, 0.25f}},
                         .position = {1.02f * static_cast<float>(i) + 0.5f * static_cast<float>(row % 2),
                                      0.25f + 0.5f * static_cast<float>(row), 3.0f * static_cast<float>(wall)}})
                    .value();
    for (int i = 0; i < 20; ++i) world.update(1.0f / 60.0f).value();
    return world;
}

TEST(Tiles, ResultsDoNotTellOfWorkersAndWidths) {
    const uint64_t expected = walls(1, 1).hash();
    EXPECT_EQ(walls(2, 16).hash(), expected);
    EXPECT_EQ(walls(5, 8).hash(), expected);
    EXPECT_EQ(walls(3, 4).hash(), expected);
}

TEST(Tiles, ContactsOfOneColourShareNoBody) {
    const World world = walls(1, 4);
    const std::vector<int> colours = world.contact_colours();
    std::set<std::pair<int, uint32_t>> seen;
    int contacts = 0;
    for (size_t i = 0; i < colours.size(); ++i) {
        if (colours[i] < 0) continue;
        ++contacts;
        const Contact c = world.contact(static_cast<int>(i));
        for (BodyId body : {c.body_a, c.body_b}) {
            if (world.get_static(body).type() != BodyType::dynamic) continue;
            EXPECT_TRUE(seen.insert({colours[i], body.index}).second) << "colour " << colours[i];
        }
    }
    EXPECT_GT(contacts, 1260);
}

}  // namespace
}  // namespace lendulet
