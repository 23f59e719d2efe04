// Bodies on triangles: nothing is felt of flat triangulations, of seams between them and of their ends in the middle of
// edges; materials by triangle.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr float reach = 6.0f;  // of all grounds along x; along z from -2 to 2

HeightField flat_field(float cell, float length_x, float length_z) {
    HeightFieldDef def;
    def.columns = static_cast<int>(length_x / cell + 0.5f) + 1, def.rows = static_cast<int>(length_z / cell + 0.5f) + 1;
    const std::vector<float> heights(static_cast<size_t>(def.columns * def.rows), 0.0f);
    def.heights = heights;
    def.cell_x = def.cell_z = cell;
    return HeightField::from_heights(def).value();
}

TriangleMesh mesh_of(const HeightField& f) { return TriangleMesh::from_triangles(f.vertices(), f.triangles()).value(); }

// A coarse strip beside a fine one, again and again: the fine ones' corners lie in the middle of the coarse ones'
// edges.
TriangleMesh t_junctions() {
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    for (int strip = 0; strip < 24; ++strip) {
        HeightField f = flat_field(strip % 2 == 0 ? 0.5f : 0.1f, 0.5f, 4.0f);
        auto first = static_cast<uint32_t>(vertices.size());
        for (Vec3 v : f.vertices()) vertices.push_back(v + Vec3{0.5f * static_cast<float>(strip) - reach, 0.0f, -2.0f});
        for (uint32_t i : f.triangles()) indices.push_back(first + i);
    }
    return TriangleMesh::from_triangles(vertices, indices).value();
}

void add_tiles(World& world, float size, const std::function<Shape(float)>& tile, Vec3 corner) {
    for (float x = -reach; x < reach - 1e-3f; x += size)
        for (float z = -2.0f; z < 2.0f - 1e-3f; z += size)
            world.add_static_body({.shape = tile(size), .position = Position{x, 0.0f, z} + corner}).value();
}

struct Ground {
    const char* name;
    std::function<void(World&)> add;
};
const Ground grounds[] = {
    {"field",
     [](World& w) {
         w.add_static_body({.shape = flat_field(0.1f, 12.0f, 4.0f), .position = {-reach, 0.0f, -2.0f}}).value();
     }},
    {"mesh",
     [](World& w) {
         w.add_static_body({.shape = mesh_of(flat_field(0.1f, 12.0f, 4.0f)), .position = {-reach, 0.0f, -2.0f}})
             .value();
     }},
    {"t_junctions", [](World& w) { w.add_static_body({.shape = t_junctions()}).value(); }},
    {"tiles_of_fields", [](World& w) { add_tiles(w, 0.5f, [](float s) { return flat_field(0.25f, s, s); }, {}); }},
    {"tiles_of_meshes",
     [](World& w) { add_tiles(w, 0.5f, [](float s) { return mesh_of(flat_field(0.25f, s, s)); }, {}); }},
    {"tiles_of_boxes",
     [](World& w) {
         add_tiles(w, 0.5f, [](float s) { return Box{{0.5f * s, 0.25f, 0.5f * s}}; }, {0.25f, -0.25f, 0.25f});
     }},
};

struct Slider {
    const char* name;
    Shape shape;
    float height;
};
const Slider sliders[] = {{"ball", Sphere{0.2f}, 0.2f},
                          {"box", Box{{0.25f, 0.15f, 0.2f}}, 0.15f},
                          {"capsule", Capsule{0.3f, 0.15f}, 0.15f},
                          {"cylinder", Cylinder{0.2f, 0.25f}, 0.2f}};

class Sliding : public ::testing::TestWithParam<std::tuple<int, int>> {};

// Without friction, speed and direction stay within 0.1 %.
TEST_P(Sliding, NothingIsFelt) {
    const Ground& ground = grounds[std::get<0>(GetParam())];
    const Slider& slider = sliders[std::get<1>(GetParam())];
    for (float speed : {1.0f, 3.0f, 10.0f}) {
        World world = WorldBuilder{}.friction(0.0f).sleep(false).build().value();
        ground.add(world);
        Vec3 start = speed * normalize(Vec3{1.0f, 0.0f, 0.13f});
        RigidBodyDef def;
        def.shape = slider.shape;
        def.position = {-reach + 1.03f, slider.height, -0.81f};
        def.orientation = rotation_about({0.0f, 1.0f, 0.0f}, 0.4f);
        if (std::holds_alternative<Capsule>(slider.shape))  // lying
            def.orientation = def.orientation * rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
        BodyId body = world.add_rigid_body(def).value();
        run(world, 20);
        world.get(body).set_velocity(start).value();
        const float time = 9.5f / speed;
        float worst = 0.0f, lowest = 1.0f, spin = 0.0f;
        for (int i = 0; i < static_cast<int>(time / dt); ++i) {
            run(world, 1);
            const RigidBodyRef b = world.get(body);
            worst = std::fmax(worst, length(b.velocity() - start) / speed);
            spin = std::fmax(spin, length(b.angular_velocity()));
            lowest = std::fmin(lowest, b.position().y - slider.height);
        }
        EXPECT_LT(worst, 1e-3f) << ground.name << ", " << slider.name << ", " << speed << " m/s";
        EXPECT_LT(spin, 0.01f) << ground.name << ", " << slider.name << ", " << speed << " m/s";
        EXPECT_GT(lowest, -2e-3f) << ground.name << ", " << slider.name << ", " << speed << " m/s";
        EXPECT_GT(world.get(body).position().x, 3.5f);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Sliding,
                         ::testing::Combine(::testing::Range(0, static_cast<int>(std::size(grounds))),
                                            ::testing::Range(0, static_cast<int>(std::size(sliders)))),
                         [](const auto& info) {
                             return std::string(grounds[std::get<0>(info.param)].name) + "_" +
                                    sliders[std::get<1>(info.param)].name;
                         });

// A ball that rolls stays at its speed, too.
TEST(Rolling, OverFineTrianglesAndSeams) {
    for (const Ground& ground : grounds) {
        World world = WorldBuilder{}.friction(0.8f).sleep(false).build().value();
        ground.add(world);
        Vec3 v{2.0f, 0.0f, 0.3f};
        const float r = 0.3f;
        RigidBodyDef def;
        def.shape = Sphere{r};
        def.position = {-reach + 1.03f, r, -0.81f};
        BodyId ball = world.add_rigid_body(def).value();
        run(world, 20);
        world.get(ball).set_velocity(v).value();
        world.get(ball).set_angular_velocity((1.0f / r) * cross(Vec3{0.0f, 1.0f, 0.0f}, v)).value();
        float worst = 0.0f;
        for (int i = 0; i < 240; ++i) {
            run(world, 1);
            worst = std::fmax(worst, length(world.get(ball).velocity() - v) / length(v));
        }
        EXPECT_LT(worst, 1e-3f) << ground.name;
    }
}

// Steps are still felt, and walls hold.
TEST(Seams, StepsAndWallsAreFelt) {
    for (float rise : {0.02f, 0.1f, 1.0f}) {
        for (const Slider& slider : sliders) {
            World world = WorldBuilder{}.friction(0.0f).sleep(false).build().value();
            world.add_static_body({.shape = flat_field(0.25f, 4.0f, 4.0f), .position = {-4.0f, 0.0f, -2.0f}}).value();
            world.add_static_body({.shape = Box{{2.0f, 1.0f, 2.0f}}, .position = {2.0f, rise - 1.0f, 0.0f}}).value();
            RigidBodyDef def;
            def.shape = slider.shape;
            def.position = {-2.0f, slider.height, 0.0f};
            BodyId body = world.add_rigid_body(def).value();
            run(world, 20);
            world.get(body).set_velocity({1.0f, 0.0f, 0.0f}).value();
            run(world, 180);
            // A ball of 0.2 m at 1 m/s does not climb 2 cm without bouncing: energy goes at the corner.
            EXPECT_LT(world.get(body).velocity().x, 0.97f) << slider.name << ", step of " << rise;
            if (rise == 1.0f) {
                EXPECT_LT(world.get(body).position().x, 0.0f) << slider.name;
            }
        }
    }
}

// What is covered within a mesh is found with the manifolds and kept with them, through a snapshot, too: a box creeps
// Boxes on hills so rough that some of their contacts are silenced as seams are: these have no points, and rows made of
// them must do nothing to others that are solved beside them.
TEST(Seams, SilencedContactsDisturbNobody) {
    constexpr int side = 20;
    uint64_t expected = 0;
    for (int width : {1, 4, 8, 16}) {
        uint32_t state = 7;
        auto next = [&] {
            state = state * 1664525u + 1013904223u;
            return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
        };
        World world = WorldBuilder{}.width(width).build().value();
        std::vector<float> heights(side * side);
        for (float& y : heights) y = 0.5f * next();
        HeightFieldDef hills{.columns = side, .rows = side, .heights = heights, .cell_x = 0.7f, .cell_z = 0.7f};
        world.add_static_body({.shape = HeightField::from_heights(hills).value()}).value();
        for (int i = 0; i < 80; ++i) {
            const Vec3 half{0.3f + 0.25f * next(), 0.2f + 0.15f * next(), 0.2f + 0.15f * next()};
            world
                .add_rigid_body(
                    {.shape = Box{half},
                     .position = {6.6f + 5.0f * next(), 1.5f + 0.02f * static_cast<float>(i), 6.6f + 5.0f * next()},
                     .angular_velocity = {4.0f * next(), 4.0f * next(), 4.0f * next()},
                     .density = i % 2 ? 10.0f : 1000.0f})
                .value();
        }
        int contained = 0;
        for (int i = 0; i < 240; ++i) {
            world.update(dt).value();
            contained += world.statistics().contained_bodies;
        }
        EXPECT_EQ(contained, 0) << width;
        if (width == 1) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << width;
    }
}

// over junctions, restored after each step.
TEST(Seams, CoveredContactsAreInSnapshots) {
    auto build = [](BodyId& box) {
        World world = WorldBuilder{}.friction(0.0f).sleep(false).build().value();
        world.add_static_body({.shape = t_junctions()}).value();
        RigidBodyDef def;
        def.shape = Box{{0.25f, 0.15f, 0.2f}};
        def.position = {0.23f, 0.1495f, -0.81f};
        box = world.add_rigid_body(def).value();
        run(world, 5);
        world.get(box).set_velocity({0.02f, 0.0f, 0.005f}).value();
        return world;
    };
    BodyId box, same;
    World world = build(box), restored = build(same);
    for (int i = 0; i < 120; ++i) {
        run(world, 1);
        run(restored, 1);
        ASSERT_EQ(world.hash(), restored.hash()) << i;
        restored.restore(restored.snapshot()).value();
    }
    EXPECT_NEAR(length(world.get(box).velocity() - Vec3{0.02f, 0.0f, 0.005f}), 0.0f, 1e-4f);
}

// --- materials

const Material table[] = {
    {.static_friction = 0.5f, .dynamic_friction = 0.5f, .friction_combine = CombineRule::multiply},
    {.static_friction = 0.0f, .dynamic_friction = 0.0f, .friction_combine = CombineRule::multiply},
    {.restitution = 0.8f, .restitution_combine = CombineRule::average}};

// Three strips along x, with the materials 0, 1 and 2.
HeightField striped_field() {
    HeightFieldDef def;
    def.columns = 61, def.rows = 31;
    const std::vector<float> heights(static_cast<size_t>(def.columns * def.rows), 0.0f);
    std::vector<uint8_t> materials;
    for (int row = 0; row < 30; ++row) materials.insert(materials.end(), 60, static_cast<uint8_t>(row / 10));
    def.heights = heights, def.materials = materials;
    def.cell_x = def.cell_z = 0.2f;
    return HeightField::from_heights(def).value();
}

Shape striped(bool mesh) {
    HeightField f = striped_field();
    if (!mesh) return f;
    std::vector<uint8_t> materials;
    for (int t = 0; t < f.triangle_count(); ++t) materials.push_back(static_cast<uint8_t>(f.material(t)));
    return TriangleMesh::from_triangles(f.vertices(), f.triangles(), {.materials = materials}).value();
}

class Materials : public ::testing::TestWithParam<bool> {};

TEST_P(Materials, EachTriangleHasItsOwn) {
    World world = WorldBuilder{}.sleep(false).build().value();
    ColliderDef ground;
    ground.shape = striped(GetParam());
    ground.materials = table;
    world.add_static_body({.colliders = {&ground, 1}}).value();
    auto box_at = [&](float z) {
        ColliderDef collider;
        collider.shape = Box{{0.2f, 0.2f, 0.2f}};
        collider.material = {
            .static_friction = 1.0f, .dynamic_friction = 1.0f, .friction_combine = CombineRule::multiply};
        RigidBodyDef def;
        def.colliders = {&collider, 1};
        def.position = {1.0f, 0.2f, z};
        return world.add_rigid_body(def).value();
    };
    BodyId rough = box_at(1.0f), smooth = box_at(3.0f), between = box_at(2.0f);
    RigidBodyDef ball;
    ball.shape = Sphere{0.2f};
    ball.position = {1.0f, 1.2f, 5.0f};
    ball.restitution = 0.8f;
    BodyId bouncing = world.add_rigid_body(ball).value();
    run(world, 1);
    for (BodyId b : {rough, smooth, between}) world.get(b).set_velocity({2.0f, 0.0f, 0.0f}).value();
    float highest = 0.0f;
    for (int i = 0; i < 48; ++i) {
        run(world, 1);
        if (i > 30) highest = std::fmax(highest, world.get(bouncing).position().y);
        if (i != 12) continue;
        // What has none of the table's rows in common is not one contact: the box between rests on two.
        int on_between = 0;
        for (int c = 0; c < world.contact_count(); ++c) {
            Contact contact = world.contact(c);
            if (contact.body_a != between && contact.body_b != between) continue;
            ++on_between;
            EXPECT_GE(contact.triangle, 0);
        }
        EXPECT_EQ(on_between, 2);
        EXPECT_GT(world.get(between).velocity().x, 1.3f);
        EXPECT_LT(world.get(between).velocity().x, 1.7f);  // half of its weight on either: 2 - 2.45 * 0.22
    }
    EXPECT_NEAR(world.get(rough).velocity().x, 0.0f, 1e-5f);  // after 0.4 s
    EXPECT_NEAR(world.get(smooth).velocity().x, 2.0f, 1e-3f);
    EXPECT_GT(highest, 0.2f + 0.64f - 0.1f);
}
INSTANTIATE_TEST_SUITE_P(Surfaces, Materials, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "mesh" : "field"; });

TEST(MaterialTables, AreCheckedAtTheDoor) {
    World world = WorldBuilder{}.build().value();
    ColliderDef ground;
    ground.shape = striped_field();
    ground.materials = std::span(table).first(2);
    Result<BodyId> refused = world.add_static_body({.colliders = {&ground, 1}});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_material);
    EXPECT_NE(refused.error().message.find("has material 2, but the table has only 2"), std::string::npos);
    ground.shape = Box{};
    refused = world.add_static_body({.colliders = {&ground, 1}});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_material);
    const Material bad[] = {{}, {.restitution = 2.0f}, {}};
    ground.shape = striped_field();
    ground.materials = bad;
    EXPECT_FALSE(world.add_static_body({.colliders = {&ground, 1}}).ok());
    ground.materials = {};
    EXPECT_TRUE(world.add_static_body({.colliders = {&ground, 1}}).ok());  // its one material is that of all
    EXPECT_EQ(world.body_count(), 1);
    RigidBodyDef moving;
    moving.shape = striped_field();
    Result<BodyId> dynamic = world.add_rigid_body(moving);
    ASSERT_FALSE(dynamic.ok());
    EXPECT_EQ(dynamic.error().code, ErrorCode::shape_not_dynamic);
    EXPECT_NE(dynamic.error().message.find("height field"), std::string::npos);
    const std::vector<uint8_t> short_list(3, 0);
    HeightField f = striped_field();
    Result<TriangleMesh> mesh = TriangleMesh::from_triangles(f.vertices(), f.triangles(), {.materials = short_list});
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().message.find("but there are 3"), std::string::npos);
}

// A snapshot's contacts find their materials again: both worlds go on alike.
TEST(MaterialTables, OutlastSnapshots) {
    auto make = [] {
        World world = WorldBuilder{}.build().value();
        ColliderDef ground;
        ground.shape = striped(true);
        ground.materials = table;
        world.add_static_body({.colliders = {&ground, 1}}).value();
        for (int i = 0; i < 3; ++i) {
            RigidBodyDef def;
            def.shape = Box{{0.2f, 0.2f, 0.2f}};
            def.position = {1.0f, 0.2f, 1.0f + 2.0f * static_cast<float>(i)};
            def.velocity = {2.0f, 0.0f, 0.0f};
            world.add_rigid_body(def).value();
        }
        return world;
    };
    World a = make(), b = make();
    run(a, 5);
    b.restore(a.snapshot()).value();
    run(a, 40), run(b, 40);
    EXPECT_EQ(a.hash(), b.hash());
}

}  // namespace
}  // namespace lendulet::test
