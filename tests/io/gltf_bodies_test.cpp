// Bodies of glTF files: which nodes become bodies, where they stand, and their motion.
#include <cmath>

#include "io/gltf_fixture.h"

namespace lendulet::test {
namespace {

constexpr float half_root = 0.70710678f;

TEST(GltfHierarchy, BodiesInTheOrderOfTheTree) {
    Scene scene = load(scene_file("hierarchy.gltf"));
    std::vector<std::string> names;
    for (int i = 0; i < scene.world.body_count(); ++i) {
        names.emplace_back(scene.world.get_static(scene.world.body(i)).name());
    }
    EXPECT_EQ(names, (std::vector<std::string>{"Body", "Inner", "StaticBox", "Matrix", "Mirrored", ""}));
}

// Group: at (1, 2, 3), turned by 90 degrees about y, which takes x to -z and z to x.
TEST(GltfHierarchy, PosesAreThoseOfTheNodesInTheWorld) {
    Scene scene = load(scene_file("hierarchy.gltf"));
    const World& world = scene.world;
    StaticBodyRef body = any_body(world, "Body");
    EXPECT_LT(distance(from_origin(body.position()), {1.0f, 2.0f, 2.0f}), 1e-6f);
    Quat expected = Quat{0.0f, half_root, 0.0f, half_root} * Quat{half_root, 0.0f, 0.0f, half_root};
    EXPECT_GT(dot(body.orientation(), expected), 1.0f - 1e-6f);  // with the sign that the product has
    // Inner is 5 m up Body's y axis, which points along the group's z, the world's x.
    EXPECT_LT(distance(from_origin(any_body(world, "Inner").position()), {6.0f, 2.0f, 2.0f}), 1e-5f);
    // Matrix: columns (0, 0, -2), (0, 2, 0), (2, 0, 0) are scale 2 and the same turn as the group's.
    StaticBodyRef matrix = any_body(world, "Matrix");
    EXPECT_LT(angle_between(matrix.orientation(), {0.0f, 1.0f, 0.0f, 0.0f}), 1e-3f);
    EXPECT_LT(distance(std::get<Box>(matrix.shape()).half_extents, {1.0f, 1.0f, 1.0f}), 1e-5f);
    EXPECT_LT(distance(from_origin(matrix.position()), {1.0f + 7.0f, 2.0f + 6.0f, 3.0f - 5.0f}), 1e-5f);
}

TEST(GltfHierarchy, CollidersOfDescendantsBelongToTheNearestMovingNode) {
    Scene scene = load(scene_file("hierarchy.gltf"));
    StaticBodyRef body = any_body(scene.world, "Body");
    ASSERT_EQ(body.collider_count(), 2);
    EXPECT_LT(distance(body.collider_pose(0).translation, {0.0f, 1.0f, 0.0f}), 1e-6f);
    // The ball is 2 units along z of a node scaled by a half at (0, -1, 0).
    EXPECT_LT(distance(body.collider_pose(1).translation, {0.0f, -1.0f, 1.0f}), 1e-6f);
    EXPECT_FLOAT_EQ(std::get<Sphere>(body.shape(1)).radius, 0.25f);
    EXPECT_EQ(any_body(scene.world, "Inner").collider_count(), 1);
    ASSERT_EQ(scene.collider_names.size(), 2u);
    EXPECT_EQ(scene.collider_names[0].second, "BodyBox");
    EXPECT_EQ(scene.collider_names[0].first, body.collider(0));
}

TEST(GltfHierarchy, MirroredNodeKeepsItsRotation) {
    Scene scene = load(scene_file("hierarchy.gltf"));
    const RigidBodyRef body = moving(scene.world, "Mirrored");
    Quat expected{0.0f, 0.0f, 0.25881905f, 0.96592583f};
    EXPECT_LT(angle_between(body.orientation(), expected), 1e-3f);
    // Velocities are along the node's axes.
    EXPECT_LT(distance(body.velocity(), {0.8660254f, 0.5f, 0.0f}), 1e-5f);
    EXPECT_LT(distance(body.angular_velocity(), {0.0f, 0.0f, 2.0f}), 1e-5f);
}

class GltfMotion : public testing::Test {
protected:
    Scene scene = load(scene_file("motion.gltf"));
};

TEST_F(GltfMotion, GivenPropertiesAreTaken) {
    const RigidBodyRef body = moving(scene.world, "Given");  // turned by 90 degrees about z: x to y, y to -x
    EXPECT_FLOAT_EQ(body.mass(), 4.0f);
    EXPECT_LT(distance(body.centre_of_mass() - body.position(), {-0.2f, 0.1f, 0.3f}), 1e-5f);
    EXPECT_LT(distance(body.velocity(), {-2.0f, 1.0f, 3.0f}), 1e-5f);
    EXPECT_LT(distance(body.angular_velocity(), {-0.2f, 0.1f, 0.3f}), 1e-5f);
    // Principal moments (1, 2, 2.5) turned about x by 90 degrees are (1, 2.5, 2) along the node's axes, and with the
    // node's turn (2.5, 1, 2) along the world's.
    SymMat3 inverse = body.inverse_inertia();
    EXPECT_NEAR(1.0f / inverse.xx, 2.5f, 1e-4f);
    EXPECT_NEAR(1.0f / inverse.yy, 1.0f, 1e-4f);
    EXPECT_NEAR(1.0f / inverse.zz, 2.0f, 1e-4f);
}

TEST_F(GltfMotion, MissingPropertiesAreComputed) {
    const RigidBodyRef body = moving(scene.world, "Computed");
    EXPECT_NEAR(body.mass(), 1000.0f, 0.1f);  // a cubic metre at 1000 kg/m^3
    EXPECT_NEAR(body.inverse_inertia().xx, 6.0f / 1000.0f, 1e-6f);
}

TEST_F(GltfMotion, GravityFactor) {
    run(scene, 30);  // half a second
    EXPECT_NEAR(moving(scene.world, "Floating").position().y, 5.0f, 1e-5f);
    EXPECT_NEAR(moving(scene.world, "Rising").position().y, 5.0f + 0.25f * 9.81f * 0.25f, 0.05f);
    EXPECT_NEAR(moving(scene.world, "Computed").position().y, 5.0f - 0.5f * 9.81f * 0.25f, 0.05f);
}

TEST_F(GltfMotion, KinematicKeepsItsVelocity) {
    run(scene, 60);
    const RigidBodyRef body = moving(scene.world, "Kinematic");
    EXPECT_EQ(body.type(), BodyType::kinematic);
    EXPECT_LT(distance(from_origin(body.position()), {-2.0f, 5.0f, 1.0f}), 1e-3f);
    EXPECT_LT(angle_between(body.orientation(), {0.0f, std::sin(0.5f), 0.0f, std::cos(0.5f)}), 1e-2f);
}

TEST_F(GltfMotion, ZeroMeansInfinity) {
    RigidBodyRef heavy = scene.world.get(find_body(scene.world, "Immovable"));
    heavy.apply_impulse({5.0f, -3.0f, 0.0f}, heavy.position() + Vec3{0.0f, 0.0f, 0.5f}).value();
    RigidBodyRef stiff = scene.world.get(find_body(scene.world, "Untwisting"));
    stiff.apply_impulse({1.0f, 0.0f, 0.0f}, stiff.position() + Vec3{0.0f, 0.3f, 0.0f}).value();
    run(scene, 30);
    EXPECT_LT(distance(from_origin(heavy.position()), {0.0f, 5.0f, 0.0f}), 1e-5f);
    EXPECT_NEAR(length(heavy.velocity()), 0.0f, 1e-9f);
    EXPECT_NEAR(heavy.angular_velocity().y, 2.5f, 1e-3f);  // arm 0.5 m, impulse 5 N s, moment 1 kg m^2 about y
    EXPECT_NEAR(heavy.angular_velocity().x, 0.0f, 1e-6f);
    EXPECT_NEAR(length(stiff.angular_velocity()), 0.0f, 1e-6f);
    EXPECT_NEAR(stiff.velocity().x, 1.0f, 1e-5f);
}

TEST_F(GltfMotion, InertiaNoSolidHasIsCut) {
    EXPECT_TRUE(warns(scene, "\"Unsolid\": no solid has such moments"));
    EXPECT_NEAR(1.0f / moving(scene.world, "Unsolid").inverse_inertia().zz, 2.0f, 1e-2f);
}

TEST_F(GltfMotion, MotionWithoutColliderFliesOn) {
    run(scene, 60);
    EXPECT_LT(distance(from_origin(moving(scene.world, "Point").position()), {6.0f, 6.0f, 0.0f}), 1e-3f);
    EXPECT_TRUE(warns(scene, "\"Point\": moves but has no collider"));
}

TEST(GltfScene, SettingsOfTheCallerWin) {
    Scene scene = load_gltf(scene_file("motion.gltf"), [](WorldBuilder& b) { b.no_gravity().solver_steps(3); }).value();
    EXPECT_EQ(scene.world.config().solver_steps, 3);
    EXPECT_EQ(scene.world.config().gravity, (Vec3{0.0f, 0.0f, 0.0f}));
    Result<Scene> refused = load_gltf(scene_file("motion.gltf"), [](WorldBuilder& b) { b.solver_steps(0); });
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_config);
}

TEST(GltfScene, OnlyTheDefaultSceneIsLoaded) {
    std::string text = gltf_text(
        "{'name':'in','extensions':{'KHR_physics_rigid_bodies':{'collider':{'geometry':{'shape':0}}}}},"
        "{'name':'out','extensions':{'KHR_physics_rigid_bodies':{'collider':{'geometry':{'shape':0}}}}}",
        "{'type':'sphere'}");
    text.back() = ',';
    text += "\"scene\":1,\"scenes\":[{\"nodes\":[1]},{\"nodes\":[0]}]}";
    Scene scene = load_text(text);
    ASSERT_EQ(scene.world.body_count(), 1);
    EXPECT_EQ(scene.world.get_static(scene.world.body(0)).name(), "in");
}

TEST(GltfScene, WithoutPhysicsIsAnEmptyWorldWithAWarning) {
    Scene scene = load_text(R"({"asset":{"version":"2.0"},"nodes":[{"name":"a"}],"animations":[]})");
    EXPECT_EQ(scene.world.body_count(), 0);
    EXPECT_TRUE(warns(scene, "no physics"));
    EXPECT_TRUE(warns(scene, "animations are not played"));
    run(scene, 3);
}

}  // namespace
}  // namespace lendulet::test
