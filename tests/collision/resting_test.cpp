// Every shape in every pose in which it can rest: on a box, a hull, a plane and a grid of triangles it gets the points
// it needs, level, at the right height, and evenly about its centre.
#include "family.h"
#include "meshes.h"

using namespace pairs;

namespace {

const Vec3 up{0.0f, 1.0f, 0.0f};

struct Floor {
    const char* name;
    Shape shape;
    float height;    // of its surface over its origin
    float rounding;  // of its points about the centre, where it is a grid: how unevenly they may lie
};

std::vector<Floor> every_floor() {
    std::vector<Vec3> slab;
    for (float x : {-3.0f, 3.0f})
        for (float y : {-0.5f, 0.5f})
            for (float z : {-3.0f, 3.0f}) slab.push_back({x, y, z});
    return {{"box", Box{{3.0f, 0.5f, 3.0f}}, 0.5f, 1e-3f},
            {"rounded box", Box{{3.0f, 0.4f, 3.0f}, 0.1f}, 0.5f, 1e-3f},
            {"hull", ConvexHull::from_points(slab).value(), 0.5f, 1e-3f},
            {"plane", Plane{up, 0.5f}, 0.5f, 1e-3f},
            {"two triangles", flat_grid(1, 6.0f), 0.0f, 1e-3f},
            {"fine grid", flat_grid(24, 0.25f), 0.0f, 0.05f},
            {"cylinder", Cylinder{0.5f, 3.0f}, 0.5f, 1e-3f}};
}

void expect_rest(const Rest& rest, const Floor& floor, const Placed& below, const Placed& above, Vec3 offset,
                 float depth) {
    std::vector<Manifold> all = manifolds(pair_of(below, above, offset, 0.02f));
    ASSERT_EQ(all.size(), 1u);
    const Manifold& m = all[0];
    ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.02f));
    expect_near(m.normal, up, 2e-5f, "normal");
    EXPECT_GE(m.count, rest.points);
    Vec3 mean{};
    for (int k = 0; k < m.count; ++k) {
        EXPECT_NEAR(m.points[k].separation, -depth, 2e-4f);
        EXPECT_NEAR(m.points[k].position.y, floor.height - 0.5f * depth, 2e-4f);
        mean += (1.0f / static_cast<float>(m.count)) * (m.points[k].position - offset);
    }
    if (rest.symmetric) {
        EXPECT_NEAR(mean.x, 0.0f, floor.rounding);
        EXPECT_NEAR(mean.z, 0.0f, floor.rounding);
    }
    // And seen from the other side.
    std::vector<Manifold> back = manifolds(pair_of(above, below, -offset, 0.02f));
    ASSERT_EQ(back.size(), 1u);
    expect_near(back[0].normal, -up, 2e-5f, "normal of the swapped pair");
    EXPECT_GE(back[0].count, rest.points);
}

class Resting : public testing::TestWithParam<int> {};

TEST_P(Resting, HasThePointsToRestOn) {
    Floor floor = every_floor()[static_cast<size_t>(GetParam())];
    Random random(7);
    for (const Rest& rest : every_rest()) {
        Solid below(floor.shape), above(rest.shape);
        for (float depth : {-1e-3f, 0.0f, 1e-3f}) {
            for (int turn = 0; turn < 4; ++turn) {
                SCOPED_TRACE(testing::Message()
                             << rest.name << " on " << floor.name << " depth " << depth << " turn " << turn);
                Quat heading = rotation_about(up, 0.7f * static_cast<float>(turn));
                Vec3 offset{random.in(-0.5f, 0.5f), floor.height + rest.height - depth, random.in(-0.5f, 0.5f)};
                expect_rest(rest, floor, {below, {}}, {above, heading * rest.turn}, offset, depth);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Floors, Resting, testing::Range(0, 7));

TEST(RestingRadii, RoundShapesRoll) {
    Solid plane(Plane{up, 0.0f}), cylinder(Cylinder{0.3f, 0.4f}), capsule(Capsule{0.3f, 0.4f});
    Quat lying = rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi);
    Manifold m = manifold(pair_of({plane, {}}, {cylinder, lying}, {0.0f, 0.4f, 0.0f}, 0.01f));
    EXPECT_EQ(m.radius_b, 0.4f);
    EXPECT_EQ(m.follow, 1.0f);
    m = manifold(pair_of({plane, {}}, {capsule, lying}, {0.0f, 0.4f, 0.0f}, 0.01f));
    EXPECT_EQ(m.radius_b, 0.4f);
    m = manifold(pair_of({plane, {}}, {cylinder, {}}, {0.0f, 0.3f, 0.0f}, 0.01f));
    EXPECT_EQ(m.radius_b, 0.0f);
}

// Two units of a kind on top of each other.
TEST(RestingPairs, StacksOfOneKind) {
    for (const Rest& rest : every_rest()) {
        if (rest.points < 4) continue;
        SCOPED_TRACE(rest.name);
        Solid solid(rest.shape);
        // On its top stands the same solid upside down, so that equal faces meet.
        Quat over = rotation_about({1.0f, 0.0f, 0.0f}, pi) * rest.turn;
        Manifold m =
            manifold(pair_of({solid, over}, {solid, rest.turn}, {0.05f, 2.0f * rest.height - 1e-3f, 0.02f}, 0.02f));
        EXPECT_EQ(m.count, 4);
        expect_near(m.normal, up, 2e-5f);
        EXPECT_NEAR(deepest(m), -1e-3f, 1e-4f);
    }
}

}  // namespace
